//! The alphabet: what happens to a path, as expressions spell it.

use crate::path::turn::{Kind, Source, Turn};

/// The letters, each a bit of [`Letters`]: reflection and transmission of each kind, volume; light, object, background;
/// camera.
pub(super) const COUNT: usize = 11;
/// Of these, the scatterings.
pub(super) const TURNS: usize = 7;
/// And the sources.
pub(super) const SOURCES: usize = 3;

/// A set of letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Letters(pub(super) u16);

impl Letters {
    /// Sharp, glossy and diffuse reflection.
    pub const R: Self = Self(0b111);
    /// Sharp, glossy and diffuse transmission.
    pub const T: Self = Self(0b111 << 3);
    /// Scattering in a medium.
    pub const V: Self = Self(1 << 6);
    /// A light.
    pub const L: Self = Self(1 << 7);
    /// Matter that glows.
    pub const O: Self = Self(1 << 8);
    /// The background.
    pub const B: Self = Self(1 << 9);
    /// The camera.
    pub const C: Self = Self(1 << 10);
    /// Sharp reflection and transmission.
    pub const S: Self = Self(0b001_001);
    /// Glossy reflection and transmission.
    pub const G: Self = Self(0b010_010);
    /// Diffuse reflection and transmission.
    pub const D: Self = Self(0b100_100);
    /// Everything.
    pub const ALL: Self = Self((1 << COUNT) - 1);
    /// None.
    pub const NONE: Self = Self(0);

    /// Those that are in one of the two.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are in both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The others.
    #[must_use]
    pub fn others(self) -> Self {
        Self(!self.0 & Self::ALL.0)
    }

    /// Whether a letter is among them.
    pub fn has(self, letter: usize) -> bool {
        self.0 >> letter & 1 == 1
    }

    /// Whether all of the others are among them.
    pub fn include(self, other: Self) -> bool {
        self.and(other) == other
    }
}

/// The number of a scattering's letter.
#[inline]
pub fn of_turn(turn: Turn) -> usize {
    match turn {
        Turn::Surface { crossed, kind, .. } => {
            let kind = match kind {
                Kind::Specular => 0,
                Kind::Glossy => 1,
                Kind::Diffuse => 2,
            };
            kind + if crossed { 3 } else { 0 }
        }
        Turn::Medium(_) => 6,
    }
}

/// The number of a source's letter, after those of the scatterings; none for what is no light.
#[inline]
pub fn of_source(source: Source) -> Option<usize> {
    match source {
        Source::Light(_) => Some(7),
        Source::Medium(_) => Some(8),
        Source::Sky(_) => Some(9),
        Source::Fault => None,
    }
}
