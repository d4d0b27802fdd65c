//! The modified Bessel function I₀ without its growth, `e^(−x) I₀(x)`, to the digits of double precision or, with fewer terms, of
//! single precision.
//!
//! Below [`FAR`], Taylor series about whole numbers. Their first two terms come from `I₀(x) = Σ (x²/4)^k / k!²` and
//! `I₁ = I₀′`; the rest from the equation that `y = e^(−x) I₀(x)` obeys, `x y″ + (2x + 1) y′ + y = 0`. From there on, Hankel's
//! expansion `y = 1/√(2πx) · Σ ((2k−1)!!)² / (k! (8x)^k)`, whose terms fall off like `k!/(2x)^k`
//! (Abramowitz and Stegun 1964, 9.6.12 and 9.7.1). Renderers that stop early are up to 2 % low near x = 12.

use std::f64::consts::TAU;

/// Where Hankel's expansion takes over.
const FAR: usize = 32;

/// Terms of a Taylor series: the next is below 10⁻¹⁶ half-way between two whole numbers.
const NEAR_TERMS: usize = 18;

/// Terms of Hankel's expansion that can matter, at [`FAR`].
const FAR_TERMS: usize = 18;

static NEAR: [[f64; NEAR_TERMS]; FAR + 1] = near();
static HANKEL: [f64; FAR_TERMS] = hankel();

/// Terms that are enough for the digits of single precision.
const SINGLE_NEAR_TERMS: usize = 12;
const SINGLE_FAR_TERMS: usize = 6;

/// `e^(−x) I₀(x)` for `x ≥ 0`: between 0 and 1.
pub(super) fn scaled_i0(x: f64) -> f64 {
    of_terms::<NEAR_TERMS, FAR_TERMS>(x)
}

/// The same to the digits of single precision.
#[inline]
pub(super) fn scaled_i0_single(x: f64) -> f64 {
    of_terms::<SINGLE_NEAR_TERMS, SINGLE_FAR_TERMS>(x)
}

#[inline]
fn of_terms<const NEAR_COUNT: usize, const FAR_COUNT: usize>(x: f64) -> f64 {
    if x < FAR as f64 {
        let nearest = (x + 0.5) as usize;
        polynomial(&NEAR[nearest.min(FAR)][..NEAR_COUNT], x - nearest as f64)
    } else {
        polynomial(&HANKEL[..FAR_COUNT], 1.0 / x) / (TAU * x).sqrt()
    }
}

/// Two chains, of even and of odd powers, which a processor works at side by side.
#[inline]
fn polynomial(terms: &[f64], x: f64) -> f64 {
    let square = x * x;
    let (mut even, mut odd) = (0.0, 0.0);
    for pair in terms.rchunks_exact(2) {
        even = even * square + pair[0];
        odd = odd * square + pair[1];
    }
    even + odd * x
}

const fn near() -> [[f64; NEAR_TERMS]; FAR + 1] {
    let mut table = [[0.0; NEAR_TERMS]; FAR + 1];
    let mut about = 0;
    while about <= FAR {
        table[about] = taylor(about as f64);
        about += 1;
    }
    table
}

/// The series of `e^(−x) I₀(x)` about `c`.
const fn taylor(c: f64) -> [f64; NEAR_TERMS] {
    // e^c, I₀ and I₁: of positive terms, so that nothing cancels.
    let (mut growth, mut i0, mut i1) = (0.0, 0.0, 0.0);
    let (mut power, mut term, mut n) = (1.0, 1.0, 0.0);
    while n < 150.0 {
        growth += power;
        i0 += term;
        i1 += term * 0.5 * c / (n + 1.0);
        n += 1.0;
        power *= c / n;
        term *= 0.25 * c * c / (n * n);
    }
    let mut a = [0.0; NEAR_TERMS];
    a[0] = i0 / growth;
    a[1] = (i1 - i0) / growth;
    let mut k = 2;
    while k < NEAR_TERMS {
        let n = k as f64;
        a[k] = if c > 0.0 {
            -((n - 1.0) * (n - 1.0 + 2.0 * c) * a[k - 1] + (2.0 * n - 3.0) * a[k - 2]) / (c * n * (n - 1.0))
        } else {
            -(2.0 * n - 1.0) * a[k - 1] / (n * n)
        };
        k += 1;
    }
    a
}

const fn hankel() -> [f64; FAR_TERMS] {
    let mut terms = [1.0; FAR_TERMS];
    let mut k = 1;
    while k < FAR_TERMS {
        let odd = (2 * k - 1) as f64;
        terms[k] = terms[k - 1] * odd * odd / (8 * k) as f64;
        k += 1;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `I₀(x) = 1/π ∫₀^π e^(x cos t) dt`: the trapezium rule converges faster than any power for a periodic function.
    #[test]
    fn bessels_function_is_its_integral() {
        let from_place_to_place = (0..4000).map(|i| f64::from(i) * 0.01);
        for x in from_place_to_place.chain([1e-3, 31.999_999, 32.0, 99.0, 255.9, 256.1, 300.0, 2e4]) {
            let n = 2000;
            let half = |i: i32| (0.5 * TAU * f64::from(i) / f64::from(n)).sin();
            let mean: f64 = (0..n).map(|i| (-2.0 * x * half(i) * half(i)).exp()).sum();
            let expected = mean / f64::from(n);
            assert!((scaled_i0(x) / expected - 1.0).abs() < 2e-14, "{x}: {} {expected}", scaled_i0(x));
            let single = scaled_i0_single(x);
            assert!((single / expected - 1.0).abs() < 3e-8, "{x}: {single} {expected}");
        }
    }
}
