//! `cargo xtask words`: a small scene for each word of the scene languages, drawn, and compared where two can draw it.
//!
//! The scenes lie in `scenes/words/mitsuba/KIND-WORD.xml` and `scenes/words/pbrt/KIND-WORD.pbrt`; files without a `-` in
//! their names are pieces that scenes include. A scene of Mitsuba is rendered by Mitsuba 3 too ([`Theirs`]); a scene of pbrt
//! is compared with the scene of the same name in Mitsuba's language, if there is one: they say the same in other words.
//! The rows are kept in `scenes/words/rows.json`, so that a call with `--filter` renews only some, in any clone; the page
//! that is made of them is `docs/src/pictures.md`. The call fails if a scene does not render, or if two renderers differ and the reason is not known:
//! known ones stand in `scenes/words/differences.tsv` ([`known`]).

mod known;
mod page;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use serde::{Deserialize, Serialize};

use crate::collections::comparison::Comparison;
use crate::collections::limits::Limits;
use crate::collections::ours::Ours;
use crate::collections::theirs::Theirs;
use crate::peers::image::Image;
use crate::peers::tyndall::Tyndall;
use crate::shell::root;
use known::Known;

/// Independent renders of each side.
const RUNS: u32 = 4;
/// Probability that one call complains although nothing is wrong, shared among its comparisons.
const FALSE_ALARM: f64 = 0.01;

/// What to draw.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Only scenes whose names contain this
    #[arg(long, default_value = "")]
    filter: String,
    /// Samples a pixel of one render
    #[arg(long, default_value_t = 64)]
    spp: u32,
    /// Wall time of one process [s]
    #[arg(long, default_value_t = 300)]
    seconds: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { filter: String::new(), spp: 64, seconds: 300 }
    }
}

/// A scene's name and its files.
#[derive(Debug, Default)]
struct Scene {
    pbrt: Option<PathBuf>,
    mitsuba: Option<PathBuf>,
}

/// What came of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Row {
    /// KIND-WORD
    name: String,
    /// The languages in which it is there
    languages: Vec<String>,
    /// Our picture of the scene in Mitsuba's language against Mitsuba's
    with_mitsuba: Option<Comparison>,
    /// Our picture of pbrt's scene against ours of Mitsuba's
    with_twin: Option<Comparison>,
}

impl Row {
    fn comparisons(&self) -> impl Iterator<Item = &Comparison> {
        self.with_mitsuba.iter().chain(&self.with_twin)
    }
}

/// Draws and compares, writes `scenes/words/rows.json`, the pictures and `docs/src/pictures.md`.
pub(crate) fn run(options: &Options) -> Result<()> {
    let home = root().join("scenes/words");
    let work = root().join("target/words");
    let pictures = root().join("docs/src/images/words");
    std::fs::create_dir_all(&work)?;
    std::fs::create_dir_all(&pictures)?;
    let limits = Limits { seconds: options.seconds, gibibytes: Some(8) };
    let ours = Ours { binary: Tyndall::find()?.binary, limits };
    let studio = Studio { work: work.clone(), pictures, spp: options.spp, ours, theirs: Theirs::install(limits)? };

    let scenes = scenes(&home)?;
    let known = Known::read(&home.join("differences.tsv"))?;
    ensure!(scenes.keys().any(|name| name.contains(&options.filter)), "no scene's name contains `{}`", options.filter);
    let file = home.join("rows.json");
    let mut rows: BTreeMap<String, Row> = read(&file)?.into_iter().map(|row| (row.name.clone(), row)).collect();
    rows.retain(|name, _| scenes.contains_key(name));
    let mut broken = Vec::new();
    for (name, scene) in scenes.iter().filter(|(name, _)| name.contains(&options.filter)) {
        match studio.draw(name, scene) {
            Ok(row) => {
                let told = row.comparisons().map(|found| found.told(0.0).1).collect::<Vec<_>>();
                eprintln!("━━ {name}: {}", if told.is_empty() { "drawn".to_owned() } else { told.join(" | pbrt: ") });
                rows.insert(name.clone(), row);
            }
            Err(error) => broken.push(format!("{name}: {error:#}")),
        }
        std::fs::write(&file, written(rows.values())?)?;
    }
    let rows: Vec<Row> = rows.into_values().collect();
    let level = testkit::sidak(FALSE_ALARM, rows.iter().flat_map(Row::comparisons).count().max(1));
    std::fs::write(root().join("docs/src/pictures.md"), page::page(&rows, level, &known))?;
    let differing = rows.iter().filter(|row| row.comparisons().any(|found| found.p < level) && !known.explain(row));
    broken.extend(differing.map(|row| format!("{}: the pictures differ", row.name)));
    if !broken.is_empty() {
        bail!("{}", broken.join("\n"));
    }
    Ok(())
}

/// Scenes by name.
fn scenes(home: &Path) -> Result<BTreeMap<String, Scene>> {
    let mut scenes: BTreeMap<String, Scene> = BTreeMap::new();
    for (folder, ending) in [("pbrt", "pbrt"), ("mitsuba", "xml")] {
        for entry in std::fs::read_dir(home.join(folder)).context("scenes/words")? {
            let file = entry?.path();
            let name = file.file_stem().and_then(OsStr::to_str).context("a name that is no text")?.to_owned();
            if file.extension() != Some(OsStr::new(ending)) || !name.contains('-') {
                continue;
            }
            let scene = scenes.entry(name).or_default();
            *(if folder == "pbrt" { &mut scene.pbrt } else { &mut scene.mitsuba }) = Some(file);
        }
    }
    Ok(scenes)
}

/// The rows of earlier calls.
fn read(table: &Path) -> Result<Vec<Row>> {
    if !table.exists() {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(table)?;
    serde_json::from_str(&text).with_context(|| format!("{} is of another version: delete it", table.display()))
}

/// A list with a line for each row, so that two lists of different rows merge.
fn written<'r>(rows: impl Iterator<Item = &'r Row>) -> Result<String> {
    let lines: Vec<String> = rows.map(serde_json::to_string).collect::<std::result::Result<_, _>>()?;
    Ok(format!("[\n{}\n]\n", lines.join(",\n")))
}

/// What every scene is put through.
struct Studio {
    work: PathBuf,
    pictures: PathBuf,
    spp: u32,
    ours: Ours,
    theirs: Theirs,
}

impl Studio {
    fn draw(&self, name: &str, scene: &Scene) -> Result<Row> {
        let shown = scene.pbrt.as_ref().or(scene.mitsuba.as_ref()).context("a scene without files")?;
        let size = self.ours.size(shown, false)?.map_err(|failure| anyhow::anyhow!("{failure:?}"))?;
        let picture = self.work.join(format!("{name}_shown"));
        self.render(shown, size, 4 * self.spp, 0, &picture)?;
        std::fs::copy(picture.with_extension("png"), self.pictures.join(format!("{name}.png")))?;

        let mitsuba = scene.mitsuba.as_deref().map(|file| self.runs(file, size, 1, name)).transpose()?;
        let pbrt = scene.pbrt.as_deref().map(|file| self.runs(file, size, 1001, name)).transpose()?;
        let with_mitsuba = match (&scene.mitsuba, &mitsuba) {
            (Some(file), Some(ours)) => {
                let stem = self.work.join(format!("{name}_theirs_{:016x}", content(file)?));
                let theirs = self.theirs.render(file, size, self.spp, RUNS, &stem)?.map_err(anyhow::Error::msg)?;
                Some(Comparison::of(ours, &theirs)?)
            }
            _ => None,
        };
        let with_twin = match (&pbrt, &mitsuba) {
            (Some(pbrt), Some(mitsuba)) => Some(Comparison::of(pbrt, mitsuba)?),
            _ => None,
        };
        let languages = [("pbrt", pbrt.is_some()), ("Mitsuba", mitsuba.is_some())];
        let languages =
            languages.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| (*name).to_owned()).collect();
        Ok(Row { name: name.to_owned(), languages, with_mitsuba, with_twin })
    }

    fn runs(&self, file: &Path, size: [usize; 2], seed: u32, name: &str) -> Result<Vec<Image>> {
        let image = |run: u32| self.work.join(format!("{name}_{}", seed + run));
        (0..RUNS).map(|run| self.render(file, size, self.spp, seed + run, &image(run))).collect()
    }

    fn render(&self, file: &Path, size: [usize; 2], spp: u32, seed: u32, image: &Path) -> Result<Image> {
        let rendered = self.ours.render(file, size, spp, seed, image)?;
        Ok(rendered.map_err(|failure| anyhow::anyhow!("{failure:?}"))?.image)
    }
}

/// A number for what is in the scene and in whatever lies beside it that is no scene: what Mitsuba drew stays good for it.
fn content(scene: &Path) -> Result<u64> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(scene.parent().context("a scene lies in a directory")?)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<_>>()?;
    files.retain(|file| file == scene || file.file_stem().is_some_and(|name| !name.to_string_lossy().contains('-')));
    files.sort();
    let mut hasher = DefaultHasher::new();
    for file in files.iter().filter(|file| file.is_file()) {
        std::fs::read(file)?.hash(&mut hasher);
    }
    Ok(hasher.finish())
}
