//! Collisions aimed at a lamp.
//!
//! Light that a thin medium scatters once, of a lamp at distance `D` from a ray, falls off as `1/(D² + (t − δ)²)` along the
//! ray, `δ` being where the ray passes the lamp. Free flights know nothing of that. So along each ray a second collision is
//! tried, at a distance with that density (*equiangular*: uniform in the angle at which the lamp sees the ray),
//!
//! ```text
//! p(t) = D / ((θ_b − θ_a) (D² + (t − δ)²)),   θ = arctan((t − δ)/D),   0 ≤ t ≤ end,
//! ```
//!
//! where light is sampled as at any other. Three techniques then find the light of one collision: a flight and a light sample, an
//! aimed collision and a light sample, a flight and a direction that runs into the lamp. They are weighed by the balance
//! heuristic. Which lamp is aimed at is drawn before, and all three are weighed given that draw, so each draw by itself is unbiased.
//!
//! A lamp of radius `r` sees the ray from no less than about `r`: `D² = d² + r²` for one that it passes at `d`.
//!
//! Source: Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", § 5.

use crate::math::{Bounds, Ray};

/// A density of distances along a ray [1/length].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// `−δ/D`: the tangent of the angle at which the ray begins \[1\].
    start: f32,
    /// `D` [length].
    distance: f32,
    /// `θ_b − θ_a` [rad].
    span: f32,
    /// Where the ray ends [length].
    end: f32,
}

impl Aim {
    /// Along `ray` up to `end` [length], which may be infinite, at a lamp within `bounds`; `None` where no density is finite: for
    /// a point on the ray itself, or one as good as infinitely far away.
    #[inline]
    pub fn new(ray: &Ray, end: f32, bounds: &Bounds) -> Option<Self> {
        let lamp = 0.5 * (bounds.min + bounds.max) - ray.origin;
        let radius = 0.5 * (bounds.max - bounds.min).length();
        let passes = lamp.dot(ray.dir);
        let distance = ((lamp - ray.dir * passes).length_squared() + radius * radius).sqrt();
        let start = -passes / distance;
        // arctan of both ends, subtracted where neither can cancel: the tangent of a difference.
        let length = end / distance;
        let span = if length.is_finite() { length.atan2(1.0 + start * (start + length)) } else { 1f32.atan2(start) };
        (distance > 0.0 && start.is_finite() && span > 0.0).then_some(Self { start, distance, span, end })
    }

    /// A distance [length].
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let (sin, cos) = (u * self.span).sin_cos();
        let t = self.distance * sin * (1.0 + self.start * self.start) / (cos - self.start * sin);
        t.clamp(0.0, self.end)
    }

    /// Its density [1/length].
    #[inline]
    pub fn pdf(&self, t: f32) -> f32 {
        let x = self.start + t / self.distance;
        1.0 / (self.span * self.distance * (1.0 + x * x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    /// Rays past a lamp, into it, away from it, without an end; near and far.
    fn cases() -> Vec<(Aim, f64)> {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        let mut cases = Vec::new();
        for end in [0.5, 20.0, f32::INFINITY] {
            for (along, beside) in [(5.0, 1.0), (5.0, 1e-3), (-3.0, 0.1), (100.0, 2.0), (0.0, 0.5)] {
                let lamp = Bounds::of([Vec3::new(along, beside, 0.0)]);
                cases.push((Aim::new(&ray, end, &lamp).unwrap(), f64::from(end)));
            }
        }
        cases
    }

    /// Its share of the angle, in double precision.
    fn share(aim: &Aim, t: f64) -> f64 {
        let angle = |t: f64| (f64::from(aim.start) + t / f64::from(aim.distance)).atan();
        let all = angle(f64::from(aim.end)) - angle(0.0);
        (angle(t) - angle(0.0)) / all
    }

    /// A distance drawn with `u` has the share `u` of the angle before it.
    #[test]
    fn distances_are_uniform_in_the_angle_at_the_lamp() {
        for (aim, end) in cases() {
            for i in 0..1000 {
                let u = (f64::from(i) + 0.5) / 1000.0;
                let t = f64::from(aim.sample(u as f32));
                assert!(t >= 0.0 && t <= end, "{aim:?} {t}");
                let found = share(&aim, t);
                // The distance is rounded, where the lamp is near more than the angle: by four roundings.
                let rounding = 4.0 * f64::from(f32::EPSILON) * t * f64::from(aim.pdf(t as f32));
                assert!((found - u).abs() < 2e-6 + rounding, "{aim:?}: {found} for {u} at {t}");
            }
        }
    }

    /// The density is the derivative of that share, by differences.
    #[test]
    fn the_density_is_that_of_the_distances() {
        for (aim, end) in cases() {
            let far = if end.is_finite() { end } else { 50.0 };
            for i in 1..200 {
                let t = far * f64::from(i) / 200.0;
                let x = f64::from(aim.start) + t / f64::from(aim.distance);
                let h = 1e-4 * f64::from(aim.distance) * x.hypot(1.0);
                let slope = (share(&aim, t + h) - share(&aim, t - h)) / (2.0 * h);
                let pdf = f64::from(aim.pdf(t as f32));
                assert!((pdf / slope - 1.0).abs() < 2e-4, "{aim:?}: {pdf} for {slope} at {t}");
            }
        }
    }

    #[test]
    fn a_point_on_the_ray_cannot_be_aimed_at() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        assert_eq!(Aim::new(&ray, 9.0, &Bounds::of([Vec3::X])), None);
        assert_eq!(Aim::new(&ray, 9.0, &Bounds::of([Vec3::splat(f32::INFINITY)])), None);
        assert_eq!(Aim::new(&ray, 0.0, &Bounds::of([Vec3::Y])), None);
    }
}
