//! Isotropic scattering: every direction alike.
//!
//! `p(cos θ) = 1 / 4π`, and the cosine is uniform: `cos θ = 2u − 1`. The limit of deep scattering by anything
//! (similarity: `σ_s' = (1 − g) σ_s`), and the case with the most closed forms (Chandrasekhar 1960).

use std::f32::consts::PI;

/// The isotropic phase function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Isotropic;

impl Isotropic {
    /// `1 / 4π` [1/sr].
    #[inline]
    pub fn eval(self, _cos_theta: f32) -> f32 {
        0.25 / PI
    }

    /// A uniform cosine.
    #[inline]
    pub fn sample(self, u: f32) -> f32 {
        2.0 * u - 1.0
    }

    /// Zero.
    #[inline]
    pub fn mean_cosine(self) -> f32 {
        0.0
    }
}
