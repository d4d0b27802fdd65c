//! An isotropic point source of power 1 in an infinite medium: its fluence `φ(r)` [1/length²] against distance.
//!
//! The fluence in a shell of volume V is estimated from collisions, `φ = Σ w / (σ_t V)`, unscattered light included. What is
//! reported is `4π r² φ`, averaged over the shell's radius: the power that crosses spheres around the source, counted both
//! ways, which is 1 near the source and falls off as the asymptotic `r exp(−r/ν₀)` in the end.

use std::f32::consts::PI;

use glam::DVec3;
use tyndall::{
    math::{Ray, Vec3},
    sampling::rng::Rng,
    scene::Scene,
};

use crate::photon::{Collision, Detector, shoot};
use crate::run::{Estimate, Sums, Verdict};
use crate::world::{SetupError, Substance, World};

/// The fluence of a shell.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Shell {
    /// From this distance on [length].
    pub inner: f64,
    /// To this one [length].
    pub outer: f64,
    /// Mean of `4π r² φ` over the shell \[1\].
    pub fluence: Estimate,
}

struct Recorder<'a> {
    radii: &'a [f64],
    totals: Vec<f64>,
}

impl Detector for Recorder<'_> {
    fn collide(&mut self, c: &Collision) {
        let r = c.p.as_dvec3().length();
        let shell = self.radii.partition_point(|radius| *radius <= r);
        if (1..self.radii.len()).contains(&shell) {
            self.totals[shell - 1] += c.weight;
        }
        let last = self.totals.len() - 3;
        self.totals[last] += c.weight;
        self.totals[last + 1] += c.weight * r * r;
        self.totals[last + 2] += c.weight * r.powi(4);
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }
}

/// The fluence by distance, and its moments.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Fluence {
    /// Photons.
    pub photons: u64,
    /// By distance.
    pub shells: Vec<Shell>,
    /// `∫ 4π r² φ dr` [length].
    pub m0: Estimate,
    /// `∫ 4π r² φ r² dr` [length³].
    pub m2: Estimate,
    /// `∫ 4π r² φ r⁴ dr` \[length⁵\].
    pub m4: Estimate,
}

/// Measures the fluence between each of `radii` [length] and the next; they increase.
///
/// # Errors
/// The substance cannot be, neither absorbs nor scatters, or there is no shell.
pub fn fluence(
    substance: &Substance,
    radii: &[f64],
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Fluence, SetupError> {
    if radii.len() < 2 || radii.windows(2).any(|w| w[0].partial_cmp(&w[1]) != Some(std::cmp::Ordering::Less)) {
        return Err(SetupError::Missing("shell: at least two radii, which increase"));
    }
    crate::world::within("the absorption coefficient", substance.sigma_a, "positive, or light never ends", |s| {
        s > 0.0
    })?;
    Ok(fluence_in(&scene(substance)?, substance, radii, photons, seed, look))
}

/// Nothing but the medium.
pub(crate) fn scene(substance: &Substance) -> Result<Scene, SetupError> {
    World::default().build(substance, DVec3::ZERO)
}

/// The same in a scene that is made already.
pub(crate) fn fluence_in(
    scene: &Scene,
    substance: &Substance,
    radii: &[f64],
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Fluence {
    let recorder = || Recorder { radii, totals: vec![0.0; radii.len() + 2] };
    let ray = |photon| Ray::new(Vec3::ZERO, any_direction(photon, seed));
    let sums = shoot(scene, photons, seed, ray, recorder, look);
    let by_sigma = 1.0 / substance.sigma_t();
    let shell = |(i, w): (usize, &[f64])| Shell {
        inner: w[0],
        outer: w[1],
        fluence: sums.estimate(i).scaled(by_sigma / (w[1] - w[0])),
    };
    let last = radii.len() - 1;
    Fluence {
        photons: sums.photons(),
        shells: radii.windows(2).enumerate().map(shell).collect(),
        m0: sums.estimate(last).scaled(by_sigma),
        m2: sums.estimate(last + 1).scaled(by_sigma),
        m4: sums.estimate(last + 2).scaled(by_sigma),
    }
}

/// A direction of an isotropic source, from a stream that the photon's own walk does not use.
pub(crate) fn any_direction(photon: u64, seed: u64) -> Vec3 {
    let mut rng = source_stream(photon, seed);
    let (z, azimuth) = (1.0 - 2.0 * rng.next_1d(), 2.0 * PI * rng.next_1d());
    let (sin, cos) = azimuth.sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

/// Random numbers for the source of a photon.
pub(crate) fn source_stream(photon: u64, seed: u64) -> Rng {
    Rng::for_sample((photon as u32, (photon >> 32) as u32), 1, seed)
}
