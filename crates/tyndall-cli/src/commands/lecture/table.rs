//! The numbers: variance, cost and efficiency of every estimator.

use std::fmt::Write;

use serde::Serialize;

use super::Chapter;

/// One estimator on one scene.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    scene: &'static str,
    estimator: &'static str,
    /// Samples a pixel at equal samples.
    spp: f64,
    /// Variance of a sample, mean over pixels and channels.
    variance: f64,
    /// CPU time of a sample [µs].
    microseconds_per_sample: f64,
    /// 1/(variance · cost) [1/µs].
    efficiency: f64,
    /// Efficiency over that of version 0.
    gain_over_version_0: f64,
    /// Efficiency over that of the version before.
    gain_of_this_step: f64,
    /// √MSE over the mean of the image, at equal samples.
    relative_error_equal_samples: f64,
    /// √MSE over the mean of the image, at equal time.
    relative_error_equal_time: f64,
    /// Samples a pixel at equal time.
    spp_equal_time: f64,
}

/// All rows, scene by scene.
pub(crate) fn rows(chapters: &[Chapter]) -> Vec<Row> {
    chapters.iter().flat_map(rows_of).collect()
}

fn rows_of(chapter: &Chapter) -> impl Iterator<Item = Row> {
    let efficiencies: Vec<f64> = chapter.versions.iter().map(|v| v.equal_samples.efficiency()).collect();
    // A measured MSE may fall below the reference's noise: then there is no error to tell.
    let relative = |mse: f64| mse.max(0.0).sqrt() / chapter.reference.mean;
    chapter.versions.iter().enumerate().map(move |(i, version)| Row {
        scene: chapter.name,
        estimator: version.label,
        spp: version.equal_samples.spp,
        variance: version.equal_samples.variance(),
        microseconds_per_sample: version.equal_samples.cost(),
        efficiency: efficiencies[i],
        gain_over_version_0: efficiencies[i] / efficiencies[0],
        gain_of_this_step: efficiencies[i] / efficiencies[i.saturating_sub(1)],
        relative_error_equal_samples: relative(version.equal_samples.mse),
        relative_error_equal_time: relative(version.equal_time.mse),
        spp_equal_time: version.equal_time.spp,
    })
}

const HEADS: [&str; 8] = [
    "estimator",
    "variance",
    "µs/sample",
    "efficiency",
    "gain of the step",
    "gain in all",
    "error, same spp",
    "error, same time",
];

fn cells(row: &Row) -> [String; 8] {
    [
        format!("{} {}", row.scene, row.estimator),
        format!("{:.3e}", row.variance),
        format!("{:.3}", row.microseconds_per_sample),
        format!("{:.3e}", row.efficiency),
        format!("{:.2}×", row.gain_of_this_step),
        format!("{:.2}×", row.gain_over_version_0),
        format!("{:.2} %", 100.0 * row.relative_error_equal_samples),
        format!("{:.2} % ({:.0} spp)", 100.0 * row.relative_error_equal_time, row.spp_equal_time),
    ]
}

/// Aligned columns.
pub(crate) fn terminal(chapters: &[Chapter]) -> String {
    let mut lines = vec![HEADS.map(str::to_owned)];
    lines.extend(rows(chapters).iter().map(cells));
    let width = |c: usize| lines.iter().map(|line| line[c].chars().count()).max().unwrap_or(0);
    let widths: [usize; 8] = std::array::from_fn(width);
    let mut out = String::new();
    for line in &lines {
        for (c, cell) in line.iter().enumerate() {
            // The first column reads from the left, numbers from the right. Writing to a string cannot fail.
            let w = widths[c];
            let _ = if c == 0 { write!(out, "{cell:<w$}") } else { write!(out, "   {cell:>w$}") };
        }
        out.push('\n');
    }
    out.trim_end().to_owned()
}

/// A Markdown table with a word on what its columns mean.
pub(crate) fn markdown(chapters: &[Chapter]) -> String {
    let mut out = format!("| {} |\n|---{}|\n", HEADS.join(" | "), "|--:".repeat(HEADS.len() - 1));
    for row in rows(chapters) {
        let _ = writeln!(out, "| {} |", cells(&row).join(" | "));
    }
    out.push_str(
        "\nVariance of one sample (mean over pixels and channels, against a reference by `volpath`); CPU time \
         of one sample; efficiency = 1/(variance · cost) [1/µs]; errors are √MSE over the mean of the image.\n",
    );
    out
}
