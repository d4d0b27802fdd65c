//! Several views side by side in one image, each as wide as the others (Mitsuba 3's `batch`).

use super::{CameraRay, View};
use crate::math::{Ray, Vec2, Vec3};

/// Views from left to right.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// At least one, and none of them a batch.
    pub views: Vec<View>,
}

impl Batch {
    /// The ray of a place, in the world. A filter that reaches over the border of a view sees the next one's part.
    #[inline]
    pub fn ray(&self, place: Vec2, lens: Vec2) -> CameraRay {
        let across = place.x * self.views.len() as f32;
        let index = (across.max(0.0) as usize).min(self.views.len().saturating_sub(1));
        match self.views.get(index) {
            Some(view) => view.ray(Vec2::new(across - index as f32, place.y), lens),
            None => CameraRay { ray: Ray::new(Vec3::ZERO, Vec3::Z), weight: 0.0 },
        }
    }
}
