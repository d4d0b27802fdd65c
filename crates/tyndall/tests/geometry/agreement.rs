//! Hits agree with parry3d, with closed forms, and with searches that try everything.

use parry3d::query::RayCast;
use tyndall::math::{Ray, Transform, Vec2, Vec3};
use tyndall::shape::{
    Basis, Curves, Cylinder, Disk, Geometry, GeometryBuilder, Mesh, Patch, Sphere, SpherePart, Style, Turn,
};

use super::{
    affine,
    meshes::{Random, displaced_sphere},
    of_mesh,
    strands::{crooked, strand},
};

fn parry(v: Vec3) -> parry3d::math::Vector {
    parry3d::math::Vector::new(v.x, v.y, v.z)
}

/// Triangles without any order.
pub(super) fn soup(count: usize, size: f32, random: &mut Random) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..count as u32 {
        let at = random.in_ball();
        mesh.positions.extend([0; 3].map(|_| at + random.in_ball() * size));
        mesh.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// Rays at the edge of a triangle may be counted differently: parry3d is not watertight. So one in a thousand may
/// differ, and the rest must agree to 10⁻⁴.
#[test]
fn rays_hit_triangles_where_parry_says() {
    let random = &mut Random(1);
    for (count, size) in [(1, 1.0), (7, 0.8), (100, 0.3), (3000, 0.1)] {
        let mesh = soup(count, size, random);
        let theirs =
            parry3d::shape::TriMesh::new(mesh.positions.iter().map(|&p| parry(p)).collect(), mesh.indices.clone());
        let (theirs, ours) = (theirs.unwrap(), of_mesh(mesh));
        let mut differ = 0;
        for _ in 0..20_000 {
            let ray = Ray::new(random.in_ball() * 1.5, random.dir());
            let their_ray = parry3d::query::Ray::new(parry(ray.origin), parry(ray.dir));
            let t_max = if random.unit() < 0.5 { 1e9 } else { random.unit() };
            let theirs = theirs.cast_local_ray(&their_ray, t_max, false);
            let ours = ours.intersect(&ray, t_max);
            let agree = match (theirs, ours) {
                (Some(a), Some(b)) => (a - b.t).abs() < 1e-4,
                (None, None) => true,
                _ => false,
            };
            differ += u32::from(!agree);
        }
        assert!(differ <= 20, "{differ} of 20000 rays differ for {count} triangles");
    }
}

/// `occluded` and `intersect` walk the tree in different orders, but ask the same question.
#[test]
fn what_is_hit_occludes() {
    let random = &mut Random(2);
    let geometry = everything(random);
    for _ in 0..50_000 {
        let ray = Ray::new(random.in_ball() * 2.0, random.dir());
        let t_max = random.unit() * 2.0;
        assert_eq!(geometry.occluded(&ray, t_max), geometry.intersect(&ray, t_max).is_some());
    }
}

/// Spheres, disks, cylinders, parts of them, patches, meshes, in the world and in groups.
pub(super) fn everything(random: &mut Random) -> Geometry {
    let mut builder = GeometryBuilder::new();
    for _ in 0..20 {
        let transform = random_affine(random, 0.2);
        builder.add_sphere(Sphere::new(random.in_ball(), 0.3), &transform, false).unwrap();
        builder.add_sphere(Sphere::new(random.in_ball(), 0.1), &Transform::IDENTITY, true).unwrap();
        builder.add_disk(Disk::new(0.1, 0.5, 0.2), &transform, false).unwrap();
        let half = Turn::degrees(180.0);
        builder.add_cylinder(Cylinder::new(0.2, [-0.3, 0.3], half), &transform, false).unwrap();
        let part = SpherePart::new(0.2, [-0.05, 0.1], half);
        builder.add_sphere(Sphere::new(random.in_ball(), 0.2).cut(part), &transform, false).unwrap();
        builder.add_patch(Patch::new([0; 4].map(|_| random.in_ball())), &transform, false).unwrap();
        for style in [Style::Flat, Style::Round] {
            builder.add_curves(strand(style, 5, 0.05, random), &Transform::IDENTITY).unwrap();
        }
        let mut straight = Curves::new(Style::Round);
        straight.push(Basis::Linear, &crooked(4, 0.03, random));
        builder.add_curves(straight, &Transform::IDENTITY).unwrap();
    }
    let group = builder.begin_group();
    builder.add_mesh(displaced_sphere(6, 0.1), &Transform::IDENTITY, false).unwrap();
    builder.add_sphere(Sphere::new(Vec3::X, 0.5), &Transform::IDENTITY, false).unwrap();
    builder.add_disk(Disk::new(1.5, 0.5, 0.0), &Transform::IDENTITY, false).unwrap();
    builder.add_curves(strand(Style::Round, 4, 0.1, random), &Transform::IDENTITY).unwrap();
    builder.add_cylinder(Cylinder::new(0.4, [-0.3, 0.8], Turn::FULL), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    let ball = builder.begin_group();
    builder.add_sphere(Sphere::new(Vec3::Y, 0.5), &Transform::IDENTITY, false).unwrap();
    let cap = SpherePart::new(0.5, [0.2, 0.5], Turn::FULL);
    builder.add_sphere(Sphere::new(Vec3::X, 0.5).cut(cap), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    for _ in 0..20 {
        let transform = random_affine(random, 0.1);
        builder.add_instance(group, &transform).unwrap();
        builder.add_instance(ball, &transform).unwrap();
        builder
            .add_instance(ball, &affine([[0.0, 0.1, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]], [0.5, 0.0, 0.5]))
            .unwrap();
    }
    builder.build().unwrap()
}

/// A random map with stretches around `scale`, mirroring every other time.
pub(super) fn random_affine(random: &mut Random, scale: f32) -> Transform {
    loop {
        let columns = [0; 3].map(|_| ((random.dir() + random.in_ball() * 0.5) * scale).to_array().map(f64::from));
        let translation = random.in_ball().to_array().map(f64::from);
        let transform = affine(columns, translation);
        if transform.least_stretch() > 0.2 * scale {
            return transform;
        }
    }
}

/// The roots of the quadratic in its plainest form, where it is well conditioned.
#[test]
fn rays_hit_a_sphere_where_the_quadratic_says() {
    let random = &mut Random(3);
    let (centre, radius) = (Vec3::new(0.3, -0.2, 0.5), 0.7);
    let geometry = super::of_sphere(centre, radius);
    for _ in 0..100_000 {
        let ray = Ray::new(random.in_ball() * 2.0, random.dir());
        let from = (ray.origin - centre).as_dvec3();
        let dir = ray.dir.as_dvec3().normalize();
        let b = from.dot(dir);
        let d = b * b - from.length_squared() + f64::from(radius) * f64::from(radius);
        let expected = [-b - d.sqrt(), -b + d.sqrt()].into_iter().find(|&t| t > 0.0);
        if d.abs() < 1e-6 {
            continue; // tangents may be counted either way: the direction is rounded
        }
        let hit = geometry.intersect(&ray, f32::INFINITY);
        assert_eq!(hit.is_some(), expected.is_some());
        if let (Some(hit), Some(expected)) = (hit, expected) {
            assert!((f64::from(hit.t) - expected).abs() < 1e-5 / d.sqrt());
            let point = geometry.interaction(&ray, &hit);
            assert!((point.p - ray.at(hit.t)).length() < 2e-6 / d.sqrt() as f32);
            assert!((point.ng - (point.p - centre) / radius).length() < 1e-6);
        }
    }
}

/// A sphere of radius 1 seen from 10⁶ radii: half of the rays at the disk of radius √2 hit it.
#[test]
fn a_small_sphere_far_away_keeps_its_shape() {
    let random = &mut Random(4);
    let geometry = super::of_sphere(Vec3::ZERO, 1.0);
    for _ in 0..20_000 {
        let origin = random.dir() * 1e6;
        let target = random.in_ball() * 1.5;
        let ray = Ray::new(origin, (target - origin).normalize());
        let (from, dir) = (origin.as_dvec3(), ray.dir.as_dvec3().normalize());
        let miss = (from - dir * from.dot(dir)).length();
        if (miss - 1.0).abs() < 1e-6 {
            continue;
        }
        assert_eq!(geometry.intersect(&ray, f32::INFINITY).is_some(), miss < 1.0);
    }
}

/// A quarter of the rays through the square around a disk miss it; the ring leaves out its hole. In local
/// coordinates the hit is `z = height` and `inner ≤ |(x, y)| ≤ radius`, whatever the transform.
#[test]
fn rays_hit_a_disk_where_the_plane_says() {
    let random = &mut Random(5);
    for _ in 0..50 {
        let transform = random_affine(random, 1.0);
        let mut builder = GeometryBuilder::new();
        builder.add_disk(Disk::new(0.3, 0.8, 0.2), &transform, false).unwrap();
        let geometry = builder.build().unwrap();
        for _ in 0..2000 {
            let ray = Ray::new(random.in_ball() * 3.0, random.dir());
            let local = transform.ray_to_local(&ray);
            let t = (0.3 - local.origin.z) / local.dir.z;
            let r = local.at(t).truncate().length();
            let near_edge = (r - 0.8).abs() < 1e-4 || (r - 0.2).abs() < 1e-4 || t.abs() < 1e-4 || t > 1e3;
            if near_edge {
                continue;
            }
            let hit = geometry.intersect(&ray, f32::INFINITY);
            assert_eq!(hit.is_some(), t > 0.0 && (0.2..=0.8).contains(&r));
            if let Some(hit) = hit {
                let point = geometry.interaction(&ray, &hit);
                assert!((hit.t - t).abs() < 1e-4 * (1.0 + t), "{} {t}", hit.t);
                assert!(point.ng.dot(transform.normal(Vec3::Z)) > 0.0);
                assert!((point.p - ray.at(hit.t)).length() < 1e-5 * (1.0 + t));
            }
        }
    }
}

/// The patch as 2·64² triangles: hits agree to the size of their deviation.
#[test]
fn rays_hit_a_patch_where_its_triangles_are() {
    const N: u32 = 64;
    let random = &mut Random(6);
    for _ in 0..10 {
        let corners = [0; 4].map(|_| random.in_ball());
        let at = |u: f32, v: f32| corners[0].lerp(corners[1], u).lerp(corners[2].lerp(corners[3], u), v);
        let mut mesh = Mesh::default();
        for i in 0..=N * (N + 2) {
            mesh.positions.push(at((i % (N + 1)) as f32 / N as f32, (i / (N + 1)) as f32 / N as f32));
        }
        for i in (0..N * (N + 1)).filter(|i| i % (N + 1) != N) {
            mesh.indices.extend([[i, i + 1, i + N + 2], [i, i + N + 2, i + N + 1]]);
        }
        let mut builder = GeometryBuilder::new();
        builder.add_patch(Patch::new(corners), &Transform::IDENTITY, false).unwrap();
        let (patch, mesh) = (builder.build().unwrap(), of_mesh(mesh));
        let mut differ = 0;
        for _ in 0..5000 {
            let target = at(random.unit(), random.unit());
            let origin = random.in_ball() * 2.0;
            let ray = Ray::new(origin, (target - origin).normalize());
            let (a, b) = (patch.intersect(&ray, f32::INFINITY), mesh.intersect(&ray, f32::INFINITY));
            let agree = match (a, b) {
                (Some(a), Some(b)) => {
                    let (p, q) = (patch.interaction(&ray, &a), mesh.interaction(&ray, &b));
                    assert!((p.p - ray.at(a.t)).length() < 1e-5);
                    (p.p - q.p).length() < 1e-2 && p.ng.dot(q.ng) > 0.9
                }
                (a, b) => a.is_none() && b.is_none(),
            };
            differ += u32::from(!agree);
        }
        // Silhouettes of the 8192 triangles are not those of the patch.
        assert!(differ < 250, "{differ} of 5000 rays differ");
    }
}

/// A flat patch is a mesh of two triangles with the parameters of the patch.
#[test]
fn a_parallelogram_has_the_parameters_of_its_patch() {
    let random = &mut Random(7);
    let transform = random_affine(random, 1.0);
    let mut builder = GeometryBuilder::new();
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
    let object = builder.add_patch(Patch::new(corners), &transform, false).unwrap();
    let geometry = builder.build().unwrap();
    assert!(geometry.triangle(object, 1).is_some());
    for _ in 0..1000 {
        let uv = Vec2::new(random.unit(), random.unit()) * 0.98 + 0.01;
        let target = transform.point(uv.extend(0.0));
        let origin = random.in_ball() * 3.0;
        let ray = Ray::new(origin, (target - origin).normalize());
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY) else { panic!("missed {uv}") };
        let point = geometry.interaction(&ray, &hit);
        assert!((point.uv.get() - uv).length() < 1e-3, "{} {uv}", point.uv.get());
        assert!(point.ng.dot(transform.normal(Vec3::Z)) > 0.0);
        assert!((point.dpdu - transform.vector(Vec3::X)).length() < 1e-4);
    }
}

/// An instance of a group is the group's shapes, transformed one by one: same hits, normals and parameters.
#[test]
fn an_instance_is_its_shapes_transformed() {
    let random = &mut Random(8);
    for mirrored in [false, true] {
        let mut transform = random_affine(random, 0.5);
        while transform.mirrors() != mirrored {
            transform = random_affine(random, 0.5);
        }
        let add = |builder: &mut GeometryBuilder, t: &Transform| {
            builder.add_mesh(displaced_sphere(8, 0.1), t, false).unwrap();
            builder.add_sphere(Sphere::new(Vec3::X * 2.0, 0.5), t, true).unwrap();
            builder.add_disk(Disk::new(1.5, 0.5, 0.0), t, false).unwrap();
            builder.add_cylinder(Cylinder::new(0.3, [-3.0, -2.0], Turn::degrees(200.0)), t, true).unwrap();
            let part = SpherePart::new(0.5, [-0.3, 0.4], Turn::degrees(300.0));
            builder.add_sphere(Sphere::new(Vec3::Y * 2.0, 0.5).cut(part), t, false).unwrap();
            builder.add_patch(Patch::new([Vec3::Y * -2.0, Vec3::X, Vec3::Z, -Vec3::ONE]), t, false).unwrap();
        };
        let mut placed = GeometryBuilder::new();
        add(&mut placed, &transform);
        let placed = placed.build().unwrap();
        let mut instanced = GeometryBuilder::new();
        let group = instanced.begin_group();
        add(&mut instanced, &Transform::IDENTITY);
        instanced.end_group();
        instanced.add_instance(group, &transform).unwrap();
        let instanced = instanced.build().unwrap();
        let (mut differ, mut hits) = (0, 0);
        for _ in 0..20_000 {
            let ray = Ray::new(random.in_ball() * 2.0, random.dir());
            let (a, b) = (placed.intersect(&ray, f32::INFINITY), instanced.intersect(&ray, f32::INFINITY));
            let (Some(a), Some(b)) = (a, b) else {
                differ += u32::from(a.is_some() || b.is_some());
                continue;
            };
            hits += 1;
            if a.object != b.object || (a.t - b.t).abs() > 1e-4 {
                differ += 1;
                continue;
            }
            let (p, q) = (placed.interaction(&ray, &a), instanced.interaction(&ray, &b));
            assert_eq!(b.instance, 0);
            assert!((p.p - q.p).length() < 1e-5 * (1.0 + a.t), "{p:?} {q:?}");
            assert!((p.ng - q.ng).length() < 2e-2 || a.prim != b.prim, "{p:?} {q:?}");
            let parameters = (p.uv.get() - q.uv.get()).length() < 1e-2
                || a.prim != b.prim
                || (p.uv.get().x - q.uv.get().x).abs() > 0.98;
            assert!(parameters, "{p:?} {q:?}");
        }
        assert!(hits > 1000 && differ < 20, "{differ} of {hits} hits differ");
    }
}

/// Normals point out of the mesh by its winding, into it if the orientation is reversed, also after mirroring; the
/// shading normal follows.
#[test]
fn normals_point_outward_and_reversed_ones_inward() {
    let random = &mut Random(9);
    for i in 0..16 {
        let transform = random_affine(random, 1.0);
        let reversed = i % 2 == 1;
        let mut mesh = displaced_sphere(5, 0.0);
        if i % 4 < 2 {
            mesh.normals.clone_from(&mesh.positions);
        }
        let mut builder = GeometryBuilder::new();
        if i % 3 == 0 {
            builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &transform, reversed).unwrap();
        } else {
            builder.add_mesh(mesh, &transform, reversed).unwrap();
        }
        let geometry = builder.build().unwrap();
        for _ in 0..100 {
            let ray = Ray::new(transform.point(Vec3::ZERO), random.dir());
            let hit = geometry.intersect(&ray, f32::INFINITY).unwrap();
            let point = geometry.interaction(&ray, &hit);
            assert_eq!(point.ng.dot(ray.dir) > 0.0, !reversed);
            assert!(point.ns.dot(point.ng) >= 0.0 && (point.ns.length() - 1.0).abs() < 1e-6);
            let frame = point.shading_frame();
            assert!((frame.s.cross(frame.t) - frame.n).length() < 1e-5);
        }
    }
}

/// A thousand balls: the nearest by trying all of them.
#[test]
fn among_many_balls_the_nearest_is_hit() {
    let random = &mut Random(10);
    let mut builder = GeometryBuilder::new();
    let balls: Vec<(Vec3, f32)> = (0..1000).map(|_| (random.in_ball(), 0.05 * random.unit() + 1e-3)).collect();
    for &(centre, radius) in &balls {
        builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, false).unwrap();
    }
    let geometry = builder.build().unwrap();
    let alone: Vec<Geometry> = balls.iter().map(|&(centre, radius)| super::of_sphere(centre, radius)).collect();
    for _ in 0..2000 {
        let ray = Ray::new(random.in_ball() * 1.2, random.dir());
        let one = |ball: &Geometry| ball.intersect(&ray, f32::INFINITY).map_or(f32::INFINITY, |hit| hit.t);
        let expected = alone.iter().map(one).fold(f32::INFINITY, f32::min);
        assert_eq!(geometry.intersect(&ray, f32::INFINITY).map_or(f32::INFINITY, |hit| hit.t), expected);
    }
}
