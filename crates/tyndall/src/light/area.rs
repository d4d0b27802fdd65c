//! An emitting surface: radiance `L` from every point into the hemisphere of its normal (or both).
//!
//! Points are drawn uniformly in solid angle where a closed form exists and is worth its time (spheres by their cone; rectangles
//! that are near, Ureña et al. 2013), else uniformly in area, or nearly so, with density `d² p_A / |cos θ|` per steradian.

use std::f32::consts::PI;

use super::{LightSample, Pattern, Reference, Revolved, Target};
use crate::{
    math::{Bounds, Frame, Vec2, Vec3, rounding::gamma},
    sampling::{spherical_rectangle::SphericalRectangle, warp},
    shape::Patch,
    spectrum::{Lanes, Spectrum, Wavelengths},
    texture::TexturePoint,
};

/// A rectangle is near up to so many of its half diagonals. From farther away points that are uniform in area vary hardly more, and are
/// found sooner.
const NEAR: f32 = 1.5;

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
    /// What varies over it, if anything does.
    pub pattern: Option<Box<Pattern>>,
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
    /// A bilinear patch.
    Patch(Patch),
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
            Self::Patch(patch) => patch.area(),
            Self::Revolved(revolved) => revolved.area(),
        }
    }

    /// As [`Self::area`], good for a guess: quickly.
    fn rough_area(&self) -> f32 {
        match self {
            Self::Patch(patch) => patch.rough_area(),
            _ => self.area(),
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
            Self::Sphere { .. } | Self::Patch(_) => None,
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
            Self::Patch(patch) => Bounds::of(patch.corners),
            Self::Revolved(revolved) => revolved.bounds(),
        }
    }

    /// Which side of a flat emitter a point is on, as a height over its plane; `None` for a curved one.
    pub(crate) fn height(&self, p: Vec3) -> Option<f32> {
        match *self {
            Self::Triangle { a, ng, .. } | Self::Parallelogram { a, ng, .. } => Some((p - a).dot(ng)),
            Self::Disk { centre, ng, .. } => Some((p - centre).dot(ng)),
            Self::Revolved(revolved) => revolved.normal().map(|ng| (p - revolved.centre()).dot(ng)),
            Self::Sphere { .. } | Self::Patch(_) => None,
        }
    }

    /// Weights of `e1` and `e2` at a point of the plane of a triangle or a parallelogram [1].
    pub(crate) fn weights(&self, p: Vec3) -> [f32; 2] {
        match *self {
            Self::Triangle { a, e1, e2, .. } | Self::Parallelogram { a, e1, e2, .. } => {
                let n = e1.as_dvec3().cross(e2.as_dvec3());
                let from = (p - a).as_dvec3();
                let square = n.length_squared();
                [from.cross(e2.as_dvec3()), e1.as_dvec3().cross(from)].map(|v| (v.dot(n) / square) as f32)
            }
            Self::Sphere { .. } | Self::Disk { .. } | Self::Patch(_) | Self::Revolved(_) => [0.0; 2],
        }
    }

    /// Whether a point of the plane of a flat emitter lies on it.
    pub(crate) fn holds(&self, p: Vec3) -> bool {
        match *self {
            Self::Triangle { .. } => {
                let [b1, b2] = self.weights(p);
                b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0
            }
            Self::Parallelogram { .. } => self.weights(p).iter().all(|b| (0.0..=1.0).contains(b)),
            Self::Disk { centre, radius, inner, .. } => {
                let d2 = centre.distance_squared(p);
                d2 <= radius * radius && d2 >= inner * inner
            }
            Self::Sphere { .. } | Self::Patch(_) | Self::Revolved(_) => false,
        }
    }

    fn centre(&self) -> Vec3 {
        match *self {
            Self::Triangle { a, e1, e2, .. } => a + (e1 + e2) / 3.0,
            Self::Parallelogram { a, e1, e2, .. } => a + (e1 + e2) * 0.5,
            Self::Sphere { centre, .. } | Self::Disk { centre, .. } => centre,
            Self::Patch(patch) => patch.corners.iter().sum::<Vec3>() * 0.25,
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
            Self::Patch(patch) => {
                let (p, ng, error) = patch.sample_area(u);
                Point { p, ng, error }
            }
            Self::Revolved(revolved) => revolved.sample(u),
        }
    }

    /// Density of [`Self::sample_area`] at a point with unit normal `ng` [1/length²].
    pub(crate) fn pdf_area(&self, p: Vec3, ng: Vec3) -> f32 {
        match self {
            Self::Patch(patch) => patch.pdf_area(p, ng),
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
    /// Radiance leaving a point with unit normal `ng` towards `dir` [W·m⁻²·sr⁻¹]; `at` is the point as textures see it.
    #[inline]
    pub fn le(&self, ng: Vec3, dir: Vec3, at: impl FnOnce() -> TexturePoint, wavelengths: &Wavelengths) -> Lanes {
        if !self.two_sided && ng.dot(dir) <= 0.0 {
            return Lanes::ZERO;
        }
        let radiance = self.radiance.eval(wavelengths);
        match &self.pattern {
            None => radiance,
            Some(pattern) => radiance * pattern.factor(&at(), wavelengths),
        }
    }

    /// Whether light sampling from `from` can find a point `p` with unit normal `ng`.
    pub fn shows(&self, from: Vec3, p: Vec3, ng: Vec3) -> bool {
        self.shape.height(from).is_none_or(|h| h != 0.0) && (self.two_sided || ng.dot(p - from) < 0.0)
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
        if !(pdf > 0.0 && pdf.is_finite() && d2 > 0.0) || (!self.two_sided && point.ng.dot(dir) >= 0.0) {
            return None;
        }
        let li = self.radiance.eval(wavelengths) * self.share(&point, wavelengths);
        (!li.is_zero()).then_some(LightSample {
            dir,
            li,
            pdf,
            dirac: self.opacity == 0.0,
            target: Target::Surface { p: point.p, error: point.error, ng: point.ng },
        })
    }

    /// The share of the radiance that light sampling takes at a point: as much of it as there is surface.
    #[inline]
    fn share(&self, point: &Point, wavelengths: &Wavelengths) -> Lanes {
        let there = if self.opacity == 0.0 { 1.0 } else { self.opacity };
        match &self.pattern {
            None => Lanes::splat(there),
            Some(pattern) => {
                let at = pattern.texture_point(&self.shape, point.p, point.ng);
                pattern.factor(&at, wavelengths) * (there * pattern.opacity(&at))
            }
        }
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
            EmitterShape::Parallelogram { a, e1, e2, ng } => {
                if let Some(rectangle) = seen_near(a, e1, e2, from.p) {
                    let uv = rectangle.sample(u);
                    return (flat(a, e1 * uv.x, e2 * uv.y, ng), rectangle.pdf());
                }
            }
            _ => {}
        }
        let point = self.shape.sample_area(u);
        let pdf = area_to_solid_angle(from.p, point.p, point.ng, self.shape.pdf_area(point.p, point.ng));
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
            EmitterShape::Parallelogram { a, e1, e2, .. } => {
                if let Some(rectangle) = seen_near(a, e1, e2, from.p) {
                    return rectangle.pdf();
                }
            }
            _ => {}
        }
        area_to_solid_angle(from.p, p, ng, self.shape.pdf_area(p, ng))
    }

    /// A guess at the irradiance made at `p` [W·m⁻²]: zero only behind a one-sided flat emitter.
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let area = self.shape.rough_area();
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

/// A parallelogram as seen from a point, if it is a rectangle and [`NEAR`].
#[inline]
fn seen_near(a: Vec3, e1: Vec3, e2: Vec3, from: Vec3) -> Option<SphericalRectangle> {
    let reach = 0.5 * NEAR;
    let is_near = (a + (e1 + e2) * 0.5).distance_squared(from) < reach * reach * (e1 + e2).length_squared();
    if is_near { SphericalRectangle::new(a, e1, e2, from) } else { None }
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

/// A density by area [1/length²], by solid angle [1/sr].
fn area_to_solid_angle(from: Vec3, p: Vec3, ng: Vec3, pdf_area: f32) -> f32 {
    let to_light = p - from;
    let d2 = to_light.length_squared();
    let cosine = (to_light.dot(ng)).abs() / d2.sqrt();
    if cosine > 0.0 { pdf_area * d2 / cosine } else { 0.0 }
}

#[cfg(test)]
mod tests;
