//! A base under a coat: varnished wood, lacquered metal, anything that is clear or cloudy on top of something opaque.
//!
//! The coat is a layer of a dielectric with a surface that is smooth or rough; it may absorb and scatter; the base below is
//! Lambert's or a metal. What comes back is the sum over all ways in, between and out, as if the layer were infinitely
//! wide and light left where it came in:
//!
//! ```text
//! f cos θi = f_top cos θi + ∫∫ f_in(o → d₁) cos … scattering in the coat, at the base, under the top … f_out(dₙ → i) cos θi
//! ```
//!
//! There is no closed form. [`Coated::eval`] is an unbiased estimate: a walk enters from `wo` and at each base and each
//! particle that it meets is joined with a way out to `wi`, found in two ways with their balance heuristic: refract `wi`
//! into the coat (`p_a`), or go on by chance (`p_b`) and ask the top for `wi`. Both densities are of the *inner* direction:
//!
//! ```text
//! from a:  w · f(d, e) · (f_top(i, −e) |cos e| / p_a(e)) · η² cos θi / |cos e| · p_a/(p_a + p_b)     by reciprocity
//! from b:  w · f(d, e)/p_b(e) · f_top(−e, i) cos θi                           · p_b/(p_a + p_b)
//! ```
//!
//! Of a smooth top or a polished metal only one way is there. Between both, what a particle scatters goes to and fro without
//! meeting anything that could be joined: that is summed as a geometric series.
//!
//! (pbrt weighs b with the density of the *outer* direction, which is another by `η² |cos e| G₁(i) / (cos θi G₁(e))`: its
//! weights do not add up to 1. Its `f` of a coat with `α = 0.3` over paint is 7 % too bright, over rough gold 12 %, which its
//! samples are not, so that its pictures depend on how the light is found. Nor has its `f` the series. Here all of them are
//! as bright as its samples.)
//!
//! [`Coated::sample`] walks until it is out, taking reflection or refraction by their shares: no weight exceeds 1. The
//! density of where it comes out is not known; [`Coated::pdf`] is one like it: the exact density of the first reflection,
//! and for the rest the lobe of the base seen through a smooth top, widened. That leaves multiple importance sampling
//! unbiased: whatever positive `p(wi)` is, light sampling takes the part `p_l/(p_l + p)` of the light from `wi`, and the walk
//! takes `p/(p_l + p)`, with a weight whose mean over the walks that come out at `wi` is `f cos θi` over their density. The
//! parts add up to 1 and each is estimated without bias. So `weight · pdf` is *not* `eval` here.
//!
//! All random numbers come from a hash of `seed` and the directions: for one seed every value is always the same, and over
//! seeds the mean of `eval` is `f cos θi`.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `eta` | index of the coat over that outside \[1\] | > 0: varnish 1.5 |
//! | `alpha_x`, `alpha_y` | roughness of its surface \[1\] | 0 is smooth |
//! | `thickness` | of the coat [mean free paths]; it extinguishes even if nothing scatters | ≥ 0 |
//! | `albedo` | of what the coat extinguishes, the share that it scatters, each lane its own \[1\] | [0, 1] |
//! | `g` | mean cosine of that scattering (Henyey and Greenstein) \[1\] | (−1, 1) |
//! | `base` | what is under the coat | |
//! | `max_depth` | scatterings between the way in and the way out, of any kind, after which light is lost \[1\] | |
//! | `walks` | walks of one `eval` \[1\] | ≥ 1 |
//! | `seed` | which random numbers | any |
//!
//! `max_depth` is the scene's word and darkens: of a smooth clear coat `n` hits of the base take `2n − 1` scatterings, so
//! pbrt's 10 keeps five. (There an `eval` goes one scattering further than a sample. Here both go as far as `eval`.)
//!
//! Source: Guo, Hašan and Zhao 2018, "Position-free Monte Carlo simulation for arbitrary layered BSDFs"; the materials are
//! pbrt's `coateddiffuse` and `coatedconductor`, Pharr et al. 2023, § 14.3.

mod density;
mod top;
mod walk;

use super::{Bsdf, BsdfSample, ScatterKind, microfacet::Microfacets, seen_from};
use crate::math::{Vec2, Vec3};
use crate::sampling::rng::{Rng, mix64};
use crate::spectrum::Lanes;
use walk::{Layers, Numbers};

/// A base under a coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coated {
    /// Index of the coat over that outside \[1\].
    pub eta: f32,
    /// Roughness of its surface along x \[1\].
    pub alpha_x: f32,
    /// Roughness of its surface along y \[1\].
    pub alpha_y: f32,
    /// Thickness of the coat [mean free paths].
    pub thickness: f32,
    /// The share of what the coat extinguishes that is scattered \[1\].
    pub albedo: Lanes,
    /// Mean cosine of that scattering \[1\].
    pub g: f32,
    /// What is under the coat.
    pub base: Base,
    /// Scatterings between the way in and the way out after which light is lost \[1\].
    pub max_depth: u16,
    /// Walks of one evaluation \[1\].
    pub walks: u16,
    /// Which random numbers.
    pub seed: u32,
}

/// What is under a coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Base {
    /// Lambert's law with this reflectance \[1\].
    Diffuse(Lanes),
    /// A metal.
    Metal {
        /// Real part of its index relative to that of the coat \[1\].
        eta: Lanes,
        /// Imaginary part \[1\].
        k: Lanes,
        /// Roughness along x \[1\].
        alpha_x: f32,
        /// Roughness along y \[1\].
        alpha_y: f32,
    },
}

impl Base {
    fn bsdf(self) -> Bsdf<'static> {
        match self {
            Self::Diffuse(reflectance) => Bsdf::diffuse(reflectance),
            Self::Metal { eta, k, alpha_x, alpha_y } => Bsdf::conductor(eta, k, alpha_x, alpha_y),
        }
    }
}

impl Coated {
    /// An estimate of `f·|cos θi|` [1/sr] on the side of `wo`, without what only has Dirac lobes.
    #[inline(never)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        if wo.z * wi.z <= 0.0 || self.is_specular() {
            return Lanes::ZERO;
        }
        let (up, wi) = (seen_from(wo, wo), seen_from(wo, wi));
        let (layers, mut rng) = (Layers::of(self), self.random(up, wi));
        let walks: Lanes = (0..self.walks).fold(Lanes::ZERO, |sum, _| sum + layers.walk(up, wi, &mut rng));
        layers.top.eval(up, wi) + walks / f32::from(self.walks)
    }

    /// Where a walk from `wo` comes out again on the same side.
    #[inline(never)]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (up, layers) = (seen_from(wo, wo), Layers::of(self));
        let mut numbers = Numbers { given: Some(u), rng: self.random(up, u.extend(u_lobe)) };
        let mut out = layers.top.sample(up, u_lobe, &mut numbers)?;
        if out.kind == ScatterKind::Transmission {
            out = layers.escape(&out, &mut numbers)?;
        }
        let pdf = if out.specular { 1.0 } else { self.density(up, out.wi) };
        let wi = seen_from(wo, out.wi);
        Some(BsdfSample {
            wi,
            weight: out.weight,
            pdf,
            kind: ScatterKind::Reflection,
            specular: out.specular,
            eta: 1.0,
        })
    }

    /// Whether there are only Dirac lobes.
    pub fn is_specular(&self) -> bool {
        let smooth = |x, y| Microfacets::unless_smooth(x, y).is_none();
        let base = matches!(self.base, Base::Metal { alpha_x, alpha_y, .. } if smooth(alpha_x, alpha_y));
        base && self.albedo.is_zero() && layers_are_smooth(self)
    }

    /// The random numbers for two directions.
    fn random(&self, a: Vec3, b: Vec3) -> Rng {
        let bits = |x: f32, y: f32| (u64::from(x.to_bits()) << 32) | u64::from(y.to_bits());
        let key = [bits(a.x, a.y), bits(a.z, b.x), bits(b.y, b.z)];
        let key = key.into_iter().fold(u64::from(self.seed), |hash, bits| mix64(hash ^ bits));
        Rng { key: [key as u32, (key >> 32) as u32], counter: 0 }
    }
}

/// Whether the top has no microfacets.
fn layers_are_smooth(model: &Coated) -> bool {
    matches!(top::Top::of(model), top::Top::Smooth(_))
}
