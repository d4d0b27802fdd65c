//! Estimators of the radiance along a camera ray.

pub mod analog;
mod following;
pub mod pool;
pub mod volpath;
pub mod walk;

use std::fmt::Debug;

pub use analog::Analog;
pub use volpath::{Counted, Deep, VolPath};

use crate::{
    film::Part,
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

    /// Estimates for many camera rays: of the whole the same bits as [`Self::li`] gives for each, and of some parts.
    fn li_many(&self, scene: &Scene, samples: &[CameraSample], parts: &[Part], tally: &mut Tally) -> Estimates {
        let radiance = samples.iter().map(|seen| self.li(scene, seen, tally)).collect();
        Estimates { radiance, parts: vec![Lanes::splat(f32::NAN); samples.len() * parts.len()] }
    }

    /// Whether it can tell parts of the light apart; otherwise they are NaN.
    fn tells_parts(&self) -> bool {
        false
    }
}

/// Estimates of the radiance along many camera rays.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimates {
    /// The whole of it, in the order of the rays.
    pub radiance: Vec<Lanes>,
    /// Part by part of a ray, ray by ray.
    pub parts: Vec<Lanes>,
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
