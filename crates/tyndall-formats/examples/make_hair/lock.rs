//! A lock that hangs in waves and ends in a point.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::{TUFT, random};

const STRANDS: u32 = 7000;
const POINTS: usize = 10;
/// Length of the lock [cm].
const LENGTH: f32 = 18.0;
/// Width of a strand [cm].
pub(crate) const WIDTH: f32 = 0.009;
const TUFTS: u32 = 24;

/// From root to tip.
pub(crate) fn strands() -> Vec<[Vec3; POINTS]> {
    let strand = |n| std::array::from_fn(|i| point(n, i as f32 / (POINTS - 1) as f32));
    (0..STRANDS).map(strand).collect()
}

/// A place in the unit disk.
fn in_disk(of: u32, which: u32) -> Vec2 {
    Vec2::from_angle(TAU * random(of, which + 1)) * random(of, which).sqrt()
}

/// A point of a strand, `s` from root to tip: a wave that grows downwards, tufts that drift apart, strands that keep to their tuft.
fn point(strand: u32, s: f32) -> Vec3 {
    let tuft = TUFT + strand % TUFTS;
    let (root, own) = (in_disk(tuft, 0), in_disk(strand, 2));
    let phase = 0.7 * random(tuft, 4) + 0.25 * random(strand, 4);
    let wave = s * (0.55 + 0.35 * random(tuft, 5));
    let angle = TAU * (2.3 * s + phase);
    let narrow = Vec2::new(1.3, 0.7) * (1.0 - 0.75 * s * s);
    let stray = if random(strand, 6) < 0.04 { 2.5 } else { 1.0 };
    let spread = (0.35 - 0.28 * s) * stray;
    let short = random(strand, 7);
    let length = LENGTH * (0.9 + 0.1 * random(tuft, 9)) * (1.0 - 0.35 * short * short);
    let across = root * narrow
        + own * spread
        + Vec2::new(wave * angle.sin(), 0.8 * wave * angle.cos())
        + Vec2::new(0.08 * (TAU * (5.0 * s + random(strand, 8))).sin() * s, 0.0);
    Vec3::new(across.x, -length * s, across.y)
}
