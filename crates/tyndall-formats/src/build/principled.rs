//! Burley's two models.

use tyndall::{
    bsdf::{PrincipledFixed, Sides, ThinRates},
    material::{BurleyTextures, Material, PrincipledTextures, ThinTextures},
};

use super::{Builder, spectra::Measure};
use crate::desc::{BurleyDesc, PrincipledDesc, PrincipledThinDesc};

impl Builder<'_> {
    pub(super) fn principled(&mut self, desc: &PrincipledDesc, sides: Sides) -> Option<Material> {
        let [diffuse_rate, specular_rate, clearcoat_rate] = desc.rates.map(|rate| rate as f32);
        Some(Material::Principled(Box::new(PrincipledTextures {
            burley: self.burley(&desc.burley)?,
            metallic: self.texture(&desc.metallic, Measure::Share)?,
            clearcoat: self.texture(&desc.clearcoat, Measure::Share)?,
            clearcoat_gloss: self.texture(&desc.clearcoat_gloss, Measure::Share)?,
            fixed: PrincipledFixed { eta: desc.eta as f32, diffuse_rate, specular_rate, clearcoat_rate, sides },
        })))
    }

    pub(super) fn principled_thin(&mut self, desc: &PrincipledThinDesc) -> Option<Material> {
        let [[diffuse_reflectance, specular_reflectance], [diffuse_transmittance, specular_transmittance]] =
            desc.rates.map(|side| side.map(|rate| rate as f32));
        Some(Material::PrincipledThin(Box::new(ThinTextures {
            burley: self.burley(&desc.burley)?,
            eta: self.texture(&desc.eta, Measure::Index)?,
            diff_trans: self.texture(&desc.diff_trans, Measure::Coefficient)?,
            rates: ThinRates {
                diffuse_reflectance,
                diffuse_transmittance,
                specular_reflectance,
                specular_transmittance,
            },
        })))
    }

    fn burley(&mut self, desc: &BurleyDesc) -> Option<BurleyTextures> {
        Some(BurleyTextures {
            colour: self.texture(&desc.base_color, Measure::Share)?,
            roughness: self.texture(&desc.roughness, Measure::Share)?,
            anisotropic: self.texture(&desc.anisotropic, Measure::Share)?,
            spec_trans: self.texture(&desc.spec_trans, Measure::Share)?,
            spec_tint: self.texture(&desc.spec_tint, Measure::Share)?,
            sheen: self.texture(&desc.sheen, Measure::Share)?,
            sheen_tint: self.texture(&desc.sheen_tint, Measure::Share)?,
            flatness: self.texture(&desc.flatness, Measure::Share)?,
        })
    }
}
