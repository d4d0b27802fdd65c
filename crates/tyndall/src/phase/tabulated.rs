//! A phase function by a table: measured, or computed (Mie) elsewhere.
//!
//! Values at cosines that are regularly spaced from −1 to 1, linear between them, whatever their scale:
//!
//! ```text
//! p(c) = (1 − t) pᵢ + t pᵢ₊₁,   c = −1 + (i + t) h,   h = 2/(n − 1),   scaled so that 2π ∫ p dc = 1
//! ```
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `values` | relative values, the first straight back, the last straight on \[1\] | at least 2, ≥ 0, not all 0 |
//!
//! The inverse distribution is exact and rises with `u`. The segment is found by a table of starting points, one for each
//! `n`-th part of `u`, and bisection of the few segments between two of them. Within a segment from `a` to `b` the
//! cumulative share `ξ` is a quadratic of `t`, whose root is written so that nothing cancels:
//!
//! ```text
//! t = ξ (a + b) / (a + √(a² (1 − ξ) + b² ξ))
//! ```
//!
//! Linear interpolation cuts the tip of a narrow peak: a peak of half width `θ` wants a spacing `h` well below `θ²/2`.

use super::PhaseError;

/// A table of values, linear between.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    /// `p` [1/sr] at the cosines of the table.
    values: Box<[f32]>,
    /// The share of light below each cosine of the table: from 0 to 1.
    cumulative: Box<[f32]>,
    /// For each `i`, the last segment that begins at or below the share `i/(n − 1)`.
    starts: Box<[u32]>,
    /// `(n − 1)/2`: segments for each unit of the cosine.
    density: f32,
    mean_cosine: f32,
}

impl Tabulated {
    /// From relative values at regularly spaced cosines from −1 to 1.
    ///
    /// # Errors
    /// [`PhaseError::Table`] with fewer than two values, a negative one, or nothing but zeros.
    pub fn new(values: &[f64]) -> Result<Self, PhaseError> {
        let segments = values.len().saturating_sub(1);
        let greatest = values.iter().fold(0.0, |most, &v| f64::max(most, v));
        let sound = |v: &f64| *v >= 0.0 && v.is_finite();
        if segments == 0 || segments > MOST_SEGMENTS || greatest == 0.0 || !values.iter().all(sound) {
            return Err(PhaseError::Table);
        }
        // Relative to the greatest, so that no sum overflows.
        let values: Vec<_> = values.iter().map(|v| v / greatest).collect();
        let h = 2.0 / segments as f64;
        let mut cumulative = vec![0.0];
        let (mut mass, mut moment) = (0.0, 0.0);
        for (i, pair) in values.windows(2).enumerate() {
            let (a, b, c) = (pair[0], pair[1], -1.0 + i as f64 * h);
            mass += 0.5 * h * (a + b);
            // ∫ p c dc, a quadratic: Simpson's rule is exact.
            moment += h / 6.0 * (a * c + (a + b) * (2.0 * c + h) + b * (c + h));
            cumulative.push(mass);
        }
        let cumulative: Box<[f32]> = cumulative.iter().map(|c| (c / mass) as f32).collect();
        let share = |i: usize| i as f32 / segments as f32;
        let starts = (0..=segments).map(|i| cumulative.partition_point(|&c| c <= share(i)).saturating_sub(1));
        Ok(Self {
            values: values.iter().map(|v| (v / (mass * std::f64::consts::TAU)) as f32).collect(),
            starts: starts.map(|i| i.min(segments - 1) as u32).collect(),
            cumulative,
            density: 0.5 * segments as f32,
            mean_cosine: (moment / mass) as f32,
        })
    }

    /// `p(cos θ)` [1/sr].
    #[inline]
    pub fn eval(&self, cos_theta: f32) -> f32 {
        let at = ((cos_theta + 1.0) * self.density).max(0.0);
        let i = (at as usize).min(self.values.len() - 2);
        let t = (at - i as f32).min(1.0);
        (1.0 - t) * self.values[i] + t * self.values[i + 1]
    }

    /// A cosine with the density [`Self::eval`], that grows with `u`.
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let segments = self.values.len() - 1;
        let part = ((u * segments as f32) as usize).min(segments - 1);
        let (mut i, mut end) = (self.starts[part] as usize, self.starts[part + 1] as usize + 1);
        while end - i > 1 {
            let middle = i + (end - i) / 2;
            if self.cumulative[middle] <= u { i = middle } else { end = middle }
        }
        let (below, above) = (self.cumulative[i], self.cumulative[i + 1]);
        let xi = ((u - below) / (above - below).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let (a, b) = (self.values[i], self.values[i + 1]);
        // A segment of nothing but zeros is drawn only where u = 1 falls on it: any place in it will do.
        let slope = (a + (a * a * (1.0 - xi) + b * b * xi).sqrt()).max(f32::MIN_POSITIVE);
        let t = (xi * (a + b) / slope).min(1.0);
        ((i as f32 + t) / self.density - 1.0).min(1.0)
    }

    /// `∫ p cos θ dω`.
    #[inline]
    pub fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }
}

/// Single precision tells this many segments apart.
const MOST_SEGMENTS: usize = 1 << 22;

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// p = (1 + c)/2 has the mean cosine 1/3; the share below c is ((1 + c)/2)², so c = 2√u − 1. The place in the segment,
    /// at most 1, is rounded four times, and stretched to 2.
    #[test]
    fn a_ramp_is_drawn_by_its_square_root() {
        let ramp = Tabulated::new(&[0.0, 1.0]).unwrap();
        assert!((ramp.mean_cosine() - 1.0 / 3.0).abs() < 1e-7);
        assert!((ramp.eval(1.0) - 0.5 / PI).abs() < 1e-7 && ramp.eval(-1.0) == 0.0);
        for i in 0..=1000 {
            let u = i as f32 / 1000.0;
            assert!((ramp.sample(u) - (2.0 * u.sqrt() - 1.0)).abs() < 4.0 * f32::EPSILON, "{u}");
        }
    }

    #[test]
    fn a_flat_table_is_isotropic() {
        for n in [2, 3, 1000] {
            let flat = Tabulated::new(&vec![1e300; n]).unwrap();
            assert!(flat.mean_cosine().abs() < 1e-6);
            for i in 0..=1000 {
                let u = i as f32 / 1000.0;
                assert!((flat.sample(u) - (2.0 * u - 1.0)).abs() < 3e-7, "{n} {u}");
                assert!((flat.eval(2.0 * u - 1.0) * 4.0 * PI - 1.0).abs() < 3e-7, "{n} {u}");
            }
        }
    }

    /// Peaks of one segment between zeros, of very different heights: what is drawn lies where there is something, and
    /// the cosine never falls as u rises.
    #[test]
    fn nothing_is_drawn_where_the_table_is_zero() {
        let mut values = vec![0.0; 4001];
        (values[1000], values[1001], values[3999]) = (1.0, 1e-3, 1e3);
        let table = Tabulated::new(&values).unwrap();
        let mut last = -1.0;
        for i in 0..=100_000 {
            let c = table.sample(i as f32 / 100_000.0);
            let at = (c + 1.0) * 2000.0;
            assert!((998.9..1002.1).contains(&at) || (3997.9..=4000.1).contains(&at), "{i}: {at}");
            assert!(c >= last, "{i}");
            last = c;
        }
    }

    #[test]
    fn what_is_no_table_is_refused() {
        for values in [&[][..], &[1.0], &[0.0, 0.0], &[1.0, -1e-9], &[1.0, f64::NAN], &[1.0, f64::INFINITY]] {
            assert_eq!(Tabulated::new(values), Err(PhaseError::Table), "{values:?}");
        }
    }
}
