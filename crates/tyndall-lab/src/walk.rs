//! A random walk in an infinite medium that does not absorb: where a photon is after its n-th free flight.
//!
//! With mean free path 1 and a phase function of mean cosine g, starting along +z:
//!
//! ```text
//! ⟨z⟩  = (1 − gⁿ) / (1 − g)
//! ⟨r²⟩ = 2 (n/(1 − g) − g (1 − gⁿ)/(1 − g)²)
//! ```

use glam::DVec3;
use tyndall::math::{Ray, Vec3};
use tyndall::scene::Scene;

use crate::photon::{Collision, Detector, shoot};
use crate::run::{Estimate, Sums, Verdict};
use crate::world::{SetupError, Substance, World};

/// Moments of the place after a number of flights, in mean free paths.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Moments {
    /// Free flights so far.
    pub flights: u32,
    /// Photons.
    pub photons: u64,
    /// Mean place along the first direction.
    pub z: Estimate,
    /// Mean squared distance.
    pub r2: Estimate,
    /// Mean squared place along the first direction.
    pub z2: Estimate,
}

struct Recorder<'a> {
    flights: &'a [u32],
    totals: Vec<f64>,
}

impl Detector for Recorder<'_> {
    fn collide(&mut self, c: &Collision) {
        // Collisions told together bear the number of their first, which is none of these.
        if let Some(i) = self.flights.iter().position(|n| *n == c.order + 1) {
            let p = c.p.as_dvec3();
            for (quantity, value) in [p.z, p.length_squared(), p.z * p.z].into_iter().enumerate() {
                self.totals[3 * i + quantity] += c.weight * value;
            }
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }

    fn awaits(&self, order: u32) -> u32 {
        // The n-th flight ends at collision n − 1.
        self.flights.iter().map(|n| n - 1).filter(|next| *next >= order).min().unwrap_or(u32::MAX)
    }

    fn is_done(&self, order: u32) -> bool {
        self.flights.iter().all(|n| *n <= order)
    }
}

/// Measures the moments after each of `flights`.
///
/// # Errors
/// `g` is outside of (−1, 1), or nothing is to be measured.
pub fn moments(
    g: f64,
    flights: &[u32],
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Vec<Moments>, SetupError> {
    if flights.is_empty() || flights.contains(&0) {
        return Err(SetupError::Missing("number of flights"));
    }
    Ok(moments_in(&scene(g)?, flights, photons, seed, look))
}

/// Nothing but a medium that does not absorb, of mean free path 1.
pub(crate) fn scene(g: f64) -> Result<Scene, SetupError> {
    World::default().build(&Substance::of_albedo(1.0, g), DVec3::ZERO)
}

/// The same in a scene that is made already.
pub(crate) fn moments_in(
    scene: &Scene,
    flights: &[u32],
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Vec<Moments> {
    let recorder = || Recorder { flights, totals: vec![0.0; 3 * flights.len()] };
    let sums = shoot(scene, photons, seed, |_| Ray::new(Vec3::ZERO, Vec3::Z), recorder, look);
    let moment = |i: usize, n: u32| Moments {
        flights: n,
        photons: sums.photons(),
        z: sums.estimate(3 * i),
        r2: sums.estimate(3 * i + 1),
        z2: sums.estimate(3 * i + 2),
    };
    flights.iter().enumerate().map(|(i, n)| moment(i, *n)).collect()
}
