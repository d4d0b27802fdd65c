//! What is told of a comparison: rows for JSON, tables in Markdown.

use std::fmt::Write as _;

use serde::Serialize;

use super::runs::Side;
use super::statistics::Agreement;

/// tyndall against Mitsuba.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct DuelRow {
    /// Name of the scene
    pub(crate) scene: String,
    /// Mitsuba's backend and parameters
    pub(crate) setting: String,
    /// tyndall's picture against Mitsuba's
    pub(crate) agreement: Agreement,
    /// Ours
    pub(crate) tyndall: Side,
    /// Theirs
    pub(crate) mitsuba: Side,
    /// tyndall's efficiency over Mitsuba's, median over turns
    pub(crate) efficiency_ratio: f64,
}

impl DuelRow {
    /// Whether the pictures differ by more than noise explains.
    pub(crate) fn disagrees(&self, level: f64) -> bool {
        self.agreement.tests > 0 && self.agreement.p() < level
    }

    /// One line for those who wait for the next scene.
    pub(crate) fn told(&self) -> String {
        let Self { scene, agreement, efficiency_ratio, tyndall, mitsuba, .. } = self;
        let cpu_seconds = |side: &Side| figure(super::statistics::median(&side.cpu_seconds));
        format!(
            "{scene}: p {:.1e}, means {}; {} and {} CPU s a run, efficiency {} times Mitsuba's",
            agreement.p(),
            ratios(&agreement.ratio),
            cpu_seconds(tyndall),
            cpu_seconds(mitsuba),
            figure(*efficiency_ratio)
        )
    }

    fn verdict(&self, level: f64) -> &'static str {
        match () {
            () if self.agreement.tests == 0 => "both black: nothing compared",
            () if self.disagrees(level) => "**DISAGREE**",
            () => "agree",
        }
    }
}

/// A pbrt scene in two kinds of colour.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ColourRow {
    /// Name of the scene
    pub(crate) scene: String,
    /// RGB's luminance against spectral colour's
    pub(crate) agreement: Agreement,
    /// In RGB
    pub(crate) rgb: Side,
    /// With hero wavelengths
    pub(crate) spectral: Side,
}

impl ColourRow {
    /// One line for those who wait for the next scene.
    pub(crate) fn told(&self) -> String {
        let (ratio, error) = self.agreement.ratio[0];
        format!("{}: RGB has {ratio:.4} ± {error:.4} of the luminance of spectral colour", self.scene)
    }
}

/// Both tables.
pub(crate) fn tables(duels: &[DuelRow], colours: &[ColourRow], level: f64) -> String {
    let mut text = String::new();
    if !duels.is_empty() {
        text += &duel_table(duels, level);
    }
    if !colours.is_empty() {
        text += &colour_table(colours);
    }
    text
}

fn duel_table(rows: &[DuelRow], level: f64) -> String {
    let mut text = format!(
        "\ntyndall against Mitsuba 3. Pictures disagree if p < {level:.1e}; efficiency is 1/(MSE · CPU s) of one run.\n\n\
         | scene | extreme z (p) | χ² p | mean ratio r g b | p | verdict | Mitsuba | tyndall | ratio |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for row in rows {
        let _ = writeln!(
            text,
            "| {} | {:.2} ({:.2e}) | {:.2e} | {} | {:.2e} | {} | {} | {} | {} |",
            row.scene,
            row.agreement.extreme_z,
            row.agreement.extreme_p,
            row.agreement.chi_square_p,
            ratios(&row.agreement.ratio),
            row.agreement.p(),
            row.verdict(level),
            figure(row.mitsuba.efficiency),
            figure(row.tyndall.efficiency),
            figure(row.efficiency_ratio),
        );
    }
    text
}

fn colour_table(rows: &[ColourRow]) -> String {
    let mut text = "\npbrt scenes, RGB over spectral luminance (colours multiply differently by design; grey scenes agree). \
                    neff is mean²/(MSE · CPU s).\n\n\
                    | scene | luminance ratio | extreme z (p) | χ² p | neff RGB | neff spectral |\n|---|---|---|---|---|---|\n"
        .to_owned();
    for row in rows {
        let (ratio, error) = row.agreement.ratio[0];
        let _ = writeln!(
            text,
            "| {} | {ratio:.4} ± {error:.4} | {:.2} ({:.2e}) | {:.2e} | {} | {} |",
            row.scene,
            row.agreement.extreme_z,
            row.agreement.extreme_p,
            row.agreement.chi_square_p,
            figure(row.rgb.neff),
            figure(row.spectral.neff),
        );
    }
    text
}

fn ratios(channels: &[(f64, f64); 3]) -> String {
    let is_black = channels.iter().all(|(ratio, _)| ratio.is_nan());
    if is_black { "–".to_owned() } else { channels.map(|(ratio, error)| format!("{ratio:.4}±{error:.4}")).join(" ") }
}

/// Three digits, whatever the size.
pub(crate) fn figure(value: f64) -> String {
    match value.abs() {
        size if !size.is_finite() => "–".to_owned(),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        size if size >= 1.0 => format!("{value:.2}"),
        size if size >= 0.1 => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}
