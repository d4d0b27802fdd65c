//! Distances from a point to eight boxes, triangles or pieces of strands at once: lower bounds, in single precision but for slivers.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};
use glam::DVec3;

use super::{SLACK, to_triangle_squared};
use crate::{
    math::Vec3,
    shape::{
        ObjectId,
        bvh::{Bundle, Node, Packet},
    },
};

/// The children whose squared distance may be below `limit`, and a lower bound on it.
#[inline(always)]
pub(super) fn near_boxes<S: Simd>(simd: S, node: &Node, p: Vec3, limit: f32) -> (u32, [f32; 8]) {
    let [x0, x1, y0, y1, z0, z1] = &node.planes;
    let x = beside(simd, f32x8::simd_from(simd, *x0), f32x8::simd_from(simd, *x1), p.x);
    let y = beside(simd, f32x8::simd_from(simd, *y0), f32x8::simd_from(simd, *y1), p.y);
    let z = beside(simd, f32x8::simd_from(simd, *z0), f32x8::simd_from(simd, *z1), p.z);
    let squares = sum_of_squares(simd, x, y, z);
    (squares.simd_lt(f32x8::splat(simd, limit)).to_bitmask() as u32, squares.into())
}

/// Rounded down: by more than five roundings can add.
#[inline(always)]
fn sum_of_squares<S: Simd>(simd: S, x: f32x8<S>, y: f32x8<S>, z: f32x8<S>) -> f32x8<S> {
    (x * x + y * y + z * z) * f32x8::splat(simd, 1.0 - 8.0 * f32::EPSILON)
}

/// How far `p` is beside eight intervals.
#[inline(always)]
fn beside<S: Simd>(simd: S, least: f32x8<S>, greatest: f32x8<S>, p: f32) -> f32x8<S> {
    // In local space the point itself is rounded.
    let slack = f32x8::splat(simd, p.abs() * f32::EPSILON);
    let at = f32x8::splat(simd, p);
    ((least - at).max(at - greatest) - slack).max(f32x8::splat(simd, 0.0))
}

/// A lower bound on the distance to the triangles of a packet, at least where it may be below the root of `limit`: the
/// boxes of the triangles are asked first.
#[inline(always)]
pub(super) fn to_packet<S: Simd>(simd: S, packet: &Packet, p: DVec3, limit: f32) -> f64 {
    let point = p.as_vec3();
    let x = beside_triangles(simd, packet, 0, point.x);
    let y = beside_triangles(simd, packet, 1, point.y);
    let z = beside_triangles(simd, packet, 2, point.z);
    let near = sum_of_squares(simd, x, y, z).simd_lt(f32x8::splat(simd, limit));
    if near.to_bitmask() == 0 {
        return f64::INFINITY;
    }
    let (distances, certain) = to_triangles(simd, packet, point);
    let infinity = f32x8::splat(simd, f32::INFINITY);
    let mut nearest = f64::from((near & certain).select(distances, infinity).reduce_min());
    let mut mask = (near & !certain).to_bitmask() as u32;
    while mask != 0 {
        let [a, b, c] = packet.triangle((mask.trailing_zeros() & 7) as usize);
        mask &= mask - 1;
        let triangle = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
        let slack = SLACK * (p - triangle[0]).abs().max_element();
        nearest = nearest.min(to_triangle_squared(triangle, p).sqrt() - slack);
    }
    nearest
}

/// The triangle of a packet that is nearest, by single precision.
#[inline(always)]
pub(super) fn nearest_of<S: Simd>(simd: S, packet: &Packet, p: Vec3) -> (ObjectId, u32) {
    let distances: [f32; 8] = to_triangles(simd, packet, p).0.into();
    let lane = (1..8).fold(0, |best, lane| if distances[lane] < distances[best] { lane } else { best });
    let id = packet.ids[lane];
    (ObjectId(id.object), id.prim)
}

#[inline(always)]
fn beside_triangles<S: Simd>(simd: S, packet: &Packet, axis: usize, p: f32) -> f32x8<S> {
    let a = f32x8::simd_from(simd, packet.vertex[0][axis]);
    let b = f32x8::simd_from(simd, packet.vertex[1][axis]);
    let c = f32x8::simd_from(simd, packet.vertex[2][axis]);
    beside(simd, a.min(b).min(c), a.max(b).max(c), p)
}

/// A lower bound on the distance to the pieces of a bundle: to their sheaths.
#[inline(always)]
pub(super) fn to_bundle<S: Simd>(simd: S, bundle: &Bundle, p: Vec3) -> f64 {
    let [a, b] = [from(simd, &bundle.ends[0], p), from(simd, &bundle.ends[1], p)];
    let distance = to_edge(simd, a, minus(b, a)).sqrt();
    let reach = (dot(a, a).max(dot(b, b))).sqrt() + f32x8::splat(simd, p.abs().max_element());
    let slack = reach * f32x8::splat(simd, 8.0 * f32::EPSILON);
    f64::from((distance - f32x8::simd_from(simd, bundle.radius) - slack).reduce_min())
}

/// `1/sin` of the angle between two edges above which double precision is asked.
const FLATTEST: f32 = 8.0;

/// Eight vectors.
type Vectors<S> = [f32x8<S>; 3];

/// Lower bounds on the distances to the triangles of a packet, and for which of them single precision is enough: not for
/// slivers, whose normal has few digits.
#[inline(always)]
fn to_triangles<S: Simd>(simd: S, packet: &Packet, p: Vec3) -> (f32x8<S>, mask32x8<S>) {
    let zero = f32x8::splat(simd, 0.0);
    let [a, b, c] = &packet.vertex;
    let [a, b, c] = [from(simd, a, p), from(simd, b, p), from(simd, c, p)];
    let [ab, bc, ca] = [minus(b, a), minus(c, b), minus(a, c)];
    let edges = to_edge(simd, a, ab).min(to_edge(simd, b, bc)).min(to_edge(simd, c, ca));

    let n = cross(ca, ab);
    let square = dot(n, n);
    let length = square.sqrt();
    let [over_ab, over_bc, over_ca] = [dot(cross(n, ab), a), dot(cross(n, bc), b), dot(cross(n, ca), c)];
    let inside = over_ab.max(over_bc).max(over_ca).simd_le(zero) & square.simd_gt(zero);
    let height = dot(n, a).abs() / length;
    let distance = inside.select(height.min(edges.sqrt()), edges.sqrt());

    // The errors of the differences of vertices, times what they are divided by.
    let spread = (dot(ab, ab) * dot(ca, ca)).sqrt() / length;
    let reach = dot(a, a).sqrt() + (dot(ab, ab) + dot(ca, ca)).sqrt() + f32x8::splat(simd, p.abs().max_element());
    let slack = reach * (spread + f32x8::splat(simd, 1.0)) * f32x8::splat(simd, 4.0 * f32::EPSILON);
    (distance - slack, spread.simd_lt(f32x8::splat(simd, FLATTEST)))
}

/// From a point to eight others.
#[inline(always)]
fn from<S: Simd>(simd: S, [x, y, z]: &[[f32; 8]; 3], p: Vec3) -> Vectors<S> {
    [
        f32x8::simd_from(simd, *x) - f32x8::splat(simd, p.x),
        f32x8::simd_from(simd, *y) - f32x8::splat(simd, p.y),
        f32x8::simd_from(simd, *z) - f32x8::splat(simd, p.z),
    ]
}

/// Squared distance to the edges that begin at `from`.
#[inline(always)]
fn to_edge<S: Simd>(simd: S, from: Vectors<S>, edge: Vectors<S>) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let square = dot(edge, edge).max(f32x8::splat(simd, f32::MIN_POSITIVE));
    let t = ((zero - dot(from, edge)) / square).max(zero).min(one);
    let nearest = [from[0] + edge[0] * t, from[1] + edge[1] * t, from[2] + edge[2] * t];
    dot(nearest, nearest)
}

#[inline(always)]
fn minus<S: Simd>(a: Vectors<S>, b: Vectors<S>) -> Vectors<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<S: Simd>(a: Vectors<S>, b: Vectors<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<S: Simd>(a: Vectors<S>, b: Vectors<S>) -> Vectors<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
