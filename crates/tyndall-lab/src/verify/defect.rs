//! Deliberate defects: what a verifier must not overlook.
//!
//! A defect is put into the scene of an experiment, where every medium and surface of the renderer gets it, while the
//! expected numbers stay what they are. A table that nothing can fail proves nothing: the module `slow` of the tests
//! puts each of the defects that a table claims to see into its experiments and demands that they fail.

use std::sync::Arc;

use tyndall::{
    material::{HairColour, Index, Material},
    phase::Phase,
    scene::Scene,
    spectrum::{Spectrum, Wavelengths},
    texture::Texture,
};

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Fault {
    /// Scattering coefficients are too large.
    Scattering,
    /// Absorption coefficients are too large.
    Absorption,
    /// Phase functions integrate to less than 1: of what collides less goes on.
    PhaseNormalisation,
    /// Mean cosines of phase functions are too small.
    MeanCosine,
    /// Relative refractive indices are too large.
    Index,
    /// The Fresnel term is too small: less is reflected, no more goes through.
    Fresnel,
    /// Surfaces reflect too little.
    Reflectance,
}

/// A fault and its size.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Defect {
    /// What is wrong.
    pub fault: Fault,
    /// By what part of itself \[1\].
    pub size: f32,
}

impl Defect {
    /// The scene with the defect.
    pub(crate) fn spoil(self, mut scene: Scene) -> Scene {
        let (more, less) = (1.0 + self.size, 1.0 - self.size);
        for medium in Arc::make_mut(&mut scene.media) {
            match self.fault {
                Fault::Scattering => medium.sigma_s = medium.sigma_s.clone().scaled(more),
                Fault::Absorption => medium.sigma_a = medium.sigma_a.clone().scaled(more),
                Fault::PhaseNormalisation => {
                    // What a collision loses is as good as absorbed. Media of experiments are grey.
                    let [a, s] = [&medium.sigma_a, &medium.sigma_s].map(|sigma| sigma.eval(&Wavelengths::Mono).lane(0));
                    medium.sigma_a = Spectrum::constant(a + s * self.size);
                    medium.sigma_s = Spectrum::constant(s * less);
                }
                Fault::MeanCosine => {
                    if let Phase::HenyeyGreenstein(model) = medium.phase {
                        // A smaller mean cosine is within the range that the model had.
                        medium.phase = Phase::henyey_greenstein(model.mean_cosine() * less)
                            .unwrap_or_else(|_| medium.phase.clone());
                    }
                }
                Fault::Index | Fault::Fresnel | Fault::Reflectance => {}
            }
        }
        for material in Arc::make_mut(&mut scene.materials) {
            match (self.fault, material) {
                (Fault::Index, Material::Dielectric { eta: Index::Constant(eta), .. }) => *eta *= more,
                (Fault::Fresnel, Material::Dielectric { reflection_tint, .. }) => *reflection_tint = less.into(),
                (Fault::Index, Material::Hair(hair)) => scale(&mut hair.eta, more),
                (Fault::Absorption, Material::Hair(hair)) => {
                    if let HairColour::SigmaA(sigma_a) = &mut hair.colour {
                        scale(sigma_a, more);
                    }
                }
                (Fault::Reflectance, Material::Diffuse { reflectance, .. }) => scale(reflectance, less),
                _ => {}
            }
        }
        scene
    }
}

/// Textures of experiments are constant.
fn scale(texture: &mut Texture, by: f32) {
    if let Texture::Constant(spectrum) = texture {
        *spectrum = spectrum.clone().scaled(by);
    }
}
