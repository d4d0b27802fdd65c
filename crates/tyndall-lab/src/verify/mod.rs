//! The program against numbers that others computed or published.
//!
//! An oracle is a table with its source, and a row of code that measures each of its figures. A figure `x ± s` against an
//! expected `e ± u` gives `z = (x − e)/√(s² + u² + ρ²)`, with `ρ` the rounding of single precision, `10⁻⁶·e`.
//!
//! The figures of one experiment share its photons, and so do not err independently. Each experiment is therefore done
//! [`REPLICATES`] times, and the sum of all its `z`, replicate by replicate, tells whether they are off together: its mean
//! over its spread follows Student's law. Three tests look at everything, and share the chance α of a false alarm:
//!
//! - the greatest `|z|` of all figures (one is far off), with Šidák's correction for their number;
//! - `Σ shift/√N` over the experiments of each family (all are off in one direction, as a coefficient that is 0.5 % too large
//!   makes them);
//! - `Σ shift²` over the experiments of each family (many are a little off, in any direction).

mod balls;
mod layers;
mod points;
pub(crate) mod table;
mod walks;

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};
use statrs::function::erf::erfc;
use tyndall::sampling::rng::mix64;

use crate::run::{Estimate, Sums, Verdict};
use crate::world::SetupError;

/// One figure: what it should be, and what it is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Check {
    /// The table it is from.
    pub family: &'static str,
    /// What it is.
    pub name: String,
    /// What it should be.
    pub expected: f64,
    /// Standard error or accuracy of that.
    pub uncertainty: f64,
    /// What was measured.
    pub measured: Estimate,
}

/// Relative rounding of a figure that is computed in single precision.
const ROUNDING: f64 = 1e-6;

impl Check {
    /// The deviation in standard errors.
    pub fn z(&self) -> f64 {
        let difference = self.measured.mean - self.expected;
        if difference == 0.0 { 0.0 } else { difference / self.error() }
    }

    /// The standard error of the difference.
    fn error(&self) -> f64 {
        self.measured.standard_error.hypot(self.accuracy())
    }

    /// How well the expectation is known, rounding included.
    fn accuracy(&self) -> f64 {
        self.uncertainty.hypot(ROUNDING * self.expected.abs())
    }

    /// The chance of a deviation as large.
    pub fn p(&self) -> f64 {
        two_sided(self.z())
    }
}

/// How often an experiment is repeated.
pub const REPLICATES: u64 = 8;

/// Figures that were measured together, in the same experiment.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Experiment {
    /// The table they are from.
    pub family: &'static str,
    /// The figures.
    pub checks: Vec<Check>,
    /// Whether they are off together: a standard normal number if nothing is wrong.
    pub shift: f64,
}

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Photons of one experiment, at most.
    pub photons: u64,
    /// Of each table the experiments 0, n, 2n, …
    pub every: usize,
    /// Standard error, as a part of what is sent in, at which an experiment ends.
    pub error: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The photons of one replicate.
#[derive(Debug, Clone, Copy)]
struct Share {
    photons: u64,
    seed: u64,
    error: f64,
}

impl Effort {
    /// Under a minute on two cores.
    pub const QUICK: Self = Self { photons: 20_000, every: 4, error: 0.0, seed: 0 };
    /// To a standard error of 0.1 % of what is sent in, or better.
    pub const FULL: Self = Self { photons: 1_000_000, every: 1, error: 5e-4, seed: 0 };

    /// Does an experiment [`REPLICATES`] times, each with other random numbers, and sums up.
    fn experiment(
        self,
        family: &'static str,
        number: usize,
        mut measure: impl FnMut(Share) -> Result<Vec<Check>, SetupError>,
    ) -> Result<Experiment, SetupError> {
        // Of each experiment of each table its own.
        let first = family.bytes().fold(mix64(self.seed ^ mix64(number as u64)), |key, b| mix64(key ^ u64::from(b)));
        let share = |k| Share {
            photons: self.photons / REPLICATES,
            seed: first.wrapping_add(k),
            error: self.error * (REPLICATES as f64).sqrt(),
        };
        let replicates = (0..REPLICATES).map(|k| measure(share(k))).collect::<Result<Vec<_>, _>>()?;
        Ok(Experiment::of(family, &replicates))
    }
}

impl Share {
    /// Stops when the errors of the given quantities are small enough.
    fn look(self, quantities: std::ops::Range<usize>) -> impl FnMut(&Sums) -> Verdict {
        move |sums| {
            // An error from few batches is itself uncertain.
            let known = sums.batches >= 64;
            let small = || quantities.clone().all(|q| sums.estimate(q).standard_error <= self.error);
            if known && small() { Verdict::Enough } else { Verdict::GoOn }
        }
    }
}

impl Experiment {
    /// Sums up replicates of the same figures.
    fn of(family: &'static str, replicates: &[Vec<Check>]) -> Self {
        let n = replicates.len() as f64;
        let figures = replicates.iter().map(Vec::len).min().unwrap_or(0);
        let checks: Vec<Check> = (0..figures)
            .map(|i| {
                let each = || replicates.iter().map(|checks| &checks[i].measured);
                let mean = each().map(|e| e.mean).sum::<f64>() / n;
                let standard_error = each().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt() / n;
                Check { measured: Estimate { mean, standard_error }, ..replicates[0][i].clone() }
            })
            // A figure that hardly any photon contributes to has no error that could be known.
            .filter(|check| check.measured.standard_error < RAREST * check.measured.mean.abs() || check.z() == 0.0)
            .collect();
        let sum = |replicate: &Vec<Check>| -> f64 {
            let of = |check: &Check| replicate.iter().find(|other| other.name == check.name).map(|c| c.measured.mean);
            checks.iter().filter_map(|c| Some((of(c)? - c.expected) / c.error())).sum()
        };
        // What is not known of the expectations does not average out.
        let unknown = checks.iter().map(|c| c.accuracy() / c.error()).sum();
        let shift = standard(&replicates.iter().map(sum).collect::<Vec<_>>(), unknown);
        Self { family, checks, shift }
    }
}

/// Relative errors beyond this come from so few photons that they say nothing.
const RAREST: f64 = 0.03;

/// The mean of independent numbers over its standard error and an `offset` that they may share, as the standard normal
/// number that is as unlikely.
fn standard(numbers: &[f64], offset: f64) -> f64 {
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let error = (numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt().hypot(offset);
    if mean == 0.0 && error == 0.0 {
        return 0.0;
    }
    let below = StudentsT::new(0.0, 1.0, n - 1.0).map_or(f64::NAN, |law| law.cdf(-(mean / error).abs()));
    -Normal::standard().inverse_cdf(below.max(f64::MIN_POSITIVE)) * mean.signum()
}

/// A table and how its figures are measured.
#[derive(Debug, Clone, Copy)]
pub struct Oracle {
    /// Its name.
    pub name: &'static str,
    /// What it holds.
    pub about: &'static str,
    /// Who made it.
    pub source: &'static str,
    measure: fn(&'static str, Effort) -> Result<Vec<Experiment>, SetupError>,
}

impl Oracle {
    /// Measures its figures.
    ///
    /// # Errors
    /// The table holds an experiment that cannot be set up.
    pub fn measure(&self, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
        (self.measure)(self.name, effort)
    }
}

/// All tables.
pub const ORACLES: &[Oracle] = &[
    Oracle {
        name: "slabs",
        about: "reflectance and transmittance of slabs and half-spaces, collimated and diffuse",
        source: "adding-doubling (iadpython, Prahl 2023)",
        measure: layers::slabs,
    },
    Oracle {
        name: "half-space",
        about: "albedo of an isotropic half-space: all orders, the first, the second",
        source: "Chandrasekhar 1960, d'Eon 2016; closed forms",
        measure: layers::half_spaces,
    },
    Oracle {
        name: "mcml-totals",
        about: "diffuse reflectance and transmittance of tissue, marble and milk",
        source: "adding-doubling, on the cases of MCML 1.2 (Wang, Jacques and Zheng 1995)",
        measure: layers::mcml_totals,
    },
    Oracle {
        name: "mcml-angle",
        about: "van de Hulst's slab by exit angle",
        source: "adding-doubling; MCML 1.2",
        measure: layers::by_angle,
    },
    Oracle {
        name: "mcml-radius",
        about: "reflectance by radius of marble, milk, tissue and others",
        source: "MCML 1.2, 10⁶ to 2·10⁷ photons",
        measure: layers::by_radius,
    },
    Oracle {
        name: "points",
        about: "fluence around a point source",
        source: "d'Eon's Monte Carlo; exact where scattering is isotropic (Davison 1947)",
        measure: points::fluence,
    },
    Oracle {
        name: "point-moments",
        about: "moments of the fluence around a point source",
        source: "Case, de Hoffmann and Placzek 1953; closed forms",
        measure: points::moments,
    },
    Oracle {
        name: "walks",
        about: "moments of a random walk after n flights",
        source: "closed forms",
        measure: walks::moments,
    },
    Oracle {
        name: "balls",
        about: "escape from and absorption in a scattering ball",
        source: "integral equation; Case, de Hoffmann and Placzek 1953",
        measure: balls::balance,
    },
];

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
    /// How many experiments.
    pub experiments: usize,
    /// The greatest `|z|` of a figure.
    pub greatest: f64,
    /// `Σ shift²`.
    pub chi_square: f64,
    /// Chance of a χ² as large.
    pub p_chi_square: f64,
    /// `Σ shift / √N`.
    pub shift: f64,
    /// Chance of a shift as large.
    pub p_shift: f64,
}

/// Judges all experiments. Nothing measured is nothing shown: p is 0.
pub fn judge(experiments: &[Experiment]) -> Judgement {
    let of = |name: &'static str| experiments.iter().filter(|e| e.family == name).collect::<Vec<_>>();
    let families: Vec<FamilyJudgement> =
        ORACLES.iter().map(|oracle| of(oracle.name)).filter(|f| !f.is_empty()).map(|f| judge_family(&f)).collect();
    let figures = experiments.iter().map(|e| e.checks.len()).sum();
    let least = experiments.iter().flat_map(|e| &e.checks).map(Check::p).fold(1.0, f64::min);
    let p_greatest = sidak(least, figures);
    let tests = families.iter().flat_map(|f| [f.p_chi_square, f.p_shift]).chain([p_greatest]);
    let worst = tests.clone().fold(1.0, f64::min);
    let p = if figures == 0 { 0.0 } else { sidak(worst, tests.count()) };
    Judgement { figures, p_greatest, families, p }
}

fn judge_family(experiments: &[&Experiment]) -> FamilyJudgement {
    let n = experiments.len() as f64;
    let chi_square: f64 = experiments.iter().map(|e| e.shift * e.shift).sum();
    let shift = experiments.iter().map(|e| e.shift).sum::<f64>() / n.sqrt();
    FamilyJudgement {
        family: experiments[0].family,
        figures: experiments.iter().map(|e| e.checks.len()).sum(),
        experiments: experiments.len(),
        greatest: experiments.iter().flat_map(|e| &e.checks).map(|c| c.z().abs()).fold(0.0, f64::max),
        chi_square,
        p_chi_square: ChiSquared::new(n).map_or(0.0, |law| law.sf(chi_square)),
        shift,
        p_shift: two_sided(shift),
    }
}

/// The chance of a standard normal number as far from 0; none for what is not a number.
fn two_sided(z: f64) -> f64 {
    if z.is_nan() { 0.0 } else { erfc(z.abs() / std::f64::consts::SQRT_2) }
}

/// The chance that the least of `n` independent p-values is as small as `p`: `1 − (1 − p)ⁿ`.
fn sidak(p: f64, n: usize) -> f64 {
    -(n as f64 * (-p).ln_1p()).exp_m1()
}
