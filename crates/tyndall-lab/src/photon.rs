//! Photons: launched, followed event by event with the renderer's own walk, watched by a detector.
//!
//! A photon is a [`Path`] that starts at the source. The renderer's paths carry radiance, which is compressed by `1/η²`
//! where light enters a denser body; a photon carries power, which is not. [`Photon::weight`] undoes the compression.
//! There are no lights in an experiment, so a path's response to an event is the walk and nothing else.

use tyndall::{
    integrator::volpath::Status,
    integrator::{CameraSample, VolPath},
    math::{Ray, Vec3},
    medium::MediumId,
    path::{Event, Path},
    sampling::{Sampler, SamplerKind},
    scene::Scene,
    shape::Interaction,
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

use crate::run::{Sums, Verdict, photons_of, run};

/// A photon on its way.
#[derive(Debug)]
pub struct Photon {
    path: Path,
    /// Where it last met a surface, or started [length].
    pub at_surface: Vec3,
    /// The surface that it last met, if any.
    pub met: Option<Interaction>,
    /// Length of its way so far [length].
    pub travelled: f64,
    /// In which direction it was sent.
    pub launched: Vec3,
}

/// A collision.
#[derive(Debug, Clone, Copy)]
pub struct Collision {
    /// Where [length].
    pub p: Vec3,
    /// The power that collides, as a part of what was sent \[1\].
    pub weight: f64,
    /// What of it is absorbed \[1\].
    pub absorbed: f64,
    /// Length of the way so far [length].
    pub travelled: f64,
    /// Collisions before this one.
    pub order: u32,
    /// The medium, where there is only one.
    pub medium: Option<MediumId>,
}

/// What looks at photons.
pub trait Detector {
    /// A photon collides.
    fn collide(&mut self, _collision: &Collision) {}
    /// A photon has met a surface, and has lost so much of its power there \[1\]; roulette counts too, in the mean as
    /// nothing.
    fn meet(&mut self, _surface: &Interaction, _lost: f64) {}
    /// A photon leaves for good. Its [`Photon::dir`] is that in which it leaves [`Photon::at_surface`].
    fn leave(&mut self, _photon: &Photon) {}
    /// What it has seen so far: a total for each quantity.
    fn totals(self) -> Vec<f64>;
    /// Whether a photon is to be followed no further after this many collisions.
    fn is_done(&self, _order: u32) -> bool {
        false
    }
}

impl Photon {
    /// The power that it carries, as a part of what was sent \[1\].
    pub fn weight(&self) -> f64 {
        f64::from(self.path.weights.emission(|| 0.0).lane(0) * self.path.history.eta_scale)
    }

    /// Direction of travel.
    pub fn dir(&self) -> Vec3 {
        self.path.ray.dir
    }

    /// By how much radiance is greater where it started than where it is, because of the indices of refraction \[1\].
    pub fn compression(&self) -> f64 {
        1.0 / f64::from(self.path.history.eta_scale)
    }

    /// How often it has met a surface or collided.
    pub fn vertices(&self) -> u32 {
        self.path.history.vertices
    }

    /// How often it has been scattered.
    pub fn order(&self) -> u32 {
        self.path.history.order
    }
}

/// An experiment: launches photons in batches, each along the ray of its number, past a detector that starts anew with
/// every batch, until there are `photons` or `look` has seen enough.
pub(crate) fn shoot<D: Detector>(
    scene: &Scene,
    photons: u64,
    seed: u64,
    ray: impl Fn(u64) -> Ray + Sync,
    detector: impl Fn() -> D + Sync,
    look: impl FnMut(&Sums) -> Verdict,
) -> Sums {
    let batch = |number| {
        let (mut detector, mut tally) = (detector(), Tally::default());
        for photon in photons_of(number) {
            launch(scene, ray(photon), photon, seed, &mut detector, &mut tally);
        }
        (detector.totals(), tally)
    };
    run(detector().totals().len(), photons, batch, look)
}

/// Launches the photon number `index` along `ray` and follows it to its end.
pub fn launch(scene: &Scene, ray: Ray, index: u64, seed: u64, detector: &mut impl Detector, tally: &mut Tally) {
    let sampler = Sampler::new(SamplerKind::Independent, (index as u32, (index >> 32) as u32), 0, seed);
    let seen = CameraSample { ray, wavelengths: Wavelengths::Mono, u_hero: 0.0, sampler };
    let path = Path::new(scene, &seen);
    let mut photon = Photon { at_surface: ray.origin, met: None, path, travelled: 0.0, launched: ray.dir };
    // There are no lights to find.
    let (walk, mut nothing) = (VolPath::default(), Lanes::ZERO);
    tally.paths += 1;
    loop {
        let (weight, from, order) = (photon.weight(), photon.path.ray.origin, photon.order());
        let medium = photon.path.inside.id();
        let event = photon.path.next_event(scene, tally);
        let p = match &event {
            Event::Escape => return detector.leave(&photon),
            Event::Surface(hit) => hit.p,
            Event::Scatter { p, .. } | Event::Absorb { p, .. } => *p,
        };
        photon.travelled += f64::from((p - from).length());
        match event {
            Event::Surface(hit) => (photon.at_surface, photon.met) = (p, Some(hit)),
            Event::Scatter { .. } => {
                let absorbed = weight - photon.weight();
                detector.collide(&Collision { p, weight, absorbed, travelled: photon.travelled, order, medium });
            }
            _ => {
                let travelled = photon.travelled;
                detector.collide(&Collision { p, weight, absorbed: weight, travelled, order, medium });
            }
        }
        let status = photon.path.respond(event, scene, &walk, &mut nothing, tally);
        if let Event::Surface(hit) = &event {
            detector.meet(hit, weight - if status == Status::Done { 0.0 } else { photon.weight() });
        }
        if status == Status::Done || detector.is_done(photon.order()) {
            return;
        }
    }
}
