//! The irradiance meter: the light that falls on a surface, averaged over its area (Mitsuba 3's `irradiancemeter`).
//!
//! `E = 1/A ∫∫ L cos θ dω dA` [W·m⁻²]: points are uniform in area, directions follow the cosine, the weight is π.

use std::f32::consts::PI;

use super::CameraRay;
use crate::{
    light::EmitterShape,
    math::{Frame, Ray, Vec2},
    sampling::{discrete::Discrete, warp},
    shape::offset_point,
};

/// A surface that measures, in world space. It measures on the side of its normal.
#[derive(Debug, Clone, PartialEq)]
pub struct IrradianceMeter {
    pieces: Vec<EmitterShape>,
    by_area: Discrete,
}

impl IrradianceMeter {
    /// `None` for a surface without area.
    pub fn new(pieces: Vec<EmitterShape>) -> Option<Self> {
        let by_area = Discrete::from_f64(pieces.iter().map(|piece| f64::from(piece.area())))?;
        Some(Self { pieces, by_area })
    }

    /// A ray from the point of the surface at `place`, in the direction of `turn`, in the world.
    #[inline]
    pub fn ray(&self, place: Vec2, turn: Vec2) -> CameraRay {
        let (piece, _, rest) = self.by_area.sample(place.x.clamp(0.0, 1.0));
        let piece = &self.pieces[piece];
        let point = piece.sample_area(Vec2::new(rest, place.y.clamp(0.0, 1.0)));
        let dir = Frame::around(point.ng).to_world(warp::cosine_hemisphere(turn)).normalize();
        let origin = offset_point(point.p, point.error, point.ng, dir);
        // Points of an oblique cylinder are not uniform in area.
        let weight = PI / (piece.area() * piece.pdf_area(point.p));
        CameraRay { ray: Ray::new(origin, dir), weight }
    }
}
