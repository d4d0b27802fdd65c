//! Where light bends on its way from a lamp into a body: the point `s` of a smooth wall at which the straight lines from `x`
//! inside and to `y` outside obey Snell's law.
//!
//! With `a = |s − x|`, `b = |y − s|`, unit vectors `d` from `x` to `s` and `u` from `s` to `y`, and `η` the index on the side of
//! `x` over that beyond, Fermat's principle makes the optical length `η a + b` stationary on the wall. Its gradient and Hessian in
//! the tangent plane of a wall with unit normal `n` (away from `x`) and curvature `κ` (positive where `x` sees it hollow) are
//!
//! ```text
//! g = P (η d − u)                P = 1 − n nᵀ
//! H = P [ η/a (1 − d dᵀ) + 1/b (1 − u uᵀ) ] P − κ n·(η d − u) P
//! ```
//!
//! `g = 0` is Snell's law, and Newton's step is `−H⁻¹ g`. The same Hessian tells how wide a lamp looks: moving `y` by `δy` moves
//! `s` by `H⁻¹ P (1 − u uᵀ) δy / b`, and that turns `d`. So a solid angle `dω` at `x` holds an area `dA` at `y` across `u` with
//!
//! ```text
//! dω/dA = cos θ_d cos θ_u / (a² b² |det H|)
//! ```
//!
//! θ from the normal. Of light from infinitely far away `1/b` is 0 in `H`, and `dω/dω_u` is the same without `b²`. Without a bend
//! (`η = 1`) it is `1/(a + b)²`.
//!
//! The search is deterministic: from the place where light that comes to `x` over the nearest point of the wall would bend, or
//! where a straight line leaves. It finds one solution at most, where there may be several or none.
//!
//! Source: Hanika, Droske and Fascione 2015, "Manifold Next Event Estimation"; Zeltner, Georgiev and Jakob 2020, "Specular Manifold
//! Sampling", § 3; the Hessian of the optical length: Jakob and Marschner 2012, "Manifold Exploration", § 4.

use glam::DVec3;

use crate::{math::Vec3, shape::Shape};

/// Steps of Newton's method.
const STEPS: u32 = 20;
/// How far from Snell's law a way may be: the tangential part of `η d − u` \[1\].
const CLOSE: f64 = 1e-7;

/// Where a way ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// At a point of a surface [length] with a unit normal.
    Point {
        /// The point.
        p: Vec3,
        /// The normal.
        ng: Vec3,
    },
    /// Infinitely far away in a direction.
    Infinity(Vec3),
}

impl Goal {
    /// The direction to it, and one over its distance [1/length].
    #[inline]
    fn seen_from(&self, s: DVec3) -> (DVec3, f64) {
        match *self {
            Self::Infinity(dir) => (dir.as_dvec3(), 0.0),
            Self::Point { p, .. } => {
                let to_goal = p.as_dvec3() - s;
                let nearness = 1.0 / to_goal.length();
                (to_goal * nearness, nearness)
            }
        }
    }

    /// The straight direction to it.
    #[inline]
    pub fn straight(&self, x: Vec3) -> Vec3 {
        self.seen_from(x.as_dvec3()).0.as_vec3()
    }
}

/// A smooth wall, as seen from one side of it: a plane or a sphere from inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// A point of it [length].
    point: DVec3,
    /// Its unit normal there, away from the side that sees it.
    normal: DVec3,
    /// One over the radius of a sphere, 0 for a plane [1/length].
    curvature: f64,
}

/// A way that bends at a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// Unit direction from the start to the wall.
    pub dir: Vec3,
    /// Unit direction from the wall to the goal.
    pub onward: Vec3,
    /// Cosine of the angle of incidence at the wall, on the side of the start \[1\].
    pub cos_theta: f32,
    /// Solid angle at the start for each area across `onward` at the goal [1/length²], or for each solid angle of a
    /// goal infinitely far away \[1\].
    pub spread: f32,
}

impl Wall {
    /// The wall that a part of an object of the world is for `x`, if it is flat or a sphere around `x`; and whether its geometric
    /// normal points to `x`.
    pub fn of(shape: &Shape, prim: u32, x: Vec3) -> Option<(Self, bool)> {
        let x = x.as_dvec3();
        match shape {
            Shape::Sphere(sphere) => {
                let (centre, radius) = sphere.round()?;
                let wall = Self::ball(centre.as_dvec3(), f64::from(radius), x)?;
                Some((wall, sphere.reversed))
            }
            Shape::Mesh(mesh) if mesh.normals.is_empty() => {
                let [p, q, r] = mesh.triangle(prim).map(Vec3::as_dvec3);
                let ng = (q - p).cross(r - p);
                let wall = Self::plane(p, ng, x)?;
                Some((wall, (ng.dot(wall.normal) < 0.0) != mesh.reversed))
            }
            _ => None,
        }
    }

    /// A sphere around `x`.
    fn ball(centre: DVec3, radius: f64, x: DVec3) -> Option<Self> {
        let normal = (x - centre).try_normalize().unwrap_or(DVec3::Z);
        let is_inside = x.distance_squared(centre) < radius * radius;
        is_inside.then(|| Self { point: centre + normal * radius, normal, curvature: 1.0 / radius })
    }

    /// A plane through `point` across `normal`, which need not be a unit vector.
    fn plane(point: DVec3, normal: DVec3, x: DVec3) -> Option<Self> {
        let normal = normal.try_normalize()?;
        let height = (point - x).dot(normal);
        let normal = if height < 0.0 { -normal } else { normal };
        (height != 0.0).then(|| Self { point: x + normal * height.abs(), normal, curvature: 0.0 })
    }

    /// Unit normal at a point of it.
    #[inline]
    fn normal(&self, s: DVec3) -> DVec3 {
        self.normal + (s - self.point) * self.curvature
    }

    /// Where the line from `x` along a unit vector leaves through it.
    #[inline]
    fn along(&self, x: DVec3, d: DVec3) -> Option<DVec3> {
        // κ t² / 2 + q t = h, with the height h of the wall over x seen from its own point: good for planes and spheres.
        let from = x - self.point;
        let half = 0.5 * self.curvature;
        let h = -(from.dot(self.normal) + half * from.length_squared());
        let q = d.dot(self.normal) + self.curvature * from.dot(d);
        let root = (q * q + 4.0 * half * h).sqrt();
        let t = 2.0 * h / (q + root);
        (t > 0.0 && t.is_finite()).then(|| x + d * t)
    }

    /// The point of it nearest to one that is nearly on it.
    #[inline]
    fn nearest(&self, s: DVec3) -> DVec3 {
        // Off by f along n: f = n·(s − p) + κ |s − p|² / 2 for a plane, and to be divided by (1 + |n(s)|)/2 for a sphere.
        let n = self.normal(s);
        let length = n.length();
        let from = s - self.point;
        let off = from.dot(self.normal) + 0.5 * self.curvature * from.length_squared();
        s - n * (2.0 * off / (length * (1.0 + length)))
    }

    /// Where to begin: where light that comes from the goal to the foot of the wall would bend towards `x`, or where a straight
    /// line to the goal leaves.
    #[inline]
    fn begin(&self, x: DVec3, eta: f64, goal: &Goal) -> Option<DVec3> {
        let (u, _) = goal.seen_from(self.point);
        let tangential = (u - self.normal * u.dot(self.normal)) / eta;
        let square = tangential.length_squared();
        if u.dot(self.normal) > 0.0 && square < 1.0 {
            return self.along(x, tangential + self.normal * (1.0 - square).sqrt());
        }
        self.along(x, goal.seen_from(x).0)
    }

    /// The way from `x` through this wall to `goal`, where the index on the side of `x` is `eta` times that beyond: one that obeys
    /// Snell's law, if it is found. The search ends where it is farther than `reach` from `x` [length].
    pub fn bend(&self, x: Vec3, eta: f32, goal: &Goal, reach: f32) -> Option<Bend> {
        let (x, eta) = (x.as_dvec3(), f64::from(eta));
        let mut s = self.begin(x, eta, goal)?;
        for _ in 0..STEPS {
            let n = self.normal(s);
            let a = s.distance(x);
            if a > f64::from(reach) {
                return None;
            }
            let d = (s - x) / a;
            let (u, nearness) = goal.seen_from(s);
            let v = eta * d - u;
            let lambda = v.dot(n);
            let (s1, s2) = n.any_orthonormal_pair();
            let [d1, d2, u1, u2] = [d.dot(s1), d.dot(s2), u.dot(s1), u.dot(s2)];
            let [g1, g2] = [eta * d1 - u1, eta * d2 - u2];
            let near = eta / a;
            let even = near + nearness - self.curvature * lambda;
            let h11 = even - near * d1 * d1 - nearness * u1 * u1;
            let h22 = even - near * d2 * d2 - nearness * u2 * u2;
            let h12 = -(near * d1 * d2 + nearness * u1 * u2);
            let det = h11 * h22 - h12 * h12;
            if g1 * g1 + g2 * g2 < CLOSE * CLOSE {
                let (cos_d, cos_u) = (d.dot(n), u.dot(n));
                let far = if nearness > 0.0 { nearness * nearness } else { 1.0 };
                let spread = (cos_d * cos_u * far / (a * a * det.abs())) as f32;
                let is_way = cos_d > 0.0 && cos_u > 0.0 && spread > 0.0 && spread.is_finite();
                return is_way.then(|| Bend { dir: d.as_vec3(), onward: u.as_vec3(), cos_theta: cos_d as f32, spread });
            }
            let step = (s1 * (h12 * g2 - h22 * g1) + s2 * (h12 * g1 - h11 * g2)) / det;
            // Over the distance to either end everything changes: no step is trusted farther.
            let (length, most) = (step.length(), a.min(1.0 / nearness));
            let step = if length > most { step * (most / length) } else { step };
            s = self.nearest(s + step);
            if !s.is_finite() {
                return None;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests;
