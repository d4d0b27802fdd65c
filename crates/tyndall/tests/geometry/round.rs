//! Cylinders, and parts of spheres and disks: rays hit them where their equations say, and leave them for good.

use glam::DVec3;
use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Cylinder, Disk, Geometry, GeometryBuilder, Sphere, SpherePart, Turn};

use super::{affine, agreement::random_affine, meshes::Random};

fn of(add: impl FnOnce(&mut GeometryBuilder)) -> Geometry {
    let mut builder = GeometryBuilder::new();
    add(&mut builder);
    builder.build().unwrap()
}

/// Azimuth from +x [degrees].
fn azimuth(p: DVec3) -> f64 {
    p.y.atan2(p.x).to_degrees().rem_euclid(360.0)
}

/// It is a close thing, and rounding decides.
struct Close;

/// The least positive of the distances at which the margin is positive.
fn expected(distances: [f64; 2], ray: (DVec3, DVec3), margin: impl Fn(DVec3) -> f64) -> Result<Option<f64>, Close> {
    let mut found = None;
    for t in distances {
        let margin = margin(ray.0 + ray.1 * t);
        if margin.abs() < 1e-4 || t.abs() < 1e-4 {
            return Err(Close);
        }
        if margin > 0.0 && t > 0.0 && found.is_none() {
            found = Some(t);
        }
    }
    Ok(found)
}

fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - 4.0 * a * c).sqrt();
    [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)]
}

/// In local coordinates a hit has `x² + y² = r²`, `low ≤ z ≤ high`, φ ≤ 200°, whatever the transform; its point is where
/// the ray is, its normal points away from the axis, `(u, v)` are φ/200° and the share of the height.
#[test]
fn rays_hit_a_cylinder_where_the_quadratic_says() {
    let random = &mut Random(50);
    let (radius, low, high) = (0.6, -0.4, 0.8);
    let mut hits = 0;
    for _ in 0..50 {
        let transform = random_affine(random, 1.0);
        let cylinder = Cylinder::new(radius as f32, [low as f32, high as f32], Turn::degrees(200.0));
        let geometry = of(|b| drop(b.add_cylinder(cylinder, &transform, false)));
        for _ in 0..2000 {
            let ray = Ray::new(random.in_ball() * 2.0, random.dir());
            let inverse = transform.matrix.as_dmat4().inverse();
            let (o, d) =
                (inverse.transform_point3(ray.origin.as_dvec3()), inverse.transform_vector3(ray.dir.as_dvec3()));
            let distances = quadratic(
                d.x * d.x + d.y * d.y,
                2.0 * (o.x * d.x + o.y * d.y),
                o.x * o.x + o.y * o.y - radius * radius,
            );
            let margin = |p: DVec3| (p.z - low).min(high - p.z).min((200.0 - azimuth(p)).min(azimuth(p)).to_radians());
            let hit = geometry.intersect(&ray, f32::INFINITY);
            if distances[0].is_nan() {
                assert!(hit.is_none());
                continue;
            }
            let Ok(expected) = expected(distances, (o, d), margin) else { continue };
            assert_eq!(hit.is_some(), expected.is_some(), "{ray:?} {distances:?}");
            let (Some(hit), Some(t)) = (hit, expected) else { continue };
            hits += 1;
            assert!((f64::from(hit.t) - t).abs() < 1e-6 * (1.0 + t), "{} {t}", hit.t);
            let point = geometry.interaction(&ray, &hit);
            let local = o + d * t;
            assert!((point.p.as_dvec3() - ray.origin.as_dvec3() - ray.dir.as_dvec3() * t).length() < 1e-6 * (1.0 + t));
            let away = transform.normal(Vec3::new(local.x as f32, local.y as f32, 0.0)).normalize();
            assert!((point.ng - away).length() < 1e-4, "{} {away}", point.ng);
            assert!((f64::from(point.uv.get().x) - azimuth(local) / 200.0).abs() < 1e-4);
            assert!((f64::from(point.uv.get().y) - (local.z - low) / (high - low)).abs() < 1e-4);
            // ∂p/∂u runs round the axis: across it, at right angles to the radius, 200° for a whole u.
            let around = DVec3::new(-local.y, local.x, 0.0) * 200f64.to_radians();
            let around = transform.vector(around.as_vec3());
            assert!((point.dpdu - around).length() < 1e-4 * around.length(), "{} {around}", point.dpdu);
        }
    }
    assert!(hits > 5000, "{hits}");
}

/// What is missing of a sphere is not hit, and what is behind it is.
#[test]
fn rays_hit_a_part_of_a_sphere_where_the_whole_sphere_is() {
    let random = &mut Random(51);
    let centre = Vec3::new(0.1, -0.2, 0.3);
    let mut hits = 0;
    for i in 0..40 {
        // Similarities, and maps that the world sees as ellipsoids.
        let transform = if i % 2 == 0 {
            affine([[0.0, 2.0, 0.0], [0.0, 0.0, 2.0], [if i % 4 == 0 { 2.0 } else { -2.0 }, 0.0, 0.0]], [0.3, 0.1, 0.0])
        } else {
            random_affine(random, 1.0)
        };
        let part = SpherePart::new(0.7, [-0.5, 0.3], Turn::degrees(220.0));
        let geometry = of(|b| drop(b.add_sphere(Sphere::new(centre, 0.7).cut(part), &transform, false)));
        for _ in 0..2000 {
            let ray = Ray::new(random.in_ball() * 2.0, random.dir());
            let inverse = transform.matrix.as_dmat4().inverse();
            let (o, d) =
                (inverse.transform_point3(ray.origin.as_dvec3()), inverse.transform_vector3(ray.dir.as_dvec3()));
            let o = o - centre.as_dvec3();
            let distances = quadratic(d.length_squared(), 2.0 * o.dot(d), o.length_squared() - 0.49);
            let margin = |p: DVec3| (p.z + 0.5).min(0.3 - p.z).min((220.0 - azimuth(p)).min(azimuth(p)).to_radians());
            let hit = geometry.intersect(&ray, f32::INFINITY);
            if distances[0].is_nan() {
                assert!(hit.is_none());
                continue;
            }
            let Ok(expected) = expected(distances, (o, d), margin) else { continue };
            assert_eq!(hit.is_some(), expected.is_some(), "{ray:?} {distances:?}");
            let (Some(hit), Some(t)) = (hit, expected) else { continue };
            hits += 1;
            assert!((f64::from(hit.t) - t).abs() < 1e-5 * (1.0 + t), "{} {t}", hit.t);
            let (point, local) = (geometry.interaction(&ray, &hit), o + d * t);
            assert!((f64::from(point.uv.get().x) - azimuth(local) / 220.0).abs() < 1e-4);
            // v runs with the angle from the south, from the southern rim to the northern one.
            let [south, here, north] = [-0.5, local.z, 0.3].map(|z| -(z / 0.7f64).acos());
            assert!(
                (f64::from(point.uv.get().y) - (here - south) / (north - south)).abs() < 1e-4,
                "{}",
                point.uv.get()
            );
        }
    }
    assert!(hits > 3000, "{hits}");
}

/// A third of a disk is hit by a third of the rays along its axis.
#[test]
fn a_part_of_a_disk_ends_at_its_azimuth() {
    let random = &mut Random(52);
    let disk = Disk::new(0.0, 1.0, 0.2).cut(Turn::degrees(120.0));
    let geometry = of(|b| drop(b.add_disk(disk, &Transform::IDENTITY, false)));
    for _ in 0..5000 {
        let p = random.in_ball();
        let r = p.truncate().length();
        let phi = azimuth(p.as_dvec3());
        if (r - 0.2).abs() < 1e-4 || (phi - 120.0).abs() < 1e-3 || (r - 1.0).abs() < 1e-4 {
            continue;
        }
        let ray = Ray::new(Vec3::new(p.x, p.y, 2.0), -Vec3::Z);
        let hit = geometry.intersect(&ray, f32::INFINITY);
        assert_eq!(hit.is_some(), r > 0.2 && phi < 120.0, "{p}");
        if let Some(hit) = hit {
            let uv = geometry.interaction(&ray, &hit).uv.get();
            assert!((f64::from(uv.x) - phi / 120.0).abs() < 1e-5 && (uv.y - (1.0 - r) / 0.8).abs() < 1e-5, "{uv}");
        }
    }
}

/// Rays that leave a cylinder outward never meet it again; those that leave inward meet its far side or fly through an
/// end; and from point to point of its inside nothing is in between: at any scale and place.
#[test]
fn rays_leave_a_cylinder_for_good() {
    let random = &mut Random(53);
    for scale in [1e-6, 1.0, 1e6] {
        for offset in [Vec3::ZERO, Vec3::new(3.0, -2.0, 1.0), Vec3::new(500.0, 100.0, -300.0)] {
            for uneven in [false, true] {
                let s = f64::from(scale);
                let columns = if uneven {
                    [[s, 0.5 * s, 0.0], [0.0, 0.7 * s, 0.2 * s], [0.1 * s, 0.0, 0.4 * s]]
                } else {
                    [[0.0, s, 0.0], [0.0, 0.0, s], [s, 0.0, 0.0]]
                };
                let transform = affine(columns, (offset * scale).to_array().map(f64::from));
                let cylinder = Cylinder::new(1.0, [-1.0, 1.0], Turn::FULL);
                let geometry = of(|b| drop(b.add_cylinder(cylinder, &transform, false)));
                let mut point = || loop {
                    let ray = Ray::new(offset * scale, random.dir());
                    if let Some(hit) = geometry.intersect(&ray, f32::INFINITY) {
                        return (geometry.interaction(&ray, &hit), random.dir());
                    }
                };
                for _ in 0..5000 {
                    let ((from, dir), (to, _)) = (point(), point());
                    let out = if dir.dot(from.ng) < 0.0 { -dir } else { dir };
                    let again = geometry.intersect(&from.spawn(out), f32::INFINITY);
                    assert!(again.is_none(), "scale {scale} offset {offset}: {from:?} {out} {again:?}");
                    if let Some(hit) = geometry.intersect(&from.spawn(-out), f32::INFINITY) {
                        assert!(
                            hit.t > 0.1 * out.dot(from.ng) * scale,
                            "scale {scale} offset {offset}: {from:?} {hit:?}"
                        );
                    }
                    let between = to.p - from.p;
                    let slope = (-from.ng.dot(between)).min(to.ng.dot(between)) / between.length();
                    if between.length() > 0.01 * scale && slope > 0.01 {
                        let (ray, t_max) = from.spawn_to(&to).unwrap();
                        assert!(!geometry.occluded(&ray, t_max), "scale {scale} offset {offset}: {from:?} {to:?}");
                    }
                }
            }
        }
    }
}

/// The nearest point of a round cylinder is on its side, or on one of its rims.
#[test]
fn the_clearance_of_a_cylinder_is_the_distance_to_it() {
    let random = &mut Random(54);
    let turned = affine([[0.0, 3.0, 0.0], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]], [0.0; 3]);
    let geometry = of(|b| drop(b.add_cylinder(Cylinder::new(0.4, [-0.2, 1.0], Turn::FULL), &turned, false)));
    for _ in 0..5000 {
        let p = random.in_ball() * 5.0;
        let [x, y, z] = [p.y, p.z, p.x].map(|v| f64::from(v) / 3.0);
        let distance = 3.0 * (x.hypot(y) - 0.4).hypot(z - z.clamp(-0.2, 1.0));
        let clearance = f64::from(geometry.clearance(p, f32::INFINITY));
        assert!(clearance <= distance + 1e-6 && clearance > distance - 1e-5, "{clearance} {distance}");
    }
}
