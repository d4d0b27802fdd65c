//! Convex places in which flights are free: what begins and ends in one meets nothing on the way, if no surface cuts it.
//!
//! A [`Ball`] is found around any point by its clearance. A [`Block`] is what a body with six flat faces has inside: it ends only
//! where the body does, and nothing is to be looked for.

use super::Mesh;
use crate::math::{Bounds, Vec3, rounding::gamma};

/// A ball or a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Room {
    /// A ball.
    Ball(Ball),
    /// A block.
    Block(Block),
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre [length].
    pub centre: Vec3,
    /// Its radius, 0 for none [length].
    pub radius: f32,
}

/// What is between three pairs of parallel planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Its centre [length].
    pub centre: Vec3,
    /// The normals of the planes, which need not be at right angles \[1\].
    pub axes: [Vec3; 3],
    /// How far they are from the centre [length].
    pub half: [f32; 3],
}

impl Room {
    /// None.
    pub const NONE: Self = Self::Ball(Ball::NONE);

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        match self {
            Self::Ball(ball) => ball.depth(p),
            Self::Block(block) => block.depth(p),
        }
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        match self {
            Self::Ball(ball) => ball.reach(p, dir),
            Self::Block(block) => block.reach(p, dir),
        }
    }

    /// If it is a block.
    pub fn block(&self) -> Option<Block> {
        if let Self::Block(block) = self { Some(*block) } else { None }
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Ball(Ball { centre, radius }) => Bounds { min: *centre - *radius, max: *centre + *radius },
            Self::Block(block) => Bounds::of(block.corners()),
        }
    }
}

impl Ball {
    /// None.
    pub const NONE: Self = Self { centre: Vec3::ZERO, radius: 0.0 };

    /// Within so large a clearance of `centre`: smaller by what rounding can do to a point within it.
    #[inline]
    pub fn within(centre: Vec3, clearance: f32) -> Self {
        Self { centre, radius: (clearance - margin(centre, clearance)).max(0.0) }
    }

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        let from = p - self.centre;
        self.radius - (from.x * from.x + from.y * from.y + from.z * from.z).sqrt()
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        let from = p - self.centre;
        let (along, beyond) = (from.dot(dir), self.radius * self.radius - from.length_squared());
        if beyond > 0.0 { (along * along + beyond).sqrt() - along } else { 0.0 }
    }
}

/// Corners of a block.
const CORNERS: usize = 8;
/// Triangles of its surface.
const FACES: usize = 12;

impl Block {
    /// What a closed mesh encloses, if that is a block whose corners are all the vertices that it has: smaller by what rounding can
    /// do to a point within.
    pub fn inside(mesh: &Mesh) -> Option<Self> {
        if mesh.indices.len() != FACES {
            return None;
        }
        let faces: Vec<_> = (0..FACES as u32).map(|prim| mesh.triangle(prim)).collect();
        let axes = axes(&faces)?;
        let bounds = Bounds::of(faces.iter().flatten().copied());
        let centre = bounds.centre();
        let height = |axis: Vec3, p: Vec3| axis.dot(p - centre);
        // On which side of the centre a corner is, and how near the nearest of the planes through each face's corners.
        let is_above = |p: Vec3| axes.map(|axis| height(axis, p) > 0.0);
        let half = axes.map(|axis| {
            let corners = faces.iter().flatten().map(|p| height(axis, *p).abs());
            corners.fold(f32::INFINITY, f32::min)
        });
        let is_face = |face: &[Vec3; 3]| {
            let [a, b, c] = face.map(is_above);
            (0..3).any(|axis| a[axis] == b[axis] && b[axis] == c[axis])
        };
        let name = |p: &Vec3| (is_above(*p), (*p + Vec3::ZERO).to_array().map(f32::to_bits)); // of -0 as well as of 0
        let mut corners: Vec<_> = faces.iter().flatten().map(name).collect();
        corners.sort_unstable();
        corners.dedup();
        let is_whole = corners.len() == CORNERS && corners.windows(2).all(|two| two[0].0 != two[1].0);
        let margin = margin(centre, bounds.extent().length());
        let block = Self { centre, axes, half: half.map(|half| half - margin) };
        (is_whole && faces.iter().all(is_face) && block.half.iter().all(|half| *half > 0.0)).then_some(block)
    }

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        let from = p - self.centre;
        let depth = |axis: Vec3, half: f32| half - (axis.x * from.x + axis.y * from.y + axis.z * from.z).abs();
        let ([a, b, c], [u, v, w]) = (self.axes, self.half);
        depth(a, u).min(depth(b, v)).min(depth(c, w))
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        let from = p - self.centre;
        let mut reach = f32::INFINITY;
        for (axis, half) in self.axes.iter().zip(self.half) {
            let (height, along) = (axis.dot(from), axis.dot(dir));
            if height.abs() >= half {
                return 0.0;
            }
            if along != 0.0 {
                reach = reach.min((half - height * along.signum()) / along.abs());
            }
        }
        reach
    }

    fn corners(&self) -> impl Iterator<Item = Vec3> {
        // Where three planes meet: by the reciprocal basis of their normals.
        let [a, b, c] = self.axes;
        let volume = a.dot(b.cross(c));
        let edges = [b.cross(c), c.cross(a), a.cross(b)].map(|edge| edge / volume);
        (0..CORNERS).map(move |corner| {
            let side = |i: usize| if corner >> i & 1 == 0 { -self.half[i] } else { self.half[i] };
            self.centre + edges[0] * side(0) + edges[1] * side(1) + edges[2] * side(2)
        })
    }
}

/// The three directions, and no more, that the normals of faces have.
fn axes(faces: &[[Vec3; 3]]) -> Option<[Vec3; 3]> {
    const PARALLEL: f64 = 1.0 - 1e-6;
    let mut axes = Vec::new();
    for face in faces {
        let [a, b, c] = face.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).try_normalize()?;
        if axes.iter().all(|axis: &glam::DVec3| axis.dot(normal).abs() < PARALLEL) {
            axes.push(normal);
        }
    }
    let [a, b, c] = axes[..] else { return None };
    Some([a, b, c].map(|axis| axis.as_vec3()))
}

/// What rounding can do to a point that is so far from `centre` [length].
#[inline]
fn margin(centre: Vec3, away: f32) -> f32 {
    gamma(16) * (centre.abs().max_element() + away)
}
