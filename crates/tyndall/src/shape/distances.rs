//! Distances to the nearest surface, remembered.
//!
//! Far from all surfaces a search in the tree is at its slowest: from the middle of a body half of its surface is about
//! equally near. So a grid over the bodies remembers the distance `d` from the centre of each cell; it is measured when the
//! cell is asked for first. From a point at distance `s` from the centre no surface is nearer than `d − s`. Where that is
//! less than the size of a cell, near the surface, a search is quick and the grid has no answer.
//!
//! What a cell holds depends on where it is alone, so no order of threads and questions can be seen in an answer.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::math::{Bounds, Vec3, rounding::gamma};

/// Cells along the longest side: of a body that is even within a cell a thirtieth of it remains to be searched.
const CELLS: f32 = 32.0;
/// Stands for a distance that nobody has asked for: the bits of no distance.
const UNKNOWN: u32 = u32::MAX;

/// The grid.
#[derive(Debug)]
pub struct Distances {
    min: Vec3,
    /// Side of a cell [length].
    side: f32,
    counts: [usize; 3],
    /// By cell, x fastest: bits of a distance [length].
    cells: Vec<AtomicU32>,
}

impl Distances {
    /// Over a box; `None` if that is empty, flat or without bounds.
    pub fn over(bounds: &Bounds) -> Option<Self> {
        let extent = bounds.extent();
        let side = extent.max_element() / CELLS;
        if !(side > 0.0 && extent.is_finite() && bounds.min.is_finite()) {
            return None;
        }
        let counts = (extent / side).to_array().map(|n| (n.ceil() as usize).clamp(1, CELLS as usize));
        let cells = (0..counts.iter().product()).map(|_| AtomicU32::new(UNKNOWN)).collect();
        Some(Self { min: bounds.min, side, counts, cells })
    }

    /// A lower bound on the distance from `p` to the nearest surface [length], given how to `search` for it; `None` outside
    /// of the grid and near a surface.
    #[inline]
    pub fn bound(&self, p: Vec3, search: impl FnOnce(Vec3) -> f32) -> Option<f32> {
        let (centre, nearest) = self.cell(p, search)?;
        let bound = nearest - (p - centre).length() - gamma(8) * nearest;
        (bound > self.side).then_some(bound)
    }

    /// What the distance from `p` to the nearest surface can be at most, but where distances are bounds \[length\]; `None` outside
    /// of the grid.
    #[inline]
    pub fn at_most(&self, p: Vec3, search: impl FnOnce(Vec3) -> f32) -> Option<f32> {
        let (centre, nearest) = self.cell(p, search)?;
        Some(nearest + (p - centre).length())
    }

    /// The centre of the cell that `p` is in, and the distance from there to the nearest surface [length]; `None` outside of
    /// the grid.
    #[inline]
    fn cell(&self, p: Vec3, search: impl FnOnce(Vec3) -> f32) -> Option<(Vec3, f32)> {
        let place = (p - self.min) / self.side;
        let [x, y, z] = place.to_array();
        let [nx, ny, nz] = self.counts;
        // Also false for NaN.
        let inside = x >= 0.0 && y >= 0.0 && z >= 0.0 && x < nx as f32 && y < ny as f32 && z < nz as f32;
        if !inside {
            return None;
        }
        let centre = self.min + (place.floor() + 0.5) * self.side;
        let cell = &self.cells[x as usize + nx * (y as usize + ny * z as usize)];
        let mut nearest = f32::from_bits(cell.load(Ordering::Relaxed));
        if nearest.is_nan() {
            nearest = search(centre);
            cell.store(nearest.to_bits(), Ordering::Relaxed);
        }
        Some((centre, nearest))
    }
}
