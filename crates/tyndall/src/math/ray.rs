//! A ray: where light is looked for.

use glam::Vec3;

/// A half-line `origin + t·dir`, `t ≥ 0`.
///
/// How far it reaches is not part of it: the integrator first samples a free flight and then asks the scene for a hit
/// before that distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Start [length].
    pub origin: Vec3,
    /// Direction of travel, a unit vector (inside an instance it may be scaled; `t` keeps its meaning).
    pub dir: Vec3,
}

impl Ray {
    /// A ray from `origin` along `dir`.
    pub fn new(origin: Vec3, dir: Vec3) -> Self {
        Self { origin, dir }
    }

    /// The point `origin + t·dir`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.dir * t
    }
}
