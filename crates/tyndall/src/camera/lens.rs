//! A lens of many elements: spherical interfaces of glass and a stop, along the axis +z.
//!
//! Elements are listed from the scene to the film. Each has a radius of curvature (positive where the centre lies towards
//! the film, 0 for the stop), the distance to the next one (of the last: to the film), the index of what follows it, and
//! a radius beyond which it is opaque. The film lies in z = 0, the scene at z → ∞. Rays are traced by Snell's law, without
//! reflections; glass does not disperse.
//!
//! Focus is that of the paraxial matrix `[A B; C D]` from the first vertex to the last: an object `s` before the first is
//! sharp `s'` behind the last where `(C s + D) s' + A s + B = 0`.
//!
//! Source: Kolb et al. 1995; Pharr et al. 2023, § 5.4 (online); Hecht, Optics, § 6.2 (matrices).

use glam::{DMat2, DVec2, DVec3};

/// An interface of a lens, or its stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// Radius of curvature [length]; positive where the centre lies towards the film, 0 for the stop.
    pub curvature: f64,
    /// Distance to the next element, or to the film [length].
    pub thickness: f64,
    /// Index of refraction of what follows [1]; 0 and 1 for air.
    pub eta: f64,
    /// Radius of the opening [length].
    pub aperture: f64,
}

/// The shape of the stop's opening.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// A disk of the stop's radius.
    Circular,
    /// Transmittance over the square around that disk, `n × n` values row by row from the lower left; of mean π/4 where
    /// it is to be as bright as the disk.
    Image {
        /// Values a side.
        n: usize,
        /// Transmittances [1]; more than 1 is a correction of brightness.
        values: Vec<f32>,
    },
}

/// A lens and its film.
#[derive(Debug, Clone, PartialEq)]
pub struct LensSystem {
    /// From the scene to the film, at least one.
    pub elements: Vec<Element>,
    /// The shape of its stop.
    pub stop: Stop,
}

/// A ray in camera space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LensRay {
    pub(super) origin: DVec3,
    pub(super) dir: DVec3,
}

impl LensSystem {
    /// Distance of the last element from the film [length].
    pub fn rear_z(&self) -> f64 {
        self.elements.last().map_or(0.0, |e| e.thickness)
    }

    /// Radius of the last element's opening [length].
    pub fn rear_aperture(&self) -> f64 {
        self.elements.last().map_or(0.0, |e| e.aperture)
    }

    /// Moves the film to where an object at `distance` [length] from it is sharp. `None` if that is nowhere: it is too
    /// near, or nothing bends light.
    #[must_use]
    pub fn focused(mut self, distance: f64) -> Option<Self> {
        let m = self.paraxial();
        let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
        let length: f64 = self.elements.iter().rev().skip(1).map(|e| e.thickness).sum();
        // With s = distance − length − s': C s'² − (C S + D − A) s' − (A S + B) = 0, S = distance − length.
        let s = distance - length;
        let half = (c * s + d - a) / 2.0;
        let root = (half * half + c * (a * s + b)).sqrt();
        let near = [(half - root) / c, (half + root) / c].into_iter().filter(|z| *z > 0.0).reduce(f64::min)?;
        self.elements.last_mut()?.thickness = near;
        near.is_finite().then_some(self)
    }

    /// From height and angle before the first vertex to those behind the last.
    fn paraxial(&self) -> DMat2 {
        let mut matrix = DMat2::IDENTITY;
        let mut before = 1.0;
        for (i, element) in self.elements.iter().enumerate() {
            if element.curvature != 0.0 {
                let after = index(element.eta);
                let bend = (before - after) / (element.curvature * after);
                matrix = DMat2::from_cols(DVec2::new(1.0, bend), DVec2::new(0.0, before / after)) * matrix;
                before = after;
            }
            if i + 1 < self.elements.len() {
                matrix = DMat2::from_cols(DVec2::X, DVec2::new(element.thickness, 1.0)) * matrix;
            }
        }
        matrix
    }

    /// Follows a ray from the film to the scene; `None` where it is stopped, else where it leaves and the transmittance
    /// of the stop.
    pub(super) fn trace(&self, ray: LensRay) -> Option<(LensRay, f64)> {
        let LensRay { mut origin, dir } = ray;
        let mut dir = dir.normalize();
        let (mut z, mut weight) = (0.0, 1.0);
        for (i, element) in self.elements.iter().enumerate().rev() {
            z += element.thickness;
            if element.curvature == 0.0 {
                let t = (z - origin.z) / dir.z;
                origin += dir * (t >= 0.0).then_some(t)?;
                weight *= self.stop_transmittance(origin, element.aperture)?;
                continue;
            }
            let centre = DVec3::new(0.0, 0.0, z - element.curvature);
            let t = meet_sphere(origin - centre, dir, element.curvature)?;
            origin += dir * t;
            if origin.x.hypot(origin.y) > element.aperture {
                return None;
            }
            let normal = (origin - centre) / element.curvature;
            let before = i.checked_sub(1).map_or(1.0, |i| index(self.elements[i].eta));
            dir = refract(dir, if normal.dot(dir) > 0.0 { -normal } else { normal }, index(element.eta) / before)?;
        }
        Some((LensRay { origin, dir }, weight))
    }

    fn stop_transmittance(&self, p: DVec3, radius: f64) -> Option<f64> {
        match &self.stop {
            Stop::Circular => (p.x.hypot(p.y) <= radius).then_some(1.0),
            Stop::Image { n, values } => {
                let at = |v: f64| f64::midpoint(v / radius, 1.0) * *n as f64;
                let (x, y) = (at(p.x), at(p.y));
                let within = x >= 0.0 && y >= 0.0 && x < *n as f64 && y < *n as f64;
                let value = within.then(|| values.get(y as usize * n + x as usize)).flatten()?;
                (*value > 0.0).then_some(f64::from(*value))
            }
        }
    }
}

/// The index of a number that may stand for air.
fn index(eta: f64) -> f64 {
    if eta == 0.0 { 1.0 } else { eta }
}

/// The distance to the cap of a sphere around the origin that a ray towards +z can pass: the nearer side where the centre
/// lies behind the cap.
fn meet_sphere(from: DVec3, dir: DVec3, curvature: f64) -> Option<f64> {
    let along = from.dot(dir);
    let square = along * along - (from.length_squared() - curvature * curvature);
    let root = (square >= 0.0).then(|| square.sqrt())?;
    let t = if curvature < 0.0 { -along - root } else { -along + root };
    (t >= 0.0).then_some(t)
}

/// Snell's law: `normal` against `dir`, `ratio` the index before over that after. `None` for total reflection.
fn refract(dir: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let cos = -dir.dot(normal);
    let square = 1.0 - ratio * ratio * (1.0 - cos * cos);
    (square > 0.0).then(|| (dir * ratio + normal * (ratio * cos - square.sqrt())).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(curvature: f64, thickness: f64, eta: f64, aperture: f64) -> Element {
        Element { curvature, thickness, eta, aperture }
    }

    /// A biconvex lens, thin against its focal length: the lensmaker's equation gives 1/f = (n − 1)·2/R, and an object at
    /// distance s is sharp at s' with 1/s + 1/s' = 1/f.
    #[test]
    fn a_thin_lens_is_focused_where_the_lensmaker_says() {
        let lens = LensSystem {
            elements: vec![element(100.0, 1e-6, 1.5, 20.0), element(-100.0, 1.0, 1.0, 20.0)],
            stop: Stop::Circular,
        };
        let focused = lens.clone().focused(1000.0).unwrap();
        let image = focused.rear_z();
        let object = 1000.0 - image;
        assert!((1.0 / object + 1.0 / image - 1.0 / 100.0).abs() < 1e-9, "{image}");
        assert!(lens.clone().focused(300.0).is_none(), "nearer than four focal lengths");
        let pane = LensSystem { elements: vec![element(0.0, 5.0, 0.0, 1.0)], stop: Stop::Circular };
        assert!(pane.focused(1000.0).is_none());
    }

    /// Rays near the axis from a point of the film meet at the distance in focus: real refraction against the matrix.
    #[test]
    fn rays_from_a_point_of_the_film_meet_in_focus() {
        let elements = vec![
            element(30.0, 4.0, 1.6, 12.0),
            element(-80.0, 2.0, 1.0, 12.0),
            element(0.0, 3.0, 0.0, 8.0),
            element(-60.0, 2.0, 1.7, 10.0),
            element(-25.0, 40.0, 1.0, 10.0),
        ];
        let lens = LensSystem { elements, stop: Stop::Circular }.focused(500.0).unwrap();
        let film = DVec3::new(0.2, 0.0, 0.0);
        let at_focus = |x: f64, y: f64| {
            let dir = DVec3::new(x, y, lens.rear_z()) - film;
            let (ray, _) = lens.trace(LensRay { origin: film, dir }).unwrap();
            ray.origin + ray.dir * ((500.0 - ray.origin.z) / ray.dir.z)
        };
        let middle = at_focus(0.0, 0.0);
        assert!(middle.x < -1.0, "the image is upside down: {middle}");
        for (x, y) in [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.1)] {
            assert!((at_focus(x, y) - middle).length() < 2e-3 * middle.x.abs(), "{} {middle}", at_focus(x, y));
        }
    }
}
