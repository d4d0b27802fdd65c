//! Whether what is sampled is what is evaluated: the difference of two maps, pixel by pixel.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use super::Layout;
use crate::run::{Estimate, Sums};

/// Samples that a pixel must expect to be tested.
const ENOUGH: f64 = 20.0;

/// How sampling and evaluation compare.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Agreement {
    /// The map as evaluation gives it \[1/sr\], by channels and pixels.
    pub map: Vec<Vec<Estimate>>,
    /// The integral of evaluation \[1\]; mean over the channels.
    pub evaluated: Estimate,
    /// The z of the difference of both in every pixel; 0 where too few samples came.
    pub z: Vec<f64>,
    /// How many pixels could be tested.
    pub tests: usize,
    /// The greatest |z|.
    pub max_z: f64,
    /// The sum of z².
    pub chi_square: f64,
    /// The chance of either, if sampling and evaluation agree.
    pub p: f64,
}

impl Layout {
    /// Compares the maps of sampling and of evaluation, `map`.
    pub(super) fn compare(&self, sums: &Sums, map: Vec<Vec<Estimate>>) -> Agreement {
        let (omega, photons) = (self.map.solid_angle(), sums.photons() as f64);
        let of_channels = |pixel: usize| map.iter().map(|channel| channel[pixel].mean).sum::<f64>() / map.len() as f64;
        // The weight of a sample, in the mean over those that have any.
        let weight = sums.estimate(0).mean.max(f64::MIN_POSITIVE);
        let difference = |pixel: usize| {
            let (found, power) = (sums.estimate(self.start(2 * self.channels) + pixel), of_channels(pixel) * omega);
            // A pixel that was hit too rarely underestimates its own variance: it is at least that of a Poisson number.
            (found.mean, found.standard_error.powi(2).max(power * weight / photons), power)
        };
        let z_of = |mean: f64, variance: f64| if variance > 0.0 { mean / variance.sqrt() } else { 0.0 };
        let (mut z, mut tests, mut rest) = (vec![0.0; self.map.pixels()], 0, (0.0, 0.0));
        for (pixel, z) in z.iter_mut().enumerate() {
            let (mean, variance, power) = difference(pixel);
            if power * photons / weight >= ENOUGH {
                *z = z_of(mean, variance);
                tests += 1;
            } else {
                rest = (rest.0 + mean, rest.1 + variance);
            }
        }
        let last = (rest.1 > 0.0).then(|| z_of(rest.0, rest.1));
        let all = || z.iter().copied().filter(|z| *z != 0.0).chain(last);
        let max_z = all().map(f64::abs).fold(0.0, f64::max);
        let chi_square: f64 = all().map(|z| z * z).sum();
        let tests = tests + usize::from(last.is_some());
        Agreement {
            evaluated: self.evaluated(sums),
            z,
            tests,
            max_z,
            chi_square,
            p: chance(max_z, chi_square, tests),
            map,
        }
    }

    /// The integral of evaluation, whose pixels are independent.
    fn evaluated(&self, sums: &Sums) -> Estimate {
        let quantities = || self.start(self.channels)..self.start(2 * self.channels);
        let by = 1.0 / self.channels as f64;
        let variance: f64 = quantities().map(|quantity| sums.estimate(quantity).standard_error.powi(2)).sum();
        // Channels of a pixel are not: their errors add at most.
        let standard_error = (variance * self.channels as f64).sqrt() * by;
        Estimate { mean: by * quantities().map(|quantity| sums.estimate(quantity).mean).sum::<f64>(), standard_error }
    }
}

/// The chance of a greatest |z| or a χ² as large as this by noise alone.
fn chance(max_z: f64, chi_square: f64, tests: usize) -> f64 {
    if tests == 0 {
        return 1.0;
    }
    let sidak = |p: f64, count: f64| -(count * (-p.min(1.0)).ln_1p()).exp_m1();
    let largest = sidak(2.0 * Normal::standard().cdf(-max_z), tests as f64);
    let squares = ChiSquared::new(tests as f64).map_or(1.0, |law| law.sf(chi_square));
    sidak(largest.min(squares), 2.0)
}
