//! Rough plastic: a diffuse base under a rough clear coat.
//!
//! Microfacets reflect as those of a rough dielectric do. What passes them, scattered by the base and kept inside by the
//! coat again and again, is a geometric series as under the smooth coat of [`super::Plastic`]:
//!
//! ```text
//! f(o, i) cos θi = F(o·m) D(m) G₂(o, i) / (4 cos θo) + T(o) T(i) / η² · ρ / (1 − ρ' R) · |cos θi| / π
//! T(w) = ∫ D_w(m) (1 − F(w·m)) G₁(t) dm,   t the direction refracted at m
//! ```
//!
//! `T` is what passes into the coat from `w`, tabulated at 64 regular cosines and linear between. `R` is what the coat
//! reflects of diffuse light from inside, `2 ∫ R(μ) μ dμ` of the like integral `R(μ)`; the model is defined (in Mitsuba,
//! with which it must agree) with the plain mean over the same 64 cosines in place of that integral. At its upper end that
//! mean counts the last term, which is small, in full, and divides by 64 where there are 63 steps: it is less than the
//! integral by 1 to 2 % (for a nearly smooth coat of η = 1.49, 0.579 for 0.590), so that a base whose hue is kept
//! (`ρ' = 1`) is up to 2.6 % darker than it would be by the integral. Light that meets two facets on its way is lost.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `coat` | index, microfacets, `T` and `R` | |
//! | `base` | `ρ / (1 − ρ' R) / η²`, each lane its own \[1\] | [0, 1] |
//! | `reflectance` | multiplier of the microfacets' reflection \[1\] | [0, 1]; 1 is physical |
//! | `sides` | which sides reflect | |
//!
//! A lobe is chosen by its share of the power, `1 − T(o)` of the brightest tint or `T(o)` of the brightest base; what is
//! drawn weighs the sum of both over the sum of their densities.
//!
//! Source: Mitsuba's `roughplastic` (Jakob 2010); microfacets: Walter et al. 2007, eq. 20 and 21.

use std::f32::consts::FRAC_1_PI;

use super::microfacet::Microfacets;
use super::{BsdfSample, ScatterKind, Sides, fresnel, plastic::under_coat, seen_from};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp::cosine_hemisphere;
use crate::spectrum::Lanes;

/// Cosines at which a coat is tabulated.
const COSINES: usize = 64;
/// Nodes of the quadrature over visible normals, a side.
const NODES: usize = 64;

/// A rough interface into a clear coat.
#[derive(Debug, Clone, PartialEq)]
pub struct RoughCoat {
    /// Its index over that outside \[1\].
    pub eta: f32,
    /// Its microfacets.
    pub microfacets: Microfacets,
    /// `R` \[1\].
    pub internal: f32,
    /// `T` \[1\].
    transmittance: [f32; COSINES],
}

/// A diffuse base under a rough coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughPlastic<'s> {
    /// What covers it.
    pub coat: &'s RoughCoat,
    /// What the base sends back of what enters, with all that happens under the coat \[1\].
    pub base: Lanes,
    /// Multiplier of the microfacets' reflection \[1\].
    pub reflectance: Lanes,
    /// Which sides reflect; the other is black.
    pub sides: Sides,
}

impl RoughCoat {
    /// A coat of index `eta` (> 0) whose roughness is the same in all directions.
    pub fn new(eta: f32, microfacets: Microfacets) -> Self {
        let cosine = |i: usize| (i as f32 / (COSINES - 1) as f32).max(1e-6);
        let transmittance = std::array::from_fn(|i| passed(&microfacets, cosine(i), eta).1);
        let reflected = |i| f64::from(passed(&microfacets, cosine(i), 1.0 / eta).0 * cosine(i));
        let internal = (0..COSINES).map(reflected).sum::<f64>() * 2.0 / COSINES as f64;
        Self { eta, microfacets, internal: internal as f32, transmittance }
    }

    /// `T` at the cosine of `w`.
    #[inline]
    fn transmittance(&self, w: Vec3) -> f32 {
        let at = w.z.abs() * (COSINES - 1) as f32;
        let i = (at as usize).min(COSINES - 2);
        let t = at - i as f32;
        (1.0 - t) * self.transmittance[i] + t * self.transmittance[i + 1]
    }
}

/// What microfacets between indices whose ratio is `eta` reflect, and what they let through, of light at a cosine: the
/// mean over the normals visible from there.
fn passed(microfacets: &Microfacets, cosine: f32, eta: f32) -> (f32, f32) {
    let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    microfacets.for_visible_grid(wo, NODES, |m| {
        let cos_o = wo.dot(m).clamp(0.0, 1.0);
        let facet = fresnel::dielectric(cos_o, eta);
        let wi = 2.0 * cos_o * m - wo;
        if wi.z > 0.0 {
            reflected += facet.reflectance * microfacets.masking(wi);
        }
        let wi = m * (facet.cos_t - cos_o / eta) + wo / eta;
        if wi.z > 0.0 && facet.cos_t > 0.0 {
            transmitted += (1.0 - facet.reflectance) * microfacets.masking(wi);
        }
    });
    let all = (NODES * NODES) as f32;
    (reflected / all, transmitted / all)
}

impl<'s> RoughPlastic<'s> {
    /// A base of reflectance `rho`; `nonlinear` as of [`super::Plastic::new`].
    pub fn new(coat: &'s RoughCoat, rho: Lanes, nonlinear: bool) -> Self {
        let base = under_coat(rho, coat.eta, coat.internal, nonlinear);
        Self { coat, base, reflectance: Lanes::ONE, sides: Sides::Both }
    }

    /// The probability of the diffuse lobe, where the coat lets `t` through.
    #[inline]
    fn p_diffuse(&self, t: f32) -> f32 {
        let (facets, base) = ((1.0 - t) * self.reflectance.max_lane(), t * self.base.max_lane());
        if facets + base > 0.0 { base / (facets + base) } else { 0.0 }
    }

    /// `f·|cos θi|` [1/sr] and the density [1/sr] of [`Self::sample`], for directions above the surface.
    #[inline]
    fn both(&self, wo: Vec3, wi: Vec3) -> (Lanes, f32) {
        let RoughCoat { eta, microfacets, .. } = self.coat;
        let (h, through) = (wo + wi, self.coat.transmittance(wo));
        let length = h.length();
        let d = microfacets.density(h / length);
        let facets = fresnel::dielectric(0.5 * length, *eta).reflectance
            * (0.25 * d * microfacets.masking_shadowing_over_cos(wo, wi));
        let cosine = wi.z * FRAC_1_PI;
        let value = self.reflectance * facets + self.base * (through * self.coat.transmittance(wi) * cosine);
        let p = self.p_diffuse(through);
        (value, p * cosine + (1.0 - p) * d * 0.5 / (wo.z + microfacets.stretched(wo)))
    }

    /// `f·|cos θi|` [1/sr] on the side of `wo`.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        if self.sides.reflect(wo, wi) { self.both(seen_from(wo, wo), seen_from(wo, wi)).0 } else { Lanes::ZERO }
    }

    /// The density [1/sr] of [`Self::sample`].
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.sides.reflect(wo, wi) { self.both(seen_from(wo, wo), seen_from(wo, wi)).1 } else { 0.0 }
    }

    /// The mirror image in a visible microfacet, or a direction with the density of a cosine; `None` when it points below
    /// the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if !self.sides.answer(wo) {
            return None;
        }
        let up = seen_from(wo, wo);
        let wi = if u_lobe < self.p_diffuse(self.coat.transmittance(up)) {
            cosine_hemisphere(u)
        } else {
            let m = self.coat.microfacets.sample_visible(up, u);
            2.0 * up.dot(m) * m - up
        };
        if wi.z <= 0.0 {
            return None;
        }
        let (value, pdf) = self.both(up, wi);
        let kind = ScatterKind::Reflection;
        (pdf > 0.0).then(|| BsdfSample {
            wi: seen_from(wo, wi),
            weight: value / pdf,
            pdf,
            kind,
            specular: false,
            eta: 1.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::internal_reflectance;
    use crate::bsdf::microfacet::{Distribution, Shadowing};

    fn coat(alpha: f32, distribution: Distribution) -> RoughCoat {
        RoughCoat::new(
            1.49,
            Microfacets { alpha_x: alpha, alpha_y: alpha, distribution, shadowing: Shadowing::Separable },
        )
    }

    /// Nearly smooth, the coat lets through `1 − F`; and the mean over 64 cosines of 2 R(μ) μ is what Fresnel's equations
    /// give it, which is less than the integral, [`internal_reflectance`], by the 1.9 % of the manual.
    #[test]
    fn a_nearly_smooth_coat_is_a_smooth_one() {
        for distribution in [Distribution::TrowbridgeReitz, Distribution::Beckmann] {
            let coat = coat(1e-3, distribution);
            for i in 4..COSINES {
                let cosine = i as f32 / (COSINES - 1) as f32;
                let smooth = 1.0 - fresnel::dielectric(cosine, 1.49).reflectance;
                assert!((coat.transmittance[i] - smooth).abs() < 1e-3, "{i}: {} for {smooth}", coat.transmittance[i]);
            }
            let term = |i: usize| {
                let cosine = i as f32 / 63.0;
                2.0 / 64.0 * cosine * fresnel::dielectric(cosine, 1.0 / 1.49).reflectance
            };
            let mean: f32 = (0..COSINES).map(term).sum();
            assert!((coat.internal - mean).abs() < 2e-3, "{} for {mean}", coat.internal);
            let less = 1.0 - coat.internal / internal_reflectance(1.49);
            assert!((0.017..0.02).contains(&less), "{less}");
        }
    }

    /// Light that is neither reflected nor transmitted is shadowed, which it is the more the rougher the coat; nothing is
    /// gained.
    #[test]
    fn a_coat_reflects_and_transmits_no_more_than_all() {
        for distribution in [Distribution::TrowbridgeReitz, Distribution::Beckmann] {
            for eta in [1.49, 1.0 / 1.49] {
                let lost = [1e-3, 0.1, 0.3, 1.0].map(|alpha| {
                    let (r, t) = passed(&coat(alpha, distribution).microfacets, 0.8, eta);
                    1.0 - r - t
                });
                assert!(lost[0].abs() < 1e-3 && lost.is_sorted(), "{distribution:?} {eta}: {lost:?}");
            }
        }
    }
}
