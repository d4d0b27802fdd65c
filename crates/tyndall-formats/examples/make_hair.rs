//! Makes the strands of `scenes/hair`: a lock that hangs in waves, as a `.hair` file. The same file at every call.
//!
//! ```text
//! cargo run -p tyndall-formats --example make_hair -- scenes/hair
//! ```
#![allow(clippy::print_stderr)]

use std::f32::consts::TAU;

const STRANDS: u32 = 7000;
const POINTS: u32 = 10;
/// Length of the lock [cm].
const LENGTH: f32 = 18.0;
/// Width of a strand [cm].
const WIDTH: f32 = 0.009;
const TUFTS: u32 = 24;

/// Numbers in [0, 1), the same for the same names (Jarzynski and Olano 2020, "pcg").
fn random(of: u32, which: u32) -> f32 {
    let mut x = of.wrapping_mul(747_796_405).wrapping_add(which.wrapping_mul(2_891_336_453)).wrapping_add(1);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    x = (x >> 22) ^ x;
    x = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    ((x >> 22 ^ x) >> 8) as f32 / (1 << 24) as f32
}

/// A place in the unit disk.
fn in_disk(of: u32, which: u32) -> [f32; 2] {
    let (r, phi) = (random(of, which).sqrt(), TAU * random(of, which + 1));
    [r * phi.cos(), r * phi.sin()]
}

/// A point of a strand, `s` from root to tip: a wave that grows downwards, tufts that drift apart, strands that keep to their tuft.
fn point(strand: u32, s: f32) -> [f32; 3] {
    let tuft = strand % TUFTS;
    let (root, own) = (in_disk(1_000_000 + tuft, 0), in_disk(strand, 2));
    let phase = 0.7 * random(1_000_000 + tuft, 4) + 0.25 * random(strand, 4);
    let wave = s * (0.55 + 0.35 * random(1_000_000 + tuft, 5));
    let angle = TAU * (2.3 * s + phase);
    let narrow = 1.0 - 0.45 * s;
    let stray = if random(strand, 6) < 0.04 { 2.5 } else { 1.0 };
    let spread = (0.35 - 0.2 * s) * stray;
    let length = LENGTH * (0.9 + 0.1 * random(strand, 7));
    [
        1.3 * root[0] * narrow
            + own[0] * spread
            + wave * angle.sin()
            + 0.08 * (TAU * (5.0 * s + random(strand, 8))).sin() * s,
        -length * s,
        0.7 * root[1] * narrow + own[1] * spread + 0.8 * wave * angle.cos(),
    ]
}

fn main() -> std::io::Result<()> {
    let Some(directory) = std::env::args().nth(1) else {
        eprintln!("make_hair DIRECTORY");
        std::process::exit(2);
    };
    let mut bytes = b"HAIR".to_vec();
    // Only points: every strand has as many segments, and the same width.
    for n in [STRANDS, STRANDS * POINTS, 2, POINTS - 1] {
        bytes.extend(n.to_le_bytes());
    }
    for v in [WIDTH, 0.0, 0.5, 0.5, 0.5] {
        bytes.extend(v.to_le_bytes());
    }
    bytes.resize(128, 0);
    for strand in 0..STRANDS {
        for i in 0..POINTS {
            let p = point(strand, i as f32 / (POINTS - 1) as f32);
            for x in p {
                bytes.extend(x.to_le_bytes());
            }
        }
    }
    std::fs::write(std::path::Path::new(&directory).join("lock.hair"), bytes)
}
