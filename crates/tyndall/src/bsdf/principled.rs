//! Burley's model of everything solid: from dust and plastic to metal and ground glass.
//!
//! On the side that the normal points to, with the shares `κ = (1 − metallic)(1 − spec_trans)` of the base and
//! `γ = (1 − metallic) spec_trans` of the glass (lobes of [`super::burley`] in quotes; microfacets with `α_x`, `α_y`):
//!
//! ```text
//! f cos θi =  κ "diffuse" + (1 − metallic) "sheen"
//!          +  ((1 − metallic) "Fresnel" + metallic (S + (1 − S) c)) D G₂ / (4 cos θo)            highlight
//!          +  clearcoat/4 (S + 0.04 (1 − S)) D₁ G |cos θi|                                        coat
//!          +  √c γ (1 − F) D G₂ |o·m| |i·m| / (cos θo (o·m + η i·m)²)                             through
//! D₁(m) = (a² − 1) / (π ln a² (1 + (a² − 1) m_z²)),  a = 0.1 − 0.099 clearcoat_gloss;   G = G₁(o) G₁(i) at α = 0.25
//! ```
//!
//! `G₂` is the separable one. From behind there is only glass, `γ F` and `√c γ (1 − F)`; without `spec_trans` the other
//! side is black, or alike. Where `F` is 0, as for an index of 1, there is no highlight of metal either.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `burley` | colour, roughness and the lobes of the base | |
//! | `metallic` | how much of it is metal \[1\] | [0, 1] |
//! | `clearcoat`, `clearcoat_gloss` | how much coat there is, how polished it is \[1\] | [0, 1] |
//! | `fixed` | what is the same everywhere: index, rates of sampling, sides | |
//!
//! A lobe is drawn by its share times its rate, `κ`, 1 and `clearcoat/4`; highlight and glass share theirs by `γ (1 − F)`
//! of the facet that was drawn. A rate only moves noise, but 0 leaves out what no other lobe draws.
//!
//! Source: Burley 2012 and 2015; in this form Mitsuba's `principled` (3.9). There, in the scalar variants, the sheen is
//! gone where `spec_trans` is exactly 1.

use std::f32::consts::{FRAC_1_PI, PI};

use super::burley::{Burley, Mirror, schlick};
use super::microfacet::{Distribution, Microfacets, Shadowing};
use super::{BsdfSample, ScatterKind, Sides, fresnel, seen_from};
use crate::math::{Vec2, Vec3, fast::sin_cos_turn};
use crate::sampling::warp::cosine_hemisphere;
use crate::spectrum::Lanes;

/// Burley's model of solids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principled<'s> {
    /// Colour, roughness and the lobes of the base.
    pub burley: Burley,
    /// How much of it is metal \[1\].
    pub metallic: f32,
    /// How much coat there is \[1\].
    pub clearcoat: f32,
    /// How polished the coat is \[1\].
    pub clearcoat_gloss: f32,
    /// What is the same everywhere.
    pub fixed: &'s PrincipledFixed,
}

/// What is the same everywhere on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipledFixed {
    /// Index inside over that outside \[1\].
    pub eta: f32,
    /// How often the base is drawn, relative to its share \[1\].
    pub diffuse_rate: f32,
    /// The same of highlight and glass.
    pub specular_rate: f32,
    /// The same of the coat.
    pub clearcoat_rate: f32,
    /// Which sides answer where nothing passes; the other is black.
    pub sides: Sides,
}

/// Shadowing of the coat, whatever its gloss.
const COAT_SHADOWS: Microfacets = Microfacets {
    alpha_x: 0.25,
    alpha_y: 0.25,
    distribution: Distribution::TrowbridgeReitz,
    shadowing: Shadowing::Separable,
};

/// The probabilities of the lobes from one side; what is left is highlight and glass.
struct Chances {
    diffuse: f32,
    clearcoat: f32,
    specular: f32,
}

impl Principled<'_> {
    /// `κ`.
    #[inline]
    fn base(&self) -> f32 {
        (1.0 - self.metallic) * (1.0 - self.burley.spec_trans)
    }

    /// `γ`.
    #[inline]
    fn glass(&self) -> f32 {
        (1.0 - self.metallic) * self.burley.spec_trans
    }

    /// Whether light can pass.
    #[inline]
    pub fn transmits(&self) -> bool {
        self.burley.spec_trans > 0.0
    }

    /// Whether `wo` sees the side that the normal points to, or one like it; `None` where it sees nothing.
    #[inline]
    fn in_front(&self, wo: Vec3) -> Option<bool> {
        if self.transmits() {
            (wo.z > 0.0 || wo.z < 0.0 && self.glass() > 0.0).then_some(wo.z > 0.0)
        } else {
            self.fixed.sides.answer(wo).then_some(true)
        }
    }

    #[inline]
    fn chances(&self, front: bool) -> Option<Chances> {
        if !front {
            return Some(Chances { diffuse: 0.0, clearcoat: 0.0, specular: 1.0 });
        }
        let PrincipledFixed { diffuse_rate, specular_rate, clearcoat_rate, .. } = self.fixed;
        let (diffuse, clearcoat) = (self.base() * diffuse_rate, 0.25 * self.clearcoat * clearcoat_rate);
        let total = diffuse + clearcoat + specular_rate;
        (total > 0.0).then(|| Chances {
            diffuse: diffuse / total,
            clearcoat: clearcoat / total,
            specular: specular_rate / total,
        })
    }

    /// How much of what is drawn at a facet of reflectance `f` goes through it.
    #[inline]
    fn share_through(&self, front: bool, f: f32) -> f32 {
        (1.0 - f) * if front { self.glass() } else { 1.0 }
    }

    /// The index beyond the surface over that on the side of `wo`.
    #[inline]
    fn eta_from(&self, front: bool) -> f32 {
        if front { self.fixed.eta } else { 1.0 / self.fixed.eta }
    }

    /// `f·|cos θi|` [1/sr].
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        self.both(wo, wi).map_or(Lanes::ZERO, |(value, _)| value)
    }

    /// The density [1/sr] of [`Self::sample`].
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.both(wo, wi).map_or(0.0, |(_, pdf)| pdf)
    }

    #[inline]
    fn both(&self, wo: Vec3, wi: Vec3) -> Option<(Lanes, f32)> {
        let front = self.in_front(wo)?;
        let chances = self.chances(front)?;
        let (up, to) = (seen_from(wo, wo), seen_from(wo, wi));
        if to.z > 0.0 {
            self.reflect(up, to, front, &chances)
        } else if to.z < 0.0 {
            self.transmit(up, to, front, &chances)
        } else {
            None
        }
    }

    /// Value and density of a direction on the side of `wo`.
    #[inline]
    fn reflect(&self, wo: Vec3, wi: Vec3, front: bool, chances: &Chances) -> Option<(Lanes, f32)> {
        let Mirror { m, cos_d } = Mirror::between(wo, wi)?;
        let eta = self.eta_from(front);
        let f = fresnel::dielectric(cos_d, eta).reflectance;
        let microfacets = self.burley.microfacets(1.0);
        let d = microfacets.density(m);
        let shape = 0.25 * d * microfacets.masking_shadowing_over_cos(wo, wi);
        let seen = d * 0.5 / (wo.z + microfacets.stretched(wo));
        let pdf = chances.specular * (1.0 - self.share_through(front, f)) * seen;
        if !front {
            return Some((Lanes::splat(self.glass() * f * shape), pdf));
        }
        let dielectric = 1.0 - self.metallic;
        let mut value = self.burley.diffuse(wo, wi, cos_d) * self.base() + self.burley.sheen(wi, cos_d) * dielectric;
        if f > 0.0 {
            let facet = self.burley.fresnel(f, cos_d, eta) * dielectric
                + schlick(self.burley.colour(), cos_d, eta) * self.metallic;
            value += facet * shape;
        }
        let mut pdf = pdf + chances.diffuse * wi.z * FRAC_1_PI;
        if self.clearcoat > 0.0 {
            let d = self.coat_density(m.z);
            let shadows = COAT_SHADOWS.masking(wo) * COAT_SHADOWS.masking(wi);
            value += schlick(Lanes::splat(0.04), cos_d, eta) * (0.25 * self.clearcoat * d * shadows * wi.z);
            pdf += chances.clearcoat * d * m.z / (4.0 * cos_d);
        }
        Some((value, pdf))
    }

    /// Value and density of a direction on the other side.
    #[inline]
    fn transmit(&self, wo: Vec3, wi: Vec3, front: bool, chances: &Chances) -> Option<(Lanes, f32)> {
        if self.glass() <= 0.0 {
            return None;
        }
        let eta = self.eta_from(front);
        let h = wo + wi * eta;
        let length = h.length();
        if length <= f32::MIN_POSITIVE {
            return None;
        }
        let m = h * (1f32.copysign(h.z) / length);
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        if cos_o <= 0.0 || cos_i >= 0.0 {
            return None;
        }
        // From the thinner side, where nothing cancels: the same, to the bit, from both.
        let (cos, into) = if eta < 1.0 { (-cos_i, 1.0 / eta) } else { (cos_o, eta) };
        let f = fresnel::dielectric(cos, into).reflectance;
        let microfacets = self.burley.microfacets(1.0);
        let d = microfacets.density(m);
        let half = cos_o + eta * cos_i;
        let below = Vec3::new(wi.x, wi.y, -wi.z);
        let shape = d * microfacets.masking_shadowing_over_cos(wo, below) * cos_o * -cos_i / (half * half);
        let value = self.burley.colour().map(f32::sqrt) * (self.glass() * (1.0 - f) * shape);
        let pdf = chances.specular
            * self.share_through(front, f)
            * microfacets.visible_density(wo, m)
            * (eta * eta * -cos_i / (half * half));
        Some((value, pdf))
    }

    /// A direction by one of the lobes, weighed by all of them; `None` where a facet sends light to the wrong side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let front = self.in_front(wo)?;
        let chances = self.chances(front)?;
        let up = seen_from(wo, wo);
        let coated = chances.diffuse + chances.clearcoat;
        let (wi, kind, eta) = if u_lobe < chances.diffuse {
            (cosine_hemisphere(u), ScatterKind::Reflection, 1.0)
        } else if u_lobe < coated {
            (mirrored_in(self.sample_coat(u), up), ScatterKind::Reflection, 1.0)
        } else {
            let m = self.burley.microfacets(1.0).sample_visible(up, u);
            let (cos, eta) = (up.dot(m).clamp(0.0, 1.0), self.eta_from(front));
            let facet = fresnel::dielectric(cos, eta);
            let rest = (u_lobe - coated) / (1.0 - coated).max(f32::MIN_POSITIVE);
            if rest < self.share_through(front, facet.reflectance) {
                (m * (cos / eta - facet.cos_t) - up / eta, ScatterKind::Transmission, eta)
            } else {
                (mirrored_in(m, up), ScatterKind::Reflection, 1.0)
            }
        };
        let (value, pdf) = match kind {
            ScatterKind::Reflection if wi.z > 0.0 => self.reflect(up, wi, front, &chances)?,
            ScatterKind::Transmission if wi.z < 0.0 => self.transmit(up, wi, front, &chances)?,
            _ => return None,
        };
        let wi = seen_from(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, kind, specular: false, eta })
    }

    /// `a²`.
    #[inline]
    fn coat_alpha2(&self) -> f32 {
        let a = 0.1 - 0.099 * self.clearcoat_gloss;
        a * a
    }

    /// `D₁` [1/sr].
    #[inline]
    fn coat_density(&self, cos: f32) -> f32 {
        let a2 = self.coat_alpha2();
        (a2 - 1.0) / (PI * libm::logf(a2) * (1.0 + (a2 - 1.0) * cos * cos))
    }

    /// A normal of the coat with the density `D₁(m) m_z`.
    #[inline]
    fn sample_coat(&self, u: Vec2) -> Vec3 {
        let a2 = self.coat_alpha2();
        let cos2 = ((1.0 - libm::powf(a2, 1.0 - u.y)) / (1.0 - a2)).clamp(0.0, 1.0);
        let (sin_phi, cos_phi) = sin_cos_turn(u.x);
        let sin = (1.0 - cos2).sqrt();
        Vec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())
    }
}

/// The mirror image of `w` in a facet.
#[inline]
pub(super) fn mirrored_in(m: Vec3, w: Vec3) -> Vec3 {
    2.0 * w.dot(m) * m - w
}
