//! Balls that touch a surface from inside: as large as there is room for, with their centre on the normal of the point that they
//! touch. In geometry processing they are known as medial balls, when no larger one has that point.
//!
//! A path in a body is near the surface more often than not, and around it there is hardly any room. In the ball that touches the
//! surface there is much: a walk leaves it far more rarely, and near the point of touch it reaches as far as the surface does.
//!
//! What is found for a triangle is remembered: it depends on the triangle alone, so no order of threads and questions can be seen
//! in an answer.
//!
//! Source: Amenta, Choi and Kolluri 2001, "The power crust, unions of balls, and the medial axis transform", § 2.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;

use super::{Ball, Geometry, ObjectId, Shape};
use crate::math::Vec3;

/// A ball that touches a surface, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touching {
    /// No surface is in it.
    pub ball: Ball,
    /// From the surface to its centre.
    inward: Vec3,
    /// How far the centre is from the surface [length].
    away: f32,
}

impl Touching {
    /// Sizes that are tried, each half of the one before.
    const SIZES: i32 = 7;
    /// How far from the surface a ball ends, in its radii \[1\]: more than rounding and small bends add up to.
    const GAP: f32 = 3e-4;
    /// What of the way to the surface must be left in the ball, for it to be as good as the largest around a point \[1\].
    const ENOUGH: f32 = 0.5;

    /// With its centre so far from a surface at `at`, on the side of its normal `inward` [length].
    #[inline]
    fn new(at: DVec3, inward: DVec3, away: f32) -> Self {
        let ball = Ball::within((at + inward * f64::from(away)).as_vec3(), away * (1.0 - Self::GAP));
        Self { ball, inward: inward.as_vec3(), away }
    }

    /// The largest of a few that touches a surface at `at` on the side of its normal `inward` and is free, no wider than `widest`
    /// [length].
    pub fn widest(at: DVec3, inward: DVec3, widest: f32, is_free: impl Fn(&Ball) -> bool) -> Option<Self> {
        let sizes = (0..Self::SIZES).map(|halvings| widest * 0.5f32.powi(halvings));
        sizes.map(|away| Self::new(at, inward, away)).find(|touching| is_free(&touching.ball))
    }

    /// Whether `p` is in the ball, with about as much room around it as the surface leaves where that is flat.
    #[inline]
    pub fn holds(&self, p: Vec3) -> bool {
        let height = self.inward.dot(p - self.ball.centre) + self.away;
        self.ball.depth(p) > (Self::ENOUGH * height).max(0.0)
    }

    /// Whether there is about as much room around `p` as in another ball around it.
    #[inline]
    pub fn is_as_good_as(&self, around: &Ball, p: Vec3) -> bool {
        self.ball.depth(p) > Self::ENOUGH * around.radius
    }
}

/// Stands for a ball that nobody has asked for: the bits of no length.
const UNKNOWN: u32 = u32::MAX;
/// Stands for no ball.
const NONE: u32 = 0;

/// The balls that touch triangles from behind, on the side away from their normals.
#[derive(Debug, Default)]
pub struct TouchingBalls {
    /// By object, by triangle: the bits of [`Touching::away`].
    balls: Vec<Vec<AtomicU32>>,
}

impl TouchingBalls {
    /// Of the meshes among so many objects that are of some kind.
    pub fn of(geometry: &Geometry, objects: usize, is_wanted: impl Fn(ObjectId) -> bool) -> Self {
        let triangles = |id| match geometry.shape(id) {
            Shape::Mesh(mesh) if is_wanted(id) => mesh.indices.len(),
            _ => 0,
        };
        let unknown = |count| (0..count).map(|_| AtomicU32::new(UNKNOWN)).collect();
        Self { balls: (0..objects as u32).map(|id| unknown(triangles(ObjectId(id)))).collect() }
    }

    /// The ball that touches a triangle in its middle, given how to `find` it from there and the direction inwards; `None` where
    /// nothing is remembered.
    #[inline]
    pub fn behind(
        &self,
        geometry: &Geometry,
        (object, prim): (ObjectId, u32),
        find: impl FnOnce(DVec3, DVec3) -> Option<Touching>,
    ) -> Option<Option<Touching>> {
        let ball = self.balls.get(object.0 as usize)?.get(prim as usize)?;
        let Shape::Mesh(mesh) = geometry.shape(object) else { return None };
        let [a, b, c] = mesh.triangle(prim).map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (at, inward) = ((a + b + c) / 3.0, if mesh.reversed { normal } else { -normal });
        Some(match ball.load(Ordering::Relaxed) {
            NONE => None,
            UNKNOWN => {
                let found = find(at, inward);
                ball.store(found.map_or(NONE, |found| found.away.to_bits()), Ordering::Relaxed);
                found
            }
            away => Some(Touching::new(at, inward, f32::from_bits(away))),
        })
    }
}
