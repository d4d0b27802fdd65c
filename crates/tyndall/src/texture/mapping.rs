//! From a point of a surface to the place on a pattern.
//!
//! | mapping | (s, t) of a point p = (x, y, z) in texture space |
//! |---|---|
//! | UV | (s_u u + d_u, s_v v + d_v), by any affine map of the parameters |
//! | spherical | (θ/π, φ/2π), θ from +z, φ in [0, 2π) from +x |
//! | cylindrical | ((π + atan2(y, x))/2π, z) |
//! | planar | (p·v_s + d_s, p·v_t + d_t) |
//!
//! Source: Pharr, Jakob and Humphreys 2023, § 10.2.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Affine2;

use super::TexturePoint;
use crate::math::{Transform, Vec2, Vec3};

/// To a pattern in a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mapping2 {
    /// By the parameters of the surface.
    Uv(Affine2),
    /// By direction from the origin of texture space.
    Spherical {
        /// World to texture space.
        from_world: Transform,
    },
    /// By the angle about the z axis of texture space, and z.
    Cylindrical {
        /// World to texture space.
        from_world: Transform,
    },
    /// By projection onto a plane of texture space.
    Planar {
        /// World to texture space.
        from_world: Transform,
        /// v_s and v_t [1/length].
        axes: [Vec3; 2],
        /// d_s and d_t [1].
        offset: Vec2,
    },
}

impl Mapping2 {
    /// The parameters as they are.
    pub const UV: Self = Self::Uv(Affine2::IDENTITY);

    /// The place on the pattern.
    #[inline]
    pub fn at(&self, at: &TexturePoint) -> Vec2 {
        match self {
            Self::Uv(map) => map.transform_point2(at.uv.get()),
            Self::Spherical { from_world } => {
                let p = from_world.point(at.p);
                let theta = p.z.atan2(p.truncate().length());
                // θ from +z is a quarter turn less the elevation.
                Vec2::new(0.5 - theta * FRAC_1_PI, turns(p))
            }
            Self::Cylindrical { from_world } => {
                let p = from_world.point(at.p);
                Vec2::new(0.5 + p.y.atan2(p.x) * (0.5 * FRAC_1_PI), p.z)
            }
            Self::Planar { from_world, axes: [s, t], offset } => {
                let p = from_world.point(at.p);
                Vec2::new(p.dot(*s), p.dot(*t)) + *offset
            }
        }
    }
}

/// φ/2π in [0, 1).
fn turns(p: Vec3) -> f32 {
    let phi = p.y.atan2(p.x);
    (if phi < 0.0 { phi + 2.0 * PI } else { phi }) * (0.5 * FRAC_1_PI)
}

/// To a pattern in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping3 {
    /// World to texture space.
    pub from_world: Transform,
}

impl Mapping3 {
    /// The place in the pattern.
    #[inline]
    pub fn at(&self, p: Vec3) -> Vec3 {
        self.from_world.point(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(p: Vec3) -> TexturePoint {
        TexturePoint { p, uv: Vec2::new(0.25, 0.5).into(), n: Vec3::Z, part: None }
    }

    #[test]
    fn every_mapping_puts_the_axes_where_its_formula_says() {
        let from_world = Transform::IDENTITY;
        let near = |a: Vec2, b: [f32; 2]| assert!((a - Vec2::from_array(b)).length() < 1e-6, "{a} {b:?}");
        let spherical = Mapping2::Spherical { from_world };
        near(spherical.at(&at(Vec3::Z)), [0.0, 0.0]);
        near(spherical.at(&at(Vec3::X * 3.0)), [0.5, 0.0]);
        near(spherical.at(&at(-Vec3::Y)), [0.5, 0.75]);
        near(Mapping2::Cylindrical { from_world }.at(&at(Vec3::new(0.0, 2.0, 5.0))), [0.75, 5.0]);
        let planar = Mapping2::Planar { from_world, axes: [Vec3::X, Vec3::Y * 2.0], offset: Vec2::new(0.5, 0.0) };
        near(planar.at(&at(Vec3::new(1.0, 2.0, 9.0))), [1.5, 4.0]);
        let uv = Affine2::from_scale_angle_translation(Vec2::new(2.0, 4.0), 0.0, Vec2::new(0.5, 1.0));
        near(Mapping2::Uv(uv).at(&at(Vec3::ZERO)), [1.0, 3.0]);
    }
}
