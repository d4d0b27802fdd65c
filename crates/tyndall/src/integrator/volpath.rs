//! The workhorse: unidirectional path tracing of surfaces and homogeneous media, with light sampling at every vertex
//! and multiple importance sampling over both ways to find a light and over the lanes.

use super::next_event::Lamps;
use crate::{
    bend::Goal,
    light::Reference,
    material::Material,
    medium::{Inside, MediumId, Skin},
    path::{Attempt, Event, History, Path, Sight, Source, Turn, Vertex},
    scene::Scene,
    shape::Interaction,
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

/// Settings of the path tracer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolPath {
    /// Scattering events after which a path is cut; `None` (the default) cuts nothing. What is lost is tallied.
    pub max_depth: Option<u32>,
    /// What counts as a scattering event for that.
    pub counted: Counted,
    /// Paths below this throughput play roulette and survive with this throughput [1].
    pub roulette: f32,
    /// How paths deep inside a medium are followed.
    pub deep: Deep,
    /// Grains that a path leaves before it goes on in their proxy, which is not exact: see [`crate::granular`]. `None` (the
    /// default) follows all paths among grains to their end.
    pub explicit_grains: Option<u32>,
}

impl Default for VolPath {
    fn default() -> Self {
        Self {
            max_depth: None,
            counted: Counted::Scatterings,
            roulette: 0.5,
            deep: Deep::default(),
            explicit_grains: None,
        }
    }
}

/// How paths deep inside a medium are followed: see [`super::walk`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Deep {
    /// As everywhere: a ray for each flight, a light sample at each collision.
    Traced,
    /// Within balls without surfaces, one path after the other.
    Alone,
    /// The same, many paths at once: the same bits.
    #[default]
    Together,
}

/// What a limit on the depth of paths counts. (Boundaries without a material never count.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Counted {
    /// Every collision and every surface with a material.
    #[default]
    Scatterings,
    /// Of these, those that turn a path: not a thin pane that it passes straight (as Mitsuba's `volpath` has it).
    Turns,
}

/// Whether a path goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// There is more to come.
    Alive,
    /// It has ended.
    Done,
}

/// Takes what a path finds.
pub trait Sink {
    /// Radiance that reaches the camera along a path with this history, and then perhaps one turn more, from a source.
    fn add(&mut self, radiance: Lanes, history: &History, last: Option<Turn>, source: Source);

    /// The path has taken the same turn so many times.
    #[inline]
    fn turned(&self, _history: &mut History, _turn: Turn, _times: u32) {}
}

impl Sink for Lanes {
    #[inline]
    fn add(&mut self, radiance: Lanes, _history: &History, _last: Option<Turn>, _source: Source) {
        *self += radiance;
    }
}

impl Path {
    /// Finds the next event and responds to it.
    #[inline]
    pub fn step(&mut self, scene: &Scene, settings: &VolPath, sink: &mut impl Sink, tally: &mut Tally) -> Status {
        let scene = self.world(scene);
        let mut lamps = Lamps { scene, settings, sink: &mut *sink };
        let event = match self.pass_open(scene, &mut lamps, tally) {
            Some(event) => event,
            None => self.next_event_past(scene, &mut lamps, tally),
        };
        self.respond(event, scene, settings, sink, tally)
    }

    /// What an event does to the path: a term of the transport equation each.
    #[inline]
    pub fn respond(
        &mut self,
        event: Event,
        scene: &Scene,
        settings: &VolPath,
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) -> Status {
        match event {
            Event::Escape => {
                if !self.foreseen {
                    self.find_environment(scene, Lanes::ONE, sink, tally);
                }
                Status::Done
            }
            Event::Surface(mut hit) => {
                let skin = if scene.has_bodies() { self.meet(scene, &mut hit, tally) } else { Skin::Written };
                let sampler = &mut self.sampler;
                let (material, relief) = scene.meet(&hit, self.ray.dir, || sampler.next_1d());
                let (bsdf, disperses) = match (skin, material) {
                    (_, Material::Hole) => {
                        self.pass_opening(scene, &hit);
                        self.ray = hit.spawn(self.ray.dir);
                        self.around.leave(scene, &hit, self.ray.dir);
                        return Status::Alive;
                    }
                    (Skin::Open, _) | (Skin::Written, Material::Null) => {
                        self.find_emitter(scene, &hit, Lanes::ONE, sink, tally);
                        self.cross(scene, &hit);
                        return Status::Alive;
                    }
                    (Skin::Written, material) => {
                        let bsdf = material.bsdf(&(&hit).into(), &self.wavelengths, self.hero);
                        (bsdf.seeded(|| sampler.rng.next_u32()), material.disperses())
                    }
                    (Skin::Between { eta, disperses }, material) => {
                        (material.bsdf_between(eta, &(&hit).into(), &self.wavelengths), disperses)
                    }
                };
                if !self.foreseen {
                    self.find_emitter(scene, &hit, Lanes::ONE, sink, tally);
                }
                tally.surface_vertices += 1;
                let vertex = Vertex::met(scene, hit, bsdf, self.ray.dir, relief);
                self.scatter(scene, settings, &vertex, (disperses, Attempt::CERTAIN), sink, tally)
            }
            Event::Scatter { p, medium, phase, emitted } => {
                self.find_emission(medium, emitted, sink);
                let light = match settings.deep {
                    Deep::Traced => self.attempt(scene),
                    Deep::Alone | Deep::Together => self.look_around(scene, p),
                };
                self.history.order += 1;
                let vertex = Vertex::Medium { p, dir: self.ray.dir, medium, phase };
                self.scatter(scene, settings, &vertex, (false, light), sink, tally)
            }
            Event::Absorb { medium, emitted, .. } => {
                self.find_emission(medium, emitted, sink);
                Status::Done
            }
        }
    }

    /// Light from the medium, at a collision.
    #[inline]
    fn find_emission(&self, medium: MediumId, emitted: Lanes, sink: &mut impl Sink) {
        if !emitted.is_zero() {
            sink.add(emitted, &self.history, None, Source::Medium(medium));
        }
    }

    /// Light from infinity, through `transmittance`.
    pub(super) fn find_environment(
        &self,
        scene: &Scene,
        transmittance: Lanes,
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        for id in &scene.lights.environments {
            let light = scene.lights.get(*id);
            let le = light.le_from_infinity(self.last_vertex.p, self.ray.dir, &self.wavelengths);
            if !le.is_zero() {
                let weight = self.weights.emission(|| {
                    let straight = |from: &Reference| light.pdf_towards(from, self.ray.dir);
                    self.light_density(scene, *id, &Goal::Infinity(self.ray.dir), straight, tally)
                });
                sink.add(weight * transmittance * le, &self.history, None, Source::Sky(*id));
            }
        }
    }

    /// Light from a surface ahead, through `transmittance`.
    #[inline]
    pub(super) fn find_emitter(
        &self,
        scene: &Scene,
        hit: &Interaction,
        transmittance: Lanes,
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        let Some((id, light)) = scene.light_at(hit) else { return };
        let le = light.le(hit.ng, -self.ray.dir, || hit.into(), &self.wavelengths);
        if !le.is_zero() {
            let weight = self.weights.emission(|| {
                let goal = Goal::Point { p: hit.p, ng: hit.ng };
                self.light_density(scene, id, &goal, |from| light.pdf(from, hit.p, hit.ng), tally)
            });
            sink.add(weight * transmittance * le, &self.history, None, Source::Light(id));
        }
    }

    /// Straight on through a surface without a material.
    pub(crate) fn cross(&mut self, scene: &Scene, hit: &Interaction) {
        self.pass_opening(scene, hit);
        self.enter(scene, hit);
        self.ray = hit.spawn(self.ray.dir);
        self.around.leave(scene, hit, self.ray.dir);
    }

    /// Finds out what is at a surface where bodies can overlap, and what is behind it.
    #[inline(never)]
    fn meet(&mut self, scene: &Scene, hit: &mut Interaction, tally: &mut Tally) -> Skin {
        let (skin, beyond) = self.within.meet(scene, hit, self.ray.dir, &self.wavelengths, self.hero, tally);
        self.beyond = beyond;
        skin
    }

    /// A surface that is open in part was passed with that probability: as a medium is, for light sampling through it.
    fn pass_opening(&mut self, scene: &Scene, hit: &Interaction) {
        // The surface of a body is there or it is not, and not in part.
        if !matches!(scene.material(hit), Material::Null) && scene.object(hit).body.is_none() {
            let open = scene.openness(hit, self.ray.dir).part;
            self.weights.pass(Lanes::splat(open), self.hero);
        }
    }

    /// Enters the medium on the far side of a surface.
    fn enter(&mut self, scene: &Scene, hit: &Interaction) {
        self.forget_surroundings();
        if scene.has_bodies() {
            self.within = self.beyond;
            self.inside = self.within.inside(scene, &self.wavelengths);
            return;
        }
        if let Some(interface) = scene.object(hit).interface {
            let medium = interface.towards(self.ray.dir.dot(hit.ng));
            self.inside = Inside::of(scene, medium, &self.wavelengths);
        }
    }

    /// A vertex: light is sampled, roulette played, a direction taken.
    #[inline]
    fn scatter(
        &mut self,
        scene: &Scene,
        settings: &VolPath,
        vertex: &Vertex,
        (disperses, light): (bool, Attempt),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) -> Status {
        // At the limit a path may still go on through a pane.
        let at_limit = settings.max_depth.is_some_and(|limit| self.history.depth() >= limit);
        let free_passage = settings.counted == Counted::Turns && vertex.is_pane();
        if at_limit && !free_passage {
            return self.cut(tally);
        }
        // What only reflects is another BSDF for each wavelength, if it disperses: they part before light is sampled.
        if disperses && !vertex.transmits() {
            self.part_wavelengths(scene);
        }
        let reference = vertex.reference();
        let samples = vertex.light_samples();
        if light.is_made() && vertex.can_use_light_samples() {
            let numbers = if vertex.is_surface() {
                self.sampler.light(self.history.vertices)
            } else {
                let [u_choice, u, v] = self.sampler.light(self.history.vertices);
                [u_choice, u, v, 0.0] // in a medium every ray is sent
            };
            let of = (&self.weights, &self.history);
            self.look_for_light(scene, settings, vertex, (&light, numbers), of, sink, tally);
            if samples > 1 {
                self.look_again(scene, vertex, samples, (&light, numbers), sink, tally);
            }
        }
        if !self.weights.throughput().is_finite() {
            sink.add(self.weights.beta, &self.history, None, Source::Fault); // the film counts and locates it
            return Status::Done;
        }
        if !self.survives(settings.roulette) {
            return Status::Done;
        }
        let Some(scattered) = vertex.sample(self.sampler.direction(self.history.vertices)) else {
            return Status::Done;
        };
        let passes = free_passage && scattered.crossed;
        if at_limit && !passes {
            return self.cut(tally);
        }
        if disperses && scattered.eta != 1.0 {
            self.part_wavelengths(scene);
        }
        if !scattered.specular {
            self.weights.scatter(scattered.weight, scattered.pdf, light.supposed * samples as f32);
            self.sight = Self::sight(scene, vertex);
        } else if let Some(passed) = self.passes(scene, vertex, &scattered) {
            self.weights.bend(scattered.weight, scattered.pdf);
            self.sight = Sight::Past(passed);
        } else {
            self.weights.scatter_specular(scattered.weight);
        }
        self.history.eta_scale *= scattered.eta * scattered.eta;
        self.history.scattered(scattered.specular);
        sink.turned(&mut self.history, vertex.turn(scattered.crossed, scattered.specular), 1);
        self.history.passes = self.history.passes.saturating_add(u16::from(passes));
        self.last_vertex = reference;
        self.ray = scattered.ray;
        if let Vertex::Surface { hit, .. } = vertex {
            if scattered.crossed {
                self.enter(scene, hit);
            }
            self.around.leave(scene, hit, self.ray.dir);
            self.leave_grain(scene, hit, scattered.crossed);
        }
        Status::Alive
    }

    /// Ends a path that the user's limit does not let go on.
    fn cut(&self, tally: &mut Tally) -> Status {
        tally.truncated_paths += 1;
        tally.truncated_throughput += f64::from(self.weights.throughput());
        Status::Done
    }

    /// Past a boundary that disperses, each wavelength has its own way: the path goes on with the hero's, in every lane, so
    /// that no lane could have decided otherwise.
    fn part_wavelengths(&mut self, scene: &Scene) {
        if matches!(self.wavelengths, Wavelengths::Spectral { .. }) && !self.history.parted {
            self.history.parted = true;
            self.weights.keep_hero_only(self.hero);
            self.wavelengths = self.wavelengths.hero_everywhere(self.hero);
            self.forget_surroundings();
            self.inside = match self.inside {
                Inside::Medium { id, .. } => Inside::of(scene, Some(id), &self.wavelengths),
                Inside::Mixture { .. } => self.within.inside(scene, &self.wavelengths),
                Inside::Vacuum => Inside::Vacuum,
            };
        }
    }

    /// Roulette on the throughput: a path that carries less than `threshold` survives with probability
    /// `throughput / threshold` and then carries the threshold. No weight ever grows beyond it, so the variance stays
    /// finite at any albedo, and at albedo 1 nothing is ever cut.
    #[inline]
    fn survives(&mut self, threshold: f32) -> bool {
        let throughput = self.weights.throughput() * self.history.eta_scale;
        let survival = if throughput < threshold { throughput / threshold } else { self.history.survival() };
        if survival == 1.0 {
            return true;
        }
        if self.sampler.roulette() >= survival {
            return false;
        }
        self.weights.beta /= survival;
        true
    }
}
