//! Independent runs of one renderer in turns, and what they say of it: its error and its efficiency.

use serde::Serialize;

use super::image::Image;
use super::statistics::{mean_squared_error, median};

/// A few runs by one renderer, then as many by the other: one turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn {
    /// From 0
    pub(crate) index: u32,
    /// Runs of each renderer
    pub(crate) runs: u32,
}

impl Turn {
    /// Seed of its first run; the next runs count on.
    pub(crate) fn seed(self) -> u32 {
        1 + self.index * self.runs
    }

    /// The turns of a comparison.
    pub(crate) fn all(turns: u32, runs: u32) -> impl Iterator<Item = Self> {
        (0..turns).map(move |index| Self { index, runs })
    }
}

/// Pictures of independent runs and what they took together.
#[derive(Debug)]
pub(crate) struct Runs {
    /// One picture a run
    pub(crate) images: Vec<Image>,
    /// CPU seconds of all runs [s]
    pub(crate) cpu_seconds: f64,
}

/// Turns of one renderer.
pub(crate) fn images(turns: &[Runs]) -> Vec<Image> {
    turns.iter().flat_map(|runs| runs.images.iter().cloned()).collect()
}

/// CPU seconds of one run in each turn.
fn cpu_seconds_of_a_run(turns: &[Runs]) -> Vec<f64> {
    turns.iter().map(|runs| runs.cpu_seconds / runs.images.len() as f64).collect()
}

/// Efficiency and its parts, of one renderer on one scene.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Side {
    /// Samples a pixel in one run
    pub(crate) spp: u32,
    /// Independent runs
    pub(crate) runs: usize,
    /// Mean squared error of one run, over pixels and channels
    pub(crate) mse: f64,
    /// Mean over pixels and channels
    pub(crate) mean: f64,
    /// `1/(MSE · CPU s)` [1/s]
    pub(crate) efficiency: f64,
    /// The same with the error relative to the mean of the picture: `mean²/(MSE · CPU s)` [1/s]
    pub(crate) neff: f64,
    /// CPU seconds of one run, in each turn [s]
    pub(crate) cpu_seconds: Vec<f64>,
}

impl Side {
    /// From the turns of a renderer.
    pub(crate) fn of(turns: &[Runs], spp: u32) -> Self {
        let images = images(turns);
        let cpu_seconds = cpu_seconds_of_a_run(turns);
        let mse = mean_squared_error(&images);
        let values = images.iter().flat_map(|image| image.pixels.iter().flatten());
        let mean =
            values.map(|&value| f64::from(value)).sum::<f64>() / (images.len() * images[0].pixels.len() * 3) as f64;
        let efficiency = 1.0 / (mse * median(&cpu_seconds));
        Self { spp, runs: images.len(), mse, mean, neff: efficiency * mean * mean, efficiency, cpu_seconds }
    }

    /// The median over the turns of the ratios of efficiencies: each turn met the same weather on the machine.
    pub(crate) fn efficiency_over(&self, other: &Self) -> f64 {
        let times: Vec<f64> =
            other.cpu_seconds.iter().zip(&self.cpu_seconds).map(|(theirs, ours)| theirs / ours).collect();
        other.mse / self.mse * median(&times)
    }
}
