//! One picture at four sizes: a cube of frosted glass with scattering inside, lengths divided by 1 to 1000 and coefficients multiplied.
//!
//! Nothing in the transport equation knows the size. Who starts rays at a fixed distance from a surface does: Mitsuba 3 moves them off by
//! `RayEpsilon (1 + max |p|)` (`Interaction::offset_p`), of which the 1 does not shrink with the scene. In a medium that skips the first
//! collisions behind the boundary.

use std::fmt::Write as _;

use anyhow::Result;
use testkit::Mean;

use super::judge;
use crate::peers::image::Image;
use crate::peers::mitsuba::Mitsuba;
use crate::peers::runs::{Runs, Turn, images};
use crate::peers::settings::{Duel, Variant};
use crate::peers::tyndall::Tyndall;
use crate::peers::{SCALE, directory, scene_file};

/// By what lengths are divided.
const DIVISORS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
const SPP: u32 = 512;
const RUNS: u32 = 4;

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    let mitsuba = Mitsuba::install()?;
    let mut rows = Vec::new();
    for divisor in DIVISORS {
        rows.push(measure(divisor, turns, &mitsuba, tyndall)?);
    }
    println!("{}", table(&rows));
    let [[whole, _], .., [small, _]] = &rows[..] else { return Ok(()) };
    let p = small.agrees_with(whole).p;
    judge("tyndall at a thousandth of the size: p of the same light", p, "", p > 1e-4, "above 1e-4");
    Ok(())
}

/// Both sides at one size.
fn measure(divisor: f64, turns: u32, mitsuba: &Mitsuba, tyndall: &Tyndall) -> Result<[Mean; 2]> {
    let directory = directory(&format!("{SCALE}/{divisor}"))?;
    let place = |p: [f64; 3]| p.map(|x| (x / divisor).to_string()).join(",");
    let values = [
        format!("half={}", 20.0 / divisor),
        format!("eye={}", place([60.0, 45.0, 95.0])),
        format!("lamp={}", place([0.0, 0.0, 60.0])),
        format!("spot={}", place([0.0, 0.0, 20.0])),
        format!("intensity={}", 1e5 / (divisor * divisor)),
        format!("density={}", 3.0071 * divisor),
    ];
    let duel = Duel {
        scene: SCALE,
        variant: Variant::Llvm,
        parameters: values.join(" "),
        mitsuba_spp: SPP,
        tyndall_spp: SPP,
        arguments: &[],
    };
    let arguments: Vec<&str> = values.iter().flat_map(|value| ["-D", value]).collect();
    let (mut ours, mut theirs): (Vec<Runs>, Vec<Runs>) = (Vec::new(), Vec::new());
    for turn in Turn::all(turns, RUNS) {
        theirs.push(mitsuba.render(&duel, turn, &directory, false)?);
        ours.push(tyndall.render(&scene_file(SCALE), SPP, turn, &directory.join("tyndall"), &arguments)?);
    }
    Ok([ours, theirs].map(|runs| images(&runs).iter().map(brightness).collect()))
}

/// The mean of a picture.
fn brightness(image: &Image) -> f64 {
    let values = image.pixels.iter().flatten();
    values.map(|&value| f64::from(value)).sum::<f64>() / (3 * image.pixels.len()) as f64
}

fn table(rows: &[[Mean; 2]]) -> String {
    let mut text = "\n| width of the cube | tyndall | Mitsuba |\n|--:|--:|--:|\n".to_owned();
    for (divisor, [ours, theirs]) in DIVISORS.iter().zip(rows) {
        let _ = writeln!(text, "| {} | {ours} | {theirs} |", 40.0 / divisor);
    }
    text
}
