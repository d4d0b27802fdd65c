//! Placing a shape or a group of shapes in the world by an affine map.
//!
//! Rays go to local space by the inverse in double precision and are rounded once, so a translation by many times the
//! size of the group loses nothing but what the world's coordinates have lost already.

use glam::{Affine3, DAffine3, DMat3, DVec3};

use super::interaction::Point;
use crate::math::{Bounds, Ray, Transform, Vec3};

/// An affine map from local to world space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    to_world: Affine3,
    to_local: DAffine3,
}

/// A group in the world.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instance {
    pub(super) group: u32,
    pub(super) placement: Placement,
}

impl Placement {
    pub(super) fn new(transform: &Transform) -> Self {
        let to_world = Affine3::from_mat4(transform.matrix);
        Self { to_world, to_local: as_double(&to_world).inverse() }
    }

    /// Local to world.
    pub(super) fn map(&self) -> DAffine3 {
        as_double(&self.to_world)
    }

    /// The ray in local space; `t` keeps its meaning.
    #[inline(always)]
    pub(super) fn ray_to_local(&self, ray: &Ray) -> Ray {
        Ray::new(
            self.local_point(ray.origin.as_dvec3()).as_vec3(),
            self.to_local.transform_vector3(ray.dir.as_dvec3()).as_vec3(),
        )
    }

    /// A world point in local space.
    #[inline(always)]
    pub(super) fn local_point(&self, p: DVec3) -> DVec3 {
        self.to_local.transform_point3(p)
    }

    /// A lower bound on the factor by which the map stretches lengths: `1/‖M⁻¹‖`, where the square of the norm is at
    /// most the largest row sum of `M⁻ᵀM⁻¹`; equal to it for rotations, uniform scales and scales along axes.
    pub(super) fn least_stretch(&self) -> f64 {
        least_stretch(self.to_local.matrix3)
    }

    /// The factor of a similarity (rotation, mirroring, uniform scale), exact to rounding.
    pub(super) fn uniform_scale(&self) -> Option<f64> {
        let m = self.map().matrix3;
        let gram = m.transpose() * m;
        let square = gram.x_axis.x;
        let off = gram - DMat3::from_diagonal(DVec3::splat(square));
        let deviation = [off.x_axis, off.y_axis, off.z_axis].map(|c| c.abs().max_element());
        let tolerance = 4.0 * f64::from(f32::EPSILON) * square; // the matrix itself is rounded to single precision
        deviation.iter().all(|&d| d <= tolerance).then(|| square.sqrt())
    }

    /// The box around a mapped box, rounded outward.
    pub(super) fn bounds(&self, b: &Bounds) -> Bounds {
        let map = self.map();
        let corners = b.corners().map(|c| map.transform_point3(c.as_dvec3()));
        let min = corners.iter().fold(DVec3::INFINITY, |a, &c| a.min(c));
        let max = corners.iter().fold(DVec3::NEG_INFINITY, |a, &c| a.max(c));
        outward(min, max)
    }

    /// Maps a surface point.
    pub(super) fn place(&self, point: &Point) -> Point {
        let map = self.map();
        let normal = |n: DVec3| self.to_local.matrix3.transpose() * n;
        // A ray that leaves this point is rounded in local space: by u in each coordinate of its origin.
        let rounding = f64::from(f32::EPSILON) * point.p.abs().max_element();
        let m = map.matrix3;
        let stretch = (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt();
        Point {
            p: map.transform_point3(point.p),
            error: (point.error + rounding) * stretch,
            ng: normal(point.ng),
            ns: normal(point.ns),
            uv: point.uv,
            dpdu: map.transform_vector3(point.dpdu),
        }
    }
}

/// The same for a map whose inverse this is.
pub(super) fn least_stretch(inverse: DMat3) -> f64 {
    let gram = inverse.transpose() * inverse;
    let rows = [gram.x_axis, gram.y_axis, gram.z_axis].map(|r| r.abs().element_sum());
    (1.0 - 1e-12) / rows[0].max(rows[1]).max(rows[2]).sqrt()
}

fn as_double(map: &Affine3) -> DAffine3 {
    DAffine3 { matrix3: map.matrix3.as_dmat3(), translation: map.translation.as_dvec3() }
}

/// A box in single precision around a box in double precision.
pub(super) fn outward(min: DVec3, max: DVec3) -> Bounds {
    let down = |v: DVec3| v.as_vec3().to_array().map(f32::next_down);
    let up = |v: DVec3| v.as_vec3().to_array().map(f32::next_up);
    Bounds { min: Vec3::from_array(down(min)), max: Vec3::from_array(up(max)) }
}
