//! Who is inside what: boundaries between media, and the medium that a path is in.

use super::{Coefficients, MediumId};
use crate::{scene::Scene, spectrum::Wavelengths};

/// The media on the two sides of a surface; `None` is vacuum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MediumInterface {
    /// On the side opposite to the normal.
    pub inside: Option<MediumId>,
    /// On the side of the normal.
    pub outside: Option<MediumId>,
}

impl MediumInterface {
    /// The medium that light enters which leaves the surface with `cos_normal = dir · n`.
    #[inline]
    pub fn towards(&self, cos_normal: f32) -> Option<MediumId> {
        if cos_normal > 0.0 { self.outside } else { self.inside }
    }
}

/// The medium that a path is in, with its coefficients at the path's wavelengths.
#[derive(Debug, Clone, Copy)]
pub enum Inside {
    /// Nothing scatters here.
    Vacuum,
    /// A scattering or absorbing medium.
    Medium {
        /// Which.
        id: MediumId,
        /// Its coefficients in the lanes of the path.
        coefficients: Coefficients,
    },
    /// Several media share the place: their coefficients are added. Which they are, [`super::Within`] knows.
    Mixture {
        /// The sums.
        coefficients: Coefficients,
    },
}

impl Inside {
    /// In medium `id` of the scene.
    #[inline]
    pub fn of(scene: &Scene, id: Option<MediumId>, wavelengths: &Wavelengths) -> Self {
        id.map_or(Self::Vacuum, |id| Self::Medium { id, coefficients: scene.medium(id).coefficients(wavelengths) })
    }

    /// Its id, `None` for vacuum and for a mixture.
    pub fn id(&self) -> Option<MediumId> {
        match self {
            Self::Vacuum | Self::Mixture { .. } => None,
            Self::Medium { id, .. } => Some(*id),
        }
    }

    /// The coefficients, unless nothing is here.
    #[inline]
    pub fn coefficients(&self) -> Option<&Coefficients> {
        match self {
            Self::Vacuum => None,
            Self::Medium { coefficients, .. } | Self::Mixture { coefficients } => Some(coefficients),
        }
    }
}
