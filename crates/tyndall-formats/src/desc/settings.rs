//! Settings: units, samples, integrator, and what had no effect.

use tyndall::{film::LayerKind, integrator::Counted};

use super::{Span, Spanned};

/// Settings of the scene as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What one scene unit is. Millimetres by default, because measured media are per millimetre.
    pub unit: Spanned<LengthUnit>,
    /// Seed of the random numbers, if the scene says.
    pub seed: Option<Spanned<u64>>,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// 10⁻⁹ m.
    Nanometre,
    /// 10⁻⁶ m.
    Micrometre,
    /// 10⁻³ m.
    Millimetre,
    /// 10⁻² m.
    Centimetre,
    /// The metre.
    Metre,
    /// 10³ m.
    Kilometre,
    /// 25.4 mm.
    Inch,
    /// 304.8 mm.
    Foot,
}

impl LengthUnit {
    /// Every unit with its word in scene files.
    pub const ALL: [(&'static str, Self); 8] = [
        ("nm", Self::Nanometre),
        ("um", Self::Micrometre),
        ("mm", Self::Millimetre),
        ("cm", Self::Centimetre),
        ("m", Self::Metre),
        ("km", Self::Kilometre),
        ("in", Self::Inch),
        ("ft", Self::Foot),
    ];

    /// The unit of a word.
    pub fn parse(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(name, _)| *name == word).map(|(_, unit)| unit)
    }

    /// How long it is \[mm\]. A coefficient given per millimetre is multiplied by this to be per unit.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Nanometre => 1e-6,
            Self::Micrometre => 1e-3,
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1e3,
            Self::Kilometre => 1e6,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
        }
    }
}

/// How many samples, and which.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerDesc {
    /// The language's word for it (`independent`, `zsobol`, …): recorded, tyndall has one sampler.
    pub kind: Spanned<String>,
    /// Samples a pixel, at least 1.
    pub spp: Spanned<u32>,
    /// Seed, if given here.
    pub seed: Option<Spanned<u64>>,
}

/// How light is transported.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorDesc {
    /// The language's word for it (`path`, `volpath`, …).
    pub name: Spanned<String>,
    /// The most scatterings of a path (0: only light seen directly), if the user limits them. Mitsuba's `max_depth` counts
    /// one more. Where the user wrote nothing there is no limit, also where the language's own renderer has one.
    pub max_depth: Option<Spanned<u32>>,
    /// What counts as a scattering for that.
    pub counted: Counted,
    /// Grains that a path leaves before it goes on in their proxy, if the user wants that: see [`tyndall::granular`].
    pub explicit_grains: Option<Spanned<u32>>,
    /// Scatterings before Russian roulette may begin, if the user says.
    pub rr_depth: Option<Spanned<u32>>,
    /// Whether emission that the camera sees directly is left out.
    pub hide_emitters: bool,
    /// What is to be recorded beside light, if the integrator says.
    pub layers: Vec<LayerKind>,
}

/// Words that were read and understood, and change nothing here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ignored {
    /// The words.
    pub span: Span,
    /// Why they change nothing.
    pub reason: &'static str,
}
