//! Layers: what a film records beside light, pixel by pixel.
//!
//! A layer has four lanes, each with its sum and squared sum over the samples of a pixel; how many there were is known
//! from the pixel itself. A layer that is defined only where something was hit keeps the weight of hits in its last lane.

use super::{Bands, Part, standard_error};
use crate::feature::Feature;

/// What a layer records, and how it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerKind {
    /// What is recorded.
    pub recorded: Recorded,
    /// Names of its lanes, at most four.
    pub channels: Vec<String>,
    /// What it is the mean of.
    pub average: Average,
}

/// What a layer records of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recorded {
    /// Something of the first surface.
    Surface(Feature),
    /// The light in bands of wavelengths.
    Light(Bands),
    /// A part of the light.
    Part(Part),
}

/// Over what a layer is averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Average {
    /// Over all samples: where nothing was hit, 0 counts.
    Samples,
    /// Over the samples that hit something; 0 without any.
    Hits,
    /// As a direction: the mean, made a unit vector; 0 without any.
    Directions,
    /// Over the samples that hit something, without its sign; 0 without any.
    Sizes,
}

/// The four lanes of a layer in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cell {
    /// Σ x.
    pub sum: [f64; 4],
    /// Σ x².
    pub sum_of_squares: [f64; 4],
}

/// A layer of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What it records.
    pub kind: LayerKind,
    /// As the pixels of the film, row by row.
    pub cells: Vec<Cell>,
}

impl Cell {
    /// Adds one sample.
    #[inline]
    pub fn add(&mut self, value: [f32; 4]) {
        for (lane, v) in value.into_iter().enumerate() {
            let v = f64::from(v);
            self.sum[lane] += v;
            self.sum_of_squares[lane] += v * v;
        }
    }

    /// Adds the samples of another cell.
    pub fn merge(&mut self, other: &Self) {
        for lane in 0..4 {
            self.sum[lane] += other.sum[lane];
            self.sum_of_squares[lane] += other.sum_of_squares[lane];
        }
    }

    /// What it says of its pixel after `count` samples.
    pub fn value(&self, average: Average, count: u64) -> [f32; 4] {
        let by = match average {
            Average::Samples => count as f64,
            Average::Hits | Average::Sizes => self.sum[3],
            Average::Directions => self.sum[..3].iter().map(|v| v * v).sum::<f64>().sqrt(),
        };
        let mean = if by == 0.0 { [0.0; 4] } else { self.sum.map(|v| (v / by) as f32) };
        if average == Average::Sizes { mean.map(f32::abs) } else { mean }
    }

    /// Standard error of the mean over all samples.
    pub fn standard_error(&self, count: u64) -> [f32; 4] {
        std::array::from_fn(|lane| standard_error(self.sum[lane], self.sum_of_squares[lane], count))
    }
}
