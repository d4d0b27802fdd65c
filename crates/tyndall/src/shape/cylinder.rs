//! Cylinders without lids, whole or cut along a plane through their axis.
//!
//! A cylinder is kept as the centre of its base, two half-axes of the base, and its axis, so any affine map of a cylinder
//! is a cylinder of the same kind (in general an oblique one over an ellipse). In its own coordinates it is
//! `x² + y² = 1`, `0 ≤ z ≤ 1`; the quadratic is solved there, in double precision, with the discriminant taken from the
//! ray's closest approach to the axis, as for [spheres](super::Sphere).

use glam::{DMat3, DVec2, DVec3};

use super::{
    ShapeError,
    derivatives::Local,
    instance::{least_stretch, outward},
    interaction::Point,
    part::{Turn, turns},
};
use crate::math::{Bounds, Ray, Transform, Vec2, Vec3};

/// The points `base + cos φ·a + sin φ·b + h·axis`, `0 ≤ h ≤ 1`, φ below a full turn or a part of it. Seen from the axis
/// outward is the outside, unless `reversed`. `u` is φ over its range, `v` is `h` (pbrt and Mitsuba alike).
#[derive(Debug, Clone, Copy)]
pub struct Cylinder {
    /// Centre of the base [length].
    pub base: Vec3,
    /// Half-axis of the base at azimuth 0 [length].
    pub a: Vec3,
    /// Half-axis of the base a quarter turn on [length].
    pub b: Vec3,
    /// From the base to the other end [length].
    pub axis: Vec3,
    /// How far round it goes.
    pub turn: Turn,
    /// Whether the normal points to the axis.
    pub reversed: bool,
    /// To coordinates where it is a unit cylinder.
    inverse: DMat3,
}

impl Cylinder {
    /// The cylinder around the z axis between two heights [length].
    pub fn new(radius: f32, [low, high]: [f32; 2], turn: Turn) -> Self {
        let (a, b, axis) = (Vec3::X * radius, Vec3::Y * radius, Vec3::Z * (high - low));
        let inverse = DMat3::IDENTITY;
        Self { base: Vec3::Z * low, a, b, axis, turn, reversed: false, inverse }.prepared()
    }

    fn prepared(mut self) -> Self {
        self.inverse = self.matrix().inverse();
        self
    }

    fn matrix(&self) -> DMat3 {
        DMat3::from_cols(self.a.as_dvec3(), self.b.as_dvec3(), self.axis.as_dvec3())
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        if !(self.base.is_finite() && self.a.is_finite() && self.b.is_finite() && self.axis.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        if !self.inverse.is_finite() || self.matrix().determinant() == 0.0 {
            return Err(ShapeError::NotPositive { what: "radius or height of the cylinder", value: 0.0 });
        }
        Ok(())
    }

    /// The cylinder in world space: its outside stays outside under a mirroring.
    pub(super) fn placed(mut self, transform: &Transform, reversed: bool) -> Self {
        let map = transform.matrix.as_dmat4();
        self.base = map.transform_point3(self.base.as_dvec3()).as_vec3();
        [self.a, self.b, self.axis] =
            [self.a, self.b, self.axis].map(|v| map.transform_vector3(v.as_dvec3()).as_vec3());
        self.reversed = reversed;
        self.prepared()
    }

    pub(super) fn bounds(&self) -> Bounds {
        let (a, b) = (self.a.as_dvec3(), self.b.as_dvec3());
        let half = (a * a + b * b).map(f64::sqrt) * (1.0 + f64::from(f32::EPSILON));
        let ends = [self.base.as_dvec3(), self.base.as_dvec3() + self.axis.as_dvec3()];
        outward(ends[0].min(ends[1]) - half, ends[0].max(ends[1]) + half)
    }

    /// The least positive distance before `t_max`.
    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        let (from, dir) = self.local(ray);
        let is_there = |t: &f64| {
            let p = from + dir * *t;
            *t > 0.0 && (0.0..=1.0).contains(&p.z) && self.turn.holds(p.truncate())
        };
        let t = roots(from, dir)?.into_iter().find(is_there)? as f32;
        (t > 0.0 && t < t_max).then_some(t)
    }

    /// Origin and direction of a ray where the cylinder is a unit one.
    fn local(&self, ray: &Ray) -> (DVec3, DVec3) {
        (self.inverse * (ray.origin.as_dvec3() - self.base.as_dvec3()), self.inverse * ray.dir.as_dvec3())
    }

    pub(super) fn point(&self, ray: &Ray, t: f32) -> Point {
        let (from, dir) = self.local(ray);
        // `t` was rounded: of a thin cylinder far away it has lost the place, so solve again.
        let nearer = |[near, far]: [f64; 2]| {
            if (near - f64::from(t)).abs() <= (far - f64::from(t)).abs() { near } else { far }
        };
        let t = roots(from, dir).map_or(f64::from(t), nearer);
        let local = from + dir * t;
        let round = local.truncate().normalize_or(DVec2::X);
        let matrix = self.matrix();
        let size = [self.base, self.a, self.b, self.axis].map(|v| f64::from(v.abs().max_element()));
        let normal = self.inverse.transpose() * round.extend(0.0);
        let ng = if self.reversed { -normal } else { normal };
        Point {
            p: self.base.as_dvec3() + matrix * round.extend(local.z),
            error: size.iter().sum::<f64>() * (-45f64).exp2(),
            ng,
            ns: ng,
            uv: Vec2::new((turns(round) / self.turn.turns()) as f32, local.z as f32).into(),
            dpdu: matrix * round.perp().extend(0.0) * self.turn.radians(),
        }
    }

    /// By the parameters, at a point of the space that holds it.
    pub(super) fn derivatives(&self, p: DVec3) -> Local {
        let local = self.inverse * (p - self.base.as_dvec3());
        let round = local.truncate().normalize_or(DVec2::X);
        let along = round.perp().extend(0.0) * self.turn.radians();
        let cotangent = self.inverse.transpose();
        let dn = [cotangent * along, DVec3::ZERO];
        Local::of_normal([self.matrix() * along, self.axis.as_dvec3()], cotangent * round.extend(0.0), dn)
    }

    /// A lower bound on the distance [length] from `p` to the whole cylinder: the distance itself if the cylinder is
    /// round and right.
    pub(super) fn clearance(&self, p: DVec3) -> f64 {
        let matrix = self.matrix();
        let sizes = DVec3::new(matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length());
        let local = self.inverse * (p - self.base.as_dvec3());
        let radial = (local.truncate().length() - 1.0).abs() * sizes.x.min(sizes.y);
        let beyond = (local.z - 1.0).max(-local.z).max(0.0) * sizes.z;
        let stretch = least_stretch(DMat3::from_diagonal(sizes) * self.inverse);
        // Half-axes of a round one differ by their rounding, and are at right angles up to it.
        let rounding = f64::from(f32::EPSILON) * 8.0;
        radial.hypot(beyond) * stretch * (1.0 - rounding)
            - 1e-14 * (local.abs() * sizes).max_element().max(sizes.max_element())
    }
}

/// Both distances to `x² + y² = 1` along a line, in order.
fn roots(from: DVec3, dir: DVec3) -> Option<[f64; 2]> {
    let (from, dir) = (from.truncate(), dir.truncate());
    let a = dir.length_squared();
    let b = -from.dot(dir);
    let approach = from + dir * (b / a);
    let discriminant = 1.0 - approach.length_squared();
    if discriminant.is_nan() || discriminant < 0.0 {
        return None; // along the axis there is nothing either
    }
    let c = from.length_squared() - 1.0;
    let q = b + (a * discriminant).sqrt().copysign(b);
    if q == 0.0 {
        return None; // a tangent that starts where it touches
    }
    let (t0, t1) = (c / q, q / a);
    Some([t0.min(t1), t0.max(t1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of the way round and half way up; the tangent is ∂p/∂u: a small step along it changes u by the step.
    #[test]
    fn u_runs_round_and_v_runs_up() {
        for (turn, u) in [(Turn::FULL, 0.25), (Turn::degrees(180.0), 0.5)] {
            let cylinder = Cylinder::new(2.0, [1.0, 3.0], turn);
            let at =
                |p: Vec3| cylinder.point(&Ray::new(p * Vec3::new(2.0, 2.0, 1.0), -p * Vec3::new(1.0, 1.0, 0.0)), 1.0);
            let here = at(Vec3::new(0.0, 2.0, 2.0));
            assert!((here.uv.get() - Vec2::new(u, 0.5)).length() < 1e-6, "{}", here.uv.get());
            assert!((here.ng.normalize() - DVec3::Y).length() < 1e-6);
            let step = 1e-4;
            let on = at((here.p + here.dpdu * step).as_vec3());
            assert!(
                (on.uv.get() - here.uv.get() - Vec2::new(step as f32, 0.0)).length() < 1e-6,
                "{} {}",
                here.uv.get(),
                on.uv.get()
            );
        }
    }

    /// A ray along the axis meets nothing, also when it runs on the surface itself.
    #[test]
    fn a_ray_along_the_axis_meets_nothing() {
        let cylinder = Cylinder::new(1.0, [0.0, 1.0], Turn::FULL);
        for x in [0.0, 0.5, 1.0, 2.0] {
            assert_eq!(cylinder.intersect(&Ray::new(Vec3::new(x, 0.0, -1.0), Vec3::Z), f32::INFINITY), None);
        }
    }
}
