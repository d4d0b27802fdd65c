//! Builds a tree: pairs by PLOC (Meister and Bittner 2018, crate `obvhs`), then the cheapest 8-wide collapse of the
//! pairs by dynamic programming over the surface area heuristic (Ylitie, Karras and Laine 2017, § 3.1).

use obvhs::{
    aabb::Aabb,
    bvh2::{Bvh2, node::Bvh2Node, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};

use super::{Child, Node, Packet, Primitive, Tree, TriangleId};
use crate::math::{Bounds, Vec3};

/// What goes into a tree.
#[derive(Debug, Clone, Copy)]
pub(in crate::shape) enum Entry {
    Triangle(TriangleId, [Vec3; 3]),
    Other(Primitive, Bounds),
}

impl Entry {
    fn bounds(&self) -> Bounds {
        match *self {
            Self::Triangle(_, vertices) => Bounds::of(vertices),
            Self::Other(_, bounds) => bounds,
        }
    }
}

/// The cost of meeting a node, of a packet of triangles, and of another primitive. Only ratios matter.
const NODE_COST: f32 = 0.75;
const PACKET_COST: f32 = 1.0;
const OTHER_COST: f32 = 0.5;

/// Builds the tree over `entries`.
pub(in crate::shape) fn build(entries: &[Entry]) -> Tree {
    let mut tree = Tree {
        nodes: Vec::new(),
        packets: Vec::new(),
        others: Vec::new(),
        root: None,
        bounds: entries.iter().fold(Bounds::EMPTY, |b, e| b.union(e.bounds())),
    };
    if entries.is_empty() {
        return tree;
    }
    let pairs = build_pairs(entries);
    let plan = Plan::new(&pairs, entries);
    emit(&mut tree, &pairs, &plan, entries);
    tree
}

fn build_pairs(entries: &[Entry]) -> Bvh2 {
    let boxes: Vec<Aabb> = entries
        .iter()
        .map(|e| {
            let b = e.bounds();
            Aabb { min: b.min.into(), max: b.max.into() }
        })
        .collect();
    let indices = (0..entries.len() as u32).collect();
    let mut pairs = PlocBuilder::new().build(PlocSearchDistance::Medium, &boxes, indices, SortPrecision::U64, 0);
    ReinsertionOptimizer::default().run(&mut pairs, 0.5, None);
    pairs
}

/// For each node of the binary tree: the least cost of representing it by `1..=7` children of a wide node, and the
/// decisions that give that cost.
struct Plan {
    steps: Vec<Step>,
}

#[derive(Clone, Copy)]
struct Step {
    /// `cost[i]`: by at most `i + 1` children.
    cost: [f32; 7],
    /// `left[i]`: how many of `i + 2` children go to the left half.
    left: [u8; 7],
    triangles: u32,
    others: u32,
    is_leaf: bool,
}

impl Step {
    const NONE: Self = Self { cost: [0.0; 7], left: [0; 7], triangles: 0, others: 0, is_leaf: true };

    /// The best way to share `children` between two halves: cost, and how many go left.
    fn share(left: &Self, right: &Self, children: usize) -> (f32, u8) {
        (1..children)
            .map(|k| (left.cost[k.min(7) - 1] + right.cost[(children - k).min(7) - 1], k as u8))
            .fold((f32::INFINITY, 1), |best, next| if next.0 < best.0 { next } else { best })
    }

    fn leaf_cost(&self, area: f32) -> f32 {
        if self.others == 0 && self.triangles as usize <= Child::MAX_TRIANGLES {
            area * PACKET_COST * self.triangles.div_ceil(8) as f32
        } else if self.triangles == 0 && self.others as usize <= Child::MAX_OTHERS {
            area * OTHER_COST * self.others as f32
        } else {
            f32::INFINITY
        }
    }
}

impl Plan {
    fn new(pairs: &Bvh2, entries: &[Entry]) -> Self {
        let mut plan = Self { steps: vec![Step::NONE; pairs.nodes.len()] };
        for index in preorder(pairs).into_iter().rev() {
            plan.steps[index] = plan.step(pairs, &pairs.nodes[index], entries);
        }
        plan
    }

    fn step(&self, pairs: &Bvh2, node: &Bvh2Node, entries: &[Entry]) -> Step {
        let area = node.aabb().half_area();
        let mut step = Step::NONE;
        if node.is_leaf() {
            for entry in leaf_entries(pairs, node) {
                match entries[entry] {
                    Entry::Triangle(..) => step.triangles += 1,
                    Entry::Other(..) => step.others += 1,
                }
            }
            step.cost = [step.leaf_cost(area); 7];
            return step;
        }
        let (left, right) = (&self.steps[node.first_index as usize], &self.steps[node.first_index as usize + 1]);
        step.triangles = left.triangles + right.triangles;
        step.others = left.others + right.others;
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

    /// The nodes of the binary tree that become the children of a wide node when `index` is given `budget` of them.
    fn children(&self, pairs: &Bvh2, index: usize, budget: usize, out: &mut Vec<usize>) {
        let left = if budget == 1 || pairs.nodes[index].is_leaf() { 0 } else { self.steps[index].left[budget - 2] };
        if budget == 1 || pairs.nodes[index].is_leaf() {
            out.push(index);
        } else if left == 0 {
            self.children(pairs, index, budget - 1, out);
        } else {
            self.split(pairs, index, budget, out);
        }
    }

    fn split(&self, pairs: &Bvh2, index: usize, budget: usize, out: &mut Vec<usize>) {
        let (first, left) = (pairs.nodes[index].first_index as usize, self.steps[index].left[budget - 2] as usize);
        self.children(pairs, first, left, out);
        self.children(pairs, first + 1, budget - left, out);
    }
}

fn leaf_entries<'a>(pairs: &'a Bvh2, node: &Bvh2Node) -> impl Iterator<Item = usize> + 'a {
    let first = node.first_index as usize;
    pairs.primitive_indices[first..first + node.prim_count as usize].iter().map(|&i| i as usize)
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

fn emit(tree: &mut Tree, pairs: &Bvh2, plan: &Plan, entries: &[Entry]) {
    // (binary node, where its wide twin is to be written down)
    let mut stack: Vec<(usize, Option<(usize, usize)>)> = vec![(0, None)];
    let mut children = Vec::with_capacity(8);
    while let Some((index, parent)) = stack.pop() {
        let child = if plan.steps[index].is_leaf {
            emit_leaf(tree, pairs, index, entries)
        } else {
            let wide = tree.nodes.len();
            tree.nodes.push(Node::EMPTY);
            children.clear();
            plan.split(pairs, index, 8, &mut children);
            for (slot, &child) in children.iter().enumerate() {
                let b = pairs.nodes[child].aabb();
                tree.nodes[wide].set(slot, &Bounds { min: b.min.into(), max: b.max.into() });
                stack.push((child, Some((wide, slot))));
            }
            Child::node(wide)
        };
        match parent {
            None => tree.root = Some(child),
            Some((wide, slot)) => tree.nodes[wide].child[slot] = child,
        }
    }
}

fn emit_leaf(tree: &mut Tree, pairs: &Bvh2, index: usize, entries: &[Entry]) -> Child {
    let (mut triangles, mut others) = (Vec::new(), Vec::new());
    let mut stack = vec![index];
    while let Some(index) = stack.pop() {
        let node = &pairs.nodes[index];
        if !node.is_leaf() {
            stack.extend([node.first_index as usize + 1, node.first_index as usize]);
            continue;
        }
        for entry in leaf_entries(pairs, node) {
            match entries[entry] {
                Entry::Triangle(id, vertices) => triangles.push((id, vertices)),
                Entry::Other(primitive, _) => others.push(primitive),
            }
        }
    }
    if triangles.is_empty() {
        let child = Child::others(tree.others.len(), others.len());
        tree.others.append(&mut others);
        return child;
    }
    let child = Child::packets(tree.packets.len(), triangles.len().div_ceil(8));
    for chunk in triangles.chunks(8) {
        let lane = |i: usize| chunk[i.min(chunk.len() - 1)];
        let vertex = std::array::from_fn(|v| std::array::from_fn(|axis| std::array::from_fn(|i| lane(i).1[v][axis])));
        tree.packets.push(Packet { vertex, ids: std::array::from_fn(|i| lane(i).0) });
    }
    child
}
