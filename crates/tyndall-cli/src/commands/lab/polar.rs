//! Polar plots: a quantity by direction in a plane, the distance from the middle logarithmic.

use plotters::{
    coord::Shift,
    prelude::{ChartBuilder, DrawingArea, DrawingBackend, PathElement, Text},
    style::{BLACK, Color},
};

use super::report::COLORS;
use crate::legend;

/// Lines around a middle.
#[derive(Debug)]
pub(crate) struct Polar {
    /// Powers of ten from the middle to the rim.
    pub(crate) decades: f64,
    pub(crate) lines: Vec<Line>,
}

/// A line once around.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) name: &'static str,
    /// Angle to the upward direction, clockwise [rad], and value.
    pub(crate) points: Vec<(f64, f64)>,
}

impl Polar {
    /// Draws rings a decade apart, spokes of 30°, and the lines.
    pub(crate) fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
        let values = || self.lines.iter().flat_map(|line| &line.points).map(|(_, value)| *value);
        let most = values().fold(f64::MIN_POSITIVE, f64::max);
        // The rim is the next power of ten.
        let rim = most.log10().ceil();
        let distance = |value: f64| ((value.max(0.0).log10() - rim) / self.decades + 1.0).clamp(0.0, 1.0);
        let place = |angle: f64, distance: f64| (distance * angle.sin(), distance * angle.cos());
        let mut chart = ChartBuilder::on(area).margin(12).build_cartesian_2d(-1.2..1.2, -1.2..1.2)?;
        let faint = BLACK.mix(0.15).stroke_width(1);
        for ring in 0..self.decades.ceil() as i32 {
            let radius = 1.0 - f64::from(ring) / self.decades;
            let circle = (0..=90).map(|i| place(f64::from(i) * std::f64::consts::TAU / 90.0, radius));
            chart.draw_series([PathElement::new(circle.collect::<Vec<_>>(), faint)])?;
            let label = format!("1e{}", rim as i32 - ring);
            chart.draw_series([Text::new(label, place(0.3, radius), ("sans-serif", 15))])?;
        }
        for spoke in 0..12 {
            let angle = f64::from(spoke) * std::f64::consts::TAU / 12.0;
            chart.draw_series([PathElement::new(vec![(0.0, 0.0), place(angle, 1.0)], faint)])?;
            let from_up = if spoke <= 6 { 30 * spoke } else { 360 - 30 * spoke };
            let (x, y) = place(angle, 1.1);
            chart.draw_series([Text::new(format!("{from_up}°"), (x - 0.04, y + 0.03), ("sans-serif", 15))])?;
        }
        for (line, color) in self.lines.iter().zip(COLORS.into_iter().cycle()) {
            let mut points: Vec<_> = line.points.iter().map(|(angle, value)| place(*angle, distance(*value))).collect();
            points.extend(points.first().copied());
            chart
                .draw_series([PathElement::new(points, color.stroke_width(2))])?
                .label(line.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        }
        legend::draw(&mut chart)
    }
}
