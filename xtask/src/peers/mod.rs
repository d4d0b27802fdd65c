//! `cargo xtask peers`: the scenes of `scenes/peers` through tyndall and through its peers.
//!
//! Mitsuba's scenes are rendered by both, in turns so that both meet the same weather on the machine. For each:
//! do the pictures agree ([`statistics`]), and which renderer is more efficient. Efficiency is `1/(MSE · CPU s)` of
//! one run; the error is the spread between independent runs, so no reference is needed.
//!
//! pbrt-v4 cannot be installed from a registry, so its scenes are rendered by tyndall alone, in RGB and in spectral
//! colour: their luminances differ where coloured light meets coloured things (the red wall of the Cornell box under its
//! orange lamp is 9 % brighter in RGB, in one reflection), and nowhere else.

pub(crate) mod bodies;
pub(crate) mod image;
pub(crate) mod mitsuba;
pub(crate) mod report;
pub(crate) mod runs;
pub(crate) mod settings;
pub(crate) mod statistics;
pub(crate) mod tyndall;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;

use crate::shell::root;
use image::Image;
use mitsuba::Mitsuba;
use report::{ColourRow, DuelRow};
use runs::{Runs, Side, Turn, images};
use settings::Duel;
use statistics::compare;
use tyndall::Tyndall;

/// Probability that one call complains although nothing is wrong, shared among its scenes.
const FALSE_ALARM: f64 = 0.01;

/// What to compare.
#[derive(Debug, Default, Args)]
pub(crate) struct Options {
    /// Only scenes whose names contain this
    #[arg(long, default_value = "")]
    filter: String,
    /// A quarter of the samples, four runs instead of ten
    #[arg(long)]
    quick: bool,
    /// Take Mitsuba's runs of an earlier call where they were the same; their times are of that day then
    #[arg(long)]
    reuse: bool,
    /// Mitsuba against itself: no call of tyndall, half of the runs against the other half. Shows what agreement is
    #[arg(long)]
    control: bool,
}

/// The cube that is so many mean free paths across.
pub(crate) const THICKNESS: &str = "thickness";
/// The cube that comes in several sizes.
pub(crate) const SCALE: &str = "scale";

/// A scene of Mitsuba's in the repository, or one of those that [`bodies`] makes.
pub(crate) fn scene_file(scene: &str) -> PathBuf {
    if [THICKNESS, SCALE].contains(&scene) {
        return root().join(format!("xtask/scenes/{scene}.xml"));
    }
    if scene.ends_with(bodies::MESHED) || scene == bodies::HAIR {
        return root().join(format!("target/bench/{scene}.xml"));
    }
    root().join(format!("scenes/peers/mitsuba/{scene}.xml"))
}

/// Compares, prints the tables, writes `target/peers/report.json` and `report.md`; fails where pictures disagree.
pub(crate) fn run(options: &Options) -> Result<()> {
    let mitsuba = Mitsuba::install()?;
    bodies::write_bodies()?;
    let tyndall = if options.control { None } else { Some(Tyndall::find()?) };
    let mut failures = Vec::new();
    let mut keep = |name: &str, error: anyhow::Error| {
        eprintln!("error: {name}: {error:#}");
        failures.push(name.to_owned());
    };

    let mut duels = Vec::new();
    for duel in settings::duels().into_iter().filter(|duel| duel.scene.contains(&options.filter)) {
        eprintln!("━━ peers: {}", duel.scene);
        match fight(&duel, options, &mitsuba, tyndall.as_ref()) {
            Ok(row) => {
                eprintln!("{}", row.told());
                duels.push(row);
            }
            Err(error) => keep(duel.scene, error),
        }
    }
    let mut colours = Vec::new();
    if let Some(tyndall) = &tyndall {
        for scene in pbrt_scenes(&options.filter)? {
            eprintln!("━━ peers: {}", scene.display());
            match compare_colours(&scene, options, tyndall) {
                Ok(row) => {
                    eprintln!("{}", row.told());
                    colours.push(row);
                }
                Err(error) => keep(&scene.display().to_string(), error),
            }
        }
    }

    let level = testkit::sidak(FALSE_ALARM, duels.len());
    let table = report::tables(&duels, &colours, level);
    println!("{table}");
    let directory = directory("")?;
    std::fs::write(directory.join("report.md"), &table)?;
    let report = serde_json::json!({ "quick": options.quick, "level": level, "mitsuba": duels, "pbrt": colours });
    std::fs::write(directory.join("report.json"), serde_json::to_string_pretty(&report)?)?;

    failures.extend(duels.iter().filter(|row| row.disagrees(level)).map(|row| row.scene.clone()));
    ensure!(
        !duels.is_empty() || !colours.is_empty() || !failures.is_empty(),
        "no scene is called `{}`",
        options.filter
    );
    if !failures.is_empty() {
        bail!("peers: {} of the scenes failed or disagree: {}", failures.len(), failures.join(", "));
    }
    Ok(())
}

/// Renders one scene with both, in turns, and compares. Without tyndall, Mitsuba's odd turns stand in for it.
fn fight(duel: &Duel, options: &Options, mitsuba: &Mitsuba, tyndall: Option<&Tyndall>) -> Result<DuelRow> {
    let mut duel = duel.clone();
    if options.quick {
        duel.mitsuba_spp = duel.mitsuba_spp.div_ceil(4);
        duel.tyndall_spp = duel.tyndall_spp.div_ceil(4);
    }
    let directory = directory(duel.scene)?;
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for turn in Turn::all(if options.quick { 2 } else { 5 }, 2) {
        let peer = mitsuba.render(&duel, turn, &directory, options.reuse)?;
        match tyndall {
            None if turn.index % 2 == 1 => ours.push(peer),
            None => theirs.push(peer),
            Some(tyndall) => {
                theirs.push(peer);
                let label = directory.join("tyndall");
                ours.push(tyndall.render(&scene_file(duel.scene), duel.tyndall_spp, turn, &label, duel.arguments)?);
            }
        }
    }
    let agreement = compare(&images(&ours), &images(&theirs))?;
    let theirs = Side::of(&theirs, duel.mitsuba_spp);
    let ours = Side::of(&ours, if tyndall.is_some() { duel.tyndall_spp } else { duel.mitsuba_spp });
    Ok(DuelRow {
        scene: duel.scene.to_owned(),
        setting: format!("{} {}", mitsuba.available(duel.variant).name(), duel.parameters),
        efficiency_ratio: ours.efficiency_over(&theirs),
        agreement,
        tyndall: ours,
        mitsuba: theirs,
    })
}

/// Renders one pbrt scene in RGB and in spectral colour, in turns, and compares luminances.
fn compare_colours(scene: &Path, options: &Options, tyndall: &Tyndall) -> Result<ColourRow> {
    let name = scene.file_stem().context("a scene has a name")?.to_string_lossy().into_owned();
    let directory = directory(&name)?;
    let spp = if options.quick { 4 } else { 16 };
    let (mut rgb, mut spectral) = (Vec::new(), Vec::new());
    for turn in Turn::all(2, 2) {
        rgb.push(tyndall.render(scene, spp, turn, &directory.join("rgb"), &["--color", "rgb"])?);
        spectral.push(tyndall.render(scene, spp, turn, &directory.join("spectral"), &["--color", "spectral"])?);
    }
    let luminances = |turns: &[Runs]| images(turns).iter().map(Image::luminance).collect::<Vec<_>>();
    Ok(ColourRow {
        scene: name,
        agreement: compare(&luminances(&rgb), &luminances(&spectral))?,
        rgb: Side::of(&rgb, spp),
        spectral: Side::of(&spectral, spp),
    })
}

/// The pbrt scenes of the repository.
fn pbrt_scenes(filter: &str) -> Result<Vec<PathBuf>> {
    let directory = root().join("scenes/peers/pbrt");
    if !directory.is_dir() {
        eprintln!("━━ SKIPPED: no pbrt scenes at {}", directory.display());
        return Ok(Vec::new());
    }
    let mut scenes: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.ends_with(".pbrt") && name.contains(filter) {
            scenes.push(path.clone());
        }
    }
    scenes.sort();
    Ok(scenes)
}

/// `target/peers/NAME`, made if need be.
pub(crate) fn directory(name: &str) -> Result<PathBuf> {
    let directory = root().join("target/peers").join(name);
    std::fs::create_dir_all(&directory)?;
    Ok(directory)
}
