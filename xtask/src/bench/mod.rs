//! `cargo xtask bench`: the figures that tyndall promises, measured on this machine, peers in the same minutes.

mod dense;
mod lab;
mod lights;
mod mesh;
mod plot;
mod rays;
mod roulette;
mod scale;
mod scenes;
mod startup;
mod thickness;
mod threads;

use anyhow::Result;
use clap::{Args, Subcommand};
use serde::Serialize;

use self::plot::Plot;
use crate::peers::tyndall::Tyndall;
use crate::shell::root;

/// What to measure and how long.
#[derive(Debug, Default, Args)]
pub(crate) struct Options {
    #[command(subcommand)]
    bench: Option<Bench>,
    /// Few repetitions: shows that a bench works, its figures are rough
    #[arg(long, global = true)]
    quick: bool,
}

/// What to measure; everything if nothing is named.
#[derive(Debug, Clone, Copy, Subcommand)]
pub(crate) enum Bench {
    /// Rays a second beside Embree 4.4 robust (at least 0.9 times on incoherent rays)
    Rays,
    /// Efficiency on the Cornell and fog boxes against both backends of Mitsuba (at least 1.5 times the better)
    Scenes,
    /// Time of `tyndall render` of a tiny scene (under 50 ms)
    Startup,
    /// How much faster two threads are than one (at least 1.9 times)
    Threads,
    /// Error times time of 10,000 emissive triangles beside that of ten (at most 2 times)
    Lights,
    /// Efficiency in dense media against both backends of Mitsuba, and ns a collision beside the bare loop
    Dense,
    /// What an error of 1 % costs in a cube of 1 to 10⁴ mean free paths, beside Mitsuba, and ns a collision: a plot
    Thickness,
    /// Photons a second and ns a collision of `tyndall lab`, beside a bare loop that only collides
    Lab,
    /// Reading and building a mesh of ten million triangles (under 15 s and 4 GiB)
    Mesh,
    /// MSE · N against N: our roulette keeps the variance finite where Mitsuba's does not
    Roulette,
    /// One picture at four sizes: the same light from tyndall, less from Mitsuba the smaller it is
    Scale,
}

/// Measures and prints; whether a target is met is said, but a missed one is no failure: machines differ.
pub(crate) fn run(options: &Options) -> Result<()> {
    std::fs::create_dir_all(root().join("target/bench"))?;
    println!("machine: {}", machine());
    let all = [
        Bench::Startup,
        Bench::Threads,
        Bench::Rays,
        Bench::Scenes,
        Bench::Lights,
        Bench::Dense,
        Bench::Thickness,
        Bench::Lab,
        Bench::Mesh,
        Bench::Roulette,
        Bench::Scale,
    ];
    match options.bench {
        Some(bench) => run_one(bench, options.quick),
        None => all.into_iter().try_for_each(|bench| run_one(bench, options.quick)),
    }
}

fn run_one(bench: Bench, quick: bool) -> Result<()> {
    match bench {
        Bench::Rays => rays::run(),
        Bench::Scenes => scenes::run(&Tyndall::find()?, if quick { 2 } else { 5 }),
        Bench::Lights => lights::run(&Tyndall::find()?, if quick { 2 } else { 5 }),
        Bench::Dense => dense::run(&Tyndall::find()?, if quick { 2 } else { 5 }),
        Bench::Thickness => thickness::run(&Tyndall::find()?, if quick { 2 } else { 3 }),
        Bench::Mesh => mesh::run(&Tyndall::find()?, if quick { 1 } else { 3 }),
        Bench::Startup => startup::run(&Tyndall::find()?, if quick { 5 } else { 20 }),
        Bench::Threads => threads::run(&Tyndall::find()?, if quick { 2 } else { 5 }),
        Bench::Lab => lab::run(&Tyndall::find()?, if quick { 1 } else { 5 }),
        Bench::Scale => scale::run(&Tyndall::find()?, if quick { 1 } else { 4 }),
        Bench::Roulette => roulette::run(&Tyndall::find()?, if quick { 4.0 } else { 60.0 }),
    }
}

/// Prints a table, and writes it, the data and a plot of them to `target/bench/NAME.*`.
fn publish(name: &str, table: &str, data: &impl Serialize, plot: &Plot) -> Result<()> {
    println!("{table}");
    let stem = root().join("target/bench").join(name);
    std::fs::write(stem.with_extension("md"), table)?;
    std::fs::write(stem.with_extension("json"), serde_json::to_string_pretty(data)?)?;
    plot.write(&stem.with_extension("svg"))?;
    println!("{}", stem.with_extension("svg").display());
    Ok(())
}

/// A figure beside its target.
fn judge(name: &str, figure: f64, unit: &str, is_met: bool, target: &str) {
    println!("{name}: {figure:.3} {unit} (target {target}: {})", if is_met { "met" } else { "MISSED" });
}

/// The processor and the load that others put on it, as Linux tells them.
fn machine() -> String {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let cpu_info = read("/proc/cpuinfo");
    let model = cpu_info.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown processor");
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let load = read("/proc/loadavg");
    let load = load.split_whitespace().next().unwrap_or("unknown");
    format!("{}, {cores} cores, load {load} when the bench began", model.trim_start_matches([' ', '\t', ':']))
}
