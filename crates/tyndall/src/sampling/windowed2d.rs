//! Points of a window of the unit square, with the density of the image in it.
//!
//! `p(u, v) = f(u, v) / ∫_window f`, with `f` constant on each pixel. A table of sums over all rectangles from the corner
//! gives the integral over any window; the number of a column is found in it by bisection, then that of a row within the
//! column. Within a pixel sums are linear, so that both are inverted exactly.
//!
//! Source: Crow 1984 (summed-area tables); Bitterli et al. 2015, "Portal-masked environment map sampling", § 4.

use glam::{DVec2, dvec2};

use crate::math::Vec2;

/// A rectangle of the unit square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Least corner.
    pub min: Vec2,
    /// Greatest corner.
    pub max: Vec2,
}

impl Window {
    /// All of it.
    pub const SQUARE: Self = Self { min: Vec2::ZERO, max: Vec2::ONE };

    /// Whether a point is inside or on the rim.
    #[inline]
    pub fn holds(&self, uv: Vec2) -> bool {
        (uv.cmpge(self.min) & uv.cmple(self.max)).all()
    }
}

/// An image over the unit square that can be sampled within any window.
#[derive(Debug, Clone, PartialEq)]
pub struct Windowed2d {
    width: usize,
    height: usize,
    /// Sums over the first i columns and j rows: `(width + 1) × (height + 1)` numbers.
    sums: Vec<f64>,
    values: Vec<f32>,
}

impl Windowed2d {
    /// From `width` × n values ≥ 0, row after row. `None` when they do not fill rows, or one is negative or not finite.
    pub fn new(values: Vec<f32>, width: usize) -> Option<Self> {
        if width == 0 || values.is_empty() || !values.len().is_multiple_of(width) {
            return None;
        }
        if values.iter().any(|v| !(*v >= 0.0 && v.is_finite())) {
            return None;
        }
        let height = values.len() / width;
        let mut sums = vec![0.0; (width + 1) * (height + 1)];
        for y in 0..height {
            let mut row = 0.0;
            for x in 0..width {
                row += f64::from(values[y * width + x]);
                sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
            }
        }
        Some(Self { width, height, sums, values })
    }

    /// `∫ f` over the part of the window from its least corner to `(x, y)` [pixels].
    fn integral(&self, min: DVec2, max: DVec2) -> f64 {
        let at = |x: f64, y: f64| self.corner_integral(x, y);
        (at(max.x, max.y) - at(min.x, max.y)) - (at(max.x, min.y) - at(min.x, min.y))
    }

    /// `∫ f` from (0, 0) to `(x, y)` [pixels]: bilinear between the corners of pixels.
    fn corner_integral(&self, x: f64, y: f64) -> f64 {
        let place = |v: f64, n: usize| {
            let cell = (v.max(0.0) as usize).min(n - 1);
            (cell, (v - cell as f64).clamp(0.0, 1.0))
        };
        let ((i, dx), (j, dy)) = (place(x, self.width), place(y, self.height));
        let at = |i: usize, j: usize| self.sums[j * (self.width + 1) + i];
        let low = at(i, j) + dx * (at(i + 1, j) - at(i, j));
        let high = at(i, j + 1) + dx * (at(i + 1, j + 1) - at(i, j + 1));
        low + dy * (high - low)
    }

    fn pixels(&self, window: &Window) -> [DVec2; 2] {
        let size = dvec2(self.width as f64, self.height as f64);
        [window.min, window.max].map(|corner| corner.as_dvec2().clamp(DVec2::ZERO, DVec2::ONE) * size)
    }

    /// A point of the window and its density [1/area]; `None` where the window has no light.
    pub fn sample(&self, u: Vec2, window: &Window) -> Option<(Vec2, f32)> {
        let [min, max] = self.pixels(window);
        let total = self.integral(min, max);
        if total.is_nan() || total <= 0.0 {
            return None;
        }
        let x = invert(f64::from(u.x) * total, [min.x, max.x], |x| self.integral(min, dvec2(x, max.y)))?;
        let column = (x as usize).min(self.width - 1) as f64;
        let [left, right] = [column.max(min.x), (column + 1.0).min(max.x)];
        let strip = |y: f64| self.integral(dvec2(left, min.y), dvec2(right, y));
        let y = invert(f64::from(u.y) * strip(max.y), [min.y, max.y], strip)?;
        let size = dvec2(self.width as f64, self.height as f64);
        let uv = (dvec2(x, y) / size).as_vec2().clamp(window.min, window.max);
        let pdf = self.pdf(uv, window);
        (pdf > 0.0 && pdf.is_finite()).then_some((uv, pdf))
    }

    /// The density at a point of the window [1/area]; 0 outside.
    pub fn pdf(&self, uv: Vec2, window: &Window) -> f32 {
        if !window.holds(uv) || !Window::SQUARE.holds(uv) {
            return 0.0;
        }
        let [min, max] = self.pixels(window);
        let total = self.integral(min, max);
        if total.is_nan() || total <= 0.0 {
            return 0.0;
        }
        let [x, y] = [(uv.x, self.width), (uv.y, self.height)].map(|(v, n)| ((v * n as f32) as usize).min(n - 1));
        (f64::from(self.values[y * self.width + x]) / total * (self.width * self.height) as f64) as f32
    }
}

/// The x in a range at which a rising function, linear between whole numbers, has a value.
fn invert(value: f64, [mut low, mut high]: [f64; 2], f: impl Fn(f64) -> f64) -> Option<f64> {
    // Among the whole numbers inside of the range the last one that is not above.
    let (mut first, mut last) = (low.floor(), high.ceil());
    while last - first > 1.0 {
        let middle = ((first + last) * 0.5).floor();
        if f(middle) <= value { first = middle } else { last = middle }
    }
    (low, high) = (low.max(first), high.min(last));
    let (at_low, at_high) = (f(low), f(high));
    let part = ((value - at_low) / (at_high - at_low)).clamp(0.0, 1.0);
    (at_high > at_low).then_some(low + part * (high - low))
}
