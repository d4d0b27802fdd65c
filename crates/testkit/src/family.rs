//! Many tests as one: the more tests, the smaller each one's significance.
//!
//! `m` independent tests at level `1 − (1 − α)^(1/m)` raise a false alarm with probability `α` together (Šidák 1967).

use std::{fmt::Write, thread};

use crate::Outcome;

/// The level of each of `m` tests that gives the level `alpha` to all together.
pub fn sidak(alpha: f64, m: usize) -> f64 {
    // In this form small levels keep their digits.
    -((-alpha).ln_1p() / m.max(1) as f64).exp_m1()
}

/// A collection of tests that stand or fall together.
///
/// [`Family::finish`] must be called; a family dropped before it panics, since its tests would pass unread.
#[derive(Debug)]
pub struct Family {
    name: String,
    alpha: f64,
    outcomes: Vec<(String, Outcome)>,
    finished: bool,
}

impl Family {
    /// A family with false-alarm probability `alpha` as a whole, such as 0.01.
    pub fn new(name: &str, alpha: f64) -> Self {
        Self { name: name.to_owned(), alpha, outcomes: Vec::new(), finished: false }
    }

    /// Adds a test: an [`Outcome`] or a bare p-value.
    pub fn check(&mut self, name: &str, outcome: impl Into<Outcome>) {
        self.outcomes.push((name.to_owned(), outcome.into()));
    }

    /// The table of tests that failed, or nothing.
    pub fn failures(&self) -> Option<String> {
        let level = sidak(self.alpha, self.outcomes.len());
        // Not `p < level`, so that NaN fails.
        let failed: Vec<_> = self.outcomes.iter().filter(|(_, o)| o.p.is_nan() || o.p < level).collect();
        if failed.is_empty() {
            return None;
        }
        let width = failed.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        let (count, all) = (failed.len(), self.outcomes.len());
        let mut table = format!("{}: {count} of {all} tests failed at p < {level:.1e}\n", self.name);
        for (name, outcome) in failed {
            let _ = writeln!(table, "  {name:width$}  p = {:<8.1e}  {}", outcome.p, outcome.detail);
        }
        Some(table)
    }

    /// Reads the family's verdict.
    ///
    /// # Panics
    /// When a test failed, with a table of those that did; and when there is no test at all.
    #[track_caller]
    pub fn finish(mut self) {
        self.finished = true;
        assert!(!self.outcomes.is_empty(), "{}: no tests", self.name);
        if let Some(table) = self.failures() {
            panic!("{table}");
        }
    }
}

impl Drop for Family {
    fn drop(&mut self) {
        assert!(self.finished || thread::panicking(), "{}: finish() was not called", self.name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For small α it is nearly Bonferroni's α/m, and for m = 1 it is α.
    #[test]
    fn the_level_shrinks_with_the_family() {
        assert!((sidak(0.05, 1) - 0.05).abs() < 1e-15);
        assert!((sidak(0.05, 10) - 0.005_116_196_9).abs() < 1e-9);
        assert!((sidak(1e-12, 1000) / 1e-15 - 1.0).abs() < 1e-9);
    }

    /// p = 0.02 is a failure alone at 0.05 and none among ten.
    #[test]
    fn one_small_p_value_among_many_is_no_alarm() {
        let mut family = Family::new("ten", 0.05);
        family.check("low", 0.02);
        assert!(family.failures().is_some());
        (0..9).for_each(|_| family.check("fine", 0.5));
        assert!(family.failures().is_none());
        family.finish();
    }

    #[test]
    #[should_panic(expected = "warps: 2 of 3 tests failed at p < 3.3e-3\n  cone  p = 1.0e-9    p = 1.00e-9")]
    fn the_table_names_what_failed() {
        let mut family = Family::new("warps", 0.01);
        family.check("disk", 0.4);
        family.check("cone", 1e-9);
        family.check("nan", f64::NAN);
        family.finish();
    }

    #[test]
    #[should_panic(expected = "finish() was not called")]
    fn a_family_that_nobody_reads_panics() {
        Family::new("forgotten", 0.01).check("a", 1.0);
    }
}
