//! The error of separated direct light against the size of the pattern, both logarithmic.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use plotters::{
    coord::Shift,
    prelude::{
        ChartBuilder, Circle, DrawingArea, DrawingBackend, IntoDrawingArea, IntoLogRange, LineSeries, PathElement,
        RGBColor, SVGBackend,
    },
    style::{BLACK, Color, WHITE},
};
use tyndall_formats::film::{png, save};

use super::figures::Figures;
use crate::{
    canvas::Canvas,
    legend,
    outputs::{Outputs, is_png},
};

const SIZE: (u32, u32) = (640, 420);
/// Okabe–Ito 2008.
const COLORS: [RGBColor; 2] = [RGBColor(213, 94, 0), RGBColor(0, 114, 178)];

/// Beside each of the outputs, a plot: SVG for the EXR, PNG for the PNG.
pub(super) fn files(outputs: &Outputs) -> Vec<PathBuf> {
    let beside = |file: &PathBuf| {
        let mut name = file.file_stem().unwrap_or_default().to_os_string();
        name.push(if is_png(file) { "-sweep.png" } else { "-sweep.svg" });
        file.with_file_name(name)
    };
    outputs.files.iter().map(beside).collect()
}

/// Draws and writes one.
pub(super) fn write(file: &Path, figures: &[Figures]) -> anyhow::Result<()> {
    if is_png(file) {
        let mut page = Canvas::new(SIZE.0, SIZE.1, [255; 3]);
        draw(&(&mut page).into_drawing_area(), figures)?;
        return Ok(png::write_rgb8(file, [page.width, page.height], &page.pixels, &[])?);
    }
    let mut svg = String::new();
    draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area(), figures)?;
    Ok(save::replace(file, svg.as_bytes())?)
}

fn draw<B: DrawingBackend>(page: &DrawingArea<B, Shift>, figures: &[Figures]) -> anyhow::Result<()> {
    // The error types of backends borrow from them; what they say is all that is wanted.
    let told = |e: plotters::drawing::DrawingAreaErrorKind<B::ErrorType>| anyhow!("cannot draw the plot: {e}");
    page.fill(&WHITE).map_err(told)?;
    chart(page, figures).map_err(told)?;
    page.present().map_err(told)
}

fn chart<B: DrawingBackend>(
    page: &DrawingArea<B, Shift>,
    figures: &[Figures],
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let points = |of: fn(&Figures) -> f64| -> Vec<(f64, f64)> {
        figures.iter().map(|f| (f.size, 100.0 * of(f))).filter(|(_, percent)| *percent > 0.0).collect()
    };
    let series = [("separated less true", points(|f| f.rms)), ("noise", points(|f| f.noise))];
    let range = |axis: fn(&(f64, f64)) -> f64| {
        let values = series.iter().flat_map(|(_, points)| points).map(axis);
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        if low < high { low * 0.8..high * 1.25 } else { 0.1..10.0 }
    };
    let mut chart = ChartBuilder::on(page)
        .caption("direct light by patterns", ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())?;
    let short = |value: &f64| format!("{}", (value * 1e6).round() / 1e6);
    chart
        .configure_mesh()
        .x_desc("side of a square [pixels of the projector]")
        .y_desc("rms [% of the mean of all light]")
        .x_label_formatter(&short)
        .y_label_formatter(&short)
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for ((label, points), color) in series.into_iter().zip(COLORS) {
        chart
            .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
            .label(label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points.into_iter().map(|at| Circle::new(at, 3, color.filled())))?;
    }
    legend::draw(&mut chart)
}
