//! The film: sums and squared sums of every pixel, from which come the mean and its standard error.
//!
//! A sample belongs to one pixel (reconstruction filters are sampled, [`filter`]), so pixels are independent, a crop
//! of the image is the image of the crop, and films of the same scene merge by addition.

pub mod bands;
pub mod filter;
pub mod layer;
pub mod lobed;
pub mod parts;

pub use bands::Bands;
pub use filter::Filter;
pub use layer::{Average, Cell, Layer, LayerKind, Recorded};
pub use lobed::{Kernel, Lobed};

/// A rectangle of pixels, `min ≤ (x, y) < max`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crop {
    /// First column and row.
    pub min: (u32, u32),
    /// Column and row after the last.
    pub max: (u32, u32),
}

impl Crop {
    /// The whole of an image.
    pub fn full(width: u32, height: u32) -> Self {
        Self { min: (0, 0), max: (width, height) }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.max.0.saturating_sub(self.min.0)
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.max.1.saturating_sub(self.min.1)
    }

    /// Row by row.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.min.1..self.max.1).flat_map(move |y| (self.min.0..self.max.0).map(move |x| (x, y)))
    }

    /// The pixels of both.
    #[must_use]
    pub fn common(self, other: Self) -> Self {
        let (Self { min: a, max: b }, Self { min: c, max: d }) = (self, other);
        Self { min: (a.0.max(c.0), a.1.max(c.1)), max: (b.0.min(d.0), b.1.min(d.1)) }
    }

    /// Where the pixel `(x, y)` of this crop is, row by row.
    #[inline]
    pub fn index(&self, (x, y): (u32, u32)) -> usize {
        ((y - self.min.1) * self.width() + (x - self.min.0)) as usize
    }

    /// The part of this crop that lies within an image.
    #[must_use]
    pub fn within(self, width: u32, height: u32) -> Self {
        self.common(Self::full(width, height))
    }
}

/// What a pixel has received: linear-sRGB radiance [W·m⁻²·sr⁻¹, or the scene's unit].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pixel {
    /// Σ x.
    pub sum: [f64; 3],
    /// Σ x².
    pub sum_of_squares: [f64; 3],
    /// Number of samples.
    pub count: u64,
}

impl Pixel {
    /// Adds one sample.
    #[inline]
    pub fn add(&mut self, value: [f32; 3]) {
        for (c, v) in value.into_iter().enumerate() {
            let v = f64::from(v);
            self.sum[c] += v;
            self.sum_of_squares[c] += v * v;
        }
        self.count += 1;
    }

    /// Adds the samples of another pixel.
    pub fn merge(&mut self, other: &Self) {
        for c in 0..3 {
            self.sum[c] += other.sum[c];
            self.sum_of_squares[c] += other.sum_of_squares[c];
        }
        self.count += other.count;
    }

    /// The estimate, `Σx / n`; zero without samples.
    pub fn mean(&self) -> [f32; 3] {
        if self.count == 0 {
            return [0.0; 3];
        }
        self.sum.map(|s| (s / self.count as f64) as f32)
    }

    /// Standard error of the mean, `√((Σx² − (Σx)²/n) / (n(n−1)))`; infinite for fewer than two samples.
    pub fn standard_error(&self) -> [f32; 3] {
        std::array::from_fn(|c| standard_error(self.sum[c], self.sum_of_squares[c], self.count))
    }
}

/// `√((Σx² − (Σx)²/n) / (n(n−1)))`; infinite for fewer than two samples.
pub(crate) fn standard_error(sum: f64, sum_of_squares: f64, count: u64) -> f32 {
    if count < 2 {
        return f32::INFINITY;
    }
    let n = count as f64;
    let spread = (sum_of_squares - sum * sum / n).max(0.0);
    (spread / (n * (n - 1.0))).sqrt() as f32
}

/// The pixels of a crop of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Size of the whole image.
    pub width: u32,
    /// Size of the whole image.
    pub height: u32,
    /// The part that is rendered.
    pub crop: Crop,
    /// Row by row, the crop only.
    pub pixels: Vec<Pixel>,
    /// What is recorded beside light.
    pub layers: Vec<Layer>,
}

impl Film {
    /// An empty film of `crop` of an image.
    pub fn new(width: u32, height: u32, crop: Crop) -> Self {
        let crop = crop.within(width, height);
        let pixels = vec![Pixel::default(); crop.width() as usize * crop.height() as usize];
        Self { width, height, crop, pixels, layers: Vec::new() }
    }

    /// The same, with layers.
    #[must_use]
    pub fn with_layers(self, kinds: &[LayerKind]) -> Self {
        let cells = vec![Cell::default(); self.pixels.len()];
        let layers = kinds.iter().map(|kind| Layer { kind: kind.clone(), cells: cells.clone() }).collect();
        Self { layers, ..self }
    }

    /// The pixel at image coordinates `(x, y)`; `None` outside the crop.
    pub fn pixel(&self, x: u32, y: u32) -> Option<&Pixel> {
        let c = &self.crop;
        (x >= c.min.0 && y >= c.min.1 && x < c.max.0 && y < c.max.1).then(|| &self.pixels[c.index((x, y))])
    }

    /// Adds the samples of a film of the same image and crop.
    ///
    /// # Errors
    /// The two films are not of the same image and crop, or record different things.
    pub fn merge(&mut self, other: &Self) -> Result<(), FilmMismatch> {
        if (self.width, self.height, self.crop) != (other.width, other.height, other.crop) {
            return Err(FilmMismatch);
        }
        let kinds = |film: &Self| film.layers.iter().map(|layer| layer.kind.clone()).collect::<Vec<_>>();
        if kinds(self) != kinds(other) {
            return Err(FilmMismatch);
        }
        for (mine, theirs) in self.layers.iter_mut().zip(&other.layers) {
            for (a, b) in mine.cells.iter_mut().zip(&theirs.cells) {
                a.merge(b);
            }
        }
        for (a, b) in self.pixels.iter_mut().zip(&other.pixels) {
            a.merge(b);
        }
        Ok(())
    }
}

/// Two films of different images or crops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the films differ in size, crop or layers, so their samples cannot be added")]
pub struct FilmMismatch;

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples 1, 2, 3, 4: mean 5/2, variance 5/3, standard error √(5/12).
    #[test]
    fn mean_and_standard_error_follow_from_the_sums() {
        let mut p = Pixel::default();
        for v in [1.0, 2.0, 3.0, 4.0] {
            p.add([v, 0.0, 1.0]);
        }
        assert_eq!(p.mean(), [2.5, 0.0, 1.0]);
        let se = p.standard_error();
        assert!((se[0] - (5.0f32 / 12.0).sqrt()).abs() < 1e-6 && se[1] == 0.0 && se[2] == 0.0);
    }

    #[test]
    fn merged_films_hold_all_samples() {
        let crop = Crop { min: (1, 1), max: (3, 9) };
        let mut a = Film::new(4, 3, crop);
        let mut b = a.clone();
        assert_eq!(a.pixels.len(), 2 * 2);
        a.pixels[3].add([1.0; 3]);
        b.pixels[3].add([3.0; 3]);
        a.merge(&b).unwrap();
        assert_eq!(a.pixel(2, 2).unwrap().mean(), [2.0; 3]);
        assert!(a.merge(&Film::new(5, 3, crop)).is_err());
    }
}
