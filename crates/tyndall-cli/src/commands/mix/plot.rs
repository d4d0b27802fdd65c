//! Coefficients by wavelength on a logarithmic scale, the mean cosine beside them.

use std::{ops::Range, path::Path};

use anyhow::anyhow;
use plotters::{
    coord::Shift,
    prelude::{
        ChartBuilder, DrawingArea, DrawingBackend, IntoDrawingArea, IntoLogRange, LineSeries, PathElement, RGBColor,
        SVGBackend,
    },
    style::{BLACK, Color, WHITE},
};
use tyndall_formats::film::{png, save};

use super::Row;
use crate::{canvas::Canvas, legend};

const SIZE: (u32, u32) = (1100, 480);
/// Okabe–Ito 2008: told apart by every eye.
const COLORS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(0, 158, 115), RGBColor(213, 94, 0)];

/// Writes the plot as SVG or PNG, by its ending.
pub(crate) fn write(path: &Path, title: &str, rows: &[Row]) -> anyhow::Result<()> {
    if path.extension().is_some_and(|ending| ending == "svg") {
        let mut svg = String::new();
        draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area(), title, rows)?;
        return Ok(save::replace(path, svg.as_bytes())?);
    }
    let mut page = Canvas::new(SIZE.0, SIZE.1, [255; 3]);
    draw(&(&mut page).into_drawing_area(), title, rows)?;
    Ok(png::write_rgb8(path, [page.width, page.height], &page.pixels, &[])?)
}

fn draw<B: DrawingBackend>(page: &DrawingArea<B, Shift>, title: &str, rows: &[Row]) -> anyhow::Result<()> {
    // The error types of backends borrow from them; what they say is all that is wanted.
    let told = |e: plotters::drawing::DrawingAreaErrorKind<B::ErrorType>| anyhow!("cannot draw the plot: {e}");
    page.fill(&WHITE).map_err(told)?;
    let (left, right) = page.split_horizontally(SIZE.0 * 6 / 10);
    coefficients(&left, title, rows).map_err(told)?;
    mean_cosine(&right, rows).map_err(told)?;
    page.present().map_err(told)
}

fn points(rows: &[Row], of: impl Fn(&Row) -> f64) -> Vec<(f64, f64)> {
    rows.iter().filter_map(|row| Some((row.nanometres?, of(row)))).collect()
}

fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low <= high { low..high } else { 0.1..1.0 }
}

fn coefficients<B: DrawingBackend>(
    panel: &DrawingArea<B, Shift>,
    title: &str,
    rows: &[Row],
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let series = [
        ("scattering", points(rows, |row| row.sigma_s)),
        ("reduced scattering", points(rows, |row| row.sigma_s_reduced)),
        ("absorption", points(rows, |row| row.sigma_a)),
    ];
    let positive = series.iter().flat_map(|(_, points)| points).map(|p| p.1).filter(|v| *v > 0.0);
    let Range { start, end } = span(positive);
    let mut chart = ChartBuilder::on(panel)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(90)
        .build_cartesian_2d(360.0..830.0, (0.7 * start..3.0 * end).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("wavelength [nm]")
        .y_desc("coefficient [1/mm]")
        .y_label_formatter(&|value| format!("{value:e}"))
        .x_label_formatter(&|value| format!("{value:.0}"))
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for ((name, points), color) in series.into_iter().zip(COLORS) {
        let line = points.into_iter().filter(|p| p.1 > 0.0);
        chart
            .draw_series(LineSeries::new(line, color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
    }
    legend::draw(&mut chart)
}

fn mean_cosine<B: DrawingBackend>(
    panel: &DrawingArea<B, Shift>,
    rows: &[Row],
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let mut chart = ChartBuilder::on(panel)
        .caption("mean cosine g", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(50)
        .build_cartesian_2d(360.0..830.0, 0.0..1.0)?;
    chart
        .configure_mesh()
        .x_desc("wavelength [nm]")
        .x_label_formatter(&|value| format!("{value:.0}"))
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    chart.draw_series(LineSeries::new(points(rows, |row| row.g), COLORS[0].stroke_width(2)))?;
    Ok(())
}
