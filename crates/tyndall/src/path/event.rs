//! What happens next to a path: free flight first, ray second.

use super::{Path, PathWeights, ahead::Seeker, aim::Aim};
use crate::{
    math::{Bounds, Vec3, fast},
    medium::{Inside, MediumId, bodies::Part},
    phase::Phase,
    scene::Scene,
    shape::{Hit, Interaction},
    spectrum::Lanes,
    tally::Tally,
};

/// One term of the transport equation.
#[derive(Debug, Clone, Copy)]
pub enum Event<'s> {
    /// Nothing more is hit.
    Escape,
    /// A surface is reached.
    Surface(Interaction),
    /// A collision that scatters.
    Scatter {
        /// Where [length].
        p: Vec3,
        /// In which medium.
        medium: MediumId,
        /// How it scatters there.
        phase: &'s Phase,
        /// What the medium emits there towards the camera [W·m⁻²·sr⁻¹].
        emitted: Lanes,
    },
    /// A collision in a medium that only absorbs; or a path that has leaked out of its medium, which is tallied.
    Absorb {
        /// Where [length].
        p: Vec3,
        /// In which medium.
        medium: MediumId,
        /// What the medium emits there towards the camera [W·m⁻²·sr⁻¹].
        emitted: Lanes,
    },
}

/// A collision that was aimed at a lamp.
#[derive(Debug, Clone, Copy)]
pub struct Aimed {
    /// Where [length].
    pub p: Vec3,
    /// What the path would weigh there.
    pub weights: PathWeights,
    /// Random numbers for the light.
    pub numbers: [f32; 3],
}

impl Path {
    /// Samples a free flight, looks for a surface before its end, and weighs the path for what it found.
    #[inline]
    pub fn next_event<'s>(&mut self, scene: &'s Scene, tally: &mut Tally) -> Event<'s> {
        self.next_event_past(scene, &mut (), tally)
    }

    /// The same, with what else is to be looked for along the way.
    #[inline]
    pub fn next_event_past<'s>(&mut self, scene: &'s Scene, seeker: &mut impl Seeker, tally: &mut Tally) -> Event<'s> {
        if let Some(collision) = self.unfinished_collision(scene) {
            return collision;
        }
        let (flight, lamp) = self.begin_flight(seeker);
        if self.stays_clear(flight) {
            return self.arrive(scene, None, flight, None, tally);
        }
        tally.rays += 1;
        // Where surfaces are open, [`Self::pass_open`] has looked, or nobody can.
        self.foreseen = false;
        let looks = !scene.has_null_surfaces() && seeker.looks(&self.inside);
        if lamp.is_none() && !looks {
            let hit = self.around.first_surface(scene, &self.ray, flight);
            return self.arrive(scene, hit, flight, None, tally);
        }
        let hit = self.around.first_surface(scene, &self.ray, f32::INFINITY);
        let end = hit.map_or(f32::INFINITY, |hit| hit.t);
        if looks {
            let transmittance = self.inside.coefficients().map(|c| c.transmittance(end));
            self.foresee(scene, hit, || transmittance, seeker, tally);
        }
        let aim = self.aim(scene, lamp, end, seeker, tally);
        let hit = hit.filter(|hit| hit.t < flight + scene.rounding(&self.ray, flight));
        self.arrive(scene, hit, flight, aim, tally)
    }

    /// A flight that was left under way; or another, and a lamp to aim at along it [length].
    #[inline]
    pub(super) fn begin_flight(&mut self, seeker: &mut impl Seeker) -> (f32, Option<Bounds>) {
        if let Some(flight) = self.unfinished_flight() {
            return (flight, None);
        }
        let lamp = seeker.lamp(self);
        (self.sample_flight(), lamp)
    }

    /// Aims at a lamp from where the path is, along the way that it goes until `end` [length].
    #[inline]
    pub(super) fn aim(
        &mut self,
        scene: &Scene,
        lamp: Option<Bounds>,
        end: f32,
        seeker: &mut impl Seeker,
        tally: &mut Tally,
    ) -> Option<Aim> {
        let aim = Aim::new(&self.ray, end, &lamp?)?;
        if let Some(aimed) = self.collide_aimed(scene, &aim) {
            seeker.aimed(self, &aimed, tally);
        }
        Some(aim)
    }

    /// At a surface within the flight, at a collision at its end, or nowhere.
    #[inline]
    pub(super) fn arrive<'s>(
        &mut self,
        scene: &'s Scene,
        hit: Option<Hit>,
        flight: f32,
        aim: Option<Aim>,
        tally: &mut Tally,
    ) -> Event<'s> {
        match hit {
            Some(hit) => {
                self.pass(hit.t);
                Event::Surface(scene.geometry.interaction(&self.ray, &hit))
            }
            None if flight.is_finite() => self.collide(scene, flight, aim, tally),
            None => {
                self.pass(f32::INFINITY);
                Event::Escape
            }
        }
    }

    /// Weighs the path for a distance without a collision [length].
    #[inline]
    pub(super) fn pass(&mut self, distance: f32) {
        if let Some(coefficients) = self.inside.coefficients() {
            self.weights.pass(coefficients.transmittance(distance), self.hero);
        }
    }

    /// A distance with density `σ_t exp(−σ_t s)` in the hero's lane; infinite where the hero meets nothing.
    #[inline]
    fn sample_flight(&mut self) -> f32 {
        match self.inside.coefficients() {
            None => f32::INFINITY,
            Some(coefficients) => {
                let sigma_t = coefficients.sigma_t.lane(self.hero);
                if sigma_t > 0.0 {
                    // The stratified number of a vertex serves once: in the next medium behind a boundary it is known.
                    let u = match self.history.flights {
                        0 => self.sampler.flight(self.history.vertices),
                        _ => self.sampler.rng.next_positive(),
                    };
                    self.history.flew();
                    -fast::ln(u) / sigma_t
                } else {
                    f32::INFINITY
                }
            }
        }
    }

    /// A collision that is aimed at a lamp, to find light and for nothing else: the path goes where its flight ends.
    #[inline]
    fn collide_aimed(&mut self, scene: &Scene, aim: &Aim) -> Option<Aimed> {
        let Inside::Medium { id, coefficients } = &self.inside else { return None };
        let [u, numbers @ ..] = match self.history.flights {
            1 => self.sampler.aim(self.history.vertices),
            _ => self.sampler.random(),
        };
        let distance = aim.sample(u);
        let (transmittance, p) = (coefficients.transmittance(distance), self.ray.at(distance));
        if transmittance.is_zero() || !scene.may_contain(*id, p) {
            return None;
        }
        let mut weights = self.weights;
        weights.collide_aimed(coefficients.sigma_t, coefficients.sigma_s, transmittance, aim.pdf(distance));
        Some(Aimed { p, weights, numbers })
    }

    #[inline]
    fn collide<'s>(&mut self, scene: &'s Scene, flight: f32, aim: Option<Aim>, tally: &mut Tally) -> Event<'s> {
        let (id, coefficients, part) = match &self.inside {
            Inside::Vacuum => return Event::Escape,
            Inside::Medium { id, coefficients } => (*id, coefficients, None),
            Inside::Mixture { coefficients } => {
                let u = self.sampler.next_1d();
                let Some(part) = self.within.choose_part(scene, &self.wavelengths, self.hero, u) else {
                    return Event::Escape;
                };
                (part.id, coefficients, Some(part))
            }
        };
        let p = self.ray.at(flight);
        if !scene.may_contain(id, p) {
            tally.leaks += 1;
            return Event::Absorb { p, medium: id, emitted: Lanes::ZERO };
        }
        tally.collisions += 1;
        let transmittance = coefficients.transmittance(flight);
        let emitted = if coefficients.source.is_zero() {
            Lanes::ZERO
        } else {
            coefficients.source * self.weights.volume_emission(coefficients.sigma_t, transmittance)
        };
        if coefficients.sigma_s.is_zero() {
            return Event::Absorb { p, medium: id, emitted };
        }
        let aim = aim.map_or(0.0, |aim| aim.pdf(flight));
        self.weights.collide(coefficients.sigma_t, coefficients.sigma_s, transmittance, self.hero, aim);
        if let Some(Part { share, probability, .. }) = part {
            self.weights.choose(share, probability, self.hero);
        }
        Event::Scatter { p, medium: id, phase: &scene.medium(id).phase, emitted }
    }
}
