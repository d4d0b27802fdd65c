//! Spectra: numbers, colours, black bodies, samples, names and files, each by what it measures.

use tyndall::spectrum::Spectrum;

use super::Builder;
use crate::{
    desc::{EmissionDesc, Magnitude, SpectrumDesc},
    error::SceneError,
    source::{Span, Spanned},
};

/// What a spectrum measures, which says what an RGB triple becomes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Measure {
    /// A share of light, 0 to 1.
    Share,
    /// A coefficient or an index, at least 0.
    Coefficient,
}

impl Builder<'_> {
    /// A reflectance, a coefficient, an index.
    pub(super) fn spectrum(&mut self, desc: &Spanned<SpectrumDesc>, measure: Measure) -> Option<Spectrum> {
        let span = desc.span;
        match &desc.value {
            SpectrumDesc::Constant(v) => {
                self.check(&[*v], measure, span)?;
                Some(Spectrum::constant(*v as f32))
            }
            SpectrumDesc::Rgb(rgb) => {
                self.check(rgb, measure, span)?;
                let rgb = rgb.map(|v| v as f32);
                Some(if measure == Measure::Share { Spectrum::albedo_rgb(rgb) } else { Spectrum::unbounded_rgb(rgb) })
            }
            SpectrumDesc::Samples { lambda, values } => {
                self.check(values, measure, span)?;
                self.samples(lambda, values, span)
            }
            SpectrumDesc::Blackbody { .. } => self.fail(
                SceneError::at(span, "a black body is a light, not a reflectance or a coefficient")
                    .help("write a number, \"rgb\" or wavelength-value pairs"),
            ),
            SpectrumDesc::Named(name) => self.fail(
                SceneError::at(span, format!("the spectrum \"{name}\" is not known yet"))
                    .help("write a number, \"rgb\" or wavelength-value pairs"),
            ),
            SpectrumDesc::File(path) => self.fail(
                SceneError::at(span, format!("spectrum files are not known yet ({})", path.display()))
                    .help("write the wavelength-value pairs into the scene"),
            ),
        }
    }

    /// Light: radiance, intensity, irradiance.
    pub(super) fn emission(&mut self, desc: &EmissionDesc) -> Option<Spectrum> {
        let span = desc.spectrum.span;
        if !desc.scale.is_finite() || desc.scale < 0.0 {
            return self.fail(SceneError::at(span, format!("light cannot be scaled by {}", desc.scale)));
        }
        let unit_luminance = desc.magnitude == Magnitude::UnitLuminance;
        let normalised = |s: Spectrum| {
            let luminance = s.luminance();
            if unit_luminance && luminance > 0.0 { s.scaled(1.0 / luminance) } else { s }
        };
        let spectrum = match &desc.spectrum.value {
            // A flat spectrum of light is white by definition of the film: (v, v, v).
            SpectrumDesc::Constant(v) => {
                self.check(&[*v], Measure::Coefficient, span)?;
                Spectrum::illuminant_rgb([*v as f32; 3])
            }
            SpectrumDesc::Rgb(rgb) => {
                self.check(rgb, Measure::Coefficient, span)?;
                Spectrum::illuminant_rgb(rgb.map(|v| v as f32))
            }
            SpectrumDesc::Blackbody { kelvin } => Spectrum::blackbody(*kelvin as f32),
            SpectrumDesc::Samples { lambda, values } => {
                self.check(values, Measure::Coefficient, span)?;
                let (lambda, values) = (single(lambda), single(values));
                match Spectrum::sampled_illuminant(&lambda, &values) {
                    Ok(s) => normalised(s),
                    Err(e) => return self.fail(SceneError::at(span, e.to_string())),
                }
            }
            SpectrumDesc::Named(name) => {
                return self.fail(
                    SceneError::at(span, format!("the light spectrum \"{name}\" is not known yet"))
                        .help("use \"rgb\", \"blackbody\" or wavelength-value pairs"),
                );
            }
            SpectrumDesc::File(path) => {
                return self.fail(
                    SceneError::at(span, format!("spectrum files are not known yet ({})", path.display()))
                        .help("write the wavelength-value pairs into the scene"),
                );
            }
        };
        Some(spectrum.scaled(desc.scale as f32))
    }

    fn samples(&mut self, lambda: &[f64], values: &[f64], span: Span) -> Option<Spectrum> {
        match Spectrum::sampled(&single(lambda), &single(values)) {
            Ok(s) => Some(s),
            Err(e) => self.fail(SceneError::at(span, e.to_string())),
        }
    }

    fn check(&mut self, values: &[f64], measure: Measure, span: Span) -> Option<()> {
        let most = if measure == Measure::Share { 1.0 } else { f64::from(f32::MAX) };
        match values.iter().find(|v| !(0.0..=most).contains(*v)) {
            None => Some(()),
            Some(v) if measure == Measure::Share => self.fail(
                SceneError::at(span, format!("{v} is not between 0 and 1"))
                    .help("a surface cannot reflect more light than it gets"),
            ),
            Some(v) => self.fail(SceneError::at(span, format!("{v} is negative or not finite"))),
        }
    }
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|v| *v as f32).collect()
}
