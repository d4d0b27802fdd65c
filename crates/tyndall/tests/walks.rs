//! Walks deep inside media: the bits of many at once are those of one after the other, and both have the light that rays find.

mod common;

use glam::{DMat4, DVec3};

use common::{World, diffuse, glass, medium};
use tyndall::{
    camera::{CameraModel, Perspective},
    integrator::{Deep, VolPath},
    light::{Light, PointLight},
    material::Material,
    math::{Transform, Vec3},
    medium::{Homogeneous, MediumId},
    phase::Phase,
    render::{Rendering, Settings, render},
    sampling::SamplerKind,
    scene::Scene,
    shape::{Ball, ObjectId, Room, Shape},
    spectrum::ColorMode,
};

fn followed(deep: Deep) -> VolPath {
    VolPath { deep, ..VolPath::default() }
}

fn picture(scene: &Scene, integrator: &VolPath, settings: &Settings) -> Rendering {
    render(scene, integrator, settings, &())
}

/// Dense bodies side by side: coloured, with a boundary of glass and without one, open to a sky and a lamp; `phase` for
/// all of them.
fn dense_still_life(color: ColorMode, phase: &Phase) -> Scene {
    let mut world = World::seen(Vec3::new(0.0, 1.0, 6.0), Vec3::new(0.0, 0.4, 0.0));
    world.color = color;
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.4, 0.4, -0.3, 0.3]));
    (world.camera.width, world.camera.height) = (32, 24);
    let of = |sigma_a, sigma_s| Some(Homogeneous { phase: phase.clone(), ..medium(sigma_a, sigma_s, 0.0) });
    world.sphere(Vec3::new(-1.1, 0.5, 0.0), 0.5, glass(1.4, 0.0), of([0.01, 0.05, 0.2], [20.0, 30.0, 40.0]));
    let (low, high) = (Vec3::new(-0.4, 0.0, -0.4), Vec3::new(0.4, 0.8, 0.4));
    world.cuboid(low, high, Material::Null, of([0.02, 0.0, 0.1], [10.0, 20.0, 80.0]));
    world.sphere(Vec3::new(1.1, 0.4, 0.2), 0.4, Material::Null, of([3.0, 0.5, 0.0], [30.0, 30.0, 30.0]));
    world.cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 0.0, 9.0), diffuse(0.5), None);
    world.shining_disk(3.0, 0.7, diffuse(0.0), 10.0);
    world.sky(0.3);
    world.scene()
}

fn phases() -> [Phase; 5] {
    let forward = Phase::henyey_greenstein(0.8).unwrap();
    let back = Phase::henyey_greenstein(-0.3).unwrap();
    [
        Phase::henyey_greenstein(0.0).unwrap(),
        forward.clone(),
        Phase::Rayleigh(tyndall::phase::Rayleigh),
        Phase::tabulated(&[0.5, 0.1, 0.2, 1.0, 3.0]).unwrap(),
        Phase::blend(&forward, &back, 0.3).unwrap(),
    ]
}

/// Also with a limit on the depth, which walks must keep, and with more samples than paths that are held at once.
#[test]
fn many_paths_at_once_give_the_bits_of_one_after_the_other() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        for phase in phases() {
            let scene = dense_still_life(color, &phase);
            assert!(matches!(scene.room(MediumId(1)), Some(Room::Block(_))), "walks in a block too");
            for max_depth in [None, Some(20)] {
                let settings = Settings { spp: 5, seed: 3, ..Settings::default() };
                let of = |deep| picture(&scene, &VolPath { deep, max_depth, ..VolPath::default() }, &settings);
                let (alone, together) = (of(Deep::Alone), of(Deep::Together));
                assert_eq!(alone.film, together.film, "{color:?} {phase:?} {max_depth:?}");
                let counts =
                    |r: &Rendering| (r.tally.collisions, r.tally.rays, r.tally.shadow_rays, r.tally.truncated_paths);
                assert_eq!(counts(&alone), counts(&together));
                assert_eq!((alone.tally.bad_samples, alone.tally.leaks), (0, 0));
            }
        }
    }
}

/// Mean and standard error of all pixels of a channel.
fn mean(rendering: &Rendering, channel: usize) -> (f64, f64) {
    let n = rendering.film.pixels.len() as f64;
    let errors = rendering.film.pixels.iter().map(|p| f64::from(p.standard_error()[channel]).powi(2));
    let sum: f64 = rendering.film.pixels.iter().map(|p| f64::from(p.mean()[channel])).sum();
    (sum / n, errors.sum::<f64>().sqrt() / n)
}

/// The same scenes with a ray for each flight: 45 means agree (a |z| above 4.5 has a chance of 7e-6).
#[test]
fn walks_find_the_light_that_rays_find() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        for phase in phases() {
            let scene = dense_still_life(color, &phase);
            let of = |deep, seed| {
                let settings = Settings { spp: 48, seed, sampler: SamplerKind::Independent, ..Settings::default() };
                picture(&scene, &followed(deep), &settings)
            };
            let (walks, rays) = (of(Deep::Together, 1), of(Deep::Traced, 2));
            for c in 0..3 {
                let ((a, ea), (b, eb)) = (mean(&walks, c), mean(&rays, c));
                let z = (a - b) / ea.hypot(eb);
                assert!(z.abs() < 4.5, "{color:?} {phase:?}, channel {c}: {a} ± {ea}, {b} ± {eb}: z = {z:.1}");
                assert!(ea < 0.02 * a, "{ea} {a}");
            }
        }
    }
}

/// A medium is a room where it fills one ball or block, whatever touches that; not where something else is in it, or where it has
/// other bodies or none.
#[test]
fn media_that_fill_a_ball_or_a_block_are_rooms() {
    let (low, high) = (Vec3::ZERO, Vec3::ONE);
    let dense = || Some(medium([0.0; 3], [10.0; 3], 0.0));
    let room = |furnish: &dyn Fn(&mut World)| {
        let mut world = World::seen(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO);
        world.sky(1.0);
        furnish(&mut world);
        world.scene().room(MediumId(0))
    };
    let cuboid = |world: &mut World| {
        world.cuboid(low, high, Material::Null, dense());
    };
    let wall = |world: &mut World, low: Vec3| {
        world.cuboid(low, low + 2.0, diffuse(0.5), None);
    };
    let ball = |world: &mut World, centre: Vec3, inside| {
        world.sphere(centre, 0.2, glass(1.5, 0.0), inside);
    };
    let lamp = |world: &mut World, position| {
        world.lights.push(Light::Point(PointLight { position, intensity: common::grey(1.0), luminance: 1.0 }));
    };
    assert!(matches!(room(&|world| ball(world, low, dense())), Some(Room::Ball(_))));
    let is_block = |furnish: &dyn Fn(&mut World)| {
        let room = room(&|world| {
            cuboid(world);
            furnish(world);
        });
        assert!(matches!(room, None | Some(Room::Block(_))));
        room.is_some()
    };
    assert!(is_block(&|_| ()));
    assert!(is_block(&|world| wall(world, Vec3::new(-0.5, -2.0, -0.5))));
    assert!(!is_block(&|world| wall(world, Vec3::new(-0.5, -1.99, -0.5))));
    assert!(is_block(&|world| lamp(world, Vec3::splat(1.1))));
    assert!(!is_block(&|world| lamp(world, Vec3::splat(0.9))));
    assert!(!is_block(&|world| ball(world, Vec3::splat(0.5), None)));
    // Instances of a ball, of a flattened one and of a mesh: beside the block, and in it.
    for (height, is_free) in [(3.0, true), (0.5, false)] {
        for (round, stretch) in [(true, 1.0), (true, 0.5), (false, 1.0)] {
            let placed = |world: &mut World| {
                let group = world.builder.begin_group();
                if round {
                    ball(world, Vec3::ZERO, None);
                } else {
                    wall(world, Vec3::ZERO);
                }
                world.builder.end_group();
                let stretch = DMat4::from_scale(DVec3::new(1.0, stretch, 1.0));
                let to = DMat4::from_translation(DVec3::new(0.5, height, 0.5)) * stretch;
                world.builder.add_instance(group, &Transform::new(to).unwrap()).unwrap();
            };
            assert_eq!(is_block(&placed), is_free, "{height} {round} {stretch}");
        }
    }
    assert!(!is_block(&|world| world.faceted_ball(9.0, 8, Material::Null, medium([0.0; 3], [1.0; 3], 0.0))));
    assert_eq!(room(&|world| world.faceted_ball(1.0, 8, Material::Null, medium([0.0; 3], [1.0; 3], 0.0))), None);
}

/// Lamps without a surface, few and many, in a ball: no clearance reaches over one.
#[test]
fn no_clearance_reaches_over_a_lamp_without_a_surface() {
    let mut random = testkit::Stream::new(5);
    let mut place = || Vec3::from_array([0; 3].map(|_| random.next_f64() as f32 * 2.0 - 1.0));
    for lamps in [0, 1, 5, 40] {
        let mut world = World::seen(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
        world.sphere(Vec3::ZERO, 2.0, Material::Null, Some(medium([0.0; 3], [1.0; 3], 0.0)));
        let places: Vec<_> = (0..lamps).map(|_| place()).collect();
        for &position in &places {
            world.lights.push(Light::Point(PointLight { position, intensity: common::grey(1.0), luminance: 1.0 }));
        }
        let scene = world.scene();
        for _ in 0..1000 {
            let p = place();
            let nearest = places.iter().map(|lamp| lamp.distance(p)).fold(2.0 - p.length(), f32::min);
            let clearance = scene.clearance(p, f32::INFINITY);
            assert!(clearance <= nearest * (1.0 + 1e-6), "{lamps} lamps, {p}: {clearance} above {nearest}");
            assert!(lamps > 16 || clearance > nearest * (1.0 - 1e-5), "{lamps} lamps, {p}: {clearance} for {nearest}");
        }
    }
}

/// In a body of many triangles distances are remembered on a grid: what it answers is never above the distance that the tree
/// finds, and below it by no more than the size of a cell.
#[test]
fn remembered_distances_are_bounds() {
    let mut world = World::seen(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
    world.faceted_ball(1.5, 40, Material::Null, medium([0.0; 3], [100.0; 3], 0.0));
    let position = Vec3::new(0.3, 0.2, 0.1);
    world.lights.push(Light::Point(PointLight { position, intensity: common::grey(1.0), luminance: 1.0 }));
    let scene = world.scene();
    let cell = 3.0 / 32.0;
    let mut random = testkit::Stream::new(7);
    let mut loose = 0;
    for _ in 0..20_000 {
        let p = Vec3::from_array([0; 3].map(|_| random.next_f64() as f32 * 3.4 - 1.7));
        let exact = scene.geometry.clearance(p, 9.0).min(p.distance(position));
        let found = scene.clearance(p, 9.0);
        assert!(found <= exact, "{p}: {found} above {exact}");
        assert!(found >= exact - 1.8 * cell, "{p}: {found} far below {exact}");
        loose += u32::from(found < exact);
    }
    assert!(loose > 5000, "the grid has answered {loose} times");
}

/// A body of many triangles with bumps and dents, ten to a hundred free paths deep.
fn bumpy(color: ColorMode, phase: &Phase, boundary: Material) -> World {
    let mut world = World::seen(Vec3::new(0.0, 1.0, 4.0), Vec3::ZERO);
    world.color = color;
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.4, 0.4, -0.3, 0.3]));
    (world.camera.width, world.camera.height) = (24, 18);
    let inside = Homogeneous { phase: phase.clone(), ..medium([0.01, 0.05, 0.2], [10.0, 30.0, 50.0], 0.0) };
    world.uneven_ball(|d| 1.0 + 0.1 * (9.0 * d.x).sin() * (8.0 * d.y).sin(), 40, boundary, inside);
    world.shining_disk(3.0, 0.7, diffuse(0.0), 10.0);
    world.sky(0.3);
    world
}

/// In it a ball touches nearly every triangle, within 3e-4 of its radius and rounding: no surface and no lamp is in the ball, and in one
/// twice as large there would be, or it is as large as any.
#[test]
fn balls_that_touch_a_surface_have_nothing_in_them() {
    let lamp = Vec3::new(0.2, 0.1, 0.3);
    let mut world = bumpy(ColorMode::Rgb, &phases()[0], Material::Null);
    world.lights.push(Light::Point(PointLight { position: lamp, intensity: common::grey(1.0), luminance: 1.0 }));
    let scene = world.scene();
    let id = ObjectId(0);
    let Shape::Mesh(mesh) = scene.geometry.shape(id) else { panic!() };
    let (mut found, mut widest) = (0, 0f32);
    for (prim, _) in (0..).zip(&mesh.indices) {
        let touching = scene.touching((id, prim)).expect("a body has ends");
        assert_eq!(scene.touching((id, prim)), Some(touching), "what is remembered is what was found");
        let Some(touching) = touching else { continue };
        let Ball { centre, radius } = touching.ball;
        let [a, b, c] = mesh.triangle(prim);
        let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
        assert!(scene.geometry.clearance(centre, f32::INFINITY) >= radius && centre.distance(lamp) >= radius);
        assert!((middle.distance(centre) / radius - 1.0).abs() < 4e-4 && normal.dot(middle - centre) >= radius);
        // A point at the surface has room enough, one outside or on the far side has not.
        assert!(touching.holds(middle - normal * 0.2 * radius) && !touching.holds(middle + normal * 0.1 * radius));
        assert!(!touching.holds(centre - normal * 0.95 * radius));
        let larger = middle - normal * (2.0 * radius);
        let is_free = scene.geometry.clearance(larger, f32::INFINITY).min(larger.distance(lamp)) >= 2.0 * radius;
        (found, widest) = (found + 1, widest.max(radius));
        assert!(!is_free, "{prim}: {radius}");
    }
    assert!(found > mesh.indices.len() * 9 / 10 && widest > 0.2, "{found} of {}, {widest}", mesh.indices.len());
    assert_eq!(scene.touching((ObjectId(1), 0)), None, "a lamp has no inside");
    assert_eq!(scene.touching((id, u32::MAX)), None);
}

/// Also where balls touch the surface.
#[test]
fn walks_in_a_bumpy_body_find_the_light_that_rays_find() {
    for (color, phase) in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral].into_iter().zip(phases()) {
        for boundary in [Material::Null, glass(1.3, 0.0)] {
            let scene = bumpy(color, &phase, boundary).scene();
            let of = |deep, spp, seed| {
                let settings = Settings { spp, seed, sampler: SamplerKind::Independent, ..Settings::default() };
                picture(&scene, &followed(deep), &settings)
            };
            assert_eq!(of(Deep::Alone, 4, 3).film, of(Deep::Together, 4, 3).film, "{color:?} {phase:?}");
            let (walks, rays) = (of(Deep::Together, 64, 1), of(Deep::Traced, 64, 2));
            for c in 0..3 {
                let ((a, ea), (b, eb)) = (mean(&walks, c), mean(&rays, c));
                let z = (a - b) / ea.hypot(eb);
                assert!(z.abs() < 4.5, "{color:?} {phase:?}, channel {c}: {a} ± {ea}, {b} ± {eb}: z = {z:.1}");
                assert!(ea < 0.02 * a, "{ea} {a}");
            }
        }
    }
}

/// Deep inside a clear ball of 10⁴ free paths hardly a ray is cast.
#[test]
fn collisions_deep_inside_cast_no_rays() {
    let mut world = World::seen(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO);
    world.sphere(Vec3::ZERO, 1.0, glass(1.4, 0.0), Some(medium([0.5; 3], [5000.0; 3], 0.9)));
    world.sky(1.0);
    let tally = picture(&world.scene(), &VolPath::default(), &Settings { spp: 2000, ..Settings::default() }).tally;
    assert!(tally.collisions > 20 * (tally.rays + tally.shadow_rays), "{tally:?}");
}
