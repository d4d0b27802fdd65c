//! What a scene's geometry consists of, counted.

use std::mem::size_of_val;

use super::{Geometry, Shape, bvh::Tree};

/// Numbers of shapes, and what they and their trees take up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Census {
    /// Triangles of all meshes, each counted once however often it is placed.
    pub triangles: usize,
    /// Spheres and ellipsoids.
    pub spheres: usize,
    /// Disks and rings.
    pub disks: usize,
    /// Cylinders.
    pub cylinders: usize,
    /// Bilinear patches that are not flat.
    pub patches: usize,
    /// Segments of strands.
    pub curves: usize,
    /// Placed groups.
    pub instances: usize,
    /// Memory of shapes and trees [bytes].
    pub bytes: usize,
}

impl Census {
    /// All that a ray may meet.
    pub fn surfaces(&self) -> usize {
        let Self { triangles, spheres, disks, cylinders, patches, curves, instances, .. } = *self;
        triangles + spheres + disks + cylinders + patches + curves + instances
    }
}

impl Geometry {
    /// Counts the shapes.
    pub fn census(&self) -> Census {
        let trees = self.groups.iter().chain([&self.world]).map(tree_bytes).sum::<usize>();
        let own = size_of_val(&*self.shapes) + size_of_val(&*self.instances);
        let mut census = Census { instances: self.instances.len(), bytes: trees + own, ..Census::default() };
        for shape in &*self.shapes {
            match shape {
                Shape::Mesh(mesh) => {
                    census.triangles += mesh.indices.len();
                    census.bytes += size_of_val(&*mesh.positions) + size_of_val(&*mesh.indices);
                    census.bytes += size_of_val(&*mesh.normals) + size_of_val(&*mesh.uvs);
                }
                Shape::Sphere(_) => census.spheres += 1,
                Shape::Disk(_) => census.disks += 1,
                Shape::Cylinder(_) => census.cylinders += 1,
                Shape::Patch(_) => census.patches += 1,
                Shape::Curves(curves) => {
                    census.curves += curves.len();
                    census.bytes += curves.bytes();
                }
            }
        }
        census
    }
}

fn tree_bytes(tree: &Tree) -> usize {
    size_of_val(&*tree.nodes) + size_of_val(&*tree.packets) + size_of_val(&*tree.bundles) + size_of_val(&*tree.others)
}

#[cfg(test)]
mod tests {
    use crate::math::{Transform, Vec3};
    use crate::shape::{GeometryBuilder, Mesh, Sphere};

    /// A triangle placed twice is one triangle and two instances; its 3 positions and its indices are 48 bytes.
    #[test]
    fn shapes_are_counted_once_however_often_they_are_placed() {
        let mut builder = GeometryBuilder::new();
        builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false).unwrap();
        let group = builder.begin_group();
        let mesh = Mesh { positions: vec![Vec3::X, Vec3::Y, Vec3::Z], indices: vec![[0, 1, 2]], ..Mesh::default() };
        builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
        builder.end_group();
        for _ in 0..2 {
            builder.add_instance(group, &Transform::IDENTITY).unwrap();
        }
        let census = builder.build().unwrap().census();
        assert_eq!((census.triangles, census.spheres, census.instances), (1, 1, 2));
        assert!(census.bytes >= 48, "{census:?}");
    }
}
