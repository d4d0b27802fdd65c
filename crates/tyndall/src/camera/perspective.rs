//! The perspective camera: a pinhole, or a thin lens with its plane of focus.
//!
//! The pinhole sends the place `(s, t)` of the image along `(x, y, 1)`, where x and y run over its window in the plane
//! z = 1. A thin lens of radius `R` [length], focused at distance `f` [length], sends it from a uniform point of the lens
//! through `f·(x, y, 1)`; a point at distance `d` then blurs to a disk that measures `R·|d − f|/f` in its own plane.
//! The weight is 1: no fall-off towards the corners, as in pbrt-v4 and Mitsuba 3.
//!
//! Source: Potmesil and Chakravarty 1981; Cook et al. 1984.

use super::CameraRay;
use crate::{
    math::{Ray, Vec2, Vec3},
    sampling::warp,
};

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perspective {
    /// What the image sees of the plane z = 1: left, right, bottom, top [1].
    pub window: [f32; 4],
    /// The lens; a pinhole without one.
    pub lens: Option<ThinLens>,
}

/// A thin lens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinLens {
    /// Radius of its aperture [length].
    pub radius: f32,
    /// Distance of the plane in focus [length].
    pub focus: f32,
}

impl Perspective {
    /// A pinhole that sees this window of the plane z = 1: left, right, bottom, top [1].
    pub fn pinhole(window: [f32; 4]) -> Self {
        Self { window, lens: None }
    }

    /// The ray of a place, in camera space.
    #[inline]
    pub fn ray(&self, place: Vec2, lens: Vec2) -> CameraRay {
        let [left, right, bottom, top] = self.window;
        let dir = Vec3::new(left + (right - left) * place.x, top + (bottom - top) * place.y, 1.0);
        let ray = match self.lens {
            None => Ray::new(Vec3::ZERO, dir),
            Some(ThinLens { radius, focus }) => {
                let origin = (warp::concentric_disk(lens) * radius).extend(0.0);
                // Scaled by 1/f, so that a far focus does not round the lens away.
                Ray::new(origin, dir - origin / focus)
            }
        };
        CameraRay { ray, weight: 1.0 }
    }
}
