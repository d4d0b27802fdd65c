//! Light at the end of a way through a clear medium: without noise, and of the right amount.

mod common;

use common::{World, assert_agree, diffuse, measure, medium};
use tyndall::{
    integrator::{Analog, VolPath},
    material::Material,
    math::Vec3,
    medium::{Homogeneous, Inside, MediumId},
    scene::Scene,
    spectrum::{ColorMode, Wavelengths},
};

/// What of the fog there is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fog {
    /// A box in a vacuum; the camera is outside.
    Box,
    /// A ball, which a path can meet twice on its way: nobody looks through it from outside.
    Ball,
    /// All that there is.
    Everywhere,
}

/// A large lamp above fog and a floor, and a sky.
fn lamp_above(fog: Fog, color: ColorMode, content: Homogeneous) -> Scene {
    let mut world = World::seen(Vec3::new(0.4, -0.9, 0.3), Vec3::new(0.0, 3.0, 0.0));
    world.color = color;
    match fog {
        Fog::Box => {
            world.cuboid(Vec3::new(-1.0, -0.5, -1.0), Vec3::new(1.0, 1.0, 1.0), Material::Null, Some(content));
        }
        Fog::Ball => {
            world.sphere(Vec3::new(0.0, 0.3, 0.0), 0.8, Material::Null, Some(content));
        }
        Fog::Everywhere => {
            world.media.push(content);
            world.camera.medium = Some(MediumId(0));
        }
    }
    world.cuboid(Vec3::new(-2.0, -1.2, -2.0), Vec3::new(2.0, -1.0, 2.0), diffuse(0.6), None);
    world.shining_disk(1.3, 0.7, diffuse(0.2), 3.0);
    world.sky(0.3);
    world.scene()
}

/// Seen directly, each sample is `exp(−σ_t d) L`: the error of the mean is that of the different lengths of the ways.
#[test]
fn a_lamp_behind_clear_fog_is_seen_without_noise() {
    let (sigma_a, sigma_s) = ([0.1, 0.2, 0.3], [0.2, 0.2, 0.1]);
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        for fog in [Fog::Box, Fog::Everywhere] {
            let seen = |content| {
                let scene = lamp_above(fog, color, content);
                measure(&scene, &VolPath { max_depth: Some(0), ..VolPath::default() }, 1000)
            };
            let (clear, foggy) = (seen(medium([0.0; 3], [0.0; 3], 0.0)), seen(medium(sigma_a, sigma_s, 0.0)));
            for c in 0..3 {
                // The camera is 0.9 below the origin and looks straight at it, nearly.
                let slope = Vec3::new(0.4, -3.9, 0.3).length() / 3.9;
                let way = f64::from(if fog == Fog::Box { 1.5 * slope } else { 2.2 * slope });
                let transmittance = (-f64::from(sigma_a[c] + sigma_s[c]) * way).exp();
                let (ratio, error) = (foggy.mean[c] / clear.mean[c], foggy.standard_error[c] / foggy.mean[c]);
                if color == ColorMode::Rgb {
                    assert!((ratio / transmittance - 1.0).abs() < 1e-5, "{fog:?} {c}: {ratio} for {transmittance}");
                }
                // Wavelengths are drawn, and make noise without fog too.
                let without = clear.standard_error[c] / clear.mean[c];
                assert!(error < 2.0 * without + 1e-5, "{color:?} {fog:?} {c}: {error} beside {without}");
            }
        }
    }
}

/// All orders, with light samples beside: the lamp is as likely to be found by either.
#[test]
fn what_is_found_ahead_is_what_flights_find() {
    for fog in [Fog::Box, Fog::Ball, Fog::Everywhere] {
        for (color, g) in [(ColorMode::Rgb, 0.8), (ColorMode::Spectral, 0.0), (ColorMode::Mono, -0.4)] {
            let scene = lamp_above(fog, color, medium([0.1, 0.1, 0.2], [0.3, 0.3, 0.1], g));
            let within = Inside::of(&scene, Some(MediumId(0)), &Wavelengths::Rgb);
            assert_eq!(scene.looks_ahead(&within), fog != Fog::Ball);
            let looking = measure(&scene, &VolPath::default(), 40_000);
            let naive = measure(&scene, &Analog, 400_000);
            assert_agree(&format!("{fog:?}, {color:?}, g = {g}"), [looking, naive], 0.01);
        }
    }
}

/// Through a box and through fog that is everywhere, not through a ball from outside; never through what is deep.
#[test]
fn paths_look_through_clear_media() {
    for (fog, outside) in [(Fog::Box, true), (Fog::Ball, false), (Fog::Everywhere, false)] {
        for (sigma_s, is_clear) in [(0.1, true), (30.0, false)] {
            let scene = lamp_above(fog, ColorMode::Rgb, medium([0.0; 3], [sigma_s; 3], 0.0));
            let within = Inside::of(&scene, Some(MediumId(0)), &Wavelengths::Rgb);
            assert_eq!(scene.looks_ahead(&within), is_clear && fog != Fog::Ball, "{fog:?} {sigma_s}");
            assert_eq!(scene.looks_ahead(&Inside::Vacuum), outside, "{fog:?}");
        }
    }
}
