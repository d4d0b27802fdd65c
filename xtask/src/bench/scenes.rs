//! Efficiency, `1/(MSE · CPU s)`, against both backends of Mitsuba, in turns.

use std::path::Path;

use anyhow::{Context, Result};

use super::judge;
use crate::peers::mitsuba::Mitsuba;
use crate::peers::runs::{Runs, Side, Turn, images};
use crate::peers::settings::{Duel, Variant, duels};
use crate::peers::statistics::{Tails, tails};
use crate::peers::tyndall::Tyndall;
use crate::peers::{directory, scene_file};

/// Scenes, and how many times the efficiency of the better Mitsuba is asked.
const SCENES: [(&str, f64); 2] = [("g_cornell", 1.5), ("d_fog_box", 1.5)];
const BACKENDS: [Variant; 2] = [Variant::Scalar, Variant::Llvm];

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    race_all(&SCENES, tyndall, turns)
}

/// Measures scenes and prints how many times the efficiency of the better Mitsuba each has.
pub(super) fn race_all(scenes: &[(&str, f64)], tyndall: &Tyndall, turns: u32) -> Result<()> {
    let mitsuba = Mitsuba::install()?;
    crate::peers::bodies::write_bodies()?;
    for duel in &duels() {
        if let Some((_, target)) = scenes.iter().find(|(scene, _)| *scene == duel.scene) {
            race(duel, *target, turns, &mitsuba, tyndall)?;
        }
    }
    Ok(())
}

fn race(duel: &Duel, target: f64, turns: u32, mitsuba: &Mitsuba, tyndall: &Tyndall) -> Result<()> {
    let label = directory(duel.scene)?.join("tyndall");
    let (ours, theirs) = in_turns(duel, duel.arguments, turns, &label, mitsuba, tyndall)?;
    let told = |runs: &[Runs]| {
        let Tails { excess_kurtosis, largest } = tails(&images(runs));
        format!("excess kurtosis {excess_kurtosis:.2}, largest pixel {largest:.0} errors up")
    };
    let tails = told(&ours);
    let ours = Side::of(&ours, duel.tyndall_spp);
    println!("{}: tyndall {:.3e} 1/(MSE·CPU s); {tails}", duel.scene, ours.efficiency);
    let mut worst = f64::INFINITY;
    for (backend, runs) in BACKENDS.iter().zip(&theirs) {
        let side = Side::of(runs, duel.mitsuba_spp);
        let ratio = ours.efficiency_over(&side);
        let (name, tails) = (backend.name(), told(runs));
        println!("{}: Mitsuba {name} {:.3e}; {tails}; tyndall is {ratio:.2}×", duel.scene, side.efficiency);
        worst = worst.min(ratio);
    }
    judge(&format!("{} over the better Mitsuba", duel.scene), worst, "×", worst >= target, &format!("{target}×"));
    Ok(())
}

/// The turns of a race.
pub(super) fn turns(count: u32) -> impl Iterator<Item = Turn> {
    Turn::all(count, 2)
}

/// Renders with both backends of Mitsuba and with tyndall, in turns; `label` names the files of the latter, which stand beside those of
/// the others.
pub(super) fn in_turns(
    duel: &Duel,
    arguments: &[&str],
    count: u32,
    label: &Path,
    mitsuba: &Mitsuba,
    tyndall: &Tyndall,
) -> Result<(Vec<Runs>, [Vec<Runs>; 2])> {
    let rivals = BACKENDS.map(|variant| Duel { variant, ..duel.clone() });
    let directory = label.parent().context("a file in a directory")?;
    let (mut ours, mut theirs) = (Vec::new(), [Vec::new(), Vec::new()]);
    for turn in turns(count) {
        for (rival, runs) in rivals.iter().zip(&mut theirs) {
            runs.push(mitsuba.render(rival, turn, directory, false)?);
        }
        ours.push(tyndall.render(&scene_file(duel.scene), duel.tyndall_spp, turn, label, arguments)?);
    }
    Ok((ours, theirs))
}
