//! What the projector throws.

use std::{f32::consts::TAU, sync::Arc};

use tyndall::texture::{Grey, ImageTexture, Interpolation, Mapping2, Picture, Texture, Wrap};

use crate::world::{SetupError, within};

/// Pixels of a projector on a side at most.
const MOST_PIXELS: u32 = 8192;
/// Images of an experiment at most.
const MOST_IMAGES: u32 = 1024;

/// A family of patterns, half of whose pixels are lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// Squares, shifted along both axes.
    Checkerboard {
        /// Side of a square [pixels of the projector].
        square: u32,
        /// From one image to the next [pixels of the projector].
        step: u32,
        /// How many along each axis.
        shifts: u32,
    },
    /// Waves along the rows, `(1 + cos)/2`.
    Waves {
        /// Length of a wave [pixels of the projector].
        period: u32,
        /// How many phases, evenly.
        phases: u32,
    },
}

impl Pattern {
    /// The checkerboard of the paper: squares of 8 pixels, five shifts by 3 along each axis.
    pub const PAPER: Self = Self::Checkerboard { square: 8, step: 3, shifts: 5 };

    /// The checkerboard of the paper with squares of another side [pixels].
    pub fn checkerboard(square: u32) -> Self {
        let step = square.saturating_mul(3).div_ceil(8).max(1);
        // As many as come round, but no more than the paper has.
        Self::Checkerboard { square, step, shifts: square.max(1).saturating_mul(2).div_ceil(step).min(5) }
    }

    /// How much of the projector a pixel may cover, so that it is wholly lit in some image and wholly dark in another
    /// [pixels of the projector]: a square less the greatest gap between shifts, round the two squares in which the pattern
    /// repeats itself. Of waves an eighth, over which a pixel sees 0.974 of their amplitude.
    pub fn widest_pixel(&self) -> f64 {
        match *self {
            Self::Checkerboard { square, step, shifts } => {
                let mut stops: Vec<u32> = (0..shifts).map(|n| n * step % (2 * square)).collect();
                stops.sort_unstable();
                let round = stops.first().map(|first| first + 2 * square);
                let gaps = stops.iter().zip(stops.iter().skip(1).chain(&round)).map(|(a, b)| b - a);
                f64::from(square.saturating_sub(gaps.max().unwrap_or(0)))
            }
            Self::Waves { period, .. } => f64::from(period) / 8.0,
        }
    }

    /// How many images there are.
    pub fn count(&self) -> u32 {
        match *self {
            Self::Checkerboard { shifts, .. } => shifts.saturating_mul(shifts),
            Self::Waves { phases, .. } => phases,
        }
    }

    /// The phase of an image of waves; `None` of a checkerboard.
    pub(super) fn phase(&self, number: u32) -> Option<f32> {
        match *self {
            Self::Checkerboard { .. } => None,
            Self::Waves { phases, .. } => Some(TAU * number as f32 / phases as f32),
        }
    }

    /// How bright a pixel is in an image, 0 to 1.
    fn brightness(&self, number: u32, [x, y]: [u32; 2]) -> f32 {
        match *self {
            Self::Checkerboard { square, step, shifts } => {
                let cell = |at: u32, shift: u32| (at + shift * step) / square;
                let cells = cell(x, number % shifts) + cell(y, number / shifts);
                if cells.is_multiple_of(2) { 1.0 } else { 0.0 }
            }
            Self::Waves { period, .. } => {
                let phase = self.phase(number).unwrap_or(0.0);
                let place = (x % period) as f32 + 0.5;
                0.5 + 0.5 * (TAU * place / period as f32 + phase).cos()
            }
        }
    }

    /// Checks what it says.
    ///
    /// # Errors
    /// Sizes of nothing or beyond reason, shifts that leave some pixels always lit or always dark.
    pub fn check(&self) -> Result<(), SetupError> {
        let sizes = |what, n: u32| {
            within(what, f64::from(n), "between 1 and 8192 pixels", |n| (1.0..=f64::from(MOST_PIXELS)).contains(&n))
        };
        match *self {
            Self::Checkerboard { square, step, shifts } => {
                sizes("the side of a square", square)?;
                sizes("the step of a shift", step)?;
                within("the number of shifts along an axis", f64::from(shifts), "between 2 and 32", |n| {
                    (2.0..=32.0).contains(&n)
                })?;
                within("the step of a shift", f64::from(step), "at most a square", |n| n <= f64::from(square))?;
                let way = f64::from(step * (shifts - 1));
                within("the way of all shifts", way, "a square at least, or some pixels stay lit or dark", |way| {
                    way >= f64::from(square)
                })
            }
            Self::Waves { period, phases } => {
                sizes("the period of waves", period)?;
                within("the period of waves", f64::from(period), "at least 3 pixels", |n| n >= 3.0)?;
                within("the number of phases", f64::from(phases), "between 3 and 1024", |n| {
                    (3.0..=f64::from(MOST_IMAGES)).contains(&n)
                })
            }
        }
    }
}

/// A projector's patterns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Which.
    pub pattern: Pattern,
    /// Its columns and rows [pixels].
    pub pixels: [u32; 2],
    /// How bright dark pixels are, of the brightness of lit ones \[1\].
    pub dark: f32,
}

impl Projection {
    /// Patterns of a projector.
    ///
    /// # Errors
    /// Sizes of nothing or beyond reason, dark pixels as bright as lit ones.
    pub fn new(pattern: Pattern, pixels: [u32; 2], dark: f32) -> Result<Self, SetupError> {
        pattern.check()?;
        within("the brightness of dark pixels", f64::from(dark), "at least 0 and below 1", |b| {
            (0.0..1.0).contains(&b)
        })?;
        for n in pixels {
            within("the number of a projector's pixels", f64::from(n), "between 1 and 8192 along each axis", |n| {
                (1.0..=f64::from(MOST_PIXELS)).contains(&n)
            })?;
        }
        Ok(Self { pattern, pixels, dark })
    }

    /// An image as a slide.
    pub(super) fn slide(&self, number: u32) -> Texture {
        let [width, height] = self.pixels;
        let pixel = |x, y| self.dark + (1.0 - self.dark) * self.pattern.brightness(number, [x, y]);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [pixel(x, y); 3])).collect();
        let interpolation = match self.pattern {
            Pattern::Checkerboard { .. } => Interpolation::Nearest,
            Pattern::Waves { .. } => Interpolation::Bilinear,
        };
        Texture::Image(ImageTexture {
            picture: Arc::new(Picture { width, height, pixels }),
            mapping: Mapping2::UV,
            wrap: Wrap::Clamp,
            interpolation,
            scale: 1.0,
            invert: false,
            grey: Grey::Mean,
            least: 0.0,
            most: f32::MAX,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a row of pixels as wide as they may be, and wherever they begin, each is wholly lit in some image and wholly dark in
    /// another; not so in a row of pixels that are wider.
    #[test]
    fn pixels_as_wide_as_they_may_be_are_wholly_lit_once_and_wholly_dark_once() {
        for square in [4, 8, 16, 64] {
            let pattern = Pattern::checkerboard(square);
            let Pattern::Checkerboard { step, shifts, .. } = pattern else { panic!("a checkerboard") };
            let works = |width: f64| {
                (0..16 * square).map(|i| f64::from(i) / 8.0).all(|from| {
                    let cell = |at: f64, n: u32| ((at + f64::from(n * step)) / f64::from(square)).floor() as u32 % 2;
                    let whole = |n: &u32| cell(from, *n) == cell(from + width - 1e-9, *n);
                    let seen: Vec<u32> = (0..shifts).filter(whole).map(|n| cell(from, n)).collect();
                    seen.contains(&0) && seen.contains(&1)
                })
            };
            let widest = pattern.widest_pixel();
            assert!(widest > 0.0 && works(widest) && !works(widest + 0.25), "{square}: {widest}");
        }
    }

    /// Each pixel is lit in some shift and dark in another, for every size; and over all shifts nearly half of the time.
    #[test]
    fn every_pixel_is_lit_once_and_dark_once() {
        for square in [1, 2, 3, 4, 5, 8, 13, 16, 64] {
            let pattern = Pattern::checkerboard(square);
            for at in [[0, 0], [7, 3], [100, 31], [63, 64]] {
                let lit = (0..pattern.count()).filter(|&n| pattern.brightness(n, at) > 0.5).count() as u32;
                assert!(lit > 0 && lit < pattern.count(), "{square} {at:?}: {lit} of {}", pattern.count());
            }
        }
        assert_eq!(Pattern::checkerboard(8), Pattern::PAPER);
        assert_eq!(Pattern::PAPER.count(), 25);
        assert_eq!(Pattern::PAPER.widest_pixel(), 4.0);
    }

    #[test]
    fn phases_of_a_wave_average_to_a_half() {
        let pattern = Pattern::Waves { period: 16, phases: 3 };
        for x in 0..20 {
            let mean = (0..3).map(|n| pattern.brightness(n, [x, 0])).sum::<f32>() / 3.0;
            assert!((mean - 0.5).abs() < 1e-6, "{mean}");
        }
    }

    #[test]
    fn what_cannot_be_projected_is_refused() {
        let new = |pattern, pixels, dark| Projection::new(pattern, pixels, dark).is_err();
        assert!(new(Pattern::checkerboard(0), [8, 8], 0.0) && new(Pattern::PAPER, [0, 8], 0.0));
        assert!(new(Pattern::PAPER, [8, 8], 1.0) && new(Pattern::PAPER, [8, 8], f32::NAN));
        assert!(new(Pattern::PAPER, [8, 100_000], 0.0) && new(Pattern::Waves { period: 8, phases: 2 }, [8, 8], 0.0));
        assert!(new(Pattern::Checkerboard { square: 8, step: 3, shifts: 1 }, [8, 8], 0.0));
        assert!(new(Pattern::Checkerboard { square: 8, step: 1, shifts: 2 }, [8, 8], 0.0));
        assert!(new(Pattern::Checkerboard { square: 8, step: 9, shifts: 5 }, [8, 8], 0.0));
        assert!(new(Pattern::Waves { period: 2, phases: 3 }, [8, 8], 0.0));
    }
}
