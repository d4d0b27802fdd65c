//! Dense media: efficiency beside both backends of Mitsuba at the best of its settings, and what a collision costs beside
//! the bare loop of `bare_walk.rs`.

use anyhow::{Context, Result};

use super::{judge, lab, scenes};
use crate::peers::scene_file;
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::shell::output;

/// Scenes, and how many times the efficiency of the better Mitsuba is asked.
const SCENES: [(&str, f64); 3] = [("b_marble_cube_matched", 20.0), ("c_milk_sphere", 40.0), ("d_fog_box", 3.0)];
/// What a collision may cost in the whole program [ns].
const COLLISION: f64 = 8.0;

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    scenes::race_all(&SCENES, tyndall, turns)?;
    let bare = lab::compile_bare_walk()?;
    let (mut loops, mut collisions) = (Vec::new(), Vec::new());
    for _ in 0..turns {
        loops.push(lab::bare_times(&bare)?[1]);
        collisions.push(collision(tyndall)?);
    }
    let (bare, ours) = (median(&loops), median(&collisions));
    println!("bare loop: {bare:.2} ns a collision in 16 lanes; whole milk, all told: {:.1} times that", ours / bare);
    judge("a collision in whole milk, all told, one core", ours, "ns", ours <= COLLISION, "8 ns");
    Ok(())
}

/// CPU time of a render of whole milk on one thread for each collision [ns].
fn collision(tyndall: &Tyndall) -> Result<f64> {
    let image = crate::shell::root().join("target/bench/collision.exr");
    let mut command = tyndall.render_command(&scene_file("c_milk_sphere"), 16, &image);
    let report: serde_json::Value = serde_json::from_str(&output(command.args(["--threads", "1", "--json", "-"]))?)?;
    report["ns_per_collision"].as_f64().context("no cost of a collision in the report")
}
