//! What a grain of a pack does to light, measured once: where light leaves that has met one, and what is left of it.
//!
//! Light comes from everywhere alike, and meets a grain of radius `r` as often as its cross section is large, `∝ r²`: isotropic,
//! uniform lines are drawn through a grain of radius 1, and a radius with them. The grain is a smooth dielectric. Light is
//! reflected or refracted by Fresnel's equations, by chance, until it is outside again, having come `L` through the inside; a
//! wavelength keeps `w = exp(−σ_a L)` of it, so that all wavelengths share the same ways. With `d`, `d'` the directions of travel
//! before and after and `δ` the way from where light meets the grain to where it leaves, per wavelength
//!
//! ```text
//! a = ⟨w⟩    g = ⟨w d·d'⟩ / a    A = ⟨w δ·(d + d')⟩ / 2a    B = ⟨w δ²⟩ / a
//! ```
//!
//! `⟨δ·d⟩ = ⟨δ·d'⟩`, for every way is as likely as the same way back (Helmholtz), so that `A` is the mean of both.
//!
//! A line that enters a grain with hollows several times meets it as often. What light does that leaves such a grain and meets
//! it again is another meeting.

use glam::{DMat4, DVec3};
use tyndall::{
    bsdf::{Bsdf, Dielectric},
    math::{Ray, Transform, Vec3},
    path::Vertex,
    sampling::Rng,
    shape::{Geometry, GeometryBuilder, Interaction, Mesh, ShapeError, Sphere},
};

use crate::{form::Form, free_path::line, pack::Pack, uniform};

/// Lines that are drawn.
const LINES: u32 = 1 << 19;
/// Reflections inside after which light has got lost.
const MOST: u32 = 10_000;
/// Cosines of the table of the phase function, regularly spaced from −1 to 1.
pub const COSINES: usize = 401;

/// What grains are of, optically.
#[derive(Debug, Clone)]
pub struct Substance {
    /// Refractive index \[1\].
    pub eta: f64,
    /// Absorption coefficients, by wavelength [1/length].
    pub sigma_a: Vec<f64>,
}

/// What grains do to light.
#[derive(Debug, Clone)]
pub struct Scattering {
    /// By wavelength.
    pub meetings: Vec<Meeting>,
    /// Relative light by the cosine between `d` and `d'`, all wavelengths together: see [`tyndall::phase::Tabulated`].
    pub phase: Vec<f64>,
}

/// A meeting of light with a grain, in the mean.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Meeting {
    /// `a`: the part of the light that leaves \[1\].
    pub albedo: f64,
    /// `g` \[1\].
    pub mean_cosine: f64,
    /// `A` [length].
    pub advance: f64,
    /// `B` [length²].
    pub square: f64,
}

impl Pack {
    /// Measures what its grains do to light.
    ///
    /// # Errors
    /// The grain is too small for a number, or stretched beyond it.
    pub fn scattering(&self, substance: &Substance, seed: u64) -> Result<Scattering, ShapeError> {
        let grain = grain(&self.form)?;
        let bsdf = Bsdf::Dielectric(Dielectric::new(substance.eta as f32));
        let mut meetings = vec![Meeting::default(); substance.sigma_a.len()];
        let mut phase = vec![0.0; COSINES];
        let mut met = 0.0;
        for index in 0..LINES {
            let mut rng = Rng::for_sample((3, 0), index, seed);
            let radius = self.radius(&mut rng);
            let (origin, dir) = line(self.form.reach(), &mut rng);
            let dir = dir.as_vec3();
            for entry in entries(&grain, origin.as_vec3() - 2.0 * self.form.reach() as f32 * dir, dir) {
                let Some(way) = way(&grain, &bsdf, entry, dir, &mut rng) else { continue };
                met += 1.0;
                let (cosine, delta) = (f64::from(dir.dot(way.dir)), (way.end - entry.p).as_dvec3() * radius);
                let advance = 0.5 * delta.dot((dir + way.dir).as_dvec3());
                for (sum, sigma_a) in meetings.iter_mut().zip(&substance.sigma_a) {
                    let left = (-sigma_a * way.inside * radius).exp();
                    sum.albedo += left;
                    sum.mean_cosine += left * cosine;
                    sum.advance += left * advance;
                    sum.square += left * delta.length_squared();
                    strew(&mut phase, cosine, left);
                }
            }
        }
        for meeting in &mut meetings {
            let light = meeting.albedo;
            *meeting = Meeting {
                albedo: light / met,
                mean_cosine: meeting.mean_cosine / light,
                advance: meeting.advance / light,
                square: meeting.square / light,
            };
        }
        // The table's ends stand for half as wide a range of cosines.
        phase[0] *= 2.0;
        phase[COSINES - 1] *= 2.0;
        Ok(Scattering { meetings, phase })
    }

    /// The radius of a grain that light meets.
    fn radius(&self, rng: &mut Rng) -> f64 {
        loop {
            let radius = self.grains[(uniform(rng) * self.grains.len() as f64) as usize].radius;
            if uniform(rng) < (radius / self.largest).powi(2) {
                return radius;
            }
        }
    }
}

/// A grain of radius 1 for rays.
fn grain(form: &Form) -> Result<Geometry, ShapeError> {
    let mut builder = GeometryBuilder::new();
    match (form, form.triangles()) {
        (_, Some((points, triangles))) => {
            let positions = points.into_iter().map(DVec3::as_vec3).collect();
            let mesh = Mesh { positions, indices: triangles.to_vec(), ..Mesh::default() };
            builder.add_mesh(mesh, &Transform::IDENTITY, false)?;
        }
        (form, None) => {
            let axes = if let Form::Ellipsoid(axes) = form { *axes } else { DVec3::ONE };
            let stretch = Transform::new(DMat4::from_scale(axes)).ok_or(ShapeError::NotFinite)?;
            builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &stretch, false)?;
        }
    }
    builder.build()
}

/// Where a line enters the grain.
fn entries(grain: &Geometry, origin: Vec3, dir: Vec3) -> Vec<Interaction> {
    let mut ray = Ray::new(origin, dir);
    let mut entries = Vec::new();
    while let Some(hit) = grain.intersect(&ray, f32::INFINITY) {
        let surface = grain.interaction(&ray, &hit);
        ray = surface.spawn(dir);
        if dir.dot(surface.ng) < 0.0 {
            entries.push(surface);
        }
    }
    entries
}

/// A way of light through a grain of radius 1.
struct Way {
    end: Vec3,
    dir: Vec3,
    /// What of it is inside.
    inside: f64,
}

/// From where light enters; `None` if it gets lost by rounding, or never comes out.
fn way(grain: &Geometry, bsdf: &Bsdf, mut at: Interaction, mut dir: Vec3, rng: &mut Rng) -> Option<Way> {
    let mut inside = 0.0;
    for _ in 0..MOST {
        let numbers = [rng.next_1d(), rng.next_1d(), rng.next_1d()];
        let ray = Vertex::surface(at, *bsdf, dir).sample(numbers)?.ray;
        if ray.dir.dot(at.ng) > 0.0 {
            return Some(Way { end: at.p, dir: ray.dir, inside });
        }
        let hit = grain.intersect(&ray, f32::INFINITY)?;
        inside += f64::from(hit.t);
        (at, dir) = (grain.interaction(&ray, &hit), ray.dir);
    }
    None
}

/// Adds light at a cosine to the two nearest places of a table, so that the mean cosine stays what it is.
fn strew(table: &mut [f64], cosine: f64, light: f64) {
    let last = table.len() - 1;
    let place = (0.5 * (cosine + 1.0)).clamp(0.0, 1.0) * last as f64;
    let below = (place as usize).min(last - 1);
    let share = place - below as f64;
    table[below] += (1.0 - share) * light;
    table[below + 1] += share * light;
}
