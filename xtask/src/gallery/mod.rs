//! `cargo xtask gallery`: renders what hangs in the gallery ([`rows`]), takes the light of each picture apart, and writes the
//! page `docs/src/gallery.md`.
//!
//! Each picture is rendered with its layers; those of each partition must add up to it, to one unit in the last place, or the
//! call fails. What is told beneath a picture is kept in `docs/src/gallery/rows.json`, so that a call with `--filter` renews
//! only some. `--quick` renders small pictures with few samples into `target/gallery`, checks their sums, and leaves the
//! book as it is.

mod page;
mod rows;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde::{Deserialize, Serialize};

use crate::peers::tyndall::Tyndall;
use crate::shell::{output, root};
use rows::{ENTRIES, Entry};

/// A file of the book may have [bytes].
const MOST_BYTES: u64 = 300_000;
/// By how much `--quick` divides samples.
const QUICKER: u32 = 32;

/// What to render.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Only pictures whose names contain this
    #[arg(long, default_value = "")]
    filter: String,
    /// By how much to multiply the samples of each picture
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    effort: u32,
    /// Small and coarse, into target/gallery only: whether everything works, and adds up
    #[arg(long)]
    quick: bool,
}

/// What is told of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Told {
    width: u32,
    height: u32,
    spp: f64,
    wall_seconds: f64,
    cpu_seconds: f64,
    relative_error: f64,
    non_finite_samples: u64,
    /// A line for each partition of its light
    #[serde(default)]
    sums: Vec<String>,
}

/// Renders, checks, and writes pictures and page.
pub(crate) fn run(options: &Options) -> Result<()> {
    let work = root().join("target/gallery");
    let book = root().join("docs/src/gallery");
    std::fs::create_dir_all(&work)?;
    std::fs::create_dir_all(&book)?;
    let program = Tyndall::find()?;
    let chosen: Vec<&Entry> = ENTRIES.iter().filter(|entry| entry.name.contains(&options.filter)).collect();
    ensure!(!chosen.is_empty(), "no picture's name contains `{}`", options.filter);
    let table = book.join("rows.json");
    let mut rows = read(&table)?;
    let mut large = Vec::new();
    for entry in chosen {
        let told = render(&program, entry, &work, options).with_context(|| entry.name)?;
        eprintln!("━━ {}: {:.0} CPU seconds\n   {}", entry.name, told.cpu_seconds, told.sums.join("\n   "));
        if options.quick {
            continue;
        }
        large.extend(hang(entry, &work, &book)?);
        rows.insert(entry.name.to_owned(), told);
        rows.retain(|name, _| ENTRIES.iter().any(|entry| entry.name == name));
        // After each picture: what has been rendered is in the book, however the call ends.
        std::fs::write(&table, serde_json::to_string_pretty(&rows)? + "\n")?;
        std::fs::write(root().join("docs/src/gallery.md"), page::page(&ENTRIES, &rows, &book))?;
    }
    ensure!(large.is_empty(), "make these smaller, or take more samples:\n{}", large.join("\n"));
    Ok(())
}

/// Image, picture, strips and what there is to tell, in the directory for work.
fn render(program: &Tyndall, entry: &Entry, work: &Path, options: &Options) -> Result<Told> {
    let stem = work.join(entry.name);
    let mut command = command(program, entry, options);
    command.args(["--quiet", "--layers", entry.layers.list(), "-o"]).arg(stem.with_extension("exr"));
    command.arg("-o").arg(stem.with_extension("png")).args(["--json", "-"]);
    let mut told: Told = serde_json::from_str(&output(&mut command)?)?;
    ensure!(told.non_finite_samples == 0, "{} samples are no radiance", told.non_finite_samples);
    let mut apart = Command::new(&program.binary);
    apart.arg("layers").arg(stem.with_extension("exr")).arg("--check").arg("--strips").arg(&stem);
    let lines = output(&mut apart).context("the layers do not add up to the picture")?;
    told.sums = lines.lines().filter(|line| line.starts_with("all = ")).map(str::to_owned).collect();
    Ok(told)
}

/// The call that a reader can repeat.
fn command(program: &Tyndall, entry: &Entry, options: &Options) -> Command {
    let scene = Path::new("scenes").join(entry.scene);
    let mut command = Command::new(&program.binary);
    let spp = if options.quick { (entry.spp / QUICKER).max(2) } else { entry.spp * options.effort };
    command.arg("render").arg(scene).args(["--spp", &spp.to_string()]).args(entry.options).current_dir(root());
    if options.quick {
        command.args(["--resolution", "100x80"]);
    }
    command
}

/// Puts a picture and its strips into the book; tells which of them are too large for it.
fn hang(entry: &Entry, work: &Path, book: &Path) -> Result<Vec<String>> {
    let mut large = Vec::new();
    let strips = entry.layers.groups().iter().map(|group| format!("{}-{group}.png", entry.name));
    for file in std::iter::once(format!("{}.png", entry.name)).chain(strips) {
        let bytes = std::fs::copy(work.join(&file), book.join(&file)).with_context(|| file.clone())?;
        if bytes > MOST_BYTES {
            large.push(format!("{file} has {bytes} bytes, more than {MOST_BYTES}"));
        }
    }
    Ok(large)
}

/// What earlier calls have told.
fn read(table: &Path) -> Result<BTreeMap<String, Told>> {
    if !table.exists() {
        return Ok(BTreeMap::new());
    }
    serde_json::from_str(&std::fs::read_to_string(table)?)
        .with_context(|| format!("{} is of another version: delete it", table.display()))
}
