//! A polished metal: a mirror with Fresnel's reflectance for a complex index.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `eta` | real part of the index relative to the outside, each lane its own \[1\] | ≥ 0 |
//! | `k` | imaginary part, the extinction coefficient \[1\] | ≥ 0 |
//! | `reflectance` | multiplier of all that is reflected \[1\] | [0, 1]; 1 is physical |
//! | `sides` | which sides reflect | |
//!
//! `eta = 0` with `k = 1` is the perfect mirror. Source: Born and Wolf 1999, § 14.2.

use super::{BsdfSample, ScatterKind, Sides, fresnel, mirrored};
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// A smooth metal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conductor {
    /// Real part of the relative index \[1\].
    pub eta: Lanes,
    /// Imaginary part of the relative index \[1\].
    pub k: Lanes,
    /// Multiplier of the reflection \[1\].
    pub reflectance: Lanes,
    /// Which sides reflect; the other is black.
    pub sides: Sides,
}

impl Conductor {
    /// Reflected fraction of the power \[1\] at the cosine `cos_i` to the (micro)facet's normal.
    #[inline]
    pub fn reflected(&self, cos_i: f32) -> Lanes {
        fresnel::conductor(cos_i, self.eta, self.k) * self.reflectance
    }

    /// The mirrored direction.
    #[inline]
    pub fn sample(&self, wo: Vec3) -> Option<BsdfSample> {
        self.sides.answer(wo).then(|| BsdfSample {
            wi: mirrored(wo),
            weight: self.reflected(wo.z.abs()),
            pdf: 1.0,
            kind: ScatterKind::Reflection,
            specular: true,
            eta: 1.0,
        })
    }
}
