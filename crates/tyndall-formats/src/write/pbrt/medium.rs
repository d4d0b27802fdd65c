//! Media.

use super::Pen;
use super::entity::Entity;
use crate::build::media;
use crate::desc::{Coefficients, MediumDesc, PhaseDesc, Span, SpectrumDesc};
use crate::write::number::as_single;
use tyndall_optics::recipe;

impl Pen<'_, '_> {
    pub(super) fn medium(&mut self, index: usize, medium: &MediumDesc) {
        let mut entity = Entity::new("MakeNamedMedium", &[&self.media[index]]);
        let kind = match &medium.coefficients {
            Coefficients::Recipe { name, .. } => &name.value,
            _ => "homogeneous",
        };
        entity.string("type", kind);
        match &medium.coefficients {
            Coefficients::Recipe { name, values } => {
                let parameters = recipe::named(&name.value).map_or(&[][..], |recipe| recipe.parameters);
                for (parameter, value) in parameters.iter().zip(values) {
                    entity.float_unless(parameter.name, *value, parameter.default);
                }
            }
            Coefficients::Preset { name, reduced } => {
                entity.string("preset", &name.value);
                if !reduced {
                    entity.boolean("reduced", false);
                }
            }
            Coefficients::AbsorptionScattering { sigma_a, sigma_s } => {
                for (name, sigma) in [("sigma_a", sigma_a), ("sigma_s", sigma_s)] {
                    self.coefficient(&mut entity, name, &sigma.value, sigma.span);
                }
            }
            Coefficients::PerMillimetre { sigma_a, sigma_s } => {
                let unit = self.draft.desc.options.unit.value;
                for (name, sigma) in [("sigma_a", sigma_a), ("sigma_s", sigma_s)] {
                    match media::per_unit(&sigma.value, unit) {
                        Some(rgb) => {
                            self.coefficient(&mut entity, name, &SpectrumDesc::Rgb(rgb.map(as_single)), sigma.span);
                        }
                        None => self.lacks(sigma.span, "a medium by wavelength and millimetre"),
                    }
                }
            }
            Coefficients::Reflectance { reflectance, .. } => {
                self.lacks(reflectance.span, "a medium by the reflectance of its surface, apart from that surface");
            }
            Coefficients::ExtinctionAlbedo { sigma_t, albedo } => match media::split(&sigma_t.value, &albedo.value) {
                Some(sigma) => {
                    // The renderer keeps them in single precision.
                    let [sigma_a, sigma_s] = sigma.map(|sigma| sigma.map(as_single));
                    self.coefficient(&mut entity, "sigma_a", &SpectrumDesc::Rgb(sigma_a), sigma_t.span);
                    self.coefficient(&mut entity, "sigma_s", &SpectrumDesc::Rgb(sigma_s), albedo.span);
                }
                None => self.lacks(sigma_t.span, "an extinction or an albedo by wavelength"),
            },
        }
        entity.float_unless("scale", medium.scale.value, 1.0);
        match &medium.phase {
            PhaseDesc::Isotropic => {}
            PhaseDesc::HenyeyGreenstein { g } => entity.float_unless("g", g.value, 0.0),
            PhaseDesc::Rayleigh => self.lacks(medium.span, "Rayleigh's phase function"),
            PhaseDesc::Tabulated { values } => entity.list("float", "phase", &values.value),
            PhaseDesc::Blend { .. } => self.lacks(medium.span, "a blend of phase functions"),
        }
        if let Some(light) = &medium.emission {
            self.emission(&mut entity, "Le", "Lescale", light);
        }
        self.entity(entity);
    }

    /// Both coefficients are 1 if nothing is said.
    fn coefficient(&mut self, entity: &mut Entity, name: &str, sigma: &SpectrumDesc, span: Span) {
        if *sigma != SpectrumDesc::Constant(1.0) {
            self.spectrum(entity, name, sigma, span);
        }
    }
}
