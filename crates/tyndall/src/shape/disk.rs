//! Flat disks and rings.
//!
//! A disk is kept as its centre and two half-axes, so any affine map of a disk is a disk of the same kind (in general
//! an ellipse).

use glam::{DVec2, DVec3};

use super::{
    ShapeError,
    derivatives::Local,
    instance::outward,
    interaction::Point,
    part::{Turn, turns},
};
use crate::math::{Bounds, Ray, Transform, Vec2, Vec3};

/// The texture coordinates of a disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DiskMapping {
    /// u is the azimuth over its range; v runs from 0 at the rim to 1 at the inner edge (pbrt).
    #[default]
    AzimuthInward,
    /// u is the radius, over that of the rim; v is the azimuth in turns (Mitsuba).
    OutwardAzimuth,
}

/// The points `centre + x·a + y·b` with `inner² ≤ x² + y² ≤ 1`, all the way round or some of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    /// Centre [length].
    pub centre: Vec3,
    /// Half-axis at azimuth 0 [length].
    pub a: Vec3,
    /// Half-axis a quarter turn on [length].
    pub b: Vec3,
    /// Radius of the hole over that of the disk, in `[0, 1)` [1].
    pub inner: f32,
    /// How far round it goes.
    pub turn: Turn,
    /// Its texture coordinates.
    pub mapping: DiskMapping,
    /// Whether the normal is `−a × b`.
    pub reversed: bool,
}

impl Disk {
    /// The disk at `z = height` around the z axis, facing +z.
    pub fn new(height: f32, radius: f32, inner_radius: f32) -> Self {
        Self {
            centre: Vec3::Z * height,
            a: Vec3::X * radius,
            b: Vec3::Y * radius,
            inner: inner_radius / radius,
            turn: Turn::FULL,
            mapping: DiskMapping::default(),
            reversed: false,
        }
    }

    /// The same with other texture coordinates.
    #[must_use]
    pub fn mapped(self, mapping: DiskMapping) -> Self {
        Self { mapping, ..self }
    }

    /// Some of the way round.
    #[must_use]
    pub fn cut(self, turn: Turn) -> Self {
        Self { turn, ..self }
    }

    /// Unit normal.
    pub fn normal(&self) -> Vec3 {
        self.outward().normalize_or_zero().as_vec3()
    }

    fn outward(&self) -> DVec3 {
        let n = self.a.as_dvec3().cross(self.b.as_dvec3());
        if self.reversed { -n } else { n }
    }

    /// The outer radius [length] if the rim is a circle or part of one.
    pub fn radius(&self) -> Option<f32> {
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let square = a.length_squared();
        let tolerance = 4.0 * f64::from(f32::EPSILON) * square;
        let circular = (square - b.length_squared()).abs() <= tolerance && a.dot(b).abs() <= tolerance;
        circular.then(|| square.sqrt() as f32)
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        if !(self.centre.is_finite() && self.a.is_finite() && self.b.is_finite() && self.inner.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        if !(0.0..1.0).contains(&self.inner) {
            return Err(ShapeError::NotPositive { what: "width of the ring", value: 1.0 - self.inner });
        }
        if self.outward() == DVec3::ZERO || self.turn.turns() <= 0.0 {
            return Err(ShapeError::NotPositive { what: "radius of the disk", value: 0.0 });
        }
        Ok(())
    }

    pub(super) fn placed(mut self, transform: &Transform, reversed: bool) -> Self {
        let map = transform.matrix.as_dmat4();
        self.centre = map.transform_point3(self.centre.as_dvec3()).as_vec3();
        self.a = map.transform_vector3(self.a.as_dvec3()).as_vec3();
        self.b = map.transform_vector3(self.b.as_dvec3()).as_vec3();
        self.reversed = reversed != transform.mirrors();
        self
    }

    pub(super) fn bounds(&self) -> Bounds {
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let half = (a * a + b * b).map(f64::sqrt) * (1.0 + f64::from(f32::EPSILON));
        outward(self.centre.as_dvec3() - half, self.centre.as_dvec3() + half)
    }

    /// The distance to the disk, if it is positive and before `t_max`.
    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        let n = self.a.as_dvec3().cross(self.b.as_dvec3());
        let from = ray.origin.as_dvec3() - self.centre.as_dvec3();
        let t = -n.dot(from) / n.dot(ray.dir.as_dvec3());
        if !(t > 0.0 && (t as f32) < t_max) {
            return None;
        }
        let (x, y) = self.coordinates(from + ray.dir.as_dvec3() * t);
        let (square, inner) = (x * x + y * y, f64::from(self.inner));
        let is_there = square <= 1.0 && square >= inner * inner && self.turn.holds(DVec2::new(x, y));
        is_there.then_some(t as f32)
    }

    /// `(x, y)` of a vector from the centre.
    fn coordinates(&self, v: DVec3) -> (f64, f64) {
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let n = a.cross(b);
        let square = n.length_squared();
        (b.cross(n).dot(v) / square, n.cross(a).dot(v) / square)
    }

    /// By the parameters, at a point of the space that holds it.
    pub(super) fn derivatives(&self, p: DVec3) -> Local {
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let (x, y) = self.coordinates(p - self.centre.as_dvec3());
        let r = x.hypot(y);
        let (cos, sin) = if r > 0.0 { (x / r, y / r) } else { (1.0, 0.0) };
        let (out, round) = (a * cos + b * sin, (b * cos - a * sin) * (r * self.turn.radians()));
        let dp = match self.mapping {
            DiskMapping::AzimuthInward => [round, out * (f64::from(self.inner) - 1.0)],
            DiskMapping::OutwardAzimuth => [out, round],
        };
        Local { dp, dn: [DVec3::ZERO; 2] }
    }

    pub(super) fn point(&self, ray: &Ray, t: f32) -> Point {
        let (centre, n) = (self.centre.as_dvec3(), self.outward());
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let (x, y) = self.coordinates(ray.origin.as_dvec3() - centre + ray.dir.as_dvec3() * f64::from(t));
        let turn = turns(DVec2::new(x, y)) / self.turn.turns();
        let r = x.hypot(y);
        // At the centre the azimuth is 0.
        let (cos, sin) = if r == 0.0 { (1.0, 0.0) } else { (x / r, y / r) };
        let (uv, dpdu) = match self.mapping {
            DiskMapping::AzimuthInward => {
                let v = (1.0 - r) / (1.0 - f64::from(self.inner));
                let along = if r == 0.0 { 1.0 } else { r };
                ([turn, v], (b * cos - a * sin) * (along * self.turn.radians()))
            }
            DiskMapping::OutwardAzimuth => ([r, turn], a * cos + b * sin),
        };
        Point {
            p: centre + a * x + b * y,
            error: (centre.abs().max_element() + a.abs().max_element() + b.abs().max_element()) * (-45f64).exp2(),
            ng: n,
            ns: n,
            uv: Vec2::new(uv[0] as f32, uv[1] as f32).into(),
            dpdu,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn around, half way from the centre to the rim, in both conventions; the tangent is ∂p/∂u, by difference.
    #[test]
    fn texture_coordinates_follow_their_convention() {
        let uv_at = |disk: &Disk, p: Vec3| disk.point(&Ray::new(p + Vec3::Z, -Vec3::Z), 1.0);
        let place = Vec3::new(0.0, 0.5, 0.0);
        for (mapping, expected) in
            [(DiskMapping::AzimuthInward, Vec2::new(0.25, 0.5)), (DiskMapping::OutwardAzimuth, Vec2::new(0.5, 0.25))]
        {
            let disk = Disk::new(0.0, 1.0, 0.0).mapped(mapping);
            let at = uv_at(&disk, place);
            assert!((at.uv.get() - expected).length() < 1e-6, "{mapping:?}: {}", at.uv.get());
            // A small step along ∂p/∂u changes u by the step, and v not.
            let step = 1e-3;
            let on = uv_at(&disk, place + at.dpdu.as_vec3() * step);
            assert!(
                (on.uv.get() - at.uv.get() - Vec2::new(step, 0.0)).length() < 1e-4,
                "{mapping:?}: {} {}",
                at.uv.get(),
                on.uv.get()
            );
        }
    }
}
