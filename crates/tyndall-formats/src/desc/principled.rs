//! Burley's two models (Mitsuba's `principled` and `principledthin`).

use super::{Spanned, Varying};

/// What both have. All are in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct BurleyDesc {
    /// Colour.
    pub base_color: Spanned<Varying>,
    /// Roughness.
    pub roughness: Spanned<Varying>,
    /// How much longer highlights are along the first tangent.
    pub anisotropic: Spanned<Varying>,
    /// How much of it is clear.
    pub spec_trans: Spanned<Varying>,
    /// How far reflections have the hue of the colour.
    pub spec_tint: Spanned<Varying>,
    /// How much light grazing dust sends on.
    pub sheen: Spanned<Varying>,
    /// How far that has the hue of the colour.
    pub sheen_tint: Spanned<Varying>,
    /// From diffuse to a likeness of subsurface scattering.
    pub flatness: Spanned<Varying>,
}

/// Solids.
#[derive(Clone, Debug, PartialEq)]
pub struct PrincipledDesc {
    /// What both models have.
    pub burley: BurleyDesc,
    /// How much of it is metal, in [0, 1].
    pub metallic: Spanned<Varying>,
    /// How much coat there is, in [0, 1].
    pub clearcoat: Spanned<Varying>,
    /// How polished the coat is, in [0, 1].
    pub clearcoat_gloss: Spanned<Varying>,
    /// Refractive index of the inside relative to the outside, greater than 0 and not 1 where anything is clear.
    pub eta: f64,
    /// How often lobes are drawn, relative to their shares, at least 0: base, highlight and glass, coat.
    pub rates: [f64; 3],
}

/// Sheets.
#[derive(Clone, Debug, PartialEq)]
pub struct PrincipledThinDesc {
    /// What both models have.
    pub burley: BurleyDesc,
    /// Refractive index of the sheet relative to its surroundings.
    pub eta: Spanned<Varying>,
    /// Twice the share of the base that goes through, in [0, 2].
    pub diff_trans: Spanned<Varying>,
    /// How often lobes are drawn, relative to their shares, at least 0: base and highlight on the near side, the same on the
    /// far side.
    pub rates: [[f64; 2]; 2],
}

impl BurleyDesc {
    fn quantities(&self) -> [&Spanned<Varying>; 8] {
        let Self { base_color, roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness } = self;
        [base_color, roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness]
    }
}

impl PrincipledDesc {
    pub(super) fn quantities(&self) -> Vec<&Spanned<Varying>> {
        let own = [&self.metallic, &self.clearcoat, &self.clearcoat_gloss];
        self.burley.quantities().into_iter().chain(own).collect()
    }
}

impl PrincipledThinDesc {
    pub(super) fn quantities(&self) -> Vec<&Spanned<Varying>> {
        self.burley.quantities().into_iter().chain([&self.eta, &self.diff_trans]).collect()
    }
}
