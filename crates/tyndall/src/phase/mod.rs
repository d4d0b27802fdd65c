//! Phase functions: where light goes when a particle scatters it.
//!
//! A phase function `p(cos θ)` [1/sr] is the density of the new direction of travel over the sphere, `∫ p dω = 1`.
//! Every model here is symmetric around the old direction of travel, so it sees nothing but the cosine between the two
//! directions **of travel**: +1 goes straight on, −1 goes back. Frames and azimuth live in one function, [`deflect`].
//!
//! The inverse distribution of each model is exact and free of library calls, so that a scalar path and a SIMD lane give
//! the same bits; those of the closed models are free of branches too. Tables and blends are shared and never change:
//! the media of a scene own them, and a path refers to them. To add a model: one file, one variant with its three
//! forwarding lines, one row in the sampler table of `tests/models.rs`.
//!
//! ```
//! use tyndall::{math::Vec3, phase::{Phase, deflect}};
//! let milk = Phase::henyey_greenstein(0.9)?;
//! let cos_theta = milk.sample(0.5);
//! let onward = deflect(Vec3::Z, cos_theta, 0.25);
//! assert!((onward.z - cos_theta).abs() < 1e-6);
//! # Ok::<(), tyndall::phase::PhaseError>(())
//! ```

mod blend;
mod henyey_greenstein;
mod isotropic;
mod rayleigh;
mod tabulated;

pub use blend::Blend;
pub use henyey_greenstein::HenyeyGreenstein;
pub use isotropic::Isotropic;
pub use rayleigh::Rayleigh;
pub use tabulated::Tabulated;

use std::sync::Arc;

use crate::math::{Frame, Vec3, fast::sin_cos_turn};

/// Why a phase function cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PhaseError {
    /// The mean cosine of a Henyey–Greenstein phase function is outside of its open interval, or not a number.
    #[error(
        "the mean cosine g of a Henyey-Greenstein phase function must lie between -1 and 1, both excluded: got {0}"
    )]
    MeanCosine(f32),
    /// The values of a table are no distribution.
    #[error("the table of a phase function has at least two values, none of them negative and not all of them 0")]
    Table,
    /// The weight of a blend is outside of [0, 1], or not a number.
    #[error("the weight of a blend of phase functions must lie between 0 and 1: got {0}")]
    Weight(f32),
}

/// A phase function. The methods only forward.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// All directions alike.
    Isotropic(Isotropic),
    /// One parameter between forward and backward.
    HenyeyGreenstein(HenyeyGreenstein),
    /// Particles far smaller than the wavelength.
    Rayleigh(Rayleigh),
    /// By values at regular cosines.
    Tabulated(Arc<Tabulated>),
    /// A weighted sum of others.
    Blend(Arc<Blend>),
}

impl Phase {
    /// Henyey–Greenstein with mean cosine `g` in (−1, 1); isotropic when `g` is zero.
    ///
    /// # Errors
    /// [`PhaseError::MeanCosine`] when `g` is outside of the interval or not a number.
    pub fn henyey_greenstein(g: f32) -> Result<Self, PhaseError> {
        let model = HenyeyGreenstein::new(g)?;
        Ok(if g == 0.0 { Self::Isotropic(Isotropic) } else { Self::HenyeyGreenstein(model) })
    }

    /// Linear between relative values at regularly spaced cosines from −1 to 1.
    ///
    /// # Errors
    /// [`PhaseError::Table`] with fewer than two values, a negative one, or nothing but zeros.
    pub fn tabulated(values: &[f64]) -> Result<Self, PhaseError> {
        Tabulated::new(values).map(|table| Self::Tabulated(Arc::new(table)))
    }

    /// `1 − weight` of the first and `weight` of the second.
    ///
    /// # Errors
    /// [`PhaseError::Weight`] when the weight is not in [0, 1].
    pub fn blend(first: &Self, second: &Self, weight: f32) -> Result<Self, PhaseError> {
        Blend::new(first, second, weight).map(|blend| Self::Blend(Arc::new(blend)))
    }

    /// The density `p(cos θ)` [1/sr] over the sphere of directions.
    #[inline]
    pub fn eval(&self, cos_theta: f32) -> f32 {
        match self {
            Self::Isotropic(model) => model.eval(cos_theta),
            Self::HenyeyGreenstein(model) => model.eval(cos_theta),
            Self::Rayleigh(model) => model.eval(cos_theta),
            Self::Tabulated(model) => model.eval(cos_theta),
            Self::Blend(model) => model.eval(cos_theta),
        }
    }

    /// A cosine drawn with `u` in `[0, 1]`; with a uniform azimuth its density [1/sr] is exactly [`Self::eval`].
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        match self {
            Self::Isotropic(model) => model.sample(u),
            Self::HenyeyGreenstein(model) => model.sample(u),
            Self::Rayleigh(model) => model.sample(u),
            Self::Tabulated(model) => model.sample(u),
            Self::Blend(model) => model.sample(u),
        }
    }

    /// The mean cosine `g = ∫ p cos θ dω`, in (−1, 1).
    #[inline]
    pub fn mean_cosine(&self) -> f32 {
        match self {
            Self::Isotropic(model) => model.mean_cosine(),
            Self::HenyeyGreenstein(model) => model.mean_cosine(),
            Self::Rayleigh(model) => model.mean_cosine(),
            Self::Tabulated(model) => model.mean_cosine(),
            Self::Blend(model) => model.mean_cosine(),
        }
    }
}

/// The direction at the angle `acos(cos_theta)` from `dir`, at the azimuth `2π·u_azimuth`.
///
/// `dir` is a unit vector of travel, and so is the result: one Newton step on `1/√x` takes back the rounding of the
/// rotation, so that a walk of any number of deflections stays on the unit sphere.
#[inline]
pub fn deflect(dir: Vec3, cos_theta: f32, u_azimuth: f32) -> Vec3 {
    let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = sin_cos_turn(u_azimuth);
    let turned = Frame::around(dir).to_world(Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta));
    turned * (1.5 - 0.5 * turned.length_squared())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_walk_stays_on_the_unit_sphere() {
        let phase = Phase::henyey_greenstein(0.99).unwrap();
        let mut dir = Vec3::Z;
        for i in 0..1_000_000u32 {
            let u = |k: u32| (i.wrapping_mul(2_654_435_769).wrapping_add(k * 987_654_321) >> 8) as f32 / 16_777_216.0;
            dir = deflect(dir, phase.sample(u(1)), u(2));
            assert!((dir.length() - 1.0).abs() < 3e-7, "step {i}: {dir}");
        }
    }

    #[test]
    fn a_deflection_turns_by_the_angle_that_was_asked_for() {
        for dir in [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::new(0.36, -0.48, 0.8)] {
            for cos_theta in [-1.0, -0.7, 0.0, 0.999, 1.0] {
                for u in [0.0, 0.3, 0.99, 1.0] {
                    assert!((deflect(dir, cos_theta, u).dot(dir) - cos_theta).abs() < 5e-7);
                }
            }
        }
    }
}
