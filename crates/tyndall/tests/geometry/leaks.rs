//! A ray that starts inside a closed mesh hits it, wherever it goes: at vertices and edges above all.

use rayon::prelude::*;
use tyndall::math::Vec3;
use tyndall::shape::Mesh;

use super::{
    meshes::{Random, at_seam, cube, displaced_sphere, moved, prism},
    of_mesh,
};

/// How many of `rays` from within `spread` of `centre` at vertices, edges, and anywhere miss the mesh around them.
fn leaks(mesh: &Mesh, centre: Vec3, spread: Vec3, rays: u64) -> usize {
    let geometry = of_mesh(mesh.clone());
    let missing = |i: u64| {
        let mut random = Random(i << 32);
        (0..1000)
            .filter(|k| {
                let origin = centre + random.in_ball() * spread;
                let mut ray = at_seam(mesh, origin, k % 2 == 1, &mut random);
                if k % 10 == 9 {
                    ray.dir = random.dir();
                }
                let any = k % 16 > 13; // the other search
                if any {
                    !geometry.occluded(&ray, f32::INFINITY)
                } else {
                    geometry.intersect(&ray, f32::INFINITY).is_none()
                }
            })
            .count()
    };
    (0..rays.div_ceil(1000)).into_par_iter().map(missing).sum()
}

#[test]
fn no_ray_leaves_a_bumpy_ball() {
    assert_eq!(leaks(&displaced_sphere(40, 0.05), Vec3::ZERO, Vec3::splat(0.8), 3_000_000), 0);
}

/// Triangles as large as the body: rounding displaces their corners most.
#[test]
fn no_ray_leaves_a_cube() {
    assert_eq!(leaks(&cube(), Vec3::ZERO, Vec3::splat(0.999), 2_000_000), 0);
}

/// Sides of length 314 and width 2π/2000: an aspect of 10⁵, and caps of needles that meet in one point.
#[test]
fn no_ray_leaves_a_prism_of_thin_triangles() {
    assert_eq!(leaks(&prism(2000, 314.0), Vec3::ZERO, Vec3::new(0.9, 0.9, 156.0), 2_000_000), 0);
}

/// At 10⁶ radii the coordinates of a ball of radius 1 are multiples of 1/16: many triangles have become lines and
/// points, but the surface is still closed.
#[test]
fn no_ray_leaves_a_ball_far_from_the_origin() {
    for offset in [1e4, 1e5, 1e6] {
        let centre = Vec3::new(offset, -0.7 * offset, 0.3 * offset);
        assert_eq!(leaks(&moved(displaced_sphere(20, 0.05), 1.0, centre), centre, Vec3::splat(0.5), 600_000), 0);
    }
}

/// Edges along the axes, rays along the axes: zero components and boxes without thickness.
#[test]
fn no_ray_along_an_axis_leaves_a_cube() {
    let geometry = of_mesh(cube());
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for dir in [axis, -axis] {
            for i in 0..81 {
                let origin = Vec3::new((i % 9) as f32, ((i / 9) % 9) as f32, ((i * 5) % 9) as f32) / 4.5 - 8.0 / 9.0;
                let hit = geometry.intersect(&tyndall::math::Ray::new(origin, dir), f32::INFINITY);
                assert!(hit.is_some(), "{origin} {dir}");
            }
        }
    }
}

/// Small and large bodies: nothing in the tests is measured against a constant.
#[test]
fn no_ray_leaves_a_ball_of_any_size() {
    for scale in [1e-6, 1e6] {
        let mesh = moved(displaced_sphere(20, 0.05), scale, Vec3::ZERO);
        assert_eq!(leaks(&mesh, Vec3::ZERO, Vec3::splat(0.8 * scale), 600_000), 0);
    }
}
