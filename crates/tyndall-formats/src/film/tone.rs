//! From radiance to what a display shows: exposure, then a curve, then the sRGB transfer function.
//!
//! `display = encode(curve(2^exposure · radiance))`, each channel alone.

/// How scene values meet the display's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Curve {
    /// Straight, cut off at 1: numbers can be read back from the image.
    #[default]
    Srgb,
    /// Hable's filmic curve of Uncharted 2 (Hable 2010, "Filmic Tonemapping Operators"): a toe that keeps shadows
    /// rich and a shoulder that takes in 11.2 times more than white before it clips.
    Filmic,
}

/// Exposure and curve.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tone {
    /// Exposure [stops], any finite value: each stop doubles the light.
    pub exposure: f32,
    /// The curve after it.
    pub curve: Curve,
}

impl Tone {
    /// The 8-bit sRGB colour of a linear-sRGB radiance. What is not a number turns magenta, so that nobody overlooks
    /// it; negative channels (outside the display's gamut) turn 0.
    pub fn apply(&self, radiance: [f32; 3]) -> [u8; 3] {
        if radiance.iter().any(|v| v.is_nan()) {
            return [255, 0, 255];
        }
        radiance.map(|v| {
            let exposed = v.max(0.0) * self.exposure.exp2();
            let shown = match self.curve {
                Curve::Srgb => exposed,
                Curve::Filmic => hable(2.0 * exposed) / hable(WHITE),
            };
            (srgb_encode(shown.min(1.0)) * 255.0 + 0.5) as u8
        })
    }
}

/// The linear value that the filmic curve maps to 1; Hable's exposure bias of 2 comes before.
const WHITE: f32 = 11.2;

/// Hable 2010: `((x(Ax + CB) + DE) / (x(Ax + B) + DF)) − E/F`, with shoulder strength A, linear strength B, linear
/// angle C, toe strength D, toe numerator E, toe denominator F.
fn hable(x: f32) -> f32 {
    const A: f32 = 0.15;
    const B: f32 = 0.50;
    const C: f32 = 0.10;
    const D: f32 = 0.20;
    const E: f32 = 0.02;
    const F: f32 = 0.30;
    // Past any white; keeps x² finite.
    let x = x.min(1e9);
    (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F
}

/// IEC 61966-2-1: linear `[0, 1]` to encoded `[0, 1]`.
fn srgb_encode(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sRGB of linear 0.5 is 0.7354 (188 of 255); of 0.18, 0.4614 (118).
    #[test]
    fn the_srgb_curve_has_its_published_values() {
        let tone = Tone::default();
        assert_eq!(tone.apply([0.0, 0.5, 0.18]), [0, 188, 118]);
        assert_eq!(tone.apply([1.0, 7.0, f32::INFINITY]), [255; 3]);
        assert_eq!(tone.apply([-1.0, 0.0, 0.0]), [0; 3]);
    }

    #[test]
    fn one_stop_doubles_the_light() {
        let brighter = Tone { exposure: 1.0, curve: Curve::Srgb };
        assert_eq!(brighter.apply([0.25, 0.1, 0.0]), Tone::default().apply([0.5, 0.2, 0.0]));
    }

    /// Hable's curve sends 0 to 0 and half of 11.2 (bias 2) to 1, and never falls.
    #[test]
    fn the_filmic_curve_rises_from_black_to_its_white() {
        let tone = Tone { exposure: 0.0, curve: Curve::Filmic };
        assert_eq!(tone.apply([0.0, WHITE / 2.0, f32::INFINITY]), [0, 255, 255]);
        assert!(tone.apply([1.0; 3])[0] < 200, "white has room above it");
        let shown: Vec<u8> = (0..600).map(|i| tone.apply([i as f32 * 0.01; 3])[0]).collect();
        assert!(shown.is_sorted());
    }

    #[test]
    fn what_is_not_a_number_is_seen() {
        assert_eq!(Tone::default().apply([0.2, f32::NAN, 0.2]), [255, 0, 255]);
    }
}
