//! Microfacets: the slopes of a rough surface, what of them can be seen, and how to draw them.
//!
//! With `r² = α_x² w_x² + α_y² w_y²`, for directions above the surface:
//!
//! ```text
//! t²        = ((m_x/α_x)² + (m_y/α_y)²) / m_z²                        slope of a normal, in units of the roughness
//! D(m)      = 1 / (π α_x α_y m_z⁴ (1 + t²)²)                          Trowbridge and Reitz (GGX) [1/sr]
//! D(m)      = exp(−t²) / (π α_x α_y m_z⁴)                             Beckmann [1/sr]
//! s(w)      = √(w_z² + r²)                                            Trowbridge and Reitz
//! s(w)      = w_z erf(w_z/r) + r exp(−(w_z/r)²)/√π                    Beckmann
//! Λ(w)      = (s/w_z − 1)/2,   G₁ = 1/(1 + Λ)                         Smith's masking, of both
//! G₂(o, i)  = 1/(1 + Λ_o + Λ_i) = 2 o_z i_z / (s_o i_z + s_i o_z)     height-correlated masking and shadowing
//! G₂(o, i)  = G₁(o) G₁(i)                                             separable masking and shadowing
//! D_o(m)    = G₁(o) D(m) (o·m) / o_z = 2 D(m) (o·m) / (o_z + s_o)     visible normals [1/sr]
//! ```
//!
//! Written with `s`, nothing divides by a cosine that vanishes at grazing angles, and a distribution is its `D`, its `s`
//! and its way to draw visible normals. `G₂` serves reflection and transmission alike. Facets that are high are seen from
//! both directions and low ones from neither: the correlated form (pbrt) knows that, the product (Mitsuba) does not and
//! shadows more. With either, the weight of a visible normal is `G₂/G₁(o)`.
//!
//! Visible normals are drawn for unit roughness and stretched. Trowbridge and Reitz: a uniform point on a spherical cap,
//! without a frame. Beckmann: across the plane of `o` the slope is Gaussian; within it, the slope `x` has the cumulative
//! distribution `∝ o_z √π (1 + erf x) + √(1 − o_z²) exp(−x²)` below `o_z/√(1 − o_z²)`, which is inverted numerically.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `alpha_x`, `alpha_y` | roughness along the tangents: the scale of the slopes \[1\] | about 0.001 to 1 |
//! | `distribution` | the law of the slopes | |
//! | `shadowing` | how masking and shadowing depend on each other | |
//!
//! Source: Beckmann and Spizzichino 1963; Trowbridge and Reitz 1975; Walter et al. 2007; Heitz 2014, "Understanding the
//! masking-shadowing function"; sampling: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps";
//! Heitz and d'Eon 2014, "Importance sampling microfacet-based BSDFs using the distribution of visible normals".

use std::f32::consts::PI;

use super::SMOOTHEST_ALPHA;
use crate::math::{Vec2, Vec3, fast::sin_cos_turn};

/// Roughness in [0, 1] as artists set it, to `alpha` (pbrt's `remaproughness`): `α = √roughness`.
pub fn roughness_to_alpha(roughness: f32) -> f32 {
    roughness.max(0.0).sqrt()
}

/// The law of the slopes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Distribution {
    /// Trowbridge and Reitz 1975, known as GGX: steep slopes are frequent.
    #[default]
    TrowbridgeReitz,
    /// Beckmann and Spizzichino 1963: Gaussian slopes, of variance `α²/2` along each tangent.
    Beckmann,
}

/// How what hides a microfacet from one direction and from another depend on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shadowing {
    /// By the height that both share (Heitz 2014, eq. 99), as pbrt has it.
    #[default]
    Correlated,
    /// Not at all: a product, as Mitsuba has it.
    Separable,
}

/// The microfacets of a rough surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microfacets {
    /// Roughness along x \[1\].
    pub alpha_x: f32,
    /// Roughness along y \[1\].
    pub alpha_y: f32,
    /// The law of their slopes.
    pub distribution: Distribution,
    /// How masking and shadowing depend on each other.
    pub shadowing: Shadowing,
}

/// Slopes beyond this many times the roughness are left out of Beckmann's distribution: one in 10¹¹.
const STEEPEST: f64 = 5.0;

/// `1/√π`.
const FRAC_1_SQRT_PI: f64 = std::f64::consts::FRAC_2_SQRT_PI * 0.5;

impl Microfacets {
    /// Those of Trowbridge and Reitz, or `None` for a surface that is smooth in both directions.
    pub fn unless_smooth(alpha_x: f32, alpha_y: f32) -> Option<Self> {
        (alpha_x.max(alpha_y) >= SMOOTHEST_ALPHA).then(|| Self {
            alpha_x: alpha_x.max(SMOOTHEST_ALPHA),
            alpha_y: alpha_y.max(SMOOTHEST_ALPHA),
            distribution: Distribution::TrowbridgeReitz,
            shadowing: Shadowing::Correlated,
        })
    }

    /// `D(m)` [1/sr]: `∫ D(m) m_z dm = 1` over the hemisphere.
    #[inline]
    pub fn density(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let z2 = m.z * m.z;
        let unit = PI * self.alpha_x * self.alpha_y;
        match self.distribution {
            Distribution::TrowbridgeReitz => {
                let q = x * x + y * y + z2;
                1.0 / (unit * q * q)
            }
            Distribution::Beckmann => {
                let slope2 = (x * x + y * y) / z2;
                // Also false for a normal in the surface, whose slope is infinite or not a number.
                if slope2 < 80.0 { libm::expf(-slope2) / (unit * z2 * z2) } else { 0.0 }
            }
        }
    }

    /// `s(w)`, at least `w_z`: what Smith's masking of `w` depends on.
    #[inline]
    pub fn stretched(&self, w: Vec3) -> f32 {
        let (x, y) = (w.x * self.alpha_x, w.y * self.alpha_y);
        let r2 = x * x + y * y;
        match self.distribution {
            Distribution::TrowbridgeReitz => (r2 + w.z * w.z).sqrt(),
            Distribution::Beckmann if r2 == 0.0 => w.z,
            Distribution::Beckmann => {
                let r = r2.sqrt();
                let a = w.z / r;
                (w.z * libm::erff(a) + r * libm::expf(-a * a) * FRAC_1_SQRT_PI as f32).max(w.z)
            }
        }
    }

    /// `G₁(w)` in [0, 1]: the part of the microfacets that face `w` (`w_z > 0`) which is not hidden from it.
    #[inline]
    pub fn masking(&self, w: Vec3) -> f32 {
        2.0 * w.z / (w.z + self.stretched(w))
    }

    /// `G₂(wo, wi) / wo_z`, for directions with their z components taken positive.
    #[inline]
    pub fn masking_shadowing_over_cos(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.shadowing {
            Shadowing::Correlated => 2.0 * wi.z / (self.stretched(wo) * wi.z + self.stretched(wi) * wo.z),
            Shadowing::Separable => 2.0 * self.masking(wi) / (wo.z + self.stretched(wo)),
        }
    }

    /// `G₂(wo, wi) / G₁(wo)` in [0, 1], for directions with their z components taken positive.
    #[inline]
    pub fn shadowing_of_visible(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.shadowing {
            Shadowing::Correlated => {
                let so = self.stretched(wo);
                wi.z * (wo.z + so) / (so * wi.z + self.stretched(wi) * wo.z)
            }
            Shadowing::Separable => self.masking(wi),
        }
    }

    /// `D_o(m)` [1/sr], the density of [`Self::sample_visible`], for `wo_z > 0`.
    #[inline]
    pub fn visible_density(&self, wo: Vec3, m: Vec3) -> f32 {
        2.0 * self.density(m) * wo.dot(m).max(0.0) / (wo.z + self.stretched(wo))
    }

    /// A normal among those visible from `wo` (`wo_z > 0`), with `u` in [0, 1).
    #[inline]
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let o = self.unit(wo);
        let h = match self.distribution {
            Distribution::TrowbridgeReitz => visible_on_cap(o, u),
            Distribution::Beckmann => {
                let [x, y] = slopes(o, u);
                facet_of_slopes(o, x, y)
            }
        };
        self.stretch(h)
    }

    /// Every normal of [`Self::sample_visible`] for the middles of `n` by `n` cells of `u`: a quadrature over what is
    /// visible from `wo`, for which each Gaussian slope is inverted once.
    pub(super) fn for_visible_grid(&self, wo: Vec3, n: usize, mut f: impl FnMut(Vec3)) {
        let o = self.unit(wo);
        let middle = |i: usize| (i as f32 + 0.5) / n as f32;
        let slopes: Vec<_> = match self.distribution {
            Distribution::TrowbridgeReitz => Vec::new(),
            Distribution::Beckmann => (0..n).map(|i| slopes(o, Vec2::splat(middle(i)))).collect(),
        };
        for i in 0..n {
            for j in 0..n {
                f(self.stretch(match self.distribution {
                    Distribution::TrowbridgeReitz => visible_on_cap(o, Vec2::new(middle(i), middle(j))),
                    Distribution::Beckmann => facet_of_slopes(o, slopes[i][0], slopes[j][1]),
                }));
            }
        }
    }

    /// `w` as it is seen where the roughness is 1.
    #[inline]
    fn unit(&self, w: Vec3) -> Vec3 {
        let o = Vec3::new(w.x * self.alpha_x, w.y * self.alpha_y, w.z);
        o / o.length()
    }

    /// A normal where the roughness is 1, as it is here.
    #[inline]
    fn stretch(&self, h: Vec3) -> Vec3 {
        Vec3::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z).normalize()
    }
}

/// A visible normal of unit roughness after Trowbridge and Reitz, not normalised, for a unit `o`.
#[inline]
fn visible_on_cap(o: Vec3, u: Vec2) -> Vec3 {
    // A uniform point c of the cap z ≥ −o_z; 1 − c_z and 1 + c_z apart, since one of them is small for small α.
    let (below, above) = (u.y * (1.0 + o.z), (1.0 - u.y) * (1.0 + o.z));
    let sin_theta = (below * (1.0 - o.z + above)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = sin_cos_turn(u.x);
    Vec3::new(sin_theta * cos_phi + o.x, sin_theta * sin_phi + o.y, above)
}

/// The slopes of a visible facet of unit roughness after Beckmann, within the plane of a unit `o` and across it.
fn slopes(o: Vec3, u: Vec2) -> [f64; 2] {
    let o = o.as_dvec3();
    [visible_slope(o.z, o.x.hypot(o.y), f64::from(u.x)), visible_slope(1.0, 0.0, f64::from(u.y))]
}

/// The normal of the facet with these slopes within the plane of `o` and across it, not normalised.
fn facet_of_slopes(o: Vec3, x: f64, y: f64) -> Vec3 {
    let o = o.as_dvec3();
    let sin = o.x.hypot(o.y);
    let along = if sin == 0.0 { glam::DVec2::X } else { o.truncate() / sin };
    // A facet of slope (x, y) has the normal (−x, −y, 1), turned to the azimuth of o.
    Vec3::new((along.y * y - along.x * x) as f32, (-along.y * x - along.x * y) as f32, 1.0)
}

/// The slope `x` along a direction of polar angle θ below which lies the share `u` of what is seen of Gaussian facets:
/// `F(x) = u F(cot θ)` with `F(x) = cos θ √π (1 + erf x) + sin θ exp(−x²)`.
///
/// Newton's method, kept inside an interval that shrinks from both sides.
fn visible_slope(cos: f64, sin: f64, u: f64) -> f64 {
    let share = |x: f64| cos * (1.0 + libm::erf(x)) + sin * libm::exp(-x * x) * FRAC_1_SQRT_PI;
    let steepest = if cos < STEEPEST * sin { cos / sin } else { STEEPEST };
    let (mut low, mut high) = (-STEEPEST, steepest);
    let wanted = u * share(high);
    let mut x = 0f64.min(0.5 * (low + high));
    for _ in 0..64 {
        let over = share(x) - wanted;
        (low, high) = if over > 0.0 { (low, x) } else { (x, high) };
        let slope = 2.0 * (cos - x * sin) * libm::exp(-x * x) * FRAC_1_SQRT_PI;
        let step = over / slope;
        let next = x - step;
        if step.abs() < 1e-8 {
            break;
        }
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    x
}
