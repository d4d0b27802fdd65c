//! BSDFs: where light goes when it meets a surface.
//!
//! Conventions, the same for every model:
//!
//! - `wo` and `wi` are unit vectors that point **away** from the surface, in the local frame whose z axis is the shading
//!   normal on the outside of the shape. `wo.z > 0` is outside.
//! - A path comes from the camera: `wo` looks back along it, `wi` is where it goes on and where light comes from.
//! - `eval` is `f(wo, wi)·|cos θi|` [1/sr]: it includes the cosine. Perfectly sharp (Dirac) lobes evaluate to zero and
//!   can only be sampled; a model may have others beside them.
//! - `pdf` is per steradian of `wi`, over the whole sphere.
//! - What is carried is radiance: light that passes into an index higher by `η` is squeezed into a smaller cone, so
//!   transmission carries `1/η²`, with `η` the index on the side of `wi` over that on the side of `wo`. Hence
//!   `f(wo, wi)/η_o² = f(wi, wo)/η_i²`, which for reflection is plain reciprocity.
//!
//! To add a model: one file, one variant with its forwarding lines, one row in the table of `tests/models.rs`.

pub mod fresnel;
pub mod hair;
pub mod measured;
pub mod microfacet;

mod burley;
mod coated;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod making;
mod plastic;
mod principled;
mod principled_thin;
mod rough_conductor;
mod rough_dielectric;
mod rough_plastic;
mod thin_dielectric;

pub use burley::Burley;
pub use coated::{Base, Coated};
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use making::index_of_reflectance;
pub use plastic::{Plastic, internal_reflectance};
pub use principled::{Principled, PrincipledFixed};
pub use principled_thin::{PrincipledThin, ThinRates};
pub use rough_conductor::RoughConductor;
pub use rough_dielectric::RoughDielectric;
pub use rough_plastic::{RoughCoat, RoughPlastic};
pub use thin_dielectric::ThinDielectric;

use crate::math::{Vec2, Vec3};
use crate::spectrum::Lanes;
use hair::Hair;
use measured::Measured;

/// Surfaces whose roughness is below this in both directions are perfectly smooth: the lobe would be narrower than
/// single precision can hold (as pbrt, Pharr et al. 2023, § 9.6).
pub const SMOOTHEST_ALPHA: f32 = 1e-3;

/// Which sides of a surface a model answers on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// Both sides alike, as in pbrt and in Mitsuba's `twosided`.
    #[default]
    Both,
    /// Only the outside; the inside is black, as Mitsuba's plain `diffuse` and `conductor`.
    Outside,
}

impl Sides {
    /// Whether light is reflected from `wi` to `wo`: both on one side, which answers.
    #[inline]
    fn reflect(self, wo: Vec3, wi: Vec3) -> bool {
        wo.z * wi.z > 0.0 && self.answer(wo)
    }

    /// Whether the side of `wo` answers.
    #[inline]
    fn answer(self, wo: Vec3) -> bool {
        match self {
            Self::Both => wo.z != 0.0,
            Self::Outside => wo.z > 0.0,
        }
    }
}

/// On which side a scattered direction lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScatterKind {
    /// On the side of `wo`.
    Reflection,
    /// On the other side.
    Transmission,
}

/// A direction drawn from a BSDF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfSample {
    /// Where the path goes on: a unit vector away from the surface, local frame.
    pub wi: Vec3,
    /// `f·|cos θi| / pdf` \[1\].
    pub weight: Lanes,
    /// Density of `wi` [1/sr]; for Dirac lobes the probability \[1\] that this lobe was chosen.
    pub pdf: f32,
    /// The side on which `wi` lies.
    pub kind: ScatterKind,
    /// Whether the lobe is Dirac, so that `eval` and `pdf` cannot see it.
    pub specular: bool,
    /// The relative index crossed: `η_i/η_o` for transmission, 1 for reflection.
    pub eta: f32,
}

/// A model of a surface. The methods only forward. Tables are the scene's: a model refers to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bsdf<'s> {
    /// Lambert's law.
    Diffuse(Diffuse),
    /// A polished metal.
    Conductor(Conductor),
    /// A metal with microfacets.
    RoughConductor(RoughConductor),
    /// Clear smooth glass, water, the polished skin of milk.
    Dielectric(Dielectric),
    /// Ground glass.
    RoughDielectric(RoughDielectric),
    /// A window pane.
    ThinDielectric(ThinDielectric),
    /// A leaf, a lampshade.
    DiffuseTransmission(DiffuseTransmission),
    /// A diffuse base under a smooth coat.
    Plastic(Plastic),
    /// A diffuse base under a coat with microfacets.
    RoughPlastic(RoughPlastic<'s>),
    /// Burley's model of solids.
    Principled(Principled<'s>),
    /// Burley's model of sheets.
    PrincipledThin(PrincipledThin<'s>),
    /// A base under a coat, rough or smooth, clear or cloudy.
    Coated(Coated),
    /// As it was measured.
    Measured(Measured<'s>),
    /// A fibre of hair.
    Hair(Hair),
    /// No surface at all: a mere boundary of media.
    Null,
}

impl Bsdf<'_> {
    /// `f(wo, wi)·|cos θi|` [1/sr]; zero for Dirac lobes.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        match self {
            Self::Diffuse(model) => model.eval(wo, wi),
            Self::RoughConductor(model) => model.eval(wo, wi),
            Self::RoughDielectric(model) => model.eval(wo, wi),
            Self::DiffuseTransmission(model) => model.eval(wo, wi),
            Self::Plastic(model) => model.eval(wo, wi),
            Self::RoughPlastic(model) => model.eval(wo, wi),
            Self::Principled(model) => model.eval(wo, wi),
            Self::PrincipledThin(model) => model.eval(wo, wi),
            Self::Coated(model) => model.eval(wo, wi),
            Self::Measured(model) => model.eval(wo, wi),
            Self::Hair(model) => model.eval_and_pdf(wo, wi).0,
            Self::Conductor(_) | Self::Dielectric(_) | Self::ThinDielectric(_) | Self::Null => Lanes::ZERO,
        }
    }

    /// The density [1/sr] with which [`Self::sample`] draws `wi`; zero for Dirac lobes.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Diffuse(model) => model.pdf(wo, wi),
            Self::RoughConductor(model) => model.pdf(wo, wi),
            Self::RoughDielectric(model) => model.pdf(wo, wi),
            Self::DiffuseTransmission(model) => model.pdf(wo, wi),
            Self::Plastic(model) => model.pdf(wo, wi),
            Self::RoughPlastic(model) => model.pdf(wo, wi),
            Self::Principled(model) => model.pdf(wo, wi),
            Self::PrincipledThin(model) => model.pdf(wo, wi),
            Self::Coated(model) => model.pdf(wo, wi),
            Self::Measured(model) => model.pdf(wo, wi),
            Self::Hair(model) => model.eval_and_pdf(wo, wi).1,
            Self::Conductor(_) | Self::Dielectric(_) | Self::ThinDielectric(_) | Self::Null => 0.0,
        }
    }

    /// [`Self::eval`] and [`Self::pdf`], for which a fibre does the same work.
    #[inline]
    pub fn eval_and_pdf(&self, wo: Vec3, wi: Vec3) -> (Lanes, f32) {
        match self {
            Self::Hair(model) => model.eval_and_pdf(wo, wi),
            _ => (self.eval(wo, wi), self.pdf(wo, wi)),
        }
    }

    /// Draws `wi` with `u_lobe` and `u` in [0, 1). `None`: the path ends here, absorbed or shadowed by a microfacet.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(model) => model.sample(wo, u),
            Self::Conductor(model) => model.sample(wo),
            Self::RoughConductor(model) => model.sample(wo, u),
            Self::Dielectric(model) => model.sample(wo, u_lobe),
            Self::RoughDielectric(model) => model.sample(wo, u_lobe, u),
            Self::ThinDielectric(model) => model.sample(wo, u_lobe),
            Self::DiffuseTransmission(model) => model.sample(wo, u_lobe, u),
            Self::Plastic(model) => model.sample(wo, u_lobe, u),
            Self::RoughPlastic(model) => model.sample(wo, u_lobe, u),
            Self::Principled(model) => model.sample(wo, u_lobe, u),
            Self::PrincipledThin(model) => model.sample(wo, u_lobe, u),
            Self::Coated(model) => model.sample(wo, u_lobe, u),
            Self::Measured(model) => model.sample(wo, u),
            Self::Hair(model) => model.sample(wo, u_lobe, u),
            Self::Null => Some(straight_on(wo)),
        }
    }

    /// Whether there is nothing but Dirac lobes, so that light sampling is in vain.
    #[inline]
    pub fn is_specular(&self) -> bool {
        match self {
            Self::Conductor(_) | Self::Dielectric(_) | Self::ThinDielectric(_) | Self::Null => true,
            Self::Coated(model) => model.is_specular(),
            _ => false,
        }
    }

    /// How many light samples are worth their while at a vertex: two on a fibre, whose lobes are narrow and which stands among
    /// others that shade it.
    #[inline]
    pub fn light_samples(&self) -> u32 {
        if matches!(self, Self::Hair(_)) { 2 } else { 1 }
    }

    /// Whether all that is not a Dirac lobe follows Lambert's law.
    #[inline]
    pub fn is_diffuse(&self) -> bool {
        matches!(self, Self::Diffuse(_) | Self::DiffuseTransmission(_) | Self::Plastic(_))
    }

    /// Whether light can pass to the other side.
    #[inline]
    pub fn transmits(&self) -> bool {
        match self {
            Self::Diffuse(_)
            | Self::Conductor(_)
            | Self::RoughConductor(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_)
            | Self::Coated(_)
            | Self::Measured(_) => false,
            Self::Dielectric(model) => !model.transmittance.is_zero(),
            Self::RoughDielectric(model) => !model.interface.transmittance.is_zero(),
            Self::ThinDielectric(model) => !model.transmittance.is_zero(),
            Self::DiffuseTransmission(model) => !model.transmittance.is_zero(),
            Self::Principled(model) => model.transmits(),
            Self::PrincipledThin(_) | Self::Hair(_) | Self::Null => true,
        }
    }
}

/// A vertex of every path holds one, as big as the biggest, a coat: tables and constants stay in the scene.
const _: () = assert!(size_of::<Bsdf>() <= 112);

/// The unscattered direction behind a surface that is not there.
#[inline]
fn straight_on(wo: Vec3) -> BsdfSample {
    BsdfSample { wi: -wo, weight: Lanes::ONE, pdf: 1.0, kind: ScatterKind::Transmission, specular: true, eta: 1.0 }
}

/// The mirror image in the plane of the surface: where a smooth surface reflects.
#[inline]
fn mirrored(w: Vec3) -> Vec3 {
    Vec3::new(-w.x, -w.y, w.z)
}

/// The other side's view of the same direction: models that are alike on both sides answer as if `wo` were outside.
#[inline]
fn seen_from(wo: Vec3, w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z * 1f32.copysign(wo.z))
}
