//! Error against CPU time, both logarithmic: unbiased estimators fall with slope −1/2, and what tells them apart is how far
//! to the left their line is.

use std::path::Path;

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

use super::Chapter;
use crate::{canvas::Canvas, legend};

const SIZE: (u32, u32) = (1100, 480);

/// Okabe–Ito 2008: told apart by every eye.
const COLORS: [RGBColor; 4] =
    [RGBColor(213, 94, 0), RGBColor(230, 159, 0), RGBColor(0, 158, 115), RGBColor(0, 114, 178)];

/// Writes the plot as SVG and as PNG.
pub(crate) fn write(stem: &Path, chapters: &[Chapter]) -> anyhow::Result<()> {
    let mut svg = String::new();
    draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area(), chapters)?;
    save::replace(&stem.with_extension("svg"), svg.as_bytes())?;

    let mut page = Canvas::new(SIZE.0, SIZE.1, [255; 3]);
    draw(&(&mut page).into_drawing_area(), chapters)?;
    Ok(png::write_rgb8(&stem.with_extension("png"), [page.width, page.height], &page.pixels, &[])?)
}

fn draw<B: DrawingBackend>(page: &DrawingArea<B, Shift>, chapters: &[Chapter]) -> anyhow::Result<()> {
    // The error types of backends borrow from them; what they say is all that is wanted.
    let told = |e: plotters::drawing::DrawingAreaErrorKind<B::ErrorType>| anyhow!("cannot draw the plot: {e}");
    page.fill(&WHITE).map_err(told)?;
    for (panel, chapter) in page.split_evenly((1, chapters.len())).iter().zip(chapters) {
        draw_chapter(panel, chapter).map_err(told)?;
    }
    page.present().map_err(told)
}

/// Time [s] and relative error of each pass, without those that the reference's noise hides.
fn points(chapter: &Chapter, version: usize) -> Vec<(f64, f64)> {
    let course = &chapter.versions[version].equal_time.course;
    let visible = course.iter().filter(|(seconds, mse)| *seconds > 0.0 && *mse > 0.0);
    visible.map(|(seconds, mse)| (*seconds, 100.0 * mse.sqrt() / chapter.reference.mean)).collect()
}

fn draw_chapter<B: DrawingBackend>(
    panel: &DrawingArea<B, Shift>,
    chapter: &Chapter,
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let series: Vec<Vec<(f64, f64)>> = (0..chapter.versions.len()).map(|i| points(chapter, i)).collect();
    let range = |axis: fn(&(f64, f64)) -> f64| {
        let values = series.iter().flatten().map(axis);
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        if low < high { low * 0.8..high * 1.25 } else { 0.1..10.0 }
    };
    let mut chart = ChartBuilder::on(panel)
        .caption(format!("{}: error against time", chapter.name), ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("CPU time [s]")
        .x_label_formatter(&|value| short(*value))
        .y_label_formatter(&|value| short(*value))
        .x_labels(4)
        .y_labels(8)
        .y_desc("error [% of the mean]")
        .label_style(("sans-serif", 15))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for ((points, version), color) in series.iter().zip(&chapter.versions).zip(COLORS) {
        chart
            .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
            .label(version.label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points.iter().map(|&at| Circle::new(at, 3, color.filled())))?;
    }
    legend::draw(&mut chart)
}

/// Labels of the axes: `100`, `0.1`.
fn short(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}
