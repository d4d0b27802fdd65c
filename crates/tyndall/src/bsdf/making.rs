//! Models from what a scene says of a surface, and variants of them.

use super::{
    Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, RoughConductor, RoughDielectric, Sides, ThinDielectric,
    microfacet::{Distribution, Microfacets, Shadowing},
};
use crate::spectrum::Lanes;

/// Interfaces between indices closer than this are sharp however rough they are: the bend is too small to be resolved.
const LEAST_INDEX_STEP: f32 = 1e-4;

impl Bsdf<'_> {
    /// Lambert's law on both sides.
    pub fn diffuse(reflectance: Lanes) -> Self {
        Self::Diffuse(Diffuse { reflectance, sides: Sides::Both })
    }

    /// The interface of a dielectric whose inside (−z) has `eta` times the index of its outside; rough when either
    /// `alpha` \[1\] reaches [`SMOOTHEST_ALPHA`](super::SMOOTHEST_ALPHA). Without a step of the index it is smooth, and lets all light straight
    /// through.
    pub fn dielectric(eta: f32, alpha_x: f32, alpha_y: f32) -> Self {
        match Microfacets::unless_smooth(alpha_x, alpha_y) {
            Some(microfacets) if (eta - 1.0).abs() >= LEAST_INDEX_STEP => {
                Self::RoughDielectric(RoughDielectric { interface: Dielectric::new(eta), microfacets })
            }
            _ => Self::Dielectric(Dielectric::new(eta)),
        }
    }

    /// A thin sheet of index `eta` relative to its surroundings, each lane its own.
    pub fn thin_dielectric(eta: Lanes) -> Self {
        Self::ThinDielectric(ThinDielectric { eta, reflectance: Lanes::ONE, transmittance: Lanes::ONE })
    }

    /// Lambert's law on both sides of a sheet.
    pub fn diffuse_transmission(reflectance: Lanes, transmittance: Lanes) -> Self {
        Self::DiffuseTransmission(DiffuseTransmission { reflectance, transmittance })
    }

    /// A metal of complex index `eta + i·k` (relative to the outside, each lane its own) on both sides; rough when
    /// either `alpha` \[1\] reaches [`SMOOTHEST_ALPHA`](super::SMOOTHEST_ALPHA).
    pub fn conductor(eta: Lanes, k: Lanes, alpha_x: f32, alpha_y: f32) -> Self {
        let smooth = Conductor { eta, k, reflectance: Lanes::ONE, sides: Sides::Both };
        match Microfacets::unless_smooth(alpha_x, alpha_y) {
            Some(microfacets) => Self::RoughConductor(RoughConductor { metal: smooth, microfacets }),
            None => Self::Conductor(smooth),
        }
    }

    /// A metal with this reflectance in [0, 1] at normal incidence: [`index_of_reflectance`].
    pub fn conductor_of_reflectance(reflectance: Lanes, alpha_x: f32, alpha_y: f32) -> Self {
        let [eta, k] = index_of_reflectance(reflectance);
        Self::conductor(eta, k, alpha_x, alpha_y)
    }

    /// The same model with every reflection multiplied by `reflectance` and every transmission by `transmittance`
    /// (Mitsuba's `specular_reflectance` and `specular_transmittance`); 1 is physical, and more gains energy. What is
    /// under a coat, what was measured and hair take no tints.
    #[must_use]
    pub fn tinted(mut self, reflectance: Lanes, transmittance: Lanes) -> Self {
        match &mut self {
            Self::Diffuse(model) => model.reflectance *= reflectance,
            Self::Conductor(model) => model.reflectance *= reflectance,
            Self::Plastic(model) => model.reflectance *= reflectance,
            Self::RoughPlastic(model) => model.reflectance *= reflectance,
            Self::RoughConductor(model) => model.metal.reflectance *= reflectance,
            Self::Dielectric(model) => model.tint(reflectance, transmittance),
            Self::RoughDielectric(model) => model.interface.tint(reflectance, transmittance),
            Self::ThinDielectric(model) => {
                model.reflectance *= reflectance;
                model.transmittance *= transmittance;
            }
            Self::DiffuseTransmission(model) => {
                model.reflectance *= reflectance;
                model.transmittance *= transmittance;
            }
            // Their colours tint them.
            Self::Coated(_)
            | Self::Measured(_)
            | Self::Principled(_)
            | Self::PrincipledThin(_)
            | Self::Hair(_)
            | Self::Null => {}
        }
        self
    }

    /// The same model with other random numbers, if it has any: [`Coated`](super::Coated).
    #[must_use]
    #[inline]
    pub fn seeded(mut self, seed: impl FnOnce() -> u32) -> Self {
        if let Self::Coated(model) = &mut self {
            model.seed = seed();
        }
        self
    }

    /// The same model with its microfacets, if it has any, after other laws of slopes and of shadowing.
    #[must_use]
    pub fn distributed(mut self, distribution: Distribution, shadowing: Shadowing) -> Self {
        let microfacets = match &mut self {
            Self::RoughConductor(model) => &mut model.microfacets,
            Self::RoughDielectric(model) => &mut model.microfacets,
            Self::Diffuse(_)
            | Self::Conductor(_)
            | Self::Dielectric(_)
            | Self::ThinDielectric(_)
            | Self::DiffuseTransmission(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_)
            | Self::Principled(_)
            | Self::PrincipledThin(_)
            | Self::Coated(_)
            | Self::Measured(_)
            | Self::Hair(_)
            | Self::Null => return self,
        };
        (microfacets.distribution, microfacets.shadowing) = (distribution, shadowing);
        self
    }

    /// The same model answering on `sides`; interfaces and coats always have two.
    #[must_use]
    pub fn on(mut self, sides: Sides) -> Self {
        match &mut self {
            Self::Diffuse(model) => model.sides = sides,
            Self::Conductor(model) => model.sides = sides,
            Self::RoughConductor(model) => model.metal.sides = sides,
            Self::Plastic(model) => model.sides = sides,
            Self::Measured(model) => model.sides = sides,
            Self::RoughPlastic(model) => model.sides = sides,
            Self::Dielectric(_)
            | Self::RoughDielectric(_)
            | Self::ThinDielectric(_)
            | Self::DiffuseTransmission(_)
            | Self::Principled(_)
            | Self::PrincipledThin(_)
            | Self::Coated(_)
            | Self::Hair(_)
            | Self::Null => {}
        }
        self
    }
}

/// A complex index \[1\] with this reflectance at normal incidence: 1 and `k = 2√r / √(1 − r)`, `r` in [0, 0.9999] (pbrt's
/// parameter `reflectance`).
pub fn index_of_reflectance(reflectance: Lanes) -> [Lanes; 2] {
    let k = reflectance.map(|r| {
        let r = r.clamp(0.0, 0.9999);
        2.0 * r.sqrt() / (1.0 - r).sqrt()
    });
    [Lanes::ONE, k]
}
