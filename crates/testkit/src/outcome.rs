//! What a test says: a p-value and a sentence.

/// The result of one statistical test.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Probability of a deviation at least this large if nothing is wrong, in [0, 1].
    pub p: f64,
    /// What was measured and what was expected.
    pub detail: String,
}

impl From<f64> for Outcome {
    fn from(p: f64) -> Self {
        Self { p, detail: format!("p = {p:.2e}") }
    }
}

/// A comparison without chance, as of an integral: `p` is 1 when `value` is within `tolerance` (absolute) of `expected`,
/// and 0 otherwise, also for NaN.
pub fn close(value: f64, expected: f64, tolerance: f64) -> Outcome {
    let p = if (value - expected).abs() <= tolerance { 1.0 } else { 0.0 };
    Outcome { p, detail: format!("value {value:.8}, expected {expected} within {tolerance:.0e}") }
}
