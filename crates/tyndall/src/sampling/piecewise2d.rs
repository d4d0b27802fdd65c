//! Points of the unit square with the density of an image: environment maps, textured emitters, projected slides.
//!
//! The density is constant on each pixel: `p(u, v) = value/mean`. A row is chosen by its sum, then a pixel within the row;
//! what is left of the two random numbers places the point within the pixel. Pixel (column i, row j) covers
//! `u ∈ [i/w, (i+1)/w)`, `v ∈ [j/h, (j+1)/h)`; the caller orients the image and supplies any Jacobian, such as sin θ.
//!
//! Source: Pharr, Jakob and Humphreys 2023, appendix A.5.6.

use super::discrete::Discrete;
use crate::math::Vec2;

/// A density over the unit square, constant on pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Piecewise2d {
    rows: Discrete,
    /// Pixels of each row; none where the whole row is zero.
    columns: Vec<Option<Discrete>>,
    width: usize,
}

impl Piecewise2d {
    /// From `width` × n values ≥ 0, row after row. `None` when they do not fill rows, no value is positive, or one is
    /// negative or not finite.
    pub fn new(values: &[f32], width: usize) -> Option<Self> {
        if width == 0 || !values.len().is_multiple_of(width) || values.iter().any(|v| !(*v >= 0.0 && v.is_finite())) {
            return None;
        }
        let rows = values.chunks_exact(width);
        Some(Self {
            rows: Discrete::from_f64(rows.clone().map(|row| row.iter().map(|&v| f64::from(v)).sum()))?,
            columns: rows.map(Discrete::new).collect(),
            width,
        })
    }

    /// From `u` in [0, 1)²: a point of the square and its density [1/area].
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        let (row, p_row, rest_y) = self.rows.sample(u.y);
        let Some(columns) = &self.columns[row] else {
            return (Vec2::ZERO, 0.0); // a row of no weight is never chosen
        };
        let (column, p_column, rest_x) = columns.sample(u.x);
        let (w, h) = (self.width as f32, self.columns.len() as f32);
        (Vec2::new(place(column, rest_x, w), place(row, rest_y, h)), p_row * p_column * w * h)
    }

    /// The density at a point of the square [1/area]; 0 outside.
    pub fn pdf(&self, uv: Vec2) -> f32 {
        if !(uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all()) {
            return 0.0;
        }
        let (w, h) = (self.width, self.columns.len());
        let column = cell(uv.x, w as f32).min(w - 1);
        let row = cell(uv.y, h as f32).min(h - 1);
        let p_column = self.columns[row].as_ref().map_or(0.0, |columns| columns.pmf(column));
        self.rows.pmf(row) * p_column * (w * h) as f32
    }
}

/// The cell of n in which `x` lies.
fn cell(x: f32, n: f32) -> usize {
    (x * n) as usize
}

/// The place at the fraction `rest` of a cell of n: never, by rounding, in a neighbour, whose density is another.
fn place(index: usize, rest: f32, n: f32) -> f32 {
    let mut x = (index as f32 + rest) / n;
    while cell(x, n) > index {
        x = x.next_down();
    }
    while cell(x, n) < index {
        x = x.next_up();
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value over mean: [[0, 1], [2, 5]] has mean 2.
    #[test]
    fn the_density_is_value_over_mean() {
        let p = Piecewise2d::new(&[0.0, 1.0, 2.0, 5.0], 2).unwrap();
        for (uv, density) in [((0.2, 0.2), 0.0), ((0.7, 0.2), 0.5), ((0.2, 0.7), 1.0), ((1.0, 1.0), 2.5)] {
            assert!((p.pdf(uv.into()) - density).abs() < 1e-6, "{uv:?}");
        }
        assert_eq!(p.pdf(Vec2::new(1.1, 0.5)), 0.0);
        assert_eq!(p.pdf(Vec2::NAN), 0.0);
    }

    #[test]
    fn samples_lie_in_the_pixel_that_was_chosen() {
        for n in [3u16, 7, 49, 1000, 4095] {
            for index in 0..usize::from(n) {
                for rest in [0.0, 1e-9, 0.5, 1.0 - f32::EPSILON / 2.0] {
                    let x = place(index, rest, f32::from(n));
                    assert_eq!(cell(x, f32::from(n)), index, "{rest}");
                    assert!((x * f32::from(n) - index as f32 - rest).abs() < 1e-3);
                }
            }
        }
    }

    #[test]
    fn images_without_light_or_with_ragged_rows_are_refused() {
        assert_eq!(Piecewise2d::new(&[0.0; 4], 2), None);
        assert_eq!(Piecewise2d::new(&[1.0; 3], 2), None);
        assert_eq!(Piecewise2d::new(&[], 0), None);
        assert_eq!(Piecewise2d::new(&[1.0, f32::NAN], 1), None);
    }
}
