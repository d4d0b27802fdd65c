//! What is no radiance is never hidden.

mod common;

use common::World;
use tyndall::{
    integrator::{CameraSample, Integrator},
    math::Vec3,
    render::{Settings, render},
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};

/// Returns a bad value in about one of eight samples, else 1.
#[derive(Debug)]
struct Faulty(f32);

impl Integrator for Faulty {
    fn li(&self, _: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        if { seen.sampler }.rng.next_1d() < 0.125 {
            tally.collisions += 1; // counts the faults
            return Lanes::splat(self.0);
        }
        Lanes::ONE
    }
}

/// A sample that is not a number, infinite or negative is counted and located, and adds no light: with `n` of 64 samples
/// bad and the others 1, the pixel is (64 − n)/64.
#[test]
fn a_sample_that_is_no_radiance_is_counted_located_and_left_out() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0] {
        let scene = World::seen(Vec3::ZERO, Vec3::Z).scene();
        let rendering = render(&scene, &Faulty(bad), &Settings { spp: 64, ..Settings::default() }, &());
        let faults = rendering.tally.collisions;
        assert!(faults > 0 && faults < Tally::KEPT as u64, "{faults} faults: the test tests nothing");
        assert_eq!(rendering.tally.bad_samples, faults);
        assert_eq!(rendering.tally.bad_sample_list.len() as u64, faults);
        let mut indices: Vec<u32> = rendering.tally.bad_sample_list.iter().map(|s| s.index).collect();
        indices.dedup();
        assert_eq!(indices.len() as u64, faults, "each fault has its own sample");
        assert!(rendering.tally.bad_sample_list.iter().all(|s| s.pixel == (0, 0)));
        let expected = (64 - faults) as f32 / 64.0;
        assert_eq!(rendering.film.pixels[0].mean(), [expected; 3], "{bad}");
    }
}
