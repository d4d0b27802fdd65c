//! What an instrument has measured, as a table, as JSON, as CSV and as a plot.

use std::{fmt::Write, path::Path};

use anyhow::{anyhow, bail};
use plotters::{
    coord::Shift,
    prelude::{
        ChartBuilder, DrawingArea, DrawingBackend, IntoDrawingArea, IntoLogRange, PathElement, RGBColor, SVGBackend,
    },
    style::{BLACK, Color, WHITE},
};
use serde::Serialize;
use tyndall_formats::film::{png, save};
use tyndall_lab::run::Estimate;

use super::polar::Polar;
use crate::{canvas::Canvas, legend};

/// All figures of an experiment.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    /// What was done.
    pub(crate) title: String,
    /// Photons.
    pub(crate) photons: u64,
    /// Single figures.
    pub(crate) figures: Vec<Figure>,
    /// Figures by bins.
    pub(crate) curves: Vec<Curve>,
    /// What follows from them, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) verdict: Option<String>,
    /// What the plot is of, instead of the curves.
    #[serde(skip)]
    pub(crate) polar: Option<Polar>,
}

/// A figure with its name and unit.
#[derive(Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    #[serde(flatten)]
    pub(crate) estimate: Estimate,
    /// What it is by theory, where theory is exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) exact: Option<f64>,
}

/// A quantity by bins of another.
#[derive(Debug, Serialize)]
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    /// What the bins are of.
    pub(crate) of: &'static str,
    pub(crate) of_unit: &'static str,
    pub(crate) bins: Vec<Bin>,
    /// What theories say of it: they are told and drawn beside it, in a panel of its own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) models: Vec<Model>,
}

/// What a theory says of a curve, bin by bin.
#[derive(Debug, Serialize)]
pub(crate) struct Model {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<f64>,
}

/// A bin, from `start` to `end`.
#[derive(Debug, Serialize)]
pub(crate) struct Bin {
    pub(crate) start: f64,
    pub(crate) end: f64,
    #[serde(flatten)]
    pub(crate) estimate: Estimate,
}

/// A chance in words.
pub(super) fn chance(p: f64) -> String {
    match p {
        p if p >= 0.01 => format!("p = {p:.2}"),
        p if p >= 1e-99 => format!("p = {p:.0e}"),
        _ => "p < 1e-99".into(),
    }
}

impl Report {
    /// The single figures, and how many others there are.
    pub(crate) fn table(&self) -> String {
        let mut out = format!("{}\n{} photons\n\n", self.title, self.photons);
        for Figure { name, unit, estimate: Estimate { mean, standard_error }, exact } in &self.figures {
            let beside = exact.map(|exact| format!("exact {exact:.6}   z {:+.2}", (mean - exact) / standard_error));
            let line = format!("{name:<28} {mean:>12.6} ± {standard_error:.6} {unit} {}", beside.unwrap_or_default());
            // Writing to a string cannot fail.
            let _ = writeln!(out, "{}", line.trim_end());
        }
        for curve in &self.curves {
            if curve.models.is_empty() {
                let _ = writeln!(out, "{:<28} {:>12} bins of {}", curve.name, curve.bins.len(), curve.of);
            } else {
                out += &curve.table();
            }
        }
        if let Some(verdict) = &self.verdict {
            let _ = writeln!(out, "\n{verdict}");
        }
        out
    }

    /// A line a figure: its name, its bin, mean and standard error, unit.
    pub(crate) fn csv(&self) -> String {
        let mut out = String::from("quantity,start,end,mean,standard_error,unit\n");
        for Figure { name, unit, estimate, exact } in &self.figures {
            let _ = writeln!(out, "{name},,,{},{},{unit}", estimate.mean, estimate.standard_error);
            if let Some(exact) = exact {
                let _ = writeln!(out, "{name} (exact),,,{exact},0,{unit}");
            }
        }
        for curve in &self.curves {
            for Bin { start, end, estimate } in &curve.bins {
                let (mean, error) = (estimate.mean, estimate.standard_error);
                let _ = writeln!(out, "{},{start},{end},{mean},{error},{}", curve.name, curve.unit);
            }
            for Model { name, values } in &curve.models {
                for (Bin { start, end, .. }, value) in curve.bins.iter().zip(values) {
                    let _ = writeln!(out, "{} ({name}),{start},{end},{value},0,{}", curve.name, curve.unit);
                }
            }
        }
        out
    }

    /// Draws all curves, a panel for each thing that they are binned by.
    pub(crate) fn plot(&self, path: &Path) -> anyhow::Result<()> {
        let mut panels: Vec<(&str, Vec<&Curve>)> = Vec::new();
        for curve in self.curves.iter().filter(|curve| curve.bins.iter().any(|bin| bin.estimate.mean > 0.0)) {
            match panels.iter_mut().find(|(of, curves)| *of == curve.of && curves[0].models.is_empty()) {
                Some((_, curves)) => curves.push(curve),
                None => panels.push((curve.of, vec![curve])),
            }
        }
        if panels.is_empty() && self.polar.is_none() {
            bail!("there is no curve to draw: ask for bins, such as --radii 50,0.01");
        }
        let size = if self.polar.is_some() { (640, 640) } else { (640 * panels.len() as u32, 480) };
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg") => {
                let mut svg = String::new();
                self.draw(&SVGBackend::with_string(&mut svg, size).into_drawing_area(), &panels)?;
                Ok(save::replace(path, svg.as_bytes())?)
            }
            Some("png") => {
                let mut page = Canvas::new(size.0, size.1, [255; 3]);
                self.draw(&(&mut page).into_drawing_area(), &panels)?;
                Ok(png::write_rgb8(path, [page.width, page.height], &page.pixels, &[])?)
            }
            _ => bail!("{}: plots are written as .svg or .png", path.display()),
        }
    }
}

/// Whether a name is one that plots can have.
pub(crate) fn check_plot(path: &Path) -> anyhow::Result<()> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg" | "png") => Ok(()),
        _ => bail!("{}: plots are written as .svg or .png", path.display()),
    }
}

impl Report {
    fn draw<B: DrawingBackend>(
        &self,
        page: &DrawingArea<B, Shift>,
        panels: &[(&str, Vec<&Curve>)],
    ) -> anyhow::Result<()> {
        // The error types of backends borrow from them; what they say is all that is wanted.
        let told = |e: plotters::drawing::DrawingAreaErrorKind<B::ErrorType>| anyhow!("cannot draw the plot: {e}");
        page.fill(&WHITE).map_err(told)?;
        if let Some(polar) = &self.polar {
            polar.draw(page).map_err(told)?;
        } else {
            for (area, (of, curves)) in page.split_evenly((1, panels.len())).iter().zip(panels) {
                draw_panel(area, of, curves).map_err(told)?;
            }
        }
        page.present().map_err(told)
    }
}

impl Curve {
    /// All bins, with what the theories say of them.
    fn table(&self) -> String {
        let brackets = |unit: &str| if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let (unit, of_unit) = (brackets(self.unit), brackets(self.of_unit));
        let mut out = format!("\n{}{unit}, by {}{of_unit}\n{:>25}", self.name, self.of, "");
        let _ = write!(out, " {:>26}", "measured");
        for model in &self.models {
            let _ = write!(out, " {:>22}", model.name);
        }
        out.push('\n');
        for (i, Bin { start, end, estimate }) in self.bins.iter().enumerate() {
            let _ = write!(
                out,
                "{start:>11.4} – {end:<11.4} {:>12.4e} ± {:<11.2e}",
                estimate.mean, estimate.standard_error
            );
            for model in &self.models {
                let _ = write!(out, " {:>22.4e}", model.values[i]);
            }
            out.push('\n');
        }
        out
    }
}

/// Okabe–Ito 2008: told apart by every eye.
pub(super) const COLORS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// Means with bars of one standard error, on a logarithmic scale.
fn draw_panel<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    of: &str,
    curves: &[&Curve],
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let bins = || curves.iter().flat_map(|curve| &curve.bins);
    let start = bins().map(|bin| bin.start).fold(0.0, f64::min);
    let end = bins().map(|bin| bin.end).fold(0.0, f64::max);
    let positive = || bins().map(|bin| bin.estimate.mean).filter(|mean| *mean > 0.0);
    let (low, high) = positive().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    let low = low.max(high * 1e-9);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(80)
        .build_cartesian_2d(start..end, (0.7 * low..3.0 * high).log_scale())?;
    let (first, x_unit) = (curves[0], curves[0].of_unit);
    let brackets = |unit: &str| if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    chart
        .configure_mesh()
        .x_desc(format!("{of}{}", brackets(x_unit)))
        .y_desc(first.unit)
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for (curve, color) in curves.iter().zip(COLORS.into_iter().cycle()) {
        let steps = curve.bins.iter().filter(|bin| bin.estimate.mean >= low);
        let step = |bin: &Bin| {
            PathElement::new([(bin.start, bin.estimate.mean), (bin.end, bin.estimate.mean)], color.stroke_width(2))
        };
        chart
            .draw_series(steps.clone().map(step))?
            .label(&*curve.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        let bar = |bin: &Bin| {
            let (x, Estimate { mean, standard_error }) = (f64::midpoint(bin.start, bin.end), bin.estimate);
            let ends = [(x, (mean - standard_error).max(low)), (x, mean + standard_error)];
            PathElement::new(ends, color.stroke_width(1))
        };
        chart.draw_series(steps.map(bar))?;
        for (model, color) in curve.models.iter().zip(COLORS.into_iter().skip(1).cycle()) {
            let middles = curve.bins.iter().zip(&model.values).filter(|(_, value)| **value >= low);
            let line = middles.map(|(bin, value)| (f64::midpoint(bin.start, bin.end), *value));
            chart
                .draw_series([PathElement::new(line.collect::<Vec<_>>(), color.stroke_width(1))])?
                .label(model.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(1)));
        }
    }
    legend::draw(&mut chart)
}
