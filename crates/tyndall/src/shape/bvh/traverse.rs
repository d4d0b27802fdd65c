//! Walks a tree along a ray, nearest boxes first.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::{Child, Content, NONE, Node, Primitive, Tree, bundle::Sight, prefetch::prefetch, triangle::Shear};
use crate::math::{Ray, Vec2, Vec3};

/// Relative error allowed for the distances to a box's planes: see the head of [`super`].
const SLACK: f32 = 12.0 / (1 << 24) as f32;

/// The nearest hit so far.
#[derive(Debug, Clone, Copy)]
pub(in crate::shape) struct Nearest {
    /// Its distance, or how far to look while there is none.
    pub(in crate::shape) t: f32,
    /// `NONE` while there is no hit.
    pub(in crate::shape) object: u32,
    pub(in crate::shape) prim: u32,
    pub(in crate::shape) instance: u32,
    pub(in crate::shape) uv: Vec2,
}

impl Nearest {
    pub(in crate::shape) fn before(t_max: f32) -> Self {
        Self { t: t_max, object: NONE, prim: 0, instance: NONE, uv: Vec2::ZERO }
    }

    #[inline(always)]
    pub(in crate::shape) fn found(&self) -> bool {
        self.object != NONE
    }
}

/// Takes what a ray meets.
pub(in crate::shape) trait Met {
    /// How far there is to look.
    fn limit(&self) -> f32;

    /// Whether the way is known to be blocked.
    fn is_blocked(&self) -> bool;

    /// A hit before the limit.
    fn take(&mut self, hit: Nearest);
}

impl Met for Nearest {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t
    }

    #[inline(always)]
    fn is_blocked(&self) -> bool {
        self.found()
    }

    #[inline(always)]
    fn take(&mut self, hit: Nearest) {
        *self = hit;
    }
}

/// A ray made ready for boxes.
struct Slabs {
    origin: Vec3,
    /// `1/dir`, shortened for the near planes and lengthened for the far ones.
    near: Vec3,
    far: Vec3,
    /// The near plane of each axis in [`Node::planes`]; the far one is its neighbour.
    side: [usize; 3],
}

impl Slabs {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        // A component too small to invert moves the ray nowhere: any finite inverse does.
        // Written out: `map` is not always inlined, and then loses the instruction set.
        let inverse = |d: f32| 1.0 / d.abs().max(f32::MIN_POSITIVE).copysign(d);
        let inv = Vec3::new(inverse(ray.dir.x), inverse(ray.dir.y), inverse(ray.dir.z));
        let side = [usize::from(inv.x < 0.0), 2 + usize::from(inv.y < 0.0), 4 + usize::from(inv.z < 0.0)];
        Self { origin: ray.origin, near: inv * (1.0 - SLACK), far: inv * (1.0 + SLACK), side }
    }

    /// The boxes that the ray meets before `t_max`, and where it enters them.
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, node: &Node, t_max: f32) -> (u32, [f32; 8]) {
        let [x, y, z] = self.side;
        let enter = self.distance(simd, &node.planes[x], 0, self.near.x);
        let enter = enter.max(self.distance(simd, &node.planes[y], 1, self.near.y));
        let enter = enter.max(self.distance(simd, &node.planes[z], 2, self.near.z));
        let enter = enter.max(f32x8::splat(simd, 0.0));
        let leave = self.distance(simd, &node.planes[x ^ 1], 0, self.far.x);
        let leave = leave.min(self.distance(simd, &node.planes[y ^ 1], 1, self.far.y));
        let leave = leave.min(self.distance(simd, &node.planes[z ^ 1], 2, self.far.z));
        let leave = leave.min(f32x8::splat(simd, t_max));
        (enter.simd_le(leave).to_bitmask() as u32, enter.into())
    }

    // A function, not a closure: closures are not always inlined, and then lose the instruction set.
    #[inline(always)]
    fn distance<S: Simd>(&self, simd: S, plane: &[f32; 8], axis: usize, inv: f32) -> f32x8<S> {
        (f32x8::simd_from(simd, *plane) - f32x8::splat(simd, self.origin[axis])) * f32x8::splat(simd, inv)
    }
}

/// Boxes still to be opened, each as its distance (upper half) and its content (lower half). Distances are not
/// negative, so these numbers sort like them.
pub(in crate::shape) struct Stack {
    top: [u64; 32],
    len: usize,
    /// For the rest, which is rarely needed; the top is kept short because it is cleared for every ray.
    spill: Vec<u64>,
}

impl Stack {
    #[inline(always)]
    pub(in crate::shape) fn new() -> Self {
        Self { top: [0; 32], len: 0, spill: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, key: u64) {
        if self.len < self.top.len() {
            self.top[self.len] = key;
            self.len += 1;
        } else {
            self.spill.push(key);
        }
    }

    /// The next box that begins before `t_max`.
    #[inline(always)]
    pub(in crate::shape) fn pop(&mut self, t_max: f32) -> Option<Child> {
        loop {
            let key = match self.spill.pop() {
                Some(key) => key,
                None if self.len == 0 => return None,
                None => {
                    self.len -= 1;
                    self.top[self.len & 31]
                }
            };
            if f32::from_bits((key >> 32) as u32) < t_max {
                return Some(Child(key as u32));
            }
        }
    }
}

/// Finds the nearest hit before the limit (or any that blocks, if `ANY`) in `tree`; `visit` tests what is not a triangle.
#[inline(always)]
pub(in crate::shape) fn traverse<S: Simd, M: Met, const ANY: bool>(
    simd: S,
    tree: &Tree,
    ray: &Ray,
    met: &mut M,
    mut visit: impl FnMut(&Primitive, &mut M),
) {
    let Some(mut child) = tree.root else { return };
    let slabs = Slabs::new(ray);
    let (mut shear, mut sight) = (None, None);
    let mut stack = Stack::new();
    loop {
        match child.content() {
            Content::Node(index) => {
                let node = &tree.nodes[index];
                let (mask, enter) = slabs.meet(simd, node, met.limit());
                prefetch_children(tree, node, mask);
                if let Some(first) = open(node, mask, &enter, &mut stack) {
                    child = first;
                    continue;
                }
            }
            Content::Packets { first, count } => {
                // Made here and not before: short flights meet no triangle.
                let shear = match shear {
                    Some(shear) => shear,
                    None => *shear.insert(Shear::new(ray)),
                };
                for packet in first..first + count {
                    test_packet(simd, tree, packet, &shear, met);
                }
            }
            Content::Bundles { first, count } => {
                let sight = match sight {
                    Some(sight) => sight,
                    None => *sight.insert(Sight::new(ray)),
                };
                for bundle in &tree.bundles[first..first + count] {
                    let mut mask = sight.candidates(simd, bundle, met.limit());
                    while mask != 0 {
                        visit(&bundle.primitive((mask.trailing_zeros() & 7) as usize), met);
                        mask &= mask - 1;
                    }
                }
            }
            Content::Others { first, count } => {
                for primitive in &tree.others[first..first + count] {
                    visit(primitive, met);
                }
            }
        }
        if ANY && met.is_blocked() {
            return;
        }
        match stack.pop(met.limit()) {
            Some(next) => child = next,
            None => return,
        }
    }
}

/// All boxes that were met will soon be opened, or most.
#[inline(always)]
fn prefetch_children(tree: &Tree, node: &Node, mut mask: u32) {
    while mask != 0 {
        match node.child[(mask.trailing_zeros() & 7) as usize].content() {
            Content::Node(index) => prefetch(&tree.nodes[index]),
            Content::Packets { first, .. } => prefetch(&tree.packets[first].vertex),
            Content::Bundles { first, .. } => prefetch(&tree.bundles[first].ends),
            Content::Others { first, .. } => prefetch(&tree.others[first]),
        }
        mask &= mask - 1;
    }
}

/// The nearest box that was met; the others go onto the stack, farthest first.
#[inline(always)]
pub(in crate::shape) fn open(node: &Node, mask: u32, enter: &[f32; 8], stack: &mut Stack) -> Option<Child> {
    if mask == 0 {
        return None;
    }
    let key = |mask: u32| {
        let slot = (mask.trailing_zeros() & 7) as usize;
        u64::from(enter[slot].to_bits()) << 32 | u64::from(node.child[slot].0)
    };
    let first = key(mask);
    let mask = mask & (mask - 1);
    if mask == 0 {
        return Some(Child(first as u32));
    }
    let second = key(mask);
    let mut mask = mask & (mask - 1);
    if mask == 0 {
        stack.push(first.max(second));
        return Some(Child(first.min(second) as u32));
    }
    let mut keys = [0; 8];
    (keys[0], keys[1]) = (first.max(second), first.min(second));
    let mut len = 2;
    while mask != 0 {
        let key = key(mask);
        mask &= mask - 1;
        let mut at = len;
        while at > 0 && keys[at - 1] < key {
            keys[at & 7] = keys[at - 1];
            at -= 1;
        }
        keys[at & 7] = key;
        len += 1;
    }
    for &key in &keys[..len - 1] {
        stack.push(key);
    }
    Some(Child(keys[len - 1] as u32))
}

#[inline(always)]
fn test_packet<S: Simd, M: Met>(simd: S, tree: &Tree, packet: usize, shear: &Shear, met: &mut M) {
    let triangles = &tree.packets[packet];
    let mut mask = shear.candidates(simd, triangles, met.limit());
    while mask != 0 {
        let lane = (mask.trailing_zeros() & 7) as usize;
        mask &= mask - 1;
        let Some(hit) = shear.resolve(triangles, lane) else { continue };
        let t = hit.t as f32;
        if hit.t > 0.0 && t < met.limit() {
            let id = triangles.ids[lane];
            met.take(Nearest { t, object: id.object, prim: id.prim, instance: NONE, uv: hit.uv });
        }
    }
}
