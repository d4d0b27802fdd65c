//! `MSE · N` against N, both logarithmic: a level line is a finite variance, a climbing one is none.

use std::ops::Range;
use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, PathElement};
use plotters::prelude::{DrawingBackend, IntoLogRange, LineSeries, RGBColor, SVGBackend, SeriesLabelPosition};
use plotters::style::{BLACK, Color, WHITE};

use super::{Course, Level, Panel};

const SIZE: (u32, u32) = (1100, 480);

/// Okabe–Ito 2008: told apart by every eye.
const COLORS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115)];

/// Writes the plot.
pub(super) fn write(path: &Path, panels: &[Panel]) -> Result<()> {
    let mut svg = String::new();
    draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area(), panels)
        .map_err(|error| anyhow!("cannot draw the plot: {error}"))?;
    Ok(std::fs::write(path, svg)?)
}

fn draw<B: DrawingBackend>(
    page: &DrawingArea<B, Shift>,
    panels: &[Panel],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    page.fill(&WHITE)?;
    for (area, panel) in page.split_evenly((1, panels.len())).iter().zip(panels) {
        draw_panel(area, panel)?;
    }
    page.present()
}

fn draw_panel<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    panel: &Panel,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let levels = || panel.courses.iter().flat_map(|course| &course.levels);
    let samples = around(levels().map(|level| f64::from(level.spp)));
    let errors = around(levels().map(|level| level.mse_n.0));
    let mut chart = ChartBuilder::on(area)
        .caption(panel.cube.title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(samples.log_scale(), (errors.start..4.0 * errors.end).log_scale())?; // room for the legend
    chart
        .configure_mesh()
        .x_desc("samples a pixel, N")
        .y_desc("MSE · N")
        .x_label_formatter(&|value| value.to_string())
        .y_label_formatter(&|value| value.to_string())
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for (course, color) in panel.courses.iter().zip(COLORS) {
        let points = course.levels.iter().map(|level| (f64::from(level.spp), level.mse_n.0));
        chart
            .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
            .label(course.side.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points.map(|at| Circle::new(at, 3, color.filled())))?;
        chart.draw_series(bars(course, errors.start).map(|bar| PathElement::new(bar, color.stroke_width(1))))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 15))
        .draw()
}

/// One standard error up and down; no further down than the axis goes.
fn bars(course: &Course, floor: f64) -> impl Iterator<Item = [(f64, f64); 2]> {
    course.levels.iter().map(move |&Level { spp, mse_n: (middle, error), .. }| {
        [(f64::from(spp), (middle - error).max(floor)), (f64::from(spp), middle + error)]
    })
}

/// The range of positive values with a margin on both sides.
fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values
        .filter(|value| *value > 0.0)
        .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { low / 1.5..high * 1.5 } else { 0.1..10.0 }
}
