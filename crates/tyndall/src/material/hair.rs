//! Hair as the scene has it: every parameter may vary along the strands.

use crate::{
    bsdf::{Bsdf, hair::Hair},
    spectrum::{Spectrum, Wavelengths},
    texture::{Texture, TexturePoint},
};

/// A fibre; see [`Hair`].
#[derive(Debug, Clone)]
pub struct HairTextures {
    /// What it absorbs.
    pub colour: HairColour,
    /// Index of the fibre over that outside [1].
    pub eta: Texture,
    /// Roughness along the fibre, 0 to 1 [1].
    pub beta_m: Texture,
    /// Roughness round the fibre, 0 to 1 [1].
    pub beta_n: Texture,
    /// Tilt of the scales [degrees].
    pub alpha: Texture,
}

/// What a fibre absorbs.
#[derive(Debug, Clone)]
pub enum HairColour {
    /// Absorption [1/radius].
    SigmaA(Texture),
    /// As much as makes a bundle of fibres look of this colour [1].
    Reflectance(Texture),
    /// By its pigments.
    Pigments(Box<Pigments>),
}

/// Pigments of hair: brown to black, and red.
#[derive(Debug, Clone)]
pub struct Pigments {
    /// Concentration of eumelanin [1].
    pub eumelanin: Texture,
    /// Concentration of pheomelanin [1].
    pub pheomelanin: Texture,
    /// What a unit of either absorbs [1/radius].
    pub absorb: [Spectrum; 2],
}

impl Pigments {
    /// With the absorption [1/radius] of d'Eon et al. 2011, § 6.1, in linear sRGB.
    pub fn new(eumelanin: Texture, pheomelanin: Texture) -> Self {
        let absorb = [[0.419, 0.697, 1.37], [0.187, 0.4, 1.05]].map(Spectrum::unbounded_rgb);
        Self { eumelanin, pheomelanin, absorb }
    }
}

impl HairTextures {
    #[inline]
    pub(super) fn bsdf(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Bsdf<'_> {
        let beta_n = self.beta_n.scalar(at);
        let sigma_a = match &self.colour {
            HairColour::SigmaA(texture) => texture.eval(at, wavelengths).map(|v| v.max(0.0)),
            HairColour::Reflectance(texture) => Hair::sigma_a_of_reflectance(texture.eval(at, wavelengths), beta_n),
            HairColour::Pigments(pigments) => {
                let amounts = [&pigments.eumelanin, &pigments.pheomelanin].map(|t| t.scalar(at).max(0.0));
                let [eumelanin, pheomelanin] = [0, 1].map(|i| pigments.absorb[i].eval(wavelengths) * amounts[i]);
                (eumelanin + pheomelanin).map(|v| v.max(0.0))
            }
        };
        let alpha = self.alpha.scalar(at).to_radians();
        let h = 2.0 * at.uv.get().y - 1.0;
        Bsdf::Hair(Hair::new(h, self.eta.scalar(at), sigma_a, [self.beta_m.scalar(at), beta_n], alpha))
    }
}
