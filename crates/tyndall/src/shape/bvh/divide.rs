//! Divides what goes into a tree into clusters, in space: planes by the surface area heuristic (MacDonald and Booth
//! 1990), counted in bins (Wald 2007) of a sample of the entries.

use super::build::Entry;
use crate::math::Bounds;

/// Entries that are looked at to find a plane.
const SAMPLES: usize = 1 << 14;
/// Places for a plane on each axis, and one more.
const BINS: usize = 32;

/// Where to divide: entries whose centre lies below `at` on `axis` go left.
#[derive(Clone, Copy)]
struct Plane {
    axis: usize,
    at: f32,
}

/// The entries, sorted into clusters of at most `longest`, or more where they all lie at one point. At least one.
pub(super) fn divide(entries: &mut [Entry], longest: usize) -> Vec<&mut [Entry]> {
    if entries.len() <= longest {
        return vec![entries];
    }
    let Some(plane) = best_plane(entries) else { return vec![entries] };
    let middle = partition(entries, plane);
    if middle == 0 || middle == entries.len() {
        return vec![entries]; // coordinates that are too large or too close for bins
    }
    let (left, right) = entries.split_at_mut(middle);
    let (mut left, mut right) = rayon::join(|| divide(left, longest), || divide(right, longest));
    left.append(&mut right);
    left
}

/// Moves the entries below the plane before the others; returns how many they are.
fn partition(entries: &mut [Entry], plane: Plane) -> usize {
    let mut below = 0;
    for i in 0..entries.len() {
        if entries[i].bounds().centre()[plane.axis] < plane.at {
            entries.swap(below, i);
            below += 1;
        }
    }
    below
}

/// The plane of the least cost, if the centres are not all the same.
fn best_plane(entries: &[Entry]) -> Option<Plane> {
    let samples: Vec<_> = entries.iter().step_by(entries.len().div_ceil(SAMPLES)).collect();
    let centres = Bounds::of(samples.iter().map(|entry| entry.bounds().centre()));
    let planes = (0..3).filter_map(|axis| best_on_axis(&samples, axis, centres.min[axis], centres.max[axis]));
    planes.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, plane)| plane)
}

/// The best plane across one axis, and its cost.
fn best_on_axis(samples: &[&Entry], axis: usize, least: f32, greatest: f32) -> Option<(f32, Plane)> {
    let width = (greatest - least) / BINS as f32;
    let edge = |bin: usize| least + width * bin as f32;
    let mut bins = [(0u32, Bounds::EMPTY); BINS];
    for entry in samples {
        let along = entry.bounds().centre()[axis];
        // The edge is what the entries are compared with, so it also says in which bin they are.
        let guess = (((along - least) / width) as usize).min(BINS - 1);
        let bin = if along < edge(guess) { guess.saturating_sub(1) } else { guess };
        bins[bin] = (bins[bin].0 + 1, bins[bin].1.union(entry.bounds()));
    }
    let mut above = [(0, 0.0); BINS];
    let mut all = (0, Bounds::EMPTY);
    for bin in (1..BINS).rev() {
        all = (all.0 + bins[bin].0, all.1.union(bins[bin].1));
        above[bin] = (all.0, all.1.half_area());
    }
    let mut below = (0, Bounds::EMPTY);
    let mut best: Option<(f32, Plane)> = None;
    for bin in 1..BINS {
        below = (below.0 + bins[bin - 1].0, below.1.union(bins[bin - 1].1));
        let (count, area) = above[bin];
        let cost = below.0 as f32 * below.1.half_area() + count as f32 * area;
        if below.0 > 0 && count > 0 && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, Plane { axis, at: edge(bin) }));
        }
    }
    best
}
