//! Colour: how the spectra of a scene become four [`Lanes`], and how lanes become the film's linear sRGB.
//!
//! | mode | lanes | scene spectrum → lanes | lanes → film |
//! |---|---|---|---|
//! | [`Rgb`](ColorMode::Rgb) | R, G, B, G | the spectrum's linear-sRGB colour, resolved once | drop the fourth |
//! | [`Mono`](ColorMode::Mono) | Y, Y, Y, Y | Rec. 709 luminance of that colour | grey |
//! | [`Spectral`](ColorMode::Spectral) | four wavelengths | the spectrum itself | CIE 1931 over the sampling density |
//!
//! ## Conventions (those of pbrt-v4)
//!
//! - Tristimulus values are divided by ∫ȳ: `XYZ = ∫ L (x̄, ȳ, z̄) dλ / ∫ ȳ dλ`, so a flat spectrum of 1 has luminance 1.
//! - The white of the film is CIE D65. [`Spectrum::illuminant_rgb`]`([1, 1, 1])` is D65 scaled to luminance 1 and comes
//!   out as `(1, 1, 1)` in every mode. [`Spectrum::constant`]`(1.0)` used as a light is the equal-energy spectrum: it is
//!   `(1, 1, 1)` in `rgb` mode, which knows no spectra, and the slightly pink `(1.205, 0.948, 0.909)` in `spectral`.
//! - A spectrum that is not emitted (reflectance, coefficient) has the colour that D65 gives it: flat is grey.
//! - Colours outside of the sRGB gamut (a filament, a laser) lose their negative components where the `rgb` colour is
//!   resolved and keep their luminance; `spectral` mode does not need this.
//! - `mono` is the Rec. 709 luminance of the `rgb` colour for lights, reflectances and coefficients alike. It is exact for
//!   grey scenes; in others the luminance of a product is not the product of luminances.
//! - Components and values given must be finite: whoever reads a file says where they are not.
//! - One spectral sample may have **negative** sRGB components on the film; only the mean is a colour.

pub mod blackbody;
pub mod cie;
pub mod glass;
pub mod lanes;
pub mod rgb;
pub mod sampled;
pub mod srgb;
pub mod uplift;
pub mod uplift_table;
pub mod wavelengths;

pub use blackbody::Blackbody;
pub use glass::Glass;
pub use lanes::Lanes;
pub use rgb::{RgbSpectrum, Role};
pub use sampled::{Sampled, SpectrumError};
pub use uplift::Sigmoid;
pub use wavelengths::{ColorMode, Wavelengths};

/// A spectrum of the scene, resolved once and good for all colour modes.
#[derive(Debug, Clone, PartialEq)]
pub enum Spectrum {
    /// The same value in every lane.
    Constant(f32),
    /// A colour, and the smooth spectrum that has it.
    Rgb(RgbSpectrum),
    /// Planck's law.
    Blackbody(Blackbody),
    /// Piecewise linear between tabulated values.
    Sampled(Sampled),
}

impl Spectrum {
    /// A flat spectrum: `v` in every lane.
    pub fn constant(v: f32) -> Self {
        Self::Constant(v)
    }

    /// A reflectance in \[0, 1\] from linear sRGB. A component above 1 is kept as in [`Self::unbounded_rgb`], so that
    /// all modes agree on how much is reflected; a negative one counts as 0.
    pub fn albedo_rgb(rgb: [f32; 3]) -> Self {
        Self::Rgb(RgbSpectrum::albedo(rgb))
    }

    /// A coefficient from linear sRGB, each component in [0, ∞): a scale times a reflectance.
    pub fn unbounded_rgb(rgb: [f32; 3]) -> Self {
        Self::Rgb(RgbSpectrum::unbounded(rgb))
    }

    /// A light from linear sRGB, each component in [0, ∞): a scale times a reflectance times D65.
    pub fn illuminant_rgb(rgb: [f32; 3]) -> Self {
        Self::Rgb(RgbSpectrum::illuminant(rgb))
    }

    /// A black body of `kelvin` [K] scaled to luminance 1; at 0 K or below there is no light.
    pub fn blackbody(kelvin: f32) -> Self {
        if kelvin > 0.0 { Self::Blackbody(Blackbody::new(kelvin)) } else { Self::Constant(0.0) }
    }

    /// A reflectance or coefficient, piecewise linear between `values` at `lambda_nm` [nm] and zero outside.
    ///
    /// # Errors
    /// When the lists differ in length or are empty, wavelengths do not increase, or a value is not finite or negative.
    pub fn sampled(lambda_nm: &[f32], values: &[f32]) -> Result<Self, SpectrumError> {
        Sampled::new(lambda_nm, values, Role::Reflectance).map(Self::Sampled)
    }

    /// A light, piecewise linear between `values` at `lambda_nm` [nm] and zero outside. Differs from [`Self::sampled`]
    /// in the `rgb` colour only: a light has its own, a reflectance is seen under D65.
    ///
    /// # Errors
    /// As [`Self::sampled`].
    pub fn sampled_illuminant(lambda_nm: &[f32], values: &[f32]) -> Result<Self, SpectrumError> {
        Sampled::new(lambda_nm, values, Role::Illuminant).map(Self::Sampled)
    }

    /// This spectrum times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Self::Constant(v) => Self::Constant(v * factor),
            Self::Rgb(s) => Self::Rgb(s.scaled(factor)),
            Self::Blackbody(s) => Self::Blackbody(s.scaled(factor)),
            Self::Sampled(s) => Self::Sampled(s.scaled(factor)),
        }
    }

    /// The four lanes of this spectrum.
    #[inline]
    pub fn eval(&self, w: &Wavelengths) -> Lanes {
        match *w {
            Wavelengths::Rgb => {
                let [r, g, b] = self.rgb();
                Lanes::rgb(r, g, b)
            }
            Wavelengths::Mono => Lanes::splat(self.luminance()),
            Wavelengths::Spectral { lambda, .. } => Lanes::new(lambda.map(|l| self.at(l))),
        }
    }

    /// The value at wavelength `lambda` [nm].
    pub fn at(&self, lambda: f32) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Rgb(s) => s.at(lambda),
            Self::Blackbody(s) => s.at(lambda),
            Self::Sampled(s) => s.at(lambda),
        }
    }

    /// The linear-sRGB colour.
    #[inline]
    pub fn rgb(&self) -> [f32; 3] {
        match self {
            Self::Constant(v) => [*v; 3],
            Self::Rgb(s) => s.rgb,
            Self::Blackbody(s) => s.rgb,
            Self::Sampled(s) => s.rgb,
        }
    }

    /// Whether nothing is emitted, reflected or absorbed at any wavelength.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Sampled(s) => s.is_zero(),
            other => other.rgb() == [0.0; 3],
        }
    }

    /// Rec. 709 luminance of the colour.
    #[inline]
    pub fn luminance(&self) -> f32 {
        srgb::luminance(self.rgb())
    }
}

/// Lanes of radiance to linear sRGB.
///
/// In spectral mode this is the estimate `XYZ = ¼ Σᵢ Lᵢ (x̄, ȳ, z̄)(λᵢ) / (pᵢ ∫ȳ)`, with terms of zero density left
/// out, through the XYZ-to-sRGB matrix.
#[inline]
pub fn film_rgb(value: Lanes, w: &Wavelengths) -> [f32; 3] {
    match *w {
        Wavelengths::Rgb => [value.lane(0), value.lane(1), value.lane(2)],
        Wavelengths::Mono => [value.lane(0); 3],
        Wavelengths::Spectral { lambda, pdf } => {
            let mut xyz = [0.0; 3];
            for i in (0..4).filter(|&i| pdf[i] > 0.0) {
                let weight = 0.25 * value.lane(i) / pdf[i];
                let observer = cie::observer(lambda[i]);
                for (sum, response) in xyz.iter_mut().zip(observer) {
                    *sum += weight * response;
                }
            }
            srgb::from_xyz(xyz)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The film's expectation: `film_rgb` averaged over the wavelength sample u, by the midpoint rule.
    fn film(spectrum: &Spectrum, mode: ColorMode) -> [f32; 3] {
        let n = 2_000;
        let mut sum = [0.0f64; 3];
        for i in 0..n {
            let w = Wavelengths::sample(mode, (i as f32 + 0.5) / n as f32);
            for (s, v) in sum.iter_mut().zip(film_rgb(spectrum.eval(&w), &w)) {
                *s += f64::from(v) / f64::from(n);
            }
        }
        sum.map(|v| v as f32)
    }

    fn assert_near(a: [f32; 3], b: [f32; 3], tolerance: f32, what: &str) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance), "{what}: {a:?} and {b:?}");
    }

    #[test]
    fn a_light_has_the_same_colour_on_the_film_in_rgb_and_in_spectral_mode() {
        let lights = [
            Spectrum::illuminant_rgb([1.0, 1.0, 1.0]),
            Spectrum::illuminant_rgb([0.9, 0.2, 0.1]),
            Spectrum::illuminant_rgb([0.0, 0.3, 0.7]),
            Spectrum::blackbody(2856.0),
            Spectrum::blackbody(6500.0),
            Spectrum::blackbody(20_000.0),
            Spectrum::sampled_illuminant(&[360.0, 500.0, 600.0, 830.0], &[0.7, 1.0, 0.8, 0.6]).unwrap(),
        ];
        for light in &lights {
            assert_near(film(light, ColorMode::Spectral), film(light, ColorMode::Rgb), 1e-3, &format!("{light:?}"));
        }
    }

    /// D65 times a reflectance must look as the reflectance's colour does in rgb mode.
    #[test]
    fn a_reflectance_under_white_light_has_its_own_colour() {
        let white = Spectrum::illuminant_rgb([1.0; 3]);
        for albedo in [
            Spectrum::albedo_rgb([0.8, 0.5, 0.3]),
            Spectrum::unbounded_rgb([3.0, 0.1, 7.0]),
            Spectrum::sampled(&[300.0, 550.0, 900.0], &[0.2, 0.5, 0.3]).unwrap(),
            Spectrum::constant(0.7),
        ] {
            let n = 2_000;
            let mut sum = [0.0; 3];
            for i in 0..n {
                let w = Wavelengths::sample(ColorMode::Spectral, (i as f32 + 0.5) / n as f32);
                let rgb = film_rgb(white.eval(&w) * albedo.eval(&w), &w);
                sum = std::array::from_fn(|c| sum[c] + rgb[c] / n as f32);
            }
            assert_near(sum, albedo.rgb(), 1e-3 * albedo.rgb()[2].max(1.0), &format!("{albedo:?}"));
        }
    }

    #[test]
    fn white_and_black_bodies_have_luminance_one() {
        assert_near(film(&Spectrum::illuminant_rgb([1.0; 3]), ColorMode::Spectral), [1.0; 3], 1e-3, "white");
        for kelvin in [500.0, 1_000.0, 6_504.0, 1e6] {
            assert!((Spectrum::blackbody(kelvin).luminance() - 1.0).abs() < 1e-4, "{kelvin} K");
            let y = srgb::luminance(film(&Spectrum::blackbody(kelvin), ColorMode::Spectral));
            assert!((y - 1.0).abs() < 2e-3, "{kelvin} K: {y}");
        }
    }

    #[test]
    fn mono_mode_is_the_luminance_of_rgb_mode() {
        let s = Spectrum::illuminant_rgb([2.0, 1.0, 0.5]);
        let y = 0.2126 * 2.0 + 0.7152 + 0.0722 * 0.5;
        assert_near(film(&s, ColorMode::Mono), [y; 3], 1e-3, "mono");
    }

    #[test]
    fn scaling_scales_in_every_mode() {
        for s in [
            Spectrum::constant(0.5),
            Spectrum::albedo_rgb([0.2, 0.4, 0.6]),
            Spectrum::blackbody(3000.0),
            Spectrum::sampled(&[400.0, 700.0], &[1.0, 2.0]).unwrap(),
        ] {
            for mode in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
                let w = Wavelengths::sample(mode, 0.37);
                let (once, thrice) = (s.eval(&w), s.clone().scaled(3.0).eval(&w));
                assert!((0..4).all(|i| (3.0 * once.lane(i) - thrice.lane(i)).abs() < 1e-5), "{s:?}");
            }
        }
        assert!(Spectrum::blackbody(3000.0).scaled(0.0).is_zero());
        assert!(Spectrum::blackbody(0.0).is_zero() && Spectrum::blackbody(f32::NAN).is_zero());
        assert!(Spectrum::sampled(&[900.0, 950.0], &[0.0, 0.0]).unwrap().is_zero());
    }
}
