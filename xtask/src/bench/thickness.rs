//! Cost against optical thickness: a cube under a lamp, from 1 to 10⁴ mean free paths across, at albedo 0.999 and at albedo 1.
//!
//! Cost is `MSE · CPU s / (1 % of the mean)²`: the CPU seconds until the error of a pixel is 1 % of the mean of the picture, the start of
//! the program included. Mitsuba plays no roulette: with its own, light is missing (`bench roulette`).

use std::fmt::Write as _;

use anyhow::{Context, Result};
use serde::Serialize;

use super::plot::{Curve, Panel, Plot};
use super::{lab, publish, scenes};
use crate::peers::mitsuba::Mitsuba;
use crate::peers::report::figure;
use crate::peers::runs::Side;
use crate::peers::settings::{Duel, Variant};
use crate::peers::statistics::median;
use crate::peers::tyndall::{Tyndall, report};
use crate::peers::{THICKNESS, directory};

const ALBEDOS: [&str; 2] = ["0.999", "1"];

/// Mean free paths across, and samples a pixel in a run of Mitsuba and of tyndall.
const CUBES: [(u32, u32, u32); 5] = [(1, 32, 64), (10, 32, 64), (100, 16, 64), (1000, 4, 64), (10_000, 1, 128)];

/// What was measured in one cube.
#[derive(Debug, Serialize)]
struct Row {
    albedo: &'static str,
    /// Mean free paths across
    thickness: u32,
    tyndall: Side,
    mitsuba: [Side; 2],
    /// Of a path of tyndall
    collisions: f64,
    /// CPU time of a run of tyndall, all told, for each of them [ns]
    collision: f64,
}

/// Measures, prints the table, writes `target/bench/thickness.*`.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    let mitsuba = Mitsuba::install()?;
    let mut rows = Vec::new();
    for albedo in ALBEDOS {
        for cube in CUBES {
            let row = measure(albedo, cube, turns, &mitsuba, tyndall)?;
            eprintln!("albedo {albedo}, {} across: {:.2}×", cube.0, row.gain());
            rows.push(row);
        }
    }
    publish("thickness", &table(&rows), &rows, &plot(&rows))?;

    let bare = lab::compile_bare_walk()?;
    let loops = (0..turns).map(|_| Ok(lab::bare_times(&bare)?[1])).collect::<Result<Vec<_>>>()?;
    let deepest = rows.last().context("there are cubes")?.collision;
    lab::judge_collision("in the interior", deepest, median(&loops));
    Ok(())
}

fn measure(
    albedo: &'static str,
    (thickness, mitsuba_spp, tyndall_spp): (u32, u32, u32),
    turns: u32,
    mitsuba: &Mitsuba,
    tyndall: &Tyndall,
) -> Result<Row> {
    let label = directory(&format!("{THICKNESS}/{thickness} {albedo}"))?.join("tyndall");
    let values = [format!("thickness={thickness}"), format!("albedo={albedo}")];
    let parameters = format!("integrator=volpath rr_depth=1000000 {}", values.join(" "));
    let duel =
        Duel { scene: THICKNESS, variant: Variant::Scalar, parameters, mitsuba_spp, tyndall_spp, arguments: &[] };
    let arguments = ["--threads", "1", "-D", &values[0], "-D", &values[1]];
    let (ours, theirs) = scenes::in_turns(&duel, &arguments, turns, &label, mitsuba, tyndall)?;
    let (mut costs, mut collisions) = (Vec::new(), 0.0);
    for turn in scenes::turns(turns) {
        let report = report(&label, turn)?;
        costs.push(report["ns_per_collision"].as_f64().context("no cost of a collision in the report")?);
        let number = |name: &str| report[name].as_f64().with_context(|| format!("no {name} in the report"));
        collisions = number("collisions")? / number("paths")?;
    }
    Ok(Row {
        albedo,
        thickness,
        tyndall: Side::of(&ours, tyndall_spp),
        mitsuba: theirs.map(|runs| Side::of(&runs, mitsuba_spp)),
        collisions,
        collision: median(&costs),
    })
}

impl Row {
    /// How many times the efficiency of the better Mitsuba tyndall has.
    fn gain(&self) -> f64 {
        self.mitsuba.iter().map(|side| self.tyndall.efficiency_over(side)).fold(f64::INFINITY, f64::min)
    }

    /// CPU seconds until the error is 1 % of the mean: of tyndall, and of the better Mitsuba [s].
    fn costs(&self) -> [f64; 2] {
        let [scalar, llvm] = self.mitsuba.each_ref().map(|side| side.neff);
        [self.tyndall.neff, scalar.max(llvm)].map(|neff| 1e4 / neff)
    }
}

fn table(rows: &[Row]) -> String {
    let mut text = "\n| albedo | mean free paths across | collisions a path | ns each | CPU s to 1 %: tyndall | Mitsuba | ratio |\n\
                    |--:|--:|--:|--:|--:|--:|--:|\n"
        .to_owned();
    for row in rows {
        let ([ours, theirs], gain) = (row.costs().map(figure), figure(row.gain()));
        let Row { albedo, thickness, .. } = row;
        let [collisions, each] = [row.collisions, row.collision].map(figure);
        let _ = writeln!(text, "| {albedo} | {thickness} | {collisions} | {each} | {ours} | {theirs} | {gain} |");
    }
    text
}

fn plot(rows: &[Row]) -> Plot<'_> {
    let panel = |albedo, title| {
        let rows = || rows.iter().filter(move |row| row.albedo == albedo);
        let curve = |name, side: usize| Curve {
            name,
            points: rows().map(|row| [f64::from(row.thickness), row.costs()[side], 0.0]).collect(),
        };
        Panel { title, curves: vec![curve("tyndall", 0), curve("Mitsuba 3.9, the better backend", 1)] }
    };
    Plot {
        across: "mean free paths across",
        up: "CPU seconds until the error is 1 %",
        panels: vec![panel(ALBEDOS[0], "albedo 0.999"), panel(ALBEDOS[1], "albedo 1")],
    }
}
