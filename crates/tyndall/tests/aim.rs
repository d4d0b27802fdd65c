//! Collisions aimed at lamps: the light of closed forms, and that of flights alone.

mod common;

use common::{World, assert_agree, assert_mean, diffuse, grey, measure, medium};
use tyndall::{
    integrator::{Deep, VolPath, walk::Depths},
    light::{Light, PointLight},
    material::Material,
    math::Vec3,
    medium::{Homogeneous, MediumId},
    scene::Scene,
    spectrum::{ColorMode, Wavelengths},
};

const SIGMA_A: [f32; 3] = [0.1, 0.0, 0.4];
const SIGMA_S: [f32; 3] = [0.2, 0.5, 0.1];

/// A lamp of intensity 1 at the centre of a ball of fog of radius 2, seen along a ray that passes it at distance `beside`.
fn lamp_in_fog(color: ColorMode, beside: f32) -> Scene {
    let mut world = World::seen(Vec3::new(beside, 0.0, 5.0), Vec3::new(beside, 0.0, 0.0));
    world.color = color;
    world.sphere(Vec3::ZERO, 2.0, Material::Null, Some(medium(SIGMA_A, SIGMA_S, 0.0)));
    world.lights.push(Light::Point(PointLight { position: Vec3::ZERO, intensity: grey(1.0), luminance: 1.0 }));
    world.scene()
}

/// `∫ σ_s/(4π r²) exp(−σ_t (t + r)) dt` along the chord of the ball, by the midpoint rule in the angle at the lamp.
fn scattered_once(beside: f64) -> [f64; 3] {
    const STEPS: u32 = 20_000;
    let half = (4.0 - beside * beside).sqrt();
    let most = (half / beside).atan();
    std::array::from_fn(|c| {
        let (sigma_s, sigma_t) = (f64::from(SIGMA_S[c]), f64::from(SIGMA_S[c]) + f64::from(SIGMA_A[c]));
        let along = |i: u32| {
            let angle = most * ((f64::from(i) + 0.5) / f64::from(STEPS) * 2.0 - 1.0);
            // dt = beside / cos² dφ, r = beside / cos
            let (t, r) = (half + beside * angle.tan(), beside / angle.cos());
            sigma_s / (4.0 * std::f64::consts::PI * beside) * (-sigma_t * (t + r)).exp()
        };
        (0..STEPS).map(along).sum::<f64>() * 2.0 * most / f64::from(STEPS)
    })
}

/// However near the ray passes: the error of flights alone grows as `1/√beside`, that of aimed collisions does not.
#[test]
fn light_that_a_lamp_sends_through_fog_is_found_at_every_distance() {
    let once = |deep| VolPath { max_depth: Some(1), deep, ..VolPath::default() };
    for beside in [1.0, 0.1, 0.003] {
        let expected = scattered_once(f64::from(beside));
        for color in [ColorMode::Rgb, ColorMode::Spectral] {
            let scene = lamp_in_fog(color, beside);
            let aimed = measure(&scene, &once(Deep::Together), 20_000);
            assert_eq!(aimed, measure(&scene, &once(Deep::Alone), 20_000));
            // Uplifted colours come back to 10⁻³ or so: there the error is compared alone.
            if color == ColorMode::Rgb {
                assert_mean(&format!("a lamp {beside} beside the ray"), &aimed, expected, 0.004);
            }
            let flights = measure(&scene, &once(Deep::Traced), 20_000);
            let gain = flights.standard_error[1] / aimed.standard_error[1];
            assert!(
                gain > 0.3 / f64::from(beside).sqrt(),
                "{color:?}, {beside}: error of flights over that of aimed ones {gain}"
            );
        }
    }
}

/// Fog over a floor with a small lamp that paths run into, one without a surface, and a large one.
fn three_lamps(color: ColorMode, fog: Homogeneous) -> Scene {
    let mut world = World::seen(Vec3::new(0.3, 0.8, 3.0), Vec3::new(0.1, 0.5, 0.0));
    world.color = color;
    world.cuboid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0), Material::Null, Some(fog));
    world.cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, -0.01, 9.0), diffuse(0.5), None);
    world.shining_sphere(Vec3::new(-0.2, 0.6, 0.0), 0.08, diffuse(0.2), 20.0, false);
    world.shining_disk(1.9, 0.7, diffuse(0.0), 1.0);
    let position = Vec3::new(0.4, 0.3, 0.2);
    world.lights.push(Light::Point(PointLight { position, intensity: grey(0.2), luminance: 0.2 }));
    world.scene()
}

/// All three techniques and all orders, in media whose lanes differ.
#[test]
fn aimed_collisions_find_the_light_that_flights_find() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        for g in [0.0, 0.7] {
            let scene = three_lamps(color, medium([0.1, 0.2, 0.0], [0.3, 1.0, 2.0], g));
            let aimed = measure(&scene, &VolPath::default(), 60_000);
            let flights = measure(&scene, &VolPath { deep: Deep::Traced, ..VolPath::default() }, 120_000);
            assert_agree(&format!("{color:?}, g = {g}"), [aimed, flights], 0.03);
        }
    }
}

/// Multiple importance sampling over the lanes supposes that a path would have been treated alike with any of them as hero:
/// in a body deep in one lane and shallow in another, and in one where a lane does not scatter.
#[test]
fn what_a_path_does_in_a_medium_does_not_depend_on_the_hero() {
    for (sigma_a, sigma_s) in [([0.0; 3], [0.4, 3.0, 12.0]), ([2.0; 3], [0.0, 1.0, 5.0]), ([0.0; 3], [0.2, 0.3, 0.9])] {
        for lamp_radius in [0.01, 0.5] {
            let mut world = World::seen(Vec3::new(0.0, 0.3, 4.0), Vec3::ZERO);
            world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(medium(sigma_a, sigma_s, 0.0)));
            world.shining_sphere(Vec3::ZERO, lamp_radius, diffuse(0.2), 20.0, false);
            let scene = world.scene();
            let coefficients = scene.media[0].coefficients(&Wavelengths::Rgb);
            let answers = |hero| {
                let depths = Depths::of(&scene, MediumId(0), &coefficients, hero)?;
                let ways = [0.01, 0.03, 0.1, 0.3, 1.0];
                let answers =
                    (depths.farthest(&scene), ways.map(|way| depths.is_roomy(way)), ways.map(|way| depths.odds(way)));
                Some((answers, depths.limit))
            };
            for hero in 1..4 {
                assert_eq!(answers(hero), answers(0), "{sigma_a:?} {sigma_s:?} {lamp_radius} {hero}");
            }
        }
    }
}
