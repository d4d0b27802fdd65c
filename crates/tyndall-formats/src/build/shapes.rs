//! Shapes, groups and instances.

use std::collections::HashMap;

use glam::{DMat4, DVec3};
use tyndall::{
    light::{EmitterShape, Light},
    lpe::Names,
    math::{Transform, Vec2, Vec3},
    medium::{self, BodyId, Member},
    scene::{Emission, Object},
    shape::{Cylinder, Disk, Geometry, GeometryBuilder, GroupId, Mesh, ObjectId, ShapeError, Sphere},
    texture::TexturePoint,
};

use super::{
    Builder,
    emitters::{Pieces, Shining, pieces},
    material_id, medium_id,
    painted::Painting,
    spectra::Measure,
    strands::{strand, strands},
    triangles::{Normals, cube, finished, inline_mesh, mesh_of, patches_of, rectangle, wound_by_normals},
};
use crate::{
    desc::{DisplacementDesc, FileRef, GroupDesc, MaterialKind, ShapeDesc, ShapeKind},
    error::SceneError,
    mesh::{MeshError, TriangleMesh, displace, read_obj, read_ply, read_serialized, subdivide},
};

/// All shapes of a scene.
pub(super) struct Shapes<'a> {
    pub(super) geometry: Geometry,
    /// Without grains, where a proxy stands for them.
    pub(super) proxied: Option<Geometry>,
    pub(super) objects: Vec<Object>,
    /// Grains and proxies, and their objects.
    pub(super) granular: Vec<(&'a ShapeDesc, Vec<ObjectId>)>,
    pub(super) lights: Vec<Light>,
    /// What objects and lights are called.
    pub(super) names: Names,
    /// The surfaces of shapes that measure, by their index in the description.
    pub(super) meters: HashMap<usize, Vec<EmitterShape>>,
}

/// Shapes in the making.
#[derive(Default)]
struct Gathered<'a> {
    builder: GeometryBuilder,
    objects: Vec<Object>,
    /// What each object is called, and its material.
    names: Vec<Vec<String>>,
    emitters: Vec<Shining<'a>>,
    /// Grains and proxies, and their objects.
    granular: Vec<(&'a ShapeDesc, Vec<ObjectId>)>,
    painting: Painting,
}

impl<'a> Builder<'a> {
    pub(super) fn shapes(&mut self) -> Option<Shapes<'a>> {
        let desc = self.desc;
        let mut gathered = Gathered::default();
        let metered = desc.camera.metered_shapes();
        let mut objects = HashMap::new();
        for (index, shape) in desc.shapes.iter().enumerate() {
            let first = gathered.objects.len() as u32;
            self.shape(&mut gathered, shape);
            if metered.contains(&index) {
                objects.insert(index, first..gathered.objects.len() as u32);
            }
        }
        let groups: Vec<GroupId> = desc.groups.iter().map(|g| self.group(&mut gathered, g)).collect();
        for instance in &desc.instances {
            let group = *groups.get(instance.group.value.0 as usize)?;
            let transform = self.transform(instance.to_world, instance.span)?;
            if let Err(e) = gathered.builder.add_instance(group, &transform) {
                self.errors.push(SceneError::at(instance.span, e.to_string()));
            }
        }
        let granular = |id: ObjectId| gathered.objects.get(id.0 as usize).and_then(|object| object.granular);
        let (geometry, proxied) = match gathered.builder.build_granular(granular) {
            Ok(built) => built,
            Err(e) => return self.fail(SceneError::new(e.to_string())),
        };
        self.paint(&geometry, gathered.painting);
        let (mut lights, mut names_of_lights) = (Vec::new(), Vec::new());
        for shining in &gathered.emitters {
            let object = shining.object.0 as usize;
            gathered.objects[object].emission = self.emitters(&geometry, shining, &mut lights)?;
            let names = shining.light.name.iter().chain(&gathered.names[object]).cloned().collect();
            names_of_lights.resize(lights.len(), names);
        }
        let names = Names { objects: gathered.names, lights: names_of_lights, media: Vec::new() };
        let mut meters = HashMap::new();
        for (index, objects) in objects {
            meters.insert(index, surfaces(&geometry, objects));
        }
        Some(Shapes {
            geometry,
            proxied,
            objects: gathered.objects,
            granular: gathered.granular,
            lights,
            names,
            meters,
        })
    }

    /// The surface of a shape on its own.
    pub(super) fn surface_pieces(&mut self, shape: &'a ShapeDesc) -> Option<Vec<EmitterShape>> {
        let mut gathered = Gathered::default();
        self.shape(&mut gathered, shape)?;
        let objects = 0..gathered.objects.len() as u32;
        let geometry = match gathered.builder.build() {
            Ok(geometry) => geometry,
            Err(e) => return self.fail(SceneError::at(shape.span, e.to_string())),
        };
        Some(surfaces(&geometry, objects))
    }

    fn group(&mut self, gathered: &mut Gathered<'a>, group: &'a GroupDesc) -> GroupId {
        let id = gathered.builder.begin_group();
        for shape in &group.shapes {
            if let Some(emission) = &shape.emission {
                self.errors.push(
                    SceneError::at(emission.span, "shapes that shine cannot be instanced yet")
                        .help("place this shape in the world itself"),
                );
            }
            self.shape(gathered, shape);
        }
        gathered.builder.end_group();
        id
    }

    /// Adds the objects of one shape; a mesh of patches is one object a patch.
    fn shape(&mut self, gathered: &mut Gathered<'a>, desc: &'a ShapeDesc) -> Option<()> {
        let transform = self.transform(desc.to_world, desc.span)?;
        let reversed = desc.reverse_orientation;
        let builder = &mut gathered.builder;
        let added = match &desc.kind {
            ShapeKind::Sphere { radius, part } => {
                let sphere = Sphere::new(Vec3::ZERO, *radius as f32).cut(*part);
                vec![builder.add_sphere(sphere, &transform, reversed)]
            }
            ShapeKind::Disk { height, radius, inner_radius, turn, mapping } => {
                // Height and radius in double precision: the disk is the same whether a number or a matrix says them.
                let unit = DMat4::from_translation(DVec3::new(0.0, 0.0, *height))
                    * DMat4::from_scale(DVec3::new(*radius, *radius, 1.0));
                let disk = Disk::new(0.0, 1.0, (inner_radius / radius) as f32).cut(*turn).mapped(*mapping);
                let transform = self.transform(desc.to_world * unit, desc.span)?;
                vec![gathered.builder.add_disk(disk, &transform, reversed)]
            }
            ShapeKind::Cylinder { radius, heights, turn } => {
                // From 0 upwards: it is the same whether a number or a matrix says where it begins.
                let [low, high] = *heights;
                let cylinder = Cylinder::new(*radius as f32, [0.0, (high - low) as f32], *turn);
                let up = DMat4::from_translation(DVec3::new(0.0, 0.0, low));
                let transform = self.transform(desc.to_world * up, desc.span)?;
                vec![gathered.builder.add_cylinder(cylinder, &transform, reversed)]
            }
            ShapeKind::Rectangle => vec![builder.add_mesh(rectangle(), &transform, reversed)],
            ShapeKind::Cube => vec![builder.add_mesh(cube(), &transform, reversed)],
            ShapeKind::TriangleMesh(mesh) => vec![builder.add_mesh(inline_mesh(mesh), &transform, reversed)],
            ShapeKind::BilinearMesh(patches) => {
                patches_of(patches).map(|patch| builder.add_patch(patch, &transform, reversed)).collect()
            }
            ShapeKind::Ply { path, face_normals, smooth_normals, flip_tex_coords, displacement } => {
                let normals = Normals::asked(*face_normals, *smooth_normals);
                let mut mesh = match displacement {
                    None => self.meshes.get((path.value.clone(), 0), || read_ply(&path.value)),
                    Some(displacement) => self.displaced(path, displacement, &transform)?,
                };
                if let Ok(mesh) = &mut mesh {
                    self.keep_colours(mesh, gathered.objects.len() as u32, &mut gathered.painting);
                }
                let mesh = self.mesh_file(mesh, path, normals, *flip_tex_coords)?;
                vec![gathered.builder.add_mesh(mesh, &transform, reversed)]
            }
            ShapeKind::Curve(curve) => {
                self.check_strands(desc)?;
                vec![gathered.builder.add_curves(strand(curve), &transform)]
            }
            ShapeKind::Strands(file) => {
                self.check_strands(desc)?;
                match strands(file, &transform) {
                    Ok((curves, transform)) => vec![gathered.builder.add_curves(curves, &transform)],
                    Err(error) => return self.fail(error),
                }
            }
            ShapeKind::Subdivision { positions, indices, levels } => {
                let positions: Vec<_> = positions.iter().copied().map(Vec3::from_array).collect();
                match subdivide(&positions, indices, *levels) {
                    Ok(mesh) => vec![builder.add_mesh(wound_by_normals(mesh_of(mesh)), &transform, reversed)],
                    Err(problem) => return self.fail(SceneError::at(desc.span, format!("this surface: {problem}"))),
                }
            }
            ShapeKind::Serialized { path, index, face_normals } => {
                let normals = Normals::asked(*face_normals, true);
                let mesh = self.meshes.get((path.value.clone(), *index), || read_serialized(&path.value, *index));
                let mesh = self.mesh_file(mesh, path, normals, false)?;
                vec![gathered.builder.add_mesh(mesh, &transform, reversed)]
            }
            ShapeKind::Obj { path, face_normals, smooth_normals, flip_tex_coords } => {
                let normals = Normals::asked(*face_normals, *smooth_normals);
                let mesh = self.meshes.get((path.value.clone(), 0), || read_obj(&path.value));
                let mesh = self.mesh_file(mesh, path, normals, *flip_tex_coords)?;
                vec![gathered.builder.add_mesh(mesh, &transform, reversed)]
            }
        };
        let body = BodyId(gathered.objects.len() as u32);
        let body = desc.priority.map(|priority| Member { body, priority: priority.value });
        self.check_priority(desc)?;
        if desc.granular.is_some() {
            gathered.granular.push((desc, added.iter().filter_map(|added| added.as_ref().ok()).copied().collect()));
        }
        for object in added {
            self.bind(gathered, desc, object, body)?;
        }
        Some(())
    }

    /// A body with a priority must be something that light can enter, that does not shine, and whose outside is left to others.
    fn check_priority(&mut self, desc: &ShapeDesc) -> Option<()> {
        let Some(priority) = desc.priority else { return Some(()) };
        let kind = |id| self.desc.material(id).map(|material| &material.kind);
        let kind = match kind(desc.material.value) {
            Some(MaterialKind::Embossed { of, .. }) => kind(of.value),
            even => even,
        };
        if !matches!(kind, Some(MaterialKind::Dielectric { .. } | MaterialKind::Interface) | None) {
            return self.fail(
                SceneError::at(priority.span, "only a body that light can enter has a priority")
                    .help("leave it out, or use a dielectric material or none (\"interface\", \"null\")")
                    .related(desc.material.span, "its material"),
            );
        }
        if let Some(opacity) = &desc.opacity {
            return self.fail(
                SceneError::at(priority.span, "a body with a priority has no holes")
                    .help("leave out the priority, or the opacity")
                    .related(opacity.span, "its opacity"),
            );
        }
        if let Some(light) = &desc.emission {
            return self.fail(
                SceneError::at(priority.span, "the surface of a body with a priority cannot shine")
                    .help("leave out the priority, or the light")
                    .related(light.span, "its light"),
            );
        }
        if let Some(interface) = desc.interface.filter(|interface| interface.outside.is_some()) {
            return self.fail(
                SceneError::at(interface.span, "what is outside of a body with a priority, the other bodies say")
                    .help("name the medium inside only")
                    .related(priority.span, "its priority"),
            );
        }
        Some(())
    }

    /// Material, media and light of an object that was just added.
    fn bind(
        &mut self,
        gathered: &mut Gathered<'a>,
        desc: &'a ShapeDesc,
        object: Result<ObjectId, ShapeError>,
        body: Option<Member>,
    ) -> Option<()> {
        let object = match object {
            Ok(object) => object,
            Err(e) => return self.fail(SceneError::at(desc.span, e.to_string())),
        };
        let material = match &desc.opacity {
            None => material_id(desc.material.value),
            Some(opacity) => self.pierced(desc.material.value, opacity)?,
        };
        let material_name = self.desc.material(desc.material.value).and_then(|material| material.name.as_ref());
        gathered.names.push(desc.name.iter().chain(material_name).cloned().collect());
        gathered.objects.push(Object {
            name: desc.name.clone().unwrap_or_default(),
            material,
            interface: desc.interface.map(|i| medium::MediumInterface {
                inside: i.inside.map(medium_id),
                outside: i.outside.map(medium_id),
            }),
            emission: Emission::None,
            body,
            granular: desc.granular.map(|granular| granular.value),
        });
        if let Some(light) = &desc.emission {
            let by_face =
                !matches!(desc.kind, ShapeKind::Sphere { .. } | ShapeKind::Disk { .. } | ShapeKind::BilinearMesh(_));
            gathered.emitters.push(Shining { object, light, opacity: desc.opacity.as_ref(), by_face });
        }
        Some(())
    }

    fn mesh_file(
        &mut self,
        mesh: Result<TriangleMesh, MeshError>,
        path: &FileRef,
        normals: Normals,
        flip_tex_coords: bool,
    ) -> Option<Mesh> {
        match mesh {
            Ok(mesh) => Some(finished(mesh, normals, flip_tex_coords)),
            Err(e) => self.fail(SceneError::at(path.span, e.to_string())),
        }
    }

    /// A file's mesh with its vertices moved; `None` if the texture of the heights is wrong.
    fn displaced(
        &mut self,
        path: &FileRef,
        displacement: &DisplacementDesc,
        transform: &Transform,
    ) -> Option<Result<TriangleMesh, MeshError>> {
        let texture = self.texture(&displacement.height, Measure::Number)?;
        // As in pbrt, textures of space see the points of the mesh's own space, and no normal.
        let height = |p, uv: Vec2| texture.scalar(&TexturePoint { p, uv: uv.into(), n: Vec3::ZERO, part: None });
        let length = |a: Vec3, b: Vec3| {
            let along = transform.matrix.as_dmat4().transform_vector3(b.as_dvec3() - a.as_dvec3());
            along.length()
        };
        let displace = |mesh| {
            displace(mesh, length, displacement.edge_length, height)
                .map_err(|problem| MeshError { path: path.value.clone(), problem })
        };
        Some(self.meshes.get((path.value.clone(), 0), || read_ply(&path.value)).and_then(displace))
    }
}

/// The surface of several objects.
fn surfaces(geometry: &Geometry, objects: std::ops::Range<u32>) -> Vec<EmitterShape> {
    let pieces: Vec<Pieces> = objects.map(|object| pieces(geometry, ObjectId(object))).collect();
    pieces.iter().flat_map(Pieces::shapes).copied().collect()
}
