//! Light taken apart while it is found: each contribution of a path is added to the layers that its history belongs to.
//!
//! The light itself is summed as it is without layers, in single precision, in the order in which it is found. Layers are
//! summed in double precision, so that those of a partition add up to all contributions; the film deals with what is left
//! between the two sums ([`crate::film::parts`]).

use super::{CameraSample, volpath::Sink};
use crate::{
    lpe::Automaton,
    path::{History, Source, Turn},
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};

/// An estimator that knows what its paths go through.
pub trait TakesApart: Sync {
    /// Estimates for many camera rays, in their order, with the bits of
    /// [`Integrator::li_many`](super::Integrator::li_many), and their layers.
    fn li_apart(&self, scene: &Scene, by: &Automaton, samples: &[CameraSample], tally: &mut Tally) -> Parts;
}

/// Radiance along many camera rays, and its layers.
#[derive(Debug, Clone)]
pub struct Parts {
    layers: usize,
    /// In the order of the rays.
    pub radiance: Vec<Lanes>,
    /// Of each ray the sum of all contributions, then that of each layer.
    sums: Vec<[f64; 4]>,
}

impl Parts {
    /// Nothing yet, along so many rays.
    pub fn new(layers: usize, rays: usize) -> Self {
        Self { layers, radiance: vec![Lanes::ZERO; rays], sums: vec![[0.0; 4]; rays * (layers + 1)] }
    }

    /// Radiance without layers.
    pub fn undivided(radiance: Vec<Lanes>) -> Self {
        Self { layers: 0, radiance, sums: Vec::new() }
    }

    /// The sum of all contributions along a ray, and that of each layer.
    pub fn of(&self, ray: usize) -> (&[f64; 4], &[[f64; 4]]) {
        let sums = &self.sums[ray * (self.layers + 1)..][..=self.layers];
        (&sums[0], &sums[1..])
    }

    /// A sink for each ray.
    pub(super) fn sinks<'a>(&'a mut self, by: &'a Automaton) -> Vec<PartSink<'a>> {
        let rays = self.radiance.iter_mut().zip(self.sums.chunks_mut(self.layers + 1));
        rays.map(|(radiance, sums)| PartSink { by, radiance, sums }).collect()
    }
}

/// Takes what one path finds apart.
#[derive(Debug)]
pub(super) struct PartSink<'a> {
    by: &'a Automaton,
    radiance: &'a mut Lanes,
    sums: &'a mut [[f64; 4]],
}

impl Sink for PartSink<'_> {
    #[inline]
    fn add(&mut self, radiance: Lanes, history: &History, last: Option<Turn>, source: Source) {
        *self.radiance += radiance;
        let state = last.map_or(history.state, |turn| self.by.turn(history.state, turn));
        let (values, mut layers) = (radiance.to_array().map(f64::from), self.by.selects(state, source));
        add(&mut self.sums[0], values);
        while layers != 0 {
            add(&mut self.sums[1 + layers.trailing_zeros() as usize], values);
            layers &= layers - 1;
        }
    }

    #[inline]
    fn turned(&self, history: &mut History, turn: Turn, times: u32) {
        history.state = self.by.turns(history.state, turn, times);
    }
}

#[inline]
fn add(sum: &mut [f64; 4], values: [f64; 4]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += value;
    }
}
