//! Whether a surface is closed: each edge of its faces must be met by another face that runs along it the other way.
//!
//! Corners are the same if their coordinates are: meshes repeat vertices where normals or texture coordinates jump.
//! Faces that have shrunk to a line count for nothing.

use glam::DVec3;
use rayon::prelude::*;

use super::{Geometry, Mesh, ObjectId, Patch, Shape};
use crate::{math::Vec3, sampling::rng::mix64};

/// The edges of the faces of a surface, counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Seams {
    /// Edges, each counted for every face that has it.
    pub edges: usize,
    /// Those that no other face meets with the opposite orientation.
    pub open: usize,
}

impl Geometry {
    /// The edges of what these objects are together. A sphere has none and is closed, unless a part of it is missing; a
    /// disk has one and a cylinder two, which are open.
    pub fn seams(&self, objects: &[ObjectId]) -> Seams {
        let mut edges = Vec::new();
        let rims = self.for_each_edge(objects, |edge| edges.push(edge));
        // Along an edge and against it, side by side.
        edges.par_sort_unstable();
        let open: i64 = edges
            .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
            .map(|edge| edge.iter().map(|(_, _, along)| if *along { 1 } else { -1 }).sum::<i64>().abs())
            .sum();
        Seams { edges: edges.len() + rims, open: open as usize + rims }
    }

    /// Whether what these objects are together has no edge, and so an inside.
    ///
    /// Told without memory: edges are hashed to 128 bits and added, those that run the other way subtracted.
    pub fn is_closed(&self, objects: &[ObjectId]) -> bool {
        let sums = objects.iter().map(|&object| match self.shape(object) {
            Shape::Sphere(sphere) => sphere.part.is_whole().then_some(0),
            Shape::Disk(_) | Shape::Cylinder(_) | Shape::Curves(_) => None,
            Shape::Mesh(mesh) => {
                let faces = (0..mesh.indices.len() as u32).into_par_iter();
                let faces = faces.map(|prim| sum(face_edges(mesh.triangle(prim), mesh.reversed)));
                Some(faces.reduce(|| 0, u128::wrapping_add))
            }
            Shape::Patch(patch) => Some(sum(patch_edges(patch))),
        });
        let total = sums.reduce(|a, b| Some(a?.wrapping_add(b?)));
        total.is_none_or(|total| total == Some(0))
    }

    /// Whether the normals of a closed surface point to its inside: by the volume that they enclose, which is then negative.
    pub fn faces_inward(&self, object: ObjectId) -> bool {
        match self.shape(object) {
            Shape::Sphere(sphere) => sphere.reversed,
            Shape::Disk(_) | Shape::Cylinder(_) | Shape::Patch(_) | Shape::Curves(_) => false,
            Shape::Mesh(mesh) => {
                let about = mesh.positions.first().map_or(DVec3::ZERO, |p| p.as_dvec3());
                let volume = |face: &[u32; 3]| {
                    let [a, b, c] = face.map(|corner| mesh.positions[corner as usize].as_dvec3() - about);
                    a.dot(b.cross(c))
                };
                // By parts of a fixed size: the sum is the same on any number of threads.
                let parts = mesh.indices.par_chunks(1 << 16).map(|faces| faces.iter().map(volume).sum());
                (parts.collect::<Vec<f64>>().iter().sum::<f64>() < 0.0) != mesh.reversed
            }
        }
    }

    /// Calls `visit` for every edge that has corners; returns the number of those that have none, and are open.
    fn for_each_edge(&self, objects: &[ObjectId], mut visit: impl FnMut(Edge)) -> usize {
        let mut rims = 0;
        for &object in objects {
            match self.shape(object) {
                Shape::Sphere(sphere) => rims += usize::from(!sphere.part.is_whole()),
                Shape::Disk(_) => rims += 1,
                Shape::Cylinder(_) => rims += 2,
                Shape::Curves(curves) => rims += 2 * curves.len(),
                Shape::Mesh(mesh) => mesh_edges(mesh).for_each(&mut visit),
                Shape::Patch(patch) => patch_edges(patch).for_each(&mut visit),
            }
        }
        rims
    }
}

/// Two corners in order, and whether the face runs from the first to the second.
type Edge = ([u32; 3], [u32; 3], bool);

fn mesh_edges(mesh: &Mesh) -> impl Iterator<Item = Edge> {
    (0..mesh.indices.len() as u32).flat_map(|prim| face_edges(mesh.triangle(prim), mesh.reversed))
}

fn patch_edges(patch: &Patch) -> impl Iterator<Item = Edge> + use<> {
    let [p00, p10, p01, p11] = patch.corners;
    face_edges([p00, p10, p11, p01], patch.reversed)
}

fn face_edges<const N: usize>(corners: [Vec3; N], reversed: bool) -> impl Iterator<Item = Edge> {
    let names = corners.map(|p| {
        let Vec3 { x, y, z } = p + Vec3::ZERO; // −0 is 0
        [x.to_bits(), y.to_bits(), z.to_bits()]
    });
    (0..N)
        .map(move |i| (names[i], names[(i + 1) % N]))
        .filter(|(a, b)| a != b)
        .map(move |(a, b)| if a < b { (a, b, !reversed) } else { (b, a, reversed) })
}

/// The sum of the hashes of edges, negative for those that run the other way.
fn sum(edges: impl Iterator<Item = Edge>) -> u128 {
    edges.fold(0, |sum, (a, b, along)| {
        let hash = hash(&a, &b);
        if along { sum.wrapping_add(hash) } else { sum.wrapping_sub(hash) }
    })
}

/// `SplitMix64` over the coordinates, two in a word, from two seeds.
fn hash(a: &[u32; 3], b: &[u32; 3]) -> u128 {
    let word = |low: u32, high: u32| u64::from(low) | u64::from(high) << 32;
    let words = [word(a[0], a[1]), word(a[2], b[0]), word(b[1], b[2])];
    let half = |seed: u64| words.iter().fold(seed, |hash, &word| mix64(hash ^ word));
    u128::from(half(0x243f_6a88_85a3_08d3)) << 64 | u128::from(half(0x1319_8a2e_0370_7344))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Transform;
    use crate::shape::{Disk, GeometryBuilder, Sphere};

    fn tetrahedron(faces: usize) -> Mesh {
        let indices = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        Mesh { positions, indices: indices[..faces].to_vec(), ..Mesh::default() }
    }

    /// The same faces with no vertex in common.
    fn torn(mesh: &Mesh) -> Mesh {
        let positions: Vec<_> = (0..mesh.indices.len() as u32).flat_map(|i| mesh.triangle(i)).collect();
        let indices = (0..mesh.indices.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Mesh { positions, indices, ..Mesh::default() }
    }

    fn seams(add: impl FnOnce(&mut GeometryBuilder)) -> (Seams, bool) {
        let mut builder = GeometryBuilder::new();
        add(&mut builder);
        let geometry = builder.build().unwrap();
        let all: Vec<_> = (0..geometry.shapes.len() as u32).map(ObjectId).collect();
        (geometry.seams(&all), geometry.is_closed(&all))
    }

    /// A tetrahedron has 4 faces of 3 edges; without one face, three edges are met by nobody.
    #[test]
    fn a_surface_is_closed_if_every_edge_is_met_from_the_other_side() {
        let mesh = |mesh: Mesh| seams(|b| drop(b.add_mesh(mesh, &Transform::IDENTITY, false)));
        assert_eq!(mesh(tetrahedron(4)), (Seams { edges: 12, open: 0 }, true));
        assert_eq!(mesh(torn(&tetrahedron(4))), (Seams { edges: 12, open: 0 }, true));
        assert_eq!(mesh(tetrahedron(3)), (Seams { edges: 9, open: 3 }, false));
        assert_eq!(mesh(torn(&tetrahedron(3))), (Seams { edges: 9, open: 3 }, false));
        // A face that looks the wrong way is met at none of its edges, and meets none.
        let mut turned = tetrahedron(4);
        turned.indices[3].swap(0, 1);
        assert_eq!(mesh(turned), (Seams { edges: 12, open: 6 }, false));
    }

    #[test]
    fn spheres_are_closed_and_disks_are_not() {
        let sphere = seams(|b| drop(b.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false)));
        assert_eq!(sphere, (Seams { edges: 0, open: 0 }, true));
        let disk = seams(|b| drop(b.add_disk(Disk::new(0.0, 1.0, 0.0), &Transform::IDENTITY, false)));
        assert_eq!(disk, (Seams { edges: 1, open: 1 }, false));
    }

    /// Two halves that are open alone are closed together.
    #[test]
    fn several_objects_can_be_closed_together() {
        let lid = Mesh { indices: vec![[2, 0, 3]], ..tetrahedron(4) };
        let both = seams(|b| {
            drop(b.add_mesh(tetrahedron(3), &Transform::IDENTITY, false));
            drop(b.add_mesh(lid, &Transform::IDENTITY, false));
        });
        assert_eq!(both, (Seams { edges: 12, open: 0 }, true));
    }
}
