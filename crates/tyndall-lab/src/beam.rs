//! A narrow beam falls on a body: where its light comes out again, by the distance from the beam and as a picture.
//!
//! ```text
//!        beam          the beam runs along −z and meets the body at x = y = 0 or nearby;
//!          │           half-spaces and slabs begin at z = 0, balls and boxes have the origin in their middle,
//!     ┌────┼────┐      meshes stay where they are
//!     │    ▼    │
//!     └─────────┘
//! ```
//!
//! `R(r)` [1/length²] is the power that leaves through what faces the beam, per area across the beam, at a distance `r` from
//! its axis, of a beam of power 1; light that has never collided is left out. On a flat face it is what a camera's picture,
//! averaged over rings, is compared with diffusion theory by ([`crate::diffusion`]).
//!
//! The picture is that of a telecentric camera far away, which sees the body along one direction `v` and accepts what leaves
//! within an angle `α` of it. A pixel of area `a` shows the mean over this cone of the radiance [1/(length² sr)] of what
//! lies behind it, weighted with the cosine to the surface there:
//!
//! ```text
//! L = Σ w (n·v) / (a P(n·v, α))
//! ```
//!
//! over photons of power `w` that leave with normal `n` there; `P` is the part of the cone above the surface, projected on
//! it, `(n·v) π sin² α` where all of it is ([`projected_cone`]). Every photon that the camera accepts counts, whatever it
//! has been through, and no weight exceeds that at normal view.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use tyndall::{
    math::{Ray, Vec3},
    scene::Scene,
    shape::Mesh,
};

use crate::photon::{Collision, Detector, Photon, shoot};
use crate::point::source_stream;
use crate::run::{Estimate, Sums, Verdict};
use crate::slab::Edges;
use crate::world::{SetupError, Substance, World, within};

/// What the beam falls on.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// Everything below z = 0.
    HalfSpace,
    /// From z = 0 down to its thickness [length].
    Slab(f64),
    /// A ball of a radius [length].
    Ball(f64),
    /// A box by the lengths of its edges [length].
    Box(DVec3),
    /// A closed surface.
    Mesh(Mesh),
}

/// The camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Pixels along each edge of the picture.
    pub pixels: u32,
    /// Length of its edges in the world [length]. In its middle is the middle of the body, or where the beam falls on a
    /// plane.
    pub width: f64,
    /// Half-angle of the cone that it accepts [rad].
    pub acceptance: f64,
    /// How far from the beam it stands [rad]: 0 looks along it.
    pub tilt: f64,
    /// To which side [rad]: 0 is towards −y, so that y points up in the picture.
    pub azimuth: f64,
}

/// An experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// What the beam falls on.
    pub body: Body,
    /// What that is made of; it stands in air.
    pub substance: Substance,
    /// Diameter of the beam, which is uniform [length]; 0 for a ray.
    pub spot: f64,
    /// Where its axis is [length].
    pub aim: DVec2,
    /// Rings around the axis [length].
    pub radii: Edges,
    /// The camera, if there is one.
    pub view: Option<View>,
}

/// What was measured, of a beam of power 1.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Photons.
    pub photons: u64,
    /// Leaves after collisions through what faces the beam \[1\].
    pub returned: Estimate,
    /// Leaves after collisions elsewhere \[1\].
    pub elsewhere: Estimate,
    /// Leaves without a collision \[1\].
    pub unscattered: Estimate,
    /// Is absorbed \[1\].
    pub absorbed: Estimate,
    /// `R(r)` by rings [1/length²].
    pub by_radius: Vec<Estimate>,
    /// Radiance, row by row [1/(length² sr)].
    pub picture: Vec<Estimate>,
}

/// The first quantities: returned, elsewhere, unscattered, absorbed.
const TOTALS: usize = 4;

/// Sends the beam.
///
/// # Errors
/// The experiment cannot be.
pub fn measure(
    setup: &Setup,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Measured, SetupError> {
    setup.check()?;
    let top = setup.top()?;
    let scene = setup.scene(top)?;
    let camera = setup.view.map(|view| Camera::new(view, setup.middle(), matches!(setup.body, Body::Mesh(_))));
    let rings = setup.radii.count();
    let pixels = camera.as_ref().map_or(0, |camera| camera.view.pixels as usize * camera.view.pixels as usize);
    let recorder = || Recorder { setup, scene: &scene, camera, totals: vec![0.0; TOTALS + rings + pixels] };
    let ray = |photon| setup.ray(top, photon, seed);
    let sums = shoot(&scene, photons, seed, ray, recorder, look);
    let ring = |i: usize| {
        let [inner, outer] = setup.radii.bin(i);
        sums.estimate(TOTALS + i).scaled(1.0 / (PI * (outer * outer - inner * inner)))
    };
    Ok(Measured {
        photons: sums.photons(),
        returned: sums.estimate(0),
        elsewhere: sums.estimate(1),
        unscattered: sums.estimate(2),
        absorbed: sums.estimate(3),
        by_radius: (0..rings).map(ring).collect(),
        picture: sums.estimates(TOTALS + rings..TOTALS + rings + pixels),
    })
}

impl Setup {
    fn check(&self) -> Result<(), SetupError> {
        let size = |what, value: f64| within(what, value, "positive and finite", |d| d > 0.0 && d.is_finite());
        self.substance.check()?;
        match &self.body {
            Body::HalfSpace | Body::Mesh(_) => {}
            Body::Slab(thickness) => size("the thickness", *thickness)?,
            Body::Ball(radius) => size("the radius", *radius)?,
            Body::Box(edges) => edges.to_array().into_iter().try_for_each(|edge| size("the edge of the box", edge))?,
        }
        within("the diameter of the beam", self.spot, "at least 0, and finite", |d| d >= 0.0 && d.is_finite())?;
        within("the place of the beam", self.aim.length(), "finite", f64::is_finite)?;
        self.radii.check()?;
        let Some(view) = &self.view else { return Ok(()) };
        within("the number of pixels along an edge", f64::from(view.pixels), "from 1 to 512", |n| {
            (1.0..=512.0).contains(&n)
        })?;
        size("the width of the picture", view.width)?;
        within("the camera's acceptance", view.acceptance, "greater than 0 and less than 90°", |a| {
            a > 0.0 && a < FRAC_PI_2
        })?;
        within("the camera's tilt", view.tilt, "from 0 to 90°", |t| (0.0..=FRAC_PI_2).contains(&t))?;
        within("the camera's azimuth", view.azimuth, "finite", f64::is_finite)
    }

    /// The height at which the beam starts, or for planes meets the body [length].
    fn top(&self) -> Result<f64, SetupError> {
        match &self.body {
            Body::HalfSpace | Body::Slab(_) => Ok(0.0),
            Body::Ball(radius) => {
                let inside = radius * radius - self.aim.length_squared();
                within("the distance of the beam from the middle", self.aim.length(), "less than the radius", |_| {
                    inside > 0.0
                })?;
                Ok(inside.sqrt())
            }
            Body::Box(edges) => {
                let inside = 2.0 * self.aim.x.abs() < edges.x && 2.0 * self.aim.y.abs() < edges.y;
                within("the distance of the beam from the middle", self.aim.length(), "within the box", |_| inside)?;
                Ok(0.5 * edges.z)
            }
            Body::Mesh(mesh) => {
                let mut world = World::default();
                world.mesh(mesh.clone(), &Substance::VACUUM, &Substance::VACUUM)?;
                let scene = world.build(&Substance::VACUUM, DVec3::ZERO)?;
                if !scene.geometry.is_closed(&[tyndall::shape::ObjectId(0)]) {
                    return Err(SetupError::Missing("inside of a mesh that is not closed"));
                }
                let above = scene.geometry.bounds().max.z
                    + (scene.geometry.bounds().max - scene.geometry.bounds().min).max_element();
                let ray = Ray::new(self.aim.extend(f64::from(above)).as_vec3(), -Vec3::Z);
                let hit = scene
                    .geometry
                    .intersect(&ray, f32::INFINITY)
                    .ok_or(SetupError::Missing("mesh where the beam is"))?;
                Ok(f64::from(ray.at(hit.t).z))
            }
        }
    }

    fn scene(&self, top: f64) -> Result<Scene, SetupError> {
        let mut world = World::default();
        let (inside, outside) = (&self.substance, &Substance::VACUUM);
        match &self.body {
            Body::HalfSpace => world.plane(0.0, self.reach(), outside, inside)?,
            Body::Slab(thickness) => {
                world.plane(0.0, self.reach(), outside, inside)?;
                world.plane(-thickness, self.reach(), inside, outside)?;
            }
            Body::Ball(radius) => world.sphere(*radius, inside, outside)?,
            Body::Box(edges) => world.mesh(cuboid(*edges), inside, outside)?,
            Body::Mesh(mesh) => world.mesh(mesh.clone(), inside, outside)?,
        }
        world.build(outside, DVec3::Z * self.start(top))
    }

    /// What the camera looks at [length].
    fn middle(&self) -> DVec3 {
        match &self.body {
            Body::HalfSpace | Body::Slab(_) => self.aim.extend(0.0),
            Body::Ball(_) | Body::Box(_) => DVec3::ZERO,
            Body::Mesh(mesh) => {
                let (low, high) = extent(mesh);
                0.5 * (low + high)
            }
        }
    }

    /// How wide planes are [length].
    fn reach(&self) -> f64 {
        let thickness = if let Body::Slab(thickness) = self.body { thickness } else { 0.0 };
        let sigma_t = self.substance.sigma_t();
        let free_path = if sigma_t > 0.0 { 1.0 / sigma_t } else { 0.0 };
        1e6 * thickness.max(free_path).max(self.aim.length()).max(self.spot).max(f64::from(f32::MIN_POSITIVE))
    }

    /// The height from which photons are sent [length], above all of the body.
    fn start(&self, top: f64) -> f64 {
        match &self.body {
            Body::HalfSpace | Body::Slab(_) => 1e-6 * self.reach(),
            Body::Ball(radius) => 2.0 * radius,
            Body::Box(edges) => top + edges.max_element(),
            Body::Mesh(mesh) => {
                let (low, high) = extent(mesh);
                high.z + (high - low).max_element()
            }
        }
    }

    fn ray(&self, top: f64, photon: u64, seed: u64) -> Ray {
        let mut at = self.aim;
        if self.spot > 0.0 {
            let mut rng = source_stream(photon, seed);
            let (u, v) = (f64::from(rng.next_1d()), f64::from(rng.next_1d()));
            at += 0.5 * self.spot * u.sqrt() * DVec2::from_angle(TAU * v);
        }
        Ray::new(at.extend(self.start(top)).as_vec3(), -Vec3::Z)
    }
}

/// The corners of the smallest box around a mesh [length].
pub fn extent(mesh: &Mesh) -> (DVec3, DVec3) {
    let corners = mesh.positions.iter().map(|p| p.as_dvec3());
    corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// Each face of a box by its corners, anticlockwise as seen from outside.
const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// A box around the origin, its normals outwards.
fn cuboid(edges: DVec3) -> Mesh {
    let corner = |i: u32| {
        let sign = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        (DVec3::new(sign(0), sign(1), sign(2)) * edges).as_vec3()
    };
    let halves = FACES.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    Mesh { positions: (0..8).map(corner).collect(), indices: halves.collect(), ..Mesh::default() }
}

/// A camera and where its axes point.
#[derive(Debug, Clone, Copy)]
struct Camera {
    view: View,
    /// What is in the middle of the picture [length].
    middle: DVec3,
    /// From the body to the camera, and rightwards and upwards in the picture.
    axes: [DVec3; 3],
    cos_acceptance: f64,
    /// Whether parts of the body may hide others.
    may_hide: bool,
}

impl Camera {
    fn new(view: View, middle: DVec3, may_hide: bool) -> Self {
        let ((sin, cos), (sin_azimuth, cos_azimuth)) = (view.tilt.sin_cos(), view.azimuth.sin_cos());
        let towards = DVec3::new(sin * sin_azimuth, -sin * cos_azimuth, cos);
        let right = DVec3::new(cos_azimuth, sin_azimuth, 0.0);
        let axes = [towards, right, towards.cross(right)];
        Self { view, middle, axes, cos_acceptance: view.acceptance.cos(), may_hide }
    }

    /// The pixel in which a photon is seen that leaves, and what it adds there to the radiance.
    fn see(&self, scene: &Scene, photon: &Photon) -> Option<(usize, f64)> {
        let [towards, right, up] = self.axes;
        let (dir, hit) = (photon.dir().as_dvec3(), photon.met.as_ref()?);
        if dir.dot(towards) < self.cos_acceptance {
            return None;
        }
        let normal = if dir.dot(hit.ng.as_dvec3()) < 0.0 { -hit.ng } else { hit.ng };
        let cosine = normal.as_dvec3().dot(towards);
        if cosine <= 0.0 || self.may_hide && scene.geometry.occluded(&hit.spawn(towards.as_vec3()), f32::INFINITY) {
            return None;
        }
        let from_middle = photon.at_surface.as_dvec3() - self.middle;
        let edge = f64::from(self.view.pixels);
        let column = (from_middle.dot(right) / self.view.width + 0.5) * edge;
        let row = (0.5 - from_middle.dot(up) / self.view.width) * edge;
        if !(0.0..edge).contains(&column) || !(0.0..edge).contains(&row) {
            return None;
        }
        let area = (self.view.width / edge).powi(2);
        let radiance = photon.weight() * cosine / (area * projected_cone(cosine, self.view.acceptance));
        Some((row as usize * self.view.pixels as usize + column as usize, radiance))
    }
}

/// The solid angle [sr] of a cone of half-angle `angle`, in (0, π/2), whose axis is at a positive `cosine` to a surface, as
/// far as it is above the surface and projected on it: `∫ max(0, n·ω) dω` (Snyder 1996, "Area light sources for real-time
/// graphics").
pub fn projected_cone(cosine: f64, angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    if cosine >= sin {
        return PI * sin * sin * cosine;
    }
    let sine = (1.0 - cosine * cosine).sqrt();
    let cotangent = cos / sin;
    let y = -cotangent * cosine / sine;
    let chord = sine * (1.0 - y * y).max(0.0).sqrt();
    (cosine * y.clamp(-1.0, 1.0).acos() - cotangent * chord) * sin * sin + (chord / cotangent).atan()
}

struct Recorder<'a> {
    setup: &'a Setup,
    scene: &'a Scene,
    camera: Option<Camera>,
    totals: Vec<f64>,
}

impl Recorder<'_> {
    /// Whether it leaves through what faces the beam.
    fn comes_back(photon: &Photon) -> bool {
        let facing = |normal: Vec3| if photon.dir().dot(normal) < 0.0 { -normal.z } else { normal.z };
        photon.met.is_some_and(|hit| facing(hit.ng) > 1e-6)
    }
}

impl Detector for Recorder<'_> {
    fn awaits(&self, _order: u32) -> u32 {
        u32::MAX
    }

    fn collide(&mut self, c: &Collision) {
        self.totals[3] += c.absorbed;
    }

    fn leave(&mut self, photon: &Photon) {
        let weight = photon.weight();
        if photon.order() == 0 {
            self.totals[2] += weight;
            return;
        }
        if Self::comes_back(photon) {
            self.totals[0] += weight;
            let from_axis = photon.at_surface.as_dvec3().truncate() - self.setup.aim;
            if let Some(ring) = self.setup.radii.find(from_axis.length()) {
                self.totals[TOTALS + ring] += weight;
            }
        } else {
            self.totals[1] += weight;
        }
        if let Some((pixel, radiance)) = self.camera.and_then(|camera| camera.see(self.scene, photon)) {
            self.totals[TOTALS + self.setup.radii.count() + pixel] += radiance;
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }
}

#[cfg(test)]
mod tests;
