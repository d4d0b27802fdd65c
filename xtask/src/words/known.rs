//! Differences from Mitsuba's pictures that have a known reason, and how large they may be.
//!
//! A line each: the scene's name, the largest difference of the means that the reason explains \[1\], and the reason; tabs
//! between them.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use super::Row;

/// How many standard errors a mean may lie beyond what the reason explains.
const NOISE: f64 = 3.0;

/// A reason, and how far it goes.
#[derive(Debug, PartialEq)]
struct Reason {
    most: f64,
    text: String,
}

/// The reasons by the names of their scenes.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Known(BTreeMap<String, Reason>);

impl Known {
    /// Reads the table.
    pub(super) fn read(table: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(table).with_context(|| format!("cannot read {}", table.display()))?;
        Self::parse(&text)
    }

    fn parse(text: &str) -> Result<Self> {
        let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let reasons = lines.map(|line| {
            let mut parts = line.splitn(3, '\t');
            let mut part = || parts.next().with_context(|| format!("`{line}` has less than three parts"));
            let (name, most, text) = (part()?.to_owned(), part()?, part()?.to_owned());
            let most = most.parse().with_context(|| format!("`{most}` is no number"))?;
            Ok((name, Reason { most, text }))
        });
        reasons.collect::<Result<_>>().map(Self)
    }

    /// Whether the differences of a row are as small as its reason explains.
    pub(super) fn explain(&self, row: &Row) -> bool {
        let Some(reason) = self.0.get(&row.name) else { return false };
        let mut means = row.comparisons().flat_map(|found| found.ratio).flatten();
        means.all(|(ratio, error)| (ratio - 1.0).abs() <= reason.most + NOISE * error)
    }

    /// The reason for the differences of a scene.
    pub(super) fn reason(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(|reason| &*reason.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collections::comparison::Comparison;

    #[test]
    fn a_reason_explains_what_is_as_small_as_it_says() {
        let known = Known::parse("# name\tmost\treason\na-b\t0.01\ttheir sums are short\n").unwrap();
        let row = |name: &str, ratio: f64| {
            let ratio = [Some((ratio, 0.001)); 3];
            let found = Comparison { p: 0.0, extreme_z: 9.0, extreme_at: (0, 0, 0), ratio };
            Row { name: name.to_owned(), languages: Vec::new(), with_mitsuba: Some(found), with_twin: None }
        };
        assert!(known.explain(&row("a-b", 0.988)), "0.01 and two standard errors");
        assert!(!known.explain(&row("a-b", 0.98)));
        assert!(!known.explain(&row("a-c", 1.0)), "no reason is known");
        assert_eq!(known.reason("a-b"), Some("their sums are short"));
        assert!(Known::parse("a-b\t0.01").is_err());
    }
}
