//! Rays that leave a surface do not meet it again at once, and rays between surfaces are free.

use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Geometry, GeometryBuilder, Interaction, Mesh, Sphere};

use super::{
    affine,
    agreement::random_affine,
    meshes::{Random, cube, displaced_sphere, moved},
    of_mesh, of_sphere,
};

/// Convex bodies around the origin with radius about 1, and the factor by which they can be scaled and moved.
fn bodies(scale: f32, offset: Vec3) -> Vec<Geometry> {
    let instanced = |mesh: Option<Mesh>, transform: &Transform| {
        let mut builder = GeometryBuilder::new();
        let group = builder.begin_group();
        match mesh {
            Some(mesh) => builder.add_mesh(mesh, &Transform::IDENTITY, false),
            None => builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false),
        }
        .unwrap();
        builder.end_group();
        builder.add_instance(group, transform).unwrap();
        builder.build().unwrap()
    };
    let s = f64::from(scale);
    let t = offset.to_array().map(f64::from);
    let uneven = affine([[s, 0.5 * s, 0.0], [0.0, 0.7 * s, 0.2 * s], [0.1 * s, 0.0, 0.4 * s]], t);
    let even = affine([[0.0, s, 0.0], [s, 0.0, 0.0], [0.0, 0.0, s]], t);
    vec![
        of_sphere(offset, scale),
        of_mesh(moved(displaced_sphere(30, 0.0), scale, offset)),
        of_mesh(moved(cube(), scale, offset)),
        instanced(Some(displaced_sphere(30, 0.0)), &uneven),
        instanced(Some(cube()), &uneven),
        instanced(None, &uneven),
        instanced(None, &even),
    ]
}

/// A random point of the surface, seen from inside.
fn surface_point(body: &Geometry, centre: Vec3, random: &mut Random) -> Interaction {
    let ray = Ray::new(centre, random.dir());
    let hit = body.intersect(&ray, f32::INFINITY).unwrap();
    body.interaction(&ray, &hit)
}

fn places() -> impl Iterator<Item = (f32, Vec3)> {
    let offsets = [Vec3::ZERO, Vec3::new(3.0, -2.0, 1.0), Vec3::new(500.0, 100.0, -300.0)];
    [1e-6, 1.0, 1e6].into_iter().flat_map(move |scale| offsets.map(|offset| (scale, offset * scale)))
}

/// A body is convex, so a ray that leaves it to the outside never meets it again. (The tesselated ball is convex but
/// for the rounding of its vertices: two neighbours may form a dent of that size, so rays closer to the surface than
/// that are left out.)
#[test]
fn rays_that_leave_a_convex_body_do_not_meet_it_again() {
    let random = &mut Random(20);
    for (scale, offset) in places() {
        for (i, body) in bodies(scale, offset).iter().enumerate() {
            for _ in 0..5000 {
                let point = surface_point(body, offset, random);
                let dir = random.dir();
                let dir = if dir.dot(point.ng) < 0.0 { -dir } else { dir };
                if dir.dot(point.ng) < 1e-3 {
                    continue;
                }
                let hit = body.intersect(&point.spawn(dir), f32::INFINITY);
                assert!(hit.is_none(), "body {i} scale {scale} offset {offset}: {point:?} {dir} {hit:?}");
            }
        }
    }
}

/// Inwards, the ray meets the far side: not the point it left, and never nothing.
#[test]
fn rays_that_enter_a_convex_body_meet_its_far_side() {
    let random = &mut Random(21);
    for (scale, offset) in places() {
        for (i, body) in bodies(scale, offset).iter().enumerate() {
            for _ in 0..5000 {
                let point = surface_point(body, offset, random);
                let dir = random.dir();
                let dir = if dir.dot(point.ng) > 0.0 { -dir } else { dir };
                let Some(hit) = body.intersect(&point.spawn(dir), f32::INFINITY) else {
                    panic!("body {i} scale {scale} offset {offset}: {point:?} {dir} leaks");
                };
                let far = body.interaction(&point.spawn(dir), &hit);
                let another = far.prim != point.prim || hit.t > -0.1 * dir.dot(point.ng) * scale;
                assert!(another, "body {i} scale {scale} offset {offset}: {point:?} {dir} {hit:?}");
            }
        }
    }
}

/// Two points of the surface of a convex body see each other from inside.
#[test]
fn shadow_rays_inside_a_convex_body_are_free() {
    let random = &mut Random(22);
    for (scale, offset) in places() {
        for (i, body) in bodies(scale, offset).iter().enumerate() {
            for _ in 0..5000 {
                let (a, b) = (surface_point(body, offset, random), surface_point(body, offset, random));
                let between = b.p - a.p;
                let slope = (-a.ng.dot(between)).min(b.ng.dot(between)) / between.length();
                if between.length() < 0.01 * scale || slope < 0.01 {
                    continue;
                }
                let (ray, t_max) = a.spawn_to(&b).unwrap();
                let hit = body.intersect(&ray, t_max);
                assert!(hit.is_none(), "body {i} scale {scale} offset {offset}: {a:?} {b:?} {hit:?}");
            }
        }
    }
}

/// A light far away, a receiver that is small: the distance is rounded by more than the receiver's error.
#[test]
fn shadow_rays_from_far_away_do_not_overshoot() {
    let random = &mut Random(23);
    let mut builder = GeometryBuilder::new();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 1e-3), &Transform::IDENTITY, false).unwrap();
    builder.add_sphere(Sphere::new(Vec3::X * 1e4, 10.0), &Transform::IDENTITY, false).unwrap();
    let geometry = builder.build().unwrap();
    for _ in 0..20_000 {
        let aim = |target: Vec3, from: Vec3| Ray::new(from, (target - from).normalize());
        let to_small = aim(random.in_ball() * 0.9e-3, Vec3::X * 5000.0);
        let to_large = aim(Vec3::X * 1e4 + random.in_ball() * 9.0, Vec3::X * 5000.0);
        let [small, large] = [to_small, to_large].map(|ray| {
            let hit = geometry.intersect(&ray, f32::INFINITY).unwrap();
            geometry.interaction(&ray, &hit)
        });
        for (a, b) in [(small, large), (large, small)] {
            let (ray, t_max) = a.spawn_to(&b).unwrap();
            assert!(!geometry.occluded(&ray, t_max), "{a:?} {b:?}");
            let (ray, t_max) = a.spawn_to_point(Vec3::new(5000.0, 3.0, 4.0)).unwrap();
            assert!(!geometry.occluded(&ray, t_max));
        }
    }
}

/// `error` is a bound: the true surface lies within it. On a sphere `||p − c| − r| ≤ |n|·error`.
#[test]
fn the_point_is_within_its_error_of_the_surface() {
    let random = &mut Random(24);
    for (scale, offset) in places() {
        let sphere = of_sphere(offset, scale);
        let transform = random_affine(random, scale);
        let mut builder = GeometryBuilder::new();
        let cube = builder.add_mesh(cube(), &transform, false).unwrap();
        let cube_geometry = builder.build().unwrap();
        for _ in 0..5000 {
            let point = surface_point(&sphere, offset, random);
            let off = ((point.p - offset).as_dvec3().length() - f64::from(scale)).abs();
            let off = if offset == Vec3::ZERO {
                off
            } else {
                ((point.p.as_dvec3() - offset.as_dvec3()).length() - f64::from(scale)).abs()
            };
            assert!(off <= f64::from(point.ng.abs().dot(point.error)), "{off} {point:?}");

            let point = surface_point(&cube_geometry, transform.point(Vec3::ZERO), random);
            let [a, b, c] = cube_geometry.triangle(cube, point.prim).unwrap().map(Vec3::as_dvec3);
            let n = (b - a).cross(c - a).normalize();
            let off = n.dot(point.p.as_dvec3() - a).abs();
            assert!(off <= f64::from(point.ng.abs().dot(point.error)), "{off} {point:?}");
        }
    }
}
