//! Estimators of the radiance along a camera ray.

pub mod analog;
pub mod volpath;

use std::fmt::Debug;

pub use analog::Analog;
pub use volpath::VolPath;

use crate::{
    math::Ray,
    sampling::Sampler,
    scene::Scene,
    spectrum::{Lanes, Wavelengths},
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
