//! In a hollow sphere a ray meets what the tree says.

use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Geometry, GeometryBuilder, Hit, Interaction, ObjectId, Shape, Sphere, Style};

use super::{
    affine,
    agreement::{random_affine, soup},
    meshes::{Random, cube, moved},
    strands::strand,
};

/// Points on the spheres that random rays meet, each with the sphere.
fn seen(geometry: &Geometry, size: f32, random: &mut Random) -> Vec<(Hit, Interaction)> {
    let ray = |random: &mut Random| Ray::new(random.in_ball() * size, random.dir());
    let met = (0..20_000).filter_map(|_| {
        let ray = ray(random);
        let hit = geometry.intersect(&ray, f32::INFINITY)?;
        Some((hit, geometry.interaction(&ray, &hit)))
    });
    met.filter(|(hit, _)| matches!(geometry.shape(hit.object), Shape::Sphere(_))).collect()
}

/// Follows rays that are reflected within each hollow sphere: how many hits there were.
fn follow_within(geometry: &Geometry, size: f32, random: &mut Random) -> usize {
    let hollows = geometry.hollows(|_| true);
    let mut hits = 0;
    for (first, start) in seen(geometry, size, random) {
        let mut at = start;
        for _ in 0..4 {
            let dir = random.dir();
            let dir = if dir.dot(at.p - start.p + start.ng) > 0.0 { -dir } else { dir };
            let Some(hollow) = hollows.entered(&at, dir) else { break };
            let ray = at.spawn(dir);
            let (exit, met) = (hollow.exit(&ray), geometry.intersect(&ray, f32::INFINITY));
            assert_eq!(exit, met, "{ray:?}");
            let Some(exit) = exit else { break };
            assert_eq!((exit.object, exit.instance), (first.object, first.instance));
            hits += 1;
            at = geometry.interaction(&ray, &exit);
        }
    }
    hits
}

/// Spheres of many sizes, alone, placed once or two in a group; those are hollow to which no other comes near.
#[test]
fn the_spheres_are_hollow_that_no_other_enters() {
    let random = &mut Random(61);
    let mut builder = GeometryBuilder::new();
    let mut balls: Vec<(Vec3, f32, Option<u32>)> = Vec::new();
    let ball = |random: &mut Random| (random.in_ball() * 8.0, 0.1 + 0.5 * random.unit());
    for _ in 0..300 {
        let (centre, radius) = ball(random);
        builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, false).unwrap();
        balls.push((centre, radius, None));
    }
    let one = builder.begin_group();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    let coated = builder.begin_group();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false).unwrap();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 0.5), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    for i in 0..400 {
        let (centre, r) = ball(random);
        let [x, y, z] = centre.as_dvec3().to_array();
        let r64 = f64::from(r);
        let place = affine([[r64, 0.0, 0.0], [0.0, r64, 0.0], [0.0, 0.0, r64]], [x, y, z]);
        let index = builder.add_instance(if i % 4 == 0 { coated } else { one }, &place).unwrap();
        balls.push((centre, r, Some(index)));
        if i % 4 == 0 {
            balls.push((centre, 0.5 * r, Some(index)));
        }
    }
    let geometry = builder.build().unwrap();
    let hollows = geometry.hollows(|_| true);
    let mut counts = [0; 2];
    for (hit, surface) in seen(&geometry, 9.0, random) {
        let found = hollows.entered(&surface, -surface.ng);
        let of_hit = |(i, &(c, r, instance)): (usize, &(Vec3, f32, Option<u32>))| {
            let is_it = match instance {
                None => hit.instance == Hit::NO_INSTANCE && hit.object == ObjectId(i as u32),
                Some(index) => hit.instance == index && ((surface.p - c).length() / r - 1.0).abs() < 1e-3,
            };
            is_it.then_some(i)
        };
        let it = balls.iter().enumerate().find_map(of_hit).unwrap();
        let (centre, radius, _) = balls[it];
        let gap = |&(c, r, _): &(Vec3, f32, Option<u32>)| {
            ((c - centre).as_dvec3().length() - f64::from(r)).abs() / f64::from(radius) - 1.0
        };
        let others = balls.iter().enumerate().filter(|(i, _)| *i != it);
        let nearest = others.map(|(_, ball)| gap(ball)).fold(f64::INFINITY, f64::min);
        assert!((nearest - 1e-5).abs() < 1e-6 || found.is_some() == (nearest > 1e-5), "{nearest}");
        assert!(hollows.entered(&surface, surface.ng).is_none());
        counts[usize::from(found.is_some())] += 1;
    }
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    assert!(follow_within(&geometry, 9.0, random) > 10_000);
}

/// Among triangles, strands, ellipsoids and groups; and none is hollow that was not asked about.
#[test]
fn a_sphere_with_anything_inside_is_not_hollow() {
    let random = &mut Random(62);
    for count in [1, 40] {
        let mut builder = GeometryBuilder::new();
        for _ in 0..30 {
            let sphere = Sphere::new(random.in_ball() * 2.0, 0.3);
            builder.add_sphere(sphere, &Transform::IDENTITY, false).unwrap();
        }
        for style in [Style::Flat, Style::Round] {
            builder.add_curves(strand(style, 5, 0.05, random), &Transform::IDENTITY).unwrap();
        }
        builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &random_affine(random, 0.3), false).unwrap();
        builder.add_mesh(soup(count, 0.2, random), &Transform::IDENTITY, false).unwrap();
        let group = builder.begin_group();
        builder.add_mesh(moved(cube(), 0.1, Vec3::ZERO), &Transform::IDENTITY, false).unwrap();
        builder.end_group();
        for _ in 0..5 {
            let at = (random.in_ball() * 2.0).as_dvec3().to_array();
            builder.add_instance(group, &affine([[1.0, 0.2, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 0.5]], at)).unwrap();
        }
        let geometry = builder.build().unwrap();
        assert!(follow_within(&geometry, 3.0, random) > 1000);
        let hollows = geometry.hollows(|_| false);
        assert!(seen(&geometry, 3.0, random).iter().all(|(_, at)| hollows.entered(at, -at.ng).is_none()));
    }
}
