//! Do two renderers draw the same picture? Asked of independent runs of both, in three ways.
//!
//! The pictures are cut into tiles of 8 × 8 pixels. The mean of a tile over its pixels is nearly normal whatever the
//! pixels are, and its variance is known from the spread between the runs. For each tile and channel Welch's t is
//!
//! ```text
//! t = (ā − b̄) / √(s_a²/K_a + s_b²/K_b),   ν = (s_a²/K_a + s_b²/K_b)² / (s_a⁴/(K_a²(K_a−1)) + s_b⁴/(K_b²(K_b−1)))
//! ```
//!
//! and `z` is the normal deviate of the same tail probability, so that over the tiles of agreeing pictures the z's
//! are very nearly standard normal, however few the runs. Three tests see three kinds of error:
//! - the largest |z|: one wrong tile; corrected for the number of tiles by Šidák (1967),
//! - the sum of z²: many tiles a little wrong; χ² with as many degrees of freedom as tiles, per channel,
//! - the mean of the picture: all tiles a little wrong to the same side.
//!
//! Pictures with rare bright samples make z's that are smaller than normal, so the tests are on the safe side there. With
//! one exception: a tile where a renderer found none of the rare light has no spread, and claims to know that it is black.
//! Light that comes in portions of size p has the variance p times its mean, and p is known from the whole picture. If
//! both means were the weighted mean of both, as they are supposed to be, the variances would sum to
//! `(ā − b̄)(p_b/K_b − p_a/K_a)` more: that is added where it is positive, which is where the renderer with the larger
//! portions found less (a score test there, in place of Wald's). Tiles that neither renderer draws with noise, black ones
//! and the bare sky, are left out if they are the same up to rounding, and count in full if they are not.
//!
//! Source: Welch (1947), Biometrika 34; Šidák (1967), JASA 62; Subr and Arvo (2007), "Statistical hypothesis testing
//! for assessing Monte Carlo estimators".

use anyhow::{Result, ensure};
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

use super::image::Image;

/// Side of a tile in pixels.
const TILE: usize = 8;
/// Standard error that sums in single precision have in any case, relative to their value: two pictures of the same
/// constant sky need not have the same last bits.
const ROUNDING: f64 = 1e-6;

/// What a comparison of two sets of runs found. Channels are red, green, blue.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Agreement {
    /// Tiles times channels where there is something to compare
    pub(crate) tests: usize,
    /// The z of largest magnitude; positive where the first set is brighter
    pub(crate) extreme_z: f64,
    /// Where: first pixel of the tile (x, y), channel
    pub(crate) extreme_at: (usize, usize, usize),
    /// Probability of an extreme as large among so many z's, if the pictures agree
    pub(crate) extreme_p: f64,
    /// Probability of a sum of z² as large in the worst channel of three
    pub(crate) chi_square_p: f64,
    /// Mean of the first set over the mean of the second, with its standard error
    pub(crate) ratio: [(f64, f64); 3],
    /// Probability of means as different in the worst channel of three
    pub(crate) mean_p: f64,
}

impl Agreement {
    /// The smallest probability of the three tests, corrected for their number.
    pub(crate) fn p(&self) -> f64 {
        family_p(self.extreme_p.min(self.chi_square_p).min(self.mean_p), 3)
    }
}

/// Compares two sets of independent runs of the same picture.
pub(crate) fn compare(first: &[Image], second: &[Image]) -> Result<Agreement> {
    ensure!(first.len() > 1 && second.len() > 1, "a variance needs two runs of each");
    let size = (first[0].width, first[0].height);
    let same = |image: &Image| (image.width, image.height) == size && image.non_finite() == 0;
    ensure!(first.iter().chain(second).all(same), "pictures of different sizes, or with values that are not finite");

    let mut found = Agreement {
        tests: 0,
        extreme_z: 0.0,
        extreme_at: (0, 0, 0),
        extreme_p: 1.0,
        chi_square_p: 1.0,
        ratio: [(f64::NAN, f64::NAN); 3],
        mean_p: 1.0,
    };
    for channel in 0..3 {
        let portions = (portion(first, channel), portion(second, channel));
        let mut sum_of_squares = Sum::default();
        for y in (0..size.1).step_by(TILE) {
            for x in (0..size.0).step_by(TILE) {
                let Some(z) = tile_z(first, second, portions, x, y, channel) else { continue };
                sum_of_squares.add(z * z);
                if z.abs() > found.extreme_z.abs() {
                    (found.extreme_z, found.extreme_at) = (z, (x, y, channel));
                }
            }
        }
        found.tests += sum_of_squares.terms;
        found.chi_square_p = found.chi_square_p.min(family_p(sum_of_squares.chi_square_p(), 3));

        let whole = |image: &Image| window_mean(image, 0, 0, usize::MAX, channel);
        let (a, b) = (moments(first, whole), moments(second, whole));
        found.ratio[channel] = ratio(&a, &b);
        found.mean_p =
            found.mean_p.min(family_p(welch_z(&a, &b, portions, size.0 * size.1).map_or(1.0, two_sided_p), 3));
    }
    if found.tests > 0 {
        found.extreme_p = family_p(two_sided_p(found.extreme_z), found.tests);
    }
    Ok(found)
}

/// Mean squared error of one run, from the spread of all: the unbiased variance, meant over pixels and channels.
pub(crate) fn mean_squared_error(runs: &[Image]) -> f64 {
    let pixels = runs[0].pixels.len();
    let variances = (0..pixels).flat_map(|pixel| {
        (0..3).map(move |channel| moments(runs, |image| f64::from(image.pixels[pixel][channel])).variance)
    });
    variances.sum::<f64>() / (3 * pixels) as f64
}

/// How heavy the tails of pixel estimates are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tails {
    /// Excess kurtosis, over pixels and channels: `Σ κ₄ / Σ σ⁴`, each estimated without bias from the spread of the runs (k-statistics:
    /// Fisher 1930). 0 for a normal distribution; that of a mean of N samples is 1/N of that of one
    pub(crate) excess_kurtosis: f64,
    /// How far the largest estimate is above the mean of its pixel, in root mean squared errors of the picture
    pub(crate) largest: f64,
}

/// The tails of four runs or more.
pub(crate) fn tails(runs: &[Image]) -> Tails {
    let count = runs.len() as f64;
    let (mut fourth, mut squares, mut largest) = (0.0, 0.0, 0.0f64);
    for (pixel, channel) in (0..runs[0].pixels.len()).flat_map(|pixel| (0..3).map(move |channel| (pixel, channel))) {
        let value = |image: &Image| f64::from(image.pixels[pixel][channel]);
        let Moments { mean, variance: k2, .. } = moments(runs, value);
        let away = || runs.iter().map(|image| value(image) - mean);
        let (m2, m4) = (k2 * (count - 1.0) / count, away().map(|d| d.powi(4)).sum::<f64>() / count);
        let k4 = count * count * ((count + 1.0) * m4 - 3.0 * (count - 1.0) * m2 * m2)
            / ((count - 1.0) * (count - 2.0) * (count - 3.0));
        fourth += k4;
        squares += (count - 1.0) / (count + 1.0) * (k2 * k2 - k4 / count);
        largest = away().fold(largest, f64::max);
    }
    Tails { excess_kurtosis: fourth / squares, largest: largest / mean_squared_error(runs).sqrt() }
}

/// The probability that the smallest of `count` independent uniform values is below `p`: `1 − (1 − p)^count`. Šidák's
/// correction of a probability, as [`testkit::sidak`] is of a level.
fn family_p(p: f64, count: usize) -> f64 {
    -(count as f64 * (-p).ln_1p()).exp_m1()
}

/// The middle of the values; the mean of the two middle ones if their number is even.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { f64::midpoint(sorted[middle - 1], sorted[middle]) }
}

/// The z of one tile; none where there is nothing to compare.
fn tile_z(first: &[Image], second: &[Image], portions: (f64, f64), x: usize, y: usize, channel: usize) -> Option<f64> {
    let mean = |image: &Image| window_mean(image, x, y, TILE, channel);
    let pixels = TILE.min(first[0].width - x) * TILE.min(first[0].height - y);
    welch_z(&moments(first, mean), &moments(second, mean), portions, pixels)
}

/// The size of the portions that light comes in: variance of a pixel over its mean, both summed over the picture.
fn portion(runs: &[Image], channel: usize) -> f64 {
    let (mut variance, mut mean) = (0.0, 0.0);
    for pixel in 0..runs[0].pixels.len() {
        let moments = moments(runs, |image| f64::from(image.pixels[pixel][channel]));
        variance += moments.variance;
        mean += moments.mean;
    }
    if mean > 0.0 { variance / mean } else { 0.0 }
}

/// Mean and unbiased variance of one number of each run.
struct Moments {
    mean: f64,
    variance: f64,
    runs: f64,
}

fn moments(runs: &[Image], number: impl Fn(&Image) -> f64) -> Moments {
    let values: Vec<f64> = runs.iter().map(number).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Moments { mean, variance, runs: count }
}

/// Mean of one channel over a square of pixels, cut at the edges of the picture.
fn window_mean(image: &Image, x: usize, y: usize, side: usize, channel: usize) -> f64 {
    let columns = x..x.saturating_add(side).min(image.width);
    let rows = y..y.saturating_add(side).min(image.height);
    let count = columns.len() * rows.len();
    let sum: f64 = rows
        .flat_map(|row| &image.pixels[row * image.width..][columns.clone()])
        .map(|pixel| f64::from(pixel[channel]))
        .sum();
    sum / count as f64
}

/// Welch's t as a normal deviate; none where both are the same constant, up to rounding. `unseen` is the
/// variance that the spread of the runs does not show.
fn welch_z(a: &Moments, b: &Moments, portions: (f64, f64), pixels: usize) -> Option<f64> {
    let (va, vb) = (a.variance / a.runs, b.variance / b.runs);
    let unseen = ((a.mean - b.mean) * (portions.1 / b.runs - portions.0 / a.runs) / pixels as f64).max(0.0);
    let rounding = (ROUNDING * a.mean.abs().max(b.mean.abs())).powi(2);
    if va + vb <= rounding && (a.mean - b.mean).powi(2) <= 9.0 * rounding {
        return None;
    }
    let variance = va + vb + rounding + unseen;
    let freedom = variance.powi(2) / (va * va / (a.runs - 1.0) + vb * vb / (b.runs - 1.0));
    Some(normal_deviate((a.mean - b.mean) / variance.sqrt(), freedom.min(1e9)))
}

/// The normal deviate with the tail probability of Student's t. Beyond 37 no double holds the probability.
fn normal_deviate(t: f64, freedom: f64) -> f64 {
    let student = StudentsT::new(0.0, 1.0, freedom).expect("at least one degree of freedom");
    let tail = student.cdf(-t.abs()).max(1e-300);
    -Normal::standard().inverse_cdf(tail) * t.signum()
}

fn two_sided_p(z: f64) -> f64 {
    2.0 * Normal::standard().cdf(-z.abs())
}

/// Ratio of two means with its standard error, to first order.
fn ratio(a: &Moments, b: &Moments) -> (f64, f64) {
    let relative_variance = |m: &Moments| m.variance / m.runs / (m.mean * m.mean);
    let ratio = a.mean / b.mean;
    (ratio, ratio.abs() * (relative_variance(a) + relative_variance(b)).sqrt())
}

/// A sum of squared standard normal numbers.
#[derive(Default)]
struct Sum {
    terms: usize,
    value: f64,
}

impl Sum {
    fn add(&mut self, square: f64) {
        self.terms += 1;
        self.value += square;
    }

    fn chi_square_p(&self) -> f64 {
        ChiSquared::new(self.terms as f64).map_or(1.0, |distribution| distribution.sf(self.value))
    }
}

#[cfg(test)]
mod tests {
    use testkit::Stream;

    use super::*;

    /// Runs of 128² pixels with exponential noise of mean `mean(x, y)`: the standard deviation of a pixel is its mean.
    fn noisy_runs(seed: u64, runs: usize, mean: impl Fn(usize, usize) -> f64) -> Vec<Image> {
        let mut random = Stream::new(seed);
        let mut image = || {
            let mut pixel = |index: usize| mean(index % 128, index / 128) * -(1.0 - random.next_f64()).ln();
            let pixels = (0..128 * 128).map(|index| [(); 3].map(|()| pixel(index) as f32)).collect();
            Image { width: 128, height: 128, pixels }
        };
        (0..runs).map(|_| image()).collect()
    }

    /// 256 tiles in 3 channels of 40 pairs give 30,720 z's. Were they standard normal, their mean would be 0 ± 0.0057,
    /// their mean square 1 ± 0.0081, and 0.27 % ± 0.03 % would lie beyond 3. Bounds are at four standard errors.
    ///
    /// Welch's ν is an estimate, and a low one: with n = 10 runs of equal variance v₁, v₂ it is
    /// 2(n−1)(1 − ((v₁−v₂)/(v₁+v₂))²), on average 2(n−1)(1 − 1/n) = 16.2 in place of 18. As z² ≈ t²(1 − (t²+1)/2ν), the
    /// mean square is too small by (3+1)/2 · (1/16.2 − 1/18) = 0.012: the test is that much on the safe side.
    /// Taken as normal, the t's would have a mean square of 18/16 = 1.125.
    #[test]
    fn the_zs_of_agreeing_pictures_are_standard_normal() {
        let mut zs = Vec::new();
        for pair in 0..40 {
            let (a, b) = (noisy_runs(2 * pair, 10, |_, _| 1.0), noisy_runs(2 * pair + 1, 10, |_, _| 1.0));
            for channel in 0..3 {
                let portions = (portion(&a, channel), portion(&b, channel));
                for tile in 0..256 {
                    zs.extend(tile_z(&a, &b, portions, tile % 16 * 8, tile / 16 * 8, channel));
                }
            }
        }
        let count = zs.len() as f64;
        let mean = zs.iter().sum::<f64>() / count;
        let square = zs.iter().map(|z| z * z).sum::<f64>() / count;
        let beyond = zs.iter().filter(|z| z.abs() > 3.0).count() as f64 / count;
        assert_eq!(zs.len(), 40 * 3 * 256);
        assert!(mean.abs() < 4.0 * 0.0057, "mean {mean}");
        assert!((square - 0.988).abs() < 4.0 * 0.0081, "mean square {square}");
        assert!((beyond - 0.0027).abs() < 4.0 * 0.0003, "beyond three {beyond}");
    }

    #[test]
    fn agreeing_pictures_pass() {
        let found = compare(&noisy_runs(1, 8, |_, _| 2.0), &noisy_runs(2, 8, |_, _| 2.0)).unwrap();
        assert!(found.p() > 0.01, "{found:?}");
        assert_eq!(found.tests, 768);
    }

    /// The mean of 8 runs of 128² pixels has a standard error of 1/√(8·128²) = 0.28 %, a difference of two 0.39 %; a
    /// shift of 1 % is 2.6 of those in each channel. 64 runs make it 7.2.
    #[test]
    fn a_shift_of_one_percent_is_found_by_the_mean() {
        let found = compare(&noisy_runs(3, 64, |_, _| 1.01), &noisy_runs(4, 64, |_, _| 1.0)).unwrap();
        assert!(found.mean_p < 1e-6, "{found:?}");
        let (ratio, error) = found.ratio[1];
        assert!((ratio - 1.01).abs() < 4.0 * error && error < 0.002, "{ratio} ± {error}");
    }

    /// A tile's mean over 8 runs has a standard error of 1/√(8·64) = 4.4 %, a difference 6.3 %: 50 % is 8 of those.
    #[test]
    fn one_wrong_tile_is_found_by_the_extreme_and_named() {
        let wrong = |x: usize, y: usize| if (16..24).contains(&x) && (40..48).contains(&y) { 1.5 } else { 1.0 };
        let found = compare(&noisy_runs(5, 8, wrong), &noisy_runs(6, 8, |_, _| 1.0)).unwrap();
        assert!(found.extreme_p < 1e-4 && found.extreme_z > 0.0, "{found:?}");
        assert_eq!((found.extreme_at.0, found.extreme_at.1), (16, 40));
    }

    /// Tiles wrong by ±8 % in a chequered pattern: the mean is right, no tile stands out (1.3 standard errors), but
    /// each of 256 adds 1.6 to the expected square, and the sum is 256·2.6 where 256 ± 23 is expected.
    #[test]
    fn a_pattern_of_small_errors_is_found_by_chi_square() {
        let chequered = |x: usize, y: usize| if (x / 8 + y / 8).is_multiple_of(2) { 1.08 } else { 0.92 };
        let found = compare(&noisy_runs(7, 8, chequered), &noisy_runs(8, 8, |_, _| 1.0)).unwrap();
        assert!(found.chi_square_p < 1e-6 && found.mean_p > 1e-3, "{found:?}");
    }

    /// Light of mean 0.001 in portions of 10 a run and pixel: one in 10,000. A tile of 64 pixels gets 0.05 of them in 8 runs,
    /// nearly all see nothing. The other renderer draws 0.001 with little noise: Wald's test would be certain of a
    /// difference in every tile that is black.
    #[test]
    fn light_that_is_found_rarely_is_no_disagreement() {
        let mut random = Stream::new(11);
        let mut rare = || if random.next_f64() < 1e-4 { 10.0 } else { 0.0 };
        let image = |value: &mut dyn FnMut() -> f32| {
            let pixels = (0..128 * 128).map(|_| [(); 3].map(|()| value())).collect();
            Image { width: 128, height: 128, pixels }
        };
        let rarely: Vec<Image> = (0..8).map(|_| image(&mut rare)).collect();
        let smooth = noisy_runs(12, 8, |_, _| 0.001);
        let found = compare(&rarely, &smooth).unwrap();
        assert!(found.p() > 0.01, "{found:?}");
        assert!(compare(&noisy_runs(13, 8, |_, _| 0.0), &smooth).unwrap().p() < 1e-6, "black is a difference");
    }

    #[test]
    fn constant_pictures_agree_up_to_rounding() {
        let constant = |value: f32| vec![Image { width: 8, height: 8, pixels: vec![[value; 3]; 64] }; 2];
        let black = compare(&constant(0.0), &constant(0.0)).unwrap();
        assert_eq!((black.tests, black.p()), (0, 1.0));
        assert!(compare(&constant(1.0), &constant(1.0 + f32::EPSILON)).unwrap().p() > 0.9);
        assert!(compare(&constant(1.0), &constant(1.001)).unwrap().p() < 1e-6);
    }

    /// The variance of an exponential number of mean 2 is 4; over 3·128² pixels of 8 runs it is known to 1 %.
    #[test]
    fn the_error_of_a_run_is_the_spread_between_runs() {
        let error = mean_squared_error(&noisy_runs(9, 8, |_, _| 2.0));
        assert!((error / 4.0 - 1.0).abs() < 0.03, "{error}");
    }

    /// That of an exponential number is 6; a mean of ten has 0.6. 8 runs of 128² pixels tell the one to 0.2, the other to 0.03: bounds
    /// are at three standard errors.
    #[test]
    fn tails_are_those_of_the_distribution() {
        let found = tails(&noisy_runs(10, 8, |_, _| 2.0));
        assert!((found.excess_kurtosis / 6.0 - 1.0).abs() < 0.1, "{found:?}");
        let many = noisy_runs(11, 80, |_, _| 2.0);
        let means: Vec<Image> = many.chunks(10).map(mean_of).collect();
        let found = tails(&means);
        assert!((found.excess_kurtosis - 0.6).abs() < 0.1 && found.largest > 4.0, "{found:?}");
    }

    fn mean_of(runs: &[Image]) -> Image {
        let mut mean = runs[0].clone();
        for (i, pixel) in mean.pixels.iter_mut().enumerate() {
            *pixel =
                [0, 1, 2].map(|channel| runs.iter().map(|run| run.pixels[i][channel]).sum::<f32>() / runs.len() as f32);
        }
        mean
    }

    #[test]
    fn a_family_of_tests_at_its_level_complains_as_rarely_as_one() {
        assert!((family_p(testkit::sidak(0.01, 11), 11) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), 2.5);
    }
}
