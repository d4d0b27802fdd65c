//! Makes the strands of `scenes/hair`, `lock.hair` and `head.hair`. The same files at every call.
//!
//! ```text
//! cargo run -p tyndall-formats --example make_hair -- scenes/hair
//! ```

mod head;
mod lock;

use std::{error::Error, fs, path::Path};

use glam::Vec3;

/// Names of tufts, for [`random`], begin here; those of strands at 0.
const TUFT: u32 = 1_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).ok_or("name the directory to write to")?;
    let directory = Path::new(&directory);
    fs::write(directory.join("lock.hair"), hair_file(&lock::strands(), lock::WIDTH))?;
    fs::write(directory.join("head.hair"), hair_file(&head::strands(), head::WIDTH))?;
    Ok(())
}

/// A cyHair file of strands that have all as many points and the same width [cm].
fn hair_file<const N: usize>(strands: &[[Vec3; N]], width: f32) -> Vec<u8> {
    const POINTS: u32 = 2; // the only array: no segments, thicknesses, transparencies or colours
    const HEADER: usize = 128;
    let mut bytes = b"HAIR".to_vec();
    for n in [strands.len() as u32, (strands.len() * N) as u32, POINTS, N as u32 - 1] {
        bytes.extend(n.to_le_bytes());
    }
    let (transparency, color) = (0.0, [0.5; 3]);
    for v in [width, transparency].into_iter().chain(color) {
        bytes.extend(f32::to_le_bytes(v));
    }
    bytes.resize(HEADER, 0);
    bytes.extend(strands.iter().flatten().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes));
    bytes
}

/// Numbers in [0, 1), the same for the same names (Jarzynski and Olano 2020, "pcg").
fn random(of: u32, which: u32) -> f32 {
    let mut x = of.wrapping_mul(747_796_405).wrapping_add(which.wrapping_mul(2_891_336_453)).wrapping_add(1);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    x = (x >> 22) ^ x;
    x = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    ((x >> 22 ^ x) >> 8) as f32 / (1 << 24) as f32
}
