//! Media: coefficients in the scene's unit of length, by name or by number.

use tyndall::{
    medium::Homogeneous,
    phase::{Isotropic, Phase},
    spectrum::Spectrum,
};
use tyndall_optics::measured;

use super::{Builder, spectra::Measure};
use crate::{
    desc::{Coefficients, MediumDesc, PhaseDesc, SpectrumDesc},
    error::SceneError,
    source::Spanned,
};

impl Builder<'_> {
    pub(super) fn medium(&mut self, desc: &MediumDesc) -> Option<Homogeneous> {
        let scale = desc.scale.value;
        if !scale.is_finite() || scale < 0.0 {
            return self.fail(SceneError::at(desc.scale.span, format!("a medium cannot be scaled by {scale}")));
        }
        if let Some(emission) = &desc.emission {
            return self.fail(
                SceneError::at(emission.spectrum.span, "media that emit light are not known yet").help("leave out Le"),
            );
        }
        let (sigma_a, sigma_s) = self.coefficients(&desc.coefficients)?;
        let phase = self.phase(&desc.phase)?;
        Some(Homogeneous { sigma_a: sigma_a.scaled(scale as f32), sigma_s: sigma_s.scaled(scale as f32), phase })
    }

    fn coefficients(&mut self, coefficients: &Coefficients) -> Option<(Spectrum, Spectrum)> {
        match coefficients {
            Coefficients::Preset(name) => self.preset(name),
            Coefficients::AbsorptionScattering { sigma_a, sigma_s } => {
                Some((self.spectrum(sigma_a, Measure::Coefficient)?, self.spectrum(sigma_s, Measure::Coefficient)?))
            }
            Coefficients::ExtinctionAlbedo { sigma_t, albedo } => self.extinction_albedo(sigma_t, albedo),
        }
    }

    /// Measured coefficients [1/mm], in the scene's unit.
    fn preset(&mut self, name: &Spanned<String>) -> Option<(Spectrum, Spectrum)> {
        let Some(m) = measured::named(&name.value) else {
            return self.fail(
                SceneError::at(name.span, format!("no medium \"{}\" has been measured", name.value))
                    .suggest(&name.value, measured::names().collect::<Vec<_>>()),
            );
        };
        let per_unit = self.desc.options.unit.value.millimetres() as f32;
        let spectrum = |rgb: [f32; 3]| Spectrum::unbounded_rgb(rgb.map(|v| v * per_unit));
        Some((spectrum(m.sigma_a), spectrum(m.sigma_s_reduced)))
    }

    /// `σ_s = albedo · σ_t`, `σ_a = σ_t − σ_s`, channel by channel.
    fn extinction_albedo(
        &mut self,
        sigma_t: &Spanned<SpectrumDesc>,
        albedo: &Spanned<SpectrumDesc>,
    ) -> Option<(Spectrum, Spectrum)> {
        self.spectrum(sigma_t, Measure::Coefficient)?;
        self.spectrum(albedo, Measure::Share)?;
        let (Some(t), Some(a)) = (channels(&sigma_t.value), channels(&albedo.value)) else {
            return self.fail(
                SceneError::at(albedo.span, "extinction with an albedo is known for numbers and rgb only")
                    .help("give sigma_a and sigma_s instead"),
            );
        };
        let sigma_s: [f64; 3] = std::array::from_fn(|c| t[c] * a[c]);
        let sigma_a: [f64; 3] = std::array::from_fn(|c| t[c] * (1.0 - a[c]));
        Some((grey_or_rgb(sigma_a), grey_or_rgb(sigma_s)))
    }

    fn phase(&mut self, phase: &PhaseDesc) -> Option<Phase> {
        match phase {
            PhaseDesc::Isotropic => Some(Phase::Isotropic(Isotropic)),
            PhaseDesc::HenyeyGreenstein { g } => match Phase::henyey_greenstein(g.value as f32) {
                Ok(phase) => Some(phase),
                Err(e) => self.fail(
                    SceneError::at(g.span, e.to_string()).help("g is the mean cosine: 0 isotropic, towards 1 forward"),
                ),
            },
        }
    }
}

fn channels(spectrum: &SpectrumDesc) -> Option<[f64; 3]> {
    match spectrum {
        SpectrumDesc::Constant(v) => Some([*v; 3]),
        SpectrumDesc::Rgb(rgb) => Some(*rgb),
        _ => None,
    }
}

/// A grey coefficient is flat, at every wavelength exactly.
fn grey_or_rgb(rgb: [f64; 3]) -> Spectrum {
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
        Spectrum::constant(rgb[0] as f32)
    } else {
        Spectrum::unbounded_rgb(rgb.map(|v| v as f32))
    }
}
