//! What all figures say together.
//!
//! Tests that look for different faults share the chance α of a false alarm:
//!
//! - the greatest `|z|` of all figures (one is far off), with Šidák's correction for their number;
//! - in each family `Σ shift/√N` over its N experiments: all figures are off in one direction, as absorption makes them;
//! - in each family `Σ tilt/√N`: reflectances are off against transmittances, as scattering makes them, where the two
//!   cancel in the shift;
//! - in each family `Σ shift²` and `Σ tilt²`: many are a little off, in any direction.

use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::function::erf::erfc;

use super::ORACLES;
use super::experiment::{Check, Experiment};

/// What all figures say together.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Judgement {
    /// How many figures there are.
    pub figures: usize,
    /// Chance that the greatest `|z|` of all is as large.
    pub p_greatest: f64,
    /// Table by table.
    pub families: Vec<FamilyJudgement>,
    /// The chance of the worst of these tests, corrected for their number.
    pub p: f64,
}

/// What the experiments of a table say together.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FamilyJudgement {
    /// The table.
    pub family: &'static str,
    /// How many figures it has.
    pub figures: usize,
    /// How many were left out, because hardly any photon contributes to them.
    pub rare: usize,
    /// How many experiments.
    pub experiments: usize,
    /// The greatest `|z|` of a figure.
    pub greatest: f64,
    /// All figures in one direction.
    pub shift: Together,
    /// Figures against each other, where there are such.
    pub tilt: Option<Together>,
}

/// What numbers that should be standard normal, one an experiment, say together.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Together {
    /// `Σ x/√N`.
    pub sum: f64,
    /// Chance of a sum as far from 0.
    pub p_sum: f64,
    /// `Σ x²`.
    pub chi_square: f64,
    /// Chance of a χ² as large.
    pub p_chi_square: f64,
}

/// Judges all experiments. Nothing measured is nothing shown: p is 0.
pub fn judge(experiments: &[Experiment]) -> Judgement {
    let of = |name: &'static str| experiments.iter().filter(|e| e.family == name).collect::<Vec<_>>();
    let families: Vec<FamilyJudgement> =
        ORACLES.iter().map(|oracle| of(oracle.name)).filter(|f| !f.is_empty()).map(|f| judge_family(&f)).collect();
    let figures = experiments.iter().map(|e| e.checks.len()).sum();
    let least = experiments.iter().flat_map(|e| &e.checks).map(Check::p).fold(1.0, f64::min);
    let p_greatest = sidak(least, figures);
    let together = families.iter().flat_map(|f| std::iter::once(f.shift).chain(f.tilt));
    let tests = together.flat_map(|t| [t.p_sum, t.p_chi_square]).chain([p_greatest]);
    let worst = tests.clone().fold(1.0, f64::min);
    let p = if figures == 0 { 0.0 } else { sidak(worst, tests.count()) };
    Judgement { figures, p_greatest, families, p }
}

fn judge_family(experiments: &[&Experiment]) -> FamilyJudgement {
    let shifts: Vec<f64> = experiments.iter().map(|e| e.shift).collect();
    let tilts: Vec<f64> = experiments.iter().filter_map(|e| e.tilt).collect();
    FamilyJudgement {
        family: experiments[0].family,
        figures: experiments.iter().map(|e| e.checks.len()).sum(),
        rare: experiments.iter().map(|e| e.rare).sum(),
        experiments: experiments.len(),
        greatest: experiments.iter().flat_map(|e| &e.checks).map(|c| c.z().abs()).fold(0.0, f64::max),
        shift: Together::of(&shifts),
        tilt: (!tilts.is_empty()).then(|| Together::of(&tilts)),
    }
}

impl Together {
    fn of(numbers: &[f64]) -> Self {
        let n = numbers.len() as f64;
        let sum = numbers.iter().sum::<f64>() / n.sqrt();
        let chi_square: f64 = numbers.iter().map(|x| x * x).sum();
        let p_chi_square = ChiSquared::new(n).map_or(0.0, |law| law.sf(chi_square));
        Self {
            sum,
            p_sum: two_sided(sum),
            chi_square,
            p_chi_square: if chi_square.is_nan() { 0.0 } else { p_chi_square },
        }
    }
}

/// The chance of a standard normal number as far from 0; none for what is not a number.
pub(super) fn two_sided(z: f64) -> f64 {
    if z.is_nan() { 0.0 } else { erfc(z.abs() / std::f64::consts::SQRT_2) }
}

/// The chance that the least of `n` independent p-values is as small as `p`: `1 − (1 − p)ⁿ`.
fn sidak(p: f64, n: usize) -> f64 {
    -(n as f64 * (-p).ln_1p()).exp_m1()
}
