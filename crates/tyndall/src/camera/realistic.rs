//! A film behind a lens of many elements (pbrt-v4's `realistic`).
//!
//! The irradiance on the film is `E = ∫ L cos⁴θ dA / z²` over the exit pupil, `z` [length] the distance of the plane of
//! the last element, `θ` from the axis to the point of that plane. Points are uniform in a rectangle that bounds the pupil
//! as seen from the film, found once for each of 64 distances from the axis; the weight is `cos⁴θ · area / z²`, or 0 where
//! the lens stops the ray. It falls off towards the corners as the lens does.
//!
//! Source: Kolb et al. 1995; Pharr et al. 2023, § 5.4 (online).

use glam::{DVec2, DVec3};

use super::{CameraRay, LensSystem, lens::LensRay};
use crate::math::{Ray, Vec2, Vec3};

/// Distances from the axis for which the pupil is bounded.
const RINGS: usize = 64;
/// Rays a side with which a pupil is looked for.
const PROBES: usize = 96;

/// A film behind a lens.
#[derive(Debug, Clone, PartialEq)]
pub struct Realistic {
    lens: LensSystem,
    /// Half width and half height of the film [length].
    half: DVec2,
    /// By distance from the axis, for points of the film on +x; `None` where no light gets through.
    pupils: Vec<Option<[DVec2; 2]>>,
}

impl Realistic {
    /// A film of `diagonal` [length] and `aspect` (width over height) behind a lens. `None` if no light gets through to
    /// any of it.
    pub fn new(lens: LensSystem, diagonal: f64, aspect: f64) -> Option<Self> {
        let height = diagonal / aspect.hypot(1.0);
        let half = DVec2::new(height * aspect, height) / 2.0;
        let ring = |i: usize| i as f64 / RINGS as f64 * diagonal / 2.0;
        let pupils: Vec<_> = (0..RINGS).map(|i| pupil(&lens, [ring(i), ring(i + 1)])).collect();
        pupils.iter().any(Option::is_some).then_some(Self { lens, half, pupils })
    }

    /// The ray of a place, in camera space.
    pub fn ray(&self, place: Vec2, lens: Vec2) -> CameraRay {
        let stopped = CameraRay { ray: Ray::new(Vec3::ZERO, Vec3::Z), weight: 0.0 };
        self.passing(place, lens).unwrap_or(stopped)
    }

    fn passing(&self, place: Vec2, lens: Vec2) -> Option<CameraRay> {
        // The lens turns the image by half a turn: left of the image is the film's +x.
        let across = place.as_dvec2() * 2.0 - 1.0;
        let film = DVec2::new(-across.x, across.y) * self.half;
        let [min, max] = self.pupil_at(film.length())?;
        let uv = min + (max - min) * lens.as_dvec2();
        let axis = film.try_normalize().unwrap_or(DVec2::X);
        let point = axis.rotate(uv).extend(self.lens.rear_z());
        let origin = film.extend(0.0);
        let dir = (point - origin).normalize();
        let (ray, transmittance) = self.lens.trace(LensRay { origin, dir })?;
        let area = (max - min).element_product();
        let weight = transmittance * dir.z.powi(4) * area / self.lens.rear_z().powi(2);
        Some(CameraRay { ray: Ray::new(ray.origin.as_vec3(), ray.dir.as_vec3()), weight: weight as f32 })
    }

    fn pupil_at(&self, distance: f64) -> Option<[DVec2; 2]> {
        let ring = (distance / self.half.length() * RINGS as f64) as usize;
        self.pupils[ring.min(RINGS - 1)]
    }
}

/// The part of the plane of the last element through which light reaches the points `(x, 0, 0)` of a ring of the film.
fn pupil(lens: &LensSystem, ring: [f64; 2]) -> Option<[DVec2; 2]> {
    let reach = 1.5 * lens.rear_aperture();
    let step = 2.0 * reach / PROBES as f64;
    let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for i in 0..PROBES * PROBES {
        let probe = DVec2::new((i % PROBES) as f64 + 0.5, (i / PROBES) as f64 + 0.5) * step - reach;
        let inside = probe.cmpge(min).all() && probe.cmple(max).all();
        let passes = |x: f64| {
            let origin = DVec3::new(x, 0.0, 0.0);
            lens.trace(LensRay { origin, dir: probe.extend(lens.rear_z()) - origin }).is_some()
        };
        if !inside && ring.into_iter().any(passes) {
            (min, max) = (min.min(probe), max.max(probe));
        }
    }
    // What lies between the probes: a step, and as much again for the curve of the pupil's edge.
    (min.x <= max.x).then_some([min - 2.0 * step, max + 2.0 * step])
}

#[cfg(test)]
mod tests {
    use super::super::{Element, Stop};
    use super::*;

    fn mean_weight(camera: &Realistic, place: Vec2) -> f64 {
        let n = 400;
        let at = |i: u32| (i as f32 + 0.5) / n as f32;
        let weights = (0..n * n).map(|i| f64::from(camera.ray(place, Vec2::new(at(i % n), at(i / n))).weight));
        weights.sum::<f64>() / f64::from(n * n)
    }

    /// A stop of radius a at distance z before the film, under radiance 1. Off the axis by r the irradiance of a disk is
    /// E = π/2 · (1 − (r² + z² − a²)/√((r² + z² + a²)² − 4r²a²)) (Howell, A Catalog of Radiation Configuration Factors,
    /// B-13); on the axis, π a²/(a² + z²).
    #[test]
    fn a_stop_alone_lights_the_film_as_a_disk_does() {
        let (a, z) = (4.0f64, 20.0f64);
        let stop = Element { curvature: 0.0, thickness: z, eta: 0.0, aperture: a };
        let camera = Realistic::new(LensSystem { elements: vec![stop], stop: Stop::Circular }, 30.0, 1.0).unwrap();
        for along in [0.0, 0.3, 0.9] {
            let r = along * 15.0;
            let place = Vec2::splat((0.5 - 0.5 * along) as f32);
            let (sum, root) = (r * r + z * z, ((r * r + z * z + a * a).powi(2) - 4.0 * r * r * a * a).sqrt());
            let expected = std::f64::consts::FRAC_PI_2 * (1.0 - (sum - a * a) / root);
            let found = mean_weight(&camera, place);
            assert!((found / expected - 1.0).abs() < 1e-3, "r = {r}: {found}, expected {expected}");
        }
    }

    /// What is right in the image is right in the world (+x), and what is high is high (+y): the lens turns both round, and so
    /// does the film.
    #[test]
    fn the_picture_stands_upright() {
        let stop = Element { curvature: 0.0, thickness: 20.0, eta: 0.0, aperture: 0.1 };
        let camera = Realistic::new(LensSystem { elements: vec![stop], stop: Stop::Circular }, 30.0, 1.0).unwrap();
        let dir = |x: f32, y: f32| camera.ray(Vec2::new(x, y), Vec2::splat(0.5)).ray.dir;
        let [right, high] = [dir(0.75, 0.5), dir(0.5, 0.25)];
        // A quarter of the film's side before a pinhole at 20.
        let slope = 0.25 * 30.0 / 2.0f32.sqrt() / 20.0;
        assert!((right.x / right.z - slope).abs() < 0.01 && right.y.abs() < 0.01, "{right}");
        assert!((high.y / high.z - slope).abs() < 0.01 && high.x.abs() < 0.01, "{high}");
    }

    /// The bounds lose nothing of the pupil: through a lens that vignettes, the mean over the bounds is the integral over
    /// the whole plane of the last element.
    #[test]
    fn the_bounds_of_the_pupil_hold_all_of_it() {
        let element = |curvature, thickness, eta, aperture| Element { curvature, thickness, eta, aperture };
        let elements = vec![
            element(30.0, 4.0, 1.6, 12.0),
            element(-80.0, 2.0, 1.0, 12.0),
            element(0.0, 3.0, 0.0, 6.0),
            element(-60.0, 2.0, 1.7, 10.0),
            element(-25.0, 40.0, 1.0, 10.0),
        ];
        let lens = LensSystem { elements, stop: Stop::Circular }.focused(800.0).unwrap();
        let camera = Realistic::new(lens.clone(), 40.0, 1.5).unwrap();
        for along in [0.0, 0.371, 0.618, 0.95] {
            let place = Vec2::new(0.5, (0.5 - 0.5 * along) as f32);
            let film = DVec3::new(0.0, -along * camera.half.y, 0.0);
            let (n, reach) = (1500, 1.5 * lens.rear_aperture());
            let at = |i: i32| ((f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0) * reach;
            let mut whole = 0.0;
            for i in 0..n * n {
                let dir = (DVec3::new(at(i % n), at(i / n), lens.rear_z()) - film).normalize();
                let passes = lens.trace(LensRay { origin: film, dir }).is_some();
                whole += if passes { dir.z.powi(4) } else { 0.0 };
            }
            whole *= (2.0 * reach / f64::from(n) / lens.rear_z()).powi(2);
            let found = mean_weight(&camera, place);
            assert!((found / whole - 1.0).abs() < 3e-3, "{along}: {found}, expected {whole}");
        }
    }
}
