//! Means with their standard errors, and whether they are what they should be.
//!
//! `z = (mean − expected) / standard error` is standard normal for large samples: `p = erfc(|z|/√2)`.
//! Running sums: Welford 1962.

use std::fmt;

use statrs::function::erf::erfc;

use crate::Outcome;

/// Relative error that single-precision arithmetic may leave in a mean; it is added to the standard error, so that an
/// estimator without variance can be tested too.
const ROUNDING: f64 = 1e-6;

/// Significance of a single test outside of a family.
const ALPHA: f64 = 1e-4;

/// A running mean with its standard error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mean {
    /// Number of samples.
    pub n: u64,
    /// Their mean.
    pub mean: f64,
    /// Sum of squared deviations from the mean.
    pub squares: f64,
}

impl Mean {
    /// Adds one sample.
    pub fn push(&mut self, x: f64) {
        self.n += 1;
        let delta = x - self.mean;
        self.mean += delta / self.n as f64;
        self.squares += delta * (x - self.mean);
    }

    /// Standard error of the mean; infinite below two samples.
    pub fn standard_error(&self) -> f64 {
        if self.n < 2 {
            return f64::INFINITY;
        }
        let n = self.n as f64;
        (self.squares / ((n - 1.0) * n)).sqrt()
    }

    /// Deviation from `expected` in standard errors.
    pub fn z(&self, expected: f64) -> f64 {
        let error = self.standard_error().hypot(ROUNDING * expected.abs().max(f64::MIN_POSITIVE));
        (self.mean - expected) / error
    }

    /// Two-sided test of the hypothesis that the expectation is `expected`. A mean that is NaN fails.
    pub fn test(&self, expected: f64) -> Outcome {
        let z = self.z(expected);
        let p = if z.is_nan() || self.n < 2 { 0.0 } else { erfc(z.abs() / std::f64::consts::SQRT_2) };
        Outcome { p, detail: format!("mean {self}, expected {expected:.6} (z = {z:.1})") }
    }

    /// Whether two independent means agree: `z = (a − b)/√(sₐ² + s_b²)`.
    pub fn agrees_with(&self, other: &Self) -> Outcome {
        let rounding = ROUNDING * self.mean.abs().max(other.mean.abs()).max(f64::MIN_POSITIVE);
        let error = self.standard_error().hypot(other.standard_error()).hypot(rounding);
        let z = (self.mean - other.mean) / error;
        let p = if z.is_nan() || self.n < 2 || other.n < 2 { 0.0 } else { erfc(z.abs() / std::f64::consts::SQRT_2) };
        Outcome { p, detail: format!("means {self} and {other} (z = {z:.1})") }
    }
}

impl FromIterator<f64> for Mean {
    fn from_iter<I: IntoIterator<Item = f64>>(samples: I) -> Self {
        let mut mean = Self::default();
        samples.into_iter().for_each(|x| mean.push(x));
        mean
    }
}

impl fmt::Display for Mean {
    /// The mean to the second digit of its standard error: `1.5080 ± 0.0031`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let error = self.standard_error();
        let digits =
            if error > 0.0 && error.is_finite() { (1.0 - error.log10().floor()).clamp(0.0, 12.0) } else { 6.0 };
        write!(f, "{:.2$} ± {:.2$}", self.mean, error, digits as usize)
    }
}

/// Tests that `samples` have the expectation `expected`.
pub fn z_test(samples: impl IntoIterator<Item = f64>, expected: f64) -> Outcome {
    samples.into_iter().collect::<Mean>().test(expected)
}

/// Panics when `samples` do not have the expectation `expected`, at significance 10⁻⁴ (|z| > 3.9).
///
/// # Panics
/// With the mean, its standard error and z.
#[track_caller]
pub fn assert_mean(samples: impl IntoIterator<Item = f64>, expected: f64) {
    let outcome = z_test(samples, expected);
    assert!(outcome.p >= ALPHA, "{}", outcome.detail);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stream;

    /// Of [1, 2, 3, 4]: mean 5/2, variance 5/3, standard error √(5/12).
    #[test]
    fn a_mean_has_its_standard_error() {
        let m: Mean = [1.0, 2.0, 3.0, 4.0].into_iter().collect();
        assert!((m.mean - 2.5).abs() < 1e-15 && (m.standard_error() - (5.0f64 / 12.0).sqrt()).abs() < 1e-15);
        assert_eq!(m.to_string(), "2.50 ± 0.65");
    }

    /// P(|z| > 1.959964) = 0.05.
    #[test]
    fn p_values_are_those_of_the_normal_distribution() {
        let error = Mean { n: 101, mean: 0.0, squares: 100.0 * 101.0 };
        assert!((error.standard_error() - 1.0).abs() < 1e-12);
        assert!((error.test(1.959_964).p - 0.05).abs() < 1e-6);
        assert!((error.agrees_with(&Mean { mean: 1.959_964 * 2f64.sqrt(), ..error }).p - 0.05).abs() < 1e-6);
    }

    #[test]
    fn an_estimator_that_is_one_per_cent_too_bright_fails() {
        let mut s = Stream::new(7);
        let samples: Vec<f64> = (0..100_000).map(|_| 2.0 * s.next_f64()).collect();
        assert!(z_test(samples.iter().copied(), 1.0).p > 1e-3);
        let wrong = z_test(samples.iter().map(|x| 1.01 * x), 1.0);
        assert!(wrong.p < 1e-6 && wrong.detail.contains("expected 1.000000 (z = 5."), "{wrong:?}");
    }

    #[test]
    fn nan_and_too_few_samples_fail_and_a_constant_passes() {
        assert_eq!(z_test([1.0, f64::NAN, 1.0], 1.0).p, 0.0);
        assert_eq!(z_test([1.0], 1.0).p, 0.0);
        assert!(z_test([1.0, 1.0, 1.0], 1.0).p > 0.9);
        assert!(z_test([1.001, 1.001, 1.001], 1.0).p < 1e-6);
    }
}
