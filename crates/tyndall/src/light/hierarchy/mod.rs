//! One of many lights, in proportion to a bound on what it can do at a point, found in a tree.
//!
//! Conty Estevez and Kulla 2018; Pharr et al. 2023, § 12.6.3. Eight children a node: each is weighed by
//! `I · cos θ' · cos θ_i' / max(d², r²)`, where `I` is its intensity, `d` the distance to the middle of its bounding
//! sphere of radius `r`, `θ'` the least angle at which any of its points can be seen from its normal, and `θ_i'` the
//! least angle of incidence on the surface that is lit. A child is passed over only if it certainly gives no light there.
//!
//! Lights that are infinitely far away stand beside the tree: what they do is the same everywhere.

mod build;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8};

use super::{Light, LightId, Reference, bounds::LightBounds};
use crate::{
    math::Vec3,
    sampling::{discrete::Discrete, rng::mix64},
};

const WIDTH: usize = 8;
/// Rounding of cosines: less than this below the horizon may be above it.
const SLACK: f32 = 1e-3;
/// No cosine counts less.
const LEAST_COSINE: f32 = 1e-2;
/// The least share of the lights at infinity, and of all others, where there are both: neither is known well.
const LEAST_SHARE: f64 = 0.125;

/// Eight groups of lights, side by side so that they are weighed together.
#[derive(Debug, Clone)]
struct Node {
    centre: [[f32; WIDTH]; 3],
    axis: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    cos_o: [f32; WIDTH],
    sin_o: [f32; WIDTH],
    cos_e: [f32; WIDTH],
    /// 0 where the place is empty.
    intensity: [f32; WIDTH],
    /// 1 if the back shines too, else 0.
    two_sided: [f32; WIDTH],
    child: [Child; WIDTH],
    parent: Option<Place>,
}

#[derive(Debug, Clone, Copy)]
enum Child {
    Node(u32),
    Light(LightId),
}

/// Where a child of a node is.
#[derive(Debug, Clone, Copy)]
struct Place {
    node: u32,
    slot: u32,
}

/// Where a light is.
#[derive(Debug, Clone, Copy)]
enum Home {
    Tree(Place),
    Infinity(u32),
}

/// Lights that are the same everywhere.
#[derive(Debug, Clone)]
struct Infinite {
    lights: Vec<LightId>,
    shares: Discrete,
    /// What they do together [W·m⁻²].
    total: f64,
}

/// A tree over lights, and those at infinity beside it.
#[derive(Debug, Clone)]
pub(super) struct Hierarchy {
    /// The root first.
    nodes: Vec<Node>,
    infinite: Option<Infinite>,
    /// By light.
    homes: Vec<Home>,
    level: Level,
}

impl Hierarchy {
    /// A tree over all of `lights`.
    pub(super) fn new(lights: &[Light]) -> Self {
        let mut homes = vec![Home::Infinity(0); lights.len()];
        let mut leaves = Vec::new();
        let mut infinite = Vec::new();
        for (index, light) in lights.iter().enumerate() {
            let id = LightId(index as u32);
            if let Some(bounds) = LightBounds::of(light) {
                leaves.push((bounds, id));
            } else {
                homes[index] = Home::Infinity(infinite.len() as u32);
                infinite.push(id);
            }
        }
        // A colour may shine without luminance: everyone keeps a share of the mean.
        let mean = leaves.iter().map(|(b, _)| f64::from(b.intensity)).sum::<f64>() / leaves.len().max(1) as f64;
        let least = ((1e-6 * mean) as f32).max(f32::MIN_POSITIVE);
        for (bounds, _) in &mut leaves {
            bounds.intensity = bounds.intensity.max(least);
        }
        let mut tree = Self { nodes: Vec::new(), infinite: Infinite::of(infinite, lights), homes, level: Level::new() };
        tree.build(&mut leaves);
        tree
    }

    /// A light to sample from `from`, with its probability.
    pub(super) fn choose(&self, from: &Reference, u: f32) -> Option<(LightId, f32)> {
        let mut u = with_more_bits(u, from.p);
        let mut weights = self.root_weights(from);
        let near = self.share_of_tree(&weights);
        if u >= near {
            let infinite = self.infinite.as_ref()?;
            let (index, share, _) = infinite.shares.sample(((u - near) / (1.0 - near)) as f32);
            return Some((infinite.lights[index], (1.0 - near) as f32 * share));
        }
        u /= near;
        let (mut node, mut probability) = (self.nodes.first()?, near);
        loop {
            let (slot, share) = pick(&weights, &mut u)?;
            probability *= share;
            match node.child[slot] {
                Child::Light(id) => return Some((id, probability as f32)),
                Child::Node(next) => node = &self.nodes[next as usize],
            }
            weights = self.weights(node, from);
        }
    }

    /// The probability with which [`Self::choose`] takes `id`.
    pub(super) fn probability(&self, from: &Reference, id: LightId) -> f32 {
        let mut place = match self.homes[id.0 as usize] {
            Home::Tree(place) => place,
            Home::Infinity(index) => {
                let weights = self.root_weights(from);
                let share = self.infinite.as_ref().map_or(0.0, |infinite| infinite.shares.pmf(index as usize));
                return (1.0 - self.share_of_tree(&weights)) as f32 * share;
            }
        };
        let mut probability = 1.0;
        loop {
            let node = &self.nodes[place.node as usize];
            let weights = self.weights(node, from);
            let total = sum(&weights);
            if total <= 0.0 {
                return 0.0;
            }
            probability *= f64::from(weights[place.slot as usize]) / total;
            match node.parent {
                Some(parent) => place = parent,
                None => return (probability * self.share_of_tree(&weights)) as f32,
            }
        }
    }

    #[inline]
    fn weights(&self, node: &Node, from: &Reference) -> [f32; WIDTH] {
        dispatch!(self.level, simd => node.weigh(simd, from))
    }

    fn root_weights(&self, from: &Reference) -> [f32; WIDTH] {
        self.nodes.first().map_or([0.0; WIDTH], |root| self.weights(root, from))
    }

    /// How often a light of the tree is taken, from the weights at the root.
    fn share_of_tree(&self, root: &[f32; WIDTH]) -> f64 {
        let near = sum(root);
        match &self.infinite {
            None => 1.0,
            Some(_) if near <= 0.0 => 0.0,
            Some(infinite) => (near / (near + infinite.total)).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE),
        }
    }
}

impl Infinite {
    fn of(ids: Vec<LightId>, lights: &[Light]) -> Option<Self> {
        let weights: Vec<f64> = ids.iter().map(|id| f64::from(lights[id.0 as usize].importance_at_large())).collect();
        let total: f64 = weights.iter().sum();
        // A colour may shine without luminance: everyone keeps a share of the mean.
        let least = 1e-6 * total / weights.len().max(1) as f64 + f64::MIN_POSITIVE;
        let shares = Discrete::from_f64(weights.iter().map(|w| w + least))?;
        Some(Self { lights: ids, shares, total })
    }
}

impl Node {
    fn empty(parent: Option<Place>) -> Self {
        const ZERO: [f32; WIDTH] = [0.0; WIDTH];
        Self {
            centre: [ZERO; 3],
            axis: [ZERO; 3],
            radius: ZERO,
            cos_o: ZERO,
            sin_o: ZERO,
            cos_e: ZERO,
            intensity: ZERO,
            two_sided: ZERO,
            child: [Child::Node(0); WIDTH],
            parent,
        }
    }

    fn set(&mut self, slot: usize, group: &LightBounds) {
        let centre = group.bounds.centre();
        for axis in 0..3 {
            self.centre[axis][slot] = centre[axis];
            self.axis[axis][slot] = group.axis[axis];
        }
        // The differences of coordinates are rounded where they are taken.
        self.radius[slot] = 0.500_01 * group.bounds.extent().length() + 1e-6 * centre.abs().max_element();
        (self.sin_o[slot], self.cos_o[slot]) = group.theta_o.sin_cos();
        self.cos_e[slot] = group.theta_e.cos();
        self.intensity[slot] = group.intensity;
        self.two_sided[slot] = f32::from(u8::from(group.two_sided));
    }

    /// Bounds on what the children do at a point: see the head of this file. Only operations that are rounded alike on
    /// every machine.
    #[inline(always)]
    fn weigh<S: Simd>(&self, simd: S, from: &Reference) -> [f32; WIDTH] {
        let lanes = |values: &[f32; WIDTH]| f32x8::simd_from(simd, *values);
        let all = |value: f32| f32x8::splat(simd, value);
        let (zero, one, least) = (all(0.0), all(1.0), all(f32::MIN_POSITIVE));
        let unit = |cos: f32x8<S>| cos.max(all(-1.0)).min(one);
        let sine = |cos: f32x8<S>| (one - cos * cos).max(zero).sqrt();
        let x = lanes(&self.centre[0]) - all(from.p.x);
        let y = lanes(&self.centre[1]) - all(from.p.y);
        let z = lanes(&self.centre[2]) - all(from.p.z);
        let (radius, d2) = (lanes(&self.radius), x * x + y * y + z * z);
        let r2 = radius * radius;
        let inside = d2.simd_le(r2);
        let by_d = one / d2.max(least).sqrt();
        let sin_b = (radius * by_d).min(one);
        let b = (sine(sin_b), sin_b);
        let [ax, ay, az] = &self.axis;
        let along = zero - (lanes(ax) * x + lanes(ay) * y + lanes(az) * z) * by_d;
        let cos_w = unit(lanes(&self.two_sided).simd_gt(zero).select(along.max(zero - along), along));
        let out = less(simd, (cos_w, sine(cos_w)), (lanes(&self.cos_o), lanes(&self.sin_o)));
        let leaves = inside.select(one, less(simd, out, b).0);
        let arrives = from.normal.map_or(one, |n| {
            let cos_n = unit((all(n.x) * x + all(n.y) * y + all(n.z) * z) * by_d);
            inside.select(one, less(simd, (cos_n, sine(cos_n)), b).0)
        });
        let intensity = lanes(&self.intensity);
        let cosines = leaves.max(all(LEAST_COSINE)) * arrives.max(all(LEAST_COSINE));
        // Never infinite at a light, and never nothing where a light is merely far.
        let weight = (intensity * cosines / d2.max(r2).max(least)).max(least).min(all(1e30));
        let shines = leaves.simd_ge(lanes(&self.cos_e) - all(SLACK)) & arrives.simd_ge(all(-SLACK));
        (shines & intensity.simd_gt(zero)).select(weight, zero).into()
    }
}

/// Cosine and sine of `max(a − b, 0)`, of angles in [0, π] given by theirs.
#[inline(always)]
fn less<S: Simd>(simd: S, a: Angle<S>, b: Angle<S>) -> Angle<S> {
    let within = a.0.simd_gt(b.0);
    let (cos, sin) = (a.0 * b.0 + a.1 * b.1, a.1 * b.0 - a.0 * b.1);
    (within.select(f32x8::splat(simd, 1.0), cos), within.select(f32x8::splat(simd, 0.0), sin))
}

/// Cosine and sine.
type Angle<S> = (f32x8<S>, f32x8<S>);

fn sum(weights: &[f32; WIDTH]) -> f64 {
    weights.iter().map(|w| f64::from(*w)).sum()
}

/// A place in proportion to its weight, and its share; what is left of `u` is again uniform.
#[inline]
fn pick(weights: &[f32; WIDTH], u: &mut f64) -> Option<(usize, f64)> {
    let total = sum(weights);
    let mut rest = *u * total;
    let mut found = None;
    for (slot, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        let weight = f64::from(*weight);
        found = Some((slot, weight, rest));
        if rest < weight {
            break;
        }
        rest -= weight;
    }
    let (slot, weight, rest) = found?;
    *u = (rest / weight).clamp(0.0, 1.0 - f64::EPSILON);
    Some((slot, weight / total))
}

/// The 24 bits of `u` would run out in a tree of millions: the place decides the next 29, which are as good as random
/// over all the places of a render.
fn with_more_bits(u: f32, p: Vec3) -> f64 {
    let word = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    let bits = mix64(mix64(word(p.x, p.y)) ^ word(p.z, u)) >> 35;
    (f64::from(u) + bits as f64 * (-53f64).exp2()).min(1.0 - f64::EPSILON)
}
