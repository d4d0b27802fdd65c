//! Directions to a triangle, uniform in the solid angle that it covers from a point.
//!
//! The density is 1/Ω over directions. The first number cuts the spherical triangle ABC by an arc from B to a point C′ of
//! the side AC, so that the part ABC′ has the share E = u₀ Ω; the second is uniform in the height along that arc. With
//! α the angle at A,
//!
//! ```text
//! tan(Ω/2)   = a·(b × c) / (1 + a·b + b·c + c·a)
//! tan(AC′/2) = sin(E/2) / (tan(AB/2) sin(α − E/2))
//! ```
//!
//! Both keep their relative precision for small triangles (Arvo's own formula for C′ takes differences of cosines, and
//! fails there). The vertex with the angle nearest to π/2 is taken as A.
//!
//! Sources: Arvo 1995, "Stratified Sampling of Spherical Triangles"; Van Oosterom and Strackee 1983 (Ω); the second line is
//! Todhunter 1886, section 103, `tan(E/2) = tan(x/2) tan(y/2) sin α / (1 + tan(x/2) tan(y/2) cos α)` for the excess of a
//! triangle with sides x, y about the angle α, solved for a side. All in double precision.

use std::f64::consts::PI;

use glam::DVec3;

use crate::math::{Vec2, Vec3};

/// Below this solid angle [sr] cancellation would move samples by more than 10⁻⁶ of the triangle.
pub const MIN_SOLID_ANGLE: f64 = 1e-9;
/// Above this solid angle [sr] the point lies nearly in the triangle, whose sides then run along one great circle.
pub const MAX_SOLID_ANGLE: f64 = 6.25;
/// A triangle as seen from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalTriangle {
    /// The solid angle [sr].
    pub solid_angle: f32,
    /// Ω in full precision.
    omega: f64,
    /// Vertices relative to the point, A first.
    vertices: [DVec3; 3],
    /// How often the user's vertices were rotated to bring A first.
    rotation: usize,
    /// Unit vectors to A and B, and the unit tangent at A towards C.
    a: DVec3,
    b: DVec3,
    towards_c: DVec3,
    /// The angle at A [rad].
    alpha: f64,
    /// tan(AB/2).
    tan_half_ab: f64,
}

impl SphericalTriangle {
    /// The triangle `p0 p1 p2`, of either orientation, seen from `from`.
    ///
    /// `None` when the solid angle is not within [`MIN_SOLID_ANGLE`] and [`MAX_SOLID_ANGLE`] (degenerate, edge on, or all around the point): the caller then samples by area, and must take the
    /// density of that for MIS too.
    pub fn new(p0: Vec3, p1: Vec3, p2: Vec3, from: Vec3) -> Option<Self> {
        Self::around([p0, p1, p2].map(|p| p.as_dvec3() - from.as_dvec3()))
    }

    /// The triangle as seen from the origin.
    fn around(vertices: [DVec3; 3]) -> Option<Self> {
        // Normals of the sides' planes, from the edges: unit vectors to a small triangle are nearly equal.
        let normals = [0, 1, 2].map(|i| vertices[i].cross(vertices[(i + 1) % 3] - vertices[i]).normalize());
        let sin_cos = |i: usize| {
            let (before, after) = (-normals[(i + 2) % 3], normals[i]);
            (after.cross(before).length(), after.dot(before))
        };
        let rotation = (0..3).max_by(|&i, &j| sin_cos(i).0.total_cmp(&sin_cos(j).0))?;
        let (sin_alpha, cos_alpha) = sin_cos(rotation);
        let vertices = [0, 1, 2].map(|i| vertices[(rotation + i) % 3]);
        let [a, b, c] = vertices.map(DVec3::normalize);

        let denominator = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        let omega = if denominator > 0.1 {
            let [v0, v1, v2] = vertices;
            let triple = v0.dot((v1 - v0).cross(v2 - v0)).abs() / (v0.length() * v1.length() * v2.length());
            2.0 * triple.atan2(denominator)
        } else {
            // Vertices nearly opposite: the sum of the angles less π (Girard) is the better conditioned.
            (0..3).map(|i| sin_cos(i).0.atan2(sin_cos(i).1)).sum::<f64>() - PI
        };
        ((MIN_SOLID_ANGLE..=MAX_SOLID_ANGLE).contains(&omega)).then_some(Self {
            solid_angle: omega as f32,
            omega,
            vertices,
            rotation,
            a,
            b,
            towards_c: a.cross(normals[(rotation + 2) % 3]),
            alpha: sin_alpha.atan2(cos_alpha),
            tan_half_ab: vertices[0].cross(vertices[1] - vertices[0]).length()
                / (0.5 * vertices[0].length() * vertices[1].length() * (a + b).length_squared()),
        })
    }

    /// A direction (unit) and the barycentric coordinates of the point of the triangle that it meets.
    pub fn sample(&self, u: Vec2) -> (Vec3, [f32; 3]) {
        let b = self.b;
        let cut = self.cut(f64::from(u.x));
        // Uniform in 1 − cos of the distance from B.
        let chord = cut - b;
        let h = 0.5 * f64::from(u.y) * chord.length_squared();
        let towards_cut = (chord - chord.dot(b) * b).normalize_or_zero();
        let dir = (1.0 - h) * b + (h * (2.0 - h)).max(0.0).sqrt() * towards_cut;
        (dir.as_vec3(), self.barycentric(dir))
    }

    /// The point of the side AC at which an arc from B cuts off the share `u` of the solid angle, on A's side.
    fn cut(&self, u: f64) -> DVec3 {
        let half_excess = 0.5 * u * self.omega;
        let y = half_excess.sin() / (self.tan_half_ab * (self.alpha - half_excess).sin());
        // cos AC′ and sin AC′ by the tangent of the half.
        ((1.0 - y * y) * self.a + 2.0 * y * self.towards_c) / (1.0 + y * y)
    }

    /// The density of a sampled direction [1/sr].
    pub fn pdf(&self) -> f32 {
        (1.0 / self.omega) as f32
    }

    /// Where the ray along `dir` meets the triangle: the volumes of the three tetrahedra, clamped against rounding.
    fn barycentric(&self, dir: DVec3) -> [f32; 3] {
        let [p0, p1, p2] = self.vertices;
        let volumes = [p1.cross(p2).dot(dir), p2.cross(p0).dot(dir), p0.cross(p1).dot(dir)];
        let sign = (volumes[0] + volumes[1] + volumes[2]).signum();
        let inside = volumes.map(|v| (v * sign).max(0.0));
        let sum: f64 = inside.iter().sum();
        let rotated = inside.map(|v| (v / sum) as f32);
        std::array::from_fn(|i| rotated[(i + 3 - self.rotation) % 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The octant of the sphere is an eighth of 4π.
    #[test]
    fn an_octant_covers_an_eighth_of_the_sphere() {
        for (p, q) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::X)] {
            let t = SphericalTriangle::new(p, q, Vec3::Z, Vec3::ZERO).unwrap();
            assert!((f64::from(t.solid_angle) - PI / 2.0).abs() < 1e-7);
        }
    }

    #[test]
    fn a_distant_triangle_covers_area_times_cosine_over_distance_squared() {
        for distance in [1e2f32, 1e3, 1e4] {
            let z = Vec3::new(0.0, 0.0, distance);
            let t = SphericalTriangle::new(z, z + Vec3::X, z + Vec3::Y, Vec3::ZERO).unwrap();
            let far = 0.5 / (distance * distance);
            assert!((t.solid_angle / far - 1.0).abs() < 1e-4, "{distance}");
        }
    }

    #[test]
    fn a_triangle_seen_edge_on_or_from_within_its_plane_is_refused() {
        let new = |p0, p1, p2| SphericalTriangle::new(p0, p1, p2, Vec3::ZERO);
        assert_eq!(new(Vec3::X, 2.0 * Vec3::X, Vec3::X + Vec3::Y), None);
        assert_eq!(new(Vec3::X, Vec3::new(-1.0, 1.0, 0.0), Vec3::new(-1.0, -1.0, 0.0)), None);
        assert_eq!(new(Vec3::Z, Vec3::Z, Vec3::Z + Vec3::X), None);
        assert_eq!(new(Vec3::ZERO, Vec3::Z, Vec3::Z + Vec3::X), None);
        assert_eq!(new(Vec3::NAN, Vec3::Z, Vec3::X), None);
    }

    /// The triangle between A, B and the cut at u must cover uΩ: over seven decades of size and ten of distance.
    #[test]
    fn a_cut_leaves_its_share_of_the_solid_angle_on_one_side() {
        let mut stream = testkit::Stream::new(1);
        for _ in 0..100_000 {
            let mut axis = || 10f64.powf(-4.0 + 7.0 * stream.next_f64()) * (stream.next_f64() - 0.5).signum();
            let corner = DVec3::new(axis(), axis(), axis());
            let vertices = [DVec3::ZERO, DVec3::new(axis(), axis(), axis()), DVec3::new(axis(), axis(), axis())];
            let Some(t) = SphericalTriangle::around(vertices.map(|v| v + corner)) else { continue };
            let u = stream.next_f64();
            let Some(part) = SphericalTriangle::around([t.a, t.b, t.cut(u)]) else { continue };
            let error = (part.omega / t.omega - u).abs();
            // 1.3e-9 is the worst that was measured.
            assert!(error < 1e-8, "{t:?} cut at {u}: {error}");
        }
    }

    /// The direction and the point must be the same, also for small, thin and grazing triangles.
    #[test]
    fn the_direction_points_at_the_barycentric_point() {
        for height in [1.0f32, 1e-2, 1e-4] {
            for size in [1e-3f32, 1.0, 1e3] {
                let p = [
                    Vec3::new(0.2, 0.1, height),
                    Vec3::new(0.2 + size, 0.1, height),
                    Vec3::new(0.2, 0.1 + 0.1 * size, 2.0 * height),
                ];
                let Some(t) = SphericalTriangle::new(p[0], p[1], p[2], Vec3::ZERO) else { continue };
                for i in 0..=32 {
                    let (dir, b) = t.sample(Vec2::new(i as f32 / 32.0, (i * 7 % 33) as f32 / 32.0));
                    let point = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
                    assert!((point.normalize() - dir).length() < 1e-5, "{height} {size} {i}: {point} {dir} {b:?}");
                }
            }
        }
    }
}
