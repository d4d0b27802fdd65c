//! Emitters that are surfaces of revolution under an affine map: cylinders, parts of disks and of spheres, ellipsoids.
//!
//! `p(φ, s) = centre + ρ(s)(cos φ·a + sin φ·b) + ζ(s)·c`, with φ from 0 to at most 2π, and
//!
//! | | s | ρ(s) | ζ(s) |
//! |---|---|---|---|
//! | cylinder | height over the whole height | 1 | s |
//! | disk | square of the radius | √s | 0 |
//! | sphere | cosine of the angle from the axis | √(1 − s²) | s |
//!
//! Points are drawn uniformly in φ and s. Their density per area is `1 / (Δφ Δs |∂p/∂φ × ∂p/∂s|)`, with
//! `∂p/∂φ × ∂p/∂s = −ρρ′ a×b + ρζ′(cos φ b×c + sin φ c×a)`: the same everywhere for round ones.

use std::f32::consts::TAU;

use glam::{DMat3, DVec3};

use super::area::Point;
use crate::{
    math::{Bounds, Vec2, Vec3, rounding::gamma},
    shape::{Cylinder, Disk, Sphere},
};

/// What turns round the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Profile {
    /// A line along the axis.
    Cylinder,
    /// A line across it.
    Disk,
    /// Part of a circle.
    Sphere,
}

impl Profile {
    /// ρ and ζ.
    fn at(self, s: f32) -> [f32; 2] {
        match self {
            Self::Cylinder => [1.0, s],
            Self::Disk => [s.max(0.0).sqrt(), 0.0],
            Self::Sphere => [(1.0 - s * s).max(0.0).sqrt(), s],
        }
    }

    /// −ρρ′ and ρζ′.
    fn slope(self, s: f32) -> [f32; 2] {
        match self {
            Self::Cylinder => [0.0, 1.0],
            Self::Disk => [-0.5, 0.0],
            Self::Sphere => [s, (1.0 - s * s).max(0.0).sqrt()],
        }
    }
}

/// A surface of revolution that shines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Revolved {
    profile: Profile,
    centre: Vec3,
    /// Half-axes [length].
    a: Vec3,
    b: Vec3,
    c: Vec3,
    /// Least and greatest s \[1\].
    s: [f32; 2],
    /// Greatest φ [rad].
    phi: f32,
    /// −1 where the side that shines is not that of `∂p/∂φ × ∂p/∂s`.
    sign: f32,
    area: f32,
}

impl Revolved {
    /// A cylinder, or some of the way round one.
    pub fn cylinder(c: &Cylinder) -> Self {
        Self::new(Profile::Cylinder, c.base, [c.a, c.b, c.axis], [0.0, 1.0], c.turn.radians()).facing(c.reversed)
    }

    /// A disk or a ring, or some of the way round one.
    pub fn disk(d: &Disk) -> Self {
        let s = [d.inner * d.inner, 1.0];
        // ∂p/∂φ × ∂p/∂s is turned against a × b.
        Self {
            sign: if d.reversed { 1.0 } else { -1.0 },
            ..Self::new(Profile::Disk, d.centre, [d.a, d.b, d.normal()], s, d.turn.radians())
        }
    }

    /// A sphere or an ellipsoid, or a part of one.
    pub fn sphere(sphere: &Sphere) -> Self {
        let (centre, axes) = sphere.axes();
        let part = sphere.part;
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::as_vec3);
        Self::new(Profile::Sphere, centre.as_vec3(), axes, part.z.map(|z| z as f32), part.turn.radians())
            .facing(sphere.reversed)
    }

    fn new(profile: Profile, centre: Vec3, [a, b, c]: [Vec3; 3], s: [f32; 2], phi: f64) -> Self {
        let mut it = Self { profile, centre, a, b, c, s, phi: phi as f32, sign: 1.0, area: 0.0 };
        it.area = it.measured();
        it
    }

    /// Shining outward, or else inward.
    fn facing(self, inward: bool) -> Self {
        let mirrored = self.a.cross(self.b).dot(self.c) < 0.0;
        Self { sign: if inward == mirrored { 1.0 } else { -1.0 }, ..self }
    }

    /// Area [length²].
    pub fn area(&self) -> f32 {
        self.area
    }

    /// By the midpoint rule, which is exact for round ones.
    fn measured(&self) -> f32 {
        const N: usize = 64;
        let step = |i: usize, [low, high]: [f32; 2]| low + (high - low) * (i as f32 + 0.5) / N as f32;
        let cells = (0..N * N).map(|i| self.stretch(step(i % N, [0.0, self.phi]), step(i / N, self.s)));
        (cells.map(f64::from).sum::<f64>() / (N * N) as f64) as f32 * self.parameters()
    }

    /// Δφ Δs.
    fn parameters(&self) -> f32 {
        self.phi * (self.s[1] - self.s[0])
    }

    /// `∂p/∂φ × ∂p/∂s` [length²].
    fn normal_at(&self, phi: f32, s: f32) -> Vec3 {
        let [along, across] = self.profile.slope(s);
        let (sin, cos) = phi.sin_cos();
        self.a.cross(self.b) * along + (self.b.cross(self.c) * cos + self.c.cross(self.a) * sin) * across
    }

    fn stretch(&self, phi: f32, s: f32) -> f32 {
        self.normal_at(phi, s).length()
    }

    /// The side that shines, if it is flat.
    pub(super) fn normal(&self) -> Option<Vec3> {
        (self.profile == Profile::Disk).then(|| (self.normal_at(0.0, 1.0) * self.sign).normalize_or_zero())
    }

    /// Its middle, roughly [length].
    pub(super) fn centre(&self) -> Vec3 {
        let [_, zeta] = self.profile.at(0.5 * (self.s[0] + self.s[1]));
        self.centre + self.c * zeta
    }

    /// The box around the whole of it.
    pub(super) fn bounds(&self) -> Bounds {
        let ring = self.a * self.a + self.b * self.b;
        let half = match self.profile {
            Profile::Sphere => (ring + self.c * self.c).map(f32::sqrt),
            Profile::Cylinder | Profile::Disk => ring.map(f32::sqrt),
        };
        let half = half * (1.0 + gamma(8));
        let far = if self.profile == Profile::Cylinder { self.centre + self.c } else { self.centre };
        Bounds { min: self.centre.min(far) - half, max: self.centre.max(far) + half }
    }

    /// A point, uniform in φ and s.
    pub(super) fn sample(&self, u: Vec2) -> Point {
        let (phi, s) = (u.x * self.phi, self.s[0] + (self.s[1] - self.s[0]) * u.y);
        let [rho, zeta] = self.profile.at(s);
        let (sin, cos) = phi.sin_cos();
        let (x, y, z) = (self.a * (rho * cos), self.b * (rho * sin), self.c * zeta);
        Point {
            p: self.centre + x + y + z,
            ng: (self.normal_at(phi, s) * self.sign).normalize_or_zero(),
            error: (self.centre.abs() + self.a.abs() + self.b.abs() + self.c.abs()) * gamma(8),
        }
    }

    /// Density of [`Self::sample`] at a point of it [1/length²].
    pub(super) fn pdf(&self, p: Vec3) -> f32 {
        let axes = DMat3::from_cols(self.a.as_dvec3(), self.b.as_dvec3(), self.c.as_dvec3());
        let local = (axes.inverse() * (p.as_dvec3() - self.centre.as_dvec3())).as_vec3();
        let phi = local.y.atan2(local.x);
        let s = match self.profile {
            Profile::Cylinder => local.z,
            Profile::Disk => local.truncate().length_squared(),
            Profile::Sphere => (local.z / local.length()).clamp(-1.0, 1.0),
        };
        let stretch = self.stretch(phi.rem_euclid(TAU), s);
        if stretch > 0.0 { 1.0 / (self.parameters() * stretch) } else { 0.0 }
    }
}
