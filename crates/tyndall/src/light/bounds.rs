//! What a light, or a group of lights, can do at most: where it is, where to it shines, and how much.
//!
//! Conty Estevez and Kulla 2018, "Importance sampling of many lights with adaptive tree splitting", § 4.1–4.4: a box, a
//! cone that holds the normals (half angle θ_o), and how far from its normal each point shines (θ_e).

use std::f32::consts::{FRAC_PI_2, PI};

use super::{EmitterShape, Goniometric, Light};
use crate::math::{Bounds, Vec3};

/// Bounds on a group of lights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightBounds {
    /// Where they are [length].
    pub bounds: Bounds,
    /// Axis of the cone of normals.
    pub axis: Vec3,
    /// Its half angle θ_o [rad].
    pub theta_o: f32,
    /// The farthest from a normal that any of them shines, θ_e [rad].
    pub theta_e: f32,
    /// Luminance of the intensity along the normals, summed [W·sr⁻¹].
    pub intensity: f32,
    /// Whether their backs shine too.
    pub two_sided: bool,
}

impl LightBounds {
    /// Of one light; `None` for lights without a place.
    pub fn of(light: &Light) -> Option<Self> {
        let bounds = light.bounds()?;
        let everywhere =
            Self { bounds, axis: Vec3::Z, theta_o: PI, theta_e: FRAC_PI_2, intensity: 0.0, two_sided: false };
        Some(match light {
            Light::Area(l) => {
                let intensity = l.luminance * l.shape.projected_area();
                match normals(&l.shape) {
                    Some((axis, theta_o)) => Self { axis, theta_o, intensity, two_sided: l.two_sided, ..everywhere },
                    None => Self { intensity, ..everywhere },
                }
            }
            Light::Beam(l) => match normals(&l.shape) {
                Some((axis, theta_o)) => {
                    let intensity = l.luminance * l.shape.area();
                    Self { axis, theta_o, theta_e: 0.0, intensity, ..everywhere }
                }
                None => return None,
            },
            Light::Goniometric(l) => {
                let mean = Goniometric::mean_share(&l.shares) as f32;
                Self { intensity: l.luminance * mean, ..everywhere }
            }
            Light::Projector(l) => {
                let axis = l.slide.to_world.matrix.z_axis.truncate();
                let theta_e = l.cos_corner().acos();
                Self { axis, theta_o: 0.0, theta_e, intensity: l.luminance, ..everywhere }
            }
            Light::Point(l) => Self { intensity: l.luminance, ..everywhere },
            Light::Spot(l) => {
                let theta_o = l.cos_inner.acos();
                let theta_e = (l.cos_outer.acos() - theta_o).max(0.0);
                Self { axis: l.axis, theta_o, theta_e, intensity: l.luminance, ..everywhere }
            }
            Light::Distant(_) | Light::Constant(_) | Light::Map(_) | Light::Portal(_) => return None,
        })
    }

    /// Of both groups together.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        // The back of a two-sided light is as good as its front.
        let flip = self.two_sided && other.two_sided && self.axis.dot(other.axis) < 0.0;
        let (axis, theta_o) =
            cone_around([(self.axis, self.theta_o), (if flip { -other.axis } else { other.axis }, other.theta_o)]);
        Self {
            bounds: self.bounds.union(other.bounds),
            axis,
            theta_o,
            theta_e: self.theta_e.max(other.theta_e),
            intensity: self.intensity + other.intensity,
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// How badly a group of them is described by its bounds: intensity times the square of its size times the measure of
    /// the directions that it shines to (eq. 1 and 2 of the paper, with a size that is positive on lines too).
    pub fn cost(&self) -> f32 {
        let (o, e) = (self.theta_o, self.theta_e);
        let w = (o + e).min(PI);
        let rim = 2.0 * w * o.sin() - (o - 2.0 * w).cos() - 2.0 * o * o.sin() + o.cos();
        let directions = 2.0 * PI * (1.0 - o.cos()) + FRAC_PI_2 * rim;
        self.intensity * self.bounds.extent().length_squared() * directions.max(0.0)
    }
}

/// A cone that holds the normals of a surface: its axis and its half angle. `None` for a surface that faces all sides, and for
/// a triangle without area, which has no normal.
fn normals(shape: &EmitterShape) -> Option<(Vec3, f32)> {
    if let EmitterShape::Patch(patch) = shape {
        return patch.normals();
    }
    shape.normal().filter(|axis| *axis != Vec3::ZERO).map(|axis| (axis, 0.0))
}

/// The narrowest cone around two.
fn cone_around([a, b]: [(Vec3, f32); 2]) -> (Vec3, f32) {
    let (wide, narrow) = if a.1 >= b.1 { (a, b) } else { (b, a) };
    let between = wide.0.cross(narrow.0).length().atan2(wide.0.dot(narrow.0));
    if between + narrow.1 <= wide.1 {
        return wide;
    }
    let theta = 0.5 * (wide.1 + between + narrow.1);
    // Rounding must not leave a normal outside: the cosines of hierarchy.rs allow for a thousandth.
    if theta >= PI {
        return (wide.0, PI);
    }
    let across = (narrow.0 - wide.0 * wide.0.dot(narrow.0)).normalize_or(wide.0.any_orthonormal_vector());
    let (sin, cos) = (theta - wide.1).sin_cos();
    ((wide.0 * cos + across * sin).normalize(), theta)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cone around two cones holds the rim of both, and one of the two rims touches it on either side: its width is
    /// half of all that it spans.
    #[test]
    fn the_cone_around_two_cones_holds_both_and_is_no_wider() {
        let directions = [Vec3::Z, Vec3::X, -Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, -0.6)];
        for a in directions {
            for b in directions {
                for (ta, tb) in [(0.0, 0.0), (0.3, 0.1), (1.0, 2.0), (PI, 0.5)] {
                    let (axis, theta) = cone_around([(a, ta), (b, tb)]);
                    let needed = |d: Vec3, t: f32| axis.angle_between(d) + t;
                    let widest = needed(a, ta).max(needed(b, tb));
                    assert!(
                        theta >= PI || (widest - theta).abs() < 1e-3,
                        "{a} {ta} {b} {tb}: {theta}, needed {widest}"
                    );
                }
            }
        }
    }

    /// A flat lamp shines over a hemisphere of normals' surroundings, a point over all directions: 2π of either the cone
    /// or the rim. Eq. 1 gives π for (0, π/2) and 4π for (π, π/2).
    #[test]
    fn the_measure_of_directions_is_that_of_the_paper() {
        let bounds = Bounds::of([Vec3::ZERO, Vec3::X]);
        let lamp =
            LightBounds { bounds, axis: Vec3::Z, theta_o: 0.0, theta_e: FRAC_PI_2, intensity: 1.0, two_sided: false };
        assert!((lamp.cost() - PI).abs() < 1e-5, "{}", lamp.cost());
        let point = LightBounds { theta_o: PI, ..lamp };
        assert!((point.cost() - 4.0 * PI).abs() < 1e-4, "{}", point.cost());
    }
}
