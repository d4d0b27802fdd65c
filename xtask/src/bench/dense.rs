//! Dense media: efficiency beside both backends of Mitsuba at the best of its settings, and beside the same integrator
//! without walks; and what a collision costs beside the bare loop of `bare_walk.rs`.

use anyhow::{Context, Result};

use super::{judge, lab, scenes};
use crate::peers::runs::{Runs, Side, Turn};
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::peers::{directory, scene_file};
use crate::shell::output;

/// Scenes, and how many times the efficiency of the better Mitsuba is asked.
const SCENES: [(&str, f64); 6] = [
    ("b_marble_cube_matched", 20.0),
    ("c_milk_sphere", 40.0),
    ("b4_marble_mesh", 10.0),
    ("c2_milk_mesh", 10.0),
    ("d_fog_box", 3.0),
    ("d2_fog_lamp", 5.0),
];
/// What a collision may cost in the whole program [ns].
const COLLISION: f64 = 8.0;

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    scenes::race_all(&SCENES, tyndall, turns)?;
    for (scene, _) in SCENES {
        walks_over_rays(scene, tyndall, turns)?;
    }
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

/// How many times the efficiency of a ray for each flight walks have.
fn walks_over_rays(scene: &str, tyndall: &Tyndall, turns: u32) -> Result<()> {
    const SPP: u32 = 8;
    let directory = directory(scene)?;
    let mut sides: [Vec<Runs>; 2] = [Vec::new(), Vec::new()];
    for turn in Turn::all(turns, 2) {
        for (integrator, runs) in ["volpath", "volpath-traced"].into_iter().zip(&mut sides) {
            let extra = ["--integrator", integrator];
            runs.push(tyndall.render(&scene_file(scene), SPP, turn, &directory.join(integrator), &extra)?);
        }
    }
    let [walks, rays] = sides.map(|runs| Side::of(&runs, SPP));
    println!(
        "{scene}: walks {:.3e}, a ray for each flight {:.3e}: {:.2}×",
        walks.efficiency,
        rays.efficiency,
        walks.efficiency_over(&rays)
    );
    Ok(())
}

/// CPU time of a render of whole milk on one thread for each collision [ns].
fn collision(tyndall: &Tyndall) -> Result<f64> {
    let image = crate::shell::root().join("target/bench/collision.exr");
    let mut command = tyndall.render_command(&scene_file("c_milk_sphere"), 16, &image);
    let report: serde_json::Value = serde_json::from_str(&output(command.args(["--threads", "1", "--json", "-"]))?)?;
    report["ns_per_collision"].as_f64().context("no cost of a collision in the report")
}
