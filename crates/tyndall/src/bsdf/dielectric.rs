//! A smooth dielectric: clear glass, water, the surface of milk.
//!
//! Two Dirac lobes: a mirror with Fresnel's reflectance `F`, and refraction with `1 − F`, which as radiance also carries
//! `1/η²`. One of them is chosen with its share of the power, so that the weight of a reflection is 1 and that of a
//! transmission `1/η²`: nothing is lost. With `eta = 1` all light passes straight on.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `eta` | index inside (the −z side) over index outside \[1\] | > 0: water 1.33, glass 1.5 |
//! | `reflectance`, `transmittance` | multipliers of the lobes \[1\] | [0, 1]; 1 is physical |
//!
//! Source: Born and Wolf 1999, § 1.5; radiance through an interface: Veach 1997, § 5.2.

use super::{BsdfSample, ScatterKind, fresnel, mirrored};
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// A smooth interface between two dielectrics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dielectric {
    /// Index inside over index outside \[1\].
    pub eta: f32,
    /// Multiplier of the reflection \[1\].
    pub reflectance: Lanes,
    /// Multiplier of the transmission \[1\].
    pub transmittance: Lanes,
}

/// How an interface shares the light that meets a (micro)facet: lane-wise fractions of the power, and the probability
/// with which the reflection is sampled.
#[derive(Debug, Clone, Copy)]
pub(super) struct Split {
    pub(super) reflected: Lanes,
    pub(super) transmitted: Lanes,
    pub(super) p_reflect: f32,
}

impl Dielectric {
    /// Clear, with `eta` (> 0) the index inside over the index outside.
    pub fn new(eta: f32) -> Self {
        Self { eta, reflectance: Lanes::ONE, transmittance: Lanes::ONE }
    }

    pub(super) fn tint(&mut self, reflectance: Lanes, transmittance: Lanes) {
        self.reflectance *= reflectance;
        self.transmittance *= transmittance;
    }

    /// Index beyond the surface over the index on the side of `wo`.
    #[inline]
    pub(super) fn eta_from(&self, wo: Vec3) -> f32 {
        if wo.z > 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// The shares for the Fresnel reflectance `f`; `None` when the tints leave nothing.
    #[inline]
    pub(super) fn split(&self, f: f32) -> Option<Split> {
        let (reflected, transmitted) = (self.reflectance * f, self.transmittance * (1.0 - f));
        let (r, t) = (reflected.max_lane(), transmitted.max_lane());
        (r + t > 0.0).then(|| Split { reflected, transmitted, p_reflect: r / (r + t) })
    }

    /// The mirrored or the refracted direction.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32) -> Option<BsdfSample> {
        let met = self.meet(wo)?;
        Some(if u_lobe < met.split.p_reflect {
            met.reflected(wo, met.split.p_reflect)
        } else {
            met.refracted(wo, 1.0 - met.split.p_reflect)
        })
    }

    /// The mirrored direction, always; `None` where nothing is reflected.
    #[inline]
    pub(super) fn reflect(&self, wo: Vec3) -> Option<BsdfSample> {
        self.meet(wo).filter(|met| !met.split.reflected.is_zero()).map(|met| met.reflected(wo, 1.0))
    }

    /// The refracted direction, always; `None` where all is reflected.
    #[inline]
    pub(super) fn refract(&self, wo: Vec3) -> Option<BsdfSample> {
        self.meet(wo).filter(|met| !met.split.transmitted.is_zero()).map(|met| met.refracted(wo, 1.0))
    }

    #[inline]
    fn meet(&self, wo: Vec3) -> Option<Met> {
        if wo.z == 0.0 {
            return None;
        }
        let eta = self.eta_from(wo);
        let facet = fresnel::dielectric(wo.z.abs(), eta);
        self.split(facet.reflectance).map(|split| Met { split, cos_t: facet.cos_t, eta })
    }
}

/// How a direction meets the surface.
#[derive(Clone, Copy)]
struct Met {
    split: Split,
    /// The cosine of the refraction, on its own side.
    cos_t: f32,
    /// Index beyond the surface over that on the side of `wo`.
    eta: f32,
}

impl Met {
    /// The mirrored direction, taken with `probability`.
    #[inline]
    fn reflected(&self, wo: Vec3, probability: f32) -> BsdfSample {
        BsdfSample {
            wi: mirrored(wo),
            weight: self.split.reflected / probability,
            pdf: probability,
            kind: ScatterKind::Reflection,
            specular: true,
            eta: 1.0,
        }
    }

    /// The refracted direction, taken with `probability`.
    #[inline]
    fn refracted(&self, wo: Vec3, probability: f32) -> BsdfSample {
        let eta = self.eta;
        BsdfSample {
            wi: Vec3::new(-wo.x / eta, -wo.y / eta, -self.cos_t.copysign(wo.z)),
            weight: self.split.transmitted / (probability * eta * eta),
            pdf: probability,
            kind: ScatterKind::Transmission,
            specular: true,
            eta,
        }
    }
}
