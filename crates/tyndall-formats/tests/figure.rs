//! The marble figure of `scenes/marble`: what is shipped is what `examples/make_figure` makes, and it is closed.

#[path = "../examples/make_figure/figure.rs"]
mod figure;
#[path = "../examples/make_figure/nets.rs"]
mod nets;
#[path = "../examples/make_figure/solids.rs"]
mod solids;

use std::{collections::HashMap, path::Path};

use glam::DVec3;
use tyndall_formats::mesh::{TriangleMesh, read_ply};

fn shipped() -> TriangleMesh {
    read_ply(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/marble/figure.ply")).unwrap()
}

/// By how much more often each edge is run along than against; none is left of a closed mesh.
fn open_edges(mesh: &TriangleMesh) -> usize {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    for [a, b, c] in &mesh.indices {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *balance.entry((*from.min(to), *from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    balance.values().filter(|&&times| times != 0).count()
}

/// Sines, cosines and arc tangents of other machines may differ in their last bit, and no other bit of the mesh.
#[test]
fn the_figure_that_is_shipped_is_the_one_that_the_example_makes() {
    let (shipped, made) = (shipped(), nets::surface(figure::distance, &figure::planes()));
    assert_eq!(shipped.indices, made.indices);
    assert_eq!(shipped.positions.len(), made.positions.len());
    for (a, b) in shipped.positions.iter().zip(&made.positions) {
        assert!(a.distance(*b) < 1e-4, "{a} in the file, {b} made");
    }
}

/// A renderer of pbrt scenes turns round what is wound against its normals, and would open it.
#[test]
fn the_figure_is_closed_and_wound_along_its_normals() {
    let mesh = shipped();
    assert_eq!(open_edges(&mesh), 0);
    let normals = mesh.normals.unwrap();
    for (i, triangle) in mesh.indices.iter().enumerate() {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        let normal = triangle.map(|i| normals[i as usize]).into_iter().sum();
        assert!((b - a).cross(c - a).dot(normal) > 0.0, "triangle {i} at {a}");
    }
}

/// Whatever passes through a cell: nodes are inside or outside by chance, so that all ways in which a surface can pass
/// through cells and through the faces between them occur many times.
#[test]
fn nets_are_closed_however_a_surface_passes_through_cells() {
    let field = |p: DVec3| {
        let hash = p.round().to_array().into_iter().fold(0x9e37_79b9_u32, |h, x| {
            let h = (h ^ x as u32).wrapping_mul(0x85eb_ca6b);
            h ^ h >> 15
        });
        let at_rim = p.min_element() < 0.5 || p.max_element() > 22.5;
        if at_rim || hash & 0x100 == 0 { 1.0 } else { -1.0 }
    };
    let planes = std::array::from_fn(|_| (0..24).map(f64::from).collect());
    let mesh = nets::surface(field, &planes);
    assert!(mesh.indices.len() > 10_000, "{} triangles", mesh.indices.len());
    assert_eq!(open_edges(&mesh), 0);
}

/// An ellipsoid has the volume 4π/3 abc. Its vertices lie on it, so its triangles lie inside by about h²/8R: with h/R = 1/15
/// at most, the volume is less by no more than 3 (h/R)²/8 of itself, and it is less.
#[test]
fn nets_of_an_ellipsoid_enclose_its_volume() {
    let radii = DVec3::new(20.0, 15.0, 18.0);
    let planes = std::array::from_fn(|_| (-25..=25).map(f64::from).collect());
    let mesh = nets::surface(|p| solids::ellipsoid(p, DVec3::splat(0.3), radii), &planes);
    let volume: f64 = mesh
        .indices
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    let short = 1.0 - volume / (4.0 / 3.0 * std::f64::consts::PI * radii.element_product());
    assert!(short > 0.0 && short < 3.0 / 8.0 / 225.0, "{short:e} of the volume is missing");
}
