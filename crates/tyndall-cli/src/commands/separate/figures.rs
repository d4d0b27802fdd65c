//! What an experiment comes to, in numbers.

use std::fmt::Write;

use serde::Serialize;
use tyndall::{
    film::{Film, Pixel},
    spectrum::srgb,
};
use tyndall_lab::{
    run::Estimate,
    separate::{Outcome, Parts, Pattern, Projection},
};

/// Direct and global light by one family of patterns, beside the truth: means over all pixels, by luminance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Figures {
    /// What was thrown.
    pub(super) pattern: String,
    /// Side of a square, or half a wave [pixels of the projector].
    pub(super) size: f64,
    /// How many patterns there were.
    patterns: u32,
    /// All light.
    all: f64,
    true_direct: Estimate,
    separated_direct: Estimate,
    true_global: Estimate,
    separated_global: Estimate,
    /// Root of the mean square over pixels and channels of separated less true direct light, of the mean of all light \[1\].
    pub(super) rms: f64,
    /// At most what the standard errors of both make of that: they share random numbers \[1\].
    pub(super) noise: f64,
    /// What noise would add to direct light if the same samples chose the greatest and measured it, of the mean of all light
    /// \[1\]; of checkerboards.
    bias: Option<f64>,
}

impl Figures {
    pub(super) fn new(projection: &Projection, clear: &Film, truth: &Parts, outcome: &Outcome) -> Self {
        let (pattern, size) = match projection.pattern {
            Pattern::Checkerboard { square, step, shifts } => {
                (format!("squares of {square}, {shifts} × {shifts} shifts by {step}"), f64::from(square))
            }
            Pattern::Waves { period, phases } => {
                (format!("waves of {period}, {phases} phases"), f64::from(period) / 2.0)
            }
        };
        let parts = &outcome.parts;
        let all = mean(clear.pixels.iter().map(Pixel::mean).map(luminance));
        let squares = |pairs: &mut dyn Iterator<Item = f64>| mean(pairs).sqrt() / all;
        let differences = parts.direct.iter().flatten().zip(truth.direct.iter().flatten());
        let errors = parts.direct_error.iter().flatten().zip(truth.direct_error.iter().flatten());
        Self {
            pattern,
            size,
            patterns: projection.pattern.count(),
            all,
            true_direct: estimate(&truth.direct, &truth.direct_error),
            separated_direct: estimate(&parts.direct, &parts.direct_error),
            true_global: estimate(&truth.global, &truth.global_error),
            separated_global: estimate(&parts.global, &parts.global_error),
            rms: squares(&mut differences.map(|(a, b)| f64::from(a - b).powi(2))),
            noise: squares(&mut errors.map(|(a, b)| f64::from(*a).powi(2) + f64::from(*b).powi(2))),
            bias: outcome.bias.map(|bias| bias / all),
        }
    }
}

/// All experiments, for the terminal.
pub(super) fn table(figures: &[Figures]) -> String {
    let mut out = String::new();
    for (i, f) in figures.iter().enumerate() {
        if i == 0 {
            let _ =
                writeln!(out, "{:<38} {:>23} {:>23} {:>8} {:>8} {:>8}", "", "direct", "global", "rms", "noise", "bias");
            let _ = writeln!(out, "{:<38} {:>23} {:>23}", "truth", told(f.true_direct), told(f.true_global));
        }
        let bias = f.bias.map_or(String::new(), percent);
        let (direct, global) = (told(f.separated_direct), told(f.separated_global));
        let _ = writeln!(
            out,
            "{:<38} {direct:>23} {global:>23} {:>8} {:>8} {bias:>8}",
            f.pattern,
            percent(f.rms),
            percent(f.noise),
        );
    }
    let _ = write!(
        out,
        "\nMeans of luminance. rms: of separated less true direct light, of the mean of all light; noise: at most what standard errors make \
         of it;\nbias: what noise would add to direct light if the samples that choose the greatest also measured it."
    );
    out
}

fn told(estimate: Estimate) -> String {
    format!("{:.6} ± {:.6}", estimate.mean, estimate.standard_error)
}

fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part)
}

/// The mean over pixels; their errors are independent.
fn estimate(values: &[[f32; 3]], errors: &[[f32; 3]]) -> Estimate {
    let n = values.len().max(1) as f64;
    let squares: f64 = errors.iter().map(|e| luminance(*e).powi(2)).sum();
    Estimate { mean: mean(values.iter().map(|v| luminance(*v))), standard_error: squares.sqrt() / n }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
    sum / count.max(1) as f64
}

fn luminance(rgb: [f32; 3]) -> f64 {
    srgb::luminance(rgb).into()
}
