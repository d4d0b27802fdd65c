//! Henyey–Greenstein scattering: one parameter from backward to forward.
//!
//! ```text
//! p(cos θ) = (1 − g²) / (4π (1 + g² − 2 g cos θ)^{3/2})
//! ```
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `g` | mean cosine \[1\] | (−1, 1): skin 0.8 to 0.95, milk 0.9, cloud 0.85 |
//!
//! Both forms below are rewritten so that nothing cancels. With `a = |g|` and the cosine `c` counted from the preferred
//! direction, `1 + a² − 2ac = (1 − a)² + 2a(1 − c)`. The inverse of the distribution, usually written as
//! `(1 + g² − ((1 − g²)/(1 − g + 2gu))²) / 2g`, becomes
//!
//! ```text
//! 1 − c = 2 (1 − a)² (1 − u)(1 + a u) / (1 − a + 2 a u)²
//! ```
//!
//! which needs no special case at `g = 0`, keeps its precision as `|g| → 1`, and costs one division.
//!
//! Source: Henyey and Greenstein 1941, "Diffuse radiation in the galaxy", ApJ 93, eq. 2.

use std::f32::consts::PI;

use super::PhaseError;

/// The Henyey–Greenstein phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HenyeyGreenstein {
    g: f32,
}

impl HenyeyGreenstein {
    /// With mean cosine `g` in (−1, 1).
    ///
    /// # Errors
    /// [`PhaseError::MeanCosine`] when `g` is outside of the interval or not a number.
    pub fn new(g: f32) -> Result<Self, PhaseError> {
        if g.abs() < 1.0 { Ok(Self { g }) } else { Err(PhaseError::MeanCosine(g)) }
    }

    /// `p(cos θ)` [1/sr].
    #[inline]
    pub fn eval(self, cos_theta: f32) -> f32 {
        let a = self.g.abs();
        let away = (1.0 - cos_theta * 1f32.copysign(self.g)).max(0.0);
        let d = (1.0 - a) * (1.0 - a) + 2.0 * a * away;
        (1.0 - a) * (1.0 + a) / (4.0 * PI * d * d.sqrt())
    }

    /// A cosine with the density [`Self::eval`]. Monotonic in `u`: for `g ≥ 0`, `u = 0` goes back and `u = 1` forward.
    #[inline]
    pub fn sample(self, u: f32) -> f32 {
        let a = self.g.abs();
        let ratio = (1.0 - a) / (1.0 - a + 2.0 * a * u);
        let away = 2.0 * ratio * ratio * (1.0 - u) * (1.0 + a * u);
        1f32.copysign(self.g) * (1.0 - away).max(-1.0)
    }

    /// `g`.
    #[inline]
    pub fn mean_cosine(self) -> f32 {
        self.g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_cosine_must_be_inside_of_the_open_interval() {
        for g in [-1.0, 1.0, 1.5, f32::NAN, f32::INFINITY] {
            assert!(HenyeyGreenstein::new(g).is_err(), "{g}");
        }
        for g in [0.0, -0.999_999, 0.999_999_94] {
            assert_eq!(HenyeyGreenstein::new(g).unwrap().mean_cosine(), g);
        }
    }

    /// The textbook formula in double precision, which cancels only as `ε₆₄ / g`.
    #[test]
    fn sampling_agrees_with_the_textbook_inverse_for_every_g() {
        for g in [-0.999_99f32, -0.9, -0.5, -1e-2, -1e-4, 1e-5, 1e-3, 0.3, 0.8, 0.99, 0.999_99] {
            let model = HenyeyGreenstein::new(g).unwrap();
            let (g, mut worst) = (f64::from(g), 0f64);
            for i in 0..=1000 {
                let u = i as f32 / 1000.0;
                // For g < 0 our u runs the other way.
                let v = if g < 0.0 { 1.0 - f64::from(u) } else { f64::from(u) };
                let q = (1.0 - g * g) / (1.0 - g + 2.0 * g * v);
                let textbook = (1.0 + g * g - q * q) / (2.0 * g);
                worst = worst.max((f64::from(model.sample(u)) - textbook).abs());
            }
            assert!(worst < 1e-6, "g = {g}: {worst}");
        }
    }

    #[test]
    fn evaluation_at_the_peak_and_beyond_a_rounded_cosine_is_finite() {
        // p(1) = (1 + g) / (4π (1 − g)²).
        let model = HenyeyGreenstein::new(0.999_9).unwrap();
        let g = f64::from(model.mean_cosine());
        let peak = (1.0 + g) / (4.0 * std::f64::consts::PI * (1.0 - g) * (1.0 - g));
        assert!((f64::from(model.eval(1.0)) / peak - 1.0).abs() < 1e-5);
        assert_eq!(model.eval(1.000_001), model.eval(1.0));
    }
}
