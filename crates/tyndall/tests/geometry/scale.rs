//! Lengths have no scale: a scene that is scaled gives scaled answers.

use tyndall::math::{Ray, Vec3};
use tyndall::shape::Geometry;

use tyndall::math::Transform;
use tyndall::shape::{Cylinder, GeometryBuilder, Sphere, SpherePart, Turn};

use super::{
    meshes::{Random, displaced_sphere, moved},
    of_mesh, of_sphere,
};

/// By a power of two the rounding is the same too: all answers are scaled bit by bit.
#[test]
fn a_scene_scaled_by_a_power_of_two_gives_the_same_bits() {
    for power in [-20, 20] {
        let scale = 2f32.powi(power);
        let ball = |s: f32| of_mesh(moved(displaced_sphere(30, 0.1), s, Vec3::ZERO));
        for (unit, scaled) in [
            (ball(1.0), ball(scale)),
            (of_sphere(Vec3::X, 0.7), of_sphere(Vec3::X * scale, 0.7 * scale)),
            (open(1.0), open(scale)),
        ] {
            same(&unit, &scaled, scale, 0.0);
        }
    }
}

/// By a power of ten the coordinates are rounded anew, and hits move by that much.
#[test]
fn a_scene_scaled_by_a_million_gives_the_same_hits() {
    for scale in [1e-6, 1e6] {
        let ball = |s: f32| of_mesh(moved(displaced_sphere(30, 0.1), s, Vec3::ZERO));
        same(&ball(1.0), &ball(scale), scale, 1e-4);
        same(&of_sphere(Vec3::X, 0.7), &of_sphere(Vec3::X * scale, 0.7 * scale), scale, 1e-4);
        same(&open(1.0), &open(scale), scale, 1e-4);
    }
}

/// A cylinder and a part of a sphere.
fn open(scale: f32) -> Geometry {
    let mut builder = GeometryBuilder::new();
    let cylinder = Cylinder::new(0.4 * scale, [-0.5 * scale, 0.7 * scale], Turn::degrees(250.0));
    builder.add_cylinder(cylinder, &Transform::IDENTITY, false).unwrap();
    let part = SpherePart::new(0.8, [-0.5, 0.3], Turn::degrees(200.0));
    builder.add_sphere(Sphere::new(Vec3::Y * scale, 0.8 * scale).cut(part), &Transform::IDENTITY, false).unwrap();
    builder.build().unwrap()
}

fn same(unit: &Geometry, scaled: &Geometry, scale: f32, tolerance: f32) {
    let random = &mut Random(40);
    let mut hits = 0;
    for _ in 0..10_000 {
        let ray = Ray::new(random.in_ball() * 1.5, random.dir());
        let other = Ray::new(ray.origin * scale, ray.dir);
        let (a, b) = (unit.intersect(&ray, 2.0), scaled.intersect(&other, 2.0 * scale));
        if let (Some(a), Some(b)) = (a, b) {
            hits += 1;
            assert!((a.t - b.t / scale).abs() <= tolerance, "{a:?} {b:?}");
            let (p, q) = (unit.interaction(&ray, &a), scaled.interaction(&other, &b));
            assert!((p.error - q.error / scale).length() <= tolerance * 1e-3, "{p:?} {q:?}");
        } else {
            assert_eq!(a.is_some(), b.is_some());
        }
        let (a, b) = (unit.clearance(ray.origin, 1.0), scaled.clearance(other.origin, scale));
        assert!((a - b / scale).abs() <= tolerance.max(1e-6), "{a} {b}");
    }
    assert!(hits > 1000);
}
