//! A density like that of the walks: what multiple importance sampling weighs them with.
//!
//! ```text
//! p(o, i) = p_top(o, i) + (1 − F(o)) · ((1 − b) p_base(o', i') · cos θi / (η² cos θi') + b cos θi / π)
//! ```
//!
//! `o'` and `i'` are refracted at a smooth top, `p_base` is the density of the visible normals of a metal, and `b` the part
//! that is scattered widely: all of it over Lambert's base; over a metal what the coat scatters, and a tenth for what is
//! reflected more than once. A rough top widens the lobe of a metal. A facet of slope `s` turns what passes it by
//! `(1 − 1/η)s` inside, one of the metal by `2s`; light passes the top twice, so that the variances add up to
//! `α² = α_base² + (1 − 1/η)² α_top² / 2`.

use std::f32::consts::FRAC_1_PI;

use super::{Base, Coated, top::Top};
use crate::bsdf::{fresnel, microfacet::Microfacets, seen_from};
use crate::math::Vec3;

/// The part of what a metal sends back that has been reflected more than once, about.
const MULTIPLE: f32 = 0.1;

/// The least part that is taken to enter.
const LEAST_ENTERS: f32 = 0.01;

impl Coated {
    /// A density [1/sr] like that of the walks; zero where there are only Dirac lobes.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z * wi.z <= 0.0 || self.is_specular() { 0.0 } else { self.density(seen_from(wo, wo), seen_from(wo, wi)) }
    }

    /// The same for directions above a coat that has not only Dirac lobes.
    pub(super) fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        // A rough top lets light in even at grazing angles.
        let enters = (1.0 - fresnel::dielectric(wo.z, self.eta).reflectance).max(LEAST_ENTERS);
        Top::of(self).pdf(wo, wi) + enters * self.below(wo, wi)
    }

    /// The density of what has entered.
    fn below(&self, wo: Vec3, wi: Vec3) -> f32 {
        let wide = wi.z * FRAC_1_PI;
        let Base::Metal { alpha_x, alpha_y, .. } = self.base else { return wide };
        let bend = 0.5 * (1.0 - 1.0 / self.eta).powi(2);
        let widened = |base: f32, top: f32| (base * base + bend * top * top).sqrt();
        let lobe = Microfacets::unless_smooth(widened(alpha_x, self.alpha_x), widened(alpha_y, self.alpha_y));
        let (cos_o, cos_i) = (self.inner_cosine(wo), self.inner_cosine(wi));
        let scattered = self.albedo.max_lane() * (1.0 - libm::expf(-2.0 * self.thickness / cos_o.max(1e-3)));
        match lobe {
            Some(lobe) if cos_i > 0.0 && cos_o > 0.0 => {
                let inner = |w: Vec3, cos: f32| Vec3::new(w.x / self.eta, w.y / self.eta, cos);
                let (o, i) = (inner(wo, cos_o), inner(wi, cos_i));
                let m = (o + i).normalize();
                let mirrored = lobe.density(m) * 0.5 / (o.z + lobe.stretched(o));
                let wide_part = MULTIPLE + (1.0 - MULTIPLE) * scattered;
                (1.0 - wide_part) * mirrored * wi.z / (self.eta * self.eta * cos_i) + wide_part * wide
            }
            _ => (MULTIPLE + (1.0 - MULTIPLE) * scattered) * wide,
        }
    }

    /// The cosine of `w` refracted by a smooth top.
    fn inner_cosine(&self, w: Vec3) -> f32 {
        fresnel::dielectric(w.z, self.eta).cos_t
    }
}
