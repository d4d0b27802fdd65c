//! Ray against triangle: which triangle is decided without error (see [`super`]), where is decided in double
//! precision.
//!
//! The exact triangle and its displaced twin of the edge test agree about the distance except when the ray grazes the
//! plane. So the distance is that to the exact plane, good to the last bit of single precision, which tells a ray that
//! leaves the surface from one that comes back to it; and for grazing rays it is the mean of the vertices' depths,
//! which lies in front of the ray whenever the triangle does.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::{DVec3, Vec3Swizzles};

use super::Packet;
use crate::math::{Ray, Vec2, Vec3};

/// A ray made ready for triangles: the axis nearest to its direction and the shear onto it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shear {
    /// Which axes are x, y and z of the sheared space, z the one along the ray: the coordinates of all else here.
    axes: [usize; 3],
    origin: Vec3,
    dir: Vec3,
    /// `dir_x/dir_z`, `dir_y/dir_z`, `1/dir_z`.
    by: Vec3,
}

/// Where a ray meets a triangle: `t`, and the weights of the second and third vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct TriangleHit {
    pub(super) t: f64,
    pub(super) uv: Vec2,
}

impl Shear {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let a = ray.dir.abs();
        let (axes, origin, dir) = if a.x > a.y && a.x > a.z {
            ([1, 2, 0], ray.origin.yzx(), ray.dir.yzx())
        } else if a.y > a.z {
            ([2, 0, 1], ray.origin.zxy(), ray.dir.zxy())
        } else {
            ([0, 1, 2], ray.origin, ray.dir)
        };
        Self { axes, origin, dir, by: Vec3::new(dir.x / dir.z, dir.y / dir.z, 1.0 / dir.z) }
    }

    /// The lanes whose triangle the ray's line meets in front of the origin and before `t_max`: all of the truth, and
    /// those that [`Self::resolve`] will refuse.
    #[inline(always)]
    pub(super) fn candidates<S: Simd>(&self, simd: S, packet: &Packet, t_max: f32) -> u32 {
        let (ax, ay, az) = self.sheared_lanes(simd, &packet.vertex[0]);
        let (bx, by, bz) = self.sheared_lanes(simd, &packet.vertex[1]);
        let (cx, cy, cz) = self.sheared_lanes(simd, &packet.vertex[2]);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let zero = f32x8::splat(simd, 0.0);
        let same_sign = u.min(v).min(w).simd_ge(zero) | u.max(v).max(w).simd_le(zero);
        let in_range = az.max(bz).max(cz).simd_gt(zero) & az.min(bz).min(cz).simd_lt(f32x8::splat(simd, t_max));
        (same_sign & in_range).to_bitmask() as u32 & packet.filled
    }

    /// Sheared x and y, and the depth along the ray.
    #[inline(always)]
    fn sheared_lanes<S: Simd>(&self, simd: S, v: &[[f32; 8]; 3]) -> (f32x8<S>, f32x8<S>, f32x8<S>) {
        let [kx, ky, kz] = self.axes;
        let (origin, by) = (self.origin, self.by);
        let z = f32x8::simd_from(simd, v[kz]) - f32x8::splat(simd, origin.z);
        let x = (f32x8::simd_from(simd, v[kx]) - f32x8::splat(simd, origin.x)) - f32x8::splat(simd, by.x) * z;
        let y = (f32x8::simd_from(simd, v[ky]) - f32x8::splat(simd, origin.y)) - f32x8::splat(simd, by.y) * z;
        (x, y, z * f32x8::splat(simd, self.by.z))
    }

    /// The hit on one triangle, if there is one: the same edge functions without error, and the distance.
    #[inline(always)]
    pub(super) fn resolve(&self, packet: &Packet, lane: usize) -> Option<TriangleHit> {
        // Written out: `map` is not always inlined, and then loses the instruction set; and it copies the packet.
        let [a, b, c] = &packet.vertex;
        let triangle = [self.vertex(a, lane), self.vertex(b, lane), self.vertex(c, lane)];
        let (a, b, c) = (self.sheared(triangle[0]), self.sheared(triangle[1]), self.sheared(triangle[2]));
        let u = c.0 * b.1 - c.1 * b.0;
        let v = a.0 * c.1 - a.1 * c.0;
        let w = b.0 * a.1 - b.1 * a.0;
        let det = u + v + w;
        let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
        if !inside || det == 0.0 {
            return None;
        }
        let inv = 1.0 / det;
        let t = self.distance(&triangle, [u * inv, v * inv, w * inv]);
        Some(TriangleHit { t, uv: Vec2::new((v * inv) as f32, (w * inv) as f32) })
    }

    #[inline(always)]
    fn vertex(&self, v: &[[f32; 8]; 3], lane: usize) -> Vec3 {
        let [kx, ky, kz] = self.axes;
        Vec3::new(v[kx][lane], v[ky][lane], v[kz][lane])
    }

    /// The sheared vertex: rounded as in [`Self::candidates`], then exact.
    #[inline(always)]
    fn sheared(&self, v: Vec3) -> (f64, f64) {
        let z = v.z - self.origin.z;
        let x = (v.x - self.origin.x) - self.by.x * z;
        let y = (v.y - self.origin.y) - self.by.y * z;
        (f64::from(x), f64::from(y))
    }

    #[inline(always)]
    fn distance(&self, triangle: &[Vec3; 3], weights: [f64; 3]) -> f64 {
        // 8u: twice the angle by which rounding turns the displaced triangle, if its aspect is 1.
        const GRAZING: f64 = 8.0 / (1 << 24) as f64;
        let (origin, dir) = (self.origin.as_dvec3(), self.dir.as_dvec3());
        let (p0, p1, p2) =
            (triangle[0].as_dvec3() - origin, triangle[1].as_dvec3() - origin, triangle[2].as_dvec3() - origin);
        let (e1, e2): (DVec3, DVec3) = (p1 - p0, p2 - p0);
        let normal = e1.cross(e2);
        let slope = normal.dot(dir);
        let inv = 1.0 / dir.z;
        let depth = [p0.z * inv, p1.z * inv, p2.z * inv];
        // Long edges stand for the normal's length here: a thin triangle turns by more.
        let grazing =
            slope * slope <= GRAZING * GRAZING * e1.length_squared() * e2.length_squared() * dir.length_squared();
        if grazing {
            weights[0] * depth[0] + weights[1] * depth[1] + weights[2] * depth[2]
        } else {
            let near = depth[0].min(depth[1]).min(depth[2]);
            let far = depth[0].max(depth[1]).max(depth[2]);
            (normal.dot(p0) / slope).clamp(near, far)
        }
    }
}
