//! `cargo xtask collections DIR`: other people's scenes through tyndall, and through Mitsuba 3 where they are its own.
//!
//! Each scene of the collection's table ([`sources`]) is loaded and rendered in a process of its own, with an end to its
//! time and memory ([`limits`]). What comes of it is one of: not yet (a word that is known not to be known yet), refused,
//! broken, rendered; and then compared with Mitsuba's picture ([`theirs`]) by the tests of [`crate::peers::statistics`], or
//! with the image that its author published ([`published`]). The rows are kept in `target/collections/report.json`, so
//! that a call with `--filter` or `--unsettled` renews only some, and told in `docs/src/collections.md`.

pub(crate) mod comparison;
pub(crate) mod limits;
pub(crate) mod ours;
mod published;
mod report;
mod sources;
pub(crate) mod theirs;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;

use crate::peers::tyndall::Tyndall;
use crate::shell::root;
use comparison::Comparison;
use limits::Limits;
use ours::{Failure, Ours};
use published::Likeness;
use report::{Outcome, Row};
use sources::{Language, Source};
use theirs::Theirs;

/// Probability that one call complains although nothing is wrong, shared among its scenes.
const FALSE_ALARM: f64 = 0.01;
/// Independent renders of each side.
const RUNS: u32 = 4;

/// What to run.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// The collection: a directory with a table `sources.tsv`
    directory: PathBuf,
    /// Only scenes whose files contain this
    #[arg(long, default_value = "")]
    filter: String,
    /// Only scenes that neither agreed nor rendered at the last call
    #[arg(long)]
    unsettled: bool,
    /// Samples a pixel of one render
    #[arg(long, default_value_t = 16)]
    spp: u32,
    /// Width of the pictures, or about that [pixels]
    #[arg(long, default_value_t = 128)]
    width: usize,
    /// Wall time of one process [s]
    #[arg(long, default_value_t = 120)]
    seconds: u32,
    /// Address space of one process of tyndall [GiB]
    #[arg(long, default_value_t = 8)]
    gibibytes: u64,
}

/// Runs the scenes, writes `target/collections/report.json` and `docs/src/collections.md`.
pub(crate) fn run(options: &Options) -> Result<()> {
    let collection = options.directory.canonicalize().context("the collection is not there")?;
    let work = root().join("target/collections");
    std::fs::create_dir_all(&work)?;
    let limits = Limits { seconds: options.seconds, gibibytes: Some(options.gibibytes) };
    let ours = Ours { binary: Tyndall::find()?.binary, limits };
    let theirs = Theirs::install(limits)?;
    let bench = Bench { collection, work: work.clone(), spp: options.spp, width: options.width, ours, theirs };

    let sources = sources::read(&bench.collection)?;
    let level = testkit::sidak(FALSE_ALARM, sources.len());
    let file = work.join("report.json");
    let earlier = report::read(&file)?;
    let mut rows = Vec::new();
    for source in sources {
        let known = earlier.iter().find(|row| row.source.file == source.file);
        let is_settled = known.is_some_and(|row| !row.told(level).0.contains("**") && !row.is_not_yet());
        let is_wanted = source.file.to_string_lossy().contains(&options.filter) && !(options.unsettled && is_settled);
        if !is_wanted {
            rows.extend(known.cloned());
            continue;
        }
        let row = bench.settle(source)?;
        let (word, remark) = row.told(level);
        eprintln!("━━ {}: {word}: {remark}", row.source.file.display());
        rows.push(row);
        let others = earlier.iter().filter(|old| rows.iter().all(|row| row.source.file != old.source.file));
        let all: Vec<Row> = rows.iter().chain(others).cloned().collect();
        std::fs::write(&file, serde_json::to_string_pretty(&all)?)?;
    }
    ensure!(!rows.is_empty(), "no scene's file contains `{}`", options.filter);
    std::fs::write(&file, serde_json::to_string_pretty(&rows)?)?;
    std::fs::write(root().join("docs/src/collections.md"), report::page(&rows, level))?;
    Ok(())
}

/// What every scene is put through.
struct Bench {
    collection: PathBuf,
    work: PathBuf,
    spp: u32,
    width: usize,
    ours: Ours,
    theirs: Theirs,
}

impl Bench {
    fn settle(&self, source: Source) -> Result<Row> {
        let scene = self.collection.join(&source.file);
        let stem = self.work.join(source.file.to_string_lossy().replace(['/', ' ', '.'], "_"));
        let size = match self.ours.size(&scene, false)? {
            Ok(size) => small(size, self.width),
            Err(failure) => return self.failed(source, &scene, failure, &stem),
        };
        if source.language == Language::Mitsuba {
            self.compare_with_mitsuba(source, &scene, size, &stem)
        } else {
            self.compare_with_published(source, &scene, size, &stem)
        }
    }

    /// Who is to blame: if Mitsuba refuses its own scene too, the scene is.
    fn failed(&self, source: Source, scene: &Path, failure: Failure, stem: &Path) -> Result<Row> {
        let row = |source, outcome| Ok(Row { source, outcome, seconds: None });
        if matches!(failure, Failure::Refused(_) | Failure::FileMissing(_)) {
            if let Some(verdict) = source.verdict.clone() {
                return row(source, Outcome::Wrong(verdict));
            }
            if source.language == Language::Mitsuba {
                let trial = stem.with_extension("trial");
                if let Err(message) = self.theirs.render(scene, [16, 16], 1, 1, &trial)? {
                    return row(source, Outcome::Wrong(format!("Mitsuba refuses it too: {message}")));
                }
            }
        }
        let lenient = matches!(failure, Failure::NotYet(_)) && self.ours.size(scene, true)?.is_ok();
        row(source, Outcome::Failed { failure, lenient })
    }

    fn compare_with_mitsuba(&self, source: Source, scene: &Path, size: [usize; 2], stem: &Path) -> Result<Row> {
        let theirs = self.theirs.render(scene, size, self.spp, RUNS, &stem.with_extension("mitsuba"))?;
        let runs = if theirs.is_ok() { RUNS } else { 1 };
        let (mut images, mut seconds) = (Vec::new(), None);
        for run in 0..runs {
            let image = PathBuf::from(format!("{}_{run}", stem.display()));
            match self.ours.render(scene, size, self.spp, 1 + run, &image)? {
                Ok(picture) => {
                    seconds = seconds.or(Some((picture.load_seconds, picture.render_seconds)));
                    images.push(picture.image);
                }
                Err(failure) => return self.failed(source, scene, failure, stem),
            }
        }
        let outcome = match theirs {
            Err(message) => Outcome::Rendered(format!("Mitsuba does not render it: {message}")),
            Ok(theirs) => Comparison::of(&images, &theirs)
                .map_or_else(|error| Outcome::Rendered(format!("not compared: {error}")), Outcome::Compared),
        };
        Ok(Row { source, outcome, seconds })
    }

    fn compare_with_published(&self, source: Source, scene: &Path, size: [usize; 2], stem: &Path) -> Result<Row> {
        let picture = match self.ours.render(scene, size, self.spp, 1, stem)? {
            Ok(picture) => picture,
            Err(failure) => return self.failed(source, scene, failure, stem),
        };
        let outcome = match &source.reference {
            None if picture.image.pixels.iter().flatten().all(|&value| value == 0.0) => {
                Outcome::Rendered("a black picture".to_owned())
            }
            None => Outcome::Rendered("no image beside it".to_owned()),
            Some(reference) => {
                let file = self.collection.join(reference);
                let published = self.theirs.read_image(&file, &stem.with_extension("npy"))?;
                Outcome::Published(Likeness::of(&picture.image, &published, published::is_clipped(&file)))
            }
        };
        Ok(Row { source, outcome, seconds: Some((picture.load_seconds, picture.render_seconds)) })
    }
}

/// A size with the same ratio of sides, exactly: Mitsuba keeps the angle of the whole picture. As wide as `width` at most,
/// or the least that there is.
fn small([width, height]: [usize; 2], at_most: usize) -> [usize; 2] {
    let (mut divisor, mut rest) = (width, height);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    let unit = [width / divisor.max(1), height / divisor.max(1)];
    unit.map(|side| side * (at_most / unit[0].max(1)).clamp(1, divisor.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_size_keeps_the_ratio_of_the_sides() {
        assert_eq!(small([1280, 720], 128), [128, 72]);
        assert_eq!(small([683, 512], 128), [683, 512], "no smaller one has this ratio");
        assert_eq!(small([64, 64], 128), [64, 64], "no larger than the scene's own");
        assert_eq!(small([960, 720], 128), [128, 96]);
    }
}
