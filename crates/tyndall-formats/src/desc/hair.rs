//! Hair.

use super::{Spanned, Varying};

/// A fibre of hair.
#[derive(Clone, Debug, PartialEq)]
pub struct HairDesc {
    /// What it absorbs.
    pub colour: HairColourDesc,
    /// Refractive index of the fibre relative to the outside, above 1.
    pub eta: Spanned<Varying>,
    /// Roughness along the fibre, in [0, 1].
    pub beta_m: Spanned<Varying>,
    /// Roughness round the fibre, in [0, 1].
    pub beta_n: Spanned<Varying>,
    /// Tilt of the scales, in degrees.
    pub alpha: Spanned<Varying>,
}

/// What a fibre absorbs.
#[derive(Clone, Debug, PartialEq)]
pub enum HairColourDesc {
    /// Absorption in units of 1/radius.
    SigmaA(Spanned<Varying>),
    /// As much as makes a bundle look of this colour (pbrt).
    Reflectance(Spanned<Varying>),
    /// Concentrations of pigments, at least 0.
    Pigments {
        /// Brown to black.
        eumelanin: Spanned<Varying>,
        /// Red.
        pheomelanin: Spanned<Varying>,
    },
}

impl HairDesc {
    pub(super) fn quantities(&self) -> Vec<&Spanned<Varying>> {
        let colour = match &self.colour {
            HairColourDesc::SigmaA(colour) | HairColourDesc::Reflectance(colour) => vec![colour],
            HairColourDesc::Pigments { eumelanin, pheomelanin } => vec![eumelanin, pheomelanin],
        };
        colour.into_iter().chain([&self.eta, &self.beta_m, &self.beta_n, &self.alpha]).collect()
    }
}
