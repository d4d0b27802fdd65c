//! How the tree over lights is built: from above, along the longest side, where the sum of the costs is least.
//!
//! Conty Estevez and Kulla 2018, § 4.4; eight children a node, the costliest part of a node divided first.

use super::{Child, Hierarchy, Home, Node, Place, WIDTH};
use crate::{
    light::{LightId, bounds::LightBounds},
    math::Bounds,
};

/// From this depth on ranges are halved, so that no tree is deep.
const MAX_UNEVEN_DEPTH: u32 = 24;
const BUCKETS: usize = 16;

impl Hierarchy {
    /// Splits ranges of `leaves`, the costliest first, until a node has eight children; then does the same with each.
    pub(super) fn build(&mut self, leaves: &mut [(LightBounds, LightId)]) {
        if leaves.is_empty() {
            return;
        }
        let mut stack = vec![(0..leaves.len(), None, 0)];
        while let Some((range, parent, depth)) = stack.pop() {
            let index = self.nodes.len() as u32;
            if let Some(Place { node, slot }) = parent {
                self.nodes[node as usize].child[slot as usize] = Child::Node(index);
            }
            let mut node = Node::empty(parent);
            for (slot, (range, bounds)) in eight_ranges(leaves, range, depth).into_iter().enumerate() {
                let place = Place { node: index, slot: slot as u32 };
                node.set(slot, &bounds);
                if range.len() == 1 {
                    let id = leaves[range.start].1;
                    node.child[slot] = Child::Light(id);
                    self.homes[id.0 as usize] = Home::Tree(place);
                } else {
                    stack.push((range, Some(place), depth + 1));
                }
            }
            self.nodes.push(node);
        }
    }
}

type Range = std::ops::Range<usize>;

/// Up to eight parts of a range, with what bounds them.
fn eight_ranges(leaves: &mut [(LightBounds, LightId)], range: Range, depth: u32) -> Vec<(Range, LightBounds)> {
    let mut parts = vec![(range.clone(), bounds_of(&leaves[range]))];
    while parts.len() < WIDTH {
        let splittable = parts.iter().enumerate().filter(|(_, (range, _))| range.len() > 1);
        let costliest = splittable.max_by(|a, b| a.1.1.cost().total_cmp(&b.1.1.cost()));
        let Some((index, _)) = costliest else { break };
        let (range, _) = parts.swap_remove(index);
        let middle = range.start + split(&mut leaves[range.clone()], depth);
        for part in [range.start..middle, middle..range.end] {
            let bounds = bounds_of(&leaves[part.clone()]);
            parts.push((part, bounds));
        }
    }
    // In the order of the leaves, which are near in space where they are near in order: stratified numbers stay so.
    parts.sort_unstable_by_key(|(range, _)| range.start);
    parts
}

/// The bounds of a range that is not empty.
fn bounds_of(leaves: &[(LightBounds, LightId)]) -> LightBounds {
    leaves[1..].iter().fold(leaves[0].0, |all, (bounds, _)| all.union(*bounds))
}

/// Sorts leaves into two parts that are not empty, along the longest side of the box of their middles, where the sum of
/// the costs is least; where there is nothing to choose, halves them.
fn split(leaves: &mut [(LightBounds, LightId)], depth: u32) -> usize {
    let half = leaves.len() / 2;
    let middles = Bounds::of(leaves.iter().map(|(b, _)| b.bounds.centre()));
    let extent = middles.extent();
    let axis = extent.max_position();
    let place = |b: &LightBounds| (b.bounds.centre()[axis] - middles.min[axis]) / extent[axis];
    if extent[axis] <= 0.0 {
        return half;
    }
    if depth > MAX_UNEVEN_DEPTH || !extent[axis].is_finite() {
        leaves
            .select_nth_unstable_by(half, |(a, _), (b, _)| a.bounds.centre()[axis].total_cmp(&b.bounds.centre()[axis]));
        return half;
    }
    let bucket = |b: &LightBounds| ((place(b) * BUCKETS as f32) as usize).min(BUCKETS - 1);
    let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
    for (bounds, _) in leaves.iter() {
        join(&mut buckets[bucket(bounds)], Some(*bounds));
    }
    let mut right = [None; BUCKETS];
    (1..BUCKETS).rev().fold(None, |mut sum, i| {
        join(&mut sum, buckets[i]);
        right[i] = sum;
        sum
    });
    // The first bucket and the last are never empty.
    let (mut left, mut best) = (buckets[0], (f32::INFINITY, 1));
    for i in 1..BUCKETS {
        let cost = left.map_or(0.0, |b| b.cost()) + right[i].map_or(0.0, |b: LightBounds| b.cost());
        if cost < best.0 {
            best = (cost, i);
        }
        join(&mut left, buckets[i]);
    }
    let mut middle = 0;
    for i in 0..leaves.len() {
        if bucket(&leaves[i].0) < best.1 {
            leaves.swap(i, middle);
            middle += 1;
        }
    }
    middle
}

fn join(sum: &mut Option<LightBounds>, more: Option<LightBounds>) {
    *sum = match (*sum, more) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    };
}
