//! Samples that are shared out by error: unbiased, and of less error.

mod common;

use common::World;
use testkit::assert_mean;
use tyndall::{
    camera::{CameraModel, Perspective},
    integrator::{CameraSample, Integrator},
    math::Vec3,
    render::{Allocation, Settings, render},
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};

/// Light that one sample of many finds: 1 in the mean.
#[derive(Debug)]
struct Rare {
    odds: f32,
}

impl Integrator for Rare {
    fn li(&self, _: &Scene, seen: &CameraSample, _: &mut Tally) -> Lanes {
        let found = { seen.sampler }.rng.next_1d() < self.odds;
        Lanes::splat(if found { 1.0 / self.odds } else { 0.0 })
    }
}

/// Noise whose standard deviation is 20 times as large to the right of the middle as to its left; 1 in the mean.
#[derive(Debug)]
struct RightHalfIsNoisy;

impl Integrator for RightHalfIsNoisy {
    fn li(&self, _: &Scene, seen: &CameraSample, _: &mut Tally) -> Lanes {
        let noise = if seen.ray.dir.x > 0.0 { 1.0 } else { 0.05 };
        Lanes::splat(1.0 + noise * ({ seen.sampler }.rng.next_1d() - 0.5))
    }
}

fn plain(width: u32, height: u32) -> Scene {
    let mut world = World::seen(Vec3::ZERO, Vec3::Z);
    (world.camera.width, world.camera.height) = (width, height);
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.5, 0.5, -0.5, 0.5]));
    world.scene()
}

fn by_error(spp: u32, seed: u64) -> Settings {
    Settings { spp, seed, allocation: Allocation::ByError, ..Settings::default() }
}

/// One sample in twenty finds light, so that the eight of the first look miss it in two pixels of three. Were a pixel's own first
/// samples asked how many it gets, those that missed it would keep half of the samples, and the image would be too dark: by 30 %
/// if they weigh ten times what those of the next pixel do (z = −185).
#[test]
fn rare_light_keeps_its_mean() {
    let scene = plain(12, 12);
    let means = (0..2000).map(|seed| {
        let film = render(&scene, &Rare { odds: 0.05 }, &by_error(24, seed), &()).film;
        assert!(film.pixels.iter().any(|pixel| pixel.count != film.pixels[0].count), "shared out");
        film.pixels.iter().map(|pixel| f64::from(pixel.mean()[0])).sum::<f64>() / film.pixels.len() as f64
    });
    assert_mean(means, 1.0);
}

/// With deviations of 1 and 1/20 in the halves, samples in a proportion of 3 to 1 (the least is a half) leave `1/1.5` of
/// the error of even ones. (The mean square of 512 normal deviates is known to 6 %, so the quotient of two is to 0.06.)
#[test]
fn error_is_less_than_with_even_samples() {
    let scene = plain(32, 32);
    let error = |allocation| {
        let film = render(&scene, &RightHalfIsNoisy, &Settings { allocation, ..by_error(256, 1) }, &()).film;
        let squares = film.pixels.iter().map(|pixel| (f64::from(pixel.mean()[0]) - 1.0).powi(2));
        squares.sum::<f64>() / film.pixels.len() as f64
    };
    let ratio = error(Allocation::ByError) / error(Allocation::Even);
    assert!((0.5..0.85).contains(&ratio), "{ratio}");
}
