//! The spherical camera: all directions around a point, with +y up.
//!
//! | mapping | direction of `(s, t)` | solid angle of a unit of area |
//! |---|---|---|
//! | equirectangular | `(sin θ cos φ, cos θ, sin θ sin φ)`, `θ = πt`, `φ = 2πs` | `2π² sin θ` |
//! | equal area | the octahedral map (Clarberg 2008), its z turned up | `4π` |
//!
//! Both are those of pbrt-v4. Filters reach over the edges of the image to where the sphere goes on.

use std::f32::consts::{PI, TAU};

use super::CameraRay;
use crate::{
    light::environment::equal_area_sphere,
    math::{Ray, Vec2, Vec3},
};

/// A spherical camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spherical {
    /// How directions lie on the image.
    pub mapping: SphericalMapping,
}

/// How directions lie on a spherical image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SphericalMapping {
    /// Latitude and longitude.
    Equirectangular,
    /// Equal areas see equal solid angles.
    EqualArea,
}

impl Spherical {
    /// The ray of a place, in camera space.
    #[inline]
    pub fn ray(&self, place: Vec2) -> CameraRay {
        let dir = match self.mapping {
            SphericalMapping::Equirectangular => {
                let (sin_theta, cos_theta) = (PI * place.y).sin_cos();
                let (sin_phi, cos_phi) = (TAU * place.x).sin_cos();
                Vec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi)
            }
            SphericalMapping::EqualArea => {
                let d = equal_area_sphere(wrapped(place));
                Vec3::new(d.x, d.z, d.y)
            }
        };
        CameraRay { ray: Ray::new(Vec3::ZERO, dir), weight: 1.0 }
    }
}

/// A place beyond an edge of the octahedral square is a place within it: the edge is folded on itself.
fn wrapped(place: Vec2) -> Vec2 {
    let mut p = place;
    if p.x < 0.0 || p.x > 1.0 {
        p = Vec2::new(if p.x < 0.0 { -p.x } else { 2.0 - p.x }, 1.0 - p.y);
    }
    if p.y < 0.0 || p.y > 1.0 {
        p = Vec2::new(1.0 - p.x, if p.y < 0.0 { -p.y } else { 2.0 - p.y });
    }
    // A filter wider than the image comes round more than once: then any place of the edge will do.
    p.clamp(Vec2::ZERO, Vec2::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step over an edge of the image is a small step on the sphere: both maps turn by at most 2π for the length of it.
    #[test]
    fn the_sphere_goes_on_beyond_the_edges_of_its_images() {
        let step = 1e-3;
        for mapping in [SphericalMapping::Equirectangular, SphericalMapping::EqualArea] {
            let dir = |x: f32, y: f32| Spherical { mapping }.ray(Vec2::new(x, y)).ray.dir;
            for t in [0.1, 0.3, 0.62, 0.97] {
                let edges = [(-step, t, step, t), (1.0 + step, t, 1.0 - step, t), (t, -step, t, step)];
                for (x0, y0, x1, y1) in edges {
                    let apart = (dir(x0, y0) - dir(x1, y1)).length();
                    assert!(apart < 1.01 * 2.0 * step * TAU, "{mapping:?} at ({x0}, {y0}): {apart}");
                }
            }
        }
    }
}
