//! A rough metal: microfacets, each a small mirror with Fresnel's reflectance.
//!
//! ```text
//! f(o, i) cos θi = F(o·m) D(m) G₂(o, i) / (4 cos θo),   m = (o + i)/|o + i|
//! ```
//!
//! Sampled by the visible normals, so that the weight is `F·G₂/G₁ ≤ 1`. Light that meets a second microfacet is lost, as
//! in every single-scattering model; the loss grows with roughness.
//!
//! Parameters: those of [`Conductor`] and [`Microfacets`]. Source: Cook and Torrance 1982; Walter et al. 2007,
//! eq. 20.

use super::microfacet::Microfacets;
use super::{BsdfSample, Conductor, ScatterKind, seen_from};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Lanes;

/// A metal with microfacets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughConductor {
    /// What each microfacet is made of.
    pub metal: Conductor,
    /// How the microfacets are turned.
    pub microfacets: Microfacets,
}

impl RoughConductor {
    /// `f·|cos θi|` [1/sr] on the side of `wo`.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        if !self.metal.sides.reflect(wo, wi) {
            return Lanes::ZERO;
        }
        let (wo, wi) = (seen_from(wo, wo), seen_from(wo, wi));
        let h = wo + wi;
        let length = h.length();
        let d = self.microfacets.density(h / length) * self.microfacets.masking_shadowing_over_cos(wo, wi);
        self.metal.reflected(0.5 * length) * (0.25 * d)
    }

    /// `D_o(m) / (4 o·m)` [1/sr] on the side of `wo`.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !self.metal.sides.reflect(wo, wi) {
            return 0.0;
        }
        let (wo, wi) = (seen_from(wo, wo), seen_from(wo, wi));
        let m = (wo + wi).normalize();
        self.microfacets.density(m) * 0.5 / (wo.z + self.microfacets.stretched(wo))
    }

    /// The mirror image in a visible microfacet; `None` when it points below the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        if !self.metal.sides.answer(wo) {
            return None;
        }
        let up = seen_from(wo, wo);
        let m = self.microfacets.sample_visible(up, u);
        let cos = up.dot(m);
        let wi = 2.0 * cos * m - up;
        (wi.z > 0.0).then(|| BsdfSample {
            wi: seen_from(wo, wi),
            weight: self.metal.reflected(cos) * self.microfacets.shadowing_of_visible(up, wi),
            pdf: self.microfacets.density(m) * 0.5 / (up.z + self.microfacets.stretched(up)),
            kind: ScatterKind::Reflection,
            specular: false,
            eta: 1.0,
        })
    }
}
