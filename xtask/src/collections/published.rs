//! The picture that an author published beside a scene, against ours.
//!
//! Nobody knows the noise of a published image, its renderer, or, for a PNG, what was done to its tones. So this is no
//! test: both pictures are meant over the same cells, and what is told is the ratio of the means and the correlation of
//! the cells' luminances. A picture that was clipped at white (PNG, JPEG) is compared with ours clipped at white.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::peers::image::Image;

/// Cells along each side.
const CELLS: usize = 16;
/// Means and correlation of pictures that are called alike: the ratio within this of 1 …
const RATIO: f64 = 0.05;
/// … and the correlation above this.
const CORRELATION: f64 = 0.98;

/// How near a picture is to the published one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Likeness {
    /// Our mean over the published one, red, green, blue
    pub(crate) ratio: [f64; 3],
    /// Of the cells' luminances, −1 to 1
    pub(crate) correlation: f64,
}

impl Likeness {
    /// Compares two pictures of perhaps different sizes.
    pub(crate) fn of(ours: &Image, theirs: &Image, is_clipped: bool) -> Self {
        let (ours, theirs) = (cells(ours, is_clipped), cells(theirs, is_clipped));
        let mean = |cells: &[[f64; 3]], channel: usize| cells.iter().map(|cell| cell[channel]).sum::<f64>();
        let ratio = [0, 1, 2].map(|channel| mean(&ours, channel) / mean(&theirs, channel));
        let luminances = |cells: &[[f64; 3]]| cells.iter().map(luminance).collect::<Vec<_>>();
        Self { ratio, correlation: correlation(&luminances(&ours), &luminances(&theirs)) }
    }

    /// Whether the pictures are called alike.
    pub(crate) fn is_near(&self) -> bool {
        self.ratio.iter().all(|ratio| (ratio - 1.0).abs() < RATIO) && self.correlation > CORRELATION
    }
}

/// Whether a file holds numbers only up to white.
pub(crate) fn is_clipped(file: &Path) -> bool {
    !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr") || ending.eq_ignore_ascii_case("pfm"))
}

fn luminance(&[r, g, b]: &[f64; 3]) -> f64 {
    0.212_671 * r + 0.715_160 * g + 0.072_169 * b
}

/// Means over equal cells, row by row.
fn cells(image: &Image, is_clipped: bool) -> Vec<[f64; 3]> {
    let mut sums = vec![([0.0; 3], 0.0); CELLS * CELLS];
    for (index, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (index % image.width, index / image.width);
        let (sum, count) = &mut sums[y * CELLS / image.height * CELLS + x * CELLS / image.width];
        *count += 1.0;
        for (sum, &value) in sum.iter_mut().zip(pixel) {
            *sum += f64::from(if is_clipped { value.min(1.0) } else { value });
        }
    }
    sums.into_iter().map(|(sum, count)| sum.map(|sum| sum / f64::max(count, 1.0))).collect()
}

/// Pearson's; 1 where both are constant, 0 where a picture is not finite.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let sum = |of: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| of(x - mean_a, y - mean_b)).sum::<f64>();
    let (xy, xx, yy) = (sum(&|x, y| x * y), sum(&|x, _| x * x), sum(&|_, y| y * y));
    let found = if xx == 0.0 && yy == 0.0 { 1.0 } else { xy / (xx * yy).sqrt() };
    if found.is_finite() { found } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope(width: usize, height: usize, scale: f32) -> Image {
        let pixel = |index: usize| [scale * (index % width) as f32 / width as f32; 3];
        Image { width, height, pixels: (0..width * height).map(pixel).collect() }
    }

    /// Cell i of 16 holds the values from i/16 on: a coarse picture and a fine one differ in them by half a step.
    #[test]
    fn the_same_picture_in_two_sizes_is_near() {
        let found = Likeness::of(&slope(64, 32, 1.0), &slope(128, 64, 1.0), false);
        assert!(found.is_near() && (found.ratio[0] - 1.0).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn a_brighter_picture_and_a_mirrored_one_are_not_near() {
        assert!(!Likeness::of(&slope(64, 64, 1.1), &slope(64, 64, 1.0), false).is_near());
        let mut mirrored = slope(64, 64, 1.0);
        mirrored.pixels.reverse();
        assert!((Likeness::of(&mirrored, &slope(64, 64, 1.0), false).correlation + 1.0).abs() < 1e-6);
    }

    #[test]
    fn what_a_png_cannot_hold_is_not_held_against_us() {
        let mut clipped = slope(64, 64, 4.0);
        clipped.pixels.iter_mut().flatten().for_each(|value| *value = value.min(1.0));
        assert!(Likeness::of(&slope(64, 64, 4.0), &clipped, true).is_near());
        assert!(is_clipped(Path::new("a.PNG")) && !is_clipped(Path::new("a.exr")));
    }
}
