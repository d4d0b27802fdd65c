//! Experiments: figures that are measured together, several times over.
//!
//! The figures of one experiment share its photons, and so do not err independently. Each experiment is therefore done
//! [`REPLICATES`] times, and the sum of all its `z`, replicate by replicate, tells whether they are off together: its mean
//! over its spread follows Student's law.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use tyndall::{sampling::rng::mix64, scene::Scene};

use super::defect::Defect;
use super::judge::two_sided;
use crate::run::{Estimate, Sums, Verdict};
use crate::slab::{self, Measured, Setup};
use crate::world::SetupError;

/// One figure: what it should be, and what it is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Check {
    /// What it is.
    pub name: String,
    /// What it should be.
    pub expected: f64,
    /// Standard error or accuracy of that.
    pub uncertainty: f64,
    /// What was measured.
    pub measured: Estimate,
    /// Whether more scattering makes it smaller, as it does what is transmitted.
    pub falls: bool,
    /// Whether the expectation was itself sampled, and errs independently of others: what a Monte Carlo table says of bins,
    /// of which each photon reaches one.
    #[serde(skip)]
    pub sampled: bool,
    /// Whether hardly any photon, or sample, may contribute to it: then it is left out where its error cannot be known.
    #[serde(skip)]
    pub binned: bool,
}

/// Relative rounding of a figure that is computed in single precision.
const ROUNDING: f64 = 1e-6;

impl Check {
    /// A figure that more scattering makes larger.
    pub fn new(name: impl Into<String>, expected: f64, uncertainty: f64, measured: Estimate) -> Self {
        Self { name: name.into(), expected, uncertainty, measured, falls: false, sampled: false, binned: false }
    }

    /// A figure that more scattering makes smaller.
    #[must_use]
    pub fn falling(self) -> Self {
        Self { falls: true, ..self }
    }

    /// A figure whose expectation was sampled, independently of others.
    #[must_use]
    pub fn sampled(self) -> Self {
        Self { sampled: true, ..self }
    }

    /// A figure to which few photons may contribute, as that of a bin.
    #[must_use]
    pub fn binned(self) -> Self {
        Self { binned: true, ..self }
    }

    /// Whether so few photons contribute to it that their number says nothing.
    fn is_rare(&self) -> bool {
        self.binned && self.measured.standard_error >= RAREST * self.measured.mean.abs() && self.z() != 0.0
    }

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
    /// How many others were left out, because hardly any photon contributes to them.
    pub rare: usize,
    /// Whether they are off in one direction: a standard normal number if nothing is wrong.
    pub shift: f64,
    /// Whether those that more scattering makes larger are off against those that it makes smaller; where there are both.
    pub tilt: Option<f64>,
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
    /// What is wrong on purpose.
    pub defect: Option<Defect>,
}

/// The photons of one replicate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub(super) photons: u64,
    pub(super) seed: u64,
    pub(super) error: f64,
    defect: Option<Defect>,
}

impl Effort {
    /// Under a minute on two cores.
    pub const QUICK: Self = Self { photons: 20_000, every: 4, error: 0.0, seed: 0, defect: None };
    /// To a standard error of 0.1 % of what is sent in, or better.
    pub const FULL: Self = Self { photons: 1_000_000, every: 1, error: 1e-3, seed: 0, defect: None };

    /// `times` the photons, for an experiment whose figures share them, or whose photons are soon done.
    pub(super) fn times(self, times: u64) -> Self {
        Self { photons: self.photons * times, ..self }
    }

    /// With so much smaller errors, for an experiment whose figures half a percent of a coefficient hardly moves.
    pub(super) fn finer(self, times: f64) -> Self {
        Self { error: self.error / times, ..self }
    }

    /// For experiments whose photons go on for thousands of collisions: of a part of the tables a part of the photons.
    pub(super) fn long(self) -> Self {
        if self.every > 1 { Self { photons: self.photons / 4, ..self } } else { self }
    }

    /// Does an experiment [`REPLICATES`] times, each with other random numbers, and sums up.
    pub(super) fn experiment(
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
            defect: self.defect,
        };
        let replicates = (0..REPLICATES).map(|k| measure(share(k))).collect::<Result<Vec<_>, _>>()?;
        Ok(Experiment::of(family, &replicates))
    }
}

impl Share {
    /// Stops when the errors of the given quantities are small enough.
    pub(super) fn look(self, quantities: std::ops::Range<usize>) -> impl FnMut(&Sums) -> Verdict {
        move |sums| {
            // An error from few batches is itself uncertain.
            let known = sums.batches >= 64;
            let small = || quantities.clone().all(|q| sums.estimate(q).standard_error <= self.error);
            if known && small() { Verdict::Enough } else { Verdict::GoOn }
        }
    }

    /// The same photons anew: for another figure of the same experiment.
    pub(super) fn again(self, number: u32) -> Self {
        Self { seed: mix64(self.seed ^ mix64(u64::from(number))), ..self }
    }

    /// The scene, with what is wrong on purpose.
    pub(super) fn scene(self, scene: Scene) -> Scene {
        match self.defect {
            Some(defect) => defect.spoil(scene),
            None => scene,
        }
    }

    /// An experiment on plane layers.
    pub(super) fn slab(self, setup: &Setup) -> Result<Measured, SetupError> {
        setup.check()?;
        let scene = self.scene(setup.scene()?);
        // The first quantities are what leaves.
        Ok(slab::measure_in(&scene, setup, self.photons, self.seed, self.look(0..6)))
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
            .filter(|check| !check.is_rare())
            .collect();
        let together = |sign: fn(&Check) -> f64| {
            let sum = |replicate: &Vec<Check>| -> f64 {
                let of =
                    |check: &Check| replicate.iter().find(|other| other.name == check.name).map(|c| c.measured.mean);
                checks.iter().filter_map(|c| Some(sign(c) * (of(c)? - c.expected) / c.error())).sum()
            };
            standard(&replicates.iter().map(sum).collect::<Vec<_>>(), unknown(&checks))
        };
        let shift = together(|_| 1.0);
        let both = checks.iter().any(|c| c.falls) && checks.iter().any(|c| !c.falls);
        let tilt = both.then(|| together(|check| if check.falls { -1.0 } else { 1.0 }));
        Self { family, rare: figures - checks.len(), checks, shift, tilt }
    }
}

/// The error that a sum of all `z` has from expectations, which replicates do not average out: what was sampled adds up in
/// squares, of all else it is taken that it errs in one direction.
fn unknown(checks: &[Check]) -> f64 {
    let each = |sampled| checks.iter().filter(move |c| c.sampled == sampled).map(|c| c.accuracy() / c.error());
    each(false).sum::<f64>().hypot(each(true).map(|u| u * u).sum::<f64>().sqrt())
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
