//! A scattering ball: what of the light sent at it, or made in it, is absorbed or escapes.

use glam::DVec3;
use tyndall::math::{Ray, Vec3};
use tyndall::scene::Scene;

use crate::photon::{Collision, Detector, Photon, shoot};
use crate::point::{any_direction, source_stream};
use crate::run::{Estimate, Sums, Verdict};
use crate::world::{SetupError, Substance, World, within};

/// Where the light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Source {
    /// A wide parallel beam from outside.
    Beam,
    /// Uniform and isotropic inside of the ball.
    Volume,
}

/// What became of the light.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Balance {
    /// Photons.
    pub photons: u64,
    /// Absorbed part \[1\].
    pub absorbed: Estimate,
    /// Part that leaves \[1\].
    pub escaped: Estimate,
    /// Part that leaves without a collision \[1\].
    pub unscattered: Estimate,
    /// Of what leaves, power times the cosine between the way out and the beam's way in \[1\].
    pub forward: Estimate,
    /// The way that light has in the ball, for each photon that is sent [length]; 0 where nothing can collide.
    pub way: Estimate,
    /// Part that leaves after 0, 1, 2, … collisions \[1\].
    pub by_order: Vec<Estimate>,
}

struct Recorder {
    totals: Vec<f64>,
}

/// Orders that are kept apart.
const ORDERS: usize = 16;
/// Quantities before them.
const OTHERS: usize = 4;

impl Detector for Recorder {
    fn collide(&mut self, c: &Collision) {
        self.totals[0] += c.absorbed;
        self.totals[3] += c.weight;
    }

    fn leave(&mut self, photon: &Photon) {
        self.totals[1] += photon.weight();
        self.totals[2] -= photon.weight() * f64::from(photon.dir().z);
        if let Some(total) = self.totals.get_mut(OTHERS + photon.order() as usize) {
            *total += photon.weight();
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }
}

/// Sends photons at a ball of `radius` [length] in vacuum, or starts them in it.
///
/// # Errors
/// The substance or the radius cannot be.
pub fn balance(
    substance: &Substance,
    radius: f64,
    source: Source,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Balance, SetupError> {
    Ok(balance_in(&scene(substance, radius, source)?, substance, radius, source, photons, seed, look))
}

/// The ball, with photons that start where the source is.
pub(crate) fn scene(substance: &Substance, radius: f64, source: Source) -> Result<Scene, SetupError> {
    within("the radius", radius, "positive", |r| r > 0.0 && r.is_finite())?;
    let mut world = World::default();
    world.sphere(radius, substance, &Substance::VACUUM)?;
    match source {
        Source::Beam => world.build(&Substance::VACUUM, 2.0 * radius * DVec3::Z),
        Source::Volume => world.build(substance, DVec3::ZERO),
    }
}

/// The same in a scene that is made already.
pub(crate) fn balance_in(
    scene: &Scene,
    substance: &Substance,
    radius: f64,
    source: Source,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Balance {
    let recorder = || Recorder { totals: vec![0.0; OTHERS + ORDERS] };
    let ray = |photon| ray_of(source, radius as f32, photon, seed);
    let sums = shoot(scene, photons, seed, ray, recorder, look);
    let free_path = if substance.sigma_t() > 0.0 { 1.0 / substance.sigma_t() } else { 0.0 };
    Balance {
        photons: sums.photons(),
        absorbed: sums.estimate(0),
        escaped: sums.estimate(1),
        forward: sums.estimate(2),
        way: sums.estimate(3).scaled(free_path),
        unscattered: sums.estimate(OTHERS),
        by_order: sums.estimates(OTHERS..OTHERS + ORDERS),
    }
}

/// The way of a photon from the source on.
pub(crate) fn ray_of(source: Source, radius: f32, photon: u64, seed: u64) -> Ray {
    // The first two numbers of the stream are those of the direction.
    let mut rng = source_stream(photon, seed);
    let (u, v, w) = (rng.next_1d(), rng.next_1d(), rng.next_1d());
    match source {
        Source::Beam => {
            let (sin, cos) = (std::f32::consts::TAU * v).sin_cos();
            let r = radius * u.sqrt();
            Ray::new(Vec3::new(r * cos, r * sin, 2.0 * radius), -Vec3::Z)
        }
        Source::Volume => {
            let dir = any_direction(photon, seed);
            let place = any_direction(photon, seed ^ 0x9e37_79b9_7f4a_7c15);
            Ray::new(place * (radius * w.cbrt()), dir)
        }
    }
}
