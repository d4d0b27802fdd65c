//! Pieces of strands, eight at a time: what a ray passes at more than their radius is told in single precision, by SIMD.
//!
//! Each piece is within a [`Sheath`]: what a ball of one radius covers that goes from one end to the other. A ray whose line
//! passes at a greater distance, or which is not there before `t_max`, cannot meet the piece. With `a` and `b` from the origin
//! to the ends, that distance is the least of `|a⊥ + (b⊥ − a⊥) t|`, `t` in [0, 1], for the parts across the ray. It is found to
//! `10u` of `|a|` and `|b|`, with `u = 2⁻²⁴`: the direction is rounded by `u`, `a` by `u`, its part along the ray by `5u` in all,
//! that across it by `10u`; and a `t` that is not quite the best one is at a distance that is greater only by a square. So sheaths
//! are taken [`SLACK`] wider, and all that is kept is tested exactly: see [`crate::shape::curve`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::{Bundle, Primitive};
use crate::{
    math::{Bounds, Ray, Vec3},
    shape::{curve::Piece, instance::outward},
};

/// Of the coordinates of both ends, summed up: see the head of this module.
const SLACK: f32 = 16.0 / (1 << 24) as f32;

/// All within a distance of a line between two points, which holds a piece of a strand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::shape) struct Sheath {
    /// The points [length].
    pub(in crate::shape) ends: [Vec3; 2],
    /// The distance [length].
    pub(in crate::shape) radius: f32,
}

impl Sheath {
    pub(in crate::shape) fn bounds(&self) -> Bounds {
        let [a, b] = self.ends.map(Vec3::as_dvec3);
        let radius = f64::from(self.radius);
        outward(a.min(b) - radius, a.max(b) + radius)
    }
}

impl Bundle {
    /// Of eight pieces at most, and at least one.
    pub(super) fn new(pieces: &[(u32, Piece, Sheath)]) -> Self {
        let lane = |i: usize| pieces[i.min(pieces.len() - 1)];
        let end = |k: usize| std::array::from_fn(|axis| std::array::from_fn(|i| lane(i).2.ends[k][axis]));
        Self {
            ends: [end(0), end(1)],
            radius: std::array::from_fn(|i| pieces.get(i).map_or(f32::NEG_INFINITY, |piece| piece.2.radius)),
            objects: std::array::from_fn(|i| lane(i).0),
            pieces: std::array::from_fn(|i| lane(i).1),
        }
    }

    /// One piece of the bundle, for the exact test.
    #[inline(always)]
    pub(super) fn primitive(&self, lane: usize) -> Primitive {
        Primitive::Curve { object: self.objects[lane], piece: self.pieces[lane] }
    }

    /// The lanes that hold a piece.
    pub(super) fn filled(&self) -> impl Iterator<Item = usize> {
        (0..8).filter(|&lane| self.radius[lane] >= 0.0)
    }
}

/// A ray made ready for bundles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    origin: Vec3,
    /// Of length 1.
    dir: Vec3,
    /// That of the ray's direction.
    length: f32,
}

impl Sight {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let dir = ray.dir.as_dvec3();
        let length = dir.length();
        Self { origin: ray.origin, dir: (dir / length).as_vec3(), length: length as f32 }
    }

    /// The lanes whose sheath the ray meets in front of the origin and before `t_max`: all of the truth, and some more.
    #[inline(always)]
    pub(super) fn candidates<S: Simd>(&self, simd: S, bundle: &Bundle, t_max: f32) -> u32 {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let a = self.across(simd, &bundle.ends[0]);
        let b = self.across(simd, &bundle.ends[1]);
        let [x, y, z] = [b.x - a.x, b.y - a.y, b.z - a.z];
        let square = (x * x + y * y + z * z).max(f32x8::splat(simd, f32::MIN_POSITIVE));
        let t = ((zero - (a.x * x + a.y * y + a.z * z)) / square).max(zero).min(one);
        let [x, y, z] = [a.x + x * t, a.y + y * t, a.z + z * t];
        let radius = f32x8::simd_from(simd, bundle.radius) + (a.size + b.size) * f32x8::splat(simd, SLACK);

        let passes = (x * x + y * y + z * z).simd_gt(radius * radius + f32x8::splat(simd, f32::MIN_POSITIVE));
        let behind = (a.along.max(b.along) + radius).simd_lt(zero);
        // Rounded up twice over: lengths of directions are rounded too.
        let end = f32x8::splat(simd, t_max * self.length * (1.0 + SLACK));
        let beyond = (a.along.min(b.along) - radius).simd_gt(end);
        !(passes | behind | beyond).to_bitmask() as u32 & 0xff
    }

    /// One end of each sheath, as the ray sees it.
    #[inline(always)]
    fn across<S: Simd>(&self, simd: S, end: &[[f32; 8]; 3]) -> Across<S> {
        let (origin, dir) = (self.origin, self.dir);
        let [dx, dy, dz] = [f32x8::splat(simd, dir.x), f32x8::splat(simd, dir.y), f32x8::splat(simd, dir.z)];
        let x = f32x8::simd_from(simd, end[0]) - f32x8::splat(simd, origin.x);
        let y = f32x8::simd_from(simd, end[1]) - f32x8::splat(simd, origin.y);
        let z = f32x8::simd_from(simd, end[2]) - f32x8::splat(simd, origin.z);
        let along = x * dx + y * dy + z * dz;
        let size = x.abs() + y.abs() + z.abs();
        Across { x: x - dx * along, y: y - dy * along, z: z - dz * along, along, size }
    }
}

/// From the ray's place nearest to a point to that point, how far the place is, and the sum of the point's distances from the
/// origin on each axis [length].
struct Across<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    z: f32x8<S>,
    along: f32x8<S>,
    size: f32x8<S>,
}
