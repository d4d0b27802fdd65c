//! Runs of tyndall against runs of another: how far the pictures agree, in figures that a table can hold.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::peers::image::Image;
use crate::peers::statistics::compare;

/// Pixels left out at each edge before Mitsuba's picture is compared: the reach of its widest filter.
const RIM: usize = 4;

/// What two sets of independent runs say of each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Comparison {
    /// Probability of pictures as different, if they are the same
    pub(crate) p: f64,
    /// The z of largest magnitude of a tile
    pub(crate) extreme_z: f64,
    /// First pixel of that tile in the picture, and channel
    pub(crate) extreme_at: (usize, usize, usize),
    /// Mean of the first set over that of the second with its standard error, red, green, blue; none where both are black
    pub(crate) ratio: [Option<(f64, f64)>; 3],
}

impl Comparison {
    /// Compares two sets of runs, without their rims.
    pub(crate) fn of(ours: &[Image], theirs: &[Image]) -> Result<Self> {
        let inner = |images: &[Image]| images.iter().map(without_rim).collect::<Vec<_>>();
        let found = compare(&inner(ours), &inner(theirs))?;
        let (x, y, channel) = found.extreme_at;
        Ok(Self {
            p: if found.tests == 0 { 1.0 } else { found.p() },
            extreme_z: found.extreme_z,
            extreme_at: (x + RIM, y + RIM, channel),
            ratio: found.ratio.map(|(ratio, error)| (ratio.is_finite() && error.is_finite()).then_some((ratio, error))),
        })
    }

    /// In one word, and in a sentence; `level` is the probability below which they differ.
    pub(crate) fn told(&self, level: f64) -> (&'static str, String) {
        let word = if self.p < level { "**differs**" } else { "agrees" };
        let (x, y, channel) = self.extreme_at;
        let ratio =
            self.ratio.map(|ratio| ratio.map_or("–".to_owned(), |(ratio, error)| format!("{ratio:.4}±{error:.4}")));
        let (z, channel) = (self.extreme_z, ["r", "g", "b"][channel]);
        (word, format!("means {}; largest z {z:.1} at ({x}, {y}) {channel}; p {:.1e}", ratio.join(" "), self.p))
    }
}

/// The picture without its outermost pixels, if anything is left then.
fn without_rim(image: &Image) -> Image {
    let (width, height) = (image.width.saturating_sub(2 * RIM), image.height.saturating_sub(2 * RIM));
    if width == 0 || height == 0 {
        return image.clone();
    }
    let row = |y: usize| image.pixels[(y + RIM) * image.width + RIM..][..width].iter().copied();
    Image { width, height, pixels: (0..height).flat_map(row).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rim_is_cut_and_the_middle_stays() {
        let pixels = (0..10 * 10).map(|index| [index as f32; 3]).collect();
        let inner = without_rim(&Image { width: 10, height: 10, pixels });
        assert_eq!((inner.width, inner.height), (2, 2));
        assert_eq!(inner.pixels.iter().map(|pixel| pixel[0]).collect::<Vec<_>>(), [44.0, 45.0, 54.0, 55.0]);
    }
}
