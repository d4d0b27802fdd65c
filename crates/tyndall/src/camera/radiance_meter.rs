//! The radiance meter: one ray along +z from the origin of its own space (Mitsuba 3's `radiancemeter`).

use super::CameraRay;
use crate::math::{Ray, Vec3};

/// A radiance meter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RadianceMeter;

impl RadianceMeter {
    /// Its ray, in its own space.
    #[inline]
    pub fn ray(&self) -> CameraRay {
        CameraRay { ray: Ray::new(Vec3::ZERO, Vec3::Z), weight: 1.0 }
    }
}
