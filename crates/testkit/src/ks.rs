//! The Kolmogorov–Smirnov test: samples against a distribution function.
//!
//! `D = sup |Fₙ(x) − F(x)|`. With Stephens' factor `λ = (√n + 0.12 + 0.11/√n) D`, good from n = 5 on,
//! `p = 2 Σₖ (−1)^(k−1) exp(−2k²λ²)`.
//!
//! Sources: Kolmogorov 1933; Stephens 1970, "Use of the Kolmogorov–Smirnov, Cramér–von Mises and related statistics
//! without extensive tables".

use crate::Outcome;

/// Tests `samples` (which it sorts) against the cumulative distribution `cdf`.
pub fn ks_test(samples: &mut [f64], cdf: impl Fn(f64) -> f64) -> Outcome {
    samples.sort_by(f64::total_cmp);
    let n = samples.len() as f64;
    let mut distance = 0.0f64;
    let mut at = f64::NAN;
    for (i, &x) in samples.iter().enumerate() {
        let f = cdf(x);
        let here = (f - i as f64 / n).max((i as f64 + 1.0) / n - f);
        if here.is_nan() || x.is_nan() {
            return Outcome { p: 0.0, detail: format!("F({x}) is {f}") };
        }
        if here > distance {
            (distance, at) = (here, x);
        }
    }
    let p = if samples.is_empty() { 0.0 } else { kolmogorov((n.sqrt() + 0.12 + 0.11 / n.sqrt()) * distance) };
    Outcome { p, detail: format!("D = {distance:.5} at {at:.5}, n = {n}") }
}

/// P(λ or more).
fn kolmogorov(lambda: f64) -> f64 {
    if lambda < 0.2 {
        return 1.0; // 1 − 5e-13; the series converges slowly there
    }
    let term = |k: i32| f64::from(1 - 2 * ((k + 1) % 2)) * (-2.0 * f64::from(k * k) * lambda * lambda).exp();
    (2.0 * (1..=50).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stream;

    /// Tabulated critical values: P(λ > 1.3581) = 0.05, P(λ > 1.6276) = 0.01.
    #[test]
    fn p_values_are_kolmogorovs() {
        assert!((kolmogorov(1.3581) - 0.05).abs() < 1e-5 && (kolmogorov(1.6276) - 0.01).abs() < 1e-5);
        assert!((kolmogorov(0.2) - 1.0).abs() < 1e-10);
    }

    #[test]
    fn a_slightly_tilted_density_fails() {
        let mut s = Stream::new(3);
        let mut samples: Vec<f64> = (0..100_000).map(|_| s.next_f64()).collect();
        assert!(ks_test(&mut samples, |x| x).p > 1e-3);
        // p(x) = 1 + 0.04 (x − ½): F = x + 0.02 (x² − x), at most 0.005 off.
        assert!(ks_test(&mut samples, |x| x + 0.04 * (x * x - x)).p < 1e-6);
    }

    #[test]
    fn a_distribution_that_is_one_per_cent_too_large_fails() {
        let mut s = Stream::new(4);
        let mut samples: Vec<f64> = (0..100_000).map(|_| s.next_f64()).collect();
        assert!(ks_test(&mut samples, |x| 1.01 * x).p < 1e-6);
        assert_eq!(ks_test(&mut [0.5, f64::NAN], |x| x).p, 0.0);
        assert_eq!(ks_test(&mut [], |x| x).p, 0.0);
    }
}
