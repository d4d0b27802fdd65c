//! The perspective camera: a pinhole that looks along +z of its own space, with +x to the right of the image and +y up.

use crate::{
    film::Filter,
    math::{Ray, Transform, Vec3},
    medium::MediumId,
};

/// A pinhole camera and the raster behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Camera space to world.
    pub to_world: Transform,
    /// What the image sees of the plane z = 1: left, right, bottom, top [1].
    pub window: [f32; 4],
    /// Image width [pixels].
    pub width: u32,
    /// Image height [pixels].
    pub height: u32,
    /// Reconstruction filter.
    pub filter: Filter,
    /// A factor on every value of the film [1].
    pub exposure: f32,
    /// The medium around the camera, when the scene says so.
    pub medium: Option<MediumId>,
}

impl Camera {
    /// A ray through pixel `(x, y)` (row 0 on top) for four uniform numbers, two for the place in the filter, two for
    /// a lens that a pinhole does not have; and what the sample weighs [1].
    #[inline]
    pub fn sample_ray(&self, pixel: (u32, u32), u: [f32; 4]) -> (Ray, f32) {
        let ([dx, dy], weight) = self.filter.sample([u[0], u[1]]);
        (self.ray_through(pixel.0 as f32 + 0.5 + dx, pixel.1 as f32 + 0.5 + dy), weight)
    }

    /// The ray through a place on the raster [pixels from the upper left corner].
    #[inline]
    pub fn ray_through(&self, x: f32, y: f32) -> Ray {
        let [left, right, bottom, top] = self.window;
        let across = x / self.width as f32;
        let down = y / self.height as f32;
        let dir = Vec3::new(left + (right - left) * across, top + (bottom - top) * down, 1.0);
        Ray::new(self.to_world.point(Vec3::ZERO), self.to_world.vector(dir).normalize())
    }
}
