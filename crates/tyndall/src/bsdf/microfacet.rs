//! Trowbridge–Reitz (GGX) microfacets: the slopes of a rough surface, what of them can be seen, and how to draw them.
//!
//! With `s(w) = √(w_z² + α_x² w_x² + α_y² w_y²)`, for directions above the surface:
//!
//! ```text
//! D(m)      = 1 / (π α_x α_y ((m_x/α_x)² + (m_y/α_y)² + m_z²)²)      density of normals [1/sr]
//! Λ(w)      = (s/w_z − 1)/2,   G₁ = 1/(1 + Λ)                        Smith's masking
//! G₂(o, i)  = 1/(1 + Λ_o + Λ_i) = 2 o_z i_z / (s_o i_z + s_i o_z)     height-correlated masking and shadowing
//! D_o(m)    = G₁(o) D(m) (o·m) / o_z = 2 D(m) (o·m) / (o_z + s_o)     visible normals [1/sr]
//! ```
//!
//! Written with `s`, nothing divides by a cosine that vanishes at grazing angles. `G₂` serves reflection and transmission
//! alike, as in pbrt. Visible normals are drawn as a uniform point on a spherical cap, without a frame.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `alpha_x`, `alpha_y` | roughness along the tangents: the scale of the slopes \[1\] | about 0.001 to 1 |
//!
//! Source: Trowbridge and Reitz 1975; Walter et al. 2007; Heitz 2014, "Understanding the masking-shadowing function";
//! sampling: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps".

use std::f32::consts::PI;

use super::SMOOTHEST_ALPHA;
use crate::math::{Vec2, Vec3, fast::sin_cos_turn};

/// Roughness in [0, 1] as artists set it, to `alpha` (pbrt's `remaproughness`): `α = √roughness`.
pub fn roughness_to_alpha(roughness: f32) -> f32 {
    roughness.max(0.0).sqrt()
}

/// The distribution of microfacet normals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrowbridgeReitz {
    /// Roughness along x \[1\].
    pub alpha_x: f32,
    /// Roughness along y \[1\].
    pub alpha_y: f32,
}

impl TrowbridgeReitz {
    /// The distribution, or `None` for a surface that is smooth in both directions.
    pub fn unless_smooth(alpha_x: f32, alpha_y: f32) -> Option<Self> {
        (alpha_x.max(alpha_y) >= SMOOTHEST_ALPHA)
            .then(|| Self { alpha_x: alpha_x.max(SMOOTHEST_ALPHA), alpha_y: alpha_y.max(SMOOTHEST_ALPHA) })
    }

    /// `D(m)` [1/sr]: `∫ D(m) m_z dm = 1` over the hemisphere.
    #[inline]
    pub fn density(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let q = x * x + y * y + m.z * m.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * q * q)
    }

    /// `s(w)`: the length of `w` in the space where the surface has unit roughness.
    #[inline]
    pub fn stretched(&self, w: Vec3) -> f32 {
        let (x, y) = (w.x * self.alpha_x, w.y * self.alpha_y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// `G₁(w)` in [0, 1]: the part of the microfacets that face `w` (`w_z > 0`) which is not hidden from it.
    #[inline]
    pub fn masking(&self, w: Vec3) -> f32 {
        2.0 * w.z / (w.z + self.stretched(w))
    }

    /// `G₂(wo, wi) / wo_z`, for directions with their z components taken positive.
    #[inline]
    pub fn masking_shadowing_over_cos(&self, wo: Vec3, wi: Vec3) -> f32 {
        2.0 * wi.z / (self.stretched(wo) * wi.z + self.stretched(wi) * wo.z)
    }

    /// `G₂(wo, wi) / G₁(wo)` in [0, 1], for directions with their z components taken positive.
    #[inline]
    pub fn shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        let so = self.stretched(wo);
        wi.z * (wo.z + so) / (so * wi.z + self.stretched(wi) * wo.z)
    }

    /// `D_o(m)` [1/sr], the density of [`Self::sample_visible`], for `wo_z > 0`.
    #[inline]
    pub fn visible_density(&self, wo: Vec3, m: Vec3) -> f32 {
        2.0 * self.density(m) * wo.dot(m).max(0.0) / (wo.z + self.stretched(wo))
    }

    /// A normal among those visible from `wo` (`wo_z > 0`), with `u` in [0, 1).
    #[inline]
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let o = Vec3::new(wo.x * self.alpha_x, wo.y * self.alpha_y, wo.z) / self.stretched(wo);
        // A uniform point c of the cap z ≥ −o_z; 1 − c_z and 1 + c_z apart, since one of them is small for small α.
        let (below, above) = (u.y * (1.0 + o.z), (1.0 - u.y) * (1.0 + o.z));
        let sin_theta = (below * (1.0 - o.z + above)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = sin_cos_turn(u.x);
        let h = Vec3::new(sin_theta * cos_phi + o.x, sin_theta * sin_phi + o.y, above);
        Vec3::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z).normalize()
    }
}
