//! Repetition: photons in batches, and means over batches with their standard errors.
//!
//! A photon adds to a quantity more than once (it collides many times in one bin of depth), so the error is taken from
//! the spread between batches, which are independent: `s.e.² = Σ (x_b − x̄)² / (B (B − 1))`. Batches have a fixed size and
//! streams of random numbers by their number, and are summed in order: figures depend on the seed and on the number of
//! photons, and on nothing else.

use std::ops::Range;

use rayon::prelude::*;
use serde::Serialize;
use tyndall::tally::Tally;

/// Photons of a batch.
pub const BATCH: u64 = 250;
/// Batches between two looks at the clock, at first and at most: the longer an experiment has run, the less a look matters.
const ROUND: [u64; 2] = [64, 256];
/// A round is so small a part of the batches before it.
const ROUND_OF_ALL: u64 = 4;
/// Tasks of a round whose batches are done together.
const TASKS: u64 = 8;

/// A figure with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Estimate {
    /// The same in another unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { mean: self.mean * factor, standard_error: self.standard_error * factor.abs() }
    }
}

/// The sums of an experiment so far.
#[derive(Debug, Clone)]
pub struct Sums {
    /// Batches so far.
    pub batches: u64,
    /// What happened to the photons.
    pub tally: Tally,
    sum: Vec<f64>,
    squares: Vec<f64>,
}

/// What a batch of photons gave: a total for each quantity.
pub type Batch = (Vec<f64>, Tally);

impl Sums {
    fn new(quantities: usize) -> Self {
        Self { batches: 0, tally: Tally::default(), sum: vec![0.0; quantities], squares: vec![0.0; quantities] }
    }

    fn add(&mut self, (totals, tally): &Batch) {
        self.batches += 1;
        self.tally = std::mem::take(&mut self.tally).merged(tally);
        for ((sum, square), total) in self.sum.iter_mut().zip(&mut self.squares).zip(totals) {
            let x = total / BATCH as f64;
            *sum += x;
            *square += x * x;
        }
    }

    /// Photons so far.
    pub fn photons(&self) -> u64 {
        self.batches * BATCH
    }

    /// The mean of a quantity for each photon.
    pub fn estimate(&self, quantity: usize) -> Estimate {
        let n = self.batches as f64;
        let mean = self.sum[quantity] / n;
        let variance = (self.squares[quantity] / n - mean * mean).max(0.0) / (n - 1.0).max(1.0);
        Estimate { mean, standard_error: if self.batches < 2 { f64::INFINITY } else { variance.sqrt() } }
    }

    /// The means of a range of quantities.
    pub fn estimates(&self, quantities: std::ops::Range<usize>) -> Vec<Estimate> {
        quantities.map(|quantity| self.estimate(quantity)).collect()
    }
}

/// Whether an experiment goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// More photons.
    GoOn,
    /// That is enough.
    Enough,
}

/// Runs batches, `batch(n)` being the one of number `n`, until `photons` have been launched or `look`, which sees the sums
/// after every round, has seen enough.
pub fn run(
    quantities: usize,
    photons: u64,
    batch: impl Fn(u64) -> Batch + Sync,
    look: impl FnMut(&Sums) -> Verdict,
) -> Sums {
    run_rounds(quantities, photons, |_| 1, |numbers| numbers.map(&batch).collect(), look)
}

/// Runs batches, `batches(n..m)` being those of numbers n to m, which gain by being done together, until `photons` have been
/// launched or `look`, which sees the sums after every round, has seen enough.
pub fn run_together(
    quantities: usize,
    photons: u64,
    batches: impl Fn(Range<u64>) -> Vec<Batch> + Sync,
    look: impl FnMut(&Sums) -> Verdict,
) -> Sums {
    run_rounds(quantities, photons, |round| round.div_ceil(TASKS), batches, look)
}

/// The same; `together` of a round's batches are a task.
fn run_rounds(
    quantities: usize,
    photons: u64,
    together: impl Fn(u64) -> u64,
    batches: impl Fn(Range<u64>) -> Vec<Batch> + Sync,
    mut look: impl FnMut(&Sums) -> Verdict,
) -> Sums {
    let last = photons.div_ceil(BATCH).max(2);
    let mut sums = Sums::new(quantities);
    while sums.batches < last {
        let round = (sums.batches / ROUND_OF_ALL).clamp(ROUND[0], ROUND[1]);
        let (start, end) = (sums.batches, (sums.batches + round).min(last));
        let together = together(end - start);
        let parts = (0..(end - start).div_ceil(together)).into_par_iter();
        let part = |i: u64| start + i * together..(start + (i + 1) * together).min(end);
        let done: Vec<Vec<Batch>> = parts.map(|i| batches(part(i))).collect();
        for batch in done.iter().flatten() {
            sums.add(batch);
        }
        if look(&sums) == Verdict::Enough && sums.batches >= 2 {
            break;
        }
    }
    sums
}

/// The photons of a batch by their numbers.
pub fn photons_of(batch: u64) -> Range<u64> {
    batch * BATCH..(batch + 1) * BATCH
}
