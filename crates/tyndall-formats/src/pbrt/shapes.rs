//! `Shape`.

use tyndall::granular::Granular;
use tyndall::shape::{DiskMapping, SpherePart, Turn};

use super::Reader;
use super::param::ParamType;
use super::params::Params;
use super::parser::Statement;
use super::textures::Textures;
use crate::desc::{DisplacementDesc, MaterialDesc, MaterialId, MeshDesc, PatchDesc, ShapeDesc, ShapeKind, granular};
use crate::error::SceneError;
use crate::source::Spanned;

/// `hair` is tyndall's own.
const SHAPES: [&str; 9] =
    ["sphere", "disk", "cylinder", "trianglemesh", "bilinearmesh", "plymesh", "loopsubdiv", "curve", "hair"];

impl Reader {
    pub(super) fn shape(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !SHAPES.contains(&&*name.value) {
            return self.unknown_kind("shape", &name, &SHAPES, &[]);
        }
        let defaults = self.state.now.defaults.shape.clone();
        let mut p = self.params("shape", &mut s, &defaults);
        let kind = match &*name.value {
            "sphere" => Some(sphere(&mut p)),
            "disk" => Some(disk(&mut p)),
            "cylinder" => Some(cylinder(&mut p)),
            "trianglemesh" => triangles(&mut p).map(ShapeKind::TriangleMesh),
            "bilinearmesh" => patches(&mut p).map(ShapeKind::BilinearMesh),
            "loopsubdiv" => subdivision(&mut p),
            "curve" => super::strands::curve(&mut p),
            "hair" => super::strands::hair(&mut p),
            _ => ply(&mut p, &self.textures, self.settings.displacement_edge_scale.unwrap_or(1.0)),
        };
        let opacity = p.number("alpha", &self.textures, |_| true).filter(|a| a.value.number().is_none_or(|a| a < 1.0));
        // tyndall's own.
        let (priority, name, granular) = (p.integer_opt("priority"), p.name(), among_grains(&mut p));
        self.finish_params(p);
        if let Some(kind) = kind {
            let shape = ShapeDesc { name, opacity, priority, granular, ..self.bound(&s, kind) };
            self.place(shape);
        }
    }

    /// A shape with what the graphics state binds to it.
    fn bound(&mut self, s: &Statement<'_>, kind: ShapeKind) -> ShapeDesc {
        let material = match self.state.now.material {
            Some(material) => material,
            None => self.default_material(s),
        };
        let now = &self.state.now;
        // pbrt turns the normals of its quadrics round under a mirroring matrix; our natural normal stays outside.
        let quadric = matches!(kind, ShapeKind::Sphere { .. } | ShapeKind::Disk { .. } | ShapeKind::Cylinder { .. });
        let mirrored = quadric && now.ctm.determinant() < 0.0;
        ShapeDesc {
            span: s.whole,
            name: None,
            kind,
            to_world: now.ctm,
            reverse_orientation: now.reverse_orientation ^ mirrored,
            material,
            opacity: None,
            emission: now.area_light.as_deref().cloned(),
            // What is the same on both sides is no boundary: empty space there leaves the medium as it is.
            interface: now.interface.filter(|i| (i.inside, i.outside) != (None, None)),
            priority: None,
            granular: None,
        }
    }

    /// A shape before any `Material` is of pbrt's default one.
    fn default_material(&mut self, s: &Statement<'_>) -> Spanned<MaterialId> {
        let id = match self.default_material {
            Some(id) => id,
            None => MaterialId(self.materials.push(s.span, MaterialDesc::pbrt_default(s.span))),
        };
        self.default_material = Some(id);
        Spanned::new(id, s.span)
    }

    /// Puts a shape into the world, or into the object that is being defined.
    fn place(&mut self, mut shape: ShapeDesc) {
        let Some((group, _)) = self.group else { return self.shapes.push(shape) };
        if let Some(light) = shape.emission.take() {
            self.ignore(light.span, "shapes of an object do not shine, as in pbrt: place it outside of the object");
        }
        if let Some(group) = self.groups.get_mut(group) {
            group.shapes.push(shape);
        }
    }
}

/// What it is among grains.
fn among_grains(p: &mut Params) -> Option<Spanned<Granular>> {
    let given = p.string_opt("granular")?;
    granular(Spanned::new(&given.value, given.span)).map_err(|error| p.error(error)).ok()
}

fn sphere(p: &mut Params) -> ShapeKind {
    let radius = p.positive("radius", 1.0).value;
    let heights = [p.float("zmin", -radius).value, p.float("zmax", radius).value];
    ShapeKind::Sphere { radius, part: SpherePart::new(radius, heights, turn(p)) }
}

fn cylinder(p: &mut Params) -> ShapeKind {
    let radius = p.positive("radius", 1.0).value;
    let [a, b] = [p.float("zmin", -1.0).value, p.float("zmax", 1.0).value];
    ShapeKind::Cylinder { radius, heights: [a.min(b), a.max(b)], turn: turn(p) }
}

fn turn(p: &mut Params) -> Turn {
    Turn::degrees(p.positive("phimax", 360.0).value)
}

fn disk(p: &mut Params) -> ShapeKind {
    let radius = p.positive("radius", 1.0).value;
    let height = p.float("height", 0.0).value;
    let inner = p.not_negative("innerradius", 0.0);
    if inner.value >= radius {
        p.error(SceneError::at(inner.span, "\"innerradius\" must be less than \"radius\""));
    }
    let mapping = DiskMapping::AzimuthInward;
    ShapeKind::Disk { height, radius, inner_radius: inner.value, turn: turn(p), mapping }
}

/// What triangles and patches have in common: corners, and one normal and one coordinate for each or none.
struct Corners {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
}

fn corners(p: &mut Params, least: usize) -> Option<Corners> {
    let positions = p.tuples::<3>("P", &[ParamType::Point3]);
    let normals = p.tuples::<3>("N", &[ParamType::Normal3]);
    let uvs = p.tuples::<2>("uv", &[ParamType::Point2]);
    p.ignore("faceIndices", "only face textures read them");
    let count = positions.value.len();
    if count < least {
        let message = format!("a mesh needs \"point3 P\" with at least {least} points, and this one has {count}");
        p.error(SceneError::at(positions.span, message));
        p.skip("indices");
        return None;
    }
    for (name, found, span) in [("N", normals.value.len(), normals.span), ("uv", uvs.value.len(), uvs.span)] {
        if found != 0 && found != count {
            let message = format!("\"{name}\" has {found} values for {count} points");
            p.error(SceneError::at(span, message).help(format!("give one \"{name}\" for each point")));
            p.skip("indices");
            return None;
        }
    }
    Some(Corners { positions: positions.value, normals: normals.value, uvs: uvs.value })
}

/// Faces; without "indices" the points are one face.
fn faces<const N: usize>(p: &mut Params, count: usize, single: [u32; N]) -> Option<Vec<[u32; N]>> {
    if p.has("indices") {
        return p.indices("indices", count);
    }
    if count == N {
        return Some(vec![single]);
    }
    p.error(SceneError::at(p.span, format!("a mesh of {count} points needs \"integer indices\"")));
    None
}

fn triangles(p: &mut Params) -> Option<MeshDesc> {
    p.ignore("S", "only anisotropic surfaces read tangents, and they follow uv");
    let Corners { positions, normals, uvs } = corners(p, 3)?;
    let indices = faces(p, positions.len(), [0, 1, 2])?;
    Some(MeshDesc { positions, indices, normals, uvs })
}

fn patches(p: &mut Params) -> Option<PatchDesc> {
    p.ignore("emissionfilename", "it only guides how light from the patch is sampled");
    let Corners { positions, normals, uvs } = corners(p, 4)?;
    let indices = faces(p, positions.len(), [0, 1, 2, 3])?;
    Some(PatchDesc { positions, indices, normals, uvs })
}

fn subdivision(p: &mut Params) -> Option<ShapeKind> {
    p.ignore("scheme", "there is one scheme, Loop's");
    let levels = p.count("levels", 3, 0).value;
    let positions = p.tuples::<3>("P", &[ParamType::Point3]);
    if !p.has("indices") || positions.value.is_empty() {
        p.error(SceneError::at(p.span, "a loopsubdiv needs \"point3 P\" and \"integer indices\""));
        p.skip("indices");
        return None;
    }
    let indices = p.indices("indices", positions.value.len())?;
    Some(ShapeKind::Subdivision { positions: positions.value, indices, levels })
}

fn ply(p: &mut Params, textures: &Textures, scale: f64) -> Option<ShapeKind> {
    let height = p.number("displacement", textures, |_| true);
    let edge_length = p.positive("edgelength", 1.0).value * scale;
    let displacement = height.map(|height| DisplacementDesc { height, edge_length });
    let Some(file) = p.string_opt("filename") else {
        p.error(SceneError::at(p.span, "a plymesh needs \"string filename\""));
        return None;
    };
    let path = file.map(|name| p.resolve(&name));
    Some(ShapeKind::Ply { path, face_normals: false, smooth_normals: false, flip_tex_coords: false, displacement })
}
