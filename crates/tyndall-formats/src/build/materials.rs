//! Materials.

use tyndall::{
    bsdf::{
        Sides,
        microfacet::{Distribution, Shadowing},
    },
    material::{Index, Material, Metal, Roughness},
    spectrum::{Spectrum, glass::Glass},
    texture::Texture,
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{
        ConductorOptics, MaterialDesc, MaterialKind, MicrofacetKind, RoughnessDesc, ShadowingKind, SpectrumDesc,
        Varying,
    },
    error::SceneError,
    source::Spanned,
};

impl Builder<'_> {
    pub(super) fn material(&mut self, desc: &MaterialDesc) -> Option<Material> {
        let sides = if desc.two_sided { Sides::Both } else { Sides::Outside };
        match &desc.kind {
            MaterialKind::Diffuse { reflectance } => {
                Some(Material::Diffuse { reflectance: self.texture(reflectance, Measure::Share)?, sides })
            }
            MaterialKind::Conductor { optics, roughness, tint } => Some(Material::Conductor {
                metal: self.metal(optics)?,
                alpha: self.roughness(roughness)?,
                tint: self.tint(tint.as_ref())?,
                sides,
            }),
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                Some(Material::Dielectric {
                    eta: self.index(eta)?,
                    alpha: self.roughness(roughness)?,
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
                    reflectance: self.texture(reflectance, Measure::Share)?,
                    transmittance: self.texture(transmittance, Measure::Share)?,
                    scale: *scale as f32,
                })
            }
            MaterialKind::Interface => Some(Material::Null),
        }
    }

    fn metal(&mut self, optics: &ConductorOptics) -> Option<Metal> {
        match optics {
            ConductorOptics::EtaK { eta, k } => {
                let [eta, k] = [eta, k].map(|part| self.texture(part, Measure::Index).map(Box::new));
                Some(Metal::Index { eta: eta?, k: k? })
            }
            ConductorOptics::Reflectance(r) => Some(Metal::Reflectance(self.texture(r, Measure::Share)?)),
            ConductorOptics::Mirror => Some(Metal::Mirror),
        }
    }

    fn index(&mut self, eta: &Spanned<SpectrumDesc>) -> Option<Index> {
        match &eta.value {
            SpectrumDesc::Constant(v) if *v > 0.0 && v.is_finite() => Some(Index::Constant(*v as f32)),
            SpectrumDesc::Named(name) if Glass::named(name).is_some() => Glass::named(name).copied().map(Index::Glass),
            SpectrumDesc::Samples { .. } | SpectrumDesc::Named(_) | SpectrumDesc::File(_) => {
                match self.spectrum(eta, Measure::Index)? {
                    Spectrum::Sampled(table) => Some(Index::Table(table)),
                    _ => None,
                }
            }
            _ => self.fail(
                SceneError::at(eta.span, "an index of refraction is a positive number or the name of a glass")
                    .help("water has 1.33, glass 1.5; \"glass-BK7\" disperses"),
            ),
        }
    }

    fn roughness(&mut self, desc: &RoughnessDesc) -> Option<Roughness> {
        let u = self.texture(&desc.u, Measure::Coefficient);
        let v = self.texture(&desc.v, Measure::Coefficient);
        let distribution = match desc.distribution {
            MicrofacetKind::Ggx => Distribution::TrowbridgeReitz,
            MicrofacetKind::Beckmann => Distribution::Beckmann,
        };
        let shadowing = match desc.shadowing {
            ShadowingKind::Correlated => Shadowing::Correlated,
            ShadowingKind::Separable => Shadowing::Separable,
        };
        u.zip(v).map(|(u, v)| Roughness { u, v, remap: desc.remap, distribution, shadowing })
    }

    fn tint(&mut self, tint: Option<&Spanned<Varying>>) -> Option<Texture> {
        tint.map_or(Some(Texture::from(1.0)), |t| self.texture(t, Measure::Share))
    }
}
