//! From a description back to a scene file, in either language.
//!
//! ```text
//! A.xml ─▶ load ─▶ SceneDesc ─▶ write ─▶ B.pbrt, and files beside it: meshes that the language cannot say in words, skies
//! ```
//!
//! What is written reads back to the same picture, bit for bit: every number is the shortest that reads back to the same
//! bits, and a placement is written in words (`Translate`, `lookat`) only where they make the same matrix, else in numbers.
//! What the language has no word for is an error that names the place in the file that was read, or, if the user is
//! [lenient](Unsupported::Warn), left out with a warning and a comment on top of the new file.
//!
//! Each writer has a `match` without a rest over every kind of thing in [`crate::desc`]: a new kind is asked for by the
//! compiler.

mod mesh;
mod mitsuba;
mod names;
mod number;
mod pbrt;
mod place;
mod sheet;
mod sky;

use std::path::{Path, PathBuf};

use crate::build::made::parts;
use crate::desc::{MaterialDesc, MaterialId, MaterialKind, SceneDesc, Span};
use crate::error::{Diagnostics, ErrorList, SceneError, Unsupported};
use crate::source::SourceMap;
use names::{Names, for_a_file};

/// A scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// pbrt-v4's.
    Pbrt,
    /// Mitsuba 3's.
    Mitsuba,
}

impl Language {
    /// The language of a file, by its ending.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "pbrt" => Some(Self::Pbrt),
            "xml" => Some(Self::Mitsuba),
            _ => None,
        }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pbrt => "pbrt",
            Self::Mitsuba => "Mitsuba",
        }
    }
}

/// A scene as text, and what goes with it.
#[derive(Debug)]
pub struct Written {
    /// The scene file.
    pub text: String,
    /// Meshes and pictures to lie beside it, by their paths.
    pub beside: Vec<(PathBuf, Vec<u8>)>,
    /// What is not the same, and what was left out.
    pub warnings: Vec<SceneError>,
}

/// Writes a scene that was read from `sources`, as the file `target`. Nothing is written to the disk.
///
/// # Errors
/// Everything in the scene that the language has no word for, unless that is only to be warned of; and a `target` whose
/// ending names no language.
pub fn write(
    desc: &SceneDesc,
    sources: &SourceMap,
    target: &Path,
    unsupported: Unsupported,
) -> Result<Written, Diagnostics> {
    let Some(language) = Language::of(target) else {
        let error = SceneError::new(format!("{} is in no scene language that is known here", target.display()))
            .help("scenes end in .pbrt (pbrt-v4) or .xml (Mitsuba 3)");
        return Err(Diagnostics::new(vec![error], SourceMap::default()));
    };
    let mut draft = Draft {
        desc,
        language,
        directory: std::path::absolute(target)
            .ok()
            .and_then(|path| path.parent().map(Path::to_owned))
            .unwrap_or_default(),
        stem: target.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned()),
        errors: ErrorList::new(unsupported),
        beside: Vec::new(),
    };
    let body = match language {
        Language::Pbrt => pbrt::scene(&mut draft),
        Language::Mitsuba => mitsuba::scene(&mut draft),
    };
    if !draft.errors.is_empty() {
        return Err(draft.errors.into_diagnostics(sources.clone()));
    }
    let warnings = draft.errors.warnings();
    let header = header(desc, sources, &warnings);
    let text = match language {
        Language::Pbrt => pbrt::commented(&header) + &body,
        Language::Mitsuba => mitsuba::commented(&header) + &body,
    };
    Ok(Written { text, beside: draft.beside, warnings })
}

/// Where the scene comes from, and what became of it on the way.
fn header(desc: &SceneDesc, sources: &SourceMap, warnings: &[SceneError]) -> Vec<String> {
    let source = sources.files().first().map(|file| file.path.file_name().unwrap_or_default().to_string_lossy());
    let mut lines = vec![format!("From {}, by tyndall convert.", source.unwrap_or_default())];
    let read = desc.warnings.iter().map(|warning| (warning, "when it was read: "));
    let mut seen = std::collections::HashSet::new();
    for (warning, what) in read.chain(warnings.iter().map(|warning| (warning, ""))) {
        if seen.insert(warning.message.clone()) {
            let place = warning.span.map(|span| format!(" ({})", sources.place(span))).unwrap_or_default();
            lines.push(format!("{what}{}{place}", warning.message));
        }
    }
    lines
}

/// A scene file in the making: what both languages need.
struct Draft<'a> {
    desc: &'a SceneDesc,
    language: Language,
    /// Where the file will lie.
    directory: PathBuf,
    /// Its name without the ending.
    stem: String,
    errors: ErrorList,
    beside: Vec<(PathBuf, Vec<u8>)>,
}

impl Draft<'_> {
    /// Reports something that the language has no word for.
    fn lacks(&mut self, span: Span, what: &str) {
        let message = format!("{} has no word for {what}", self.language.name());
        let error = SceneError::not_yet(span, message).help("change it, or leave it out with --lenient");
        self.errors.push(error);
    }

    /// Warns of something that is not quite the same there.
    fn differs(&mut self, span: Span, message: &str) {
        self.errors.push(SceneError::warning(span, message));
    }

    /// Whether a material is part of such others only, which say it where they stand.
    fn stands_inside(&self, id: MaterialId, wholes: fn(&MaterialKind) -> bool) -> bool {
        let desc = self.desc;
        let mut shapes = desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes));
        let is_part = |of: &&MaterialDesc| parts(&of.kind).iter().any(|part| part.value == id);
        let mut owners = desc.materials.iter().filter(is_part).peekable();
        owners.peek().is_some() && owners.all(|of| wholes(&of.kind)) && !shapes.any(|s| s.material.value == id)
    }

    /// The name of a file with these bytes beside the new scene, called after it and `wanted`. The same bytes twice are one
    /// file.
    fn file_beside(&mut self, span: Span, wanted: &str, ending: &str, bytes: Vec<u8>) -> String {
        let known = self.beside.iter().find(|(_, known)| *known == bytes).map(|(path, _)| path.clone());
        let path = known.unwrap_or_else(|| {
            let name = format!("{}-{}.{ending}", for_a_file(&self.stem), self.free_name(wanted));
            let path = self.directory.join(name);
            self.beside.push((path.clone(), bytes));
            path
        });
        self.relative(&path, span)
    }

    /// `wanted`, with a number if that is taken: neither a file that was just made nor one that the scene names is written
    /// over.
    fn free_name(&self, wanted: &str) -> String {
        let mut names = Names::default();
        let prefix = format!("{}-", for_a_file(&self.stem));
        for path in self.beside.iter().map(|(path, _)| path).chain(self.desc.files()) {
            let stem = path.file_stem().and_then(|stem| stem.to_str());
            if let Some(taken) = stem.and_then(|stem| stem.strip_prefix(&prefix)) {
                names.unique(Some(taken), "");
            }
        }
        names.unique(Some(&for_a_file(wanted)), "file")
    }

    /// A file as seen from the directory of the new scene.
    fn relative(&mut self, path: &Path, span: Span) -> String {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let relative = relative(&path, &self.directory);
        if let Some(name) = relative.to_str() {
            return name.replace('\\', "/");
        }
        let message = format!("the name {} is not UTF-8", relative.display());
        self.errors.push(SceneError::at(span, message).help("rename the file"));
        String::new()
    }
}

/// `path`, as it is reached from `directory`; both are absolute.
fn relative(path: &Path, directory: &Path) -> PathBuf {
    let common = path.components().zip(directory.components()).take_while(|(a, b)| a == b).count();
    // On another drive there is no way from here to there.
    if common == 0 {
        return path.to_owned();
    }
    let up = directory.components().skip(common).map(|_| Path::new(".."));
    up.chain(path.components().skip(common).map(|part| Path::new(part.as_os_str()))).collect()
}
