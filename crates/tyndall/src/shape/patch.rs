//! Bilinear patches.
//!
//! `p(u, v)` interpolates four corners. A ray meets the line `u = const` of the patch where their volume form is zero,
//! which is a quadratic in `u` (Reshetov 2019, "Cool patches"); `v` and `t` follow from the two lines' nearest points.
//! Solved in double precision. Patches that are flat and convex become two triangles when they are added.

use glam::DVec3;

use super::{Mesh, ShapeError, derivatives::Local, interaction::Point};
use crate::math::{Bounds, Ray, Transform, Vec2, Vec3};

/// The surface `(1−u)(1−v)·p₀₀ + u(1−v)·p₁₀ + (1−u)v·p₀₁ + uv·p₁₁`, facing `∂p/∂u × ∂p/∂v`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Corners `[p₀₀, p₁₀, p₀₁, p₁₁]` [length].
    pub corners: [Vec3; 4],
    /// Whether the normal is turned round.
    pub reversed: bool,
}

/// A point of a patch: distance and parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct PatchHit {
    pub(super) t: f32,
    pub(super) uv: Vec2,
}

impl Patch {
    /// The patch over `[p₀₀, p₁₀, p₀₁, p₁₁]`.
    pub fn new(corners: [Vec3; 4]) -> Self {
        Self { corners, reversed: false }
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        if self.corners.iter().all(|p| p.is_finite()) { Ok(()) } else { Err(ShapeError::NotFinite) }
    }

    pub(super) fn placed(mut self, transform: &Transform, reversed: bool) -> Self {
        let map = transform.matrix.as_dmat4();
        self.corners = self.corners.map(|p| map.transform_point3(p.as_dvec3()).as_vec3());
        self.reversed = reversed != transform.mirrors();
        self
    }

    /// The two triangles of a patch that is flat (up to rounding of its corners) and convex.
    pub fn as_triangles(&self) -> Option<Mesh> {
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let normals = [(p00, p10, p01), (p10, p11, p00), (p11, p01, p10), (p01, p00, p11)]
            .map(|(at, next, last)| (next - at).cross(last - at));
        let convex = normals.iter().all(|n| n.dot(normals[0]) > 0.0);
        let magnitude = self.corners.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
        let height = normals[0].normalize_or_zero().dot(p11 - p00).abs();
        if !convex || height > 4.0 * f64::from(f32::EPSILON * magnitude) {
            return None;
        }
        Some(Mesh {
            positions: vec![self.corners[0], self.corners[1], self.corners[3], self.corners[2]],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            normals: Vec::new(),
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
            reversed: self.reversed,
        })
    }

    /// The hull of the corners holds the patch.
    pub(super) fn bounds(&self) -> Bounds {
        Bounds::of(self.corners)
    }

    /// The nearest point with a positive distance before `t_max`.
    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PatchHit> {
        let mut best: Option<PatchHit> = None;
        for [t, u, v] in self.crossings(ray).into_iter().flatten() {
            let limit = best.map_or(t_max, |b| b.t);
            let within = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
            if within && t > 0.0 && (t as f32) < limit {
                best = Some(PatchHit { t: t as f32, uv: Vec2::new(u as f32, v as f32) });
            }
        }
        best
    }

    /// `[t, u, v]` where the line of a ray passes the surface that the patch is a part of.
    pub(crate) fn crossings(&self, ray: &Ray) -> [Option<[f64; 3]>; 2] {
        let dir = ray.dir.as_dvec3();
        let [p00, p10, p01, p11] = self.corners.map(|p| p.as_dvec3() - ray.origin.as_dvec3());
        // The line u = const runs from `start` to `start + along`; both are linear in u.
        let (start, start_slope) = (p00, p10 - p00);
        let (along, along_slope) = (p01 - p00, (p11 - p10) - (p01 - p00));
        // (start × dir)·along = c0 + c1 u + c2 u²
        let c0 = start.cross(dir).dot(along);
        let c1 = start_slope.cross(dir).dot(along) + start.cross(dir).dot(along_slope);
        let c2 = start_slope.cross(dir).dot(along_slope);
        quadratic(c0, c1, c2).map(|u| {
            let u = u?;
            let (from, along) = (start + start_slope * u, along + along_slope * u);
            let across = dir.cross(along);
            let square = across.length_squared();
            Some([across.dot(from.cross(along)) / square, u, across.dot(from.cross(dir)) / square])
        })
    }

    /// By the parameters.
    pub(super) fn derivatives(&self, uv: Vec2) -> Local {
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let dpdu = (p10 - p00).lerp(p11 - p01, v);
        let dpdv = (p01 - p00).lerp(p11 - p10, u);
        let twist = p11 - p10 - p01 + p00;
        Local::of_normal([dpdu, dpdv], dpdu.cross(dpdv), [dpdu.cross(twist), twist.cross(dpdv)])
    }

    pub(super) fn point(&self, uv: Vec2) -> Point {
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let dpdu = (p10 - p00).lerp(p11 - p01, v);
        let dpdv = (p01 - p00).lerp(p11 - p10, u);
        let n: DVec3 = if self.reversed { dpdv.cross(dpdu) } else { dpdu.cross(dpdv) };
        let size = self.corners.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
        Point {
            p: p00.lerp(p10, u).lerp(p01.lerp(p11, u), v),
            error: f64::from(size) * (-32f64).exp2(),
            ng: n,
            ns: n,
            uv: uv.into(),
            dpdu,
        }
    }
}

/// Real roots of `c0 + c1 x + c2 x²`.
fn quadratic(c0: f64, c1: f64, c2: f64) -> [Option<f64>; 2] {
    let discriminant = c1 * c1 - 4.0 * c0 * c2;
    if discriminant < 0.0 {
        return [None, None];
    }
    let q = -0.5 * (c1 + discriminant.sqrt().copysign(c1));
    [(q != 0.0).then(|| c0 / q), (c2 != 0.0).then(|| q / c2)]
}
