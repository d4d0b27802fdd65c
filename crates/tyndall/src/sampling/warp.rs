//! From the unit square to directions and surfaces.
//!
//! Every function takes `u` in [0, 1)² and has its density beside it. Directions are unit vectors in a local frame whose
//! axis is z. The maps are continuous but for seams, so that stratified numbers give stratified directions.
//!
//! | sampler | density |
//! |---|---|
//! | [`uniform_sphere`] | 1/4π |
//! | [`uniform_hemisphere`] | 1/2π for z ≥ 0 |
//! | [`cosine_hemisphere`] | z/π for z ≥ 0 |
//! | [`concentric_disk`] | 1/π on the unit disk |
//! | [`Cone`], [`uniform_cone`] | 1/(2π (1 − cos θ_max)) |
//! | [`triangle`] | 1/area |
//!
//! Sources: Shirley and Chiu 1997 (disk); Malley (cosine: the disk lifted to the hemisphere); Heitz 2019, "A
//! low-distortion map between triangle and square"; Pharr, Jakob and Humphreys 2023, appendix A.5.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, TAU};

use crate::math::{Vec2, Vec3};

/// A direction, uniform over the sphere: `z = 1 − 2u₀`.
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    // sin θ = √(1 − z²) without its cancellation at the poles.
    around_z(2.0 * (u.x * (1.0 - u.x)).sqrt(), 1.0 - 2.0 * u.x, u.y)
}

/// Density of [`uniform_sphere`] [1/sr].
pub fn uniform_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// A direction, uniform over the hemisphere z ≥ 0: `z = 1 − u₀`.
pub fn uniform_hemisphere(u: Vec2) -> Vec3 {
    around_z((u.x * (2.0 - u.x)).sqrt(), 1.0 - u.x, u.y)
}

/// Density of [`uniform_hemisphere`] [1/sr] for a direction of the given cos θ.
pub fn uniform_hemisphere_pdf(cos_theta: f32) -> f32 {
    if cos_theta >= 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
}

/// A direction of the hemisphere with density proportional to its cosine.
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = concentric_disk(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] [1/sr] for a direction of the given cos θ.
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// A point, uniform on the unit disk: concentric squares become concentric circles.
pub fn concentric_disk(u: Vec2) -> Vec2 {
    let p = 2.0 * u - Vec2::ONE;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if p.x.abs() > p.y.abs() { (p.x, FRAC_PI_4 * (p.y / p.x)) } else { (p.y, FRAC_PI_2 - FRAC_PI_4 * (p.x / p.y)) };
    radius * Vec2::from_angle(angle)
}

/// Density of [`concentric_disk`] [1/area].
pub fn concentric_disk_pdf() -> f32 {
    FRAC_1_PI
}

/// A direction, uniform within the cone around z of the given cosine. For narrow cones use [`Cone`].
pub fn uniform_cone(u: Vec2, cos_max: f32) -> Vec3 {
    Cone { one_minus_cos: 1.0 - cos_max }.sample(u)
}

/// Density of [`uniform_cone`] [1/sr] inside of the cone.
pub fn uniform_cone_pdf(cos_max: f32) -> f32 {
    Cone { one_minus_cos: 1.0 - cos_max }.pdf()
}

/// A cone around z, held by `1 − cos θ_max` so that the sun, or a lamp far away, keeps its digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// `1 − cos θ_max`, in (0, 2].
    pub one_minus_cos: f32,
}

impl Cone {
    /// The directions in which a sphere is seen: `sin θ_max = radius/distance` (of the centre).
    ///
    /// `None` from inside of the sphere, on its surface, or when it is too far to have a solid angle: sample it by area.
    pub fn of_sphere(radius: f32, distance: f32) -> Option<Self> {
        let sin = radius / distance;
        let sin2 = sin * sin;
        // 1 − cos = sin²/(1 + cos).
        let one_minus_cos = sin2 / (1.0 + (1.0 - sin2).sqrt());
        (sin2 < 1.0 && one_minus_cos >= f32::MIN_POSITIVE).then_some(Self { one_minus_cos })
    }

    /// A direction, uniform within the cone.
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let h = u.x * self.one_minus_cos;
        around_z((h * (2.0 - h)).max(0.0).sqrt(), 1.0 - h, u.y)
    }

    /// The density inside of the cone [1/sr].
    pub fn pdf(&self) -> f32 {
        1.0 / (TAU * self.one_minus_cos)
    }

    /// Whether a direction of the given sine and cosine to z lies inside.
    pub fn contains(&self, sin_theta: f32, cos_theta: f32) -> bool {
        // 1 − cos, for the front half without cancellation.
        let h = if cos_theta > 0.0 { sin_theta * sin_theta / (1.0 + cos_theta) } else { 1.0 - cos_theta };
        h <= self.one_minus_cos
    }
}

/// Barycentric coordinates, uniform on a triangle; its density is 1/area.
pub fn triangle(u: Vec2) -> [f32; 3] {
    let (b0, b1) = if u.x < u.y { (0.5 * u.x, u.y - 0.5 * u.x) } else { (u.x - 0.5 * u.y, 0.5 * u.y) };
    [b0, b1, (1.0 - b0 - b1).max(0.0)]
}

fn around_z(sin_theta: f32, cos_theta: f32, turn: f32) -> Vec3 {
    let (sin, cos) = (TAU * turn).sin_cos();
    Vec3::new(sin_theta * cos, sin_theta * sin, cos_theta)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [f32; 5] = [0.0, 1e-30, 0.5, 0.75, 0.999_999_94];

    #[test]
    fn directions_are_unit_vectors_at_the_corners_of_the_square_too() {
        for (x, y) in CORNERS.into_iter().flat_map(|x| CORNERS.map(|y| (x, y))) {
            let u = Vec2::new(x, y);
            for d in [uniform_sphere(u), uniform_hemisphere(u), cosine_hemisphere(u), uniform_cone(u, 0.9)] {
                assert!((d.length() - 1.0).abs() < 1e-6, "{u}: {d}");
            }
            assert!(concentric_disk(u).length() <= 1.000_001, "{u}");
            assert!(triangle(u).iter().all(|&b| (0.0..=1.0).contains(&b)), "{u}: {:?}", triangle(u));
        }
    }

    /// A sphere of radius 1 at distance 10⁶ has 1 − cos θ = 5e-13, which no single-precision cosine can hold.
    #[test]
    fn a_distant_sphere_keeps_its_solid_angle() {
        let cone = Cone::of_sphere(1.0, 1e6).unwrap();
        assert!((cone.one_minus_cos / 5e-13 - 1.0).abs() < 1e-6);
        let d = cone.sample(Vec2::new(0.999_999_94, 0.25));
        assert!((d.y / 1e-6 - 1.0).abs() < 1e-5, "{d}");
        assert!(cone.contains(0.999e-6, 1.0) && !cone.contains(1.001e-6, 1.0));
        assert_eq!(Cone::of_sphere(1.0, 1.0), None);
        assert_eq!(Cone::of_sphere(1.0, 0.5), None);
        assert_eq!(Cone::of_sphere(1e-30, 1e30), None);
        assert_eq!(Cone::of_sphere(1.0, f32::NAN), None);
    }
}
