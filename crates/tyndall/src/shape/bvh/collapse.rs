//! From pairs to nodes of eight: the cheapest collapse, by dynamic programming over the surface area heuristic
//! (Ylitie, Karras and Laine 2017, § 3.1).

use obvhs::bvh2::{Bvh2, node::Bvh2Node};

use super::{Child, Node, Tree};
use crate::math::Bounds;

/// The cost of meeting a node, of a packet of triangles, of a bundle of strands, and of another primitive. Only ratios matter.
const NODE_COST: f32 = 0.75;
const PACKET_COST: f32 = 1.0;
const BUNDLE_COST: f32 = 1.0;
const OTHER_COST: f32 = 0.5;

/// What the leaves of a binary tree hold, by the number of their entry.
pub(super) trait Leaves {
    /// What the plan has to know of a leaf whose box has this area.
    fn step(&self, entries: impl Iterator<Item = usize>, area: f32) -> Step;
}

/// For each node of the binary tree: the least cost of representing it by `1..=7` children of a wide node, and the
/// decisions that give that cost.
#[derive(Debug)]
pub(super) struct Plan {
    steps: Vec<Step>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// `cost[i]`: by at most `i + 1` children.
    cost: [f32; 7],
    /// `left[i]`: how many of `i + 2` children go to the left half.
    left: [u8; 7],
    /// Triangles, pieces of strands, and other primitives.
    counts: [u32; 3],
    is_leaf: bool,
}

impl Step {
    const NONE: Self = Self { cost: [0.0; 7], left: [0; 7], counts: [0; 3], is_leaf: true };

    /// A leaf of so many triangles, pieces of strands, or other primitives.
    pub(super) fn leaf(counts: [u32; 3], area: f32) -> Self {
        let leaf = Self { counts, ..Self::NONE };
        Self { cost: [leaf.leaf_cost(area); 7], ..leaf }
    }

    /// The best way to share `children` between two halves: cost, and how many go left.
    fn share(left: &Self, right: &Self, children: usize) -> (f32, u8) {
        (1..children)
            .map(|k| (left.cost[k.min(7) - 1] + right.cost[(children - k).min(7) - 1], k as u8))
            .fold((f32::INFINITY, 1), |best, next| if next.0 < best.0 { next } else { best })
    }

    fn leaf_cost(&self, area: f32) -> f32 {
        match self.counts {
            [triangles, 0, 0] if triangles as usize <= Child::MAX_TRIANGLES => {
                area * PACKET_COST * triangles.div_ceil(8) as f32
            }
            [0, pieces, 0] if pieces as usize <= Child::MAX_PIECES => area * BUNDLE_COST * pieces.div_ceil(8) as f32,
            [0, 0, others] if others as usize <= Child::MAX_OTHERS => area * OTHER_COST * others as f32,
            _ => f32::INFINITY,
        }
    }
}

impl Plan {
    pub(super) fn new(pairs: &Bvh2, leaves: &impl Leaves) -> Self {
        let mut plan = Self { steps: vec![Step::NONE; pairs.nodes.len()] };
        for index in preorder(pairs).into_iter().rev() {
            plan.steps[index] = plan.step(pairs, &pairs.nodes[index], leaves);
        }
        plan
    }

    fn step(&self, pairs: &Bvh2, node: &Bvh2Node, leaves: &impl Leaves) -> Step {
        let area = node.aabb().half_area();
        if node.is_leaf() {
            return leaves.step(leaf_entries(pairs, node), area);
        }
        let mut step = Step::NONE;
        let (left, right) = (&self.steps[node.first_index as usize], &self.steps[node.first_index as usize + 1]);
        step.counts = [0, 1, 2].map(|kind| left.counts[kind] + right.counts[kind]);
        for children in 2..=8 {
            let (cost, k) = Step::share(left, right, children);
            step.left[children - 2] = k;
            if children <= 7 {
                step.cost[children - 1] = cost;
            } else {
                let (as_leaf, as_node) = (step.leaf_cost(area), cost + area * NODE_COST);
                step.is_leaf = as_leaf <= as_node;
                step.cost[0] = as_leaf.min(as_node);
            }
        }
        for i in 1..7 {
            if step.cost[i - 1] <= step.cost[i] {
                step.cost[i] = step.cost[i - 1];
                step.left[i - 1] = 0; // fewer children do better
            }
        }
        step
    }

    /// The step of the root as a leaf of the plan for a tree above, where it shares a leaf with nobody.
    pub(super) fn whole(&self) -> Step {
        Step { counts: [1; 3], ..self.steps[0] }
    }

    /// The nodes of the binary tree that become the children of a wide node when `index` is given `budget` of them.
    /// Leaves say what was left for them, the others are one child each.
    pub(super) fn children(&self, pairs: &Bvh2, index: usize, budget: usize, out: &mut Vec<(usize, usize)>) {
        if budget == 1 || pairs.nodes[index].is_leaf() {
            out.push((index, budget));
        } else if self.steps[index].left[budget - 2] == 0 {
            self.children(pairs, index, budget - 1, out);
        } else {
            self.split(pairs, index, budget, out);
        }
    }

    pub(super) fn split(&self, pairs: &Bvh2, index: usize, budget: usize, out: &mut Vec<(usize, usize)>) {
        let (first, left) = (pairs.nodes[index].first_index as usize, self.steps[index].left[budget - 2] as usize);
        self.children(pairs, first, left, out);
        self.children(pairs, first + 1, budget - left, out);
    }

    /// Writes what is below a node of the binary tree to the end of `tree`, a leaf by `write`; returns its root.
    pub(super) fn emit(
        &self,
        tree: &mut Tree,
        pairs: &Bvh2,
        top: usize,
        mut write: impl FnMut(&mut Tree, &[usize]) -> Child,
    ) -> Child {
        let mut root = Child::node(0);
        // (binary node, where its wide twin is to be written down)
        let mut stack: Vec<(usize, Option<(usize, usize)>)> = vec![(top, None)];
        let mut children = Vec::with_capacity(8);
        let mut entries = Vec::with_capacity(16);
        while let Some((index, parent)) = stack.pop() {
            let child = if self.steps[index].is_leaf {
                gather(pairs, index, &mut entries);
                write(tree, &entries)
            } else {
                let wide = tree.nodes.len();
                tree.nodes.push(Node::EMPTY);
                children.clear();
                self.split(pairs, index, 8, &mut children);
                for (slot, &(child, _)) in children.iter().enumerate() {
                    tree.nodes[wide].set(slot, &bounds(&pairs.nodes[child]));
                    stack.push((child, Some((wide, slot))));
                }
                Child::node(wide)
            };
            match parent {
                None => root = child,
                Some((wide, slot)) => tree.nodes[wide].child[slot] = child,
            }
        }
        root
    }
}

/// The box of a node of a binary tree.
pub(super) fn bounds(node: &Bvh2Node) -> Bounds {
    let b = node.aabb();
    Bounds { min: b.min.into(), max: b.max.into() }
}

/// The entries of a node of a binary tree, none if it is not a leaf.
pub(super) fn leaf_entries<'a>(pairs: &'a Bvh2, node: &Bvh2Node) -> impl Iterator<Item = usize> + 'a {
    let (first, count) = if node.is_leaf() { (node.first_index, node.prim_count) } else { (0, 0) };
    pairs.primitive_indices[first as usize..(first + count) as usize].iter().map(|&i| i as usize)
}

/// All nodes, parents before children.
fn preorder(pairs: &Bvh2) -> Vec<usize> {
    let mut order = Vec::with_capacity(pairs.nodes.len());
    let mut stack = vec![0];
    while let Some(index) = stack.pop() {
        order.push(index);
        let node = &pairs.nodes[index];
        if !node.is_leaf() {
            stack.extend([node.first_index as usize + 1, node.first_index as usize]);
        }
    }
    order
}

/// All entries below a node of the binary tree.
fn gather(pairs: &Bvh2, index: usize, entries: &mut Vec<usize>) {
    entries.clear();
    let mut stack = vec![index];
    while let Some(index) = stack.pop() {
        let node = &pairs.nodes[index];
        if node.is_leaf() {
            entries.extend(leaf_entries(pairs, node));
        } else {
            stack.extend([node.first_index as usize + 1, node.first_index as usize]);
        }
    }
}
