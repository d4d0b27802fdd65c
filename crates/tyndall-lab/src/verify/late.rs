//! Half-spaces that absorb nothing.
//!
//! All light returns, but after a number of collisions that has no mean: what has not returned after N of them falls off as
//! `C/√N + D/√N³ + …` only (odd powers: `R(ϖ)` is analytic in `√(1 − ϖ)`). No experiment that ends can wait for it, and a
//! roulette at the end would put all the weight on the few that come late. So photons are followed for 16 N collisions, and
//! what returned within N, 4 N and 16 N is extrapolated: `(16 R(16N) − 10 R(4N) + R(N))/7` is free of both terms.

use super::experiment::Share;
use crate::photon::{Detector, Photon, shoot};
use crate::run::Estimate;
use crate::slab::Setup;
use crate::world::SetupError;

/// What is left of the tail: terms from `1/√N⁵` on.
pub(super) const ACCURACY: f64 = 1e-4;
/// N, in reduced mean free paths.
const FIRST: f64 = 64.0;

/// Whether all light returns from a layer of this albedo and optical thickness, but late.
pub(super) fn returns_late(albedo: f64, tau: f64) -> bool {
    albedo == 1.0 && tau.is_infinite()
}

/// What returns.
pub(super) struct Returned {
    /// All of it, by extrapolation \[1\].
    pub(super) reflectance: Estimate,
    /// After one collision, and after two \[1\].
    pub(super) by_order: [Estimate; 2],
}

struct Recorder {
    first: u32,
    totals: Vec<f64>,
}

impl Detector for Recorder {
    fn awaits(&self, _order: u32) -> u32 {
        u32::MAX
    }

    fn leave(&mut self, photon: &Photon) {
        if photon.dir().z < 0.0 {
            return;
        }
        let sevenths = match photon.order() {
            n if n <= self.first => 7.0,
            n if n <= 4 * self.first => 6.0,
            n if n <= 16 * self.first => 16.0,
            _ => 0.0,
        };
        self.totals[0] += photon.weight() * sevenths / 7.0;
        if let Some(total @ 1..=2) = Some(photon.order() as usize) {
            self.totals[total] += photon.weight();
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }

    fn is_done(&self, order: u32) -> bool {
        order > 16 * self.first
    }
}

/// Lets light into a half-space that absorbs nothing, and waits.
pub(super) fn measure(share: Share, setup: &Setup) -> Result<Returned, SetupError> {
    setup.check()?;
    let scene = share.scene(setup.scene()?);
    let first = (FIRST / (1.0 - setup.layers[0].substance.g)).ceil() as u32;
    let recorder = || Recorder { first, totals: vec![0.0; 3] };
    let ray = |photon| setup.ray(photon, share.seed);
    let sums = shoot(&scene, share.photons, share.seed, ray, recorder, share.look(0..3));
    Ok(Returned { reflectance: sums.estimate(0), by_order: [sums.estimate(1), sums.estimate(2)] })
}
