//! Rayleigh scattering: particles far smaller than the wavelength, as in clear air.
//!
//! ```text
//! p(cos θ) = 3/(16π) · (1 + cos² θ)
//! ```
//!
//! The cumulative distribution `u = ½ + (3c + c³)/8` is inverted exactly: `c³ + 3c = 2w` with `w = 4u − 2` has one real
//! root, `∛(w + √(w² + 1)) + ∛(w − √(w² + 1))`. Cube roots differ from one system's library to the next, so the same
//! root is found with two Newton steps from a rational start; they end within the rounding of single precision, take
//! two divisions, and give the same bits everywhere.
//!
//! Source: Rayleigh 1871; the inversion is from Frisvad 2011, "Importance sampling the Rayleigh phase function",
//! JOSA A 28(12).

use std::f32::consts::PI;

/// The Rayleigh phase function for unpolarised light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rayleigh;

impl Rayleigh {
    /// `p(cos θ)` [1/sr].
    #[inline]
    pub fn eval(self, cos_theta: f32) -> f32 {
        3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta)
    }

    /// A cosine with the density [`Self::eval`].
    #[inline]
    pub fn sample(self, u: f32) -> f32 {
        let w = 4.0 * u - 2.0;
        let start = w * (2.0 / 3.0) / (1.0 + 0.09 * w * w);
        let newton = |c: f32| (2.0 / 3.0) * (c * c * c + w) / (c * c + 1.0);
        newton(newton(start)).clamp(-1.0, 1.0)
    }

    /// Zero: as much goes back as forward.
    #[inline]
    pub fn mean_cosine(self) -> f32 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_newton_steps_reach_the_closed_root() {
        for i in 0..=100_000 {
            let u = i as f32 / 100_000.0;
            let w = 4.0 * f64::from(u) - 2.0;
            let root = (w.abs() + (w * w + 1.0).sqrt()).cbrt();
            let exact = (root - 1.0 / root) * w.signum();
            let c = Rayleigh.sample(u);
            assert!((f64::from(c) - exact).abs() < 2e-7 && c.abs() <= 1.0, "u = {u}: {c} for {exact}");
        }
    }
}
