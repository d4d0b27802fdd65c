//! Burley's two models as the scene has them: every parameter may vary over the surface.

use crate::{
    bsdf::{Bsdf, Burley, Principled, PrincipledFixed, PrincipledThin, ThinRates},
    spectrum::{Lanes, Wavelengths, srgb::LUMINANCE},
    texture::{Texture, TexturePoint},
};

/// What both models have; see [`Burley`].
#[derive(Debug, Clone)]
pub struct BurleyTextures {
    /// Colour [1].
    pub colour: Texture,
    /// Roughness [1].
    pub roughness: Texture,
    /// How much longer highlights are along the first tangent [1].
    pub anisotropic: Texture,
    /// How much of the model is clear [1].
    pub spec_trans: Texture,
    /// How far reflections have the hue of the colour [1].
    pub spec_tint: Texture,
    /// How much light grazing dust sends on [1].
    pub sheen: Texture,
    /// How far that has the hue of the colour [1].
    pub sheen_tint: Texture,
    /// From diffuse to a likeness of subsurface scattering [1].
    pub flatness: Texture,
}

/// Solids; see [`Principled`].
#[derive(Debug, Clone)]
pub struct PrincipledTextures {
    /// Colour, roughness and the lobes of the base.
    pub burley: BurleyTextures,
    /// How much of it is metal [1].
    pub metallic: Texture,
    /// How much coat there is [1].
    pub clearcoat: Texture,
    /// How polished the coat is [1].
    pub clearcoat_gloss: Texture,
    /// What is the same everywhere.
    pub fixed: PrincipledFixed,
}

/// Sheets; see [`PrincipledThin`].
#[derive(Debug, Clone)]
pub struct ThinTextures {
    /// Colour, roughness and the lobes of the base.
    pub burley: BurleyTextures,
    /// Index of the sheet over that outside [1].
    pub eta: Texture,
    /// Twice the share of the base that goes through, 0 to 2 [1].
    pub diff_trans: Texture,
    /// How often lobes are drawn.
    pub rates: ThinRates,
}

impl BurleyTextures {
    #[inline]
    fn at(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Burley {
        let colour = self.colour.eval(at, wavelengths);
        let (spec_tint, sheen_tint) = (self.spec_tint.scalar(at), self.sheen_tint.scalar(at));
        let tinted = spec_tint > 0.0 || sheen_tint > 0.0;
        Burley {
            colour: colour.to_array(),
            // Of the colour itself: four wavelengths alone do not tell it.
            luminance: if tinted { luminance(self.colour.eval(at, &Wavelengths::Rgb)) } else { 1.0 },
            roughness: self.roughness.scalar(at),
            anisotropic: self.anisotropic.scalar(at),
            spec_trans: self.spec_trans.scalar(at),
            spec_tint,
            sheen: self.sheen.scalar(at),
            sheen_tint,
            flatness: self.flatness.scalar(at),
        }
    }
}

impl PrincipledTextures {
    #[inline]
    pub(super) fn bsdf(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Bsdf<'_> {
        Bsdf::Principled(Principled {
            burley: self.burley.at(at, wavelengths),
            metallic: self.metallic.scalar(at),
            clearcoat: self.clearcoat.scalar(at),
            clearcoat_gloss: self.clearcoat_gloss.scalar(at),
            fixed: &self.fixed,
        })
    }
}

impl ThinTextures {
    #[inline]
    pub(super) fn bsdf(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Bsdf<'_> {
        Bsdf::PrincipledThin(PrincipledThin {
            burley: self.burley.at(at, wavelengths),
            eta: self.eta.scalar(at),
            diff_trans: (0.5 * self.diff_trans.scalar(at)).min(1.0),
            rates: &self.rates,
        })
    }
}

/// The luminance of linear sRGB (ITU-R BT.709).
fn luminance(rgb: Lanes) -> f32 {
    (0..3).map(|c| LUMINANCE[c] * rgb.lane(c)).sum()
}
