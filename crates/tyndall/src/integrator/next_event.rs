//! Next event estimation: the light that a light sample finds, at a vertex, at a collision that a walk deep inside a medium
//! has announced, and at one that was aimed at a lamp.

use std::f32::consts::PI;

use super::{Deep, VolPath, volpath::Sink, walk::Announced};
use crate::{
    light::Reference,
    math::{Bounds, Ray, Vec2, Vec3},
    medium::{Inside, Within},
    path::{Attempt, History, Path, PathWeights, Sight, Source, Turn, Vertex, ahead::Seeker, event::Aimed, shadow},
    phase::Phase,
    scene::Scene,
    shape::Interaction,
    spectrum::Lanes,
    tally::Tally,
};

/// Lamps that collisions are aimed at, and where what they find goes.
pub(super) struct Lamps<'a, S> {
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a VolPath,
    pub(super) sink: &'a mut S,
}

impl<S: Sink> Seeker for Lamps<'_, S> {
    #[inline]
    fn lamp(&mut self, path: &mut Path) -> Option<Bounds> {
        path.lamp(self.scene, self.settings)
    }

    #[inline]
    fn aimed(&mut self, path: &Path, aimed: &Aimed, tally: &mut Tally) {
        path.sample_aimed(self.scene, aimed, self.sink, tally);
    }

    #[inline]
    fn looks(&self, inside: &Inside) -> bool {
        self.scene.looks_ahead(inside)
    }

    #[inline]
    fn seen(&mut self, path: &Path, end: Option<&Interaction>, transmittance: Lanes, tally: &mut Tally) {
        match end {
            Some(surface) => path.find_emitter(self.scene, surface, transmittance, self.sink, tally),
            None => path.find_environment(self.scene, transmittance, self.sink, tally),
        }
    }
}

/// Where a surface scatters less light than this share of what it would if it scattered evenly, a ray to the light is sent the more
/// rarely, and counts for more \[1\]. A fibre of hair sends nearly all of its light elsewhere.
const FAINT: f32 = 0.6;

/// How likely the ray is, for what the vertex scatters towards the light [1/sr], where it is one of so many samples. In a medium,
/// where collisions come as near to small lamps as they like, no light sample must count for more than it does.
#[inline]
fn worth(vertex: &Vertex, f: Lanes, samples: f32) -> f32 {
    if vertex.is_surface() { (f.max_lane() * (4.0 * PI / FAINT) / samples).min(1.0) } else { 1.0 }
}

impl Path {
    /// A light sample, straight or through a wall.
    #[inline]
    #[allow(clippy::too_many_arguments)] // those of a light sample
    pub(super) fn look_for_light(
        &self,
        scene: &Scene,
        settings: &VolPath,
        vertex: &Vertex,
        how: (&Attempt, [f32; 4]),
        of: (&PathWeights, &History),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        match Self::sight(scene, vertex) {
            Sight::Straight => self.sample_light(scene, vertex, how, of, sink, tally),
            // The wall is a vertex too.
            Sight::Behind | Sight::Past(_) if settings.max_depth.is_some_and(|limit| of.1.depth() + 1 >= limit) => {}
            Sight::Behind | Sight::Past(_) => self.sample_light_bent(scene, vertex, how, of, sink, tally),
        }
    }

    /// The light samples after the first at a surface, with numbers that lie evenly between its own.
    #[inline(never)]
    pub(super) fn look_again(
        &self,
        scene: &Scene,
        vertex: &Vertex,
        samples: u32,
        (attempt, numbers): (&Attempt, [f32; 4]),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        let of = (&self.weights, &self.history);
        for sample in 1..samples {
            let by = sample as f32 / samples as f32;
            let numbers = numbers.map(|u| if u + by < 1.0 { u + by } else { u + by - 1.0 });
            self.sample_light(scene, vertex, (attempt, numbers), of, sink, tally);
        }
    }

    /// Next event estimation: one light, one direction, one shadow ray.
    #[inline]
    fn sample_light(
        &self,
        scene: &Scene,
        vertex: &Vertex,
        (attempt, [u_choice, u, v, u_worth]): (&Attempt, [f32; 4]),
        (weights, history): (&PathWeights, &History),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        let reference = vertex.reference();
        let Some((id, probability)) = scene.lights.choose(&reference, u_choice) else { return };
        let light = scene.lights.get(id);
        let Some(sample) = light.sample(&reference, Vec2::new(u, v), &self.wavelengths) else { return };
        let (f, scatter_pdf) = vertex.eval(sample.dir);
        let samples = vertex.light_samples() as f32;
        let worth = worth(vertex, f, samples);
        if f.is_zero() || u_worth >= worth {
            return;
        }
        let Some(Attempt { odds, supposed, .. }) = attempt.towards(reference.p, sample.dir) else { return };
        let (inside, within) = self.inside_towards(scene, vertex, sample.dir);
        let origin = vertex.shadow_origin(sample.dir);
        let mut proxied_within;
        let (scene, inside, within) = match self.proxied_towards(scene, vertex, sample.dir) {
            None => (scene, inside, within),
            Some(proxied) => {
                proxied_within = *within;
                let ray = Ray::new(origin, sample.dir);
                let inside = proxied.enter_proxy(&ray, inside, &mut proxied_within, &self.wavelengths);
                (proxied, inside, &proxied_within)
            }
        };
        if !scene.light_can_reach(inside.id()) {
            return;
        }
        let wavelengths = (&self.wavelengths, self.hero);
        let arrives =
            shadow::transmittance(scene, origin, sample.dir, &sample.target, (inside, within), wavelengths, tally);
        if let Some(transmittance) = arrives {
            let scatter_pdf = if sample.dirac { 0.0 } else { scatter_pdf };
            let found = scatter_pdf * scene.reached(&inside, transmittance);
            let pdf = probability * sample.pdf;
            let weight = weights.light_sample([supposed * samples * pdf, pdf], found, transmittance);
            let turn = vertex.turn(vertex.crosses(self.ray.dir, sample.dir), false);
            let source = if light.is_environment() { Source::Sky(id) } else { Source::Light(id) };
            sink.add(weight * (supposed / (odds * worth)) * f * sample.li, history, Some(turn), source);
        }
    }

    /// The light sample that a walk deep inside a medium has announced.
    #[inline]
    pub fn sample_announced(
        &self,
        scene: &Scene,
        settings: &VolPath,
        (announced, phase): (&Announced, &Phase),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        let scene = self.world(scene);
        let Announced { p, dir, mut rng, .. } = *announced;
        let Some((attempt, weights)) = self.on_walk(announced, &mut rng) else { return };
        let (mut history, Some(medium)) = (self.history, self.inside.id()) else { return };
        history.walked(announced.collisions - 1);
        sink.turned(&mut history, Turn::Medium(medium), announced.collisions - 1);
        let numbers = [rng.next_1d(), rng.next_1d(), rng.next_1d(), 0.0];
        let vertex = Vertex::Medium { p, dir, medium, phase };
        self.look_for_light(scene, settings, &vertex, (&attempt, numbers), (&weights, &history), sink, tally);
    }

    /// The medium, and the bodies, that a ray from `vertex` towards `dir` starts in.
    #[inline]
    fn inside_towards(&self, scene: &Scene, vertex: &Vertex, dir: Vec3) -> (Inside, &Within) {
        match vertex {
            Vertex::Surface { hit, .. } if vertex.crosses(self.ray.dir, dir) => {
                if scene.has_bodies() {
                    return (self.beyond.inside(scene, &self.wavelengths), &self.beyond);
                }
                let inside = scene.object(hit).interface.map_or(self.inside, |interface| {
                    Inside::of(scene, interface.towards(dir.dot(hit.ng)), &self.wavelengths)
                });
                (inside, &self.within)
            }
            _ => (self.inside, &self.within),
        }
    }

    /// A lamp to aim at, where that is worth the while.
    #[inline]
    fn lamp(&mut self, scene: &Scene, settings: &VolPath) -> Option<Bounds> {
        let Inside::Medium { id, coefficients } = &self.inside else { return None };
        let is_cut = settings.max_depth.is_some_and(|limit| self.history.depth() >= limit);
        if settings.deep == Deep::Traced || is_cut || !scene.aims(*id, coefficients) {
            return None;
        }
        let from = Reference { p: self.ray.origin, normal: None };
        let u = if scene.lights.lights.len() > 1 { self.sampler.next_1d() } else { 0.0 };
        let (lamp, _) = scene.lights.choose(&from, u)?;
        scene.small_lamp(*id, lamp)
    }

    /// Light at a collision that was aimed at a lamp.
    #[inline]
    fn sample_aimed(&self, scene: &Scene, aimed: &Aimed, sink: &mut impl Sink, tally: &mut Tally) {
        let Aimed { p, weights, numbers: [u_choice, u, v] } = *aimed;
        let Some(medium) = self.inside.id() else { return };
        let vertex = Vertex::Medium { p, dir: self.ray.dir, medium, phase: &scene.medium(medium).phase };
        self.sample_light(
            scene,
            &vertex,
            (&Attempt::CERTAIN, [u_choice, u, v, 0.0]),
            (&weights, &self.history),
            sink,
            tally,
        );
    }
}
