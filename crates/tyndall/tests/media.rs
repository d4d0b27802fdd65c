//! Ring 3 for media with real boundaries: bodies that overlap, nest, coincide, are placed, or enclose the camera.

mod common;

use std::f64::consts::PI;

use common::{World, assert_mean, diffuse, glass, medium};
use tyndall::{
    camera::{Batch, CameraModel, View},
    integrator::{Analog, Integrator, VolPath},
    lecture::Lecture,
    light::{Light, PointLight},
    material::Material,
    math::{Transform, Vec3},
    medium::{Homogeneous, MediumId, MediumInterface},
    render::{Settings, render},
    sampling::SamplerKind,
    shape::{Disk, Sphere},
    spectrum::{ColorMode, Spectrum},
    tally::Tally,
};

const DEPTHS: [f32; 3] = [0.2, 0.7, 1.5];

/// The general ones, and the two ends of the lecture's volumes.
fn integrators() -> [(&'static str, Box<dyn Integrator>); 4] {
    [
        ("volpath", Box::new(VolPath::default())),
        ("analog", Box::new(Analog)),
        ("lecture v0.75", Box::new(Lecture::VolumeV0_75)),
        ("lecture v1", Box::new(Lecture::VolumeV1)),
    ]
}

/// The world, seen by every integrator.
#[track_caller]
fn assert_all(what: &str, world: impl Fn() -> World, expected: [f64; 3], precision: f64, spp: u32) {
    for (name, integrator) in integrators() {
        let spp = if name.starts_with("lecture") { 3 * spp } else { spp };
        assert_mean(&format!("{what}, {name}"), &world().measure(&*integrator, spp), expected, precision);
    }
}

fn tally(world: World, spp: u32) -> Tally {
    let settings = Settings { spp, sampler: SamplerKind::Independent, ..Settings::default() };
    render(&world.scene(), &VolPath::default(), &settings, &()).tally
}

fn times(sigma: [f32; 3], by: f32) -> [f32; 3] {
    sigma.map(|s| s * by)
}

fn absorber(by: f32) -> Homogeneous {
    medium(times(DEPTHS, by), [0.0; 3], 0.0)
}

fn passes(by: f64) -> [f64; 3] {
    DEPTHS.map(|s| (-f64::from(s) * by).exp())
}

/// A wide slab of a body between two heights.
fn layer(world: &mut World, [low, high]: [f32; 2], skin: Material, inside: Option<Homogeneous>, priority: i32) {
    let wide = 1e4;
    world.cuboid(Vec3::new(-wide, low, -wide), Vec3::new(wide, high, wide), skin, inside);
    world.with_priority(priority, 1);
}

fn from_above() -> World {
    World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO)
}

/// Three absorbers: A over 0..2, B over 1..3, C over 1.5..2.5, of unit coefficients 1, 2 and 4. Of one priority they add:
/// τ = 2·1 + 2·2 + 1·4 = 10. With A above B above C, B is left with 2..3 and C with nothing: 2·1 + 1·2 = 4. With C on top,
/// then B: 1·4 + 1·2 (1..1.5 and 2.5..3) + 1·1 = 7.
#[test]
fn overlapping_absorbers_add_or_cut_each_other_out() {
    for (priorities, depth) in [([0, 0, 0], 10.0), ([2, 1, 0], 4.0), ([0, 1, 2], 7.0), ([-3, -3, -5], 6.0)] {
        let world = || {
            let mut world = from_above();
            let [a, b, c] = priorities;
            layer(&mut world, [-2.0, 0.0], Material::Null, Some(absorber(0.1)), a);
            layer(&mut world, [-3.0, -1.0], Material::Null, Some(absorber(0.2)), b);
            layer(&mut world, [-2.5, -1.5], Material::Null, Some(absorber(0.4)), c);
            world.sky(1.0);
            world
        };
        assert_all(&format!("{priorities:?}"), world, passes(0.1 * depth), 0.04, 10_000);
    }
}

/// What passes and comes back of a stack of layers at normal incidence, all internal reflections included: indices
/// `n[0], …` and transmittances `a[i]` of the layers in between (adding; Fresnel's `((n₁−n₂)/(n₁+n₂))²`).
fn stack(n: &[f64], a: &[f64]) -> f64 {
    let fresnel = |i: usize| ((n[i] - n[i + 1]) / (n[i] + n[i + 1])).powi(2);
    // The reflectance from below and the transmittance of what is above.
    let (mut r, mut t) = (fresnel(0), 1.0 - fresnel(0));
    for i in 1..n.len() - 1 {
        let (layer, next) = (a[i - 1], fresnel(i));
        let (below, through) = (r * layer * layer, t * layer);
        let bounce = 1.0 - below * next;
        (r, t) = (next + (1.0 - next) * below * (1.0 - next) / bounce, through * (1.0 - next) / bounce);
    }
    t
}

/// Glass over water, seen straight from above: n₁ → n₂ → n₃ → n₁. The wall between is written once, by the glass, and
/// the water reaches into it; or by the water, and the glass reaches into that; or twice, and the faces coincide.
#[test]
fn the_indices_at_a_boundary_are_those_of_the_bodies_on_its_sides() {
    for (name, glass_low, water_high, priorities) in [
        ("water reaches into glass", -1.0, -0.4, [1, 0]),
        ("glass reaches into water", -1.7, -1.0, [0, 1]),
        ("faces coincide, glass first", -1.0, -1.0, [1, 0]),
        ("faces coincide, water first", -1.0, -1.0, [0, 1]),
        ("faces coincide, alike", -1.0, -1.0, [0, 0]),
    ] {
        let world = || {
            let mut world = from_above();
            layer(&mut world, [glass_low, 0.0], glass(1.5, 0.0), Some(absorber(0.3)), priorities[0]);
            layer(&mut world, [-2.0, water_high], glass(1.33, 0.0), Some(absorber(0.5)), priorities[1]);
            world.half_sky(0.0, 1.0);
            world
        };
        let expected = DEPTHS
            .map(f64::from)
            .map(|s| stack(&[1.0, 1.5, f64::from(1.33f32), 1.0], &[(-0.3 * s).exp(), (-0.5 * s).exp()]));
        assert_all(name, world, expected, 0.04, 10_000);
        assert_eq!(tally(world(), 2_000).leaks, 0);
    }
}

/// The deliberate opposite: two slabs that touch, without priorities, each with its index against vacuum as pbrt and
/// Mitsuba read it. The wall between is two surfaces of which a ray meets one, and the index against vacuum holds there.
#[test]
fn without_priorities_a_surface_means_what_it_says() {
    let mut world = from_above();
    world.slab(1.0, glass(1.5, 0.0), absorber(0.3));
    world.half_sky(0.0, 1.0);
    let expected = DEPTHS.map(f64::from).map(|s| stack(&[1.0, 1.5, 1.0], &[(-0.3 * s).exp()]));
    assert_mean("one slab", &world.measure(&VolPath::default(), 40_000), expected, 0.02);
}

/// A glass of milk in a furnace: whether the milk reaches into the wall, coincides with it, or leaves an air gap, nothing
/// is made or lost. Radiance 1 along every path.
#[test]
fn a_glass_of_milk_under_a_uniform_sky_vanishes() {
    for (name, radius) in [("overlap", 0.9), ("coincide", 0.8), ("gap", 0.75)] {
        let world = || {
            let mut world = World::seen(Vec3::new(0.1, 0.3, 5.0), Vec3::new(0.1, 0.3, 0.0));
            let turned = Sphere::new(Vec3::ZERO, 0.8);
            world.sphere(Vec3::ZERO, 1.0, glass(1.5, 0.0), None);
            let wall = world.objects[0].clone();
            world.objects.push(wall);
            world.builder.add_sphere(turned, &Transform::IDENTITY, true).unwrap();
            world.with_priority(1, 2);
            world.sphere(Vec3::ZERO, radius, glass(1.33, 0.0), Some(medium([0.0; 3], [0.5, 2.0, 4.0], 0.5)));
            world.with_priority(0, 1);
            world.sky(1.0);
            world
        };
        assert_all(name, world, [1.0; 3], 0.04, 10_000);
        let tally = tally(world(), 5_000);
        assert_eq!((tally.leaks, tally.lost_bodies), (0, 0), "{name}");
    }
}

/// The same with flat walls: boxes whose inner wall and liquid coincide on five faces, with edges and corners.
#[test]
fn a_box_of_milk_under_a_uniform_sky_vanishes() {
    let cube = |world: &mut World, half: f32, skin: Material, inside: Option<Homogeneous>, priority: i32| {
        world.cuboid(Vec3::splat(-half), Vec3::splat(half), skin, inside);
        world.with_priority(priority, 1);
    };
    let world = || {
        let mut world = World::seen(Vec3::new(0.3, 0.2, 5.0), Vec3::new(0.1, 0.15, 0.0));
        cube(&mut world, 1.0, glass(1.5, 0.0), None, 0);
        cube(&mut world, 0.7, glass(1.33, 0.0), Some(medium([0.0; 3], [0.5, 2.0, 4.0], 0.5)), 1);
        // The same again, of the same index: an equal body that coincides everywhere.
        cube(&mut world, 0.7, glass(1.33, 0.0), Some(medium([0.0; 3], [0.5, 1.0, 0.0], -0.3)), 1);
        world.sky(1.0);
        world
    };
    assert_all("boxes", world, [1.0; 3], 0.05, 10_000);
    let tally = tally(world(), 10_000);
    assert_eq!((tally.leaks, tally.lost_bodies), (0, 0));
}

/// Of two bodies of one index that touch, the boundary is not there, however rough it is; in spectral mode.
#[test]
fn a_body_of_the_same_glass_in_glass_is_not_there() {
    let world = || {
        let mut world = World::seen(Vec3::new(0.1, 0.3, 5.0), Vec3::new(0.1, 0.3, 0.0));
        world.color = ColorMode::Spectral;
        world.sphere(Vec3::ZERO, 1.0, glass(1.5, 0.0), None);
        world.with_priority(0, 1);
        world.sphere(Vec3::ZERO, 0.6, glass(1.5, 0.4), Some(medium([0.0; 3], [0.5, 2.0, 4.0], 0.5)));
        world.with_priority(1, 1);
        world.sky(1.0);
        world
    };
    for integrator in [&VolPath::default() as &dyn Integrator, &Analog] {
        assert_mean("same glass", &world().measure(integrator, 80_000), [1.0; 3], 0.02);
    }
}

/// Two fogs that share a place scatter as one with the sum of their coefficients and the mixture of their phase functions:
/// once-scattered light of a lamp straight behind, as in `a_lamp_behind_fog_is_seen_once_scattered_as_the_integral_says`,
/// with `Σ σ_s,i p_i(1)` in place of `σ_s/4π`.
#[test]
fn fogs_that_share_a_place_mix_their_phase_functions() {
    let [s1, s2] = [[0.1f32, 0.5, 0.0], [0.6f32, 0.2, 1.0]];
    let [g1, g2] = [0.5f32, -0.3];
    let lamp = 3.0f64;
    let world = || {
        let mut world = World::seen(Vec3::new(0.0, 1.0, 0.0), Vec3::ZERO);
        layer(&mut world, [-1.0, 0.0], Material::Null, Some(medium(times(DEPTHS, 0.3), s1, g1)), 0);
        layer(&mut world, [-1.0, 0.0], Material::Null, Some(medium([0.1; 3], s2, g2)), 0);
        let (position, intensity) = (Vec3::new(0.0, -lamp as f32, 0.0), Spectrum::constant(1.0));
        world.lights.push(Light::Point(PointLight { position, intensity, luminance: 1.0 }));
        world
    };
    let forward = |g: f32| {
        let g = f64::from(g);
        (1.0 - g * g) / (4.0 * PI * (1.0 - g).powi(3))
    };
    let expected = std::array::from_fn(|c| {
        let tau = f64::from(0.3 * DEPTHS[c] + 0.1 + s1[c] + s2[c]);
        let scattered = f64::from(s1[c]) * forward(g1) + f64::from(s2[c]) * forward(g2);
        scattered * (1.0 / (lamp - 1.0) - 1.0 / lamp) * (-tau).exp()
    });
    let single = VolPath { max_depth: Some(1), ..VolPath::default() };
    assert_mean("once scattered", &world().measure(&single, 200_000), expected, 0.01);
}

/// Under a uniform sky they vanish; and they shine with the sum of what they emit: σ₁L₁ + σ₂L₂ per length, thick or thin,
/// `(σ₁L₁ + σ₂L₂)/(σ₁ + σ₂) · (1 − exp(−(σ₁ + σ₂)d))`.
#[test]
fn fogs_that_share_a_place_add_what_they_emit() {
    let vanishing = || {
        let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
        world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(medium([0.0; 3], [1.0, 3.0, 0.0], 0.8)));
        world.with_priority(0, 1);
        world.sphere(Vec3::X, 1.0, Material::Null, Some(medium([0.0; 3], [4.0, 0.5, 2.0], -0.5)));
        world.with_priority(0, 1);
        world.sky(1.0);
        world
    };
    assert_all("vanishing", vanishing, [1.0; 3], 0.03, 40_000);
    let shining = || {
        let mut world = from_above();
        for (by, le) in [(0.5, 3.0), (1.0, 1.0)] {
            let emission = Some(Spectrum::illuminant_rgb([le; 3]));
            layer(&mut world, [-1.0, 0.0], Material::Null, Some(Homogeneous { emission, ..absorber(by) }), 0);
        }
        world
    };
    let expected = DEPTHS.map(f64::from).map(|s| 2.5 / 1.5 * (1.0 - (-1.5 * s).exp()));
    for integrator in [&VolPath::default() as &dyn Integrator, &Analog] {
        assert_mean("shining", &shining().measure(integrator, 100_000), expected, 0.02);
    }
}

/// Fog through which a glass of absorbing liquid stands ends at the glass. Straight down: fog 1, glass, liquid 2, glass, fog.
#[test]
fn fog_ends_at_the_glass_that_stands_in_it() {
    let world = || {
        let mut world = from_above();
        layer(&mut world, [-4.0, 1.0], Material::Null, Some(absorber(0.2)), 0);
        layer(&mut world, [-3.0, 0.0], glass(1.5, 0.0), None, 2);
        world.half_sky(0.0, 1.0);
        world
    };
    let expected = DEPTHS.map(f64::from).map(|s| stack(&[1.0, 1.5, 1.0], &[1.0]) * (-0.4 * s).exp());
    assert_all("fog and glass", world, expected, 0.03, 15_000);
}

/// A camera in the middle of nested bodies, which nobody tells where it is: it sees out as through what is there. In fog
/// of radius 2 (without or with a priority) and a body of radius 1 in it.
#[test]
fn what_the_camera_is_in_is_found_by_what_encloses_it() {
    let eye = || World::seen(Vec3::new(0.1, 0.0, 0.0), Vec3::X);
    let ball = |world: &mut World, r: f32, by: f32, priority: Option<i32>| {
        world.sphere(Vec3::new(0.1, 0.0, 0.0), r, Material::Null, Some(absorber(by)));
        if let Some(priority) = priority {
            world.with_priority(priority, 1);
        }
    };
    for (name, outer, inner, depth) in [
        ("written", None, None, 1.0),
        ("in fog that says nothing", None, Some(0), 1.0),
        ("added", Some(0), Some(0), 2.0 * 0.3 + 0.4),
        ("cut out", Some(0), Some(1), 0.4 + 0.3),
        ("lower", Some(1), Some(0), 0.6),
    ] {
        let world = || {
            let mut world = eye();
            ball(&mut world, 2.0, 0.3, outer);
            ball(&mut world, 1.0, 0.4, inner);
            if name == "written" {
                // What is outside of the inner one is the fog, and the file says so: 1·0.4 + 1·0.3 is not 1.0.
                world.objects[1].interface.as_mut().unwrap().outside = Some(MediumId(0));
            }
            world.sky(1.0);
            world
        };
        let depth = if matches!(name, "written" | "in fog that says nothing") { 0.7 } else { depth };
        assert_all(name, world, passes(depth), 0.03, 20_000);
    }
    // A bumpy mesh, and a body that stands elsewhere.
    let world = || {
        let mut world = eye();
        world.faceted_ball(1.0, 12, Material::Null, absorber(1.0));
        world.objects[0].interface.as_mut().unwrap().outside = None;
        world.sphere(Vec3::new(9.0, 0.0, 9.0), 1.0, Material::Null, Some(absorber(1.0)));
        world.sky(1.0);
        world
    };
    // Along x the ball of 24 segments has a vertex at (1, 0, 0): the way is 0.9.
    assert_all("mesh", world, passes(0.9), 0.03, 20_000);
}

/// What the file says about the camera's medium holds, whatever encloses it.
#[test]
fn what_the_file_says_of_the_camera_holds() {
    let mut world = World::seen(Vec3::ZERO, Vec3::X);
    world.sphere(Vec3::ZERO, 2.0, Material::Null, Some(absorber(0.3)));
    world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(absorber(0.4)));
    world.with_priority(0, 1);
    world.camera.medium = Some(MediumId(0));
    world.sky(1.0);
    assert_mean("said", &world.measure(&VolPath::default(), 30_000), passes(0.6), 0.02);
}

/// A lamp in the middle of two absorbing balls of radii 1 and 2 lights a wall at distance 4:
/// `L = ρ/π · I/d² · exp(−τ)`, with the fog on the shadow ray found by what it crosses.
#[test]
fn a_lamp_inside_of_bodies_shines_through_them() {
    for (priorities, depth) in [([0, 0], 0.3 * 2.0 + 0.4), ([0, 1], 0.3 + 0.4), ([1, 0], 0.6)] {
        let world = || {
            let mut world = World::seen(Vec3::new(0.0, 0.0, 3.5), Vec3::new(0.0, 0.0, 4.0));
            for (r, by, priority) in [(2.0, 0.3, priorities[0]), (1.0, 0.4, priorities[1])] {
                world.sphere(Vec3::ZERO, r, Material::Null, Some(absorber(by)));
                world.with_priority(priority, 1);
            }
            world.cuboid(Vec3::new(-9.0, -9.0, 4.0), Vec3::new(9.0, 9.0, 5.0), diffuse(0.5), None);
            let intensity = Spectrum::constant(1.0);
            world.lights.push(Light::Point(PointLight { position: Vec3::ZERO, intensity, luminance: 1.0 }));
            world
        };
        let expected = passes(depth).map(|t| 0.5 / PI / 16.0 * t);
        let once = VolPath { max_depth: Some(1), ..VolPath::default() };
        assert_mean(&format!("{priorities:?}"), &world().measure(&once, 2_000), expected, 1e-4);
        assert_mean("lecture", &world().measure(&Lecture::VolumeV1, 20_000), expected, 0.02);
    }
}

/// One ball in a group, placed three times in a row, at twice its size, mirrored, and so that two copies overlap: each copy is
/// a body of its own. Copies at x = −3 (radius 1) and at 2 and 3 (radius 2 and 1): chords 2, 4 and 2, which add.
#[test]
fn each_copy_of_a_group_is_a_body_of_its_own() {
    let place = |x: f64, scale: f64| {
        let scale = glam::DVec3::new(-scale, scale, scale);
        Transform::new(glam::DMat4::from_translation(glam::DVec3::X * x) * glam::DMat4::from_scale(scale)).unwrap()
    };
    for with_mesh in [false, true] {
        for eye in [-9.0, -3.0] {
            let world = || {
                let mut world = World::seen(Vec3::new(eye, 0.0, 0.0), Vec3::X * 10.0);
                let group = world.builder.begin_group();
                world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(absorber(0.1)));
                world.with_priority(0, 1);
                if with_mesh {
                    // Two more shapes, so that the group has a tree of its own; beside the way.
                    for y in [5.0, -5.0] {
                        world.cuboid(Vec3::new(0.0, y, 0.0), Vec3::new(1.0, y + 1.0, 1.0), diffuse(0.0), None);
                    }
                }
                world.builder.end_group();
                for (x, scale) in [(-3.0, 1.0), (2.0, 2.0), (3.0, 1.0)] {
                    world.builder.add_instance(group, &place(x, scale)).unwrap();
                }
                world.sky(1.0);
                world
            };
            let chords = if eye == -9.0 { 8.0 } else { 7.0 };
            assert_all(&format!("from {eye}, tree {with_mesh}"), world, passes(0.1 * chords), 0.03, 10_000);
        }
    }
}

/// Without priorities too: a placed fog encloses a camera, and a scattering one vanishes.
#[test]
fn placed_media_without_priorities_hold_and_are_found() {
    let place = Transform::new(glam::DMat4::from_scale(glam::DVec3::splat(2.0))).unwrap();
    let world = |eye: Vec3, fog: Homogeneous| {
        let mut world = World::seen(eye, Vec3::ZERO);
        let group = world.builder.begin_group();
        world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(fog));
        world.builder.end_group();
        world.builder.add_instance(group, &place).unwrap();
        world.sky(1.0);
        world
    };
    let inside = || world(Vec3::new(1.0, 0.0, 0.0), absorber(0.3));
    assert_all("absorbing", inside, passes(0.9), 0.03, 20_000);
    let outside = || world(Vec3::new(5.0, 0.3, 0.0), medium([0.0; 3], DEPTHS, 0.5));
    assert_all("scattering", outside, [1.0; 3], 0.02, 20_000);
}

/// A batch of cameras stands where its cameras do, and not at the origin of the world, which a fog encloses here: looking away
/// from the fog, they see the sky as it is.
#[test]
fn a_batch_is_where_its_cameras_are() {
    let mut world = World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::new(0.0, 9.0, 0.0));
    let views = vec![world.camera.view.clone(), world.camera.view.clone()];
    world.camera.view = View { to_world: Transform::IDENTITY, model: CameraModel::Batch(Batch { views }), near: 0.0 };
    world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(absorber(1.0)));
    world.sky(1.0);
    assert_mean("batch", &world.measure(&VolPath::default(), 1_000), [1.0; 3], 0.01);
}

/// Surfaces with edges have no inside that could be counted: what the last one said holds. Disks at 0 and −1 look up and
/// fill what is behind with fog, one at −2 looks down: straight through, the fog is 2 deep, with a priority or without.
#[test]
fn behind_an_open_surface_the_last_one_crossed_holds() {
    for priority in [None, Some(0)] {
        let world = || {
            let mut world = from_above();
            world.media.push(absorber(0.4));
            for (y, up) in [(0.0, true), (-1.0, true), (-2.0, false)] {
                world.materials.push(Material::Null);
                world.objects.push(tyndall::scene::Object {
                    name: String::new(),
                    material: tyndall::scene::MaterialId(world.materials.len() as u32 - 1),
                    interface: Some(MediumInterface { inside: Some(MediumId(0)), outside: None }),
                    emission: tyndall::scene::Emission::None,
                    body: None,
                });
                let turn = glam::DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2);
                let at = glam::DMat4::from_translation(glam::DVec3::Y * y);
                let place = Transform::new(at * turn).unwrap();
                world.builder.add_disk(Disk::new(0.0, 3.0, 0.0), &place, !up).unwrap();
            }
            if let Some(priority) = priority {
                world.with_priority(priority, 3);
            }
            world.sky(1.0);
            world
        };
        assert_all(&format!("{priority:?}"), world, passes(0.8), 0.03, 10_000);
        assert_eq!(tally(world(), 1_000).leaks, 0);
    }
}

/// Water on a floor whose face coincides with its bottom: the floor is what is met. It reflects all, and so does the water:
/// under a sky of radiance 1 the sight is 1, and nothing of the glare below (100) comes through.
#[test]
fn a_floor_that_coincides_with_the_bottom_of_water_holds() {
    let world = |top: f32| {
        let mut world = World::seen(Vec3::new(0.3, 5.0, 0.1), Vec3::ZERO);
        let wide = 1e4;
        world.cuboid(Vec3::new(-wide, -2.0, -wide), Vec3::new(wide, top, wide), diffuse(1.0), None);
        layer(&mut world, [-1.0, 0.0], glass(1.33, 0.0), None, 0);
        world.half_sky(1.0, 100.0);
        world
    };
    for integrator in [&VolPath::default() as &dyn Integrator, &Analog] {
        // Exactly, or by one rounding below or above it: which face a ray reports differs.
        for top in [-1.0f32, (-1.0f32).next_down(), (-1.0f32).next_up()] {
            assert_mean(&format!("floor at {top}"), &world(top).measure(integrator, 40_000), [1.0; 3], 0.01);
        }
    }
}

/// A path can be in eight bodies at once. The ninth and tenth are not there, and that is told: straight through ten nested balls
/// of one priority, of radii 1 to 10, the eight outer ones absorb: Σ 2r for r = 3..10 is 104.
#[test]
fn more_bodies_than_a_path_can_count_are_told() {
    let world = |least: u32| {
        let mut world = World::seen(Vec3::new(0.0, 0.0, 50.0), Vec3::ZERO);
        for r in least..=10 {
            world.sphere(Vec3::ZERO, r as f32, Material::Null, Some(absorber(0.005)));
            world.with_priority(0, 1);
        }
        world.sky(1.0);
        world
    };
    assert_all("eight", || world(3), passes(0.005 * 104.0), 0.03, 10_000);
    assert_all("ten", || world(1), passes(0.005 * 104.0), 0.03, 10_000);
    assert_eq!(tally(world(3), 100).lost_bodies, 0);
    assert!(tally(world(1), 100).lost_bodies > 0);
}

/// A ball of 10⁻³ or 10⁵ mean free paths, a metre or a micrometre across (in metres). It scatters: it vanishes. It absorbs
/// and emits 1: along its diameter it shines with `1 − exp(−τ)`.
#[test]
fn balls_of_any_depth_and_any_size_vanish_and_shine() {
    for size in [1.0f32, 1e-6, 1e6] {
        for depth in [1e-3f32, 1e5] {
            for skin in [None, Some(glass(1.4, 0.0))] {
                let open = skin.is_none();
                let skin = skin.unwrap_or(Material::Null);
                let seen = || World::seen(Vec3::new(0.0, 0.1, 2.0) * size, Vec3::new(0.0, 0.1, 0.0) * size);
                let name = format!("size {size:e}, depth {depth:e}, open {open}");
                let sigma = [depth / size; 3];

                let mut world = seen();
                world.sphere(Vec3::ZERO, 0.5 * size, skin.clone(), Some(medium([0.0; 3], sigma, 0.0)));
                world.sky(1.0);
                let (spp, precision) = if depth > 1.0 { (60, 0.15) } else { (20_000, 0.01) };
                assert_mean(
                    &format!("{name}, scattering"),
                    &world.measure(&VolPath::default(), spp),
                    [1.0; 3],
                    precision,
                );
                if open {
                    let mut world = World::seen(Vec3::new(0.0, 0.0, 2.0) * size, Vec3::ZERO);
                    let emission = Some(Spectrum::illuminant_rgb([1.0; 3]));
                    let glowing = Homogeneous { emission, ..medium(sigma, [0.0; 3], 0.0) };
                    world.sphere(Vec3::ZERO, 0.5 * size, skin, Some(glowing));
                    let expected = -(-f64::from(depth)).exp_m1();
                    assert_mean(
                        &format!("{name}, glowing"),
                        &world.measure(&VolPath::default(), 2_000_000),
                        [expected; 3],
                        0.05,
                    );
                }
            }
        }
    }
}

/// A box whose normals point inwards has its medium around it: of the way up to a lamp at height 4 the 3 above the box
/// absorb, `L exp(−3σ)`. Behind glass too light samples reach its lamps,
/// and what paths run into counts in full: as the naive twin has it.
#[test]
fn a_body_that_is_inside_out_has_its_medium_around_it() {
    let seen = |inside| {
        let mut world = World::seen(Vec3::new(0.0, -5.0, 0.0), Vec3::new(0.0, 4.0, 1e-3));
        // Mirrored in y.
        world.cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, -1.0, 1.0), Material::Null, Some(inside));
        world
    };
    let mut lamp = seen(absorber(1.0));
    lamp.shining_disk(4.0, 1.0, diffuse(0.0), 2.0);
    let expected = DEPTHS.map(|s| 2.0 * f64::from(-3.0 * s).exp());
    assert_mean("lamp", &lamp.measure(&VolPath::default(), 20_000), expected, 0.02);
    let room = || {
        let mut world = World::seen(Vec3::new(0.0, -1.5, 0.0), Vec3::new(0.0, 4.0, 1e-3));
        let fog = medium([0.2; 3], [0.5; 3], 0.0);
        world.cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, -1.0, 1.0), glass(1.0, 0.1), Some(fog));
        world.shining_disk(3.0, 3.0, diffuse(0.0), 2.0);
        world
    };
    let [volpath, analog] = [&VolPath::default() as &dyn Integrator, &Analog].map(|by| room().measure(by, 200_000));
    let z = (volpath.mean[0] - analog.mean[0]) / volpath.standard_error[0].hypot(analog.standard_error[0]);
    assert!(z.abs() < 4.5 && analog.standard_error[0] < 0.01, "{volpath:?} {analog:?}");
}

/// Fog that only a body of glass knows, and that is all around it (it is inside out), is lit by the lamps in it: light
/// samples and the naive twin agree, seen from the fog itself and through the glass.
#[test]
fn fog_around_glass_that_is_inside_out_is_lit() {
    for camera in [Some(MediumId(0)), None] {
        let world = || {
            let mut world = World::seen(Vec3::new(0.0, 0.0, -4.0), Vec3::ZERO);
            let fog = medium([0.01; 3], [0.1, 0.2, 0.4], 0.0);
            // Mirrored in y.
            world.cuboid(Vec3::new(-1.0, 1.0, -2.0), Vec3::new(1.0, -1.0, -1.0), glass(1.5, 0.0), Some(fog));
            world.camera.medium = camera;
            world.shining_disk(4.0, 3.0, diffuse(0.0), 2.0);
            world
        };
        let naive = world().measure(&Analog, 400_000);
        let clever = world().measure(&VolPath::default(), 40_000);
        for c in 0..3 {
            let error = naive.standard_error[c].hypot(clever.standard_error[c]);
            let z = (clever.mean[c] - naive.mean[c]) / error;
            assert!(z.abs() < 4.5, "{camera:?}, channel {c}: {} and {} (z = {z:.1})", clever.mean[c], naive.mean[c]);
            assert!(error < 0.02 * naive.mean[c], "too blunt: {error:.2e} of {:.2e}", naive.mean[c]);
        }
    }
}
