//! Estimators of the radiance along a camera ray.

pub mod analog;
pub mod apart;
mod bent;
mod following;
mod next_event;
pub mod pool;
pub mod volpath;
pub mod walk;

use std::fmt::Debug;

pub use analog::Analog;
pub use apart::{Parts, TakesApart};
pub use volpath::{Counted, Deep, VolPath};

use crate::{
    math::Ray,
    sampling::Sampler,
    scene::Scene,
    spectrum::{ColorMode, Lanes, Wavelengths},
    tally::Tally,
};

/// What an estimate begins with.
#[derive(Debug, Clone, Copy)]
pub struct CameraSample {
    /// From the camera into the scene.
    pub ray: Ray,
    /// What the lanes mean.
    pub wavelengths: Wavelengths,
    /// Chooses the lane that steers, in [0, 1).
    pub u_hero: f32,
    /// All further random numbers.
    pub sampler: Sampler,
}

/// An unbiased (unless it says otherwise) estimator of radiance.
pub trait Integrator: Debug + Sync {
    /// One estimate of the radiance that arrives along a camera ray, in the lanes of its wavelengths.
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes;

    /// Estimates for many camera rays, in their order: the same bits as [`Self::li`] gives for each.
    fn li_many(&self, scene: &Scene, samples: &[CameraSample], tally: &mut Tally) -> Vec<Lanes> {
        samples.iter().map(|seen| self.li(scene, seen, tally)).collect()
    }

    /// The same estimator as one that takes light apart, if it knows what its paths go through.
    fn apart(&self) -> Option<&dyn TakesApart> {
        None
    }
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
