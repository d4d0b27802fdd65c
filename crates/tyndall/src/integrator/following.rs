//! How the path tracer follows its paths, one after the other or many at once, and where the light goes that they find.

use super::{
    CameraSample, Deep, Estimates, Integrator, VolPath,
    pool::{self, Crew},
    volpath::{Sink, Status},
    walk::{Announced, End, Walker},
};
use crate::{
    film::Part,
    path::{History, Path},
    phase::Phase,
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};

/// The radiance of a path, the whole and some parts of it.
struct Light<'a> {
    radiance: &'a mut Lanes,
    kinds: &'a [Part],
    parts: &'a mut [Lanes],
}

impl Sink for Light<'_> {
    #[inline]
    fn add(&mut self, radiance: Lanes, history: &History) {
        *self.radiance += radiance;
        for (kind, part) in self.kinds.iter().zip(&mut *self.parts) {
            if kind.holds(history) {
                *part += radiance;
            }
        }
    }
}

impl Integrator for VolPath {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        let mut radiance = Lanes::ZERO;
        self.follow(scene, seen, &mut Light { radiance: &mut radiance, kinds: &[], parts: &mut [] }, tally);
        radiance
    }

    fn li_many(&self, scene: &Scene, samples: &[CameraSample], kinds: &[Part], tally: &mut Tally) -> Estimates {
        let found = Estimates {
            radiance: vec![Lanes::ZERO; samples.len()],
            parts: vec![Lanes::ZERO; samples.len() * kinds.len()],
        };
        let mut following = Following { scene, settings: self, kinds, found };
        if self.deep == Deep::Together && !scene.media.is_empty() {
            let paths = samples.iter().map(|seen| Path::new(scene, seen)).enumerate();
            pool::follow(scene, &mut following, paths, tally);
        } else {
            for (sample, seen) in samples.iter().enumerate() {
                self.follow(scene, seen, &mut following.gain(sample), tally);
            }
        }
        following.found
    }

    fn tells_parts(&self) -> bool {
        true
    }
}

impl VolPath {
    /// Follows one path by itself.
    fn follow(&self, scene: &Scene, seen: &CameraSample, light: &mut Light, tally: &mut Tally) {
        let mut path = Path::new(scene, seen);
        while path.step(scene, self, light, tally) == Status::Alive {
            if let Some(mut walker) = path.begin_walk(self) {
                let phase = &scene.medium(walker.medium).phase;
                let end = walker.alone(phase, |announced| path.sample_announced(scene, announced, phase, light, tally));
                path.end_walk(&walker, end, phase, tally);
            }
        }
    }
}

/// Radiance along many camera rays, by paths that are under way together.
struct Following<'a> {
    scene: &'a Scene,
    settings: &'a VolPath,
    kinds: &'a [Part],
    found: Estimates,
}

impl Following<'_> {
    /// Where the light of a sample goes.
    fn gain(&mut self, sample: usize) -> Light<'_> {
        let count = self.kinds.len();
        let parts = &mut self.found.parts[sample * count..][..count];
        Light { radiance: &mut self.found.radiance[sample], kinds: self.kinds, parts }
    }
}

impl Crew for Following<'_> {
    /// A path with the number of its camera ray.
    type Member = (usize, Path);

    fn advance(&mut self, (sample, path): &mut Self::Member, tally: &mut Tally) -> Option<Walker> {
        let (scene, settings) = (self.scene, self.settings);
        let mut light = self.gain(*sample);
        while path.step(scene, settings, &mut light, tally) == Status::Alive {
            if let Some(walker) = path.begin_walk(settings) {
                return Some(walker);
            }
        }
        None
    }

    fn light(&mut self, (sample, path): &Self::Member, announced: &Announced, phase: &Phase, tally: &mut Tally) {
        let scene = self.scene;
        path.sample_announced(scene, announced, phase, &mut self.gain(*sample), tally);
    }

    fn end_walk(&mut self, (_, path): &mut Self::Member, walker: &Walker, end: End, phase: &Phase, tally: &mut Tally) {
        path.end_walk(walker, end, phase, tally);
    }
}
