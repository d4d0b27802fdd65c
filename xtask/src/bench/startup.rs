//! How long `tyndall render` takes when there is nothing to do.

use std::time::Instant;

use anyhow::Result;

use super::judge;
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::shell::{output, root};

const SCENE: &str = "\
Film \"rgb\" \"integer xresolution\" [16] \"integer yresolution\" [16]
LookAt 0 0 4  0 0 0  0 1 0
Camera \"perspective\" \"float fov\" [40]
WorldBegin
LightSource \"infinite\" \"rgb L\" [1 1 1]
Material \"diffuse\"
Shape \"sphere\" \"float radius\" [1]
";
const TARGET_MS: f64 = 50.0;

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, times: u32) -> Result<()> {
    let directory = root().join("target/bench");
    let scene = directory.join("startup.pbrt");
    std::fs::write(&scene, SCENE)?;
    let mut milliseconds = Vec::new();
    for _ in 0..times {
        let begun = Instant::now();
        output(&mut tyndall.render_command(&scene, 1, &directory.join("startup.exr")))?;
        milliseconds.push(begun.elapsed().as_secs_f64() * 1e3);
    }
    let time = median(&milliseconds);
    let fastest = milliseconds.iter().copied().fold(f64::INFINITY, f64::min);
    println!("start-up: the fastest took {fastest:.3} ms, which the load on the machine hardly touches");
    judge(&format!("start-up, 16×16 pixels at 1 sample, median of {times}"), time, "ms", time < TARGET_MS, "< 50 ms");
    Ok(())
}
