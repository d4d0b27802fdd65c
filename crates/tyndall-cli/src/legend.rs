//! The legend of a plot: in the upper right corner, the labels of its series.

use plotters::{
    chart::ChartContext,
    coord::CoordTranslate,
    prelude::{DrawingAreaErrorKind, DrawingBackend, SeriesLabelPosition},
    style::{BLACK, Color, WHITE},
};

/// Draws it over what is there.
pub(crate) fn draw<'a, B: DrawingBackend + 'a, C: CoordTranslate>(
    chart: &mut ChartContext<'a, B, C>,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 15))
        .draw()
}
