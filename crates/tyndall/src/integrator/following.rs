//! How the path tracer follows its paths, one after the other or many at once, each with a sink of its own.

use super::{
    CameraSample, Deep, Integrator, Parts, TakesApart, VolPath,
    pool::{self, Crew},
    volpath::{Sink, Status},
    walk::{Announced, End, Walker},
};
use crate::{lpe::Automaton, path::Path, phase::Phase, scene::Scene, spectrum::Lanes, tally::Tally};

impl Integrator for VolPath {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        let mut radiance = Lanes::ZERO;
        self.follow(scene, seen, &mut radiance, tally);
        radiance
    }

    fn li_many(&self, scene: &Scene, samples: &[CameraSample], tally: &mut Tally) -> Vec<Lanes> {
        let mut radiance = vec![Lanes::ZERO; samples.len()];
        self.follow_many(scene, samples, &mut radiance, tally);
        radiance
    }

    fn apart(&self) -> Option<&dyn TakesApart> {
        Some(self)
    }
}

impl TakesApart for VolPath {
    fn li_apart(&self, scene: &Scene, by: &Automaton, samples: &[CameraSample], tally: &mut Tally) -> Parts {
        let mut parts = Parts::new(by.layers(), samples.len());
        let mut sinks = parts.sinks(by);
        self.follow_many(scene, samples, &mut sinks, tally);
        parts
    }
}

impl VolPath {
    /// A path at the camera.
    fn begin(&self, scene: &Scene, seen: &CameraSample) -> Path {
        let mut path = Path::new(scene, seen);
        if let Some(grains) = self.explicit_grains {
            path.limit_grains(scene, grains);
        }
        path
    }

    /// Follows a path to its end.
    fn follow(&self, scene: &Scene, seen: &CameraSample, sink: &mut impl Sink, tally: &mut Tally) {
        let mut path = self.begin(scene, seen);
        while path.step(scene, self, sink, tally) == Status::Alive {
            if let Some(mut walker) = path.begin_walk(self) {
                let phase = &scene.medium(walker.medium).phase;
                let end = walker
                    .alone(phase, |announced| path.sample_announced(scene, self, (announced, phase), sink, tally));
                path.end_walk(&walker, end, phase, sink, tally);
            }
        }
    }

    /// Follows many to theirs, each with a sink of its own.
    fn follow_many<S: Sink>(&self, scene: &Scene, samples: &[CameraSample], sinks: &mut [S], tally: &mut Tally) {
        if self.deep == Deep::Together && !scene.media.is_empty() {
            let paths = samples.iter().map(|seen| self.begin(scene, seen)).enumerate();
            return pool::follow(scene, &mut Estimates { scene, settings: self, sinks }, paths, tally);
        }
        for (seen, sink) in samples.iter().zip(sinks) {
            self.follow(scene, seen, sink, tally);
        }
    }
}

/// What many camera rays find, by paths that are under way together.
struct Estimates<'a, S> {
    scene: &'a Scene,
    settings: &'a VolPath,
    sinks: &'a mut [S],
}

impl<S: Sink> Crew for Estimates<'_, S> {
    /// A path with the number of its camera ray.
    type Member = (usize, Path);

    fn advance(&mut self, (sample, path): &mut Self::Member, tally: &mut Tally) -> Option<Walker> {
        let sink = &mut self.sinks[*sample];
        while path.step(self.scene, self.settings, sink, tally) == Status::Alive {
            if let Some(walker) = path.begin_walk(self.settings) {
                return Some(walker);
            }
        }
        None
    }

    fn light(&mut self, (sample, path): &Self::Member, announced: &Announced, phase: &Phase, tally: &mut Tally) {
        path.sample_announced(self.scene, self.settings, (announced, phase), &mut self.sinks[*sample], tally);
    }

    fn end_walk(&mut self, member: &mut Self::Member, walker: &Walker, end: End, phase: &Phase, tally: &mut Tally) {
        let (sample, path) = member;
        path.end_walk(walker, end, phase, &self.sinks[*sample], tally);
    }
}
