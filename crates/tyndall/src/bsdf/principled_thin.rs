//! Burley's model of everything thin: leaves, paper, frosted panes. Both sides are alike.
//!
//! With `τ` the share of the base that goes through (lobes of [`super::burley`] in quotes):
//!
//! ```text
//! near   f cos θi = (1 − spec_trans)(1 − τ) ("diffuse" + "sheen") + spec_trans "Fresnel" D G₂ / (4 cos θo)
//! far    f cos θi = (1 − spec_trans) τ c/π |cos θi|                + spec_trans c (1 − F) D' G₂' / (4 cos θo)
//! ```
//!
//! On the far side the facet is that which mirrors `wo` to the mirror image of `wi` in the sheet: nothing bends. `D'` and
//! `G₂'` are of the roughness times `0.65 η − 0.35`, which is how much two faces blur. Light is only passed where `wi` lies
//! behind the facet, `i·m < 0`; what a steep facet would send elsewhere is lost, and exchanging the directions is not the
//! same there.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `burley` | colour, roughness and the lobes of the base | |
//! | `eta` | index of the sheet over that outside \[1\] | > 0 |
//! | `diff_trans` | `τ` \[1\] | [0, 1] |
//! | `rates` | how often lobes are drawn | |
//!
//! A lobe is drawn by its share times its rate: `(1 − spec_trans)(1 − τ)`, `(1 − spec_trans) τ`, and `spec_trans/2` each for
//! the clear ones. A rate only moves noise, but 0 leaves out what no other lobe draws.
//!
//! Source: Burley 2015; in this form Mitsuba's `principledthin` (3.9), whose `diff_trans` is `2τ`.

use std::f32::consts::FRAC_1_PI;

use super::burley::{Burley, Mirror};
use super::principled::mirrored_in;
use super::{BsdfSample, ScatterKind, fresnel, seen_from};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp::cosine_hemisphere;
use crate::spectrum::Lanes;

/// Burley's model of sheets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipledThin<'s> {
    /// Colour, roughness and the lobes of the base.
    pub burley: Burley,
    /// Index of the sheet over that outside \[1\].
    pub eta: f32,
    /// The share of the base that goes through \[1\].
    pub diff_trans: f32,
    /// How often lobes are drawn.
    pub rates: &'s ThinRates,
}

/// How often lobes are drawn, relative to their shares \[1\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinRates {
    /// Base, on the side of `wo`.
    pub diffuse_reflectance: f32,
    /// Base, on the other side.
    pub diffuse_transmittance: f32,
    /// Highlight.
    pub specular_reflectance: f32,
    /// What passes clearly.
    pub specular_transmittance: f32,
}

/// The probabilities of the lobes.
struct Chances {
    diffuse_near: f32,
    diffuse_far: f32,
    clear_near: f32,
    clear_far: f32,
}

impl PrincipledThin<'_> {
    #[inline]
    fn chances(&self) -> Option<Chances> {
        let (clear, base) = (0.5 * self.burley.spec_trans, 1.0 - self.burley.spec_trans);
        let diffuse_near = base * (1.0 - self.diff_trans) * self.rates.diffuse_reflectance;
        let diffuse_far = base * self.diff_trans * self.rates.diffuse_transmittance;
        let (near, far) = (clear * self.rates.specular_reflectance, clear * self.rates.specular_transmittance);
        let total = diffuse_near + diffuse_far + near + far;
        (total > 0.0).then(|| Chances {
            diffuse_near: diffuse_near / total,
            diffuse_far: diffuse_far / total,
            clear_near: near / total,
            clear_far: far / total,
        })
    }

    /// How much two faces blur more than one.
    #[inline]
    fn blur(&self) -> f32 {
        0.65 * self.eta - 0.35
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
        if wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let (chances, up, to) = (self.chances()?, seen_from(wo, wo), seen_from(wo, wi));
        if to.z > 0.0 { self.near(up, to, &chances) } else { self.far(up, to, &chances) }
    }

    /// Value and density of a direction on the side of `wo`.
    #[inline]
    fn near(&self, wo: Vec3, wi: Vec3, chances: &Chances) -> Option<(Lanes, f32)> {
        let Mirror { m, cos_d } = Mirror::between(wo, wi)?;
        let base = (1.0 - self.burley.spec_trans) * (1.0 - self.diff_trans);
        let mut value = (self.burley.diffuse(wo, wi, cos_d) + self.burley.sheen(wi, cos_d)) * base;
        let mut pdf = chances.diffuse_near * wi.z * FRAC_1_PI;
        if self.burley.spec_trans > 0.0 {
            let microfacets = self.burley.microfacets(1.0);
            let d = microfacets.density(m);
            let f = fresnel::dielectric(cos_d, self.eta).reflectance;
            let shape = 0.25 * d * microfacets.masking_shadowing_over_cos(wo, wi);
            value += self.burley.fresnel(f, cos_d, self.eta) * (self.burley.spec_trans * shape);
            pdf += chances.clear_near * d * 0.5 / (wo.z + microfacets.stretched(wo));
        }
        Some((value, pdf))
    }

    /// Value and density of a direction on the other side.
    #[inline]
    fn far(&self, wo: Vec3, wi: Vec3, chances: &Chances) -> Option<(Lanes, f32)> {
        let image = Vec3::new(wi.x, wi.y, -wi.z);
        let Mirror { m, cos_d } = Mirror::between(wo, image)?;
        let base = (1.0 - self.burley.spec_trans) * self.diff_trans;
        let mut value = self.burley.colour() * (base * image.z * FRAC_1_PI);
        let mut pdf = chances.diffuse_far * image.z * FRAC_1_PI;
        if self.burley.spec_trans > 0.0 && wi.dot(m) < 0.0 {
            let microfacets = self.burley.microfacets(self.blur());
            let d = microfacets.density(m);
            let f = fresnel::dielectric(cos_d, self.eta).reflectance;
            let shape = 0.25 * d * microfacets.masking_shadowing_over_cos(wo, image);
            value += self.burley.colour() * (self.burley.spec_trans * (1.0 - f) * shape);
            pdf += chances.clear_far * d * 0.5 / (wo.z + microfacets.stretched(wo));
        }
        Some((value, pdf))
    }

    /// A direction by one of the lobes, weighed by all of them; `None` where a facet sends light to the wrong side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (chances, up) = (self.chances()?, seen_from(wo, wo));
        let through = |w: Vec3| Vec3::new(w.x, w.y, -w.z);
        let facet = |scale: f32| mirrored_in(self.burley.microfacets(scale).sample_visible(up, u), up);
        let Chances { diffuse_near, clear_near, clear_far, .. } = chances;
        let (wi, kind) = if u_lobe < clear_near {
            (facet(1.0), ScatterKind::Reflection)
        } else if u_lobe < clear_near + clear_far {
            (through(facet(self.blur())), ScatterKind::Transmission)
        } else if u_lobe < clear_near + clear_far + diffuse_near {
            (cosine_hemisphere(u), ScatterKind::Reflection)
        } else {
            (through(cosine_hemisphere(u)), ScatterKind::Transmission)
        };
        let (value, pdf) = match kind {
            ScatterKind::Reflection if wi.z > 0.0 => self.near(up, wi, &chances)?,
            // A facet whose image does not lie behind it passes nothing: its share is lost.
            ScatterKind::Transmission if wi.z < 0.0 => {
                let lost = u_lobe < clear_near + clear_far && !is_behind(up, wi);
                if lost {
                    return None;
                }
                self.far(up, wi, &chances)?
            }
            _ => return None,
        };
        let wi = seen_from(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, kind, specular: false, eta: 1.0 })
    }
}

/// Whether `wi` lies behind the facet that sends it there.
#[inline]
fn is_behind(wo: Vec3, wi: Vec3) -> bool {
    Mirror::between(wo, Vec3::new(wi.x, wi.y, -wi.z)).is_some_and(|mirror| wi.dot(mirror.m) < 0.0)
}
