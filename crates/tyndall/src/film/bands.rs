//! Bands of wavelengths that a film records one by one.
//!
//! The mean spectral radiance over a band `[a, b)` is estimated from a path's four wavelengths by
//! `1/(b − a) · ¼ Σ Lᵢ / p(λᵢ)` over those that lie in it, as [`film_rgb`](crate::spectrum::film_rgb) estimates colour. It is
//! in the scene's unit, in which a flat spectrum of 1 is a luminance of 1. Colours have no bands.

use crate::spectrum::{Lanes, Wavelengths};

/// Up to four bands side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands {
    /// Where the first begins [nm].
    pub first: f32,
    /// How wide each is, positive [nm].
    pub width: f32,
    /// How many they are, 1 to 4.
    pub count: u8,
}

impl Bands {
    /// A sample of the radiance in each band, from a path's radiance; 0 without wavelengths.
    pub fn sample(&self, radiance: Lanes, wavelengths: &Wavelengths) -> [f32; 4] {
        let mut bands = [0.0; 4];
        let Wavelengths::Spectral { lambda, pdf } = *wavelengths else { return bands };
        for lane in (0..4).filter(|&lane| pdf[lane] > 0.0 && radiance.lane(lane).is_finite()) {
            let band = ((lambda[lane] - self.first) / self.width).floor();
            if (0.0..f32::from(self.count)).contains(&band) {
                bands[band as usize] += 0.25 * radiance.lane(lane) / (pdf[lane] * self.width);
            }
        }
        bands
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{ColorMode, Spectrum};

    /// The mean of `λ` over each band is its middle: by the midpoint rule over the number that draws the wavelengths, with
    /// an error of the order of one step in each band, 2.35e-5 of the spectrum to 100 nm.
    #[test]
    fn a_band_has_the_mean_of_the_spectrum_in_it() {
        let ramp = Spectrum::sampled(&[300.0, 900.0], &[300.0, 900.0]).unwrap();
        let bands = Bands { first: 400.0, width: 100.0, count: 3 };
        let n = 200_000;
        let mut sum = [0.0f64; 4];
        for i in 0..n {
            let w = Wavelengths::sample(ColorMode::Spectral, (i as f32 + 0.5) / n as f32);
            for (sum, v) in sum.iter_mut().zip(bands.sample(ramp.eval(&w), &w)) {
                *sum += f64::from(v) / f64::from(n);
            }
        }
        for (found, middle) in sum.into_iter().zip([450.0, 550.0, 650.0, 0.0]) {
            assert!((found - middle).abs() <= 1e-3 * middle, "{sum:?}");
        }
        assert_eq!(bands.sample(Lanes::splat(1.0), &Wavelengths::Rgb), [0.0; 4]);
    }
}
