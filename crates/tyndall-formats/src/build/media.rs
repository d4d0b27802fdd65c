//! Media: coefficients in the scene's unit of length, by name or by number.

use tyndall::{
    medium::Homogeneous,
    phase::{Isotropic, Phase, Rayleigh},
    spectrum::{Role, Sampled, Spectrum},
};
use tyndall_optics::{
    half_space::HalfSpace,
    measured::{self, Anisotropic},
    medium::Medium,
    recipe,
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{Coefficients, LengthUnit, MediumDesc, PhaseDesc, SpectrumDesc},
    error::SceneError,
    source::Spanned,
};

impl Builder<'_> {
    pub(super) fn medium(&mut self, desc: &MediumDesc) -> Option<Homogeneous> {
        if let Coefficients::Recipe { name, values } = &desc.coefficients {
            let (coefficients, phase) = match mixed(name, values) {
                Ok(medium) => medium,
                Err(told) => return self.fail(SceneError::at(name.span, told)),
            };
            return self.medium(&MediumDesc { coefficients, phase, ..desc.clone() });
        }
        let scale = desc.scale.value;
        if !scale.is_finite() || scale < 0.0 {
            return self.fail(SceneError::at(desc.scale.span, format!("a medium cannot be scaled by {scale}")));
        }
        let emission = match &desc.emission {
            Some(emission) => Some(self.emission(emission)?),
            None => None,
        };
        let (sigma_a, sigma_s) = self.coefficients(desc)?;
        let phase = match &desc.coefficients {
            Coefficients::Preset { name, reduced: false } => self.measured_phase(name)?,
            _ => self.phase(&desc.phase)?,
        };
        let [sigma_a, sigma_s] = [sigma_a, sigma_s].map(|sigma| sigma.scaled(scale as f32));
        Some(Homogeneous { sigma_a, sigma_s, emission, phase })
    }

    fn coefficients(&mut self, desc: &MediumDesc) -> Option<(Spectrum, Spectrum)> {
        match &desc.coefficients {
            Coefficients::Preset { name, reduced } => self.preset(name, *reduced),
            // Written out before.
            Coefficients::Recipe { .. } => None,
            Coefficients::AbsorptionScattering { sigma_a, sigma_s } => {
                Some((self.spectrum(sigma_a, Measure::Coefficient)?, self.spectrum(sigma_s, Measure::Coefficient)?))
            }
            Coefficients::PerMillimetre { sigma_a, sigma_s } => {
                let sigma = [sigma_a, sigma_s].map(|sigma| self.spectrum(sigma, Measure::Coefficient));
                let [sigma_a, sigma_s] = sigma.map(|sigma| Some(sigma?.scaled(self.millimetres())));
                Some((sigma_a?, sigma_s?))
            }
            Coefficients::Reflectance { reflectance, mfp, eta } => self.of_colour(reflectance, mfp, *eta, &desc.phase),
            Coefficients::ExtinctionAlbedo { sigma_t, albedo } => self.extinction_albedo(sigma_t, albedo),
        }
    }

    /// A scene unit [mm].
    fn millimetres(&self) -> f32 {
        self.desc.options.unit.value.millimetres() as f32
    }

    /// The medium whose half-space, under a smooth boundary, returns this share of the light that enters it.
    fn of_colour(
        &mut self,
        reflectance: &Spanned<SpectrumDesc>,
        mfp: &Spanned<SpectrumDesc>,
        eta: f64,
        phase: &PhaseDesc,
    ) -> Option<(Spectrum, Spectrum)> {
        let share = self.spectrum(reflectance, Measure::Share)?;
        let path = self.spectrum(mfp, Measure::Coefficient)?;
        let g = if let PhaseDesc::HenyeyGreenstein { g } = phase { g.value } else { 0.0 };
        let half_space = HalfSpace::new(g, eta);
        let (albedo, unit) = (|share: f32| half_space.albedo(f64::from(share)) as f32, self.millimetres());
        let sigma_t = |path: f32| unit / path;
        let smallest = (360..=830).map(|l| path.at(l as f32)).chain(path.rgb()).fold(f32::INFINITY, f32::min);
        if !sigma_t(smallest).is_finite() {
            return self
                .fail(SceneError::at(mfp.span, format!("{smallest} is no mean free path")).help("it is positive"));
        }
        let coefficient = |of: &dyn Fn(f32, f32) -> f32| {
            per_wavelength(|l| of(share.at(l), path.at(l)), std::array::from_fn(|c| of(share.rgb()[c], path.rgb()[c])))
        };
        Some((
            coefficient(&|share, path| (1.0 - albedo(share)) * sigma_t(path)),
            coefficient(&|share, path| albedo(share) * sigma_t(path)),
        ))
    }

    /// Measured coefficients [1/mm], in the scene's unit.
    fn preset(&mut self, name: &Spanned<String>, reduced: bool) -> Option<(Spectrum, Spectrum)> {
        let Some(m) = measured::named(&name.value) else {
            return self.fail(
                SceneError::at(name.span, format!("no medium \"{}\" has been measured", name.value))
                    .suggest(&name.value, measured::names().collect::<Vec<_>>()),
            );
        };
        let per_unit = self.millimetres();
        let spectrum = |rgb: [f32; 3]| Spectrum::unbounded_rgb(rgb.map(|v| v * per_unit));
        if reduced {
            return Some((spectrum(m.sigma_a), spectrum(m.sigma_s_reduced)));
        }
        let Some(full) = m.full else {
            return self.fail(
                SceneError::at(name.span, format!("of \"{}\" only reduced scattering has been measured", m.name))
                    .help("leave out \"bool reduced\" false"),
            );
        };
        Some((spectrum(m.sigma_a), spectrum(full.sigma_s)))
    }

    /// The phase function that belongs to full scattering. One holds for all wavelengths: its mean cosine is that of the
    /// scattered light, `Σ σ_s g / Σ σ_s` over red, green and blue.
    fn measured_phase(&mut self, name: &Spanned<String>) -> Option<Phase> {
        let full = measured::named(&name.value)?.full?;
        self.phase(&PhaseDesc::HenyeyGreenstein { g: Spanned::new(mean_cosine(full), name.span) })
    }

    /// `σ_s = albedo · σ_t`, `σ_a = σ_t − σ_s`, channel by channel.
    fn extinction_albedo(
        &mut self,
        sigma_t: &Spanned<SpectrumDesc>,
        albedo: &Spanned<SpectrumDesc>,
    ) -> Option<(Spectrum, Spectrum)> {
        let extinction = self.spectrum(sigma_t, Measure::Coefficient)?;
        let share = self.spectrum(albedo, Measure::Share)?;
        let Some([sigma_a, sigma_s]) = split(&sigma_t.value, &albedo.value) else {
            let [t, a] = [extinction, share];
            return Some((product(&t, |l| 1.0 - a.at(l), a.rgb().map(|a| 1.0 - a)), product(&t, |l| a.at(l), a.rgb())));
        };
        Some((grey_or_rgb(sigma_a), grey_or_rgb(sigma_s)))
    }

    fn phase(&mut self, phase: &PhaseDesc) -> Option<Phase> {
        match phase {
            PhaseDesc::Isotropic => Some(Phase::Isotropic(Isotropic)),
            PhaseDesc::Rayleigh => Some(Phase::Rayleigh(Rayleigh)),
            PhaseDesc::HenyeyGreenstein { g } => match Phase::henyey_greenstein(g.value as f32) {
                Ok(phase) => Some(phase),
                Err(e) => self.fail(
                    SceneError::at(g.span, e.to_string()).help("g is the mean cosine: 0 isotropic, towards 1 forward"),
                ),
            },
            PhaseDesc::Tabulated { values } => match Phase::tabulated(&values.value) {
                Ok(phase) => Some(phase),
                Err(e) => self.fail(SceneError::at(values.span, e.to_string())),
            },
            PhaseDesc::Blend { of, weight } => {
                let [first, second] = [self.phase(&of[0])?, self.phase(&of[1])?];
                match Phase::blend(&first, &second, weight.value as f32) {
                    Ok(phase) => Some(phase),
                    Err(e) => self.fail(SceneError::at(weight.span, e.to_string())),
                }
            }
        }
    }
}

/// A recipe in numbers: its coefficients by wavelength, its phase function by a table.
fn mixed(name: &Spanned<String>, values: &[f64]) -> Result<(Coefficients, PhaseDesc), String> {
    let recipe = recipe::named(&name.value).ok_or_else(|| format!("there is no recipe \"{}\"", name.value))?;
    let medium = Medium::of(&recipe.mix(values)?);
    let spectrum = |values| Spanned::new(SpectrumDesc::Samples { lambda: medium.lambda.clone(), values }, name.span);
    let [sigma_a, sigma_s] = [medium.sigma_a, medium.sigma_s].map(spectrum);
    let phase = if medium.phase.is_empty() {
        PhaseDesc::Isotropic
    } else {
        PhaseDesc::Tabulated { values: Spanned::new(medium.phase, name.span) }
    };
    Ok((Coefficients::PerMillimetre { sigma_a, sigma_s }, phase))
}

/// The mean cosine of the light that full scattering sends on.
fn mean_cosine(full: Anisotropic) -> f64 {
    let scattered: f32 = full.sigma_s.iter().sum();
    let forward: f32 = full.sigma_s.iter().zip(full.g).map(|(s, g)| s * g).sum();
    f64::from(if scattered > 0.0 { forward / scattered } else { 0.0 })
}

/// Measured coefficients in numbers, for whoever writes them elsewhere.
pub(crate) struct Numbers {
    /// Absorption and scattering \[1/scene unit\].
    pub(crate) sigma: [[f32; 3]; 2],
    /// The mean cosine that belongs to them, if scattering is not the reduced one.
    pub(crate) g: Option<f64>,
}

/// The numbers of a [`Coefficients::Preset`] for a scene unit of so many millimetres.
pub(crate) fn numbers_of(name: &str, reduced: bool, millimetres: f64) -> Option<Numbers> {
    let m = measured::named(name)?;
    let full = if reduced { None } else { Some(m.full?) };
    let sigma = [m.sigma_a, full.map_or(m.sigma_s_reduced, |full| full.sigma_s)];
    Some(Numbers { sigma: sigma.map(|rgb| rgb.map(|v| v * millimetres as f32)), g: full.map(mean_cosine) })
}

/// `σ_a` and `σ_s` of an extinction and an albedo that are numbers or colours.
pub(crate) fn split(sigma_t: &SpectrumDesc, albedo: &SpectrumDesc) -> Option<[[f64; 3]; 2]> {
    let (t, a) = channels(sigma_t).zip(channels(albedo))?;
    Some([std::array::from_fn(|c| t[c] * (1.0 - a[c])), std::array::from_fn(|c| t[c] * a[c])])
}

/// Coefficients per millimetre, as colours per scene unit.
pub(crate) fn per_unit(spectrum: &SpectrumDesc, unit: LengthUnit) -> Option<[f64; 3]> {
    channels(spectrum).map(|sigma| sigma.map(|v| f64::from(v as f32 * unit.millimetres() as f32)))
}

pub(crate) fn channels(spectrum: &SpectrumDesc) -> Option<[f64; 3]> {
    match spectrum {
        SpectrumDesc::Constant(v) => Some([*v; 3]),
        SpectrumDesc::Rgb(rgb) => Some(*rgb),
        _ => None,
    }
}

/// A spectrum times a share of it, at every nanometre; the colour is the product of the two colours, as Mitsuba has it.
fn product(spectrum: &Spectrum, share: impl Fn(f32) -> f32, share_rgb: [f32; 3]) -> Spectrum {
    let rgb = spectrum.rgb();
    per_wavelength(|l| spectrum.at(l) * share(l), std::array::from_fn(|c| rgb[c] * share_rgb[c]))
}

/// A coefficient at every nanometre, and as a colour.
fn per_wavelength(at: impl Fn(f32) -> f32, rgb: [f32; 3]) -> Spectrum {
    let (lambda, values): (Vec<_>, Vec<_>) = (360..=830).map(|l| (l as f32, at(l as f32).max(0.0))).unzip();
    match Sampled::new(&lambda, &values, Role::Reflectance) {
        Ok(mut sampled) => {
            sampled.rgb = rgb.map(|v| v.max(0.0));
            Spectrum::Sampled(sampled)
        }
        // All values are finite: this is not reached.
        Err(_) => Spectrum::Constant(0.0),
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
