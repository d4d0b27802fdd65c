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

use std::sync::atomic::{AtomicU64, Ordering};

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
    const SIZES: usize = 5;
    /// How far from the surface a ball may be and touch it, in its radii \[1\]: what rounding and small bends add up to.
    const GAP: f32 = 1e-3;
    /// What of the way to the surface must be left in the ball, for it to be as good as the largest around a point \[1\].
    const ENOUGH: f32 = 0.5;

    /// The largest of a few balls that touches a surface at `at` on the side of its normal `inward`, no wider than `widest`
    /// [length]; `clearance` is given centres and how far to look at most.
    pub fn widest(at: DVec3, inward: DVec3, widest: f32, clearance: impl Fn(Vec3, f32) -> f32) -> Option<Self> {
        let sizes = (0..Self::SIZES as i32).map(|halvings| widest * 0.5f32.powi(halvings));
        sizes.map(|away| (away, clearance(centre(at, inward, away), away))).find_map(|(away, clear)| {
            let ball = Ball::within(centre(at, inward, away), clear);
            (ball.radius >= away * (1.0 - Self::GAP)).then_some(Self { ball, inward: inward.as_vec3(), away })
        })
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

fn centre(at: DVec3, inward: DVec3, away: f32) -> Vec3 {
    (at + inward * f64::from(away)).as_vec3()
}

/// Stands for a ball that nobody has asked for.
const UNKNOWN: u64 = u64::MAX;
/// Stands for no ball.
const NONE: u64 = 0;

/// The balls that touch triangles from behind, on the side away from their normals.
#[derive(Debug, Default)]
pub struct TouchingBalls {
    /// By object, by triangle: the bits of [`Touching::away`], and of the radius.
    balls: Vec<Vec<AtomicU64>>,
}

impl TouchingBalls {
    /// Of the meshes among the objects of some kind.
    pub fn of(geometry: &Geometry, objects: usize, is_wanted: impl Fn(ObjectId) -> bool) -> Self {
        let triangles = |id| match geometry.shape(id) {
            Shape::Mesh(mesh) if is_wanted(id) => mesh.indices.len(),
            _ => 0,
        };
        let objects = (0..objects as u32).map(ObjectId);
        let unknown = |count| (0..count).map(|_| AtomicU64::new(UNKNOWN)).collect();
        Self { balls: objects.map(|id| unknown(triangles(id))).collect() }
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
            UNKNOWN => {
                let found = find(at, inward);
                ball.store(found.map_or(NONE, |found| bits(&found)), Ordering::Relaxed);
                found
            }
            NONE => None,
            known => {
                let (away, radius) = (f32::from_bits((known >> 32) as u32), f32::from_bits(known as u32));
                let ball = Ball { centre: centre(at, inward, away), radius };
                Some(Touching { ball, inward: inward.as_vec3(), away })
            }
        })
    }
}

fn bits(touching: &Touching) -> u64 {
    u64::from(touching.away.to_bits()) << 32 | u64::from(touching.ball.radius.to_bits())
}
