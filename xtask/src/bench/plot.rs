//! Curves with error bars on logarithmic axes, side by side in one SVG file.

use std::ops::Range;
use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, PathElement};
use plotters::prelude::{DrawingBackend, IntoLogRange, LineSeries, RGBColor, SVGBackend, SeriesLabelPosition};
use plotters::style::{BLACK, Color, WHITE};

const SIZE: (u32, u32) = (1100, 480);

/// Okabe–Ito 2008: told apart by every eye.
const COLORS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115)];

/// Panels, one beside the other.
pub(super) struct Plot<'a> {
    /// What the axis to the right is
    pub(super) across: &'a str,
    /// What the axis upwards is
    pub(super) up: &'a str,
    pub(super) panels: Vec<Panel<'a>>,
}

/// One pair of axes.
pub(super) struct Panel<'a> {
    pub(super) title: &'a str,
    pub(super) curves: Vec<Curve<'a>>,
}

/// One curve: x, y and the standard error of y.
pub(super) struct Curve<'a> {
    pub(super) name: &'a str,
    pub(super) points: Vec<[f64; 3]>,
}

impl Plot<'_> {
    /// Writes the plot.
    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
            .map_err(|error| anyhow!("cannot draw the plot: {error}"))?;
        Ok(std::fs::write(path, svg)?)
    }

    fn draw<B: DrawingBackend>(&self, page: &DrawingArea<B, Shift>) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        page.fill(&WHITE)?;
        for (area, panel) in page.split_evenly((1, self.panels.len())).iter().zip(&self.panels) {
            self.draw_panel(area, panel)?;
        }
        page.present()
    }

    fn draw_panel<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        panel: &Panel,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let points = || panel.curves.iter().flat_map(|curve| &curve.points);
        let (right, up) = (around(points().map(|point| point[0])), around(points().map(|point| point[1])));
        let mut chart = ChartBuilder::on(area)
            .caption(panel.title, ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(84)
            .build_cartesian_2d(right.log_scale(), (up.start..4.0 * up.end).log_scale())?; // room for the legend
        chart
            .configure_mesh()
            .x_desc(self.across)
            .y_desc(self.up)
            .x_label_formatter(&|value| value.to_string())
            .y_label_formatter(&|value| value.to_string())
            .label_style(("sans-serif", 15))
            .light_line_style(BLACK.mix(0.05))
            .bold_line_style(BLACK.mix(0.15))
            .draw()?;
        for (curve, color) in panel.curves.iter().zip(COLORS) {
            let points = curve.points.iter().map(|&[x, y, _]| (x, y));
            chart
                .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
                .label(curve.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
            chart.draw_series(points.map(|at| Circle::new(at, 3, color.filled())))?;
            chart.draw_series(bars(curve, up.start).map(|bar| PathElement::new(bar, color.stroke_width(1))))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.9))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 15))
            .draw()
    }
}

/// One standard error up and down; no further down than the axis goes.
fn bars(curve: &Curve, floor: f64) -> impl Iterator<Item = [(f64, f64); 2]> {
    curve.points.iter().map(move |&[x, y, error]| [(x, (y - error).max(floor)), (x, y + error)])
}

/// The range of positive values with a margin on both sides.
fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values
        .filter(|value| *value > 0.0)
        .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { low / 1.5..high * 1.5 } else { 0.1..10.0 }
}
