//! Plastic: a diffuse base under a smooth clear coat.
//!
//! The coat reflects like a mirror with Fresnel's `F`. What passes it is scattered by the base and partly kept inside by
//! total reflection, again and again; the sum of all those bounces is a geometric series:
//!
//! ```text
//! f(o, i) cos θi = (1 − F(o)) (1 − F(i)) / η² · ρ / (1 − ρ' R) · |cos θi| / π,   beside the mirror F(o)
//! ```
//!
//! `R` is the reflectance of the coat for diffuse light from inside. With `ρ' = ρ` colours saturate as they do under
//! varnish (Mitsuba's `nonlinear`); with `ρ' = 1` they keep their hue, and the base is brighter than any real one.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `eta` | index of the coat over that outside \[1\] | > 0: polypropylene 1.49 |
//! | `base` | `ρ / (1 − ρ' R) / η²`, each lane its own \[1\] | [0, 1] |
//! | `reflectance` | multiplier of the mirror \[1\] | [0, 1]; 1 is physical |
//! | `sides` | which sides reflect | |
//!
//! Source: Mitsuba's `plastic` (Jakob 2010), after Weidlich and Wilkie 2007; `R` from outside to inside: Stokes 1862.

use std::f32::consts::FRAC_1_PI;

use super::{BsdfSample, Diffuse, ScatterKind, Sides, fresnel, mirrored};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Lanes;

/// A diffuse base under a smooth coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plastic {
    /// Index of the coat over that outside \[1\].
    pub eta: f32,
    /// What the base sends back of what enters, with all that happens under the coat \[1\].
    pub base: Lanes,
    /// Multiplier of the mirror \[1\].
    pub reflectance: Lanes,
    /// Which sides reflect; the other is black.
    pub sides: Sides,
}

/// `R`: what an interface into `eta` times the index reflects of diffuse light from inside \[1\].
///
/// From outside it is `R_ext = 2 ∫ F(μ) μ dμ`, and as many modes of light pass in as out: `R = 1 − (1 − R_ext)/η²`.
pub fn internal_reflectance(eta: f32) -> f32 {
    const STEPS: u32 = 4096;
    // μ = t²: Fresnel's reflectance is steep where μ is small.
    let term = |i: u32| {
        let t = (f64::from(i) + 0.5) / f64::from(STEPS);
        4.0 * f64::from(fresnel::dielectric((t * t) as f32, eta).reflectance) * t * t * t / f64::from(STEPS)
    };
    let external: f64 = (0..STEPS).map(term).sum();
    (1.0 - (1.0 - external) / f64::from(eta * eta)) as f32
}

/// `ρ / (1 − ρ' R) / η²`.
pub(super) fn under_coat(rho: Lanes, eta: f32, internal: f32, nonlinear: bool) -> Lanes {
    rho.map(|rho| rho / ((1.0 - if nonlinear { rho } else { 1.0 } * internal) * eta * eta))
}

impl Plastic {
    /// A base of reflectance `rho` under a coat of index `eta`, whose [`internal_reflectance`] is `internal`; `nonlinear`
    /// as above.
    pub fn new(eta: f32, internal: f32, rho: Lanes, nonlinear: bool) -> Self {
        Self { eta, base: under_coat(rho, eta, internal, nonlinear), reflectance: Lanes::ONE, sides: Sides::Both }
    }

    /// `F` at the cosine of `w`.
    #[inline]
    fn mirror(&self, w: Vec3) -> f32 {
        fresnel::dielectric(w.z.abs(), self.eta).reflectance
    }

    /// The probability of the diffuse lobe from `wo`, whose mirror has `f`: its share of the brightest power.
    #[inline]
    fn p_diffuse(&self, f: f32) -> f32 {
        let (mirror, base) = (f * self.reflectance.max_lane(), (1.0 - f) * self.base.max_lane());
        if mirror + base > 0.0 { base / (mirror + base) } else { 0.0 }
    }

    /// `f·|cos θi|` [1/sr] of the base, on the side of `wo`.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        if !self.sides.reflect(wo, wi) {
            return Lanes::ZERO;
        }
        self.base * ((1.0 - self.mirror(wo)) * (1.0 - self.mirror(wi)) * wi.z.abs() * FRAC_1_PI)
    }

    /// The density [1/sr] of the base's directions.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !self.sides.reflect(wo, wi) {
            return 0.0;
        }
        self.p_diffuse(self.mirror(wo)) * wi.z.abs() * FRAC_1_PI
    }

    /// The mirrored direction, or one with the density of a cosine.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if !self.sides.answer(wo) {
            return None;
        }
        let f = self.mirror(wo);
        let p = self.p_diffuse(f);
        if u_lobe < p {
            let s = Diffuse { reflectance: self.base / p, sides: Sides::Both }.sample(wo, u)?;
            let through = (1.0 - f) * (1.0 - self.mirror(s.wi));
            return Some(BsdfSample { weight: s.weight * through, pdf: p * s.pdf, ..s });
        }
        let weight = self.reflectance * (f / (1.0 - p));
        let kind = ScatterKind::Reflection;
        (p < 1.0).then(|| BsdfSample { wi: mirrored(wo), weight, pdf: 1.0 - p, kind, specular: true, eta: 1.0 })
    }
}
