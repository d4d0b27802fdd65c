//! The χ² test: counts in cells against what a density says.
//!
//! `χ² = Σ (Oᵢ − Eᵢ)² / Eᵢ`; with k cells, p is the upper tail of the χ² distribution with k − 1 degrees of freedom.
//! Cells that expect fewer than [`POOL`] counts are merged, smallest first, until together they expect that many, since
//! the approximation needs it (Cochran 1954). A count where none is expected fails outright.
//!
//! The expectations are scaled to the number of counts: a χ² test is about shape. Whether the density is normalised is a
//! matter for [`crate::quadrature`].

use std::f64::consts::PI;

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::{Outcome, quadrature};

/// Fewest expected counts in a cell.
pub const POOL: f64 = 5.0;

/// Tests counts against expectations of any scale.
pub fn chi_square(observed: &[u64], expected: &[f64]) -> Outcome {
    let total = observed.iter().sum::<u64>() as f64;
    let scale = total / expected.iter().sum::<f64>();
    if !(scale.is_finite() && scale > 0.0) || expected.iter().any(|e| e.is_nan() || *e < 0.0) {
        return Outcome { p: 0.0, detail: format!("{total} counts against expectations that are no density") };
    }
    let mut cells: Vec<(usize, f64, f64)> =
        observed.iter().zip(expected).enumerate().map(|(i, (&o, e))| (i, o as f64, e * scale)).collect();
    if let Some((i, o, _)) = cells.iter().find(|(_, o, e)| *o > 0.0 && *e == 0.0) {
        return Outcome { p: 0.0, detail: format!("{o} counts in cell {i}, where the density is zero") };
    }
    cells.sort_by(|a, b| a.2.total_cmp(&b.2));

    let (mut chi2, mut used, mut worst) = (0.0, 0u32, (0.0, 0, 0.0, 0.0));
    let (mut o_pool, mut e_pool) = (0.0, 0.0);
    for (i, o, e) in cells {
        o_pool += o;
        e_pool += e;
        if e_pool >= POOL {
            let term = (o_pool - e_pool) * (o_pool - e_pool) / e_pool;
            chi2 += term;
            used += 1;
            if term > worst.0 {
                worst = (term, i, o_pool, e_pool);
            }
            (o_pool, e_pool) = (0.0, 0.0);
        }
    }
    let degrees = f64::from(used) - 1.0;
    let p = ChiSquared::new(degrees).map_or(0.0, |distribution| distribution.sf(chi2));
    let (_, i, o, e) = worst;
    Outcome {
        p, detail: format!("χ² = {chi2:.1} with {degrees} degrees; worst cell {i}: {o} counts, {e:.1} expected")
    }
}

/// A rectangle cut into cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Range of the first coordinate.
    pub x: [f64; 2],
    /// Range of the second coordinate.
    pub y: [f64; 2],
    /// Cells along the first.
    pub nx: usize,
    /// Cells along the second.
    pub ny: usize,
}

impl Grid {
    /// The sphere as cos θ × φ: cells of equal solid angle.
    pub const SPHERE: Self = Self { x: [-1.0, 1.0], y: [-PI, PI], nx: 16, ny: 32 };
    /// The unit square.
    pub const SQUARE: Self = Self { x: [0.0, 1.0], y: [0.0, 1.0], nx: 24, ny: 24 };

    /// The cell of a point; rounding may put it outside by a millionth of the range.
    fn cell(&self, p: [f64; 2]) -> Option<usize> {
        let index = |v: f64, range: [f64; 2], n: usize| {
            let f = (v - range[0]) / (range[1] - range[0]);
            (-1e-6..=1.0 + 1e-6).contains(&f).then(|| ((f.max(0.0) * n as f64) as usize).min(n - 1))
        };
        Some(index(p[0], self.x, self.nx)? * self.ny + index(p[1], self.y, self.ny)?)
    }

    /// Integrals of `density` over the cells.
    pub fn integrate(&self, density: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
        let edge = |range: [f64; 2], i: usize, n: usize| range[0] + (range[1] - range[0]) * i as f64 / n as f64;
        let tolerance = 1e-4 / (self.nx * self.ny) as f64;
        let mut cells = Vec::with_capacity(self.nx * self.ny);
        for i in 0..self.nx {
            for j in 0..self.ny {
                let x = [i, i + 1].map(|i| edge(self.x, i, self.nx));
                let y = [j, j + 1].map(|j| edge(self.y, j, self.ny));
                cells.push(quadrature::adaptive_rectangle(x, y, tolerance, 6, &density));
            }
        }
        cells
    }

    /// Draws `n` points and compares the counts with `density` over the grid's coordinates.
    ///
    /// `sample` may refuse (`None`); refusals are a cell of their own that expects `1 − ∫ density`.
    pub fn test(
        &self,
        n: usize,
        mut sample: impl FnMut() -> Option<[f64; 2]>,
        density: impl Fn([f64; 2]) -> f64,
    ) -> Outcome {
        let mut expected = self.integrate(density);
        let mut observed = vec![0u64; expected.len()];
        let mut refused = 0;
        for _ in 0..n {
            let Some(p) = sample() else {
                refused += 1;
                continue;
            };
            match self.cell(p) {
                Some(i) => observed[i] += 1,
                None => {
                    return Outcome {
                        p: 0.0,
                        detail: format!("sample {p:?} is outside of {:?} × {:?}", self.x, self.y),
                    };
                }
            }
        }
        if refused > 0 {
            observed.push(refused);
            expected.push((1.0 - expected.iter().sum::<f64>()).max(0.0));
        }
        chi_square(&observed, &expected)
    }
}

/// Draws `n` directions and compares them with `pdf` [1/sr] over the sphere. As in [`Grid::test`], `sample` may refuse.
pub fn sphere_test(n: usize, mut sample: impl FnMut() -> Option<[f64; 3]>, pdf: impl Fn([f64; 3]) -> f64) -> Outcome {
    let coordinates = |d: [f64; 3]| [d[2].clamp(-1.0, 1.0), d[1].atan2(d[0])];
    Grid::SPHERE.test(n, || sample().map(coordinates), |p| pdf(quadrature::direction(p)))
}

/// Draws `n` numbers and compares them with `density` on `range`, in `cells` cells.
pub fn line_test(
    range: [f64; 2],
    cells: usize,
    n: usize,
    mut sample: impl FnMut() -> f64,
    density: impl Fn(f64) -> f64,
) -> Outcome {
    let grid = Grid { x: range, y: [0.0, 1.0], nx: cells, ny: 1 };
    grid.test(n, || Some([sample(), 0.5]), |p| density(p[0]))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Stream;

    /// Four cells of 25 expected: deviations ±5 give χ² = 4 · 25/25 = 4 with 3 degrees, p = 0.2615.
    #[test]
    fn the_statistic_and_its_p_value_are_those_of_the_textbook() {
        let outcome = chi_square(&[30, 20, 30, 20], &[1.0; 4]);
        assert!((outcome.p - 0.261_464).abs() < 1e-5, "{outcome:?}");
    }

    #[test]
    fn counts_where_the_density_is_zero_fail_and_small_cells_are_pooled() {
        assert_eq!(chi_square(&[50, 1], &[1.0, 0.0]).p, 0.0);
        // Ten cells of one expected count each become two of five.
        let outcome = chi_square(&[1, 1, 1, 1, 1, 1, 1, 1, 1, 1], &[1.0; 10]);
        assert!(outcome.detail.contains("with 1 degrees") && outcome.p > 0.99, "{outcome:?}");
        assert_eq!(chi_square(&[1, 2], &[f64::NAN, 1.0]).p, 0.0);
    }

    fn uniform_direction(s: &mut Stream) -> [f64; 3] {
        quadrature::direction([2.0 * s.next_f64() - 1.0, TAU * s.next_f64()])
    }

    /// A tilt of 0.04 deviates by 0.04/√3 of the density, root mean square: with n = 10⁶ samples χ² grows by n · 0.04²/3
    /// = 533, where the standard deviation at 511 degrees of freedom is 32.
    #[test]
    fn a_uniform_sphere_passes_and_a_slightly_tilted_one_fails() {
        let tilted = |a: f64| move |d: [f64; 3]| (1.0 + a * d[0]) / (4.0 * PI);
        let mut s = Stream::new(11);
        assert!(sphere_test(1_000_000, || Some(uniform_direction(&mut s)), tilted(0.0)).p > 1e-3);
        assert!(sphere_test(1_000_000, || Some(uniform_direction(&mut s)), tilted(0.04)).p < 1e-6);
    }

    /// Shape only: a density that is 1 % too large passes here, and must be found by quadrature.
    #[test]
    fn the_test_is_blind_to_scale() {
        let mut s = Stream::new(12);
        assert!(sphere_test(100_000, || Some(uniform_direction(&mut s)), |_| 1.01 / (4.0 * PI)).p > 1e-3);
    }

    /// A sampler that refuses one direction in ten has a density that integrates to 0.9. Against 0.91 the cell of refusals
    /// alone adds n · 0.01²/0.09 = 444 to χ² at n = 400,000.
    #[test]
    fn refused_samples_are_a_cell_of_their_own() {
        let mut s = Stream::new(13);
        let mut refuse = |rate: f64, density: f64| {
            let mut sample = || {
                let d = uniform_direction(&mut s);
                (s.next_f64() >= rate).then_some(d)
            };
            sphere_test(400_000, &mut sample, |_| density / (4.0 * PI)).p
        };
        assert!(refuse(0.1, 0.9) > 1e-3);
        assert!(refuse(0.1, 0.91) < 1e-6);
    }

    /// u^0.49 in place of √u: relative deviation 0.02 (1 + 2 ln x), root mean square 0.02; χ² grows by n · 0.02² = 416.
    #[test]
    fn samples_on_a_line_follow_their_density_or_fail() {
        let mut s = Stream::new(14);
        assert!(line_test([0.0, 1.0], 50, 1_000_000, || s.next_f64().sqrt(), |x| 2.0 * x).p > 1e-3);
        assert!(line_test([0.0, 1.0], 50, 1_000_000, || s.next_f64().powf(0.49), |x| 2.0 * x).p < 1e-6);
        assert_eq!(line_test([0.0, 1.0], 50, 10, || 1.5, |_| 1.0).p, 0.0);
    }
}
