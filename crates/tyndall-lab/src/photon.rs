//! Photons: launched, followed event by event with the renderer's own walk, watched by a detector.
//!
//! A photon is a [`Path`] that starts at the source. The renderer's paths carry radiance, which is compressed by `1/η²`
//! where light enters a denser body; a photon carries power, which is not. [`Photon::weight`] undoes the compression.
//! There are no lights in an experiment, so a path's response to an event is the walk and nothing else.

use std::ops::Range;

use tyndall::{
    integrator::{
        CameraSample, VolPath,
        pool::{self, Crew},
        volpath::Status,
        walk::{End, Walker},
    },
    math::{Ray, Vec3},
    medium::MediumId,
    path::{Event, Path},
    phase::Phase,
    sampling::{Sampler, SamplerKind},
    scene::Scene,
    shape::Interaction,
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

use crate::run::{BATCH, Sums, Verdict, photons_of, run_together};

/// As [`VolPath::roulette`], and less: most of what a camera's path finds it finds early, a photon brings all at its end.
const ROULETTE: f32 = 0.25;

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
    /// The power that it brought to the collision that a walk has ended at, which is an event still to come \[1\].
    brought: Option<f64>,
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
    /// The number of the next collision, `order` or a later one, that it has to see for itself. Those before it that are deep
    /// inside a medium are told together, as one that absorbs what all of them do.
    fn awaits(&self, order: u32) -> u32 {
        order
    }
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
/// every batch, until there are `photons` or `look` has seen enough. Many batches are followed together, so that deep inside a
/// medium no lane waits for the last of them.
pub(crate) fn shoot<D: Detector>(
    scene: &Scene,
    photons: u64,
    seed: u64,
    ray: impl Fn(u64) -> Ray + Sync,
    detector: impl Fn() -> D + Sync,
    look: impl FnMut(&Sums) -> Verdict,
) -> Sums {
    let batches = |numbers: Range<u64>| {
        let mut crew = Experimenters {
            scene,
            settings: VolPath { roulette: ROULETTE, ..VolPath::default() },
            desks: numbers.clone().map(|_| (detector(), Tally { paths: BATCH, ..Tally::default() })).collect(),
        };
        let photons = numbers.enumerate().flat_map(|(desk, batch)| photons_of(batch).map(move |photon| (desk, photon)));
        let launched = photons.map(|(desk, photon)| (desk, Photon::launch(scene, ray(photon), photon, seed)));
        pool::follow(scene, &mut crew, launched, &mut Tally::default());
        crew.desks.into_iter().map(|(detector, tally)| (detector.totals(), tally)).collect()
    };
    run_together(detector().totals().len(), photons, batches, look)
}

/// Those who follow the photons of an experiment.
struct Experimenters<'a, D> {
    scene: &'a Scene,
    settings: VolPath,
    /// Of each batch the detector, and what happened to its photons.
    desks: Vec<(D, Tally)>,
}

impl<D: Detector> Crew for Experimenters<'_, D> {
    /// A photon with the number of its desk.
    type Member = (usize, Photon);

    fn advance(&mut self, (desk, photon): &mut Self::Member, _: &mut Tally) -> Option<Walker> {
        let (detector, tally) = &mut self.desks[*desk];
        photon.advance(self.scene, &self.settings, detector, tally)
    }

    fn end_walk(&mut self, (desk, photon): &mut Self::Member, walker: &Walker, end: End, phase: &Phase, _: &mut Tally) {
        let (detector, tally) = &mut self.desks[*desk];
        photon.end_walk(walker, end, phase, detector, tally);
    }
}

impl Photon {
    /// The photon number `index`, on its way along `ray`.
    fn launch(scene: &Scene, ray: Ray, index: u64, seed: u64) -> Self {
        let sampler = Sampler::new(SamplerKind::Independent, (index as u32, (index >> 32) as u32), 0, seed);
        let seen = CameraSample { ray, wavelengths: Wavelengths::Mono, u_hero: 0.0, sampler };
        Self {
            at_surface: ray.origin,
            met: None,
            path: Path::new(scene, &seen),
            travelled: 0.0,
            launched: ray.dir,
            brought: None,
        }
    }

    /// Goes on to where a walk begins of which the detector need not know every step, or to the end.
    fn advance(
        &mut self,
        scene: &Scene,
        settings: &VolPath,
        detector: &mut impl Detector,
        tally: &mut Tally,
    ) -> Option<Walker> {
        let mut nothing = Lanes::ZERO; // There are no lights to find.
        loop {
            let weight = self.brought.take().unwrap_or(self.weight());
            let (from, order) = (self.path.ray.origin, self.order());
            let medium = self.path.inside.id();
            let event = self.path.next_event(scene, tally);
            let p = match &event {
                Event::Escape => {
                    detector.leave(self);
                    return None;
                }
                Event::Surface(hit) => hit.p,
                Event::Scatter { p, .. } | Event::Absorb { p, .. } => *p,
            };
            self.travelled += f64::from((p - from).length());
            let travelled = self.travelled;
            match event {
                Event::Surface(hit) => (self.at_surface, self.met) = (p, Some(hit)),
                Event::Scatter { .. } => {
                    let absorbed = weight - self.weight();
                    detector.collide(&Collision { p, weight, absorbed, travelled, order, medium });
                }
                _ => detector.collide(&Collision { p, weight, absorbed: weight, travelled, order, medium }),
            }
            let status = self.path.respond(event, scene, settings, &mut nothing, tally);
            if let Event::Surface(hit) = &event {
                detector.meet(hit, weight - if status == Status::Done { 0.0 } else { self.weight() });
            }
            if status == Status::Done || detector.is_done(self.order()) {
                return None;
            }
            let unseen = detector.awaits(self.order()) - self.order();
            if unseen > 0
                && let Some(mut walker) = self.path.begin_walk(settings)
            {
                walker.limit = walker.limit.min(unseen.saturating_add(1));
                return Some(walker);
            }
        }
    }

    /// Comes back from a walk: all collisions that are no event any more are told as one.
    fn end_walk(&mut self, walker: &Walker, end: End, phase: &Phase, detector: &mut impl Detector, tally: &mut Tally) {
        let (weight, order) = (self.weight(), self.order());
        self.path.end_walk(walker, end, phase, &Lanes::ZERO, tally);
        self.travelled += f64::from(walker.length);
        let is_event = end != End::Leaves;
        let told = walker.collisions - u32::from(is_event);
        // Every collision of a walk leaves the same part of the power.
        let left = weight * (self.weight() / weight).powf(f64::from(told) / f64::from(walker.collisions.max(1)));
        self.brought = is_event.then_some(left);
        if told > 0 {
            let (absorbed, travelled, medium) = (weight - left, self.travelled, Some(walker.medium));
            detector.collide(&Collision { p: walker.p, weight, absorbed, travelled, order, medium });
        }
    }
}
