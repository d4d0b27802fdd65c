//! Spheres.
//!
//! The quadratic is solved in double precision with the discriminant taken from the ray's closest approach to the
//! centre (Haines et al. 2019), so that a small sphere far away keeps its shape: the approach is the cross product of the way to
//! the centre and the direction, which loses no digits. The smaller root is taken from the product of the roots, so that a ray
//! that starts on the surface knows it. The hit point is projected onto the sphere.

use glam::{DMat3, DVec3};

use super::{
    ShapeError, Uv,
    derivatives::Local,
    instance::{Placement, outward},
    interaction::Point,
    part::SpherePart,
};
use crate::math::{Bounds, Ray, Transform, Vec3};

/// Radii up to which a distance in single precision tells a point of a sphere well enough \[1\].
const NEAR: f32 = 64.0;

/// A sphere or a part of it. Its poles are along its own z axis: `u` is the azimuth over its range, `v` runs from the
/// south pole to the north pole, or from the southern rim to the northern one, with the angle from the axis.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Centre [length].
    pub centre: Vec3,
    /// Radius [length].
    pub radius: f32,
    /// Whether the normal points to the centre.
    pub reversed: bool,
    /// What of it there is.
    pub part: SpherePart,
    /// To the sphere's own axes (of a unit or mirrored unit matrix).
    pub(super) axes: DMat3,
    /// For spheres that the world sees as ellipsoids.
    pub(super) placement: Option<Placement>,
}

impl Sphere {
    /// A sphere around `centre`.
    pub fn new(centre: Vec3, radius: f32) -> Self {
        let part = SpherePart::WHOLE;
        Self { centre, radius, reversed: false, part, axes: DMat3::IDENTITY, placement: None }
    }

    /// A part of it.
    #[must_use]
    pub fn cut(self, part: SpherePart) -> Self {
        Self { part, ..self }
    }

    /// Centre and radius in the world [length], unless the world sees an ellipsoid or a part.
    pub fn round(&self) -> Option<(Vec3, f32)> {
        (self.placement.is_none() && self.part.is_whole()).then_some((self.centre, self.radius))
    }

    /// Centre, and the half-axes of what the world sees: the columns [length].
    pub(crate) fn axes(&self) -> (DVec3, DMat3) {
        let (centre, axes) = (self.centre.as_dvec3(), self.axes.transpose() * f64::from(self.radius));
        match &self.placement {
            None => (centre, axes),
            Some(placement) => (placement.map().transform_point3(centre), placement.map().matrix3 * axes),
        }
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        if !(self.centre.is_finite() && self.radius.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        if self.radius <= 0.0 {
            return Err(ShapeError::NotPositive { what: "radius", value: self.radius });
        }
        if self.part.share() <= 0.0 {
            return Err(ShapeError::NotPositive { what: "area of the part of the sphere", value: 0.0 });
        }
        Ok(())
    }

    /// The sphere in world space: itself a sphere if the transform is a similarity.
    pub(super) fn placed(mut self, transform: &Transform, reversed: bool) -> Self {
        self.reversed = reversed;
        if *transform != Transform::IDENTITY {
            let placement = Placement::new(transform);
            match self.moved(&placement) {
                Some((centre, radius)) => {
                    self.axes = placement.map().matrix3.inverse() * f64::from(radius / self.radius);
                    (self.centre, self.radius) = (centre, radius);
                }
                None => self.placement = Some(placement),
            }
        }
        self
    }

    /// Centre and radius after a similarity.
    pub(super) fn moved(&self, placement: &Placement) -> Option<(Vec3, f32)> {
        let scale = placement.uniform_scale().filter(|_| self.placement.is_none())?;
        let centre = placement.map().transform_point3(self.centre.as_dvec3()).as_vec3();
        let radius = (f64::from(self.radius) * scale) as f32;
        (centre.is_finite() && radius.is_normal()).then_some((centre, radius))
    }

    pub(super) fn bounds(&self) -> Bounds {
        let (centre, radius) = (self.centre.as_dvec3(), f64::from(self.radius));
        match &self.placement {
            None => outward(centre - radius, centre + radius),
            Some(placement) => {
                let map = placement.map();
                let rows = map.matrix3.transpose();
                let half = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()) * radius;
                let middle = map.transform_point3(centre);
                let slack = (middle.abs() + half) * f64::from(f32::EPSILON);
                outward(middle - half - slack, middle + half + slack)
            }
        }
    }

    /// The least positive distance before `t_max`.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        match &self.placement {
            None => self.intersect_local(ray, t_max),
            Some(placement) => self.intersect_local(&placement.ray_to_local(ray), t_max),
        }
    }

    #[inline]
    fn intersect_local(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        if self.part.is_whole() {
            return nearest(self.centre, self.radius, ray, t_max);
        }
        let (centre, radius) = (self.centre.as_dvec3(), f64::from(self.radius));
        let from = ray.origin.as_dvec3() - centre;
        let is_there = |t: &f64| {
            let n = (from + ray.dir.as_dvec3() * *t).normalize_or_zero();
            *t > 0.0 && self.part.holds(self.axes * n)
        };
        let t = roots(centre, radius, ray)?.into_iter().find(is_there)? as f32;
        (t > 0.0 && t < t_max).then_some(t)
    }

    pub(super) fn point(&self, ray: &Ray, t: f32) -> Point {
        match &self.placement {
            None => self.local_point(ray, t),
            Some(placement) => {
                let local = placement.ray_to_local(ray);
                placement.place(&self.local_point(&local, t))
            }
        }
    }

    fn local_point(&self, ray: &Ray, t: f32) -> Point {
        let (centre, radius) = (self.centre.as_dvec3(), f64::from(self.radius));
        // `t` was rounded: of a small sphere far away it has lost the place, so solve again. Near it the ray itself is no better.
        let is_near = (ray.dir * t).length_squared() <= (NEAR * self.radius).powi(2);
        let t = if is_near {
            f64::from(t)
        } else {
            match roots(centre, radius, ray) {
                Some([near, far]) if (near - f64::from(t)).abs() <= (far - f64::from(t)).abs() => near,
                Some([_, far]) => far,
                None => f64::from(t),
            }
        };
        let outward = (ray.origin.as_dvec3() - centre + ray.dir.as_dvec3() * t).normalize_or(DVec3::Z);
        let local = self.axes * outward;
        let ng = if self.reversed { -outward } else { outward };
        Point {
            p: centre + outward * radius,
            error: (centre.abs().max_element() + radius) * (-45f64).exp2(),
            ng,
            ns: ng,
            uv: self.parameters(local),
            dpdu: self.axes.transpose() * self.along_u(local),
        }
    }

    /// By the parameters, at a point of the space that holds it.
    pub(super) fn derivatives(&self, p: DVec3) -> Local {
        let place = self.placement.as_ref();
        let local = place.map_or(p, |placement| placement.local_point(p)) - self.centre.as_dvec3();
        let n = (self.axes * local).normalize_or(DVec3::Z);
        let turn = self.part.turn;
        let [south, north] = self.part.rims();
        let rho = n.truncate().length();
        let [cos, sin] = if rho > 0.0 { [n.x / rho, n.y / rho] } else { [1.0, 0.0] };
        let du = DVec3::new(-n.y, n.x, 0.0) * turn.radians();
        let dv = DVec3::new(n.z * cos, n.z * sin, -rho) * (north - south);
        let dn = [du, dv].map(|d| self.axes.transpose() * d);
        let local = Local { dp: dn.map(|d| d * f64::from(self.radius)), dn };
        place.map_or(local, |placement| {
            let normal = placement.map().matrix3.inverse().transpose() * (self.axes.transpose() * n);
            local.placed(&placement.map(), normal.normalize())
        })
    }

    /// The parameters of a direction from the centre.
    fn parameters(&self, n: DVec3) -> Uv {
        if self.part.is_whole() { Uv::OnSphere(n.as_vec3()) } else { self.part.parameters(n).into() }
    }

    /// The derivative of the point by `u`, in a direction from the centre.
    fn along_u(&self, n: DVec3) -> DVec3 {
        let around = DVec3::new(-n.y, n.x, 0.0);
        let around = if around == DVec3::ZERO { DVec3::Y } else { around };
        around * (self.part.turn.radians() * f64::from(self.radius))
    }
}

/// The least positive distance to a sphere before `t_max`.
#[inline(always)]
pub(super) fn nearest(centre: Vec3, radius: f32, ray: &Ray, t_max: f32) -> Option<f32> {
    let [near, far] = roots(centre.as_dvec3(), f64::from(radius), ray)?;
    let t = if near > 0.0 { near } else { far };
    (t > 0.0 && (t as f32) < t_max).then_some(t as f32)
}

/// Both distances along the ray's line, in order.
#[inline(always)]
fn roots(centre: DVec3, radius: f64, ray: &Ray) -> Option<[f64; 2]> {
    let from = ray.origin.as_dvec3() - centre;
    let dir = ray.dir.as_dvec3();
    let a = dir.length_squared();
    // `a` times the square of half the chord: without a division, for most rays miss.
    let discriminant = radius * radius * a - from.cross(dir).length_squared();
    if discriminant < 0.0 {
        return None;
    }
    let b = -from.dot(dir);
    let c = from.length_squared() - radius * radius;
    let q = b + discriminant.sqrt().copysign(b);
    if q == 0.0 {
        return None; // a tangent that starts where it touches
    }
    let (t0, t1) = (c / q, q / a);
    Some([t0.min(t1), t0.max(t1)])
}
