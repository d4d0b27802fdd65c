//! Parallel rays from outside of the scene: its light in one direction, averaged over what they see (Mitsuba 3's
//! `distant`).
//!
//! Rays go along +z of the camera's space, through a point, through points of a surface that are uniform in its area, or
//! through the disk that the sphere around the scene shows them, uniform in its area. They start twice the radius of that
//! sphere before that, or, through the disk, once.

use super::{CameraRay, Surface};
use crate::{
    math::{Frame, Ray, Vec2, Vec3},
    sampling::warp,
};

/// A camera infinitely far away.
#[derive(Debug, Clone, PartialEq)]
pub struct Distant {
    /// Centre of the sphere around the scene [length].
    pub centre: Vec3,
    /// Its radius [length].
    pub radius: f32,
    /// Where the rays go.
    pub target: Target,
}

/// Where parallel rays go.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// To the disk that the sphere around the scene shows.
    Disk,
    /// Through one point [length].
    Point(Vec3),
    /// Through a surface, from either side.
    Surface(Surface),
}

impl Distant {
    /// A ray along `dir`, in the world, for two uniform numbers.
    #[inline]
    pub fn ray(&self, dir: Vec3, u: Vec2) -> CameraRay {
        let (through, before, weight) = match &self.target {
            Target::Point(p) => (*p, 2.0, 1.0),
            Target::Surface(surface) => {
                let (point, weight) = surface.sample(u);
                (point.p, 2.0, weight)
            }
            Target::Disk => {
                let aside = Frame::around(dir).to_world(warp::concentric_disk(u).extend(0.0));
                (self.centre + aside * self.radius, 1.0, 1.0)
            }
        };
        CameraRay { ray: Ray::new(through - dir * (before * self.radius), dir), weight }
    }
}
