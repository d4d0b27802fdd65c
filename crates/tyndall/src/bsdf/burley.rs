//! What Burley's two models share: colour, roughness, and the lobe of a dusty diffuse base.
//!
//! With `c` the colour, `Y` its luminance, `S(x) = (1 − x)⁵`, `δ` the angle between either direction and their half
//! vector, and `R = 2 r cos² δ`:
//!
//! ```text
//! diffuse    c/π ((1 − f) (d + b) + f s) |cos θi|
//!            d = (1 − S(o)/2) (1 − S(i)/2)                            darker towards the rim
//!            b = R (S(o) + S(i) + S(o) S(i) (R − 1))                  brighter back towards the light
//!            s = 1.25 (((1 − S(o)) + S(o) R/2) ((1 − S(i)) + S(i) R/2) (1/(cos θo + cos θi) − 1/2) + 1/2)
//! sheen      h ((1 − t) + t c/Y) S(cos δ) |cos θi|
//! Fresnel    (1 − k) F + k (S + (1 − S) (c/Y) ((η − 1)/(η + 1))²)
//! roughness  α_x = r²/a, α_y = r² a with a = √(1 − 0.9 anisotropic), neither below 0.001
//! ```
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `colour`, `luminance` | `c`, each lane its own, and `Y`; black counts as white where it tints \[1\] | [0, 1] |
//! | `roughness`, `anisotropic` | `r`, and how much longer highlights are along the first tangent \[1\] | [0, 1] |
//! | `spec_trans` | how much of the model is clear \[1\] | [0, 1] |
//! | `spec_tint` | `k`, how far reflections have the hue of the colour \[1\] | [0, 1] |
//! | `sheen`, `sheen_tint` | `h`, and `t`, how far it has the hue of the colour \[1\] | [0, 1] |
//! | `flatness` | `f`, from diffuse to a likeness of subsurface scattering \[1\] | [0, 1] |
//!
//! None of these lobes is held to conserve energy: sheen and the gain towards the light add to a white base.
//!
//! Source: Burley 2012, "Physically Based Shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF with
//! Integrated Subsurface Scattering"; the form is that of Mitsuba's `principled` and `principledthin`.

use std::f32::consts::FRAC_1_PI;

use super::microfacet::{Distribution, Microfacets, Shadowing};
use super::{SMOOTHEST_ALPHA, fresnel};
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// The parameters that both models have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Burley {
    /// Colour \[1\]. (An array: the alignment of [`Lanes`] would make every BSDF bigger.)
    pub colour: [f32; 4],
    /// Luminance of the colour \[1\].
    pub luminance: f32,
    /// Roughness \[1\].
    pub roughness: f32,
    /// How much longer highlights are along the first tangent \[1\].
    pub anisotropic: f32,
    /// How much of the model is clear \[1\].
    pub spec_trans: f32,
    /// How far reflections have the hue of the colour \[1\].
    pub spec_tint: f32,
    /// How much light grazing dust sends on \[1\].
    pub sheen: f32,
    /// How far that has the hue of the colour \[1\].
    pub sheen_tint: f32,
    /// From diffuse to a likeness of subsurface scattering \[1\].
    pub flatness: f32,
}

impl Burley {
    /// The colour in the lanes of a path.
    #[inline]
    pub(super) fn colour(&self) -> Lanes {
        Lanes::new(self.colour)
    }

    /// `c/Y`.
    #[inline]
    fn hue(&self) -> Lanes {
        if self.luminance > 0.0 { self.colour() / self.luminance } else { Lanes::ONE }
    }

    /// The microfacets where the roughness is multiplied by `scale`.
    #[inline]
    pub(super) fn microfacets(&self, scale: f32) -> Microfacets {
        let r = scale * self.roughness;
        let aspect = (1.0 - 0.9 * self.anisotropic).sqrt();
        Microfacets {
            alpha_x: (r * r / aspect).max(SMOOTHEST_ALPHA),
            alpha_y: (r * r * aspect).max(SMOOTHEST_ALPHA),
            distribution: Distribution::TrowbridgeReitz,
            shadowing: Shadowing::Separable,
        }
    }

    /// The diffuse lobe times `|cos θi|` [1/sr], for directions above the surface and the cosine of `δ`.
    #[inline]
    pub(super) fn diffuse(&self, wo: Vec3, wi: Vec3, cos_d: f32) -> Lanes {
        let (so, si) = (schlick_weight(wo.z), schlick_weight(wi.z));
        let r = 2.0 * self.roughness * cos_d * cos_d;
        let diffuse = (1.0 - 0.5 * so) * (1.0 - 0.5 * si);
        let back = r * (so + si + so * si * (r - 1.0));
        let flat = |s: f32| (1.0 - s) + s * 0.5 * r;
        // Times cos θi, since one over the sum of the cosines alone has no bound.
        let below = 1.25 * (flat(so) * flat(si) * (wi.z / (wo.z + wi.z) - 0.5 * wi.z) + 0.5 * wi.z);
        let shape = (1.0 - self.flatness) * (diffuse + back) * wi.z + self.flatness * below;
        self.colour() * (shape * FRAC_1_PI)
    }

    /// The sheen times `|cos θi|` [1/sr].
    #[inline]
    pub(super) fn sheen(&self, wi: Vec3, cos_d: f32) -> Lanes {
        if self.sheen == 0.0 {
            return Lanes::ZERO;
        }
        let tint = Lanes::splat(1.0 - self.sheen_tint) + self.hue() * self.sheen_tint;
        tint * (self.sheen * schlick_weight(cos_d) * wi.z)
    }

    /// What a facet reflects whose true reflectance is `f`: a part of it in the hue of the colour.
    #[inline]
    pub(super) fn fresnel(&self, f: f32, cos_d: f32, eta: f32) -> Lanes {
        let plain = Lanes::splat((1.0 - self.spec_tint) * f);
        if self.spec_tint == 0.0 {
            return plain;
        }
        let r0 = (eta - 1.0) / (eta + 1.0);
        plain + schlick(self.hue() * (r0 * r0), cos_d, eta) * self.spec_tint
    }
}

/// Two directions above the surface and the facet that mirrors one to the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mirror {
    /// Its normal.
    pub(super) m: Vec3,
    /// The cosine of both directions to it.
    pub(super) cos_d: f32,
}

impl Mirror {
    /// `None` for directions that are opposite to each other but for rounding, both in the surface.
    #[inline]
    pub(super) fn between(wo: Vec3, wi: Vec3) -> Option<Self> {
        let h = wo + wi;
        let length = h.length();
        (length > NOTHING).then(|| Self { m: h / length, cos_d: 0.5 * length })
    }
}

/// A sum of unit vectors this short is nothing but rounding.
const NOTHING: f32 = 1e-10;

/// `S`, for a cosine in [0, 1].
#[inline]
fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    m * m * m * m * m
}

/// Schlick's approximation to Fresnel's reflectance; into a smaller index by the angle on the other side.
#[inline]
pub(super) fn schlick(r0: Lanes, cos: f32, eta: f32) -> Lanes {
    let s = schlick_weight(if eta > 1.0 { cos } else { fresnel::dielectric(cos, eta).cos_t });
    Lanes::splat(s) + r0 * (1.0 - s)
}
