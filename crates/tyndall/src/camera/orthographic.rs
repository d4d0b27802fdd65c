//! The orthographic camera: parallel rays along +z, from a window of the plane z = 0.

use super::CameraRay;
use crate::math::{Ray, Vec2, Vec3};

/// An orthographic camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthographic {
    /// What the image sees: left, right, bottom, top [length].
    pub window: [f32; 4],
}

impl Orthographic {
    /// The ray of a place, in camera space.
    #[inline]
    pub fn ray(&self, place: Vec2) -> CameraRay {
        let [left, right, bottom, top] = self.window;
        let origin = Vec3::new(left + (right - left) * place.x, top + (bottom - top) * place.y, 0.0);
        CameraRay { ray: Ray::new(origin, Vec3::Z), weight: 1.0 }
    }
}
