//! The clearance never exceeds the distance to the nearest surface, and is that distance where it can be.

use parry3d::query::PointQuery;
use tyndall::math::{Transform, Vec3};
use tyndall::shape::{Disk, GeometryBuilder, Mesh, ObjectId, Sphere};

use super::{
    affine,
    agreement::{everything, soup},
    meshes::{Random, displaced_sphere},
    of_mesh, of_sphere,
};

/// Within single precision of parry3d's closest point, capped or not. The slack is 4ε for each unit of reach, here 5 at
/// most (two edges of up to 1 and points within 1.5), times 1 + 8 for the flattest triangles of single precision: 2.2e-5.
#[test]
fn the_clearance_of_triangles_is_the_distance_that_parry_finds() {
    let random = &mut Random(30);
    for (count, size) in [(1, 1.0), (7, 0.8), (100, 0.3), (3000, 0.1)] {
        let mesh = soup(count, size, random);
        let vertices = mesh.positions.iter().map(|p| parry3d::math::Vector::new(p.x, p.y, p.z)).collect();
        let theirs = parry3d::shape::TriMesh::new(vertices, mesh.indices.clone()).unwrap();
        let ours = of_mesh(mesh);
        for _ in 0..5000 {
            let p = random.in_ball() * 1.5;
            let distance = theirs.distance_to_local_point(parry3d::math::Vector::new(p.x, p.y, p.z), false);
            let clearance = ours.clearance(p, f32::INFINITY);
            assert!(clearance < distance + 1e-6 && clearance > distance - 2.2e-5, "{p}: {clearance} {distance}");
            let cap = random.unit() * 0.2;
            let capped = ours.clearance(p, cap);
            assert!(capped <= cap && (capped - clearance.min(cap)).abs() < 2.2e-5, "{p}: {capped} {clearance} {cap}");
        }
    }
}

#[test]
fn the_clearance_of_a_sphere_is_the_distance_to_it() {
    let random = &mut Random(31);
    let geometry = of_sphere(Vec3::X, 2.0);
    for _ in 0..5000 {
        let p = random.in_ball() * 5.0;
        let distance = ((p.as_dvec3() - glam::DVec3::X).length() - 2.0).abs();
        let clearance = f64::from(geometry.clearance(p, f32::INFINITY));
        assert!(clearance <= distance && clearance >= distance * (1.0 - 2e-7) - 1e-12, "{clearance} {distance}");
    }
}

/// The nearest point of a ring is above it, or on one of its circles.
#[test]
fn the_clearance_of_a_ring_is_the_distance_to_it() {
    let random = &mut Random(32);
    let mut builder = GeometryBuilder::new();
    builder.add_disk(Disk::new(0.5, 1.0, 0.4), &Transform::IDENTITY, false).unwrap();
    let geometry = builder.build().unwrap();
    for _ in 0..5000 {
        let p = random.in_ball() * 2.0;
        let r = f64::from(p.x).hypot(f64::from(p.y));
        let distance = (r - r.clamp(0.4, 1.0)).hypot(f64::from(p.z) - 0.5);
        let clearance = f64::from(geometry.clearance(p, f32::INFINITY));
        assert!(clearance <= distance + 1e-7 && clearance > distance - 1e-5, "{clearance} {distance}");
    }
}

/// Move the point by its clearance in any direction: no surface is met on the way. This holds for every kind of
/// shape and instance.
#[test]
fn no_surface_is_met_within_the_clearance() {
    let random = &mut Random(33);
    for _ in 0..5 {
        let geometry = everything(random);
        for _ in 0..1000 {
            let p = random.in_ball() * 2.0;
            let clearance = geometry.clearance(p, 10.0);
            for _ in 0..20 {
                let ray = tyndall::math::Ray::new(p, random.dir());
                if let Some(hit) = geometry.intersect(&ray, f32::INFINITY) {
                    assert!(clearance <= hit.t * (1.0 + 1e-6), "{clearance} {hit:?}");
                }
            }
        }
    }
}

/// By the distance of every triangle by itself. A search that is given up knows nothing.
#[test]
fn the_nearest_triangle_is_as_near_as_the_surface() {
    let random = &mut Random(35);
    let mesh = displaced_sphere(12, 0.3);
    let each: Vec<_> = mesh.indices.iter().map(|&t| of_mesh(Mesh { indices: vec![t], ..mesh.clone() })).collect();
    let geometry = of_mesh(mesh);
    let mut given_up = 0;
    for _ in 0..300 {
        let p = random.in_ball() * 1.5;
        let (clearance, triangle) = geometry.nearest(p, f32::INFINITY);
        let (object, prim) = triangle.unwrap();
        assert_eq!((clearance, object), (geometry.clearance(p, f32::INFINITY), ObjectId(0)));
        let distance = each[prim as usize].clearance(p, f32::INFINITY);
        assert!(distance >= clearance && distance < clearance + 1e-5, "{p}: {distance} {clearance}");
        assert_eq!(geometry.nearest(p, 0.5 * clearance), (0.5 * clearance, None));
        assert!(!geometry.is_free(p, 1.001 * clearance, u32::MAX));
        let is_free = |leaves| geometry.is_free(p, 0.999 * clearance, leaves);
        assert!(is_free(u32::MAX));
        given_up += u32::from(!is_free(3));
    }
    assert!((50..250).contains(&given_up), "{given_up}");
}

/// A uniform scale of 3 multiplies distances by 3; a squeeze by (3, 1, 1) leaves a bound that is at least a third.
#[test]
fn the_clearance_of_an_instance_follows_its_scale() {
    let random = &mut Random(34);
    let place = |x: f64| {
        let mut builder = GeometryBuilder::new();
        let group = builder.begin_group();
        builder.add_mesh(displaced_sphere(10, 0.1), &Transform::IDENTITY, false).unwrap();
        builder.add_sphere(Sphere::new(Vec3::Z * 2.0, 0.3), &Transform::IDENTITY, false).unwrap();
        builder.end_group();
        builder.add_instance(group, &affine([[0.0, x, 0.0], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]], [0.0; 3])).unwrap();
        builder.build().unwrap()
    };
    let (unit, even, uneven) = (of_group(), place(3.0), place(1.0));
    for _ in 0..2000 {
        let p = random.in_ball() * 3.0;
        let local = unit.clearance(p, f32::INFINITY);
        let world = even.clearance(Vec3::new(p.z, p.x, p.y) * 3.0, f32::INFINITY);
        assert!((world - 3.0 * local).abs() < 1e-5, "{world} {local}");
        let bound = uneven.clearance(Vec3::new(p.z * 3.0, p.x, p.y * 3.0), f32::INFINITY);
        assert!((bound - local).abs() < 1e-5, "{bound} {local}");
    }
}

fn of_group() -> tyndall::shape::Geometry {
    let mut builder = GeometryBuilder::new();
    builder.add_mesh(displaced_sphere(10, 0.1), &Transform::IDENTITY, false).unwrap();
    builder.add_sphere(Sphere::new(Vec3::Z * 2.0, 0.3), &Transform::IDENTITY, false).unwrap();
    builder.build().unwrap()
}
