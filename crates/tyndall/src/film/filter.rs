//! Reconstruction filters, by importance sampling (Ernst et al. 2006): a pixel's estimate is
//! `E[ f(x)/p(x) · L(x) ]`, with the offset `x` drawn from `p ∝ |f|`, so that each sample belongs to one pixel.

use super::Lobed;

/// A filter over offsets from the pixel's centre [pixels], normalised to unit integral.
#[derive(Debug, Clone, PartialEq)]
pub enum Filter {
    /// Constant over `|x| ≤ rx`, `|y| ≤ ry`.
    Box {
        /// Half widths [pixels].
        radius: [f32; 2],
    },
    /// The tent `(rx − |x|)(ry − |y|)`.
    Triangle {
        /// Half widths [pixels].
        radius: [f32; 2],
    },
    /// A Gaussian cut off at the radius, without its value there: `exp(−x²/2σ²) − exp(−r²/2σ²)`.
    Gaussian {
        /// Half widths [pixels].
        radius: [f32; 2],
        /// Standard deviation [pixels].
        sigma: f32,
    },
    /// One that is negative in places: Mitchell's, or a windowed sinc.
    Lobed(Lobed),
}

impl Default for Filter {
    fn default() -> Self {
        Self::Box { radius: [0.5, 0.5] }
    }
}

impl Filter {
    /// An offset from the pixel's centre [pixels] for two uniform numbers, and its weight `f/p` [1]: 1 where the filter is
    /// the density.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let both = |axis: &dyn Fn(usize) -> f32| ([axis(0), axis(1)], 1.0);
        match self {
            Self::Box { radius } => both(&|i| radius[i] * (2.0 * u[i] - 1.0)),
            Self::Triangle { radius } => both(&|i| radius[i] * tent(u[i])),
            Self::Gaussian { radius, sigma } => both(&|i| truncated_gaussian(u[i], radius[i], *sigma)),
            Self::Lobed(lobed) => lobed.sample(u),
        }
    }
}

/// Inverse of the distribution function of the tent on `[−1, 1]`.
fn tent(u: f32) -> f32 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() }
}

/// Inverts `F(x) = ∫_{−r}^{x} (exp(−t²/2σ²) − exp(−r²/2σ²)) dt / F(r)` by bisection and Newton steps.
fn truncated_gaussian(u: f32, radius: f32, sigma: f32) -> f32 {
    let (r, s, u) = (f64::from(radius), f64::from(sigma), f64::from(u));
    let edge = (-r * r / (2.0 * s * s)).exp();
    let density = |x: f64| (-x * x / (2.0 * s * s)).exp() - edge;
    // ∫₀ˣ exp(−t²/2σ²) dt = σ √(π/2) erf(x / σ√2)
    let half =
        |x: f64| s * (std::f64::consts::PI / 2.0).sqrt() * libm::erf(x / (s * std::f64::consts::SQRT_2)) - edge * x;
    let total = half(r);
    let target = (2.0 * u - 1.0) * total;
    let (mut low, mut high, mut x) = (-r, r, (2.0 * u - 1.0) * r * 0.5);
    for _ in 0..60 {
        let error = half(x) - target;
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - error / density(x);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() < 1e-9 * r {
            break;
        }
        x = next;
    }
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second moments: box r²/3; tent r²/6; the Gaussian's by numerical integration of its density.
    #[test]
    fn sampled_offsets_have_the_filters_mean_and_variance() {
        let gaussian_variance = {
            let (r, s) = (1.5f64, 0.5f64);
            let f = |x: f64| (-x * x / (2.0 * s * s)).exp() - (-r * r / (2.0 * s * s)).exp();
            let n = 20_000;
            let (mut m0, mut m2) = (0.0, 0.0);
            for i in 0..n {
                let x = r * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
                m0 += f(x);
                m2 += x * x * f(x);
            }
            m2 / m0
        };
        for (filter, variance) in [
            (Filter::Box { radius: [0.5, 0.5] }, 0.25 / 3.0),
            (Filter::Triangle { radius: [2.0, 2.0] }, 4.0 / 6.0),
            (Filter::Gaussian { radius: [1.5, 1.5], sigma: 0.5 }, gaussian_variance),
        ] {
            let n = 100_000;
            let (mut m1, mut m2) = (0.0, 0.0);
            for i in 0..n {
                let u = (i as f32 + 0.5) / n as f32;
                let ([x, _], weight) = filter.sample([u, 0.5]);
                assert_eq!(weight, 1.0);
                let x = f64::from(x);
                m1 += x / f64::from(n);
                m2 += x * x / f64::from(n);
            }
            assert!(m1.abs() < 1e-5, "{filter:?}: mean {m1}");
            assert!((m2 / variance - 1.0).abs() < 1e-4, "{filter:?}: variance {m2}, expected {variance}");
        }
    }
}
