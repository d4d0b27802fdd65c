//! The irradiance meter: the light that falls on a surface, averaged over its area (Mitsuba 3's `irradiancemeter`).
//!
//! `E = 1/A ∫∫ L cos θ dω dA` [W·m⁻²]: points are uniform in area, directions follow the cosine, the weight is π.

use std::f32::consts::PI;

use super::{CameraRay, Surface};
use crate::{
    math::{Frame, Ray, Vec2},
    sampling::warp,
    shape::offset_point,
};

/// A surface that measures on the side of its normal.
#[derive(Debug, Clone, PartialEq)]
pub struct IrradianceMeter {
    /// It.
    pub surface: Surface,
}

impl IrradianceMeter {
    /// A ray from the point of the surface at `place`, in the direction of `turn`, in the world.
    #[inline]
    pub fn ray(&self, place: Vec2, turn: Vec2) -> CameraRay {
        let (point, weight) = self.surface.sample(place);
        let dir = Frame::around(point.ng).to_world(warp::cosine_hemisphere(turn)).normalize();
        let origin = offset_point(point.p, point.error, point.ng, dir);
        CameraRay { ray: Ray::new(origin, dir), weight: PI * weight }
    }
}
