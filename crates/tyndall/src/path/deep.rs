//! How a path enters a walk deep inside a medium, and how it comes back. See [`crate::integrator::walk`].

use super::{Event, Path, Turn};
use crate::{
    integrator::{
        VolPath,
        volpath::Sink,
        walk::{Ball, Depths, End, Walker},
    },
    light::Reference,
    math::{Ray, Vec3},
    medium::Inside,
    phase::Phase,
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};

/// What a path knows of its surroundings in a medium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// The medium, if walks in it are worth while; `None` also while nobody has asked.
    depths: Option<Depths>,
    /// Whether `depths` is about the medium that the path is in.
    asked: bool,
    /// No surface and no light is here.
    ball: Ball,
    /// What a walk has left undone.
    left: Left,
}

/// What a walk has left undone.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Left {
    /// Nothing.
    Nothing,
    /// A flight whose length is drawn [length].
    Flight(f32),
    /// A collision, and whether light is to be sampled there.
    Collision { lit: bool },
}

/// Whether light is sampled at a vertex, and how likely that was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attempt {
    /// The probability \[1\].
    pub odds: f32,
    /// The probability that multiple importance sampling supposes, at least the true one \[1\].
    pub supposed: f32,
    /// Whether it is.
    pub made: bool,
}

impl Attempt {
    /// As at every surface.
    pub const CERTAIN: Self = Self { odds: 1.0, supposed: 1.0, made: true };
    /// As in a medium that no light reaches: what paths run into there counts in full.
    pub const NONE: Self = Self { odds: 0.0, supposed: 0.0, made: false };
}

impl Default for Surroundings {
    fn default() -> Self {
        Self { depths: None, asked: false, ball: Ball::NONE, left: Left::Nothing }
    }
}

impl Path {
    /// The medium has changed: nothing is known.
    #[inline]
    pub(crate) fn forget_surroundings(&mut self) {
        self.around = Surroundings::default();
    }

    /// The medium that the path is in, if walks in it are worth while.
    #[inline]
    fn depths(&mut self, scene: &Scene) -> Option<Depths> {
        if !self.around.asked {
            self.around.asked = true;
            self.around.depths = match &self.inside {
                Inside::Medium { id, coefficients } => Depths::of(scene, *id, coefficients, self.hero),
                Inside::Vacuum | Inside::Mixture { .. } => None,
            };
        }
        self.around.depths
    }

    /// Whether light is sampled at a collision about whose surroundings nothing is known.
    #[inline]
    pub(crate) fn attempt(&self, scene: &Scene) -> Attempt {
        if scene.light_can_reach(self.inside.id()) { Attempt::CERTAIN } else { Attempt::NONE }
    }

    /// At a collision: how far the nearest surface is, and with that whether light is sampled.
    #[inline]
    pub(crate) fn look_around(&mut self, scene: &Scene, p: Vec3) -> Attempt {
        let Some(depths) = self.depths(scene) else { return self.attempt(scene) };
        let left = std::mem::replace(&mut self.around.left, Left::Nothing);
        let supposed = match left {
            Left::Collision { .. } => depths.odds(self.around.ball.room(p).max(0.0)),
            _ => 1.0,
        };
        if self.around.ball.room(p) < 0.5 * self.around.ball.radius || left == Left::Nothing {
            self.around.ball = Ball::around(scene, p, depths.farthest());
        }
        let odds = depths.odds(self.around.ball.room(p).max(0.0)).min(supposed);
        let made = match left {
            Left::Collision { lit: false } => false,
            _ => odds == supposed || self.sampler.rng.next_positive() * supposed <= odds,
        };
        Attempt { odds, supposed, made }
    }

    /// Begins a walk, if there is room for one.
    #[inline]
    pub fn begin_walk(&self, settings: &VolPath) -> Option<Walker> {
        let Surroundings { depths: Some(depths), ball, left: Left::Nothing, .. } = self.around else { return None };
        if !depths.is_roomy(ball.room(self.ray.origin)) || self.sampler.is_stratified(self.history.vertices) {
            return None;
        }
        let allowed = settings.max_depth.map_or(u32::MAX, |limit| limit.saturating_sub(self.history.depth()));
        (allowed > 0).then(|| Walker {
            medium: depths.id,
            p: self.ray.origin,
            dir: self.ray.dir,
            rng: self.sampler.rng,
            ball,
            mean_free_path: 1.0 / depths.sigma_t,
            sigma_min: depths.sigma_min,
            lit: depths.lit,
            collisions: 0,
            limit: depths.limit.min(allowed),
            length: 0.0,
            flight: 0.0,
            cos_theta: 1.0,
        })
    }

    /// Comes back from a walk.
    #[inline]
    pub fn end_walk(&mut self, walker: &Walker, end: End, phase: &Phase, sink: &impl Sink, tally: &mut Tally) {
        let Some(depths) = self.around.depths else { return };
        tally.collisions += u64::from(walker.collisions);
        self.ray = Ray::new(walker.p, walker.dir);
        self.sampler.rng = walker.rng;
        if walker.collisions > 0 {
            let settled = depths.settle(walker.collisions, walker.length);
            self.weights.walk(settled.beta, settled.density);
        }
        self.around.left = match end {
            End::Leaves => {
                if walker.collisions > 0 {
                    self.history.walked(walker.collisions);
                    sink.turned(&mut self.history, Turn::Medium(depths.id), walker.collisions);
                    let odds = depths.odds(self.around.ball.room(walker.p).max(0.0));
                    self.weights.scatter(Lanes::ONE, phase.eval(walker.cos_theta), odds);
                    self.last_vertex = Reference { p: walker.p, normal: None };
                }
                Left::Flight(walker.flight)
            }
            // The last collision is an event still to come, which counts itself.
            End::Light | End::Roulette => {
                self.history.walked(walker.collisions - 1);
                sink.turned(&mut self.history, Turn::Medium(depths.id), walker.collisions - 1);
                Left::Collision { lit: end == End::Light }
            }
        };
    }

    /// The collision that a walk has ended at.
    #[inline]
    pub(super) fn unfinished_collision<'s>(&self, scene: &'s Scene) -> Option<Event<'s>> {
        match (self.around.left, self.around.depths) {
            (Left::Collision { .. }, Some(depths)) => {
                let phase = &scene.medium(depths.id).phase;
                Some(Event::Scatter { p: self.ray.origin, medium: depths.id, phase, emitted: Lanes::ZERO })
            }
            _ => None,
        }
    }

    /// Whether a flight that has left the ball of a walk stays in a ball of its own.
    #[inline]
    pub(super) fn is_free(&mut self, scene: &Scene, flight: f32) -> bool {
        let (Some(depths), p) = (self.around.depths, self.ray.origin) else { return false };
        self.around.ball = Ball::around(scene, p, depths.farthest());
        flight < self.around.ball.radius
    }

    /// The flight that a walk has left under way [length].
    #[inline]
    pub(super) fn unfinished_flight(&mut self) -> Option<f32> {
        let Left::Flight(flight) = self.around.left else { return None };
        self.around.left = Left::Nothing;
        self.history.flew();
        Some(flight)
    }
}
