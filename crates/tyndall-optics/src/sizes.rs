//! How large the particles of a mixture are: shares of their whole volume by radius.
//!
//! Volume is what a recipe gives (grams of water, per cent of fat), so all distributions are kept by volume. A number
//! density `n(r)` has the share `∝ r³ n(r) dr`.
//!
//! | distribution | `n(r)` | parameters |
//! |---|---|---|
//! | [`mono`](Sizes::mono) | all alike | radius \[m\] |
//! | [`log_normal`](Sizes::log_normal) | `exp(−ln²(r/r₀)/(2σ²))/r` | median radius r₀ by number \[m\], σ = ln of the geometric standard deviation |
//! | [`gamma`](Sizes::gamma) | `r^((1−3b)/b) exp(−r/(a b))` | effective radius a \[m\], effective variance b in (0, 1/2) (Hansen and Travis 1974, eq. 2.56) |
//!
//! Smooth densities that vanish at both ends are summed at regular steps (of the radius, or of its logarithm), which
//! converges faster than any power of the step. What limits it are the resonances of clear large spheres; with
//! 1280 classes σ_s and g of a cloud have converged to 10⁻³ (tested).

/// Radii of a smooth distribution.
const CLASSES: usize = 1280;
/// Logarithm of a density that is left out.
const NOTHING: f64 = -27.0;

/// Shares of the whole volume by radius.
#[derive(Debug, Clone, PartialEq)]
pub struct Sizes {
    /// Radius [m] and share of volume \[1\]; the shares add up to 1.
    pub classes: Vec<[f64; 2]>,
}

impl Sizes {
    /// All of one radius [m].
    pub fn mono(radius: f64) -> Self {
        Self { classes: vec![[radius, 1.0]] }
    }

    /// By the median radius of their number [m] and the width `sigma > 0` of ln r.
    pub fn log_normal(median: f64, sigma: f64) -> Self {
        Self::log_normal_volume(median * (3.0 * sigma * sigma).exp(), sigma)
    }

    /// By the median radius of their volume [m] and the width `sigma > 0` of ln r.
    pub fn log_normal_volume(median: f64, sigma: f64) -> Self {
        Self::by_logarithm(median, sigma, CLASSES, |ln| -0.5 * (ln / sigma).powi(2))
    }

    /// By the effective radius [m] and the effective variance in (0, 1/2).
    pub fn gamma(effective_radius: f64, effective_variance: f64) -> Self {
        let (a, b) = (effective_radius, effective_variance);
        // Of r⁴ n(r), the volume by ln r.
        let peak = a * (1.0 + b);
        let k = 1.0 / b + 1.0;
        Self::by_logarithm(peak, k.sqrt().recip(), CLASSES, |ln| k * (ln + 1.0 - ln.exp()))
    }

    /// From the logarithm of the volume by ln r, where ln r counts from a `peak` of some `width` and the density there is 1.
    fn by_logarithm(peak: f64, width: f64, classes: usize, log_density: impl Fn(f64) -> f64) -> Self {
        let end = |step: f64| (1..10_000).map(|i| f64::from(i) * step).find(|ln| log_density(*ln) < NOTHING);
        let (low, high) = (end(-0.25 * width).unwrap_or(0.0), end(0.25 * width).unwrap_or(0.0));
        let ln = |i: usize| low + (high - low) * i as f64 / (classes - 1) as f64;
        Self::normalised((0..classes).map(|i| [peak * ln(i).exp(), log_density(ln(i)).exp()]))
    }

    /// From a volume by radius, between 0 and `most` [m].
    pub fn by_radius(most: f64, classes: usize, density: impl Fn(f64) -> f64) -> Self {
        let radius = |i: usize| most * (i as f64 + 0.5) / classes as f64;
        Self::normalised((0..classes).map(|i| [radius(i), density(radius(i))]))
    }

    fn normalised(classes: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut classes: Vec<_> = classes.collect();
        let sum: f64 = classes.iter().map(|class| class[1]).sum();
        for class in &mut classes {
            class[1] /= sum;
        }
        Self { classes }
    }

    /// `⟨r³⟩/⟨r²⟩` [m].
    pub fn effective_radius(&self) -> f64 {
        self.classes.iter().map(|[radius, share]| share / radius).sum::<f64>().recip()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The gamma distribution with so many classes, for tests of convergence.
    pub(crate) fn gamma_of(a: f64, b: f64, classes: usize) -> Sizes {
        let k = 1.0 / b + 1.0;
        Sizes::by_logarithm(a * (1.0 + b), k.sqrt().recip(), classes, |ln| k * (ln + 1.0 - ln.exp()))
    }

    /// a and b are the effective radius and variance by definition: `a = ⟨r³⟩/⟨r²⟩`, `b = ⟨(r − a)² r²⟩/(a² ⟨r²⟩)`.
    #[test]
    fn a_gamma_distribution_has_its_effective_radius_and_variance() {
        for (a, b) in [(6e-6, 1.0 / 9.0), (1e-5, 0.2), (1e-6, 0.01)] {
            let sizes = Sizes::gamma(a, b);
            assert!((sizes.effective_radius() / a - 1.0).abs() < 1e-6, "{a} {b}: {}", sizes.effective_radius());
            let spread: f64 = sizes.classes.iter().map(|[r, share]| share / r * (r - a).powi(2)).sum();
            let variance = spread * sizes.effective_radius() / (a * a);
            assert!((variance / b - 1.0).abs() < 1e-6, "{a} {b}: {variance}");
        }
    }

    /// `⟨r³⟩/⟨r²⟩ = r₀ exp(5σ²/2)` for the median r₀ by number.
    #[test]
    fn a_log_normal_distribution_has_its_effective_radius() {
        for sigma in [0.1, 0.5, 1.0] {
            let expected = 1e-6 * (2.5f64 * sigma * sigma).exp();
            assert!((Sizes::log_normal(1e-6, sigma).effective_radius() / expected - 1.0).abs() < 1e-6, "{sigma}");
        }
        assert_eq!(Sizes::mono(2e-6).effective_radius(), 2e-6);
    }
}
