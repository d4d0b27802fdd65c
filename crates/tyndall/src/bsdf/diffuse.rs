//! Diffuse reflection: a surface that looks equally bright from everywhere.
//!
//! `f = ρ / π`, sampled by `cos θ / π`, so that the weight of every sample is `ρ`.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `reflectance` | `ρ`, reflected fraction of the power, each lane its own \[1\] | [0, 1] |
//! | `sides` | which sides reflect | |
//!
//! Source: Lambert 1760, *Photometria*.

use std::f32::consts::FRAC_1_PI;

use super::{BsdfSample, ScatterKind, Sides};
use crate::math::{Vec2, Vec3, fast::sin_cos_turn};
use crate::spectrum::Lanes;

/// Lambert's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Diffuse {
    /// Reflected fraction of the power \[1\].
    pub reflectance: Lanes,
    /// Which sides reflect; the other is black.
    pub sides: Sides,
}

impl Diffuse {
    /// `ρ |cos θi| / π` [1/sr] on the side of `wo`.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        self.reflectance * self.pdf(wo, wi)
    }

    /// `|cos θi| / π` [1/sr] on the side of `wo`.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.sides.reflect(wo, wi) { wi.z.abs() * FRAC_1_PI } else { 0.0 }
    }

    /// A direction with the density of a cosine.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        if !self.sides.answer(wo) {
            return None;
        }
        let (sin_phi, cos_phi) = sin_cos_turn(u.y);
        let (sin_theta, cos_theta) = (u.x.sqrt(), (1.0 - u.x).sqrt());
        Some(BsdfSample {
            wi: Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta.copysign(wo.z)),
            weight: self.reflectance,
            pdf: cos_theta * FRAC_1_PI,
            kind: ScatterKind::Reflection,
            specular: false,
            eta: 1.0,
        })
    }
}
