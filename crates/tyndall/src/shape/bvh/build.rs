//! Builds a tree: pairs by PLOC (Meister and Bittner 2018) and parallel reinsertion (the same 2017), both of crate
//! `obvhs`, then the cheapest 8-wide collapse ([`super::collapse`]).
//!
//! More than [`WHOLE`] entries are first divided into clusters in space ([`super::divide`]), each small enough for the
//! caches of a processor and built on its own, many at a time; a tree over the clusters joins them. How they are divided
//! depends on the entries alone, so any number of threads builds the same tree. Its cost by the surface area heuristic is
//! 2 to 3 % above that of the whole (a bumpy sphere of 10⁶ triangles).

use obvhs::{
    aabb::Aabb,
    bvh2::{Bvh2, node::Bvh2Node, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, SortPrecision},
};
use rayon::prelude::*;

use super::{
    Bundle, Child, Content, Node, Packet, Primitive, Tree, TriangleId,
    bundle::Sheath,
    collapse::{Leaves, Plan, Step, bounds, leaf_entries},
    divide::divide,
};
use crate::{
    math::{Bounds, Vec3},
    shape::curve::Piece,
};

/// A tree over more entries than this is built in clusters.
const WHOLE: usize = 1 << 18;
/// Entries of a cluster at most: its pairs take up some megabytes.
const CLUSTER: usize = 1 << 15;

/// Shares of half the nodes of a cluster that are inserted anew, pass by pass: half the work of the whole tree's passes, and a
/// cost 0.6 % higher.
const CLUSTER_PASSES: [f32; 5] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 9.0, 1.0 / 17.0];

/// Neighbours along a space-filling curve that are looked at for the best pair.
const SEARCH: usize = 14;

/// What goes into a tree.
#[derive(Debug, Clone, Copy)]
pub(in crate::shape) enum Entry {
    Triangle(TriangleId, [Vec3; 3]),
    /// A piece of a strand of an object.
    Piece(u32, Piece, Sheath),
    Other(Primitive, Bounds),
}

impl Entry {
    pub(super) fn bounds(&self) -> Bounds {
        match *self {
            Self::Triangle(_, vertices) => Bounds::of(vertices),
            Self::Piece(_, _, sheath) => sheath.bounds(),
            Self::Other(_, bounds) => bounds,
        }
    }
}

/// Builds the tree over `entries`.
pub(in crate::shape) fn build(mut entries: Vec<Entry>) -> Tree {
    if entries.len() > WHOLE { build_in_clusters(&mut entries, CLUSTER) } else { build_whole(&entries) }
}

fn build_in_clusters(entries: &mut [Entry], longest: usize) -> Tree {
    join(divide(entries, longest).into_par_iter().map(|entries| Cluster::of(entries, Some(&CLUSTER_PASSES))).collect())
}

fn build_whole(entries: &[Entry]) -> Tree {
    let bounds = entries.iter().fold(Bounds::EMPTY, |all, entry| all.union(entry.bounds()));
    let mut tree = Tree::empty(bounds);
    if !entries.is_empty() {
        let Cluster { pairs, plan, .. } = Cluster::of(entries, None);
        tree.root = Some(plan.emit(&mut tree, &pairs, 0, |tree, leaf| write_leaf(tree, entries, leaf)));
    }
    tree
}

/// Neighbours, and the plan for their tree.
struct Cluster<'a> {
    entries: &'a [Entry],
    pairs: Bvh2,
    plan: Plan,
}

impl<'a> Cluster<'a> {
    fn of(entries: &'a [Entry], passes: Option<&[f32]>) -> Self {
        let pairs = build_pairs(entries.iter().map(Entry::bounds), passes);
        let plan = Plan::new(&pairs, &entries);
        Self { entries, pairs, plan }
    }

    /// The tree below some of the pairs, and where it begins for each of them.
    fn emit(self, below: &[Place]) -> (Tree, Vec<Child>) {
        let mut tree = Tree::empty(Bounds::EMPTY);
        let mut emit = |place: &Place| {
            self.plan.emit(&mut tree, &self.pairs, place.pair, |t, leaf| write_leaf(t, self.entries, leaf))
        };
        let roots = below.iter().map(&mut emit).collect();
        (tree, roots)
    }
}

/// Where a part of a cluster hangs in the tree above.
struct Place {
    pair: usize,
    wide: usize,
    slot: usize,
}

/// One tree over all clusters. The plan for the nodes above them goes on into the clusters, whose uppermost pairs it may
/// open: so a cluster's root need not be a node.
fn join(clusters: Vec<Cluster>) -> Tree {
    let pairs = build_pairs(clusters.iter().map(|cluster| bounds(&cluster.pairs.nodes[0])), None);
    let mut tree = Tree::empty(bounds(&pairs.nodes[0]));
    let places = emit_above(&mut tree, &pairs, &clusters);
    let below: Vec<(Tree, Vec<Child>)> =
        clusters.into_par_iter().zip(&places).map(|(cluster, places)| cluster.emit(places)).collect();
    tree.nodes.reserve_exact(below.iter().map(|(tree, _)| tree.nodes.len()).sum());
    tree.packets.reserve_exact(below.iter().map(|(tree, _)| tree.packets.len()).sum());
    tree.bundles.reserve_exact(below.iter().map(|(tree, _)| tree.bundles.len()).sum());
    tree.others.reserve_exact(below.iter().map(|(tree, _)| tree.others.len()).sum());
    for ((part, roots), places) in below.into_iter().zip(places) {
        let roots = tree.take(&part, &roots);
        for (root, Place { wide, slot, .. }) in roots.into_iter().zip(places) {
            tree.nodes[wide].child[slot] = root;
        }
    }
    tree
}

/// Writes the nodes above the clusters; returns what of each of them hangs where.
fn emit_above(tree: &mut Tree, pairs: &Bvh2, clusters: &[Cluster]) -> Vec<Vec<Place>> {
    let plan = Plan::new(pairs, &clusters);
    let mut places: Vec<Vec<Place>> = clusters.iter().map(|_| Vec::new()).collect();
    let mut stack = vec![(0, None)];
    let (mut children, mut opened) = (Vec::with_capacity(8), Vec::with_capacity(8));
    while let Some((index, parent)) = stack.pop() {
        let wide = tree.nodes.len();
        tree.nodes.push(Node::EMPTY);
        children.clear();
        plan.children(pairs, index, 8, &mut children);
        let mut slot = 0;
        for &(child, budget) in &children {
            let node = &pairs.nodes[child];
            if !node.is_leaf() {
                tree.nodes[wide].set(slot, &bounds(node));
                stack.push((child, Some((wide, slot))));
                slot += 1;
            }
            for i in leaf_entries(pairs, node) {
                let Cluster { pairs, plan, .. } = &clusters[i];
                opened.clear();
                plan.children(pairs, 0, budget, &mut opened);
                for &(pair, _) in &opened {
                    tree.nodes[wide].set(slot, &bounds(&pairs.nodes[pair]));
                    places[i].push(Place { pair, wide, slot });
                    slot += 1;
                }
            }
        }
        let child = Child::node(wide);
        match parent {
            None => tree.root = Some(child),
            Some((wide, slot)) => tree.nodes[wide].child[slot] = child,
        }
    }
    places
}

/// Pairs of boxes, improved by passes of reinsertion, by default those of `obvhs`.
fn build_pairs(boxes: impl ExactSizeIterator<Item = Bounds>, passes: Option<&[f32]>) -> Bvh2 {
    let mut pairs = Bvh2::zeroed(boxes.len());
    pairs.primitive_indices = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::new();
    let mut all = Bounds::EMPTY;
    builder.current_nodes.extend((0..).zip(boxes).map(|(i, b)| {
        all = all.union(b);
        Bvh2Node::new(Aabb { min: b.min.into(), max: b.max.into() }, 1, i)
    }));
    // In a cube: in the box itself the curve would cross a thin sheet up and down as often as along.
    let cube = Bounds { min: all.min, max: all.min + all.extent().max_element() };
    let cube = Aabb { min: cube.min.into(), max: cube.max.into() };
    builder.build_ploc_from_leaves::<SEARCH, false>(&mut pairs, cube, SortPrecision::U64, 0);
    drop(builder);
    if !is_heap(&pairs) {
        ReinsertionOptimizer::default().run(&mut pairs, 0.5, passes.map(<[f32]>::to_vec));
    }
    pairs
}

/// Whether there are many boxes that nearly all overlap: for each of them reinsertion would look at all others.
fn is_heap(pairs: &Bvh2) -> bool {
    let (root, count) = (pairs.nodes[0].aabb().half_area(), pairs.primitive_indices.len());
    let sum: f32 = pairs.nodes.iter().filter(|node| !node.is_leaf()).map(|node| node.aabb().half_area()).sum();
    count > 4096 && sum >= 0.25 * count as f32 * root
}

impl Tree {
    /// Nothing yet, for what is inside of these bounds.
    fn empty(bounds: Bounds) -> Self {
        Self { nodes: Vec::new(), packets: Vec::new(), bundles: Vec::new(), others: Vec::new(), root: None, bounds }
    }

    /// Copies another tree to the end of this one; says what its roots are here.
    fn take(&mut self, other: &Self, roots: &[Child]) -> Vec<Child> {
        let (nodes, packets) = (self.nodes.len(), self.packets.len());
        let (bundles, others) = (self.bundles.len(), self.others.len());
        let moved = |child: Child| match child.content() {
            Content::Node(index) => Child::node(nodes + index),
            Content::Packets { first, count } => Child::packets(packets + first, count),
            Content::Bundles { first, count } => Child::bundles(bundles + first, count),
            Content::Others { first, count } => Child::others(others + first, count),
        };
        self.nodes.extend(other.nodes.iter().map(|node| Node { child: node.child.map(moved), ..*node }));
        self.packets.extend_from_slice(&other.packets);
        self.bundles.extend_from_slice(&other.bundles);
        self.others.extend_from_slice(&other.others);
        roots.iter().map(|&root| moved(root)).collect()
    }
}

impl Leaves for &[Entry] {
    fn step(&self, entries: impl Iterator<Item = usize>, area: f32) -> Step {
        let counts = entries.fold([0; 3], |[triangles, pieces, others], entry| match self[entry] {
            Entry::Triangle(..) => [triangles + 1, pieces, others],
            Entry::Piece(..) => [triangles, pieces + 1, others],
            Entry::Other(..) => [triangles, pieces, others + 1],
        });
        Step::leaf(counts, area)
    }
}

impl Leaves for &[Cluster<'_>] {
    fn step(&self, mut entries: impl Iterator<Item = usize>, area: f32) -> Step {
        entries.next().map_or(Step::leaf([0; 3], area), |cluster| self[cluster].plan.whole())
    }
}

/// Writes the entries of a leaf, which are all triangles, all pieces of strands, or all something else.
fn write_leaf(tree: &mut Tree, entries: &[Entry], leaf: &[usize]) -> Child {
    let first = tree.others.len();
    let (mut triangles, mut pieces) = (Vec::with_capacity(leaf.len()), Vec::new());
    for &entry in leaf {
        match entries[entry] {
            Entry::Triangle(id, vertices) => triangles.push((id, vertices)),
            Entry::Piece(object, piece, sheath) => pieces.push((object, piece, sheath)),
            Entry::Other(primitive, _) => tree.others.push(primitive),
        }
    }
    if !triangles.is_empty() {
        write_packets(tree, &triangles)
    } else if !pieces.is_empty() {
        let child = Child::bundles(tree.bundles.len(), pieces.len().div_ceil(8));
        tree.bundles.extend(pieces.chunks(8).map(Bundle::new));
        child
    } else {
        Child::others(first, leaf.len())
    }
}

fn write_packets(tree: &mut Tree, triangles: &[(TriangleId, [Vec3; 3])]) -> Child {
    let child = Child::packets(tree.packets.len(), triangles.len().div_ceil(8));
    for chunk in triangles.chunks(8) {
        let lane = |i: usize| chunk[i.min(chunk.len() - 1)];
        let vertex = std::array::from_fn(|v| std::array::from_fn(|axis| std::array::from_fn(|i| lane(i).1[v][axis])));
        let filled = 0xff >> (8 - chunk.len());
        tree.packets.push(Packet { vertex, ids: std::array::from_fn(|i| lane(i).0), filled });
    }
    child
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of small triangles, some of them far away.
    fn sheet() -> Vec<Entry> {
        let corner = |i: u32, j: u32| Vec3::new(i as f32, j as f32, ((i * 7 + j * 13) % 5) as f32 * 0.1);
        let far = |i: u32| if i.is_multiple_of(97) { 1e4 } else { 0.0 };
        (0..6000u32)
            .map(|prim| {
                let (i, j) = (prim % 80, prim / 80);
                let vertices = [corner(i, j), corner(i + 1, j), corner(i, j + 1)].map(|p| p + Vec3::Z * far(prim));
                Entry::Triangle(TriangleId { object: 0, prim }, vertices)
            })
            .collect()
    }

    /// Every box of the tree holds what is below it; the triangles that are met, in order.
    fn triangles_below(tree: &Tree, child: Child, within: &[[f32; 2]; 3], found: &mut Vec<u32>) {
        match child.content() {
            Content::Node(index) => {
                let node = &tree.nodes[index];
                for slot in (0..8).filter(|&slot| node.planes[0][slot] <= node.planes[1][slot]) {
                    let side = |axis: usize| [node.planes[2 * axis][slot], node.planes[2 * axis + 1][slot]];
                    triangles_below(tree, node.child[slot], &[side(0), side(1), side(2)], found);
                }
            }
            Content::Packets { first, count } => {
                for packet in &tree.packets[first..first + count] {
                    found.extend(packet.filled().map(|lane| packet.ids[lane].prim));
                    for (vertex, axis) in (0..9).map(|i| (i / 3, i % 3)) {
                        let [least, greatest] = within[axis];
                        assert!(packet.vertex[vertex][axis].iter().all(|x| (least..=greatest).contains(x)));
                    }
                }
            }
            Content::Bundles { .. } | Content::Others { .. } => panic!("there are only triangles"),
        }
    }

    /// Clusters of 100 make a tree that holds each triangle once, in boxes that hold it, like the tree of one cluster.
    #[test]
    fn a_tree_over_clusters_holds_every_triangle_once() {
        for longest in [100, 1000, 5000] {
            let tree = build_in_clusters(&mut sheet(), longest);
            let mut found = Vec::new();
            let everywhere = [[f32::NEG_INFINITY, f32::INFINITY]; 3];
            triangles_below(&tree, tree.root.unwrap(), &everywhere, &mut found);
            found.sort_unstable();
            assert_eq!(found, (0..6000).collect::<Vec<_>>(), "clusters of {longest}");
        }
    }

    /// What cannot be divided makes one cluster, however large.
    #[test]
    fn triangles_at_one_point_make_a_tree_too() {
        let mut entries = sheet();
        let first = entries[0];
        for (prim, entry) in (0..).zip(&mut entries) {
            if let (Entry::Triangle(_, vertices), Entry::Triangle(id, own)) = (first, entry) {
                (*id, *own) = (TriangleId { object: 0, prim }, vertices);
            }
        }
        let tree = build_in_clusters(&mut entries, 100);
        let mut found = Vec::new();
        triangles_below(&tree, tree.root.unwrap(), &[[f32::NEG_INFINITY, f32::INFINITY]; 3], &mut found);
        found.sort_unstable();
        assert_eq!(found, (0..6000).collect::<Vec<_>>());
    }

    /// One thread and four build the same tree.
    #[test]
    fn the_tree_does_not_depend_on_the_number_of_threads() {
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| build_in_clusters(&mut sheet(), 100))
        };
        let [one, four] = [1, 4].map(build);
        let bits = |tree: &Tree| format!("{:?} {:?} {:?}", tree.nodes, tree.packets, tree.root);
        assert!(bits(&one) == bits(&four));
    }
}
