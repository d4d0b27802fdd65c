//! Materials.

use tyndall::{
    bsdf::{Sides, microfacet::Distribution},
    material::{Index, Material, Metal},
    spectrum::{
        Spectrum,
        glass::{GLASSES, Glass},
    },
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{ConductorOptics, MaterialDesc, MaterialKind, MicrofacetKind, RoughnessDesc, SpectrumDesc},
    error::SceneError,
    source::Spanned,
};

impl Builder<'_> {
    pub(super) fn material(&mut self, desc: &MaterialDesc) -> Option<Material> {
        let sides = if desc.two_sided { Sides::Both } else { Sides::Outside };
        match &desc.kind {
            MaterialKind::Diffuse { reflectance } => {
                Some(Material::Diffuse { reflectance: self.spectrum(reflectance, Measure::Share)?, sides })
            }
            MaterialKind::Conductor { optics, roughness, tint } => Some(Material::Conductor {
                metal: self.metal(optics)?,
                alpha: alpha(roughness),
                distribution: distribution(roughness),
                tint: self.tint(tint.as_ref())?,
                sides,
            }),
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                Some(Material::Dielectric {
                    eta: self.index(eta)?,
                    alpha: alpha(roughness),
                    distribution: distribution(roughness),
                    reflection_tint: self.tint(reflection_tint.as_ref())?,
                    transmission_tint: self.tint(transmission_tint.as_ref())?,
                })
            }
            MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                Some(Material::ThinDielectric {
                    eta: self.index(eta)?,
                    reflection_tint: self.tint(reflection_tint.as_ref())?,
                    transmission_tint: self.tint(transmission_tint.as_ref())?,
                })
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                Some(Material::DiffuseTransmission {
                    reflectance: self.spectrum(reflectance, Measure::Share)?,
                    transmittance: self.spectrum(transmittance, Measure::Share)?,
                    scale: *scale as f32,
                })
            }
            MaterialKind::Interface => Some(Material::Null),
        }
    }

    fn metal(&mut self, optics: &ConductorOptics) -> Option<Metal> {
        match optics {
            ConductorOptics::EtaK { eta, k } => Some(Metal::Index {
                eta: self.spectrum(eta, Measure::Coefficient)?,
                k: self.spectrum(k, Measure::Coefficient)?,
            }),
            ConductorOptics::Reflectance(r) => Some(Metal::Reflectance(self.spectrum(r, Measure::Share)?)),
            ConductorOptics::Mirror => Some(Metal::Mirror),
        }
    }

    fn index(&mut self, eta: &Spanned<SpectrumDesc>) -> Option<Index> {
        match &eta.value {
            SpectrumDesc::Constant(v) if *v > 0.0 && v.is_finite() => Some(Index::Constant(*v as f32)),
            SpectrumDesc::Named(name) => match Glass::named(name) {
                Some(glass) => Some(Index::Glass(*glass)),
                None => self.fail(
                    SceneError::at(eta.span, format!("no glass is called \"{name}\""))
                        .suggest(name, GLASSES.iter().map(|g| g.name)),
                ),
            },
            _ => self.fail(
                SceneError::at(eta.span, "an index of refraction is a positive number or the name of a glass")
                    .help("water has 1.33, glass 1.5; \"glass-BK7\" disperses"),
            ),
        }
    }

    fn tint(&mut self, tint: Option<&Spanned<SpectrumDesc>>) -> Option<Spectrum> {
        tint.map_or(Some(Spectrum::constant(1.0)), |t| self.spectrum(t, Measure::Share))
    }
}

fn alpha(roughness: &RoughnessDesc) -> [f32; 2] {
    roughness.alpha().map(|a| a as f32)
}

fn distribution(roughness: &RoughnessDesc) -> Distribution {
    match roughness.distribution {
        MicrofacetKind::Ggx => Distribution::TrowbridgeReitz,
        MicrofacetKind::Beckmann => Distribution::Beckmann,
    }
}
