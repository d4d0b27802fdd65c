//! Which pixel gets how many samples.
//!
//! For a given number of samples the mean squared error of an image, `Σ V_i / N_i` over its pixels, is least with
//! `N_i ∝ √V_i`, where `V_i` is the variance of a sample. After a first look of [`FIRST_LOOK`] samples a pixel,
//! [`Allocation::ByError`] gives pixel `i` samples in proportion to
//!
//! ```text
//! w_i = Σ_j s_j / |i − j|²  /  Σ_j 1 / |i − j|²        [W·m⁻²·sr⁻¹]
//! ```
//!
//! `s_j` being the standard deviation of the samples of pixel `j`, over the pixels around `i` without `i` itself.
//!
//! **Unbiased.** What a pixel has found has no say in how many samples it gets, so the mean of them all is unbiased, the first
//! included. (Were it otherwise, a dark pixel whose first samples missed a rare light would be left alone, and one that met it
//! would be given more: on average too dark.) For the same reason there is one look, and no second: what its neighbours found with
//! their later samples would depend on how many they got, and so on this pixel.
//!
//! **Safe.** The first look can miss what is rare. No pixel gets less than [`LEAST`] of what it would get evenly, so its standard
//! error is at most `1/√LEAST = 1.41` times as large; and none more than [`MOST`]. Between them the shares are `k w_i`, with the `k`
//! that makes their mean 1.

use crate::film::{Crop, Film, Pixel};

/// Samples a pixel before they are shared out.
pub(super) const FIRST_LOOK: u32 = 8;
/// Least and most samples of a pixel, relative to the mean of all \[1\].
const LEAST: f64 = 0.5;
/// See [`LEAST`].
const MOST: f64 = 16.0;
/// How far around a pixel is looked [pixels].
const RADIUS: u32 = 3;

/// How samples are shared out among the pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Allocation {
    /// To each as many.
    #[default]
    Even,
    /// After a first look, more to those around which errors are large. A crop of such an image is not the image of the
    /// crop: its samples are shared out within it.
    ByError,
}

/// How many samples each pixel is to get.
#[derive(Debug)]
pub(super) struct Plan {
    /// By pixel, as they lie on a film, relative to the mean of all; `None` if all get as many \[1\].
    shares: Option<Vec<f64>>,
    /// The level at the end: samples of a pixel whose share is 1.
    pub(super) end: u32,
    /// Samples of all pixels at the end.
    pub(super) total: u64,
}

impl Plan {
    /// `spp` for each of so many pixels.
    pub(super) fn even(pixels: usize, spp: u32) -> Self {
        Self { shares: None, end: spp, total: pixels as u64 * u64::from(spp) }
    }

    /// A mean of `spp` for each pixel, by what a first look found.
    pub(super) fn by_error(film: &Film, spp: u32) -> Self {
        let even = Self::even(film.pixels.len(), spp);
        let mut w = deviations_around(film);
        let mean = w.iter().sum::<f64>() / w.len() as f64;
        if !(mean > 0.0 && mean.is_finite()) {
            return even;
        }
        for w in &mut w {
            *w /= mean;
        }
        let shares = shares(&w);
        let end = level_of(&shares, even.total);
        Self { end, total: sum(&shares, end), shares: Some(shares) }
    }

    /// How many samples a pixel has got at a level.
    pub(super) fn samples(&self, pixel: usize, level: u32) -> u32 {
        self.shares.as_ref().map_or(level, |shares| samples(shares[pixel], level))
    }

    /// The level at which the next picture is shown. A first one comes at once, and later ones cost little to show; where pixels get
    /// up to [`MOST`] times as many samples as others, a tile must still hold them.
    pub(super) fn next_level(&self, level: u32) -> u32 {
        let step = if self.shares.is_none() { 32 } else { FIRST_LOOK };
        level.saturating_add(level.clamp(1, step)).min(self.end)
    }
}

/// How many samples a pixel with this share has got at a level.
fn samples(share: f64, level: u32) -> u32 {
    if level <= FIRST_LOOK { level } else { ((share * f64::from(level)) as u32).max(FIRST_LOOK) }
}

/// Those of all pixels.
fn sum(shares: &[f64], level: u32) -> u64 {
    shares.iter().map(|share| u64::from(samples(*share, level))).sum()
}

/// The highest level at which all pixels together have got no more than `total` samples.
fn level_of(shares: &[f64], total: u64) -> u32 {
    let (mut low, mut high) = (FIRST_LOOK, u32::MAX);
    while low < high {
        let middle = high - (high - low) / 2;
        if sum(shares, middle) <= total { low = middle } else { high = middle - 1 }
    }
    low
}

/// `k w` between [`LEAST`] and [`MOST`], with the `k` that makes their mean 1, by bisection: as more are at the least the others
/// have less.
fn shares(w: &[f64]) -> Vec<f64> {
    let share = |k: f64, w: f64| (k * w).clamp(LEAST, MOST);
    let (mut low, mut high) = (0.0, MOST);
    for _ in 0..f64::MANTISSA_DIGITS {
        let k = 0.5 * (low + high);
        let mean = w.iter().map(|w| share(k, *w)).sum::<f64>() / w.len() as f64;
        if mean <= 1.0 { low = k } else { high = k }
    }
    w.iter().map(|w| share(low, *w)).collect()
}

/// `w_i` of the manual, by pixel; 0 for a pixel that has no other beside it [W·m⁻²·sr⁻¹].
fn deviations_around(film: &Film) -> Vec<f64> {
    let deviations: Vec<f64> = film.pixels.iter().map(deviation).collect();
    film.crop.pixels().map(|pixel| mean_around(film.crop, &deviations, pixel)).collect()
}

/// Standard deviation of the samples of a pixel, all channels together: `√(n Σ_c e_c²)`, `e` being the standard error of the mean
/// of `n` [W·m⁻²·sr⁻¹].
fn deviation(pixel: &Pixel) -> f64 {
    let squares = pixel.standard_error().map(|error| f64::from(error).powi(2));
    (pixel.count as f64 * squares.iter().sum::<f64>()).sqrt()
}

fn mean_around(crop: Crop, deviations: &[f64], (x, y): (u32, u32)) -> f64 {
    let near =
        Crop { min: (x.saturating_sub(RADIUS), y.saturating_sub(RADIUS)), max: (x + RADIUS + 1, y + RADIUS + 1) };
    let (mut sum, mut weights) = (0.0, 0.0);
    for other in crop.common(near).pixels().filter(|other| *other != (x, y)) {
        let away = f64::from(other.0.abs_diff(x)).powi(2) + f64::from(other.1.abs_diff(y)).powi(2);
        sum += deviations[crop.index(other)] / away;
        weights += 1.0 / away;
    }
    if weights > 0.0 { sum / weights } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film on which the pixels of column `x` have samples of standard deviation `deviation(x)`.
    fn film(width: u32, height: u32, deviation: impl Fn(u32) -> f64) -> Film {
        let mut film = Film::new(width, height, Crop::full(width, height));
        for (pixel, (x, _)) in film.pixels.iter_mut().zip(film.crop.pixels()) {
            for sign in [1.0, -1.0].repeat(FIRST_LOOK as usize / 2) {
                pixel.add([sign * deviation(x) as f32, 0.0, 0.0]);
            }
        }
        film
    }

    #[test]
    fn what_a_pixel_has_found_has_no_say_in_how_many_samples_it_gets() {
        let before = film(9, 9, f64::from);
        let mut after = before.clone();
        after.pixels[4 * 9 + 4].add([1e6, 0.0, 0.0]);
        let (before, after) = (deviations_around(&before), deviations_around(&after));
        assert_eq!(before[4 * 9 + 4], after[4 * 9 + 4]);
        assert!(after[4 * 9 + 5] > 100.0 * before[4 * 9 + 5], "its neighbours do get more");
    }

    /// Left of the middle samples deviate by 1, right of it by 3: three times as many samples there, away from the border
    /// between the two.
    #[test]
    fn samples_follow_the_standard_deviation() {
        let plan = Plan::by_error(&film(40, 8, |x| if x < 20 { 1.0 } else { 3.0 }), 1000);
        let [left, right] = [5, 35].map(|x| f64::from(plan.samples(3 * 40 + x, plan.end)));
        assert!((right / left - 3.0).abs() < 0.01, "{left} {right}");
    }

    #[test]
    fn the_mean_number_of_samples_is_the_one_asked_for() {
        for spp in [9, 16, 64, 1000] {
            let film = film(40, 8, |x| f64::from(x * x));
            let plan = Plan::by_error(&film, spp);
            let mean = plan.total as f64 / 320.0;
            assert!(mean <= f64::from(spp) && mean > f64::from(spp) - 2.0, "{mean} of {spp}");
        }
    }

    #[test]
    fn no_pixel_gets_less_than_half_or_its_first_look() {
        for (spp, half) in [(10, FIRST_LOOK), (100, 50), (1000, 500)] {
            let plan = Plan::by_error(&film(40, 40, |x| if x == 20 { 1e3 } else { 1.0 }), spp);
            let samples: Vec<u32> = (0..1600).map(|pixel| plan.samples(pixel, plan.end)).collect();
            assert_eq!(*samples.iter().min().unwrap(), half, "of {spp}");
        }
    }

    #[test]
    fn where_nothing_deviates_samples_are_even() {
        for width in [1, 8] {
            let plan = Plan::by_error(&film(width, 1, |_| 0.0), 100);
            assert!((0..width as usize).all(|pixel| plan.samples(pixel, plan.end) == 100));
        }
    }

    #[test]
    fn an_endless_render_has_an_end_that_is_a_number() {
        let plan = Plan::by_error(&film(40, 8, f64::from), u32::MAX);
        assert!(plan.end > 1 << 30 && plan.total <= 320 * u64::from(u32::MAX));
    }
}
