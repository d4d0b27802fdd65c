//! The surface of a solid as a mesh: surface nets (Gibson 1998) over a grid whose planes need not be evenly spaced.
//!
//! Each patch of the surface in a cell has one vertex: the mean of where the patch crosses the edges of the cell, then
//! moved onto the surface along the gradient, but not quite to the rim of its cell, so that no two meet. Each edge of the grid that crosses the surface has one quadrilateral, between
//! the four cells around it. Patches are told apart by the faces of the cell: where all four edges of one cross, its inner
//! corners are kept apart, and the cell behind that face sees the same. So the mesh is closed, even where both sides of a
//! sheet pass through one cell, wherever the solid does not reach the rim of the grid.

use std::collections::HashMap;

use glam::{DVec3, UVec3};
use tyndall_formats::mesh::TriangleMesh;

/// Steps of Newton's method.
const STEPS: usize = 4;
/// Over what length differences are taken for a gradient [mm].
const DIFFERENCE: f64 = 0.05;

/// Where the planes of the grid are, along each axis [mm].
pub(crate) type Planes = [Vec<f64>; 3];

/// The surface of what `distance` is negative in.
pub(crate) fn surface(distance: impl Fn(DVec3) -> f64, planes: &Planes) -> TriangleMesh {
    let n = UVec3::from_array([0, 1, 2].map(|axis| planes[axis].len() as u32));
    let at = |i: UVec3| DVec3::new(planes[0][i.x as usize], planes[1][i.y as usize], planes[2][i.z as usize]);
    let nodes = (0..n.z).flat_map(|z| (0..n.y).flat_map(move |y| (0..n.x).map(move |x| UVec3::new(x, y, z))));
    let values: Vec<f64> = nodes.clone().map(|i| distance(at(i))).collect();
    let value = |i: UVec3| values[((i.z * n.y + i.y) * n.x + i.x) as usize];

    let mut mesh = TriangleMesh::default();
    // The vertex of each edge of each cell that the surface passes.
    let mut vertices_of: HashMap<UVec3, [u32; 12]> = HashMap::new();
    for cell in nodes.clone().filter(|i| i.cmplt(n - 1).all()) {
        let inside: [bool; 8] = std::array::from_fn(|corner| value(cell + offset(corner)) < 0.0);
        if inside == [inside[0]; 8] {
            continue;
        }
        let patches = patches(inside);
        let mut vertices = [0; 12];
        for patch in 0..12 {
            let edges = (0..12).filter(|&edge| patches[edge] == Some(patch));
            let crossings = edges.clone().map(|edge| {
                let [a, b] = ends(edge).map(|corner| cell + offset(corner));
                at(a).lerp(at(b), value(a) / (value(a) - value(b)))
            });
            let (sum, count) = crossings.fold((DVec3::ZERO, 0.0), |(sum, count), p| (sum + p, count + 1.0));
            if count > 0.0 {
                edges.for_each(|edge| vertices[edge] = mesh.positions.len() as u32);
                let room = [0.02, 0.98].map(|s| at(cell).lerp(at(cell + 1), s));
                mesh.positions.push(settle(&distance, sum / count, room).as_vec3());
            }
        }
        vertices_of.insert(cell, vertices);
    }
    for a in nodes {
        for axis in 0..3 {
            let [along, u, v] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|axis| offset(1 << axis));
            let b = a + along;
            if b.cmpge(n).any() || (value(a) < 0.0) == (value(b) < 0.0) {
                continue;
            }
            // Around the edge, anticlockwise seen from its end, and which of the cell's edges it is.
            let mut around = [(u + v, 3), (v, 2), (UVec3::ZERO, 0), (u, 1)]
                .map(|(back, place)| vertices_of[&(a - back)][4 * axis + place]);
            if value(b) < 0.0 {
                around.reverse();
            }
            let [p, q, r, s] = around;
            let length = |i: u32, j: u32| mesh.positions[i as usize].distance_squared(mesh.positions[j as usize]);
            // The shorter diagonal.
            mesh.indices.extend(if length(p, r) < length(q, s) {
                [[p, q, r], [p, r, s]]
            } else {
                [[p, q, s], [q, r, s]]
            });
        }
    }
    mesh.normals = Some(mesh.smooth_normals());
    mesh
}

/// Where a corner of a cell is: a bit for each axis.
fn offset(corner: usize) -> UVec3 {
    UVec3::new(corner as u32 & 1, corner as u32 >> 1 & 1, corner as u32 >> 2)
}

/// The corners that an edge of a cell joins: four edges along each axis, by where they are along the next two.
fn ends(edge: usize) -> [usize; 2] {
    let [axis, u, v] = [0, 1, 2].map(|i| (edge / 4 + i) % 3);
    let start = (edge & 1) << u | (edge >> 1 & 1) << v;
    [start, start | 1 << axis]
}

/// Which patch of the surface crosses each edge of a cell, by the number of one of its edges.
fn patches(inside: [bool; 8]) -> [Option<usize>; 12] {
    let mut patches: [Option<usize>; 12] = std::array::from_fn(|edge| {
        let [a, b] = ends(edge);
        (inside[a] != inside[b]).then_some(edge)
    });
    let unite = |patches: &mut [Option<usize>; 12], edges: &[usize]| {
        if let &[p, q] = edges {
            let (old, new) = (patches[p], patches[q]);
            patches.iter_mut().filter(|patch| **patch == old).for_each(|patch| *patch = new);
        }
    };
    for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
        let of_face = |corner: usize| corner >> axis & 1 == side;
        let crossing: Vec<_> =
            (0..12).filter(|&edge| ends(edge).into_iter().all(of_face) && patches[edge].is_some()).collect();
        unite(&mut patches, &crossing);
        if crossing.len() == 4 {
            for corner in (0..8).filter(|&corner| of_face(corner) && inside[corner]) {
                let edges: Vec<_> = crossing.iter().copied().filter(|&edge| ends(edge).contains(&corner)).collect();
                unite(&mut patches, &edges);
            }
        }
    }
    patches
}

/// A point near the surface moved onto it, but not out of a box.
fn settle(distance: impl Fn(DVec3) -> f64, mut p: DVec3, [low, high]: [DVec3; 2]) -> DVec3 {
    let gradient = |p: DVec3| {
        DVec3::from_array([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let step = axis * DIFFERENCE;
            (distance(p + step) - distance(p - step)) / (2.0 * DIFFERENCE)
        }))
    };
    for _ in 0..STEPS {
        let g = gradient(p);
        p = (p - g * (distance(p) / g.length_squared().max(0.1))).clamp(low, high);
    }
    p
}
