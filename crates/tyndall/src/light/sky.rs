//! An image of radiance, as skies have them, and why one cannot be used.

use crate::{
    math::Vec2,
    spectrum::{Lanes, Spectrum, Wavelengths},
};

/// Radiance by pixel.
#[derive(Debug, Clone)]
pub struct SkyImage {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Linear-sRGB radiance by pixel, row by row [W·m⁻²·sr⁻¹].
    pub pixels: Vec<[f32; 3]>,
    /// Radiance of unit red, green and blue: any pixel is a sum of them.
    primaries: [Spectrum; 3],
}

impl SkyImage {
    /// From linear-sRGB pixels, row by row, scaled by `scale`.
    ///
    /// # Errors
    /// The image is empty, or has values that are negative or not finite.
    pub fn new(width: u32, height: u32, pixels: &[[f32; 3]], scale: f32) -> Result<Self, SkyError> {
        if width == 0 || height == 0 || pixels.len() != width as usize * height as usize {
            return Err(SkyError::Empty);
        }
        let pixels: Vec<[f32; 3]> = pixels.iter().map(|p| p.map(|v| v * scale)).collect();
        if let Some(i) = pixels.iter().position(|p| p.iter().any(|v| !v.is_finite() || *v < 0.0)) {
            return Err(SkyError::BadPixel { column: i as u32 % width, row: i as u32 / width });
        }
        let primaries = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Spectrum::illuminant_rgb);
        Ok(Self { width, height, pixels, primaries })
    }

    /// Radiance at a place of the unit square [W·m⁻²·sr⁻¹], constant over a pixel.
    #[inline]
    pub fn radiance(&self, uv: Vec2, wavelengths: &Wavelengths) -> Lanes {
        let x = ((uv.x * self.width as f32) as u32).min(self.width - 1);
        let y = ((uv.y * self.height as f32) as u32).min(self.height - 1);
        self.light(self.pixels[y as usize * self.width as usize + x as usize], wavelengths)
    }

    /// The linear-sRGB value at a place where column x stands at x and row y at y, linear between them. Columns go round;
    /// the outermost rows are the last.
    pub(crate) fn between(&self, at: Vec2) -> [f32; 3] {
        let last = self.height - 1;
        let (x, y) = ((at.x as u32).min(self.width - 1), (at.y as u32).min(last));
        let (dx, dy) = (at.x - x as f32, (at.y - y as f32).min(1.0));
        let row = |y: u32| {
            let value = |x: u32| self.pixels[y as usize * self.width as usize + x as usize];
            let (left, right) = (value(x), value(if x + 1 == self.width { 0 } else { x + 1 }));
            std::array::from_fn::<f32, 3, _>(|c| left[c] + (right[c] - left[c]) * dx)
        };
        let (upper, lower) = (row(y), row((y + 1).min(last)));
        std::array::from_fn(|c| upper[c] + (lower[c] - upper[c]) * dy)
    }

    /// The light of a linear-sRGB value [W·m⁻²·sr⁻¹].
    #[inline]
    pub(crate) fn light(&self, rgb: [f32; 3], wavelengths: &Wavelengths) -> Lanes {
        match wavelengths {
            Wavelengths::Rgb => Lanes::rgb(rgb[0], rgb[1], rgb[2]),
            _ => (0..3).fold(Lanes::ZERO, |sum, c| sum + self.primaries[c].eval(wavelengths) * rgb[c]),
        }
    }

    /// Of an equal-area octahedral square: the linear-sRGB value at a place, linear between the middles of pixels. Over
    /// an edge of the square the sphere goes on at the mirrored place of the same edge.
    pub(crate) fn octahedral(&self, uv: Vec2) -> [f32; 3] {
        let size = [self.width, self.height].map(i64::from);
        let at = [uv.x * self.width as f32 - 0.5, uv.y * self.height as f32 - 0.5];
        let cell = at.map(|v| v.floor() as i64);
        let [dx, dy] = [0, 1].map(|axis| at[axis] - cell[axis] as f32);
        let pixel = |i: i64, j: i64| {
            let mut p = [cell[0] + i, cell[1] + j];
            for axis in 0..2 {
                if !(0..size[axis]).contains(&p[axis]) {
                    p[axis] = if p[axis] < 0 { -1 - p[axis] } else { 2 * size[axis] - 1 - p[axis] };
                    p[1 - axis] = size[1 - axis] - 1 - p[1 - axis];
                }
            }
            let [x, y] = [0, 1].map(|axis| p[axis].clamp(0, size[axis] - 1) as usize);
            self.pixels[y * self.width as usize + x]
        };
        let corners =
            [(0, 0, (1.0 - dx) * (1.0 - dy)), (1, 0, dx * (1.0 - dy)), (0, 1, (1.0 - dx) * dy), (1, 1, dx * dy)];
        let corners = corners.map(|(i, j, weight)| (pixel(i, j), weight));
        std::array::from_fn(|c| corners.iter().map(|(rgb, weight)| rgb[c] * weight).sum())
    }
}

/// An image of a sky that cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SkyError {
    /// No pixels.
    #[error("the environment image has no pixels")]
    Empty,
    /// No light anywhere.
    #[error("the environment image is black: leave the light out")]
    Black,
    /// A value that is no radiance.
    #[error("the environment image has a negative or non-finite value at column {column}, row {row}")]
    BadPixel {
        /// Column.
        column: u32,
        /// Row.
        row: u32,
    },
}
