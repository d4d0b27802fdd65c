//! Diffuse reflection and transmission: a leaf, a sheet of paper, a lampshade.
//!
//! `f = ρ / π` on the side of `wo` and `f = τ / π` on the other: equally bright from everywhere on each side. The side is
//! chosen by the brightest lanes of `ρ` and `τ`, the direction by `cos θ / π`, so that the weight of a sample is `ρ/p` or
//! `τ/p`. The sheet is thin and has the same index on both sides: radiance is not squeezed.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `reflectance` | `ρ`, reflected fraction of the power, each lane its own \[1\] | [0, 1] |
//! | `transmittance` | `τ`, transmitted fraction of the power \[1\] | [0, 1]; `ρ + τ ≤ 1` is physical |
//!
//! Source: Lambert 1760, *Photometria*; both sides: Pharr et al. 2023, § 9.1.2.

use std::f32::consts::FRAC_1_PI;

use super::{BsdfSample, Diffuse, ScatterKind, Sides};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Lanes;

/// Lambert's law on both sides of a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffuseTransmission {
    /// Reflected fraction of the power \[1\].
    pub reflectance: Lanes,
    /// Transmitted fraction of the power \[1\].
    pub transmittance: Lanes,
}

impl DiffuseTransmission {
    /// The probability that the side of `wo` is chosen; `None` when the sheet is black.
    #[inline]
    fn p_reflect(&self) -> Option<f32> {
        let (r, t) = (self.reflectance.max_lane(), self.transmittance.max_lane());
        (r + t > 0.0).then(|| r / (r + t))
    }

    /// `ρ |cos θi| / π` on the side of `wo`, `τ |cos θi| / π` on the other [1/sr].
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        by_side(wo, wi, self.reflectance, self.transmittance).map_or(Lanes::ZERO, |f| f * (wi.z.abs() * FRAC_1_PI))
    }

    /// `p |cos θi| / π` [1/sr] with `p` the probability of the side.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let Some(p) = self.p_reflect() else { return 0.0 };
        by_side(wo, wi, p, 1.0 - p).map_or(0.0, |p| p * wi.z.abs() * FRAC_1_PI)
    }

    /// A side, and on it a direction with the density of a cosine.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let p = self.p_reflect()?;
        let near = Diffuse { reflectance: self.reflectance / p, sides: Sides::Both }.sample(wo, u)?;
        Some(if u_lobe < p {
            BsdfSample { pdf: p * near.pdf, ..near }
        } else {
            BsdfSample {
                wi: Vec3::new(near.wi.x, near.wi.y, -near.wi.z),
                weight: self.transmittance / (1.0 - p),
                pdf: (1.0 - p) * near.pdf,
                kind: ScatterKind::Transmission,
                ..near
            }
        })
    }
}

/// `near` if both directions are on one side, `far` if they are on two, `None` if one lies in the surface.
#[inline]
fn by_side<T>(wo: Vec3, wi: Vec3, near: T, far: T) -> Option<T> {
    match wo.z * wi.z {
        product if product > 0.0 => Some(near),
        product if product < 0.0 => Some(far),
        _ => None,
    }
}
