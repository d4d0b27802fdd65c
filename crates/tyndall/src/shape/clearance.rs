//! How far the nearest surface is at least.
//!
//! Particle-transport codes call it the safety: a flight that stays within it needs no ray. The bound is never above
//! the true distance. It is the distance itself, less a few roundings, except for ellipsoids, oblique cylinders, and
//! instances that are scaled unevenly, where lengths shrink at most by [`Placement::least_stretch`]; for patches, which
//! stand inside the hull of their corners; for strands, which stand around their chords; and for parts of spheres, disks and cylinders, which count as the whole.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, dispatch, f32x8, mask32x8};
use glam::DVec3;

use super::{
    Disk, Geometry, ObjectId, Patch, Shape, Sphere,
    bvh::{
        Bundle, Content, NONE, Node, Packet, Primitive, Tree,
        traverse::{Stack, open},
    },
    instance::Placement,
};
use crate::math::Vec3;

/// Double precision leaves less than this of the magnitudes that go into a distance.
const SLACK: f64 = 1e-14;

/// How far a search goes.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Nothing beyond is looked for [length].
    cap: f64,
    /// Once something is so near nothing nearer is looked for [length].
    enough: f64,
    /// Leaves that are looked into.
    leaves: u32,
}

/// What a search has found.
struct Found {
    /// A lower bound on the distance to all there is, or how far was to be looked [length].
    distance: f64,
    /// The packet that holds the nearest triangle, if that is the nearest of all.
    packet: Option<usize>,
}

impl Limits {
    fn cap(cap: f64) -> Self {
        Self { cap, enough: 0.0, leaves: u32::MAX }
    }
}

impl Found {
    /// Rounded down: a cast may round up.
    fn within(&self, cap: f32) -> f32 {
        if self.distance < f64::from(cap) { (self.distance as f32).next_down().max(0.0) } else { cap }
    }

    /// Something that is no triangle is so near.
    #[inline(always)]
    fn lower(&mut self, distance: f64) {
        if distance < self.distance {
            *self = Self { distance, packet: None };
        }
    }
}

impl Geometry {
    /// A lower bound on the distance from `p` to the nearest surface [length], at most `cap`.
    pub fn clearance(&self, p: Vec3, cap: f32) -> f32 {
        dispatch!(self.level, simd => self.world_clearance(simd, p, Limits::cap(f64::from(cap)), |_| false)).within(cap)
    }

    /// The same with the triangle that is nearest, or about as near, if one in the world itself is.
    pub fn nearest(&self, p: Vec3, cap: f32) -> (f32, Option<(ObjectId, u32)>) {
        dispatch!(self.level, simd => {
            let found = self.world_clearance(simd, p, Limits::cap(f64::from(cap)), |_| false);
            let id = found.packet.map(|packet| nearest_of(simd, &self.world.packets[packet], p));
            (found.within(cap), id)
        })
    }

    /// Whether no surface is within `distance` of `p` [length], where so many leaves of the tree can tell; else false.
    pub fn is_free(&self, p: Vec3, distance: f32, leaves: u32) -> bool {
        let cap = f64::from(distance);
        let limits = Limits { cap, enough: cap.next_down(), leaves };
        dispatch!(self.level, simd => self.world_clearance(simd, p, limits, |_| false)).distance >= cap
    }

    /// Whether no surface but a sphere that stands in the world can be within `distance` of `p` [length].
    pub(super) fn is_alone(&self, p: Vec3, distance: f32, sphere: (u32, u32)) -> bool {
        let is_itself = |primitive: &Primitive| matches!(*primitive, Primitive::Sphere { object, instance, .. } if (object, instance) == sphere);
        let limits = Limits::cap(f64::from(distance));
        dispatch!(self.level, simd => self.world_clearance(simd, p, limits, is_itself)).distance >= limits.cap
    }

    /// Of what stands in the world and is not `ignored`.
    #[inline(always)]
    fn world_clearance<S: Simd>(
        &self,
        simd: S,
        p: Vec3,
        limits: Limits,
        ignored: impl Fn(&Primitive) -> bool,
    ) -> Found {
        search(simd, &self.world, p.as_dvec3(), limits, |primitive, cap| match *primitive {
            _ if ignored(primitive) => f64::INFINITY,
            Primitive::Instance(index) => self.instance_clearance(simd, index, p, cap),
            Primitive::Shape { object, instance } if instance != NONE => {
                let placement = &self.instances[instance as usize].placement;
                let local = placement.local_point(p.as_dvec3());
                self.shapes[object as usize].clearance(local) * placement.least_stretch() - placement.slack(local)
            }
            _ => self.primitive_clearance(primitive, p.as_dvec3()),
        })
    }

    #[inline(never)]
    fn instance_clearance<S: Simd>(&self, simd: S, index: u32, p: Vec3, cap: f64) -> f64 {
        let instance = &self.instances[index as usize];
        let (placement, tree) = (&instance.placement, &self.groups[instance.group as usize]);
        let stretch = placement.least_stretch();
        let local = placement.local_point(p.as_dvec3());
        let found = simd.vectorize(
            #[inline(always)]
            || {
                search(simd, tree, local, Limits::cap(cap / stretch), |primitive, _| {
                    self.primitive_clearance(primitive, local)
                })
            },
        );
        found.distance * stretch - placement.slack(local)
    }

    fn primitive_clearance(&self, primitive: &Primitive, p: DVec3) -> f64 {
        match *primitive {
            Primitive::Sphere { centre, radius, .. } => to_sphere(centre, radius, p),
            Primitive::Shape { object, .. } => self.shapes[object as usize].clearance(p),
            // Groups hold no instances, and pieces of strands stand in bundles.
            Primitive::Curve { .. } | Primitive::Instance(_) => f64::INFINITY,
        }
    }
}

impl Placement {
    /// What the rounding of the map to local space may add to a distance.
    fn slack(&self, local: DVec3) -> f64 {
        let map = self.map();
        let size = (map.matrix3.x_axis.abs() + map.matrix3.y_axis.abs() + map.matrix3.z_axis.abs()).max_element();
        SLACK * (size * local.abs().max_element() + map.translation.abs().max_element())
    }
}

impl Shape {
    fn clearance(&self, p: DVec3) -> f64 {
        match self {
            // Their triangles and pieces are in the tree.
            Self::Mesh(_) | Self::Curves(_) => f64::INFINITY,
            Self::Sphere(sphere) => sphere.clearance(p),
            Self::Disk(disk) => disk.clearance(p),
            Self::Cylinder(cylinder) => cylinder.clearance(p),
            Self::Patch(patch) => patch.clearance(p),
        }
    }
}

impl Sphere {
    fn clearance(&self, p: DVec3) -> f64 {
        match &self.placement {
            None => to_sphere(self.centre, self.radius, p),
            Some(placement) => {
                let local = placement.local_point(p);
                to_sphere(self.centre, self.radius, local) * placement.least_stretch() - placement.slack(local)
            }
        }
    }
}

impl Disk {
    /// Of an ellipse: the distance to the rectangle around it.
    fn clearance(&self, p: DVec3) -> f64 {
        let (centre, a, b) = (self.centre.as_dvec3(), self.a.as_dvec3(), self.b.as_dvec3());
        let slack = SLACK * (p - centre).abs().max_element();
        if self.radius().is_none() {
            let corner = |x: f64, y: f64| centre + a * x + b * y;
            let [q0, q1, q2, q3] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            let square = to_triangle_squared([q0, q1, q2], p).min(to_triangle_squared([q0, q2, q3], p));
            return square.sqrt() - slack;
        }
        let from = p - centre;
        let height = a.cross(b).normalize().dot(from);
        let across = (from.length_squared() - height * height).max(0.0).sqrt();
        // The half-axes are rounded: allow for either being the longer.
        let rounding = f64::from(f32::EPSILON) * 8.0;
        let outer = a.length() * (1.0 + rounding);
        let inner = outer * f64::from(self.inner) * (1.0 - 3.0 * rounding);
        let beside = (across - outer).max(inner - across).max(0.0);
        height.hypot(beside) * (1.0 - 2.0 * rounding) - slack
    }
}

impl Patch {
    /// Distance to the tetrahedron of the corners, which holds the patch: its four faces, or 0 inside.
    fn clearance(&self, p: DVec3) -> f64 {
        let [a, b, c, d] = self.corners.map(Vec3::as_dvec3);
        let faces = [([a, b, c], d), ([b, c, d], a), ([c, d, a], b), ([d, a, b], c)];
        let inside = faces.iter().all(|&([x, y, z], other)| {
            let normal = (y - x).cross(z - x);
            normal.dot(p - x) * normal.dot(other - x) >= 0.0
        });
        if inside {
            return 0.0;
        }
        let square = faces.iter().map(|&(face, _)| to_triangle_squared(face, p)).fold(f64::INFINITY, f64::min);
        square.sqrt() - SLACK * (p - a).abs().max_element()
    }
}

fn to_sphere(centre: Vec3, radius: f32, p: DVec3) -> f64 {
    let (centre, radius) = (centre.as_dvec3(), f64::from(radius));
    let distance = (p - centre).length();
    (distance - radius).abs() - SLACK * (distance + radius)
}

/// The least distance in `tree`, within limits; 0 where there are more leaves than allowed.
#[inline(always)]
fn search<S: Simd>(
    simd: S,
    tree: &Tree,
    p: DVec3,
    limits: Limits,
    mut visit: impl FnMut(&Primitive, f64) -> f64,
) -> Found {
    let mut found = Found { distance: limits.cap, packet: None };
    let mut leaves = limits.leaves;
    let Some(mut child) = tree.root else { return found };
    let point = p.as_vec3();
    let mut stack = Stack::new();
    loop {
        let limit = ((found.distance * found.distance) as f32).next_up();
        match child.content() {
            Content::Node(index) => {
                let node = &tree.nodes[index];
                let (mask, squares) = near_boxes(simd, node, point, limit);
                if let Some(first) = open(node, mask, &squares, &mut stack) {
                    child = first;
                    continue;
                }
            }
            Content::Packets { first, count } => {
                for packet in first..first + count {
                    let distance = to_packet(simd, &tree.packets[packet], p, limit);
                    if distance < found.distance {
                        found = Found { distance, packet: Some(packet) };
                    }
                }
            }
            Content::Bundles { first, count } => {
                for bundle in &tree.bundles[first..first + count] {
                    found.lower(to_bundle(simd, bundle, point));
                }
            }
            Content::Others { first, count } => {
                for primitive in &tree.others[first..first + count] {
                    found.lower(visit(primitive, found.distance));
                }
            }
        }
        leaves = leaves.saturating_sub(1);
        if found.distance <= limits.enough {
            return Found { distance: found.distance.max(0.0), ..found };
        }
        if leaves == 0 {
            return Found { distance: 0.0, packet: None };
        }
        match stack.pop(((found.distance * found.distance) as f32).next_up()) {
            Some(next) => child = next,
            None => return found,
        }
    }
}

/// The children whose squared distance may be below `limit`, and a lower bound on it.
#[inline(always)]
fn near_boxes<S: Simd>(simd: S, node: &Node, p: Vec3, limit: f32) -> (u32, [f32; 8]) {
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
fn to_packet<S: Simd>(simd: S, packet: &Packet, p: DVec3, limit: f32) -> f64 {
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
fn nearest_of<S: Simd>(simd: S, packet: &Packet, p: Vec3) -> (ObjectId, u32) {
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
fn to_bundle<S: Simd>(simd: S, bundle: &Bundle, p: Vec3) -> f64 {
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

/// Squared distance to a triangle (after Ericson 2005, § 5.1.5), exact enough in double precision for triangles as
/// thin as single precision can make them: each region's answer is the distance to a line or plane of the triangle.
fn to_triangle_squared([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let edges = to_segment_squared(a, b, p).min(to_segment_squared(b, c, p)).min(to_segment_squared(c, a, p));
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    let above = |from: DVec3, to: DVec3| normal.cross(to - from).dot(p - from) >= 0.0;
    if square > 0.0 && above(a, b) && above(b, c) && above(c, a) {
        let height = normal.dot(p - a);
        edges.min(height * height / square)
    } else {
        edges
    }
}

fn to_segment_squared(a: DVec3, b: DVec3, p: DVec3) -> f64 {
    let (along, from) = (b - a, p - a);
    let length = along.length_squared();
    let t = if length > 0.0 { (along.dot(from) / length).clamp(0.0, 1.0) } else { 0.0 };
    (from - along * t).length_squared()
}
