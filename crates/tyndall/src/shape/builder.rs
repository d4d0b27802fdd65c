//! Gathers shapes and places them in the world.

use super::{
    Curves, Cylinder, Disk, Geometry, Mesh, ObjectId, Patch, Shape, Sphere,
    bvh::{
        NONE, Primitive, Tree, TriangleId,
        build::{Entry, build},
    },
    instance::{Instance, Placement},
};
use crate::{granular::Granular, math::Transform};

/// Why a shape cannot be part of a scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names a vertex beyond the {vertices} vertices of the mesh")]
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An attribute is not given for every vertex.
    #[error("the mesh has {vertices} vertices but {count} {what}")]
    AttributeCount {
        /// The attribute.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A size that must be positive is not.
    #[error("the {what} must be positive, and is {value}")]
    NotPositive {
        /// The parameter.
        what: &'static str,
        /// Its value.
        value: f32,
    },
    /// A ribbon does not have one normal more than it has segments.
    #[error("a ribbon of {segments} segments has normals for {normals}")]
    RibbonNormals {
        /// How many segments there are.
        segments: usize,
        /// For how many there are normals.
        normals: usize,
    },
    /// The transform would make the cross-sections of strands ellipses.
    #[error("curves cannot be stretched unevenly: scale their points instead")]
    UnevenCurves,
    /// A coordinate is infinite or not a number (perhaps after the transform).
    #[error("a coordinate is not finite")]
    NotFinite,
    /// More than 2²⁸ triangles or shapes in one tree, or more than 2³² objects.
    #[error("too many shapes")]
    TooMany,
}

/// Shapes that are placed together, any number of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GroupId(u32);

/// Makes a [`Geometry`]. Objects are numbered in the order in which they are added, in groups or not.
///
/// ```
/// use tyndall::{math::{Ray, Transform, Vec3}, shape::{GeometryBuilder, Sphere}};
/// let mut builder = GeometryBuilder::default();
/// let ball = builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false)?;
/// let geometry = builder.build()?;
/// let hit = geometry.intersect(&Ray::new(Vec3::Z * 3.0, -Vec3::Z), f32::INFINITY).unwrap();
/// assert_eq!((hit.object, hit.t), (ball, 2.0));
/// # Ok::<(), tyndall::shape::ShapeError>(())
/// ```
#[derive(Debug, Default)]
pub struct GeometryBuilder {
    shapes: Vec<Shape>,
    world: Vec<u32>,
    groups: Vec<Vec<u32>>,
    in_group: bool,
    instances: Vec<Instance>,
}

impl GeometryBuilder {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a mesh. `reverse_orientation` turns the normals round.
    ///
    /// # Errors
    ///
    /// If an index is out of range, an attribute incomplete, or a coordinate not finite.
    pub fn add_mesh(
        &mut self,
        mesh: Mesh,
        transform: &Transform,
        reverse_orientation: bool,
    ) -> Result<ObjectId, ShapeError> {
        mesh.check()?;
        let mesh = mesh.placed(transform, reverse_orientation);
        mesh.check()?;
        self.add(Shape::Mesh(mesh))
    }

    /// Adds a sphere.
    ///
    /// # Errors
    ///
    /// If the radius is not positive, or a coordinate not finite.
    pub fn add_sphere(
        &mut self,
        sphere: Sphere,
        transform: &Transform,
        reverse_orientation: bool,
    ) -> Result<ObjectId, ShapeError> {
        sphere.check()?;
        let sphere = sphere.placed(transform, reverse_orientation);
        sphere.check()?;
        self.add(Shape::Sphere(sphere))
    }

    /// Adds a disk.
    ///
    /// # Errors
    ///
    /// If the radius is not positive, or a coordinate not finite.
    pub fn add_disk(
        &mut self,
        disk: Disk,
        transform: &Transform,
        reverse_orientation: bool,
    ) -> Result<ObjectId, ShapeError> {
        disk.check()?;
        let disk = disk.placed(transform, reverse_orientation);
        disk.check()?;
        self.add(Shape::Disk(disk))
    }

    /// Adds a cylinder.
    ///
    /// # Errors
    ///
    /// If radius or height are not positive, or a coordinate not finite.
    pub fn add_cylinder(
        &mut self,
        cylinder: Cylinder,
        transform: &Transform,
        reverse_orientation: bool,
    ) -> Result<ObjectId, ShapeError> {
        cylinder.check()?;
        let cylinder = cylinder.placed(transform, reverse_orientation);
        cylinder.check()?;
        self.add(Shape::Cylinder(cylinder))
    }

    /// Adds a bilinear patch; as a mesh of two triangles if it is flat.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite.
    pub fn add_patch(
        &mut self,
        patch: Patch,
        transform: &Transform,
        reverse_orientation: bool,
    ) -> Result<ObjectId, ShapeError> {
        let patch = patch.placed(transform, reverse_orientation);
        patch.check()?;
        self.add(patch.as_triangles().map_or(Shape::Patch(patch), Shape::Mesh))
    }

    /// Adds strands.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite, all widths are 0 or one is negative, a ribbon lacks normals, or the transform stretches
    /// unevenly.
    pub fn add_curves(&mut self, curves: Curves, transform: &Transform) -> Result<ObjectId, ShapeError> {
        curves.check()?;
        let curves = curves.placed(transform).ok_or(ShapeError::UnevenCurves)?;
        curves.check()?;
        self.add(Shape::Curves(curves))
    }

    /// Starts a group: the objects added until [`Self::end_group`] are seen only through its instances. Groups do not
    /// nest.
    pub fn begin_group(&mut self) -> GroupId {
        self.in_group = true;
        self.groups.push(Vec::new());
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Ends the group.
    pub fn end_group(&mut self) {
        self.in_group = false;
    }

    /// Places a group in the world. Instances are numbered in this order ([`super::Hit::instance`]).
    ///
    /// # Errors
    ///
    /// If there are too many.
    pub fn add_instance(&mut self, group: GroupId, transform: &Transform) -> Result<u32, ShapeError> {
        let index = self.instances.len() as u32;
        if index == NONE {
            return Err(ShapeError::TooMany);
        }
        self.instances.push(Instance { group: group.0, placement: Placement::new(transform) });
        Ok(index)
    }

    fn add(&mut self, shape: Shape) -> Result<ObjectId, ShapeError> {
        let index = self.shapes.len() as u32;
        if index == NONE {
            return Err(ShapeError::TooMany);
        }
        self.shapes.push(shape);
        match self.groups.last_mut() {
            Some(group) if self.in_group => group.push(index),
            _ => self.world.push(index),
        }
        Ok(ObjectId(index))
    }

    /// Builds the trees.
    ///
    /// # Errors
    ///
    /// If there are too many shapes for one tree.
    pub fn build(self) -> Result<Geometry, ShapeError> {
        Ok(self.build_granular(|_| None)?.0)
    }

    /// Builds the trees of a scene with grains: the geometry without their proxy, and if there is one, that without the
    /// grains. A group of grains has nothing else in it.
    ///
    /// # Errors
    /// If there are too many shapes for one tree.
    pub fn build_granular(
        self,
        granular: impl Fn(ObjectId) -> Option<Granular>,
    ) -> Result<(Geometry, Option<Geometry>), ShapeError> {
        let groups = self.groups.iter().map(|group| self.tree(group, Vec::new())).collect::<Result<Vec<_>, _>>()?;
        let is = |object: &u32, what| granular(ObjectId(*object)) == Some(what);
        let without = |absent| {
            let shown = |group: u32| !self.groups[group as usize].iter().any(|object| is(object, absent));
            let instances = (0..).zip(&self.instances).filter(|(_, instance)| shown(instance.group));
            let entries = instances.flat_map(|(index, _)| self.instance_entries(index, &groups)).collect();
            let world: Vec<_> = self.world.iter().filter(|object| !is(object, absent)).copied().collect();
            self.tree(&world, entries)
        };
        let world = without(Granular::Proxy)?;
        let proxied = if self.world.iter().any(|object| is(object, Granular::Proxy)) {
            Some(without(Granular::Grain)?)
        } else {
            None
        };
        let mut group = vec![None; self.shapes.len()];
        for (id, objects) in (0..).zip(&self.groups) {
            for object in objects {
                group[*object as usize] = Some(id);
            }
        }
        let geometry = Geometry::new(self.shapes, group, world, groups, self.instances);
        let proxied = proxied.map(|world| geometry.with_world(world));
        Ok((geometry, proxied))
    }

    fn tree(&self, objects: &[u32], mut entries: Vec<Entry>) -> Result<Tree, ShapeError> {
        for &object in objects {
            match &self.shapes[object as usize] {
                Shape::Mesh(mesh) => entries.extend(
                    (0..mesh.indices.len() as u32)
                        .map(|prim| Entry::Triangle(TriangleId { object, prim }, mesh.triangle(prim))),
                ),
                Shape::Curves(curves) => {
                    entries.extend(curves.pieces().map(|(piece, sheath)| Entry::Piece(object, piece, sheath)));
                }
                shape => entries.push(Entry::Other(self.primitive(object), shape.bounds())),
            }
        }
        if entries.len() >= 1 << 27 {
            return Err(ShapeError::TooMany);
        }
        Ok(build(entries))
    }

    fn primitive(&self, object: u32) -> Primitive {
        match &self.shapes[object as usize] {
            Shape::Sphere(sphere) => match sphere.round() {
                Some((centre, radius)) => Primitive::Sphere { centre, radius, object, instance: NONE },
                None => Primitive::Shape { object, instance: NONE },
            },
            _ => Primitive::Shape { object, instance: NONE },
        }
    }

    /// What an instance puts into the world's tree. A group without triangles and strands and with one or two shapes is cheaper
    /// without a tree of its own, and its spheres may be spheres in the world too.
    fn instance_entries(&self, index: u32, groups: &[Tree]) -> Vec<Entry> {
        let Instance { group, placement } = &self.instances[index as usize];
        let (objects, tree) = (&self.groups[*group as usize], &groups[*group as usize]);
        if tree.bounds.is_empty() {
            return Vec::new();
        }
        let has_curves = |object: &u32| matches!(self.shapes[*object as usize], Shape::Curves(_));
        if objects.len() > 2 || !tree.packets.is_empty() || objects.iter().any(has_curves) {
            return vec![Entry::Other(Primitive::Instance(index), placement.bounds(&tree.bounds))];
        }
        let place = |&object: &u32| {
            let shape = &self.shapes[object as usize];
            if let Shape::Sphere(sphere) = shape
                && sphere.part.is_whole()
                && let Some((centre, radius)) = sphere.moved(placement)
            {
                let bounds = Sphere::new(centre, radius).bounds();
                return Entry::Other(Primitive::Sphere { centre, radius, object, instance: index }, bounds);
            }
            Entry::Other(Primitive::Shape { object, instance: index }, placement.bounds(&shape.bounds()))
        };
        objects.iter().map(place).collect()
    }
}
