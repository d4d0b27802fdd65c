//! One thread against two on the Cornell box: wall time, in turns.

use std::time::Instant;

use anyhow::Result;

use super::judge;
use crate::peers::scene_file;
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::shell::{output, root};

const SPP: u32 = 256;
const TARGET: f64 = 1.9;

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    let image = root().join("target/bench/threads.exr");
    let wall_seconds = |threads: &str| -> Result<f64> {
        let begun = Instant::now();
        output(tyndall.render_command(&scene_file("g_cornell"), SPP, &image).args(["--threads", threads]))?;
        Ok(begun.elapsed().as_secs_f64())
    };
    let mut ratios = Vec::new();
    for _ in 0..turns {
        ratios.push(wall_seconds("1")? / wall_seconds("2")?);
    }
    let ratio = median(&ratios);
    judge(&format!("two threads over one, Cornell box, median of {turns} turns"), ratio, "×", ratio >= TARGET, "1.9×");
    Ok(())
}
