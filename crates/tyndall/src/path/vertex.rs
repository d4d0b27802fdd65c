//! A place where a path scatters: on a surface or in a medium, with one interface for both.

use crate::{
    bsdf::Bsdf,
    light::Reference,
    math::{Frame, Ray, Vec2, Vec3},
    phase::{Phase, deflect},
    shape::Interaction,
    spectrum::Lanes,
};

/// A scattering vertex.
#[derive(Debug, Clone, Copy)]
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
    },
    /// In a medium.
    Medium {
        /// Where [length].
        p: Vec3,
        /// Direction of travel before the collision.
        dir: Vec3,
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
    /// Where the shading normal turns away from a ray that the true surface faces, the true normal shades: the two must
    /// agree on the side that the path comes from, or it would change sides without changing media.
    #[inline]
    pub fn surface(hit: Interaction, bsdf: Bsdf<'s>, dir: Vec3) -> Self {
        let frame = hit.shading_frame();
        let wo = frame.to_local(-dir);
        if same_side(wo.z, -dir.dot(hit.ng)) {
            return Self::Surface { hit, frame, bsdf, wo };
        }
        let frame = Frame::around(hit.ng);
        Self::Surface { hit, frame, bsdf, wo: frame.to_local(-dir) }
    }

    /// From where lights are looked at.
    #[inline]
    pub fn reference(&self) -> Reference {
        match self {
            Self::Surface { hit, frame, bsdf, wo } => {
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

    /// Whether a light sample could contribute at all.
    #[inline]
    pub fn can_use_light_samples(&self) -> bool {
        match self {
            Self::Surface { bsdf, .. } => !bsdf.is_specular(),
            Self::Medium { .. } => true,
        }
    }

    /// `f·|cos|` and the density [1/sr] of scattering towards `dir`.
    #[inline]
    pub fn eval(&self, dir: Vec3) -> (Lanes, f32) {
        match self {
            Self::Surface { hit, frame, bsdf, wo } => {
                let wi = frame.to_local(dir);
                if !same_side(wi.z, dir.dot(hit.ng)) {
                    return (Lanes::ZERO, 0.0);
                }
                (bsdf.eval(*wo, wi), bsdf.pdf(*wo, wi))
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
            Self::Surface { hit, frame, bsdf, wo } => {
                let u = Vec2::new(u, v);
                sample_surface(hit, frame, bsdf, *wo, u_lobe, u).or_else(|| {
                    // A mirror has no other direction to offer: where the shading normal sends it through the surface,
                    // the true normal shades, so that no light is lost.
                    let flat = Frame::around(hit.ng);
                    let wo = flat.to_local(frame.to_world(*wo));
                    if bsdf.is_specular() { sample_surface(hit, &flat, bsdf, wo, u_lobe, u) } else { None }
                })
            }
            Self::Medium { p, dir, phase } => {
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

    /// The origin of a shadow ray towards `dir`.
    #[inline]
    pub fn shadow_origin(&self, dir: Vec3) -> Vec3 {
        match self {
            Self::Surface { hit, .. } => hit.spawn(dir).origin,
            Self::Medium { p, .. } => *p,
        }
    }
}

/// Draws a direction in the local space `frame`; `None` also where it would be on different sides of the shading and of
/// the geometric normal.
#[inline]
fn sample_surface(hit: &Interaction, frame: &Frame, bsdf: &Bsdf, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<Scattered> {
    let sample = bsdf.sample(wo, u_lobe, u)?;
    let dir = frame.to_world(sample.wi).normalize();
    same_side(sample.wi.z, dir.dot(hit.ng)).then(|| Scattered {
        ray: hit.spawn(dir),
        weight: sample.weight,
        pdf: sample.pdf,
        specular: sample.specular,
        eta: sample.eta,
        crossed: sample.wi.z * wo.z < 0.0,
    })
}

/// Whether a direction is on the same side of the shading and of the geometric normal: else it would leak.
#[inline]
fn same_side(local_z: f32, cos_geometric: f32) -> bool {
    local_z * cos_geometric > 0.0
}
