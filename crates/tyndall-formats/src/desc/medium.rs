//! Participating media.

use super::{EmissionDesc, MediumId, Span, Spanned, SpectrumDesc};

/// A homogeneous medium.
#[derive(Clone, Debug, PartialEq)]
pub struct MediumDesc {
    /// The words that made it.
    pub span: Span,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// What it does to light.
    pub coefficients: Coefficients,
    /// Factor on both coefficients, at least 0.
    pub scale: Spanned<f64>,
    /// Where it scatters to.
    pub phase: PhaseDesc,
    /// Light that it emits \[W·m⁻²·sr⁻¹ per unit of absorption\]: what is added to the radiance along a ray is `sigma_a · Le`.
    pub emission: Option<EmissionDesc>,
}

/// Absorption and scattering, in the words that the user chose.
#[derive(Clone, Debug, PartialEq)]
pub enum Coefficients {
    /// Measured ones of this name \[1/mm\].
    Preset {
        /// The material.
        name: Spanned<String>,
        /// Whether scattering is the reduced coefficient, to be isotropic (pbrt), or the full one with its mean cosine.
        reduced: bool,
    },
    /// Those of a mixture, with its own phase function.
    Recipe {
        /// Its name, in `tyndall_optics::recipe`.
        name: Spanned<String>,
        /// What it asks for, in its order and units.
        values: Vec<f64>,
    },
    /// Both coefficients.
    AbsorptionScattering {
        /// Absorption \[1/scene unit\].
        sigma_a: Spanned<SpectrumDesc>,
        /// Scattering \[1/scene unit\].
        sigma_s: Spanned<SpectrumDesc>,
    },
    /// Both coefficients, per millimetre.
    PerMillimetre {
        /// Absorption \[1/mm\].
        sigma_a: Spanned<SpectrumDesc>,
        /// Scattering \[1/mm\].
        sigma_s: Spanned<SpectrumDesc>,
    },
    /// What a flat and deep body returns of the light that gets through its surface, and how far light flies in it.
    Reflectance {
        /// Share of the entering light that comes out again, under the same radiance from everywhere, in [0, 1].
        reflectance: Spanned<SpectrumDesc>,
        /// Mean free path 1/σ_t \[mm\].
        mfp: Spanned<SpectrumDesc>,
        /// Index of refraction of the body relative to the outside, at a smooth boundary.
        eta: f64,
    },
    /// Their sum, and the part of it that scatters.
    ExtinctionAlbedo {
        /// Extinction \[1/scene unit\].
        sigma_t: Spanned<SpectrumDesc>,
        /// Single-scattering albedo, in [0, 1].
        albedo: Spanned<SpectrumDesc>,
    },
}

/// A phase function.
#[derive(Clone, Debug, PartialEq)]
pub enum PhaseDesc {
    /// The same in all directions.
    Isotropic,
    /// Henyey and Greenstein's.
    HenyeyGreenstein {
        /// Mean cosine, in (-1, 1): positive is forward.
        g: Spanned<f64>,
    },
    /// Rayleigh's, of particles far smaller than the wavelength.
    Rayleigh,
    /// By a table (Mitsuba).
    Tabulated {
        /// Relative values at regularly spaced cosines, from -1 (straight back) to 1 (straight on).
        values: Spanned<Vec<f64>>,
    },
    /// Two others, weighed (Mitsuba).
    Blend {
        /// They.
        of: Box<[Self; 2]>,
        /// How much of the second, in [0, 1].
        weight: Spanned<f64>,
    },
}

/// What is on either side of a surface. `None` is empty space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumInterface {
    /// The words that said so.
    pub span: Span,
    /// On the side that the normal points away from.
    pub inside: Option<MediumId>,
    /// On the side that the normal points to.
    pub outside: Option<MediumId>,
}
