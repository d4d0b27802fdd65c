//! The medium that stands for a pack: a homogeneous one in which light wanders as it does from grain to grain.
//!
//! Light that wanders among grains takes, in turn, gaps of mean length `λ` and grains (see [`scattering`](crate::scattering)). Let
//! gaps be exponential and independent of the grains, as they nearly are between balls (Torquato and Lu 1993), and grains
//! independent of each other. After many meetings the mean square of the displacement grows, for each of them, by
//!
//! ```text
//! D = ⟨ℓ²⟩ + B + 2 (λ² g + 2 λ A + A²) / (1 − g),    ⟨ℓ²⟩ = 2λ²
//!   = 2 (λ + A)² / (1 − g) + B
//! ```
//!
//! (the sum of all products of two steps; the direction after `k` more meetings is `g^k` of the present one). In a medium it is
//! `2 / (σ_t² (1 − g))` for each collision. The medium whose collisions are meetings, with their albedo and their phase
//! function, therefore carries light as far if
//!
//! ```text
//! 1/σ_t = √( (λ + A)² + (1 − g) B / 2 ).
//! ```
//!
//! Few and small grains make it `n σ_geom`; grains that do not turn light, of index 1, too.
//!
//! The gap is that of stereology over all of what the medium fills, `λ = 4 (V − V_grains) / S_grains`, so that as much grain is in the
//! medium as in the pack. A medium has one phase function, that of all wavelengths together with the mean cosine `ḡ`. At each
//! wavelength `σ_s (1 − ḡ)` is what it is with the `g` of that wavelength, and `σ_a = (1 − a) σ_t`.
//!
//! Not in it: that a grain hides the next, that the way to the next grain is often the way back, that grains lie in layers at walls.
//! The medium is right for few grains, and for dense packs nearly.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use tyndall::{phase::Tabulated, sampling::Rng, shape::ShapeError};

use crate::{
    GrainError,
    container::Container,
    pack::Pack,
    scattering::{Meeting, Scattering, Substance},
    uniform,
};

/// Columns that find how high grains lie.
const COLUMNS: u32 = 1000;
/// Edges of a round body.
const EDGES: u32 = 256;

/// A medium for grains.
#[derive(Debug, Clone)]
pub struct Proxy {
    /// What it fills.
    pub body: Body,
    /// Absorption, by the wavelengths of the substance [1/length].
    pub sigma_a: Vec<f64>,
    /// Scattering [1/length].
    pub sigma_s: Vec<f64>,
    /// Relative values at regular cosines from −1 to 1.
    pub phase: Vec<f64>,
    /// The mean cosine of that \[1\].
    pub mean_cosine: f64,
    /// Of light that meets a grain, by wavelength.
    pub meetings: Vec<Meeting>,
}

/// A closed body, its centre where the container has it.
#[derive(Debug, Clone)]
pub enum Body {
    /// Of this radius.
    Ball(f64),
    /// Points, and triangles that are counterclockwise from outside.
    Mesh(Vec<DVec3>, Vec<[u32; 3]>),
}

/// Why there is no medium for a pack.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProxyError {
    /// Of the grain.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Of the pack.
    #[error(transparent)]
    Grains(#[from] GrainError),
}

impl Pack {
    /// The medium that stands for its grains, up to a height if they do not fill the container ([`Self::level`]).
    ///
    /// # Errors
    /// A grain of a size that no number has; a mesh that is not full.
    pub fn proxy(&self, substance: &Substance, level: Option<f64>, seed: u64) -> Result<Proxy, ProxyError> {
        let (body, volume) = self.container.below(level, self.largest)?;
        let grains = 4.0 / 3.0 * PI * self.moment(3);
        let gap = 4.0 * (volume - grains) / (self.form.surface() * self.moment(2));
        let Scattering { meetings, phase } = self.scattering(substance, seed)?;
        let table = Tabulated::new(&phase).map_err(|_| ShapeError::NotFinite)?;
        let mean_cosine = f64::from(table.mean_cosine());
        let sigma_t = |m: &Meeting| 1.0 / ((gap + m.advance).powi(2) + 0.5 * (1.0 - m.mean_cosine) * m.square).sqrt();
        let sigma_s = |m: &Meeting| sigma_t(m) * m.albedo * (1.0 - m.mean_cosine) / (1.0 - mean_cosine);
        Ok(Proxy {
            body,
            sigma_a: meetings.iter().map(|m| sigma_t(m) * (1.0 - m.albedo)).collect(),
            sigma_s: meetings.iter().map(sigma_s).collect(),
            phase,
            mean_cosine,
            meetings,
        })
    }

    /// How high grains lie that have settled: in the mean, what a plumb line meets first.
    pub fn level(&self, seed: u64) -> f64 {
        let (half, reach) = (self.container.half(), self.form.reach());
        let mut rng = Rng::for_sample((4, 0), 0, seed);
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..COLUMNS {
            let place = half * DVec3::new(2.0 * uniform(&mut rng) - 1.0, 2.0 * uniform(&mut rng) - 1.0, 0.0);
            let near = self
                .grains
                .iter()
                .filter(|grain| grain.centre.truncate().distance(place.truncate()) < reach * grain.radius);
            let tops = near.filter_map(|grain| self.form.passages(grain, place, DVec3::Z).last().copied());
            if let Some(top) = tops.max_by(f64::total_cmp) {
                sum += top;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { half.z }
    }
}

impl Container {
    /// What of it is below a height, and its volume; all of it if the height is nowhere or but a grain's radius below the top.
    fn below(&self, level: Option<f64>, grain: f64) -> Result<(Body, f64), GrainError> {
        let top = self.half().z;
        let level = level.filter(|level| *level < top - grain);
        let profile = match (self, level) {
            (Self::Mesh(_), Some(_)) => return Err(GrainError::NotFull),
            (Self::Mesh(solid), None) => {
                let points = solid.points.iter().map(|point| *point * solid.unit).collect();
                return Ok((Body::Mesh(points, solid.triangles.clone()), solid.volume()));
            }
            (Self::Sphere(radius), None) => return Ok((Body::Ball(*radius), self.volume())),
            (Self::Box(half), level) => {
                let corner = |x: f64, y: f64| DVec3::new(x * half.x, y * half.y, 0.0);
                let base = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                let level = level.unwrap_or(top);
                return Ok((tower(&base, &[(1.0, -top), (1.0, level)]), 4.0 * half.x * half.y * (level + top)));
            }
            (Self::Cylinder(radius, half), level) => vec![(*radius, -half), (*radius, level.unwrap_or(top))],
            (Self::Sphere(radius), Some(level)) => {
                let highest = (level / radius).clamp(-1.0, 1.0).acos();
                let angle = |i: u32| PI - (PI - highest) * f64::from(i) / f64::from(EDGES / 2);
                // The pole is a point: a ring around it that is too small to be seen.
                let ring = |i: u32| (radius * angle(i).sin().max(1e-6), radius * angle(i).cos());
                (0..=EDGES / 2).map(ring).collect()
            }
        };
        // A polygon as large as the circle that it stands for.
        let corner = TAU / f64::from(EDGES);
        let grown = (corner / corner.sin()).sqrt();
        let turn = |i: u32| DVec3::new((corner * f64::from(i)).cos(), (corner * f64::from(i)).sin(), 0.0) * grown;
        let base: Vec<DVec3> = (0..EDGES).map(turn).collect();
        let slices = profile.windows(2).map(|ends| {
            let [(a, low), (b, high)] = [ends[0], ends[1]];
            PI / 3.0 * (a * a + a * b + b * b) * (high - low)
        });
        Ok((tower(&base, &profile), slices.sum()))
    }
}

/// A convex base (counterclockwise from above), stretched and lifted, ring upon ring, between two lids.
fn tower(base: &[DVec3], rings: &[(f64, f64)]) -> Body {
    let n = base.len() as u32;
    let ring = |&(stretch, z): &(f64, f64)| base.iter().map(move |p| DVec3::new(p.x * stretch, p.y * stretch, z));
    let points = rings.iter().flat_map(ring).collect();
    let last = n * (rings.len() as u32 - 1);
    let mut triangles = Vec::new();
    for low in (0..last).step_by(n as usize) {
        for i in 0..n {
            let [a, b] = [low + i, low + (i + 1) % n];
            triangles.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    triangles.extend((1..n - 1).flat_map(|i| [[0, i + 1, i], [last, last + i, last + i + 1]]));
    Body::Mesh(points, triangles)
}
