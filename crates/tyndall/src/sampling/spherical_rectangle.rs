//! Points of a rectangle, uniform in the solid angle that it covers from a point.
//!
//! Light sampling by area wastes samples on far and grazing parts; here every sample carries the same cosine-free weight:
//! the density is 1/Ω over directions. Ω is the sum of the four interior angles of the spherical quadrilateral less 2π;
//! the first number fixes the strip of the rectangle that cuts off the share u₀ of Ω, the second the height on it.
//!
//! Source: Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles". All in double
//! precision, since Ω is a difference of angles near π/2: its absolute error is about 10⁻¹⁵.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::math::{Vec2, Vec3};

/// Below this solid angle [sr] its relative error would exceed 10⁻⁶, and sampling by area is as good.
pub const MIN_SOLID_ANGLE: f64 = 1e-9;

/// Between edges up to this cosine the corner is right.
const MAX_COSINE: f64 = 1e-5;

/// A rectangle as seen from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalRectangle {
    /// The solid angle [sr].
    pub solid_angle: f32,
    /// Ω in full precision.
    omega: f64,
    /// The rectangle in the frame of its edges: x₀, x₁, y₀, y₁, and z < 0.
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// A complex number whose argument is 2π less the two angles at the left edge.
    start: DVec2,
}

impl SphericalRectangle {
    /// The rectangle `corner + u·ex + v·ey` seen from `from`.
    ///
    /// `None` when `ex` and `ey` are not perpendicular, or when the solid angle is below [`MIN_SOLID_ANGLE`] or not finite (a
    /// degenerate rectangle, or one seen edge on): the caller then samples by area, and must take the density of that for MIS
    /// too.
    pub fn new(corner: Vec3, ex: Vec3, ey: Vec3, from: Vec3) -> Option<Self> {
        let (ex, ey) = (ex.as_dvec3(), ey.as_dvec3());
        let (width, height) = (ex.length(), ey.length());
        if ex.dot(ey).abs() > MAX_COSINE * (width * height) {
            return None;
        }
        let d = corner.as_dvec3() - from.as_dvec3();
        let z = -d.dot(ex.cross(ey) / (width * height)).abs();
        let (x0, y0) = (d.dot(ex) / width, d.dot(ey) / height);
        Self::in_frame([x0, x0 + width], [y0, y0 + height], z)
    }

    /// The angle between the planes through two neighbouring edges, which meet in the corner `(x, y, z)`, is the argument of
    /// `xy + i |z| |corner|` (its sign turned at two of the four corners). By arguments and not by arc cosines: at grazing
    /// incidence all planes nearly coincide, where those have no digits. The sum of angles is the argument of a product.
    fn in_frame(x: [f64; 2], y: [f64; 2], z: f64) -> Option<Self> {
        let corner = |x: f64, y: f64, sign: f64| DVec2::new(sign * x * y, z.abs() * (x * x + y * y + z * z).sqrt());
        let left = corner(x[0], y[0], -1.0).rotate(corner(x[0], y[1], 1.0));
        let right = corner(x[1], y[0], 1.0).rotate(corner(x[1], y[1], -1.0));
        let omega = excess(left, right);
        (omega >= MIN_SOLID_ANGLE && omega.is_finite() && z < 0.0).then_some(Self {
            solid_angle: omega as f32,
            omega,
            x,
            y,
            z,
            start: DVec2::new(left.x, -left.y),
        })
    }

    /// A point of the rectangle as fractions `(u, v)` of its edges, in [0, 1]².
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let Self { x, y, z, .. } = *self;
        let xu = self.cut(f64::from(u.x));
        let d2 = xu * xu + z * z;
        let h = [y[0] / (d2 + y[0] * y[0]).sqrt(), y[1] / (d2 + y[1] * y[1]).sqrt()];
        let hv = h[0] + f64::from(u.y) * (h[1] - h[0]);
        let yv = (hv * (d2 / (1.0 - hv * hv)).sqrt()).clamp(y[0], y[1]);
        Vec2::new(((xu - x[0]) / (x[1] - x[0])) as f32, ((yv - y[0]) / (y[1] - y[0])) as f32)
    }

    /// The x to whose left the share `u` of the solid angle lies.
    ///
    /// With b₀ and b₁ the z of the normals of the lower and upper planes, and φ = uΩ + 2π less the two angles at the left
    /// edge, the paper has `f = (b₀ cos φ − b₁)/sin φ` and `x = |z| sign(f)/√(f² + b₀² − 1)`. At grazing incidence b₀, b₁
    /// and cos φ are ±1 nearly, so their distances from 1 are computed instead.
    fn cut(&self, u: f64) -> f64 {
        let Self { x, z, .. } = *self;
        // Mirrored if need be, so that the first of the two is the farther: b₀² − 1 is then the smaller term.
        let y = if self.y[0].abs() < self.y[1].abs() { [-self.y[1], -self.y[0]] } else { self.y };
        let DVec2 { x: cos, y: sin } = DVec2::from_angle(u * self.omega).rotate(self.start) / self.start.length();
        let length = [(y[0] * y[0] + z * z).sqrt(), (y[1] * y[1] + z * z).sqrt()];
        let inverse = [1.0 / length[0], 1.0 / length[1]];
        let (b0, b1) = (-y[0] * inverse[0], y[1] * inverse[1]);
        let below_one = |i: usize| z * z * inverse[i] / (length[i] + y[i].abs());
        let below_one = [below_one(0), below_one(1)];
        let cos_below_one = sin * sin / (1.0 + cos.abs());
        let difference = if cos * b0 * b1 > 0.0 {
            (below_one[1] - below_one[0] - cos_below_one * (1.0 - below_one[0])) * b1.signum()
        } else {
            cos * b0 - b1
        };
        // With both halves of the fraction multiplied by sin φ.
        let below = (difference * difference - (sin * z * inverse[0]).powi(2)).max(0.0).sqrt();
        (z * sin / below).copysign(difference * sin).clamp(x[0], x[1])
    }

    /// The density of the direction to a sampled point [1/sr].
    pub fn pdf(&self) -> f32 {
        (1.0 / self.omega) as f32
    }
}

/// The sum of the arguments of two complex numbers, each in [0, 2π), less 2π, where it is known to be in [0, 2π).
///
/// That of their product is the same but for a turn. What is negative is rounding, or above π: then both arguments are above
/// π, and one of them above 3π/2.
fn excess(a: DVec2, b: DVec2) -> f64 {
    let product = a.rotate(b);
    let angle = product.y.atan2(product.x);
    let is_large = a.y < 0.0 && b.y < 0.0 && (a.x >= 0.0 || b.x >= 0.0);
    if angle < 0.0 && is_large { angle + TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One face of a cube seen from its centre covers 4π/6.
    #[test]
    fn the_face_of_a_cube_covers_a_sixth_of_the_sphere() {
        let r = SphericalRectangle::new(Vec3::new(-1.0, -1.0, 1.0), 2.0 * Vec3::X, 2.0 * Vec3::Y, Vec3::ZERO).unwrap();
        assert!((f64::from(r.solid_angle) - std::f64::consts::TAU / 3.0).abs() < 1e-6);
    }

    /// A rectangle of sides a and b with one corner at the foot of the perpendicular of length h covers
    /// `arctan(ab / (h√(a² + b² + h²)))`, and one around the foot four times that: nearly a half-space, where h is small.
    #[test]
    fn a_rectangle_above_a_point_covers_its_closed_form_at_every_height() {
        for (a, b) in [(1.0f64, 1.0), (1.0, 0.03), (0.002, 1.0)] {
            for h in (-30..=12).map(|tenths| 10f64.powf(f64::from(tenths) * 0.3)) {
                let quarter = (a * b / (h * (a * a + b * b + h * h).sqrt())).atan();
                for ([x, y], covered) in [([0.0, 0.0], quarter), ([-a, -b], 4.0 * quarter), ([-a, 0.0], 2.0 * quarter)]
                {
                    let found = SphericalRectangle::in_frame([x, a], [y, b], -h);
                    let omega = found.map_or(0.0, |r| r.omega);
                    let expected = if covered < MIN_SOLID_ANGLE { 0.0 } else { covered };
                    assert!((omega - expected).abs() < 1e-14, "{a} {b} {h} from {x} {y}: {omega}, expected {covered}");
                }
            }
        }
    }

    /// Far away Ω = A cos θ/r², to order A/r².
    #[test]
    fn a_distant_rectangle_covers_area_times_cosine_over_distance_squared() {
        for distance in [1e2f32, 1e3, 1e4] {
            let corner = Vec3::new(-0.5, -0.5, distance);
            let r = SphericalRectangle::new(corner, Vec3::X, Vec3::Y, Vec3::ZERO).unwrap();
            let far = 1.0 / (distance * distance);
            assert!((r.solid_angle / far - 1.0).abs() < 1e-4, "{distance}: {}", r.solid_angle / far);
        }
        assert_eq!(SphericalRectangle::new(Vec3::new(0.0, 0.0, 1e6), Vec3::X, Vec3::Y, Vec3::ZERO), None);
    }

    #[test]
    fn a_rectangle_seen_edge_on_or_without_area_is_refused() {
        let new = |corner, ex, ey| SphericalRectangle::new(corner, ex, ey, Vec3::ZERO);
        assert_eq!(new(Vec3::new(1.0, 1.0, 0.0), Vec3::X, Vec3::Y), None);
        assert_eq!(new(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y), None);
        assert_eq!(new(Vec3::new(0.0, 0.0, 1.0), Vec3::ZERO, Vec3::Y), None);
        assert_eq!(new(Vec3::NAN, Vec3::X, Vec3::Y), None);
    }

    /// The strip left of the cut at u must cover uΩ, by the same formula for solid angles: over seven decades of size and
    /// ten of height, down to grazing angles of 10⁻⁹.
    #[test]
    fn a_cut_leaves_its_share_of_the_solid_angle_to_the_left() {
        let mut stream = testkit::Stream::new(1);
        for _ in 0..100_000 {
            let mut decade = |from: f64, to: f64| 10f64.powf(from + (to - from) * stream.next_f64());
            let x0 = -decade(-4.0, 3.0) * if decade(-1.0, 1.0) < 1.0 { 1.0 } else { -1.0 };
            let y0 = -decade(-4.0, 3.0) * if decade(-1.0, 1.0) < 1.0 { 1.0 } else { -1.0 };
            let (x, y) = ([x0, x0 + decade(-4.0, 3.0)], [y0, y0 + decade(-4.0, 3.0)]);
            let Some(r) = SphericalRectangle::in_frame(x, y, -decade(-6.0, 4.0)) else { continue };
            let u = stream.next_f64();
            let Some(strip) = SphericalRectangle::in_frame([x[0], r.cut(u)], y, r.z) else { continue };
            let error = (strip.omega / r.omega - u).abs();
            // 2.6e-7 is the worst that was measured.
            assert!(error < 2e-6, "{r:?} cut at {u}: {error}");
        }
    }

    #[test]
    fn samples_of_grazing_and_tiny_rectangles_stay_inside() {
        for height in [1.0f32, 1e-2, 1e-4, 1e-6] {
            for size in [1e-3f32, 1.0, 1e3] {
                let corner = Vec3::new(-0.3 * size, 0.1, height);
                let Some(r) = SphericalRectangle::new(corner, size * Vec3::X, size * Vec3::Y, Vec3::ZERO) else {
                    continue;
                };
                for i in 0..=32 {
                    let uv = r.sample(Vec2::new(i as f32 / 32.0, 1.0 - i as f32 / 32.0));
                    assert!(uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all(), "{height} {size}: {uv}");
                }
            }
        }
    }
}
