//! Many paths at once: those that are deep inside a medium walk together, the others step one after the other.
//!
//! A path is a value that owns its random numbers, so the order in which paths are followed cannot be seen in an image.

use super::{
    CameraSample, VolPath,
    volpath::Status,
    walk::together::{WIDTH, Walks},
};
use crate::{medium::MediumId, path::Path, scene::Scene, spectrum::Lanes, tally::Tally};

/// Paths under way at once: enough that walks rarely wait for others, and few enough for the cache.
const PATHS: usize = 128;

/// Paths under way.
struct Pool<'a> {
    scene: &'a Scene,
    settings: &'a VolPath,
    paths: Vec<Slot>,
    /// Numbers of paths that are at their end.
    free: Vec<u32>,
    /// Walks under way, by medium.
    walks: Vec<Walks>,
    radiance: Vec<Lanes>,
}

/// A path with the number of the sample that it belongs to.
struct Slot {
    path: Path,
    sample: usize,
}

/// The radiance along each of `samples`, in their order.
pub(super) fn estimate(scene: &Scene, settings: &VolPath, samples: &[CameraSample], tally: &mut Tally) -> Vec<Lanes> {
    let mut pool = Pool {
        scene,
        settings,
        paths: Vec::with_capacity(PATHS),
        free: Vec::new(),
        walks: (0..scene.media.len())
            .map(|i| MediumId(i as u32))
            .map(|id| Walks::new(id, scene.light_can_reach(Some(id))))
            .collect(),
        radiance: vec![Lanes::ZERO; samples.len()],
    };
    let mut samples = samples.iter().enumerate();
    let mut ended = Vec::with_capacity(PATHS);
    loop {
        while let Some(slot) = pool.free_slot() {
            let Some((sample, seen)) = samples.next() else { break };
            pool.start(slot, sample, seen, tally);
        }
        let Some(walks) = pool.walks.iter_mut().max_by_key(|walks| walks.len()) else { break };
        if walks.len() == 0 {
            break;
        }
        let least = if walks.len() < WIDTH { 1 } else { WIDTH };
        let (paths, phase) = (&mut pool.paths, &scene.medium(walks.medium()).phase);
        walks.advance(phase, least, |slot, walker, end| {
            paths[slot as usize].path.end_walk(walker, end, phase, tally);
            ended.push(slot);
        });
        for slot in ended.drain(..) {
            pool.advance(slot, tally);
        }
    }
    pool.radiance
}

impl Pool<'_> {
    /// The number of a path that can be begun.
    fn free_slot(&self) -> Option<u32> {
        self.free.last().copied().or_else(|| (self.paths.len() < PATHS).then_some(self.paths.len() as u32))
    }

    fn start(&mut self, slot: u32, sample: usize, seen: &CameraSample, tally: &mut Tally) {
        let path = Path::new(self.scene, seen);
        match self.free.pop() {
            Some(free) => self.paths[free as usize] = Slot { path, sample },
            None => self.paths.push(Slot { path, sample }),
        }
        self.advance(slot, tally);
    }

    /// Follows a path until it walks deep inside a medium or ends.
    fn advance(&mut self, slot: u32, tally: &mut Tally) {
        let Slot { path, sample } = &mut self.paths[slot as usize];
        let radiance = &mut self.radiance[*sample];
        while path.step(self.scene, self.settings, radiance, tally) == Status::Alive {
            if let Some(walker) = path.begin_walk(self.settings) {
                self.walks[walker.medium.0 as usize].push(slot, walker);
                return;
            }
        }
        self.free.push(slot);
    }
}
