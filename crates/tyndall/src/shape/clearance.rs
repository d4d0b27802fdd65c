//! How far the nearest surface is at least.
//!
//! Particle-transport codes call it the safety: a flight that stays within it needs no ray. The bound is never above
//! the true distance. It is the distance itself, less a few roundings, except for ellipsoids, oblique cylinders, and
//! instances that are scaled unevenly, where lengths shrink at most by [`Placement::least_stretch`]; for patches, which
//! stand inside the hull of their corners; for strands, which stand around their chords; and for parts of spheres, disks and cylinders, which count as the whole.

mod eight;

use fearless_simd::{Simd, dispatch};
use glam::DVec3;

use super::{
    Disk, Geometry, ObjectId, Patch, Shape, Sphere,
    bvh::{
        Content, NONE, Primitive, Tree,
        traverse::{Stack, open},
    },
    instance::Placement,
};
use crate::math::Vec3;
use eight::{near_boxes, nearest_of, to_bundle, to_packet};

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
