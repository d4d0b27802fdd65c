//! Black-body radiation, scaled to luminance 1.
//!
//! Planck's law, `B(λ, T) ∝ λ⁻⁵ / (exp(c₂/λT) − 1)` with the second radiation constant `c₂ = hc/k = 1.438776877·10⁷ nm·K`
//! (CODATA 2018), divided by its luminance `∫ B ȳ dλ / ∫ ȳ dλ`. How bright the body is stands in the scale of the light.

use super::{cie, srgb};

/// `hc/k` [nm·K].
const C2: f64 = 1.438_776_877e7;

/// Planck's law of a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blackbody {
    /// Temperature [K], positive.
    pub kelvin: f32,
    /// Linear-sRGB colour, scaled; without negative components (below about 1900 K blue is outside of the gamut).
    pub rgb: [f32; 3],
    /// Times this is the spectral value.
    scale: f32,
}

impl Blackbody {
    /// Luminance 1 at `kelvin` [K] > 0.
    pub fn new(kelvin: f32) -> Self {
        let xyz = cie::xyz(&[], |lambda| relative(f64::from(lambda), f64::from(kelvin)));
        let scale = 1.0 / xyz[1];
        Self { kelvin, rgb: srgb::from_xyz_in_gamut(xyz.map(|v| v * scale)), scale: scale as f32 }
    }

    /// The value at `lambda` [nm].
    pub fn at(&self, lambda: f32) -> f32 {
        self.scale * relative(f64::from(lambda), f64::from(self.kelvin)) as f32
    }

    /// Times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { rgb: self.rgb.map(|v| v * factor), scale: self.scale * factor, ..self }
    }
}

/// The luminance `∫ B ȳ dλ / ∫ ȳ dλ` of a black body of `kelvin` [K] > 0 in physical units, `B` in W·m⁻²·sr⁻¹·nm⁻¹:
/// what [`Blackbody`] leaves out.
pub fn luminance(kelvin: f64) -> f64 {
    // First radiation constant of spectral radiance, 2hc² [W·m²·sr⁻¹], of which a λ⁵ in nm takes 10⁴⁵ and a nm 10⁻⁹.
    const C1: f64 = 1.191_042_972e-16 * 1e36;
    let end = f64::from(cie::LAMBDA_MAX);
    let at_end = C1 / (end.powi(5) * (C2 / (end * kelvin)).exp_m1());
    at_end * cie::xyz(&[], |lambda| relative(f64::from(lambda), kelvin))[1]
}

/// `B(λ, T)/B(830 nm, T)`, written so that nothing overflows however cold the body is.
fn relative(lambda: f64, kelvin: f64) -> f64 {
    let end = f64::from(cie::LAMBDA_MAX);
    let (x, x_end) = (C2 / (lambda * kelvin), C2 / (end * kelvin));
    (end / lambda).powi(5) * (x_end - x).exp() * (-x_end).exp_m1() / (-x).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wien: the maximum of a 5772 K body is at 2.897772e6 nm·K / 5772 K = 502.04 nm.
    #[test]
    fn the_sun_is_brightest_at_502_nanometres() {
        let sun = Blackbody::new(5772.0);
        assert!(sun.at(502.0) > sun.at(495.0) && sun.at(502.0) > sun.at(509.0));
    }

    /// CIE 015: illuminant A is a black body of 2856 K at chromaticity (0.44758, 0.40745).
    #[test]
    fn a_filament_has_the_chromaticity_of_illuminant_a() {
        let a = Blackbody::new(2855.54);
        let [x, y, z] = cie::xyz(&[], |l| f64::from(a.at(l)));
        assert!((x / (x + y + z) - 0.44758).abs() < 1e-4 && (y / (x + y + z) - 0.40745).abs() < 1e-4);
    }

    /// The candela was defined by platinum at its freezing point, 2042 K: 60 cd/cm² (CGPM 1948), with 683 lm/W, and
    /// ∫ȳ dλ = 106.857 nm: 6·10⁵ cd/m² / (683 lm/W · 106.857 nm) = 8.221 W·m⁻²·sr⁻¹·nm⁻¹. The temperature is known to
    /// 0.1 %, of which luminance makes c₂/(0.6 µm · 2042 K) = 12 times as much.
    #[test]
    fn freezing_platinum_is_as_bright_as_the_old_candela() {
        let expected = 6e5 / (683.0 * 106.857);
        assert!((luminance(2042.0) / expected - 1.0).abs() < 0.012, "{} {expected}", luminance(2042.0));
    }

    #[test]
    fn cold_and_hot_bodies_stay_finite() {
        for kelvin in [1.0, 50.0, 300.0, 1e5, 1e9] {
            let b = Blackbody::new(kelvin);
            assert!(b.rgb.iter().all(|v| v.is_finite() && *v >= 0.0), "{kelvin} K: {b:?}");
            assert!((360..=830).all(|l| b.at(l as f32).is_finite()), "{kelvin} K");
        }
    }
}
