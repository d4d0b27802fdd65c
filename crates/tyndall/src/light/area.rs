//! An emitting surface: radiance `L` from every point into the hemisphere of its normal (or both).
//!
//! Points are drawn uniformly in solid angle where a closed form exists (spheres by their cone; rectangles, Ureña et al.
//! 2013), else uniformly in area, with density `d² / (A |cos θ|)` per steradian.

use std::f32::consts::PI;

use super::{LightSample, Reference, Revolved, Target};
use crate::{
    math::{Bounds, Frame, Vec2, Vec3, rounding::gamma},
    sampling::{spherical_rectangle::SphericalRectangle, warp},
    spectrum::{Lanes, Spectrum, Wavelengths},
};

/// An emitting piece of surface.
#[derive(Debug, Clone)]
pub struct AreaLight {
    /// Where it is.
    pub shape: EmitterShape,
    /// Emitted radiance [W·m⁻²·sr⁻¹].
    pub radiance: Spectrum,
    /// Its luminance, for the choice of lights [W·m⁻²·sr⁻¹].
    pub luminance: f32,
    /// Whether the back shines too.
    pub two_sided: bool,
    /// How much of the surface is there \[1\]: the rest are holes. Of a surface that is not there at all the light remains,
    /// and only light sampling finds it (pbrt).
    pub opacity: f32,
}

/// The shapes that can emit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EmitterShape {
    /// `a`, `a + e1`, `a + e2`, with unit normal `ng`.
    Triangle {
        /// First corner [length].
        a: Vec3,
        /// Edge to the second corner [length].
        e1: Vec3,
        /// Edge to the third corner [length].
        e2: Vec3,
        /// The side that shines.
        ng: Vec3,
    },
    /// `a + u·e1 + v·e2`, `u, v ∈ [0, 1]`, with unit normal `ng`.
    Parallelogram {
        /// A corner [length].
        a: Vec3,
        /// An edge [length].
        e1: Vec3,
        /// The other edge [length].
        e2: Vec3,
        /// The side that shines.
        ng: Vec3,
    },
    /// A sphere; shines outward unless `inward`.
    Sphere {
        /// Centre [length].
        centre: Vec3,
        /// Radius [length].
        radius: f32,
        /// Whether the inside shines.
        inward: bool,
    },
    /// A flat ring or disk.
    Disk {
        /// Centre [length].
        centre: Vec3,
        /// The side that shines.
        ng: Vec3,
        /// Radius [length].
        radius: f32,
        /// Radius of the hole [length].
        inner: f32,
    },
    /// A cylinder, a part of a disk or of a sphere, an ellipsoid.
    Revolved(Revolved),
}

/// A point on an emitter: place, unit normal, bound on the rounding error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    pub(crate) p: Vec3,
    pub(crate) ng: Vec3,
    pub(crate) error: Vec3,
}

impl EmitterShape {
    /// Area [length²].
    pub fn area(&self) -> f32 {
        match *self {
            Self::Triangle { e1, e2, .. } => 0.5 * e1.cross(e2).length(),
            Self::Parallelogram { e1, e2, .. } => e1.cross(e2).length(),
            Self::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            Self::Disk { radius, inner, .. } => PI * (radius * radius - inner * inner),
            Self::Revolved(revolved) => revolved.area(),
        }
    }

    /// The greatest area that it shows to any side [length²].
    pub fn projected_area(&self) -> f32 {
        match *self {
            Self::Sphere { radius, .. } => PI * radius * radius,
            // Of a surface that bends round, no more than half faces one way.
            Self::Revolved(revolved) if revolved.normal().is_none() => 0.5 * revolved.area(),
            _ => self.area(),
        }
    }

    /// The side that shines, of a flat emitter.
    pub fn normal(&self) -> Option<Vec3> {
        match *self {
            Self::Triangle { ng, .. } | Self::Parallelogram { ng, .. } | Self::Disk { ng, .. } => Some(ng),
            Self::Revolved(revolved) => revolved.normal(),
            Self::Sphere { .. } => None,
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        match *self {
            Self::Triangle { a, e1, e2, .. } => Bounds::of([a, a + e1, a + e2]),
            Self::Parallelogram { a, e1, e2, .. } => Bounds::of([a, a + e1, a + e2, a + e1 + e2]),
            Self::Sphere { centre, radius, .. } => Bounds { min: centre - radius, max: centre + radius },
            Self::Disk { centre, radius, ng, .. } => {
                let reach = (Vec3::ONE - ng * ng).max(Vec3::ZERO).map(f32::sqrt) * radius;
                Bounds { min: centre - reach, max: centre + reach }
            }
            Self::Revolved(revolved) => revolved.bounds(),
        }
    }

    /// Which side of a flat emitter a point is on, as a height over its plane; `None` for a curved one.
    fn height(&self, p: Vec3) -> Option<f32> {
        match *self {
            Self::Triangle { a, ng, .. } | Self::Parallelogram { a, ng, .. } => Some((p - a).dot(ng)),
            Self::Disk { centre, ng, .. } => Some((p - centre).dot(ng)),
            Self::Revolved(revolved) => revolved.normal().map(|ng| (p - revolved.centre()).dot(ng)),
            Self::Sphere { .. } => None,
        }
    }

    fn centre(&self) -> Vec3 {
        match *self {
            Self::Triangle { a, e1, e2, .. } => a + (e1 + e2) / 3.0,
            Self::Parallelogram { a, e1, e2, .. } => a + (e1 + e2) * 0.5,
            Self::Sphere { centre, .. } | Self::Disk { centre, .. } => centre,
            Self::Revolved(revolved) => revolved.centre(),
        }
    }

    /// Uniform in area, or nearly so.
    pub(crate) fn sample_area(&self, u: Vec2) -> Point {
        match *self {
            Self::Triangle { a, e1, e2, ng } => {
                let [_, b1, b2] = warp::triangle(u);
                flat(a, e1 * b1, e2 * b2, ng)
            }
            Self::Parallelogram { a, e1, e2, ng } => flat(a, e1 * u.x, e2 * u.y, ng),
            Self::Sphere { centre, radius, inward } => {
                let n = warp::uniform_sphere(u);
                sphere_point(centre, radius, n, inward)
            }
            Self::Disk { centre, ng, radius, inner } => {
                let share = (inner / radius).powi(2);
                // Rings of equal area keep the concentric map's stratification.
                let d = warp::concentric_disk(u);
                let r2 = d.length_squared();
                let stretch = if r2 > 0.0 { ((share + (1.0 - share) * r2) / r2).sqrt() } else { 0.0 };
                let f = Frame::around(ng);
                flat(centre, f.s * (d.x * stretch * radius), f.t * (d.y * stretch * radius), ng)
            }
            Self::Revolved(revolved) => revolved.sample(u),
        }
    }

    /// Density of [`Self::sample_area`] at a point [1/length²].
    pub(crate) fn pdf_area(&self, p: Vec3) -> f32 {
        match self {
            Self::Revolved(revolved) => revolved.pdf(p),
            _ => 1.0 / self.area(),
        }
    }
}

/// `a + x + y` on a flat emitter, with its error bound: three roundings of each term.
fn flat(a: Vec3, x: Vec3, y: Vec3, ng: Vec3) -> Point {
    Point { p: a + x + y, ng, error: (a.abs() + x.abs() + y.abs()) * gamma(5) }
}

fn sphere_point(centre: Vec3, radius: f32, n: Vec3, inward: bool) -> Point {
    let ng = if inward { -n } else { n };
    Point { p: centre + n * radius, ng, error: (centre.abs() + Vec3::splat(radius)) * gamma(6) }
}

impl AreaLight {
    /// Radiance leaving a point with unit normal `ng` towards `dir` [W·m⁻²·sr⁻¹].
    #[inline]
    pub fn le(&self, ng: Vec3, dir: Vec3, wavelengths: &Wavelengths) -> Lanes {
        if self.two_sided || ng.dot(dir) > 0.0 { self.radiance.eval(wavelengths) } else { Lanes::ZERO }
    }

    /// A direction towards the emitter.
    #[inline]
    pub fn sample(&self, from: &Reference, u: Vec2, wavelengths: &Wavelengths) -> Option<LightSample> {
        if self.shape.height(from.p).is_some_and(|h| h == 0.0 || (h < 0.0 && !self.two_sided)) {
            return None;
        }
        let (point, pdf) = self.sample_point(from, u);
        let to_light = point.p - from.p;
        let d2 = to_light.length_squared();
        let dir = to_light / d2.sqrt();
        let shares = if self.opacity == 0.0 { 1.0 } else { self.opacity };
        let li = self.le(point.ng, -dir, wavelengths) * shares;
        (pdf > 0.0 && pdf.is_finite() && d2 > 0.0 && !li.is_zero()).then_some(LightSample {
            dir,
            li,
            pdf,
            dirac: self.opacity == 0.0,
            target: Target::Surface { p: point.p, error: point.error, ng: point.ng },
        })
    }

    /// A point and its density [1/sr].
    fn sample_point(&self, from: &Reference, u: Vec2) -> (Point, f32) {
        match self.shape {
            EmitterShape::Sphere { centre, radius, inward } if !inward => {
                let to_centre = centre - from.p;
                let d2 = to_centre.length_squared();
                if let Some(cos_max) = cone(d2, radius) {
                    return sample_cone(centre, radius, to_centre, d2, cos_max, u);
                }
            }
            EmitterShape::Parallelogram { a, e1, e2, ng } if is_rectangle(e1, e2) => {
                if let Some(rectangle) = SphericalRectangle::new(a, e1, e2, from.p) {
                    let uv = rectangle.sample(u);
                    return (flat(a, e1 * uv.x, e2 * uv.y, ng), rectangle.pdf());
                }
            }
            _ => {}
        }
        let point = self.shape.sample_area(u);
        let pdf = area_to_solid_angle(from.p, point.p, point.ng, self.shape.pdf_area(point.p));
        (point, pdf)
    }

    /// Density of [`Self::sample`] at a point with unit normal `ng` [1/sr].
    #[inline]
    pub fn pdf(&self, from: &Reference, p: Vec3, ng: Vec3) -> f32 {
        match self.shape {
            EmitterShape::Sphere { centre, radius, inward } if !inward => {
                if let Some(cos_max) = cone((centre - from.p).length_squared(), radius) {
                    return warp::uniform_cone_pdf(cos_max);
                }
            }
            EmitterShape::Parallelogram { a, e1, e2, .. } if is_rectangle(e1, e2) => {
                if let Some(rectangle) = SphericalRectangle::new(a, e1, e2, from.p) {
                    return rectangle.pdf();
                }
            }
            _ => {}
        }
        area_to_solid_angle(from.p, p, ng, self.shape.pdf_area(p))
    }

    /// A guess at the irradiance made at `p` [W·m⁻²]: zero only behind a one-sided flat emitter.
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let area = self.shape.area();
        let d2 = self.shape.centre().distance_squared(p).max(0.25 * area);
        let cosine = match self.shape.height(p) {
            Some(h) if h <= 0.0 && !self.two_sided => return 0.0,
            // Never below a tenth: the emitter has an extent.
            Some(h) => (h.abs() / d2.sqrt()).clamp(0.1, 1.0),
            None => 0.25,
        };
        self.luminance * area * cosine / d2
    }
}

/// Cosine of the half angle under which a sphere is seen from outside; `None` from within or on it, where a cone is no
/// use (and its cosine has no digits).
fn cone(distance_squared: f32, radius: f32) -> Option<f32> {
    let sin2 = radius * radius / distance_squared;
    (sin2 < 0.9999).then(|| (1.0 - sin2).sqrt())
}

/// A direction in the cone of a sphere, and the point where it meets it (Pharr et al. 2023, § 6.2.4).
fn sample_cone(centre: Vec3, radius: f32, to_centre: Vec3, d2: f32, cos_max: f32, u: Vec2) -> (Point, f32) {
    let sin2_max = radius * radius / d2;
    // 1 − cos θ_max without cancellation for small cones.
    let one_minus_cos_max = sin2_max / (1.0 + cos_max);
    let one_minus_cos = u.x * one_minus_cos_max;
    let cos_theta = 1.0 - one_minus_cos;
    let sin2_theta = one_minus_cos * (2.0 - one_minus_cos);
    // Angle at the centre, between the axis back to the reference and the point.
    let cos_alpha = sin2_theta / sin2_max.sqrt() + cos_theta * (1.0 - sin2_theta / sin2_max).max(0.0).sqrt();
    let sin_alpha = (1.0 - cos_alpha * cos_alpha).max(0.0).sqrt();
    let (sin_phi, cos_phi) = crate::math::fast::sin_cos_turn(u.y);
    let frame = Frame::around(-to_centre / d2.sqrt());
    let n = frame.to_world(Vec3::new(sin_alpha * cos_phi, sin_alpha * sin_phi, cos_alpha));
    (sphere_point(centre, radius, n, false), 1.0 / (2.0 * PI * one_minus_cos_max))
}

fn is_rectangle(e1: Vec3, e2: Vec3) -> bool {
    e1.dot(e2).abs() <= 1e-5 * (e1.length() * e2.length())
}

/// A density per area, seen from a point.
fn area_to_solid_angle(from: Vec3, p: Vec3, ng: Vec3, pdf: f32) -> f32 {
    let to_light = p - from;
    let d2 = to_light.length_squared();
    let cosine = (to_light.dot(ng)).abs() / d2.sqrt();
    if cosine > 0.0 { d2 * pdf / cosine } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(shape: EmitterShape) -> AreaLight {
        AreaLight { shape, radiance: Spectrum::constant(1.0), luminance: 1.0, two_sided: false, opacity: 1.0 }
    }

    /// Irradiance of a uniform emitter on a plane that faces it, over π: the form factor from a point.
    fn irradiance_over_pi(light: &AreaLight, n: u32) -> f64 {
        let from = Reference { p: Vec3::ZERO, normal: Some(Vec3::Z) };
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let u = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                if let Some(s) = light.sample(&from, u, &Wavelengths::Rgb) {
                    sum += f64::from(s.li.lane(0) * s.dir.z.max(0.0) / s.pdf) / std::f64::consts::PI;
                }
            }
        }
        sum / f64::from(n * n)
    }

    /// `surface_ground_truths.csv`: unit square on the axis at height 1; sphere of r = 0.5 at d = 2: (r/d)²;
    /// a disk of radius R at height h: R²/(R² + h²); a ring is the difference of two.
    #[test]
    fn uniform_emitters_give_the_irradiance_of_their_form_factors() {
        let down = -Vec3::Z;
        let square = EmitterShape::Parallelogram { a: Vec3::new(-0.5, -0.5, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: down };
        let halves = [
            EmitterShape::Triangle { a: Vec3::new(-0.5, -0.5, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: down },
            EmitterShape::Triangle { a: Vec3::new(0.5, 0.5, 1.0), e1: -Vec3::Y, e2: -Vec3::X, ng: down },
        ];
        let sphere = EmitterShape::Sphere { centre: 2.0 * Vec3::Z, radius: 0.5, inward: false };
        let ring = EmitterShape::Disk { centre: 2.0 * Vec3::Z, ng: down, radius: 1.0, inner: 0.5 };
        let check = |name: &str, value: f64, expected: f64| {
            assert!((value / expected - 1.0).abs() < 2e-4, "{name}: {value}, expected {expected}");
        };
        check("square", irradiance_over_pi(&light(square), 200), 0.239_456_470_460_774);
        let both = halves.iter().map(|t| irradiance_over_pi(&light(*t), 400)).sum();
        check("triangles", both, 0.239_456_470_460_774);
        check("sphere", irradiance_over_pi(&light(sphere), 200), 0.0625);
        check("ring", irradiance_over_pi(&light(ring), 400), 1.0 / 5.0 - 0.25 / 4.25);
    }

    #[test]
    fn the_density_of_a_sample_is_the_density_of_its_point() {
        let shapes = [
            EmitterShape::Parallelogram { a: Vec3::new(-0.5, 0.2, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: -Vec3::Z },
            EmitterShape::Sphere { centre: Vec3::new(1.0, 1.0, 2.0), radius: 0.5, inward: false },
            EmitterShape::Disk { centre: Vec3::new(0.3, 0.0, 2.0), ng: -Vec3::Z, radius: 1.0, inner: 0.0 },
        ];
        let from = Reference { p: Vec3::ZERO, normal: None };
        for shape in shapes {
            let light = light(shape);
            for i in 0..100 {
                let u = Vec2::new((i as f32 * 0.618) % 1.0, (i as f32 * 0.414) % 1.0);
                let s = light.sample(&from, u, &Wavelengths::Rgb).unwrap();
                let Target::Surface { p, ng, .. } = s.target else { panic!() };
                let pdf = light.pdf(&from, p, ng);
                assert!((pdf / s.pdf - 1.0).abs() < 1e-3, "{shape:?}: {pdf} {}", s.pdf);
            }
        }
    }

    #[test]
    fn nothing_shines_behind_a_one_sided_emitter() {
        let disk = light(EmitterShape::Disk { centre: Vec3::Z, ng: Vec3::Z, radius: 1.0, inner: 0.0 });
        let from = Reference { p: Vec3::ZERO, normal: None };
        assert!(disk.sample(&from, Vec2::new(0.3, 0.4), &Wavelengths::Rgb).is_none());
        assert_eq!(disk.importance(from.p), 0.0);
    }
}
