//! A place where a path scatters: on a surface or in a medium, with one interface for both.

use super::turn::{Kind, Turn};
use crate::{
    bsdf::Bsdf,
    light::Reference,
    math::{Frame, Ray, Vec2, Vec3},
    medium::MediumId,
    phase::{Phase, deflect},
    relief::{Embossed, Relief, unshadowed},
    scene::{MaterialId, Scene},
    shape::Interaction,
    spectrum::Lanes,
};

/// A scattering vertex.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::large_enum_variant, reason = "one lives at a time")]
pub enum Vertex<'s> {
    /// On a surface.
    Surface {
        /// Where.
        hit: Interaction,
        /// The local space of its BSDF.
        frame: Frame,
        /// How it scatters.
        bsdf: Bsdf<'s>,
        /// Back along the path, local.
        wo: Vec3,
        /// How a relief shadows itself: α² \[1\].
        shadowing: Option<f32>,
    },
    /// In a medium.
    Medium {
        /// Where [length].
        p: Vec3,
        /// Direction of travel before the collision.
        dir: Vec3,
        /// Which medium.
        medium: MediumId,
        /// How it scatters.
        phase: &'s Phase,
    },
}

/// A direction that scattering took.
#[derive(Debug, Clone, Copy)]
pub struct Scattered {
    /// The ray that leaves.
    pub ray: Ray,
    /// `f·|cos| / pdf`.
    pub weight: Lanes,
    /// Density [1/sr]; meaningless for a Dirac lobe.
    pub pdf: f32,
    /// Whether the lobe is a Dirac.
    pub specular: bool,
    /// Relative index crossed [1].
    pub eta: f32,
    /// Whether the path is now on the other side.
    pub crossed: bool,
}

impl<'s> Vertex<'s> {
    /// A vertex on a surface that a ray along `dir` has hit.
    ///
    /// Where the shading normal of a boundary turns away from a ray that the true surface faces, the true normal shades:
    /// the two must agree on the side that the path comes from, or it would change sides without changing media. What lets
    /// no light through has no such trouble, and the shading normal alone decides, as in pbrt and in Mitsuba.
    #[inline]
    pub fn surface(hit: Interaction, bsdf: Bsdf<'s>, dir: Vec3) -> Self {
        // A mirror is the same all round.
        let frame = if bsdf.is_specular() { Frame::around(hit.ns) } else { hit.shading_frame() };
        Self::framed(hit, bsdf, dir, frame)
    }

    #[inline]
    fn framed(hit: Interaction, bsdf: Bsdf<'s>, dir: Vec3, mut frame: Frame) -> Self {
        let mut wo = frame.to_local(-dir);
        if !may_leave(&bsdf, wo.z, -dir.dot(hit.ng)) {
            frame = Frame::around(hit.ng);
            wo = frame.to_local(-dir);
        }
        Self::Surface { hit, frame, bsdf, wo, shadowing: None }
    }

    /// The same on the relief of an embossed material, if there is one.
    #[inline]
    pub fn met(scene: &Scene, hit: Interaction, bsdf: Bsdf<'s>, dir: Vec3, relief: Option<MaterialId>) -> Self {
        match relief.and_then(|id| scene.relief(id)) {
            // Its slopes are along the parameters, whatever the BSDF.
            Some(relief) => Self::framed(hit, bsdf, dir, hit.shading_frame()).embossed(scene, dir, relief),
            None => Self::surface(hit, bsdf, dir),
        }
    }

    #[inline(never)]
    fn embossed(self, scene: &Scene, dir: Vec3, relief: &Relief) -> Self {
        let Self::Surface { hit, frame: even, bsdf, wo: even_wo, .. } = self else { return self };
        if even.n != hit.ns {
            return self; // the true normal shades
        }
        let Embossed { frame, shadowing } = relief.emboss(&scene.geometry, &hit, &even, -dir);
        let wo = frame.to_local(-dir);
        if (wo.z * even_wo.z > 0.0 || !relief.is_mirrored()) && may_leave(&bsdf, wo.z, -dir.dot(hit.ng)) {
            return Self::Surface { hit, frame, bsdf, wo, shadowing };
        }
        if shadowing.is_none() {
            return self;
        }
        Self::Surface { hit, frame: even, bsdf: Bsdf::diffuse(Lanes::ZERO), wo: even_wo, shadowing: None }
    }

    /// From where lights are looked at.
    #[inline]
    pub fn reference(&self) -> Reference {
        match self {
            Self::Surface { hit, frame, bsdf, wo, .. } => {
                let normal = (!bsdf.transmits()).then_some(if wo.z > 0.0 { frame.n } else { -frame.n });
                Reference { p: hit.p, normal }
            }
            Self::Medium { p, .. } => Reference { p: *p, normal: None },
        }
    }

    /// Whether light can go on as if nothing were there, beside other ways.
    #[inline]
    pub fn is_pane(&self) -> bool {
        matches!(self, Self::Surface { bsdf: Bsdf::ThinDielectric(_), .. })
    }

    /// Whether light can go on beyond.
    #[inline]
    pub fn transmits(&self) -> bool {
        match self {
            Self::Surface { bsdf, .. } => bsdf.transmits(),
            Self::Medium { .. } => true,
        }
    }

    /// Whether a light sample could contribute at all.
    #[inline]
    pub fn can_use_light_samples(&self) -> bool {
        match self {
            Self::Surface { bsdf, .. } => !bsdf.is_specular(),
            Self::Medium { .. } => true,
        }
    }

    /// Whether it is on a surface.
    #[inline]
    pub fn is_surface(&self) -> bool {
        matches!(self, Self::Surface { .. })
    }

    /// How many light samples are taken.
    #[inline]
    pub fn light_samples(&self) -> u32 {
        match self {
            Self::Surface { bsdf, .. } => bsdf.light_samples(),
            Self::Medium { .. } => 1,
        }
    }

    /// `f·|cos|` and the density [1/sr] of scattering towards `dir`.
    #[inline]
    pub fn eval(&self, dir: Vec3) -> (Lanes, f32) {
        match self {
            Self::Surface { hit, frame, bsdf, wo, shadowing } => {
                let wi = frame.to_local(dir);
                if !may_leave(bsdf, wi.z, dir.dot(hit.ng)) {
                    return (Lanes::ZERO, 0.0);
                }
                let (value, pdf) = bsdf.eval_and_pdf(*wo, wi);
                match shadowing {
                    None => (value, pdf),
                    Some(alpha2) => (value * through_relief(*alpha2, wi.z, dir.dot(hit.ns)), pdf),
                }
            }
            Self::Medium { dir: travel, phase, .. } => {
                let value = phase.eval(travel.dot(dir));
                (Lanes::splat(value), value)
            }
        }
    }

    /// Draws a direction.
    #[inline]
    pub fn sample(&self, [u_lobe, u, v]: [f32; 3]) -> Option<Scattered> {
        match self {
            Self::Surface { hit, frame, bsdf, wo, shadowing: Some(alpha2) } => {
                let mut scattered = sample_surface(hit, frame, bsdf, *wo, u_lobe, Vec2::new(u, v))?;
                let dir = scattered.ray.dir;
                scattered.weight *= through_relief(*alpha2, frame.n.dot(dir), dir.dot(hit.ns));
                Some(scattered)
            }
            Self::Surface { hit, frame, bsdf, wo, shadowing: None } => {
                let u = Vec2::new(u, v);
                sample_surface(hit, frame, bsdf, *wo, u_lobe, u).or_else(|| {
                    // Clear glass has no other direction to offer: where the shading normal sends it to the wrong side of
                    // the surface, the true normal shades, so that no light is lost.
                    let flat = Frame::around(hit.ng);
                    let wo = flat.to_local(frame.to_world(*wo));
                    let retry = bsdf.is_specular() && bsdf.transmits();
                    if retry { sample_surface(hit, &flat, bsdf, wo, u_lobe, u) } else { None }
                })
            }
            Self::Medium { p, dir, phase, .. } => {
                let cos_theta = phase.sample(u);
                let dir = deflect(*dir, cos_theta, v);
                let pdf = phase.eval(cos_theta);
                // A table may end at 0, and rounding ends there.
                (pdf > 0.0).then(|| Scattered {
                    ray: Ray::new(*p, dir),
                    weight: Lanes::ONE,
                    pdf,
                    specular: false,
                    eta: 1.0,
                    crossed: false,
                })
            }
        }
    }

    /// Whether a ray towards `dir` leaves on the other side of a boundary than that from which one along `travel` came.
    #[inline]
    pub fn crosses(&self, travel: Vec3, dir: Vec3) -> bool {
        match self {
            Self::Surface { hit, bsdf, .. } => dir.dot(hit.ng) * travel.dot(hit.ng) > 0.0 && bsdf.transmits(),
            Self::Medium { .. } => false,
        }
    }

    /// The event that going on from here is: on the other side of a surface or on this one, by a Dirac lobe or not.
    #[inline]
    pub fn turn(&self, crossed: bool, specular: bool) -> Turn {
        match self {
            Self::Surface { hit, bsdf, .. } => {
                let kind = match specular {
                    true => Kind::Specular,
                    false if bsdf.is_diffuse() => Kind::Diffuse,
                    false => Kind::Glossy,
                };
                Turn::Surface { object: hit.object, crossed, kind }
            }
            Self::Medium { medium, .. } => Turn::Medium(*medium),
        }
    }

    /// The origin of a shadow ray towards `dir`.
    #[inline]
    pub fn shadow_origin(&self, dir: Vec3) -> Vec3 {
        match self {
            Self::Surface { hit, .. } => hit.spawn(dir).origin,
            Self::Medium { p, .. } => *p,
        }
    }
}

/// Draws a direction in the local space `frame`; `None` also where a boundary must not send it.
#[inline]
fn sample_surface(hit: &Interaction, frame: &Frame, bsdf: &Bsdf, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<Scattered> {
    let sample = bsdf.sample(wo, u_lobe, u)?;
    let dir = frame.to_world(sample.wi).normalize();
    may_leave(bsdf, sample.wi.z, dir.dot(hit.ng)).then(|| Scattered {
        ray: hit.spawn(dir),
        weight: sample.weight,
        pdf: sample.pdf,
        specular: sample.specular,
        eta: sample.eta,
        crossed: sample.wi.z * wo.z < 0.0,
    })
}

/// The share of the light along a direction that a relief lets through, by its cosines with the normal of the relief and
/// with the even one: nothing on different sides of them.
fn through_relief(alpha2: f32, cos_relief: f32, cos_even: f32) -> f32 {
    if cos_relief * cos_even > 0.0 { unshadowed(alpha2, cos_even) } else { 0.0 }
}

/// Whether light can come or go where the shading normal and the geometric normal see it at these cosines: on one side
/// for both, or it would leak through a boundary.
#[inline]
fn may_leave(bsdf: &Bsdf, cos_shading: f32, cos_geometric: f32) -> bool {
    cos_shading * cos_geometric > 0.0 || !bsdf.transmits()
}
