//! Shapes, groups and instances.

use std::fmt::Write;

use glam::{DMat4, DVec3, DVec4};
use tyndall::math::{Transform, Vec3};
use tyndall::shape::{Basis, Curves, DiskMapping, Mesh, Patch, SpherePart, Style, Turn};

use super::Pen;
use super::element::Element;
use super::emitter::point;
use super::placed;
use crate::build::strands::{strand, strands};
use crate::build::triangles::triangles_of;
use crate::desc::{FileRef, MediumInterface, PatchDesc, Radii, ShapeDesc, ShapeKind, StrandsDesc};
use crate::write::mesh::{has_normals, keeps_lengths, wanted};
use crate::write::place::Place;

impl Pen<'_, '_> {
    /// Groups, shapes and instances; `meter` is a sensor and the shape that it stands on.
    pub(super) fn shapes(&mut self, mut meter: Option<(usize, Element)>) -> Vec<Element> {
        let desc = self.draft.desc;
        let mut elements = Vec::new();
        for (index, group) in desc.groups.iter().enumerate() {
            let mut element = Element::plugin("shape", "shapegroup").with("id", &self.groups[index]);
            for shape in &group.shapes {
                element.extend(self.shape(shape));
            }
            elements.push(element);
        }
        for (index, shape) in desc.shapes.iter().enumerate() {
            let mut parts = self.shape(shape);
            if let Some(first) = parts.first_mut()
                && let Some((_, sensor)) = meter.take_if(|(at, _)| *at == index)
            {
                first.push(sensor);
            }
            elements.append(&mut parts);
        }
        for instance in &desc.instances {
            let Some(name) = self.groups.get(instance.group.value.0 as usize) else { continue };
            let mut element = Element::plugin("shape", "instance").around(Element::new("ref").with("id", name));
            element.extend(placed(instance.to_world));
            elements.push(element);
        }
        elements
    }

    /// A shape; a mesh of patches is a shape a patch.
    fn shape(&mut self, shape: &ShapeDesc) -> Vec<Element> {
        let parts = match &shape.kind {
            ShapeKind::BilinearMesh(patches) => self.patches(shape, patches),
            _ => self.shape_kind(shape).into_iter().collect(),
        };
        parts.into_iter().map(|part| self.bound(part, shape)).collect()
    }

    /// With what is bound to a shape.
    fn bound(&mut self, mut element: Element, shape: &ShapeDesc) -> Element {
        element = self.called(element, shape.name.as_deref(), shape.span);
        if shape.reverse_orientation {
            element.boolean("flip_normals", true);
        }
        if let Some(priority) = shape.priority {
            element.integer("priority", priority.value.into());
        }
        if let Some(word) = shape.granular_word() {
            element.string("granular", word);
        }
        if let Some(interface) = shape.interface {
            self.interface(&mut element, &interface);
        }
        let material = self.material_ref(shape.material.value);
        match &shape.opacity {
            None => element.push(material),
            Some(opacity) => {
                if shape.interface.is_some() {
                    self.lacks(opacity.span, "holes in a boundary of media");
                }
                let mut mask = Element::plugin("bsdf", "mask");
                self.number_unless(&mut mask, "opacity", opacity, 0.5);
                element.push(mask.around(material));
            }
        }
        if let Some(light) = &shape.emission {
            element.push(self.area_light(light));
        }
        element
    }

    /// Patches that are parallelograms are rectangles; others that are flat are two triangles.
    fn patches(&mut self, shape: &ShapeDesc, patches: &PatchDesc) -> Vec<Element> {
        let mut elements = Vec::new();
        for corners in &patches.indices {
            let corners = corners.map(|i| Vec3::from_array(patches.positions[i as usize]));
            if let Some(to_world) = rectangle_of(shape.to_world, corners) {
                elements.push(placed_plugin("rectangle", to_world));
            } else if let Some(mesh) = Patch::new(corners).as_triangles() {
                let name = self.draft.mesh_file(shape, mesh);
                elements.push(mesh_file("ply", &name, shape, true));
            } else {
                self.lacks(shape.span, "curved bilinear patches");
            }
        }
        elements
    }

    /// The geometry of a shape that a sensor looks at, which need not be part of the scene.
    pub(super) fn target(&mut self, shape: &ShapeDesc) -> Option<Element> {
        let mut element = self.shape_kind(shape)?.with("name", "target");
        if shape.reverse_orientation {
            element.boolean("flip_normals", true);
        }
        Some(element)
    }

    fn interface(&mut self, element: &mut Element, interface: &MediumInterface) {
        for (name, medium) in [("interior", interface.inside), ("exterior", interface.outside)] {
            if let Some(medium) = medium {
                element.push(self.medium_ref(medium).with("name", name));
            }
        }
        if (interface.inside, interface.outside) == (None, None) {
            let message = "in Mitsuba a surface with no medium on either side leaves the medium as it is";
            self.draft.differs(interface.span, message);
        }
    }

    /// The geometry and its place.
    fn shape_kind(&mut self, shape: &ShapeDesc) -> Option<Element> {
        Some(match &shape.kind {
            ShapeKind::Sphere { radius, part } => {
                if *part != SpherePart::WHOLE {
                    self.lacks(shape.span, "a part of a sphere");
                }
                let mut element = Element::plugin("shape", "sphere");
                // Its v runs the other way.
                let to_world = shape.to_world * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
                match Place::of(to_world) {
                    Place::Steps { scale: None, translation: Some(centre) } => element.push(point("center", centre)),
                    _ => element.extend(placed(to_world)),
                }
                element.float_unless("radius", *radius, 1.0);
                element
            }
            ShapeKind::Cylinder { radius, heights: [low, high], turn } => {
                if *turn != Turn::FULL {
                    self.lacks(shape.span, "a part of a cylinder");
                }
                let up = DMat4::from_translation(DVec3::new(0.0, 0.0, *low));
                let mut element = placed_plugin("cylinder", shape.to_world * up);
                if high - low != 1.0 {
                    element.push(point("p1", DVec3::new(0.0, 0.0, high - low)));
                }
                element.float_unless("radius", *radius, 1.0);
                element
            }
            ShapeKind::Subdivision { .. } => {
                let name = self.draft.mesh(shape)?;
                mesh_file("ply", &name, shape, false)
            }
            ShapeKind::Disk { height, radius, inner_radius, turn, mapping } => {
                if *inner_radius > 0.0 || *turn != Turn::FULL {
                    self.lacks(shape.span, "a ring, or a part of a disk");
                }
                if *mapping == DiskMapping::AzimuthInward {
                    self.draft.differs(shape.span, "texture coordinates of disks run otherwise in Mitsuba");
                }
                let unit = DMat4::from_translation(DVec3::new(0.0, 0.0, *height))
                    * DMat4::from_scale(DVec3::new(*radius, *radius, 1.0));
                placed_plugin("disk", shape.to_world * unit)
            }
            ShapeKind::Rectangle => placed_plugin("rectangle", shape.to_world),
            ShapeKind::Cube => placed_plugin("cube", shape.to_world),
            ShapeKind::TriangleMesh(_) => {
                let mesh = triangles_of(&shape.kind)?.ok()?;
                if let Some(word) = word_of(&mesh) {
                    placed_plugin(word, shape.to_world)
                } else {
                    let name = self.draft.mesh(shape)?;
                    mesh_file("ply", &name, shape, mesh.normals.is_empty())
                }
            }
            // Each patch is a shape of its own.
            ShapeKind::BilinearMesh(_) => return None,
            ShapeKind::Ply { path, face_normals, smooth_normals, flip_tex_coords, displacement } => {
                if let Some(displacement) = displacement {
                    self.lacks(displacement.height.span, "a mesh whose vertices a texture moves");
                }
                let flat = *face_normals || !*smooth_normals && has_normals(path) == Some(false);
                let mut element = self.file("ply", path, shape, flat);
                if *flip_tex_coords {
                    element.boolean("flip_tex_coords", true);
                }
                element
            }
            ShapeKind::Obj { path, face_normals, smooth_normals: _, flip_tex_coords } => {
                let mut element = self.file("obj", path, shape, *face_normals);
                if !*flip_tex_coords {
                    element.boolean("flip_tex_coords", false);
                }
                element
            }
            ShapeKind::Curve(curve) => self.strands(shape, strand(curve), Transform::new(shape.to_world)?)?,
            ShapeKind::Strands(StrandsDesc { path, basis, style: Style::Round, radii })
                if plugin_of(*basis).is_some() && is_text(path) && (*radii == Radii::World || keeps_lengths(shape)) =>
            {
                let mut element = Element::plugin("shape", plugin_of(*basis)?);
                element.string("filename", &self.draft.relative(&path.value, path.span));
                element.extend(placed(shape.to_world));
                element
            }
            ShapeKind::Strands(file) => match strands(file, &Transform::new(shape.to_world)?) {
                Ok((curves, transform)) => self.strands(shape, curves, transform)?,
                Err(error) => {
                    self.draft.errors.push(error);
                    return None;
                }
            },
            ShapeKind::Serialized { path, index, face_normals } => {
                let mut element = self.file("serialized", path, shape, *face_normals);
                if *index != 0 {
                    element.integer("shape_index", (*index).into());
                }
                element
            }
        })
    }

    /// Segments as B-splines of four points each, in the world.
    fn strands(&mut self, shape: &ShapeDesc, curves: Curves, transform: Transform) -> Option<Element> {
        self.lacks(shape.span, "strands but as B-splines in a file: each segment becomes a tube of its own");
        let Some(curves) = curves.placed(&transform) else {
            self.lacks(shape.span, "curves that are stretched unevenly");
            return None;
        };
        let splines: Vec<_> = curves.beziers().map(spline).collect();
        if splines.iter().flatten().any(|p| p.w < 0.0) {
            self.lacks(shape.span, "a strand that tapers to a point");
            return None;
        }
        let mut lines = String::new();
        for spline in splines {
            for [x, y, z, radius] in spline.map(|p| p.as_vec4().to_array()) {
                // Writing to memory cannot fail.
                let _ = writeln!(lines, "{x} {y} {z} {radius}");
            }
            lines.push('\n');
        }
        let name = self.draft.file_beside(shape.span, wanted(shape), "txt", lines.into_bytes());
        let mut element = Element::plugin("shape", "bsplinecurve");
        element.string("filename", &name);
        Some(element)
    }

    fn file(&mut self, word: &str, path: &FileRef, shape: &ShapeDesc, flat: bool) -> Element {
        let name = self.draft.relative(&path.value, path.span);
        mesh_file(word, &name, shape, flat)
    }
}

/// Whether a file of strands is Mitsuba's text.
fn is_text(path: &FileRef) -> bool {
    path.value.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("hair"))
}

/// Mitsuba's word for strands of this basis.
fn plugin_of(basis: Basis) -> Option<&'static str> {
    match basis {
        Basis::CubicBSpline => Some("bsplinecurve"),
        Basis::Linear => Some("linearcurve"),
        _ => None,
    }
}

/// The control points of a uniform B-spline of one segment that is this Bézier curve.
fn spline([a, b, c, d]: [DVec4; 4]) -> [DVec4; 4] {
    let (p1, p2) = (2.0 * b - c, 2.0 * c - b);
    [6.0 * a - 4.0 * p1 - p2, p1, p2, 6.0 * d - p1 - 4.0 * p2]
}

/// Mitsuba's word for triangles that are one of its own shapes.
fn word_of(mesh: &Mesh) -> Option<&'static str> {
    let known = [("rectangle", ShapeKind::Rectangle), ("cube", ShapeKind::Cube)];
    let is_this = |kind| triangles_of(kind).and_then(Result::ok).is_some_and(|known| is_same(&known, mesh));
    known.iter().find(|(_, kind)| is_this(kind)).map(|(word, _)| *word)
}

fn placed_plugin(word: &str, to_world: DMat4) -> Element {
    let mut element = Element::plugin("shape", word);
    element.extend(placed(to_world));
    element
}

fn mesh_file(word: &str, name: &str, shape: &ShapeDesc, flat: bool) -> Element {
    let mut element = Element::plugin("shape", word);
    element.string("filename", name);
    element.extend(placed(shape.to_world));
    if flat {
        element.boolean("face_normals", true);
    }
    element
}

/// Where Mitsuba's rectangle has these corners, to the last bit.
fn rectangle_of(to_world: DMat4, corners: [Vec3; 4]) -> Option<DMat4> {
    let [p00, p10, p01, p11] = corners.map(Vec3::as_dvec3);
    let (u, v) = (0.5 * (p10 - p00), 0.5 * (p01 - p00));
    let n = u.cross(v).try_normalize()?;
    let centre = 0.5 * (p10 + p01);
    let m = to_world * DMat4::from_cols(u.extend(0.0), v.extend(0.0), n.extend(0.0), centre.extend(1.0));
    let [placed, square] = [Transform::new(to_world)?, Transform::new(m)?].map(|t| t.matrix.as_dmat4());
    let signs = [(-1.0, -1.0, p00), (1.0, -1.0, p10), (-1.0, 1.0, p01), (1.0, 1.0, p11)];
    let is_same = signs.into_iter().all(|(x, y, corner)| {
        square.transform_point3(DVec3::new(x, y, 0.0)).as_vec3() == placed.transform_point3(corner).as_vec3()
    });
    is_same.then_some(m)
}

fn is_same(a: &Mesh, b: &Mesh) -> bool {
    a.positions == b.positions && a.indices == b.indices && a.normals == b.normals && a.uvs == b.uvs
}
