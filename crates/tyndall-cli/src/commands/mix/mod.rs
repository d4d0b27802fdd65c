//! `tyndall mix RECIPE`: coefficients by wavelength of what is made of particles, as a table, JSON, a plot, and a medium.

mod medium;
pub(crate) mod options;
mod plot;

use std::{fmt::Write, process::ExitCode};

use anyhow::anyhow;
use serde::Serialize;
use tyndall::spectrum::{Role, Sampled};
use tyndall_optics::{
    medium::wavelengths,
    mixture::{Bulk, Mixture},
};

use super::lab::report::check_plot;
use crate::outputs::{say, write_text};
use options::MixOptions;

/// What is told of a mixture.
#[derive(Debug, Serialize)]
struct Told {
    recipe: &'static str,
    source: &'static str,
    parameters: Vec<(&'static str, f64)>,
    unit: &'static str,
    by_wavelength: Vec<Row>,
    /// What linear sRGB under D65 makes of the spectra.
    rgb: [Row; 3],
    /// Cosines of the phase functions.
    cosines: Vec<f64>,
}

/// Coefficients [1/mm] at a wavelength or of a channel.
#[derive(Debug, Serialize)]
struct Row {
    #[serde(skip_serializing_if = "Option::is_none")]
    nanometres: Option<f64>,
    sigma_a: f64,
    sigma_s: f64,
    g: f64,
    sigma_s_reduced: f64,
    /// [1/sr] at the cosines.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    phase: Vec<f64>,
}

impl Row {
    fn new(nanometres: Option<f64>, sigma_a: f64, sigma_s: f64, g: f64) -> Self {
        Self { nanometres, sigma_a, sigma_s, g, sigma_s_reduced: sigma_s * (1.0 - g), phase: Vec::new() }
    }
}

/// Mixes, and tells what came of it.
pub(crate) fn run(options: &MixOptions) -> anyhow::Result<ExitCode> {
    let output = &options.output;
    output.plot.as_deref().map_or(Ok(()), check_plot)?;
    output.medium.as_deref().map_or(Ok(()), medium::check)?;
    let mixture = options.recipe.mix(&options.values).map_err(|told| anyhow!(told))?;
    let mut told = told(options, &mixture)?;
    if let Some(path) = &output.plot {
        plot::write(path, options.recipe.about, &told.by_wavelength)?;
    }
    if let Some(path) = &output.medium {
        medium::write(path, options, &mixture)?;
    }
    if let Some(path) = &output.json {
        add_phase(&mut told, &mixture);
        write_text(path, &serde_json::to_string_pretty(&told)?)?;
        if path.as_os_str() == "-" {
            return Ok(ExitCode::SUCCESS);
        }
    }
    say(told.table(options.recipe.about).trim_end_matches('\n'))?;
    Ok(ExitCode::SUCCESS)
}

fn told(options: &MixOptions, mixture: &Mixture) -> anyhow::Result<Told> {
    let bulks: Vec<(f64, Bulk)> = wavelengths().map(|l| (l, mixture.at(l))).collect();
    let channels = |of: &dyn Fn(&Bulk) -> f64| -> anyhow::Result<[f64; 3]> {
        let (lambda, values): (Vec<_>, Vec<_>) =
            bulks.iter().map(|(l, bulk)| ((l * 1e9) as f32, of(bulk) as f32)).unzip();
        Ok(Sampled::new(&lambda, &values, Role::Reflectance)?.rgb.map(f64::from))
    };
    let sigma_a = channels(&|bulk| bulk.sigma_a * 1e-3)?;
    let sigma_s = channels(&|bulk| bulk.sigma_s * 1e-3)?;
    let reduced = channels(&|bulk| bulk.sigma_s * (1.0 - bulk.g) * 1e-3)?;
    let g = |c: usize| if sigma_s[c] > 0.0 { 1.0 - reduced[c] / sigma_s[c] } else { 0.0 };
    Ok(Told {
        recipe: options.recipe.name,
        source: options.recipe.source,
        parameters: options.recipe.parameters.iter().map(|p| p.name).zip(options.values.iter().copied()).collect(),
        unit: "1/mm",
        by_wavelength: bulks
            .iter()
            .map(|(l, b)| Row::new(Some((l * 1e9).round()), b.sigma_a * 1e-3, b.sigma_s * 1e-3, b.g))
            .collect(),
        rgb: [0, 1, 2].map(|c| Row::new(None, sigma_a[c], sigma_s[c], g(c))),
        cosines: Vec::new(),
    })
}

/// Phase functions at every degree.
fn add_phase(told: &mut Told, mixture: &Mixture) {
    told.cosines = (0..=180).map(|degree| f64::from(degree).to_radians().cos()).collect();
    for (row, wavelength) in told.by_wavelength.iter_mut().zip(wavelengths()) {
        let bulk = mixture.at(wavelength);
        row.phase = told.cosines.iter().map(|cosine| bulk.phase(*cosine)).collect();
    }
}

impl Told {
    fn table(&self, about: &str) -> String {
        let numbers: Vec<_> = self.parameters.iter().map(|(name, value)| format!("{name} {}", short(*value))).collect();
        let mut out = format!("{about}\n{}\n{}\n\n", numbers.join(", "), self.source);
        let _ = writeln!(out, "{:>8} {:>12} {:>12} {:>9} {:>12}", "nm", "σ_a [1/mm]", "σ_s [1/mm]", "g", "σ_s′ [1/mm]");
        let names = self.by_wavelength.iter().map(|row| row.nanometres.unwrap_or_default().to_string());
        let names = names.chain(["red", "green", "blue"].map(String::from));
        for (name, row) in names.zip(self.by_wavelength.iter().chain(&self.rgb)) {
            let [a, s, reduced] = [row.sigma_a, row.sigma_s, row.sigma_s_reduced].map(|v| format!("{v:.5e}"));
            let _ = writeln!(out, "{name:>8} {a:>12} {s:>12} {:>9.5} {reduced:>12}", row.g);
        }
        out
    }
}

/// A number with six digits.
fn short(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().map_or_else(|_| value.to_string(), |v| v.to_string())
}
