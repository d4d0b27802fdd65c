//! A bilinear patch as an emitter.
//!
//! Its normal `N = ∂p/∂u × ∂p/∂v` is linear in u and in v: the quadratic term is a vector times itself. `(u, v)` is drawn
//! with a density `p(u, v)` that is bilinear between `|N|` at the corners, so that points are nearly uniform in area; their
//! density `p(u, v) / |N(u, v)|` is exact.
//!
//! For the same reason the normals of all points lie in the hull of those at the corners, and so in any cone around them.

use std::f32::consts::FRAC_PI_2;

use glam::DVec3;

use crate::{
    math::{Ray, Vec2, Vec3, rounding::gamma},
    shape::Patch,
};

/// Wider cones of normals are of no use, and their hull may hold anything.
const WIDEST: f32 = 0.95 * FRAC_PI_2;
/// Nodes and weights of Gauss and Legendre on [0, 1].
const NODES: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Panels a side of the integral of the area.
const PANELS: u32 = 16;

impl Patch {
    /// Its area [length²].
    pub(crate) fn area(&self) -> f32 {
        let places = || (0..PANELS).flat_map(|i| NODES.map(|(x, w)| ((f64::from(i) + x) / f64::from(PANELS), w)));
        let row = |v: f64| places().map(|(u, w)| w * self.normal(u, v).length()).sum::<f64>();
        (places().map(|(v, w)| w * row(v)).sum::<f64>() / f64::from(PANELS * PANELS)) as f32
    }

    /// Its area by the corners alone [length²].
    pub(crate) fn rough_area(&self) -> f32 {
        0.25 * self.corner_weights().iter().sum::<f32>()
    }

    /// A cone that holds all its normals: axis and half angle [rad]; `None` if they point almost everywhere.
    pub(crate) fn normals(&self) -> Option<(Vec3, f32)> {
        let corners = self.corner_normals().map(|n| n.normalize_or_zero().as_vec3());
        let axis = corners.iter().sum::<Vec3>().try_normalize()?;
        let widest = corners.iter().map(|n| n.dot(axis)).fold(1.0, f32::min).acos();
        (widest < WIDEST && corners.iter().all(|n| *n != Vec3::ZERO)).then_some((axis, widest))
    }

    /// A point, its normal and a bound on its rounding error [length].
    pub(crate) fn sample_area(&self, u: Vec2) -> (Vec3, Vec3, Vec3) {
        let [w00, w10, w01, w11] = self.corner_weights();
        let y = linear(u.y, w00 + w10, w01 + w11);
        let x = linear(u.x, w00 + (w01 - w00) * y, w10 + (w11 - w10) * y);
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let (u, v) = (f64::from(x), f64::from(y));
        let p = p00.lerp(p10, u).lerp(p01.lerp(p11, u), v).as_vec3();
        let error = self.corners.iter().fold(Vec3::ZERO, |most, corner| most.max(corner.abs())) * gamma(2);
        (p, self.normal(u, v).normalize_or_zero().as_vec3(), error)
    }

    /// Density of [`Self::sample_area`] at a point of normal `ng` [1/length²].
    pub(crate) fn pdf_area(&self, p: Vec3, ng: Vec3) -> f32 {
        let Some([u, v]) = self.parameters(p, ng) else { return 0.0 };
        let [w00, w10, w01, w11] = self.corner_weights().map(f64::from);
        let low = w00 + (w10 - w00) * u;
        let high = w01 + (w11 - w01) * u;
        let density = 4.0 * (low + (high - low) * v) / (w00 + w10 + w01 + w11);
        (density / self.normal(u, v).length()) as f32
    }

    /// `(u, v)` of a point of normal `ng`: where the line along the normal passes the patch nearest to it.
    fn parameters(&self, p: Vec3, ng: Vec3) -> Option<[f64; 2]> {
        let size = (self.corners[3] - self.corners[0]).length();
        let within = |[_, u, v]: &[f64; 3]| [u, v].iter().all(|x| (-1e-4..=1.0 + 1e-4).contains(*x));
        let crossings = self.crossings(&Ray::new(p, ng)).into_iter().flatten().filter(within);
        let nearest = crossings.min_by(|a, b| a[0].abs().total_cmp(&b[0].abs()))?;
        (nearest[0].abs() <= 1e-2 * f64::from(size)).then(|| [nearest[1], nearest[2]].map(|x| x.clamp(0.0, 1.0)))
    }

    /// `∂p/∂u × ∂p/∂v`, to the side that it faces.
    fn normal(&self, u: f64, v: f64) -> DVec3 {
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let dpdu = (p10 - p00).lerp(p11 - p01, v);
        let dpdv = (p01 - p00).lerp(p11 - p10, u);
        if self.reversed { dpdv.cross(dpdu) } else { dpdu.cross(dpdv) }
    }

    fn corner_normals(&self) -> [DVec3; 4] {
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| self.normal(u, v))
    }

    /// `|N|` at the corners, each at least a hundredth of the greatest: nothing is without density.
    fn corner_weights(&self) -> [f32; 4] {
        let lengths = self.corner_normals().map(|n| n.length() as f32);
        let most = lengths.into_iter().fold(f32::MIN_POSITIVE, f32::max);
        lengths.map(|length| length.max(0.01 * most))
    }
}

/// A number in [0, 1] whose density rises from `a` at 0 to `b` at 1, both positive.
fn linear(u: f32, a: f32, b: f32) -> f32 {
    (u * (a + b) / (a + (a * a + (b * b - a * a) * u).max(0.0).sqrt())).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A saddle `z = xy` over the unit square has the area `∫∫ √(1 + x² + y²) dx dy` = 1.280789...; its normals are within
    /// the cone of its corners, and the parameters of every point are found again.
    #[test]
    fn a_saddle_has_its_area_its_normals_and_its_parameters() {
        let saddle = Patch::new([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE]);
        let n = 400;
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let places = (0..n).flat_map(|i| (0..n).map(move |j| (middle(i), middle(j))));
        let area = places.map(|(x, y)| (1.0 + x * x + y * y).sqrt()).sum::<f64>() / f64::from(n * n);
        assert!((f64::from(saddle.area()) / area - 1.0).abs() < 1e-6, "{} {area}", saddle.area());
        let (axis, theta) = saddle.normals().unwrap();
        for i in 0..=20 {
            for j in 0..=20 {
                let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                let ng = saddle.normal(u, v).normalize().as_vec3();
                assert!(ng.angle_between(axis) <= theta + 1e-3);
                let p = Vec3::new(u as f32, v as f32, (u * v) as f32);
                let [a, b] = saddle.parameters(p, ng).unwrap();
                assert!((a - u).abs() < 1e-5 && (b - v).abs() < 1e-5, "({u}, {v}): ({a}, {b})");
            }
        }
    }
}
