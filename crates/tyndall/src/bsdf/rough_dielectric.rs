//! A rough dielectric: ground glass. Microfacets, each a small smooth interface.
//!
//! With `η` the index on the side of `wi` over that on the side of `wo`, `F = F(o·m)`, and `m` on the side of `wo`:
//!
//! ```text
//! reflection    m = (o + i)/|o + i|           f cos θi = F D(m) G₂ / (4 cos θo)
//! transmission  m = −(o + η i)/|o + η i|      f cos θi = (1 − F) D(m) G₂ |o·m| |i·m| / (cos θo (o·m + η i·m)²)
//! ```
//!
//! (the sign of `m` is turned to the side of `wo`; `i·m < 0` in transmission). The transmission is radiance and already
//! carries `1/η²`. Sampled by the visible normals and then by the share of the power, so that the weight is `G₂/G₁` for
//! reflection and `G₂/(G₁ η²)` for transmission. Light that meets a second microfacet is lost.
//!
//! Parameters: those of [`Dielectric`] and [`Microfacets`]. Source: Walter et al. 2007, "Microfacet models for
//! refraction through rough surfaces", eq. 16 to 21; radiance scaling: Veach 1997, § 5.2.

use super::dielectric::Split;
use super::microfacet::Microfacets;
use super::{BsdfSample, Dielectric, ScatterKind, fresnel, seen_from};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Lanes;

/// An interface between two dielectrics with microfacets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughDielectric {
    /// What each microfacet is.
    pub interface: Dielectric,
    /// How the microfacets are turned.
    pub microfacets: Microfacets,
}

/// The microfacet that takes `wo` to `wi`, seen with `wo` above the surface.
struct Facet {
    wo: Vec3,
    wi: Vec3,
    m: Vec3,
    /// `o·m` > 0.
    cos_o: f32,
    /// `i·m`, negative for transmission.
    cos_i: f32,
    /// Index on the side of `wi` over that on the side of `wo`; 1 for reflection.
    eta: f32,
    split: Split,
}

/// A microfacet that was drawn, seen with `wo` above the surface.
#[derive(Clone, Copy)]
struct Visible {
    /// `wo`.
    up: Vec3,
    m: Vec3,
    /// `o·m`, in [0, 1].
    cos_o: f32,
    /// The cosine of the refraction, on its own side.
    cos_t: f32,
    /// Index beyond the surface over that on the side of `wo`.
    eta: f32,
    split: Split,
}

impl RoughDielectric {
    /// `f·|cos θi|` [1/sr].
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let Some(facet) = self.facet(wo, wi) else { return Lanes::ZERO };
        let above = Vec3::new(facet.wi.x, facet.wi.y, facet.wi.z.abs());
        let d = self.microfacets.density(facet.m) * self.microfacets.masking_shadowing_over_cos(facet.wo, above);
        if facet.cos_i > 0.0 {
            facet.split.reflected * (0.25 * d)
        } else {
            let half = facet.cos_o + facet.eta * facet.cos_i;
            facet.split.transmitted * (d * facet.cos_o * -facet.cos_i / (half * half))
        }
    }

    /// The density [1/sr] of [`Self::sample`].
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.facet(wo, wi).map_or(0.0, |facet| {
            let d = self.microfacets.visible_density(facet.wo, facet.m);
            if facet.cos_i > 0.0 {
                facet.split.p_reflect * d / (4.0 * facet.cos_o)
            } else {
                (1.0 - facet.split.p_reflect) * d * refraction_jacobian(facet.cos_o, facet.cos_i, facet.eta)
            }
        })
    }

    /// The mirror image in, or the refraction through, a visible microfacet; `None` when it ends on the wrong side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let met = self.visible(wo, u)?;
        if u_lobe < met.split.p_reflect {
            self.reflected(wo, &met, met.split.p_reflect)
        } else {
            self.refracted(wo, &met, 1.0 - met.split.p_reflect)
        }
    }

    /// The mirror image in a visible microfacet, always.
    #[inline]
    pub(super) fn reflect(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        self.visible(wo, u).filter(|met| !met.split.reflected.is_zero()).and_then(|met| self.reflected(wo, &met, 1.0))
    }

    /// The refraction through a visible microfacet, always; `None` where all is reflected.
    #[inline]
    pub(super) fn refract(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        self.visible(wo, u).filter(|met| !met.split.transmitted.is_zero()).and_then(|met| self.refracted(wo, &met, 1.0))
    }

    /// The density [1/sr] of [`Self::refract`].
    #[inline]
    pub(super) fn refraction_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.facet(wo, wi).filter(|facet| facet.cos_i < 0.0).map_or(0.0, |facet| {
            self.microfacets.visible_density(facet.wo, facet.m)
                * refraction_jacobian(facet.cos_o, facet.cos_i, facet.eta)
        })
    }

    /// A microfacet among those that `wo` sees.
    #[inline]
    fn visible(&self, wo: Vec3, u: Vec2) -> Option<Visible> {
        if wo.z == 0.0 {
            return None;
        }
        let up = seen_from(wo, wo);
        let m = self.microfacets.sample_visible(up, u);
        let cos_o = up.dot(m).clamp(0.0, 1.0);
        let eta = self.interface.eta_from(wo);
        let facet = fresnel::dielectric(cos_o, eta);
        let split = self.interface.split(facet.reflectance)?;
        Some(Visible { up, m, cos_o, cos_t: facet.cos_t, eta, split })
    }

    /// The mirror image in a microfacet that was drawn, taken with `probability`.
    #[inline]
    fn reflected(&self, wo: Vec3, met: &Visible, probability: f32) -> Option<BsdfSample> {
        let Visible { up, m, cos_o, split, .. } = *met;
        let wi = 2.0 * cos_o * m - up;
        (wi.z > 0.0 && cos_o > 0.0).then(|| BsdfSample {
            wi: seen_from(wo, wi),
            weight: split.reflected * (self.microfacets.shadowing_of_visible(up, wi) / probability),
            pdf: probability * self.microfacets.visible_density(up, m) / (4.0 * cos_o),
            kind: ScatterKind::Reflection,
            specular: false,
            eta: 1.0,
        })
    }

    /// The refraction through a microfacet that was drawn, taken with `probability`.
    #[inline]
    fn refracted(&self, wo: Vec3, met: &Visible, probability: f32) -> Option<BsdfSample> {
        let Visible { up, m, cos_o, cos_t, eta, split } = *met;
        let wi = m * (cos_o / eta - cos_t) - up / eta;
        (wi.z < 0.0 && cos_o > 0.0).then(|| BsdfSample {
            wi: seen_from(wo, wi),
            weight: split.transmitted
                * (self.microfacets.shadowing_of_visible(up, Vec3::new(wi.x, wi.y, -wi.z)) / (probability * eta * eta)),
            pdf: probability * self.microfacets.visible_density(up, m) * refraction_jacobian(cos_o, -cos_t, eta),
            kind: ScatterKind::Transmission,
            specular: false,
            eta,
        })
    }

    /// `None` when no visible microfacet takes `wo` to `wi`. The Fresnel reflectance is the same, to the bit, from `wi`
    /// to `wo`, and in transmission it is taken from the thinner side, where nothing cancels.
    #[inline]
    fn facet(&self, wo: Vec3, wi: Vec3) -> Option<Facet> {
        let (up, wi) = (seen_from(wo, wo), seen_from(wo, wi));
        let beyond = self.interface.eta_from(wo);
        let same_side = up.z * wi.z > 0.0;
        let eta = if same_side { 1.0 } else { beyond };
        let h = up + wi * eta;
        let length = h.length();
        let m = h * (1f32.copysign(h.z) / length);
        let (cos_o, cos_i) = if same_side { (0.5 * length, 0.5 * length) } else { (up.dot(m), wi.dot(m)) };
        // In transmission the microfacet must be seen from its front by wo and from its back by wi.
        let possible = same_side || up.z * wi.z < 0.0 && cos_o > 0.0 && cos_i < 0.0;
        if !possible {
            return None;
        }
        let (cos, into) = if eta < 1.0 { (-cos_i, 1.0 / eta) } else { (cos_o, beyond) };
        let split = self.interface.split(fresnel::dielectric(cos, into).reflectance)?;
        Some(Facet { wo: up, wi, m, cos_o, cos_i, eta, split })
    }
}

/// `|dm/dwi|` of refraction, with the cosines of `wo` and `wi` to the microfacet (Walter et al. 2007, eq. 17).
#[inline]
fn refraction_jacobian(cos_o: f32, cos_i: f32, eta: f32) -> f32 {
    let half = cos_o + eta * cos_i;
    eta * eta * cos_i.abs() / (half * half)
}
