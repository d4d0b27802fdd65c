//! A base under a coat, as the scene has it.

use super::{Index, Metal, Roughness, share};
use crate::{
    bsdf::{Base, Bsdf, Coated},
    spectrum::Wavelengths,
    texture::{Texture, TexturePoint},
};

/// The greatest magnitude of a coat's mean cosine: beyond, its phase function is a Dirac.
const MOST_G: f32 = 0.9999;

/// A base under a coat: [`Coated`] has the model.
#[derive(Debug, Clone)]
pub struct CoatedMaterial {
    /// Index of the coat over that outside [1].
    pub eta: Index,
    /// The microfacets of its surface, after Trowbridge and Reitz, where it is rough.
    pub alpha: Roughness,
    /// Thickness of the coat [mean free paths].
    pub thickness: Texture,
    /// The share of what it extinguishes that it scatters [1].
    pub albedo: Texture,
    /// Mean cosine of that scattering [1].
    pub g: Texture,
    /// What is under it.
    pub base: CoatedBase,
    /// Scatterings between the way in and the way out after which light is lost [1].
    pub max_depth: u16,
    /// Walks of one evaluation, at least 1 [1].
    pub walks: u16,
}

/// What is under a coat.
#[derive(Debug, Clone)]
pub enum CoatedBase {
    /// Lambert's law with this reflectance [1].
    Diffuse(Texture),
    /// A metal.
    Metal {
        /// How it reflects where there is no coat.
        metal: Metal,
        /// Its microfacets, after Trowbridge and Reitz, where it is rough.
        alpha: Box<Roughness>,
    },
}

impl CoatedMaterial {
    /// The BSDF in the lanes of a path, with the index of the coat at the wavelength of lane `hero`.
    pub(super) fn bsdf(&self, at: &TexturePoint, wavelengths: &Wavelengths, hero: usize) -> Bsdf<'static> {
        let eta = self.eta.at(wavelengths, hero);
        let [alpha_x, alpha_y] = self.alpha.at(at);
        Bsdf::Coated(Coated {
            eta,
            alpha_x,
            alpha_y,
            thickness: self.thickness.scalar(at).max(0.0),
            albedo: share(&self.albedo, at, wavelengths),
            g: self.g.scalar(at).clamp(-MOST_G, MOST_G),
            base: self.base.bsdf(eta, at, wavelengths),
            max_depth: self.max_depth,
            walks: self.walks,
            seed: 0,
        })
    }
}

impl CoatedBase {
    fn bsdf(&self, coat: f32, at: &TexturePoint, wavelengths: &Wavelengths) -> Base {
        match self {
            Self::Diffuse(reflectance) => Base::Diffuse(share(reflectance, at, wavelengths)),
            Self::Metal { metal, alpha } => {
                let [eta, k] = metal.index(at, wavelengths).map(|part| part / coat);
                let [alpha_x, alpha_y] = alpha.at(at);
                Base::Metal { eta, k, alpha_x, alpha_y }
            }
        }
    }
}
