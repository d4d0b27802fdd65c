//! The surface of a coat, which can be told to reflect or to refract.

use super::{Coated, walk::Numbers};
use crate::bsdf::{Bsdf, BsdfSample, Dielectric, RoughDielectric};
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// The surface between a coat and the outside.
#[derive(Clone, Copy)]
pub(super) enum Top {
    /// With Dirac lobes only.
    Smooth(Dielectric),
    /// With microfacets.
    Rough(RoughDielectric),
}

impl Top {
    #[inline]
    pub(super) fn of(coat: &Coated) -> Self {
        match Bsdf::dielectric(coat.eta, coat.alpha_x, coat.alpha_y) {
            Bsdf::RoughDielectric(rough) => Self::Rough(rough),
            _ => Self::Smooth(Dielectric::new(coat.eta)),
        }
    }

    /// `f·|cos θi|` [1/sr].
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        match self {
            Self::Smooth(_) => Lanes::ZERO,
            Self::Rough(model) => model.eval(wo, wi),
        }
    }

    /// The density [1/sr] of [`Self::sample`].
    #[inline]
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Smooth(_) => 0.0,
            Self::Rough(model) => model.pdf(wo, wi),
        }
    }

    /// Reflection or refraction, by their shares of the power.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u_lobe: f32, numbers: &mut Numbers) -> Option<BsdfSample> {
        match self {
            Self::Smooth(model) => model.sample(wo, u_lobe),
            Self::Rough(model) => model.sample(wo, u_lobe, numbers.next_2d()),
        }
    }

    /// Reflection.
    #[inline]
    pub(super) fn reflect(&self, wo: Vec3, numbers: &mut Numbers) -> Option<BsdfSample> {
        match self {
            Self::Smooth(model) => model.reflect(wo),
            Self::Rough(model) => model.reflect(wo, numbers.next_2d()),
        }
    }

    /// Refraction.
    #[inline]
    pub(super) fn refract(&self, wo: Vec3, numbers: &mut Numbers) -> Option<BsdfSample> {
        match self {
            Self::Smooth(model) => model.refract(wo),
            Self::Rough(model) => model.refract(wo, numbers.next_2d()),
        }
    }

    /// The density [1/sr] of [`Self::refract`]; none of a Dirac lobe.
    #[inline]
    pub(super) fn refraction_pdf(&self, wo: Vec3, wi: Vec3) -> Option<f32> {
        match self {
            Self::Smooth(_) => None,
            Self::Rough(model) => Some(model.refraction_pdf(wo, wi)),
        }
    }
}
