//! Plots of deviations.

use anyhow::anyhow;
use plotters::{
    prelude::{ChartBuilder, Circle, IntoDrawingArea, LineSeries, PathElement, RGBColor, Rectangle, SVGBackend},
    style::{BLACK, Color, WHITE},
};
use tyndall_lab::verify::Check;

/// Okabe–Ito 2008.
const BLUE: RGBColor = RGBColor(0, 114, 178);
const ORANGE: RGBColor = RGBColor(213, 94, 0);
/// Deviations beyond this are drawn at the edge.
const EDGE: f64 = 5.0;
/// Bins of a histogram, from −[`EDGE`] to [`EDGE`].
const BINS: usize = 40;

/// How often each deviation occurs, beside the normal law.
pub(super) fn histogram(z: &[f64]) -> anyhow::Result<String> {
    let width = 2.0 * EDGE / BINS as f64;
    let mut counts = [0.0; BINS];
    for z in z {
        let bin = ((z.clamp(-EDGE, EDGE) + EDGE) / width) as usize;
        counts[bin.min(BINS - 1)] += 1.0;
    }
    let expected = |x: f64| z.len() as f64 * width * (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let top = 1.1 * counts.iter().copied().fold(expected(0.0), f64::max).max(1.0);
    drawn((640, 320), |page| {
        let mut chart = ChartBuilder::on(page)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(50)
            .build_cartesian_2d(-EDGE..EDGE, 0.0..top)?;
        chart.configure_mesh().x_desc("z").y_desc("figures").light_line_style(WHITE).draw()?;
        let bar = |(i, count): (usize, &f64)| {
            let start = i as f64 * width - EDGE;
            Rectangle::new([(start, 0.0), (start + width, *count)], BLUE.mix(0.6).filled())
        };
        chart.draw_series(counts.iter().enumerate().map(bar))?;
        let curve = (0..=200).map(|i| f64::from(i) / 200.0 * 2.0 * EDGE - EDGE).map(|x| (x, expected(x)));
        chart.draw_series(LineSeries::new(curve, ORANGE.stroke_width(2)))?;
        Ok(())
    })
}

/// The deviation of each figure of a table, in its order.
pub(super) fn deviations(checks: &[&Check]) -> anyhow::Result<String> {
    let last = checks.len() as f64;
    drawn((640, 240), |page| {
        let mut chart = ChartBuilder::on(page)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(50)
            .build_cartesian_2d(-1.0..last, -EDGE..EDGE)?;
        chart.configure_mesh().x_desc("figure").y_desc("z").light_line_style(WHITE).draw()?;
        for at in [-3.0, 0.0, 3.0] {
            chart.draw_series([PathElement::new([(-1.0, at), (last, at)], BLACK.mix(0.5).stroke_width(1))])?;
        }
        let dot =
            |(i, check): (usize, &&Check)| Circle::new((i as f64, check.z().clamp(-EDGE, EDGE)), 2, BLUE.filled());
        chart.draw_series(checks.iter().enumerate().map(dot))?;
        Ok(())
    })
}

type Page<'a> = plotters::drawing::DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Fault = plotters::drawing::DrawingAreaErrorKind<std::io::Error>;

/// An SVG of a size.
fn drawn(size: (u32, u32), draw: impl FnOnce(&Page) -> Result<(), Fault>) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let page = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let all = page.fill(&WHITE).and_then(|()| draw(&page)).and_then(|()| page.present());
        all.map_err(|e| anyhow!("cannot draw the plot: {e}"))?;
    }
    Ok(svg)
}
