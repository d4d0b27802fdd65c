//! What the four lanes of a path stand for.
//!
//! In `spectral` mode one random number gives four wavelengths by rotation: `λᵢ = F⁻¹(u + i/4 mod 1)`, so the four are
//! stratified and the first is the hero. The density follows the eye's response, `p(λ) ∝ sech²(0.0072 (λ − 538 nm))`,
//! between 360 and 830 nm:
//!
//! ```text
//! F⁻¹(u) = 538 − 138.888889 · atanh(0.85691062 − 1.82750197 u)     [nm]
//! p(λ)   = 0.0039398042 / cosh²(0.0072 (λ − 538))                  [1/nm]
//! ```
//!
//! Sources: Radziszewski, Boryczko and Alda 2009, "An improved technique for full spectral rendering"; constants as in
//! Pharr, Jakob and Humphreys 2023, section 4.5.4; hero wavelengths: Wilkie et al. 2014.

use super::cie::{LAMBDA_MAX, LAMBDA_MIN};

/// How colour is carried along paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColorMode {
    /// Linear-sRGB channels.
    #[default]
    Rgb,
    /// One value: the luminance.
    Mono,
    /// Four wavelengths sampled for each path.
    Spectral,
}

/// The meaning of a path's lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wavelengths {
    /// Lanes are red, green, blue, green.
    Rgb,
    /// Lanes are all the luminance.
    Mono,
    /// Lanes are four wavelengths; the hero is the first.
    Spectral {
        /// Wavelengths [nm].
        lambda: [f32; 4],
        /// Their densities [1/nm]; 0 for a lane that has ended.
        pdf: [f32; 4],
    },
}

impl Wavelengths {
    /// Lanes for a new path, from `u` in [0, 1).
    #[inline]
    pub fn sample(mode: ColorMode, u: f32) -> Self {
        match mode {
            ColorMode::Rgb => Self::Rgb,
            ColorMode::Mono => Self::Mono,
            ColorMode::Spectral => {
                let lambda = [0.0, 0.25, 0.5, 0.75].map(|shift| sample_visible((u + shift).fract()));
                Self::Spectral { lambda, pdf: lambda.map(pdf_visible) }
            }
        }
    }

    /// The wavelength of lane `hero` in every lane, for a path that the others have left.
    #[must_use]
    pub fn hero_everywhere(&self, hero: usize) -> Self {
        match *self {
            Self::Spectral { lambda, pdf } => Self::Spectral { lambda: [lambda[hero]; 4], pdf: [pdf[hero]; 4] },
            Self::Rgb | Self::Mono => *self,
        }
    }

    /// The wavelength [nm] at which a dispersive index is evaluated: that of lane `hero`, or outside of spectral mode
    /// the helium d line, 587.56 nm, for which indices of glass are quoted.
    #[inline]
    pub fn hero(&self, hero: usize) -> f32 {
        match self {
            Self::Spectral { lambda, .. } => lambda[hero],
            Self::Rgb | Self::Mono => 587.56,
        }
    }
}

/// A wavelength [nm] from `u` in [0, 1].
pub fn sample_visible(u: f32) -> f32 {
    (538.0 - 138.888_889 * (0.856_910_62 - 1.827_501_97 * u).atanh()).clamp(LAMBDA_MIN, LAMBDA_MAX)
}

/// Density [1/nm] of [`sample_visible`] at `lambda` [nm].
pub fn pdf_visible(lambda: f32) -> f32 {
    if (LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
        let c = (0.0072 * (lambda - 538.0)).cosh();
        0.003_939_804_2 / (c * c)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_of_wavelengths_integrates_to_one_and_belongs_to_the_inverse() {
        let n = 47_000;
        let step = 470.0 / f64::from(n);
        let total: f64 =
            (0..n).map(|i| f64::from(pdf_visible((360.0 + (f64::from(i) + 0.5) * step) as f32)) * step).sum();
        assert!((total - 1.0).abs() < 1e-5, "{total}");
        // dλ/du = 1/p(λ).
        for i in 1..100 {
            let (u, h) = (i as f32 / 100.0, 1e-3);
            let slope = (sample_visible(u + h) - sample_visible(u - h)) / (2.0 * h);
            assert!((slope * pdf_visible(sample_visible(u)) - 1.0).abs() < 3e-3, "u = {u}: {slope}");
        }
        assert!((sample_visible(0.0) - 360.0).abs() < 1e-2 && (sample_visible(1.0) - 830.0).abs() < 2e-2);
    }

    /// The constants of the book, so that another renderer's images can be compared sample by sample.
    #[test]
    fn the_first_wavelengths_are_pinned() {
        let Wavelengths::Spectral { lambda, .. } = Wavelengths::sample(ColorMode::Spectral, 0.25) else { panic!() };
        // F⁻¹(¼) = 538 − 138.888889 atanh(0.40003513), and so on for ½, ¾ and 0, in double precision.
        for (l, exact) in lambda.into_iter().zip([479.154_1, 545.903_0, 616.856_2, 360.0]) {
            assert!((l - exact).abs() < 0.02, "{l} {exact}");
        }
    }
}
