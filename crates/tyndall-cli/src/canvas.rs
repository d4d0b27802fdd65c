//! A page to draw on: pictures, words, and through `plotters` plots; it becomes a PNG.
//!
//! Words are set in Noto Sans Mono, which is compiled in, so that they look the same everywhere.

#![allow(clippy::cast_possible_wrap, reason = "a page is far smaller than 2³¹ pixels")]

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use plotters::{
    prelude::DrawingBackend,
    style::text_anchor::{HPos, VPos},
};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingErrorKind, FontTransform};

/// A raster of sRGB bytes.
#[derive(Debug, Clone)]
pub(crate) struct Canvas {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Three bytes a pixel, row by row.
    pub(crate) pixels: Vec<u8>,
}

/// Two sizes of type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    Small,
    Large,
}

impl Type {
    fn raster(self) -> RasterHeight {
        match self {
            Self::Small => RasterHeight::Size16,
            Self::Large => RasterHeight::Size20,
        }
    }

    /// Of a line [pixels].
    pub(crate) fn height(self) -> u32 {
        self.raster().val() as u32
    }

    /// Of a text [pixels].
    pub(crate) fn width(self, text: &str) -> u32 {
        (text.chars().count() * get_raster_width(FontWeight::Regular, self.raster())) as u32
    }

    /// The one that is nearer to a size [pixels].
    fn near(size: f64) -> Self {
        if size < 18.0 { Self::Small } else { Self::Large }
    }
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32, background: [u8; 3]) -> Self {
        Self { width, height, pixels: background.repeat(width as usize * height as usize) }
    }

    /// Mixes a colour into a pixel; points outside the page are left out.
    fn mix(&mut self, x: i32, y: i32, color: [u8; 3], alpha: f64) {
        if x < 0 || y < 0 || x >= self.width as i32 || y >= self.height as i32 {
            return;
        }
        let start = 3 * (y as usize * self.width as usize + x as usize);
        for (old, new) in self.pixels[start..start + 3].iter_mut().zip(color) {
            *old = (f64::from(*old) + (f64::from(new) - f64::from(*old)) * alpha).round() as u8;
        }
    }

    /// Puts a picture of three bytes a pixel with its upper left corner at `(x, y)`.
    pub(crate) fn picture(&mut self, x: u32, y: u32, columns: u32, pixels: &[u8]) {
        for (i, p) in pixels.chunks_exact(3).enumerate() {
            let (px, py) = (x + i as u32 % columns, y + i as u32 / columns);
            self.mix(px as i32, py as i32, [p[0], p[1], p[2]], 1.0);
        }
    }

    /// Writes a line with its upper left corner at `(x, y)`.
    pub(crate) fn text(&mut self, x: u32, y: u32, text: &str, size: Type, color: [u8; 3]) {
        letters(text, size, |dx, dy, alpha| self.mix(x as i32 + dx, y as i32 + dy, color, alpha));
    }
}

/// Calls `dot` with the place and the coverage of every pixel of a line of text.
fn letters(text: &str, size: Type, mut dot: impl FnMut(i32, i32, f64)) {
    let raster = |c| get_raster(c, FontWeight::Regular, size.raster());
    let advance = get_raster_width(FontWeight::Regular, size.raster()) as i32;
    for (i, c) in text.chars().enumerate() {
        let Some(letter) = raster(c).or_else(|| raster('?')) else { continue };
        for (dy, row) in letter.rows().enumerate() {
            for (dx, &coverage) in row.iter().enumerate().filter(|(_, coverage)| **coverage > 0) {
                dot(i as i32 * advance + dx as i32, dy as i32, f64::from(coverage) / 255.0);
            }
        }
    }
}

/// Drawing on a canvas cannot fail.
type Never = DrawingErrorKind<std::convert::Infallible>;

impl DrawingBackend for &mut Canvas {
    type ErrorType = std::convert::Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn ensure_prepared(&mut self) -> Result<(), Never> {
        Ok(())
    }

    fn present(&mut self) -> Result<(), Never> {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Result<(), Never> {
        let (r, g, b) = color.rgb;
        self.mix(x, y, [r, g, b], color.alpha);
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(&self, text: &str, style: &S) -> Result<(u32, u32), Never> {
        let size = Type::near(style.size());
        Ok((size.width(text), size.height()))
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Result<(), Never> {
        let size = Type::near(style.size());
        let (w, h) = (size.width(text) as i32, size.height() as i32);
        let left = match style.anchor().h_pos {
            HPos::Left => 0,
            HPos::Center => -w / 2,
            HPos::Right => -w,
        };
        let top = match style.anchor().v_pos {
            VPos::Top => 0,
            VPos::Center => -h / 2,
            VPos::Bottom => -h,
        };
        let (color, (r, g, b)) = (style.color(), style.color().rgb);
        letters(text, size, |dx, dy, coverage| {
            let (dx, dy) = turned(&style.transform(), left + dx, top + dy);
            self.mix(at.0 + dx, at.1 + dy, [r, g, b], coverage * color.alpha);
        });
        Ok(())
    }
}

fn turned(transform: &FontTransform, x: i32, y: i32) -> (i32, i32) {
    match transform {
        FontTransform::None => (x, y),
        FontTransform::Rotate90 => (-y, x),
        FontTransform::Rotate180 => (-x, -y),
        FontTransform::Rotate270 => (y, -x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_leave_ink_within_their_box_and_nothing_outside_the_page() {
        let mut page = Canvas::new(40, 20, [255; 3]);
        page.text(2, 2, "V1", Type::Small, [0; 3]);
        let dark = |x: u32, y: u32| page.pixels[3 * (y * 40 + x) as usize] < 128;
        let ink = (0..40 * 20).filter(|i| dark(i % 40, i / 40)).count();
        assert!(ink > 10, "{ink} dark pixels");
        let right = 2 + Type::Small.width("V1");
        assert!((right..40).all(|x| (0..20).all(|y| !dark(x, y))));
        page.text(38, 18, "beyond the edge", Type::Large, [0; 3]);
        page.picture(39, 19, 2, &[1; 12]);
    }
}
