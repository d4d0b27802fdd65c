//! How far apart two images are, and whether noise explains it.
//!
//! **Measures** are means over pixels and channels: MSE `⟨(a−b)²⟩`, MAE `⟨|a−b|⟩`, relative MSE `⟨(a−b)²/(b²+0.01)⟩`
//! (Rousselle et al. 2011, §5), PSNR `10 log₁₀(max(b)²/MSE)` [dB].
//!
//! **The test.** Pixels are independent, so a tile's mean has variance `Σ se² / n²`, and for two estimates of one image
//! `z = (ā − b̄) / √(var ā + var b̄)` is standard normal in every tile and channel. Two statistics are looked at: the
//! largest |z|, which finds a local fault, with Šidák's correction for the number of tests
//! (`p = 1 − (1 − p₁)^N`); and for each channel `χ² = Σ z²` over tiles, which finds a small fault everywhere, corrected
//! for three channels. Channels of one tile are correlated, which makes Šidák's correction err on the safe side. The
//! verdict takes the smaller of the two, corrected for being the smaller of two.
//!
//! Standard errors are estimates. Where an estimator finds light rarely, a tile that found too little of it also
//! underestimates its variance, so the variance is taken as if the brighter of the two means were the truth (a score test
//! instead of a Wald test): tests of noisy images lose a little power and no longer cry wolf.
//!
//! What arithmetic can do is not counted as a difference: rounding of the stored values (independent in each pixel), and
//! a relative 10⁻⁶ of a tile's mean for sums of 32-bit floats along a path.

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use tyndall_formats::film::Image;

/// Relative error that arithmetic on 32-bit floats (2⁻²⁴ an operation, a dozen or two operations) may leave in a mean.
const ARITHMETIC: f64 = 1e-6;

/// Keeps relative errors finite in the dark (Rousselle et al. 2011).
const DARK: f64 = 0.01;

/// Error measures of an image against another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Measures {
    pub(crate) mse: f64,
    pub(crate) mae: f64,
    pub(crate) relative_mse: f64,
    /// [dB]; infinite for equal images.
    pub(crate) psnr: f64,
    pub(crate) max_difference: f64,
    /// Where the largest difference is.
    pub(crate) max_difference_pixel: (u32, u32),
    /// The MSE that the standard errors alone explain; `None` where there are none.
    pub(crate) mse_from_noise: Option<f64>,
}

/// The mean of an image, with its standard error where it is known.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MeanColor {
    pub(crate) rgb: [f64; 3],
    pub(crate) standard_error: Option<[f64; 3]>,
}

/// Outcome of the z-test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Test {
    /// Tiles times channels that could be tested.
    pub(crate) tests: usize,
    /// The largest |z|.
    pub(crate) max_z: f64,
    /// Upper-left pixel of the tile where it is.
    pub(crate) max_z_pixel: (u32, u32),
    /// Chance of a |z| that large among all tests, if the images agree.
    pub(crate) p_max_z: f64,
    /// χ² / degrees of freedom, each channel; about 1 if the images agree and the standard errors are right.
    pub(crate) chi_square_per_degree: [f64; 3],
    /// Chance of a χ² that large in any channel, if the images agree.
    pub(crate) p_chi_square: f64,
    /// Chance of either.
    pub(crate) p: f64,
}

/// The numbers of pixel `i` of an image.
fn channels(pixels: &[[f32; 3]]) -> impl Iterator<Item = f64> {
    pixels.iter().flatten().map(|&v| f64::from(v))
}

/// Error measures of `a` against `b`, which have the same crop.
pub(crate) fn measures(a: &Image, b: &Image) -> Measures {
    let n = (3 * a.mean.len()).max(1) as f64;
    let (mut squares, mut absolute, mut relative, mut peak) = (0.0, 0.0, 0.0, 0.0f64);
    let (mut largest, mut place) = (0.0, 0);
    for (i, (x, y)) in channels(&a.mean).zip(channels(&b.mean)).enumerate() {
        let d = x - y;
        squares += d * d;
        absolute += d.abs();
        relative += d * d / (y * y + DARK);
        peak = peak.max(y);
        if d.abs() > largest {
            (largest, place) = (d.abs(), i / 3);
        }
    }
    let mse = squares / n;
    let noise = |image: &Image| image.standard_error.as_deref().map(|se| channels(se).map(|e| e * e).sum::<f64>() / n);
    let noises = [a, b].map(noise);
    Measures {
        mse,
        mae: absolute / n,
        relative_mse: relative / n,
        psnr: 10.0 * (peak * peak / mse).log10(),
        max_difference: largest,
        max_difference_pixel: pixel_at(a, place),
        mse_from_noise: noises.iter().any(Option::is_some).then(|| noises.iter().flatten().sum()),
    }
}

/// Mean colour: pixels are independent, so variances add.
pub(crate) fn mean_color(image: &Image) -> MeanColor {
    let n = image.mean.len().max(1) as f64;
    let sum = |pixels: &[[f32; 3]], f: fn(f64) -> f64| {
        std::array::from_fn(|c| pixels.iter().map(|p| f(f64::from(p[c]))).sum::<f64>())
    };
    let variances: Option<[f64; 3]> = image.standard_error.as_deref().map(|se| sum(se, |e| e * e));
    MeanColor {
        rgb: sum(&image.mean, |v| v).map(|s| s / n),
        standard_error: variances.map(|v| v.map(|v| v.sqrt() / n)),
    }
}

/// The z-test over tiles of `edge` pixels. `None` if neither image tells finite standard errors, or none to speak of.
pub(crate) fn z_test(a: &Image, b: &Image, edge: u32) -> Option<Test> {
    if a.standard_error.is_none() && b.standard_error.is_none() {
        return None;
    }
    let (sampled_a, sampled_b) = (Sampled::new(a), Sampled::new(b));
    let (mut tests, mut max_z, mut max_at) = (0, 0.0f64, (0, 0));
    let mut chi_square = [0.0; 3];
    let mut degrees = [0usize; 3];
    for tile in tiles(a, edge) {
        for c in 0..3 {
            let Some(z) = tile_z(&sampled_a, &sampled_b, &tile.pixels, c) else { continue };
            tests += 1;
            degrees[c] += 1;
            chi_square[c] += z * z;
            if z.abs() > max_z {
                (max_z, max_at) = (z.abs(), tile.corner);
            }
        }
    }
    if tests == 0 {
        return None;
    }
    let p_max_z = sidak(two_sided(max_z), tests);
    let p_channel = (0..3).map(|c| chi_square_tail(chi_square[c], degrees[c])).fold(1.0, f64::min);
    let p_chi_square = sidak(p_channel, 3);
    Some(Test {
        tests,
        max_z,
        max_z_pixel: max_at,
        p_max_z,
        chi_square_per_degree: std::array::from_fn(|c| chi_square[c] / degrees[c].max(1) as f64),
        p_chi_square,
        p: sidak(p_max_z.min(p_chi_square), 2),
    })
}

struct Tile {
    corner: (u32, u32),
    /// Indices of its pixels.
    pixels: Vec<usize>,
}

/// Tiles that lie on a grid fixed to the crop; those at its right and lower edge may be smaller.
fn tiles(image: &Image, edge: u32) -> impl Iterator<Item = Tile> {
    let (w, h) = (image.crop.width(), image.crop.height());
    let origin = image.crop.min;
    let columns = w.div_ceil(edge);
    (0..columns * h.div_ceil(edge)).map(move |i| {
        let (x0, y0) = (i % columns * edge, i / columns * edge);
        let rows = y0..h.min(y0.saturating_add(edge));
        let row = move |y: u32| (x0..w.min(x0.saturating_add(edge))).map(move |x| (y * w + x) as usize);
        Tile { corner: (origin.0 + x0, origin.1 + y0), pixels: rows.flat_map(row).collect() }
    })
}

/// z of a tile in one channel. `None` where both images are equal without noise (nothing to test), and where a standard
/// error is infinite (a pixel with fewer than two samples tells nothing).
fn tile_z(a: &Sampled, b: &Sampled, pixels: &[usize], c: usize) -> Option<f64> {
    let (of_a, of_b) = (a.tile(pixels, c), b.tile(pixels, c));
    if of_a.mean == of_b.mean && of_a.noise == 0.0 && of_b.noise == 0.0 {
        return None;
    }
    let brighter = of_a.mean.max(of_b.mean);
    let n = pixels.len() as f64;
    let noise = a.noise_if_mean_were(brighter, &of_a, n, c) + b.noise_if_mean_were(brighter, &of_b, n, c);
    let arithmetic = (ARITHMETIC * 0.5 * (of_a.mean.abs() + of_b.mean.abs())).powi(2);
    let deviation = (noise + of_a.rounding + of_b.rounding + arithmetic).sqrt();
    if deviation.is_infinite() {
        return None;
    }
    // A tile that is not a number agrees with nothing.
    let z = (of_a.mean - of_b.mean) / deviation;
    Some(if z.is_nan() { f64::INFINITY } else { z })
}

/// An image, and the variance of a pixel over its mean, each channel: for light that is found rarely, in portions (a
/// compound Poisson process), that is the size of a portion.
struct Sampled<'a> {
    image: &'a Image,
    portion: [f64; 3],
}

/// A tile in one channel: its mean, and the variances of its mean.
struct TileMean {
    mean: f64,
    noise: f64,
    rounding: f64,
}

impl<'a> Sampled<'a> {
    fn new(image: &'a Image) -> Self {
        let portion = |c: usize| {
            let variances = image.standard_error.iter().flatten().map(|se| f64::from(se[c]).powi(2)).sum::<f64>();
            let light = image.mean.iter().map(|m| f64::from(m[c])).sum::<f64>();
            if variances > 0.0 && variances.is_finite() && light > 0.0 { variances / light } else { 0.0 }
        };
        Self { image, portion: std::array::from_fn(portion) }
    }

    fn tile(&self, pixels: &[usize], c: usize) -> TileMean {
        let n = pixels.len() as f64;
        let squares = |of: &[[f32; 3]]| pixels.iter().map(|&i| f64::from(of[i][c]).powi(2)).sum::<f64>();
        TileMean {
            mean: pixels.iter().map(|&i| f64::from(self.image.mean[i][c])).sum::<f64>() / n,
            noise: self.image.standard_error.as_deref().map_or(0.0, squares) / (n * n),
            rounding: squares(&self.image.mean) * f64::from(self.image.rounding).powi(2) / (n * n),
        }
    }

    /// The variance that the tile's mean of `n` pixels would have, were `mean` the truth. Where rare light was found too
    /// rarely, its variance was underestimated with it (to zero, where none was found at all): variance is proportional
    /// to the mean, with the portion of the tile, or of the whole image where the tile is black.
    fn noise_if_mean_were(&self, mean: f64, tile: &TileMean, n: f64, c: usize) -> f64 {
        let proportional = if tile.mean > 0.0 {
            tile.noise * mean / tile.mean
        } else if tile.mean == 0.0 {
            self.portion[c] * mean / n
        } else {
            0.0
        };
        tile.noise.max(proportional)
    }
}

fn pixel_at(image: &Image, index: usize) -> (u32, u32) {
    let w = image.crop.width().max(1);
    (image.crop.min.0 + index as u32 % w, image.crop.min.1 + index as u32 / w)
}

/// P(|Z| ≥ z) of a standard normal.
fn two_sided(z: f64) -> f64 {
    statrs::function::erf::erfc(z / std::f64::consts::SQRT_2)
}

/// P(X ≥ x) of χ² with so many degrees of freedom.
fn chi_square_tail(x: f64, degrees: usize) -> f64 {
    if x.is_infinite() {
        return 0.0;
    }
    ChiSquared::new(degrees as f64).map_or(1.0, |distribution| distribution.sf(x))
}

/// Šidák 1967: the chance that the smallest of `n` independent p-values is `p` or less.
fn sidak(p: f64, n: usize) -> f64 {
    // 1 − (1 − p)ⁿ without cancellation.
    -((n as f64) * (-p.min(1.0)).ln_1p()).exp_m1()
}

#[cfg(test)]
mod tests;
