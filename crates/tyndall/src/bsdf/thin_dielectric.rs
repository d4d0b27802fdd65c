//! A thin sheet of a clear dielectric: a window pane, the wall of a soap bubble.
//!
//! Both faces of the sheet in one surface. Light bounces between them without end, and what leaves on either side is the
//! sum of a geometric series, of waves that do not interfere: with Fresnel's `R` of one face and `T = 1 − R`
//!
//! `R' = R + T R T + T R³ T + … = R + T² R / (1 − R²) = 2R / (1 + R)`, `T' = 1 − R'`
//!
//! The angle inside gives the second face the same `R` as the first. Light leaves as it came, a parallel that the
//! thinness makes the same line, so nothing bends, no radiance is squeezed, and wavelengths need not part: each lane has
//! its own index. Both sides are alike.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `eta` | index of the sheet over that of what surrounds it, each lane its own \[1\] | > 0: a pane 1.5 |
//! | `reflectance`, `transmittance` | multipliers of the lobes \[1\] | [0, 1]; 1 is physical |
//!
//! Source: Stokes 1862, *On the intensity of the light reflected from or transmitted through a pile of plates*; in this
//! form Pharr et al. 2023, § 9.5.1.

use super::{BsdfSample, ScatterKind, fresnel, mirrored, straight_on};
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// A sheet between two smooth interfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinDielectric {
    /// Index of the sheet over that of its surroundings \[1\].
    pub eta: Lanes,
    /// Multiplier of the reflection \[1\].
    pub reflectance: Lanes,
    /// Multiplier of the transmission \[1\].
    pub transmittance: Lanes,
}

impl ThinDielectric {
    /// `R'`, the fraction of the power that the sheet reflects at the cosine `cos_i` in [0, 1].
    #[inline]
    fn reflected(&self, cos_i: f32) -> Lanes {
        self.eta.map(|eta| {
            let r = fresnel::dielectric(cos_i, eta).reflectance;
            2.0 * r / (1.0 + r)
        })
    }

    /// The mirrored direction or the one straight on, by their shares of the power in the brightest lanes.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let all = self.reflected(wo.z.abs());
        let (reflected, transmitted) = (self.reflectance * all, self.transmittance * all.map(|r| 1.0 - r));
        let (r, t) = (reflected.max_lane(), transmitted.max_lane());
        if r + t <= 0.0 {
            return None;
        }
        let p_reflect = r / (r + t);
        Some(if u_lobe < p_reflect {
            let (wi, kind) = (mirrored(wo), ScatterKind::Reflection);
            BsdfSample { wi, weight: reflected / p_reflect, pdf: p_reflect, kind, specular: true, eta: 1.0 }
        } else {
            let p_transmit = 1.0 - p_reflect;
            BsdfSample { weight: transmitted / p_transmit, pdf: p_transmit, ..straight_on(wo) }
        })
    }
}
