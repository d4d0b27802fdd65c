//! Long hair on a head, combed back: each strand grows out of the scalp, bends under its weight and slides over head, neck and
//! shoulders, where the strands that began higher lie upon the others.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::{TUFT, random};

const STRANDS: u32 = 16_000;
const POINTS: usize = 13;
/// Width of a strand: twice that of a real one, for a sixth of their number [cm].
pub(crate) const WIDTH: f32 = 0.018;
/// Length of the longest [cm].
const LENGTH: f32 = 40.0;
/// Steps of growth from point to point.
const STEPS: usize = 4;
/// Strands that others keep to.
const TUFTS: u32 = 320;

struct Ellipsoid {
    centre: Vec3,
    half_axes: Vec3,
}

/// Behind is +z. `scenes/hair/head.pbrt` has the same bodies, 0.1 smaller.
const HEAD: Ellipsoid = Ellipsoid { centre: Vec3::ZERO, half_axes: Vec3::new(7.6, 10.2, 9.4) };
const NECK: Ellipsoid = Ellipsoid { centre: Vec3::new(0.0, -12.0, -0.5), half_axes: Vec3::new(5.2, 12.0, 5.6) };
const TRUNK: Ellipsoid = Ellipsoid { centre: Vec3::new(0.0, -37.0, -1.0), half_axes: Vec3::new(20.0, 19.5, 9.0) };

/// From root to tip.
pub(crate) fn strands() -> Vec<[Vec3; POINTS]> {
    let guides: Vec<_> = (TUFT..TUFT + TUFTS)
        .map(|tuft| {
            let root = root(tuft);
            (tuft, root, grown(root, LENGTH, tuft))
        })
        .collect();
    let strand = |n| {
        let root = root(n);
        let near = |(_, other, _): &&(u32, Vec3, _)| root.distance_squared(*other);
        let (tuft, _, guide) = guides.iter().min_by(|a, b| near(a).total_cmp(&near(b))).expect("there are tufts");
        waved(&grown(root, LENGTH * (0.88 + 0.12 * random(n, 5)), n), guide, n, *tuft)
    };
    (0..STRANDS).map(strand).collect()
}

/// Where a strand begins: a direction from the centre of the head, above a hairline that is low at the neck and high at the forehead.
fn root(of: u32) -> Vec3 {
    let direction = |k: u32| {
        let (y, phi) = (2.0 * random(of, 100 + 2 * k) - 1.0, TAU * random(of, 101 + 2 * k));
        let r = (1.0 - y * y).sqrt();
        Vec3::new(r * phi.cos(), y, r * phi.sin())
    };
    let is_scalp = |d: &Vec3| d.y > -0.15 - 0.35 * d.z + 0.55 * (-d.z).max(0.0);
    (0..1000).map(direction).find(is_scalp).expect("half of all directions are on the scalp")
}

/// A strand of some length [cm].
fn grown(root: Vec3, length: f32, of: u32) -> [Vec3; POINTS] {
    const GRAVITY: f32 = 0.32; // by which the direction falls [1/cm]
    let step = length / ((POINTS - 1) * STEPS) as f32;
    let layer = 0.25 + 1.5 * (root.y + 0.5).max(0.0) + 0.5 * random(of, 3);
    let front = (0.35 - root.z).clamp(0.0, 1.0);
    let comb = Vec3::new(0.55 * root.x, 0.15, 1.0).lerp(Vec3::new(0.5 * root.x, -0.75, 0.3), 1.0 - front);

    let mut p = root * HEAD.half_axes;
    let mut dir = (0.55 * (root / HEAD.half_axes).normalize() + comb).normalize();
    let mut points = [p; POINTS];
    for i in 1..=(POINTS - 1) * STEPS {
        let above = layer * (i as f32 * step / 3.0).min(1.0);
        dir = (dir - Vec3::Y * (GRAVITY * step)).normalize();
        let next = outside(p + dir * step, above);
        dir = (dir + (next - p).normalize()).normalize();
        p = next;
        if i % STEPS == 0 {
            points[i / STEPS] = p;
        }
    }
    points
}

/// The same point, or the one to which the bodies push it that reach `above` their skin [cm].
fn outside(p: Vec3, above: f32) -> Vec3 {
    [HEAD, NECK, TRUNK].iter().fold(p, |p, body| {
        let from = p - body.centre;
        let share = (from / (body.half_axes + above)).length();
        if share < 1.0 { body.centre + from / share } else { p }
    })
}

/// The strand drawn to its tuft, waved with it, and a little frizzy.
fn waved(own: &[Vec3; POINTS], guide: &[Vec3; POINTS], of: u32, tuft: u32) -> [Vec3; POINTS] {
    let stray = if random(of, 6) < 0.03 { 0.2 } else { 1.0 };
    let phase = TAU * random(tuft, 4) + 0.5 * PI * (random(of, 7) - 0.5);
    std::array::from_fn(|i| {
        let s = i as f32 / (POINTS - 1) as f32;
        let together = 0.8 * stray * (1.6 * s).min(1.0).powf(1.3);
        let wave = (1.4 * s).min(1.0).powi(2);
        let angle = TAU * 3.6 * s + phase;
        let frizz = 0.12 * s / stray.max(0.4);
        let off = |k: u32| frizz * (random(of, k + i as u32) - 0.5);
        own[i].lerp(guide[i], together)
            + Vec3::new(wave * angle.sin() + off(20), 0.0, 0.6 * wave * angle.cos() + off(50))
    })
}
