//! The instruments' photons: how many a second one core follows, and what a collision costs beside the bare loop of
//! `bare_walk.rs`, which draws flights and deflections and knows no boundary.

use std::process::Command;

use anyhow::{Context, Result};

use super::judge;
use crate::peers::statistics::median;
use crate::peers::tyndall::{Tyndall, children_cpu_seconds};
use crate::shell::{output, root};

/// A layer of `tyndall lab slab`, and how many photons make about a second.
struct Case {
    name: &'static str,
    layer: &'static str,
    photons: u64,
}

const CASES: [Case; 2] = [
    Case { name: "MCML's standard case", layer: "sigma_a=10 sigma_s=90 g=0.75 d=0.02", photons: 1_000_000 },
    Case { name: "thick tissue", layer: "sigma_a=0.1 sigma_s=100 g=0.9 n=1.4", photons: 20_000 },
];

/// Measures and prints. The bare loop and the instruments take turns.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    let bare = compile_bare_walk()?;
    let mut loops: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let mut runs: [Vec<Run>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..turns {
        for (times, time) in loops.iter_mut().zip(bare_times(&bare)?) {
            times.push(time);
        }
        for (case, runs) in CASES.iter().zip(&mut runs) {
            runs.push(follow(tyndall, case)?);
        }
    }
    let [scalar, lanes] = loops.map(|times| median(&times));
    println!("bare loop: {scalar:.1} ns a collision one by one, {lanes:.2} ns in 16 lanes");
    for (case, runs) in CASES.iter().zip(&runs) {
        let of = |what: fn(&Run) -> f64| median(&runs.iter().map(what).collect::<Vec<_>>());
        let cost = of(|run| 1e9 / (run.photons_a_second * run.collisions));
        println!(
            "{}: {:.3e} photons a second and core, {:.1} collisions each, {cost:.1} ns a collision: {:.1} times the bare \
             loop, {:.1} times its 16 lanes",
            case.name,
            of(|run| run.photons_a_second),
            of(|run| run.collisions),
            cost / scalar,
            cost / lanes
        );
    }
    Ok(())
}

struct Run {
    photons_a_second: f64,
    collisions: f64,
}

/// Follows the photons of a case on one thread; the start of the program is part of the time.
fn follow(tyndall: &Tyndall, case: &Case) -> Result<Run> {
    let mut command = Command::new(&tyndall.binary);
    command.args(["lab", "slab", "--threads", "1", "--json", "-", "--layer", case.layer]);
    command.args(["--photons", &case.photons.to_string()]);
    let begun = children_cpu_seconds()?;
    let report: serde_json::Value = serde_json::from_str(&output(&mut command)?)?;
    let seconds = children_cpu_seconds()? - begun;
    let figures = report["figures"].as_array().context("a report has figures")?;
    let figure = figures.iter().find(|figure| figure["name"] == "collisions").context("no collisions in the report")?;
    let collisions = figure["mean"].as_f64().context("the collisions are no number")?;
    Ok(Run { photons_a_second: case.photons as f64 / seconds, collisions })
}

/// What a collision costs in the whole program on one core, all told, beside the bare loop in 16 lanes [ns].
pub(super) fn judge_collision(place: &str, ours: f64, bare: f64) {
    const MOST: f64 = 8.0;
    const MOST_LOOPS: f64 = 3.0;
    let loops = ours / bare;
    judge(&format!("a collision {place}, all told, one core"), ours, "ns", ours <= MOST, &format!("{MOST} ns"));
    let target = format!("{MOST_LOOPS}×");
    judge(&format!("over the bare loop of {bare:.2} ns in 16 lanes"), loops, "×", loops <= MOST_LOOPS, &target);
}

/// Compiled as DESIGN says: for this processor.
pub(super) fn compile_bare_walk() -> Result<std::path::PathBuf> {
    let program = root().join("target/bench/bare_walk");
    let source = root().join("xtask/bare_walk.rs");
    output(
        Command::new("rustc")
            .args(["--edition", "2024", "-O", "-C", "target-cpu=native", "-o"])
            .arg(&program)
            .arg(source),
    )?;
    Ok(program)
}

/// Nanoseconds a collision, one by one and in lanes.
pub(super) fn bare_times(program: &std::path::Path) -> Result<[f64; 2]> {
    let text = output(&mut Command::new(program))?;
    let mut numbers = text.split_whitespace().map(str::parse);
    let mut next = || numbers.next().context("the bare loop tells two numbers")?.context("the bare loop tells numbers");
    Ok([next()?, next()?])
}
