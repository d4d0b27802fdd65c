//! How a path enters a walk deep inside a medium, and how it comes back. See [`crate::integrator::walk`].

use super::{Event, Path, PathWeights, Sight, Turn};
use crate::{
    integrator::{
        VolPath,
        volpath::Sink,
        walk::{Announced, Depths, End, Walker, light_odds},
    },
    light::Reference,
    math::{Ray, Vec3},
    medium::{Inside, MediumId},
    phase::Phase,
    sampling::Rng,
    scene::{Lit, Scene},
    shape::{Hit, Hollow, Interaction, ObjectId, Room, Touching},
    spectrum::Lanes,
    tally::Tally,
};

/// What a path knows of its surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// The medium, if walks in it are worth while; `None` also while nobody has asked.
    depths: Option<Depths>,
    /// Whether `depths` is about the medium that the path is in.
    asked: bool,
    /// No surface and no light is here.
    room: Room,
    /// The surface that the path came from.
    behind: Behind,
    /// The sphere that it is in, if nothing else is in there.
    hollow: Option<Hollow>,
    /// What a walk has left undone.
    left: Left,
}

/// The surface behind a path in a medium: that it came from, or that is near.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Behind {
    /// Where the path left it [length].
    from: Option<Vec3>,
    /// The side of it that the path is on, until a ball is asked for that touches it there.
    side: Option<Side>,
    /// That ball.
    touching: Option<Touching>,
}

/// A side of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    /// The normal.
    inward: Vec3,
    /// The triangle, if that is in the world itself and this the side away from its normal.
    triangle: Option<(ObjectId, u32)>,
}

impl Behind {
    /// A path leaves a surface along `dir`.
    #[inline]
    fn leave(hit: &Interaction, dir: Vec3) -> Self {
        let enters = hit.ng.dot(dir) < 0.0;
        let is_known = enters && hit.instance == Hit::NO_INSTANCE;
        let inward = if enters { -hit.ng } else { hit.ng };
        let side = Side { inward, triangle: is_known.then_some((hit.object, hit.prim)) };
        Self { from: Some(hit.p), side: Some(side), touching: None }
    }

    /// How far the nearest surface is from `p` at most, for a search to end there: as far as this one [length].
    #[inline]
    fn distance(&self, p: Vec3) -> f32 {
        // A search that ended just before this surface would give the ball less room than there is.
        const BEYOND: f32 = 1.001;
        self.from.map_or(f32::INFINITY, |from| (p - from).length() * BEYOND)
    }

    /// The ball that touches the surface.
    #[inline]
    fn touching(&mut self, scene: &Scene, medium: MediumId) -> Option<Touching> {
        if let (Some(Side { inward, triangle }), Some(from)) = (self.side.take(), self.from) {
            let known = triangle.and_then(|triangle| scene.touching(triangle));
            self.touching = known.unwrap_or_else(|| scene.touching_at(from, inward, medium));
        }
        self.touching
    }

    /// A room that holds `p`, and how far the nearest surface is from there at least [length]: the ball that touches the surface,
    /// or else one around `p`, or the one that touches what is near.
    #[inline]
    fn room(&mut self, scene: &Scene, depths: &Depths, p: Vec3) -> (Room, f32) {
        if let Some(touching) = self.touching(scene, depths.id).filter(|touching| touching.holds(p)) {
            return (Room::Ball(touching.ball), touching.ball.depth(p));
        }
        let (around, nearest) = scene.ball(p, depths.farthest(scene).min(self.distance(p)));
        if let Some(touching) = nearest.and_then(|triangle| scene.touching(triangle)) {
            self.touching = touching;
        }
        match self.touching.filter(|touching| touching.is_as_good_as(&around, p)) {
            Some(Touching { ball, .. }) => (Room::Ball(ball), around.radius.max(ball.depth(p))),
            None => (Room::Ball(around), around.radius),
        }
    }
}

/// What a walk has left undone.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Left {
    /// Nothing.
    Nothing,
    /// A flight whose length is drawn [length].
    Flight(f32),
    /// A collision, whose light has been seen to.
    Collision,
}

/// Whether light is sampled at a vertex, and how likely that was: a number is drawn once, and what more becomes known of the
/// way to the light can only lower the odds that it is held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attempt {
    /// The probability so far \[1\].
    pub odds: f32,
    /// The probability that multiple importance sampling supposes, at least the true one \[1\].
    pub supposed: f32,
    /// The number that was drawn, in [0, 1].
    draw: f32,
    /// No surface and no light is here.
    room: Room,
    /// The probability where no medium is between \[1\].
    share: f32,
    /// The least `σ_t` of all lanes [1/length].
    sigma_min: f32,
}

impl Attempt {
    /// As at every surface.
    pub const CERTAIN: Self =
        Self { odds: 1.0, supposed: 1.0, draw: 0.0, room: Room::NONE, share: 1.0, sigma_min: 0.0 };
    /// As in a medium that no light reaches: what paths run into there counts in full.
    pub const NONE: Self = Self { odds: 0.0, supposed: 0.0, draw: 1.0, ..Self::CERTAIN };

    /// In a medium, with this room around it.
    #[inline]
    fn within(depths: &Depths, room: Room) -> Self {
        Self { room, share: depths.share(), sigma_min: depths.sigma_min, ..Self::CERTAIN }
    }

    /// Whether it is.
    #[inline]
    pub fn is_made(&self) -> bool {
        self.draw <= self.odds
    }

    /// The same once it is known that the light is along `dir` from `p`: no more likely than the transmittance as far as the room
    /// reaches. `None` if it is not made.
    #[inline]
    #[must_use]
    pub fn towards(&self, p: Vec3, dir: Vec3) -> Option<Self> {
        let odds = light_odds(self.share, self.sigma_min * self.room.reach(p, dir)).min(self.odds);
        (self.draw <= odds).then_some(Self { odds, ..*self })
    }
}

impl Default for Surroundings {
    fn default() -> Self {
        Self {
            depths: None,
            asked: false,
            room: Room::NONE,
            behind: Behind::default(),
            hollow: None,
            left: Left::Nothing,
        }
    }
}

impl Surroundings {
    /// The path leaves a surface along `dir`.
    #[inline]
    pub(crate) fn leave(&mut self, scene: &Scene, hit: &Interaction, dir: Vec3) {
        self.behind = Behind::leave(hit, dir);
        self.hollow = scene.hollow(hit, dir);
    }

    /// [`Scene::first_surface`], which is known in a hollow sphere.
    #[inline]
    pub(super) fn first_surface(&self, scene: &Scene, ray: &Ray, flight: f32) -> Option<Hit> {
        match self.hollow.and_then(|hollow| hollow.exit(ray)) {
            Some(exit) => (exit.t < flight + scene.rounding(ray, flight)).then_some(exit),
            None => scene.first_surface(ray, flight),
        }
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
        if scene.lit(self.inside.id()) == Lit::Never { Attempt::NONE } else { Attempt::CERTAIN }
    }

    /// At a collision: how far the nearest surface is, and with that whether light is sampled.
    #[inline]
    pub(crate) fn look_around(&mut self, scene: &Scene, p: Vec3) -> Attempt {
        let Some(depths) = self.depths(scene) else { return self.attempt(scene) };
        if std::mem::replace(&mut self.around.left, Left::Nothing) == Left::Collision {
            return Attempt { supposed: depths.odds(self.around.room.depth(p)), ..Attempt::NONE };
        }
        let (room, depth) = match scene.room(depths.id) {
            Some(room) => (room, room.depth(p)),
            None => self.around.behind.room(scene, &depths, p),
        };
        self.around.room = room;
        let (odds, draw) = (depths.odds(depth), self.sampler.rng.next_positive());
        Attempt { odds, supposed: odds, draw, ..Attempt::within(&depths, room) }
    }

    /// A light sample that a walk has announced, and what the path weighs there. What [`Attempt::towards`] says is still to be asked.
    #[inline]
    pub(crate) fn on_walk(&self, announced: &Announced, rng: &mut Rng) -> Option<(Attempt, PathWeights)> {
        let depths = self.around.depths?;
        let supposed = announced.odds;
        let draw = rng.next_positive() * supposed;
        let attempt = Attempt { odds: supposed, supposed, draw, ..Attempt::within(&depths, self.around.room) };
        let settled = depths.settle(announced.collisions, announced.length);
        let mut weights = self.weights;
        weights.walk(settled.beta, settled.density);
        Some((attempt, weights))
    }

    /// Begins a walk, if there is room for one.
    #[inline]
    pub fn begin_walk(&self, settings: &VolPath) -> Option<Walker> {
        let Surroundings { depths: Some(depths), room, left: Left::Nothing, .. } = self.around else { return None };
        // In a block walks are so cheap that stratified numbers do not pay for the flights that they want traced.
        if !depths.is_roomy(room.reach(self.ray.origin, self.ray.dir))
            || room.block().is_none() && self.sampler.is_stratified(self.history.vertices)
        {
            return None;
        }
        let allowed = settings.max_depth.map_or(u32::MAX, |limit| limit.saturating_sub(self.history.depth()));
        (allowed > 0).then(|| Walker {
            medium: depths.id,
            p: self.ray.origin,
            dir: self.ray.dir,
            came: self.ray.dir,
            rng: self.sampler.rng,
            room,
            mean_free_path: 1.0 / depths.sigma_t,
            sigma_min: depths.sigma_min,
            share: depths.share(),
            lit: depths.lit != Lit::Never,
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
                    let odds = depths.odds(self.around.room.depth(walker.p));
                    self.weights.scatter(Lanes::ONE, phase.eval(walker.cos_theta), odds);
                    self.last_vertex = Reference { p: walker.p, normal: None };
                    self.sight = Sight::from(depths.lit);
                }
                Left::Flight(walker.flight)
            }
            // The last collision is an event still to come, which counts itself.
            End::Roulette => {
                self.history.walked(walker.collisions - 1);
                sink.turned(&mut self.history, Turn::Medium(depths.id), walker.collisions - 1);
                Left::Collision
            }
        };
    }

    /// The collision that a walk has ended at.
    #[inline]
    pub(super) fn unfinished_collision<'s>(&self, scene: &'s Scene) -> Option<Event<'s>> {
        match (self.around.left, self.around.depths) {
            (Left::Collision, Some(depths)) => {
                let phase = &scene.medium(depths.id).phase;
                Some(Event::Scatter { p: self.ray.origin, medium: depths.id, phase, emitted: Lanes::ZERO })
            }
            _ => None,
        }
    }

    /// Whether a walk has ended at a collision.
    #[inline]
    pub(super) fn collision_is_due(&self) -> bool {
        self.around.left == Left::Collision
    }

    /// Whether a flight of this length ends in the room that the path knows: nothing can be in its way [length].
    #[inline]
    pub(super) fn stays_clear(&self, flight: f32) -> bool {
        flight.is_finite() && flight < self.around.room.reach(self.ray.origin, self.ray.dir)
    }

    /// Leaves a flight whose length is drawn [length].
    #[inline]
    pub(super) fn leave_flight(&mut self, flight: f32) {
        self.around.left = Left::Flight(flight);
    }

    /// The flight that has been left under way [length].
    #[inline]
    pub(super) fn unfinished_flight(&mut self) -> Option<f32> {
        let Left::Flight(flight) = self.around.left else { return None };
        self.around.left = Left::Nothing;
        self.history.flew();
        Some(flight)
    }
}
