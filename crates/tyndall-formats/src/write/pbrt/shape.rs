//! Shapes, objects and their instances.

use glam::DMat4;
use tyndall::shape::{Basis, DiskMapping, Style, Turn};

use super::Pen;
use super::entity::{Entity, quoted};
use crate::build::triangles::triangles_of;
use crate::desc::{CurveDesc, MaterialKind, PatchDesc, Radii, ShapeDesc, ShapeKind, StrandsDesc};
use crate::pbrt::strands::{BASES, STYLES};
use crate::write::mesh::{has_normals, has_normals_against_winding, keeps_lengths};
use crate::write::names::{Names, printable};
use crate::write::number::shortest;

impl Pen<'_, '_> {
    pub(super) fn shapes(&mut self) {
        let desc = self.draft.desc;
        let mut names = Names::default();
        let groups: Vec<_> =
            desc.groups.iter().map(|group| quoted(&names.unique(Some(&group.name), "object"))).collect();
        for (group, name) in desc.groups.iter().zip(&groups) {
            self.sheet.line(&format!("ObjectBegin {name}"));
            self.sheet.indent();
            group.shapes.iter().for_each(|shape| self.shape(shape));
            self.sheet.outdent();
            self.sheet.line("ObjectEnd");
            self.sheet.gap();
        }
        for shape in &desc.shapes {
            self.shape(shape);
        }
        for instance in &desc.instances {
            let Some(name) = groups.get(instance.group.value.0 as usize) else { continue };
            let is_moved = instance.to_world != DMat4::IDENTITY;
            if is_moved {
                self.open();
                self.place(instance.to_world);
            }
            self.sheet.line(&format!("ObjectInstance {name}"));
            if is_moved {
                self.close();
            }
        }
    }

    fn shape(&mut self, shape: &ShapeDesc) {
        let desc = self.draft.desc;
        let (mut material, mut opacity) = (shape.material.value, shape.opacity.as_ref());
        if let Some(MaterialKind::Mask { of, opacity: mask }) = desc.material(material).map(|m| &m.kind) {
            if opacity.is_some() || shape.interface.is_some() {
                self.lacks(shape.material.span, "a mask on a boundary of media");
            }
            (material, opacity) = (of.value, Some(mask));
        }
        let Some(mut entity) = self.shape_kind(shape) else { return };
        if let Some(opacity) = opacity {
            self.number(&mut entity, "alpha", opacity, 1.0);
        }
        if let Some(priority) = shape.priority {
            entity.integer("priority", priority.value.into());
        }
        if let Some(word) = shape.granular_word() {
            entity.string("granular", word);
        }
        self.name(&mut entity, shape.name.as_deref());
        let name = quoted(self.material_name(material));
        if let Some(name) = shape.name.as_ref().filter(|_| !self.names_count()) {
            self.sheet.line(&format!("# {}", printable(name)));
        }
        self.open();
        if let Some(interface) = shape.interface {
            self.interface(interface.inside, interface.outside);
        }
        self.place(shape.to_world);
        if is_reversed(shape) {
            self.sheet.line("ReverseOrientation");
        }
        self.sheet.line(&format!("NamedMaterial {name}"));
        if let Some(light) = &shape.emission {
            self.area_light(light);
        }
        self.entity(entity);
        self.close();
    }

    fn shape_kind(&mut self, shape: &ShapeDesc) -> Option<Entity> {
        Some(match &shape.kind {
            ShapeKind::Sphere { radius, part } => {
                let mut entity = Entity::new("Shape", &["sphere"]);
                entity.float_unless("radius", *radius, 1.0);
                for ((name, z), whole) in ["zmin", "zmax"].into_iter().zip(part.z).zip([-1.0, 1.0]) {
                    if z != whole {
                        entity.float(name, shortest(z * radius, |height| height / radius == z));
                    }
                }
                turned(&mut entity, part.turn);
                entity
            }
            ShapeKind::Cylinder { radius, heights, turn } => {
                let mut entity = Entity::new("Shape", &["cylinder"]);
                entity.float_unless("radius", *radius, 1.0);
                entity.float_unless("zmin", heights[0], -1.0);
                entity.float_unless("zmax", heights[1], 1.0);
                turned(&mut entity, *turn);
                entity
            }
            ShapeKind::Disk { height, radius, inner_radius, turn, mapping } => {
                if *mapping == DiskMapping::OutwardAzimuth {
                    let message = "texture coordinates of disks run otherwise in pbrt";
                    self.draft.differs(shape.span, message);
                }
                let mut entity = Entity::new("Shape", &["disk"]);
                entity.float_unless("height", *height, 0.0);
                entity.float_unless("radius", *radius, 1.0);
                entity.float_unless("innerradius", *inner_radius, 0.0);
                turned(&mut entity, *turn);
                entity
            }
            ShapeKind::Rectangle => {
                let mut entity = Entity::new("Shape", &["bilinearmesh"]);
                entity.param("point3", "P", "[ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]");
                entity
            }
            ShapeKind::Cube | ShapeKind::TriangleMesh(_) => triangles(shape)?,
            ShapeKind::BilinearMesh(patches) => bilinear(patches),
            ShapeKind::Subdivision { positions, indices, levels } => {
                let mut entity = Entity::new("Shape", &["loopsubdiv"]);
                if *levels != 3 {
                    entity.integer("levels", (*levels).into());
                }
                entity.singles("point3", "P", positions.as_flattened());
                entity.indices("indices", indices.as_flattened());
                entity
            }
            ShapeKind::Ply { path, face_normals, smooth_normals, flip_tex_coords, displacement } => {
                let as_it_is = !*flip_tex_coords
                    && has_normals(path).is_none_or(|has| if has { !*face_normals } else { !*smooth_normals })
                    && !has_normals_against_winding(&shape.kind);
                let name =
                    if as_it_is { self.draft.relative(&path.value, path.span) } else { self.draft.mesh(shape)? };
                let mut entity = Entity::new("Shape", &["plymesh"]);
                entity.string("filename", &name);
                if let Some(displacement) = displacement {
                    self.number(&mut entity, "displacement", &displacement.height, f64::NAN);
                    entity.float_unless("edgelength", displacement.edge_length, 1.0);
                }
                entity
            }
            ShapeKind::Curve(curve) => strand(curve),
            ShapeKind::Strands(strands) => self.strands(strands, shape),
            ShapeKind::Obj { .. } | ShapeKind::Serialized { .. } => {
                let name = self.draft.mesh(shape)?;
                let mut entity = Entity::new("Shape", &["plymesh"]);
                entity.string("filename", &name);
                entity
            }
        })
    }
}

impl Pen<'_, '_> {
    fn strands(&mut self, strands: &StrandsDesc, shape: &ShapeDesc) -> Entity {
        let StrandsDesc { path, basis, style, radii } = strands;
        self.draft.differs(path.span, "files of strands are read by tyndall only: pbrt has no word for them");
        if *radii == Radii::World && !keeps_lengths(shape) {
            self.lacks(path.span, "radii that stay as they are where their strands are scaled");
        }
        let mut entity = Entity::new("Shape", &["hair"]);
        entity.string("filename", &self.draft.relative(&path.value, path.span));
        entity.string("type", style_word(*style));
        based(&mut entity, *basis);
        entity
    }
}

fn strand(curve: &CurveDesc) -> Entity {
    let CurveDesc { basis, style, points, normals, widths: [root, tip] } = curve;
    let mut entity = Entity::new("Shape", &["curve"]);
    entity.string("type", style_word(*style));
    based(&mut entity, *basis);
    entity.float("width0", *root);
    entity.float("width1", *tip);
    entity.singles("point3", "P", points.as_flattened());
    entity.singles("normal", "N", normals.as_flattened());
    entity
}

fn style_word(style: Style) -> &'static str {
    STYLES.into_iter().find(|(_, of)| *of == style).map_or("flat", |(word, _)| word)
}

fn based(entity: &mut Entity, basis: Basis) {
    if let Some((word, degree, _)) = BASES.into_iter().find(|(.., of)| *of == basis) {
        entity.string("basis", word);
        if degree == 2 {
            entity.integer("degree", degree.into());
        }
    }
}

/// How far round a quadric goes.
fn turned(entity: &mut Entity, turn: Turn) {
    if turn != Turn::FULL {
        entity.float("phimax", shortest(360.0 * turn.turns(), |angle| Turn::degrees(angle) == turn));
    }
}

fn bilinear(patches: &PatchDesc) -> Entity {
    let mut entity = Entity::new("Shape", &["bilinearmesh"]);
    entity.singles("point3", "P", patches.positions.as_flattened());
    entity.indices("indices", patches.indices.as_flattened());
    entity.singles("normal", "N", patches.normals.as_flattened());
    entity.singles("point2", "uv", patches.uvs.as_flattened());
    entity
}

/// pbrt turns the normals of its quadrics round under a mirroring matrix.
fn is_reversed(shape: &ShapeDesc) -> bool {
    let quadric = matches!(shape.kind, ShapeKind::Sphere { .. } | ShapeKind::Disk { .. } | ShapeKind::Cylinder { .. });
    shape.reverse_orientation ^ (quadric && shape.to_world.determinant() < 0.0)
}

/// Triangles in words.
fn triangles(shape: &ShapeDesc) -> Option<Entity> {
    let mesh = triangles_of(&shape.kind)?.ok()?;
    let flat =
        |points: &[tyndall::math::Vec3]| points.iter().flat_map(tyndall::math::Vec3::to_array).collect::<Vec<_>>();
    let mut entity = Entity::new("Shape", &["trianglemesh"]);
    entity.singles("point3", "P", &flat(&mesh.positions));
    entity.indices("indices", mesh.indices.as_flattened());
    entity.singles("normal", "N", &flat(&mesh.normals));
    entity.singles("point2", "uv", &mesh.uvs.iter().flat_map(tyndall::math::Vec2::to_array).collect::<Vec<_>>());
    Some(entity)
}
