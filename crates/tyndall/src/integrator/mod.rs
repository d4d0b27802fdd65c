//! Estimators of the radiance along a camera ray.

pub mod analog;
pub mod volpath;

use std::fmt::Debug;

pub use analog::Analog;
pub use volpath::{Counted, VolPath};

use crate::{
    math::Ray,
    sampling::Sampler,
    scene::Scene,
    spectrum::{ColorMode, Lanes, Wavelengths},
    tally::Tally,
};

/// An unbiased (unless it says otherwise) estimator of radiance.
pub trait Integrator: Debug + Sync {
    /// One estimate of the radiance that arrives along a camera ray, in the lanes of `wavelengths`; `u_hero` chooses
    /// the lane that steers.
    fn li(
        &self,
        scene: &Scene,
        ray: Ray,
        wavelengths: Wavelengths,
        u_hero: f32,
        sampler: &mut Sampler,
        tally: &mut Tally,
    ) -> Lanes;
}

/// An estimate by one lane a path, chosen by `u`, that stands for all of them.
pub(crate) fn in_one_lane(color: ColorMode, u: f32, estimate: impl FnOnce(usize) -> f32) -> Lanes {
    let lanes = match color {
        ColorMode::Rgb => 3, // the film never looks at the fourth
        ColorMode::Mono => return Lanes::splat(estimate(0)),
        ColorMode::Spectral => 4,
    };
    let lane = ((u * lanes as f32) as usize).min(lanes - 1);
    let mut radiance = [0.0; 4];
    radiance[lane] = lanes as f32 * estimate(lane);
    Lanes::new(radiance)
}
