//! One of n things, with probability proportional to its weight.
//!
//! Inversion of the cumulative sum by bisection. Unlike an alias table it is monotone in u, so stratified numbers stay
//! stratified, and what is left of u is again uniform and can be used for a further choice.
//!
//! The cumulative sum is held in double precision: with a million entries, or a sun among stars, single precision would
//! give some of them no probability at all.

/// A discrete distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrete {
    /// Cumulative probabilities: n + 1 numbers from 0 to 1.
    cdf: Vec<f64>,
}

impl Discrete {
    /// From weights ≥ 0 of any scale. `None` when no weight is positive, or one is negative or not finite.
    pub fn new(weights: &[f32]) -> Option<Self> {
        Self::from_f64(weights.iter().map(|&w| f64::from(w)))
    }

    /// As [`Self::new`], from double precision.
    pub fn from_f64(weights: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut cdf = vec![0.0];
        let mut sum = 0.0;
        for weight in weights {
            if !(weight >= 0.0 && weight.is_finite()) {
                return None;
            }
            sum += weight;
            cdf.push(sum);
        }
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        for c in &mut cdf {
            *c /= sum;
        }
        Some(Self { cdf })
    }

    /// Number of things.
    #[expect(clippy::len_without_is_empty, reason = "a distribution is never empty")]
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// From `u` in [0, 1): an index, its probability, and a new uniform number in [0, 1).
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        let u = f64::from(u);
        // The first entry that ends above u: it begins at or below u, so it has a width.
        let found = self.cdf[1..].partition_point(|&end| end <= u);
        // u = 1 falls off the end: the last entry with a width.
        let index = if found < self.len() { found } else { self.cdf.partition_point(|&c| c < 1.0) - 1 };
        let (begin, width) = (self.cdf[index], self.width(index));
        let rest = ((u - begin) / width).clamp(0.0, 1.0) as f32;
        (index, width as f32, rest.min(ONE_BELOW))
    }

    /// The probability of an index; 0 beyond the end.
    pub fn pmf(&self, index: usize) -> f32 {
        if index < self.len() { self.width(index) as f32 } else { 0.0 }
    }

    fn width(&self, index: usize) -> f64 {
        self.cdf[index + 1] - self.cdf[index]
    }
}

/// The greatest single-precision number below 1.
const ONE_BELOW: f32 = 1.0 - f32::EPSILON / 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_without_weight_are_never_chosen() {
        let d = Discrete::new(&[0.0, 1.0, 0.0, 0.0, 3.0, 0.0]).unwrap();
        for u in [0.0, 0.249_999, 0.25, 0.5, ONE_BELOW, 1.0] {
            let (i, p, rest) = d.sample(u);
            assert!((i == 1 && p == 0.25) || (i == 4 && p == 0.75), "{u}: {i} {p}");
            assert!((0.0..1.0).contains(&rest), "{u}: {rest}");
        }
        assert_eq!((d.pmf(0), d.pmf(4), d.pmf(6), d.len()), (0.0, 0.75, 0.0, 6));
    }

    /// u = 0.25 + 0.75 x lies at the fraction x of the second entry.
    #[test]
    fn what_is_left_of_u_is_its_place_within_the_entry() {
        let d = Discrete::new(&[1.0, 3.0]).unwrap();
        for x in [0.0f32, 0.25, 0.5, 0.875] {
            let (i, _, rest) = d.sample(0.25 + 0.75 * x);
            assert!(i == 1 && (rest - x).abs() < 1e-6, "{x}: {rest}");
        }
    }

    #[test]
    fn a_star_beside_the_sun_keeps_its_probability() {
        let d = Discrete::new(&[1e9, 1.0, 1e9]).unwrap();
        assert!((d.pmf(1) / 5e-10 - 1.0).abs() < 1e-6, "{}", d.pmf(1));
    }

    #[test]
    fn weights_that_are_no_distribution_are_refused() {
        for weights in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[1.0, f32::NAN], &[f32::INFINITY]] {
            assert_eq!(Discrete::new(weights), None, "{weights:?}");
        }
    }
}
