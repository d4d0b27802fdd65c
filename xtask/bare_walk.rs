//! The bare loop of DESIGN: flights and Henyey–Greenstein deflections in an infinite medium, and nothing else. Prints
//! nanoseconds a collision, one walk at a time and sixteen walks in lanes. What no transport code can be faster than.
//!
//! `cargo xtask bench lab` compiles it by itself: `rustc -O -C target-cpu=native`.

use std::{hint::black_box, time::Instant};

const G: f32 = 0.8;
/// Walks side by side.
const LANES: usize = 16;
/// Numbers in [0, 1) have 24 bits.
const UNIT: f32 = 1.0 / 16_777_216.0;

fn main() {
    println!("{:.3} {:.4}", scalar(20_000_000), lanes(100_000_000));
}

/// The cosine of a deflection for a uniform number.
#[inline(always)]
fn henyey_greenstein(u: f32) -> f32 {
    let ratio = (1.0 - G * G) / (1.0 - G + 2.0 * G * u);
    (1.0 + G * G - ratio * ratio) / (2.0 * G)
}

/// The direction at a cosine to `d`, at the azimuth with this sine and cosine.
#[inline(always)]
fn turned(d: [f32; 3], cosine: f32, [sin_phi, cos_phi]: [f32; 2]) -> [f32; 3] {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (x, y) = (sine * cos_phi, sine * sin_phi);
    let sign = 1f32.copysign(d[2]);
    let a = -1.0 / (sign + d[2]);
    let b = d[0] * d[1] * a;
    [
        (1.0 + sign * d[0] * d[0] * a) * x + b * y + d[0] * cosine,
        sign * b * x + (sign + d[1] * d[1] * a) * y + d[1] * cosine,
        -sign * d[0] * x - d[1] * y + d[2] * cosine,
    ]
}

fn scalar(collisions: usize) -> f64 {
    let mut state = 12345u64;
    let mut next = || {
        let old = state;
        state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = ((((old >> 18) ^ old) >> 27) as u32).rotate_right((old >> 59) as u32);
        ((x >> 8) as f32 + 0.5) * UNIT
    };
    let (mut p, mut d) = ([0f32; 3], [0f32, 0.0, 1.0]);
    let start = Instant::now();
    for _ in 0..collisions {
        let flight = -next().ln();
        for (p, d) in p.iter_mut().zip(d) {
            *p += d * flight;
        }
        let cosine = henyey_greenstein(next());
        d = turned(d, cosine, (next() * std::f32::consts::TAU).sin_cos().into());
    }
    let seconds = start.elapsed().as_secs_f64();
    black_box((p, d));
    seconds / collisions as f64 * 1e9
}

fn lanes(collisions: usize) -> f64 {
    let mut state: [u32; LANES] = std::array::from_fn(|i| 0x9e37_79b9u32.wrapping_mul(i as u32 + 1) | 1);
    let mut p = [[0f32; LANES]; 3];
    let mut d = [[0f32; LANES], [0f32; LANES], [1f32; LANES]];
    let start = Instant::now();
    for _ in 0..collisions / LANES {
        for i in 0..LANES {
            let mut s = state[i];
            let mut next = || {
                s ^= s << 13;
                s ^= s >> 17;
                s ^= s << 5;
                ((s >> 8) as f32 + 0.5) * UNIT
            };
            let (flight, u, v) = (-ln(next()), next(), next());
            state[i] = s;
            let old = [d[0][i], d[1][i], d[2][i]];
            let new = turned(old, henyey_greenstein(u), sin_cos_turn(v));
            for axis in 0..3 {
                p[axis][i] += old[axis] * flight;
                d[axis][i] = new[axis];
            }
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    black_box((p, d));
    seconds / collisions as f64 * 1e9
}

/// The logarithm of a positive number, by a polynomial of its mantissa.
#[inline(always)]
fn ln(x: f32) -> f32 {
    let bits = x.to_bits();
    let exponent = ((bits >> 23) as i32 - 127) as f32;
    let f = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000) - 1.0;
    let polynomial =
        [0.036_088_494, -0.095_329_39, 0.167_654_07, -0.240_733_8, 0.331_799_03, -0.499_874_12, 0.999_996_4]
            .into_iter()
            .fold(-0.006_453_544f32, |sum, c| sum * f + c);
    exponent * std::f32::consts::LN_2 + f * polynomial
}

/// Sine and cosine of a part of a turn, but for their signs, which a uniform azimuth does not need right.
#[inline(always)]
fn sin_cos_turn(u: f32) -> [f32; 2] {
    let x = 4.0 * (u - 0.5);
    let quarter = x.round();
    let y = (x - quarter) * std::f32::consts::FRAC_PI_2;
    let y2 = y * y;
    let s = y * (1.0 + y2 * (-0.166_666_55 + y2 * (0.008_332_161 - y2 * 0.000_195_152_96)));
    let c = 1.0 + y2 * (-0.5 + y2 * (0.041_666_642 + y2 * (-0.001_388_661 + y2 * 0.000_024_433_16)));
    let quarter = quarter as i32;
    let (a, b) = if quarter & 1 == 0 { (s, c) } else { (c, s) };
    [if quarter & 2 == 0 { a } else { -a }, if (quarter + 1) & 2 == 0 { b } else { -b }]
}
