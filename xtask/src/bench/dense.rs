//! Dense media: efficiency beside both backends of Mitsuba at the best of its settings, beside the same integrator without walks,
//! and with samples shared out by error; and what a collision costs beside the bare loop of `bare_walk.rs`.

use anyhow::{Context, Result};

use super::{lab, scenes};
use crate::peers::runs::{Runs, Side, Turn};
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::peers::{directory, scene_file};
use crate::shell::output;

/// Scenes, and how many times the efficiency of the better Mitsuba is asked.
const SCENES: [(&str, f64); 8] = [
    ("b_marble_cube_matched", 20.0),
    ("c_milk_sphere", 40.0),
    ("b4_marble_mesh", 10.0),
    ("b5_marble_smooth_mesh", 10.0),
    ("c2_milk_mesh", 10.0),
    ("c3_milk_smooth_mesh", 10.0),
    ("d_fog_box", 3.0),
    ("d2_fog_lamp", 5.0),
];

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    scenes::race_all(&SCENES, tyndall, turns)?;
    for (scene, _) in SCENES {
        gains(scene, tyndall, turns)?;
    }
    let bare = lab::compile_bare_walk()?;
    let (mut loops, mut collisions) = (Vec::new(), Vec::new());
    for _ in 0..turns {
        loops.push(lab::bare_times(&bare)?[1]);
        collisions.push(collision(tyndall)?);
    }
    lab::judge_collision("in whole milk", median(&collisions), median(&loops));
    Ok(())
}

/// How many times the efficiency of a ray for each flight walks have, and of even samples those that are shared out by error.
fn gains(scene: &str, tyndall: &Tyndall, turns: u32) -> Result<()> {
    const PAIRS: [(&str, u32, [&[&str]; 2]); 2] = [
        ("walks over a ray for each flight", 8, [&[], &["--integrator", "volpath-traced"]]),
        ("--adaptive over even samples", 32, [&["--adaptive"], &[]]),
    ];
    let directory = directory(scene)?;
    for (name, spp, arguments) in PAIRS {
        let mut sides: [Vec<Runs>; 2] = [Vec::new(), Vec::new()];
        for turn in Turn::all(turns, 2) {
            for (arguments, runs) in arguments.into_iter().zip(&mut sides) {
                runs.push(tyndall.render(&scene_file(scene), spp, turn, &directory.join("gain"), arguments)?);
            }
        }
        let [with, without] = sides.map(|runs| Side::of(&runs, spp));
        println!("{scene}: {name}: {:.2}×", with.efficiency_over(&without));
    }
    Ok(())
}

/// CPU time of a render of whole milk on one thread for each collision [ns].
fn collision(tyndall: &Tyndall) -> Result<f64> {
    let image = crate::shell::root().join("target/bench/collision.exr");
    let mut command = tyndall.render_command(&scene_file("c_milk_sphere"), 16, &image);
    let report: serde_json::Value = serde_json::from_str(&output(command.args(["--threads", "1", "--json", "-"]))?)?;
    report["ns_per_collision"].as_f64().context("no cost of a collision in the report")
}
