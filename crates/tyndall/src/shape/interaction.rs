//! A point on a surface, and rays that leave it.
//!
//! The point is known up to `error`, so the surface lies inside the box `p ± error`. A ray starts outside that box: the
//! origin is moved along the normal by the box's half-width in that direction, and rounded away from the surface
//! (Pharr et al. 2023, § 6.8.6). There is no fixed epsilon.

use glam::DVec3;

use super::{ObjectId, Uv};
use crate::math::{Frame, Ray, Vec3, rounding::gamma};

/// A point on a surface in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interaction {
    /// The point [length].
    pub p: Vec3,
    /// Bound on the absolute error of `p` [length].
    pub error: Vec3,
    /// Geometric normal: unit, outward by the shape's orientation.
    pub ng: Vec3,
    /// Shading normal: unit, on the side of `ng`.
    pub ns: Vec3,
    /// Surface parameters.
    pub uv: Uv,
    /// Derivative of the point by `u` [length].
    pub dpdu: Vec3,
    /// The object that was hit.
    pub object: ObjectId,
    /// The part of the object: triangle index, or 0.
    pub prim: u32,
    /// The placed copy of it, or [`super::Hit::NO_INSTANCE`].
    pub instance: u32,
}

impl Interaction {
    /// The shading frame: `n` is the shading normal, `s` is along `dpdu` where that is possible.
    pub fn shading_frame(&self) -> Frame {
        let along = self.dpdu - self.ns * self.ns.dot(self.dpdu);
        match along.try_normalize() {
            Some(s) if s.dot(self.ns).abs() < 1e-3 => Frame { s, t: self.ns.cross(s), n: self.ns },
            _ => Frame::around(self.ns),
        }
    }

    /// The ray along `dir` that leaves to the side of the surface to which `dir` points.
    #[inline]
    pub fn spawn(&self, dir: Vec3) -> Ray {
        Ray::new(offset_point(self.p, self.error, self.ng, dir), dir)
    }

    /// The distance at which a ray along the unit vector `dir` that meets the surface at distance `t` has left its error behind,
    /// unless it grazes [length].
    #[inline]
    pub fn end_of_error(&self, t: f32, dir: Vec3) -> f32 {
        const GRAZING: f32 = 1e-3;
        t * (1.0 + gamma(4)) + self.ng.abs().dot(self.error) / self.ng.dot(dir).abs().max(GRAZING)
    }

    /// The ray to another point on a surface, and the distance up to which it must be free: both ends are moved off
    /// their surfaces. The far end allows for the rounding of direction and distance too.
    ///
    /// `None` when the points cannot be told apart.
    pub fn spawn_to(&self, other: &Self) -> Option<(Ray, f32)> {
        let between = other.p - self.p;
        let origin = offset_point(self.p, self.error, self.ng, between);
        let target = offset_point(other.p, other.error + along_ray_error(between), other.ng, -between);
        segment(origin, target)
    }

    /// The ray to a point that is on no surface, and its distance.
    ///
    /// `None` when the points cannot be told apart.
    pub fn spawn_to_point(&self, target: Vec3) -> Option<(Ray, f32)> {
        segment(offset_point(self.p, self.error, self.ng, target - self.p), target)
    }
}

/// Bound on the error of `origin + dir·t` at the end of a segment: its difference, length, division, and product are
/// each rounded.
fn along_ray_error(between: Vec3) -> Vec3 {
    Vec3::splat(gamma(6) * between.length())
}

fn segment(origin: Vec3, target: Vec3) -> Option<(Ray, f32)> {
    let between = (target - origin).as_dvec3();
    let distance = between.length();
    let dir = (between / distance).as_vec3();
    (distance > 0.0 && dir.is_finite()).then(|| (Ray::new(origin, dir), distance as f32))
}

/// `p`, known up to `error` on a surface of normal `ng` [length], moved off the surface to the side of `dir`.
#[inline]
pub fn offset_point(p: Vec3, error: Vec3, ng: Vec3, dir: Vec3) -> Vec3 {
    let ng = if dir.dot(ng) < 0.0 { -ng } else { ng };
    let by = ng * ng.abs().dot(error);
    let moved = p + by;
    // The sum is rounded: away from the surface, by one to two units in the last place.
    let away = |moved: f32, by: f32| if by == 0.0 { moved } else { moved + (moved * f32::EPSILON).abs().copysign(by) };
    Vec3::new(away(moved.x, by.x), away(moved.y, by.y), away(moved.z, by.z))
}

/// A surface point in double precision, before it is placed in the world and rounded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) p: DVec3,
    /// Bound on the distance to the true surface [length].
    pub(super) error: f64,
    /// Normals, not necessarily unit.
    pub(super) ng: DVec3,
    pub(super) ns: DVec3,
    pub(super) uv: Uv,
    pub(super) dpdu: DVec3,
}

impl Point {
    /// Rounds to single precision: the only rounding that matters.
    pub(super) fn round(&self, object: ObjectId, prim: u32, instance: u32) -> Interaction {
        let p = self.p.as_vec3();
        let ng = if is_unit(self.ng) { self.ng } else { self.ng.normalize_or_zero() }.as_vec3();
        let ns = if self.ns == self.ng { ng } else { self.ns.try_normalize().map_or(ng, DVec3::as_vec3) };
        let ns = if ns.dot(ng) < 0.0 { -ns } else { ns };
        let error = p.abs() * gamma(1) + Vec3::splat((self.error as f32).next_up());
        Interaction { p, error, ng, ns, uv: self.uv, dpdu: self.dpdu.as_vec3(), object, prim, instance }
    }
}

/// Whether a vector has length 1 already, as far as single precision can tell.
#[inline]
fn is_unit(v: DVec3) -> bool {
    (v.length_squared() - 1.0).abs() < 1e-9
}
