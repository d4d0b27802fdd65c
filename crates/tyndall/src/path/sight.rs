//! How light is sampled from the last vertex of a path that scattered: what multiple importance sampling must know when the path
//! runs into a light.

use crate::{math::Vec3, medium::MediumId, scene::Lit};

/// How light was sampled there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sight {
    /// Straight.
    Straight,
    /// Through a wall at which light samples bend; the path has not passed one since.
    Behind,
    /// The path has passed such a wall.
    Past(PassedWall),
}

/// Where a light sample that bends starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// The place [length].
    pub p: Vec3,
    /// The medium there.
    pub medium: MediumId,
    /// How far the wall is looked for [length].
    pub reach: f32,
}

/// A wall that a path has passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassedWall {
    /// Where light was sampled.
    pub start: Start,
    /// In which direction the path went from there.
    pub dir: Vec3,
}

impl From<Lit> for Sight {
    fn from(lit: Lit) -> Self {
        match lit {
            Lit::Bent => Self::Behind,
            Lit::Straight | Lit::Never => Self::Straight,
        }
    }
}
