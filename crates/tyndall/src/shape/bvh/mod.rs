//! The bounding volume hierarchy: 8-wide nodes, triangles in packets of 8, pieces of strands in bundles of 8 ([`bundle`]),
//! other primitives as general leaves.
//!
//! # Why no ray slips through a closed mesh
//!
//! The triangle test (Woop, Benthin and Wald 2013) moves the ray's origin to zero and shears its direction onto an
//! axis. The rounded, sheared vertex depends on the vertex and the ray only, so neighbours see the same vertex: the
//! rounded mesh is as closed as the exact one. The edge functions are differences of two products. Rounding is
//! monotonic, so without fused operations such a difference is never of the wrong sign, it is at worst falsely zero,
//! and then it is computed again in double precision, where the products are exact. So the test errs nowhere, but on
//! vertices displaced by rounding: for a vertex at `a` from the origin along an axis, seen from a ray that passes the
//! triangle, by at most `4u|a| + 8u·s`, with `u = 2⁻²⁴` and `s` the longest side of the triangle's box.
//!
//! So boxes must hold the displaced triangles (compare Ize 2013): every box is padded by `16u` of its longest side
//! when the tree is built ([`Node::PAD`]), and the distances to its planes are shortened and lengthened by `12u` when
//! it is met (`traverse::SLACK`): `4u` for the displacement, `4u` for the rounding of the distances themselves, and
//! the rest because the plane's distance from the origin is that of the padded box.

pub(super) mod between;
pub(super) mod build;
pub(super) mod bundle;
mod collapse;
mod divide;
mod prefetch;
pub(super) mod traverse;
pub(super) mod triangle;

use super::curve::Piece;
use crate::math::{Bounds, Vec3};

/// No object, no instance.
pub(super) const NONE: u32 = u32::MAX;

/// Eight boxes and what is inside them.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// `planes[2·axis + side]`: the least (side 0) and greatest (side 1) coordinates of the eight boxes [length].
    pub(super) planes: [[f32; 8]; 6],
    pub(super) child: [Child; 8],
}

impl Node {
    /// A node without children: boxes that no ray meets.
    const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; 8],
            [f32::NEG_INFINITY; 8],
            [f32::INFINITY; 8],
            [f32::NEG_INFINITY; 8],
            [f32::INFINITY; 8],
            [f32::NEG_INFINITY; 8],
        ],
        child: [Child(0); 8],
    };

    /// Padding of a box, in units of its longest side: see the head of this module.
    const PAD: f32 = 16.0 / (1 << 24) as f32;

    fn set(&mut self, slot: usize, bounds: &Bounds) {
        let pad = Self::PAD * bounds.extent().max_element();
        for axis in 0..3 {
            self.planes[2 * axis][slot] = (bounds.min[axis] - pad).next_down();
            self.planes[2 * axis + 1][slot] = (bounds.max[axis] + pad).next_up();
        }
    }
}

/// What is inside a box: a node, one or two packets of triangles or bundles of strands, or a run of other primitives.
///
/// Bits 31–30 are the kind. For packets and bundles bit 29 says whether there are two; for a run bits 29–27 are its length less
/// one. The rest is an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Child(pub(super) u32);

/// A [`Child`] taken apart.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content {
    Node(usize),
    Packets { first: usize, count: usize },
    Bundles { first: usize, count: usize },
    Others { first: usize, count: usize },
}

impl Child {
    const MAX_TRIANGLES: usize = 16;
    const MAX_PIECES: usize = 16;
    const MAX_OTHERS: usize = 8;

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn packets(first: usize, count: usize) -> Self {
        Self(1 << 30 | (count as u32 - 1) << 29 | first as u32)
    }

    fn bundles(first: usize, count: usize) -> Self {
        Self(3 << 30 | (count as u32 - 1) << 29 | first as u32)
    }

    fn others(first: usize, count: usize) -> Self {
        Self(2 << 30 | (count as u32 - 1) << 27 | first as u32)
    }

    #[inline(always)]
    pub(super) fn content(self) -> Content {
        let bits = self.0;
        match bits >> 30 {
            0 => Content::Node(bits as usize),
            1 => Content::Packets { first: (bits & 0x1fff_ffff) as usize, count: 1 + (bits >> 29 & 1) as usize },
            3 => Content::Bundles { first: (bits & 0x1fff_ffff) as usize, count: 1 + (bits >> 29 & 1) as usize },
            _ => Content::Others { first: (bits & 0x07ff_ffff) as usize, count: 1 + (bits >> 27 & 7) as usize },
        }
    }
}

/// Eight triangles, vertex by vertex and axis by axis. A packet that is not full repeats its last triangle.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Packet {
    /// `vertex[i][axis][lane]` [length].
    pub(super) vertex: [[[f32; 8]; 3]; 3],
    pub(super) ids: [TriangleId; 8],
    /// The lanes that repeat no other, a bit each.
    pub(super) filled: u32,
}

impl Packet {
    /// The lanes that repeat no other.
    pub(super) fn filled(&self) -> impl Iterator<Item = usize> {
        let filled = self.filled;
        (0..8).filter(move |lane| filled >> lane & 1 == 1)
    }

    /// One triangle of the packet [length].
    #[inline(always)]
    pub(super) fn triangle(&self, lane: usize) -> [Vec3; 3] {
        // Written out: `map` copies the packet.
        let [a, b, c] = &self.vertex;
        [vertex(a, lane), vertex(b, lane), vertex(c, lane)]
    }
}

#[inline(always)]
fn vertex(v: &[[f32; 8]; 3], lane: usize) -> Vec3 {
    Vec3::new(v[0][lane], v[1][lane], v[2][lane])
}

/// The name of a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct TriangleId {
    pub(super) object: u32,
    pub(super) prim: u32,
}

/// Eight pieces of strands in their sheaths, end by end and axis by axis. Lanes without a piece repeat the last one, in a
/// sheath of radius −∞.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Bundle {
    /// `ends[i][axis][lane]` [length].
    pub(super) ends: [[[f32; 8]; 3]; 2],
    /// Of the sheath [length].
    pub(super) radius: [f32; 8],
    pub(super) objects: [u32; 8],
    pub(super) pieces: [Piece; 8],
}

/// A leaf that is not a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) enum Primitive {
    /// A sphere in the space of the tree, at hand because scenes hold millions of them.
    Sphere { centre: Vec3, radius: f32, object: u32, instance: u32 },
    /// Any other shape, in the space of the tree or (if `instance` is not `NONE`) placed by an instance.
    Shape { object: u32, instance: u32 },
    /// A piece of a strand, in the space of the tree.
    Curve { object: u32, piece: Piece },
    /// A group with a tree of its own.
    Instance(u32),
}

/// A hierarchy over the triangles and primitives of the world or of one group.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) packets: Vec<Packet>,
    pub(super) bundles: Vec<Bundle>,
    pub(super) others: Vec<Primitive>,
    /// `None` when there is nothing.
    pub(super) root: Option<Child>,
    pub(super) bounds: Bounds,
}
