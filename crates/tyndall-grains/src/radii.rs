//! How large grains are: `R` (all alike), `uniform:MIN:MAX`, `lognormal:MEDIAN:SIGMA`, the last with `SIGMA` the standard
//! deviation of the logarithm, cut off at three of them on either side so that a largest grain exists.

use std::{f64::consts::TAU, str::FromStr};

use tyndall::sampling::Rng;

use crate::{GrainError, lengths, uniform};

/// Where a log-normal distribution is cut off [standard deviations of the logarithm].
const CUT: f64 = 3.0;

/// A distribution of radii.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Radii {
    /// All alike.
    Mono(f64),
    /// Smallest, largest.
    Uniform(f64, f64),
    /// Median, standard deviation of the logarithm.
    LogNormal(f64, f64),
}

impl FromStr for Radii {
    type Err = GrainError;

    fn from_str(text: &str) -> Result<Self, GrainError> {
        let wanted = "radii: R, uniform:MIN:MAX (MIN not above MAX) or lognormal:MEDIAN:SIGMA (SIGMA at most 1)";
        let (name, numbers) = text.split_once(':').unwrap_or(("mono", text));
        match (name, lengths(text, numbers, "radii", wanted)?.as_slice()) {
            ("mono", &[radius]) => Ok(Self::Mono(radius)),
            ("uniform", &[least, most]) if least <= most => Ok(Self::Uniform(least, most)),
            ("lognormal", &[median, sigma]) if sigma <= 1.0 => Ok(Self::LogNormal(median, sigma)),
            _ => Err(GrainError::Syntax { text: text.to_owned(), wanted }),
        }
    }
}

impl Radii {
    /// The largest.
    pub fn largest(&self) -> f64 {
        match *self {
            Self::Mono(radius) | Self::Uniform(_, radius) => radius,
            Self::LogNormal(median, sigma) => median * (CUT * sigma).exp(),
        }
    }

    /// The smallest.
    pub fn smallest(&self) -> f64 {
        match *self {
            Self::Mono(radius) | Self::Uniform(radius, _) => radius,
            Self::LogNormal(median, sigma) => median * (-CUT * sigma).exp(),
        }
    }

    /// Draws one.
    pub(crate) fn draw(&self, rng: &mut Rng) -> f64 {
        match *self {
            Self::Mono(radius) => radius,
            Self::Uniform(least, most) => least + (most - least) * uniform(rng),
            Self::LogNormal(median, sigma) => loop {
                // Box and Muller.
                let normal = (-2.0 * uniform(rng).ln()).sqrt() * (TAU * uniform(rng)).cos();
                if normal.abs() <= CUT {
                    return median * (sigma * normal).exp();
                }
            },
        }
    }
}
