//! pbrt-v4 scenes.
//!
//! `lexer` makes words of a text, `parser` statements of the words, `directives` carries them out one after the other
//! on the graphics state (`state`), and what they make goes into the [`SceneDesc`]. Includes are read where they stand,
//! relative to the directory of the scene file.
//!
//! Where we differ from pbrt-v4 on purpose:
//! - An unused parameter is an error, and so is any word that would silently change nothing.
//! - Without `"integer maxdepth"` paths have no limit (pbrt: 5).
//! - `Option "string unit" "mm"` says what one scene unit is (default: mm).
//! - `ColorSpace` says what colours are given in; they become linear sRGB (`color_space`), and so does the image.
//! - Nothing moves: things stand where they are at the start time.
//! - Emissive shapes in objects are an error (pbrt leaves their light out).

mod camera;
mod color_space;
mod directives;
mod film;
pub(crate) mod layers;
mod lexer;
mod lights;
mod materials;
mod media;
mod names;
mod param;
mod params;
mod parser;
mod settings;
mod shapes;
pub(crate) mod state;
pub(crate) mod strands;
mod subsurface;
#[cfg(test)]
mod tests;
mod textures;

use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use crate::desc::{
    GroupDesc, Ignored, InstanceDesc, LightDesc, MaterialDesc, MaterialId, MediumDesc, SceneDesc, ShapeDesc,
};
use crate::error::{Diagnostics, ErrorList, SceneError, Unsupported};
use crate::source::{FileId, SourceMap, Span};
use names::Registry;
use parser::Parser;
use settings::Settings;
use state::{Block, State};
use subsurface::Fillings;
use textures::Textures;

/// The deepest chain of includes.
const MAX_INCLUDE_DEPTH: usize = 32;

/// Reads a pbrt scene. It has no parameters, so `overrides` must be empty.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn load(
    path: &Path,
    overrides: &[(String, String)],
    unsupported: Unsupported,
) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut sources = SourceMap::default();
    let mut errors = ErrorList::new(unsupported);
    for (name, _) in overrides {
        errors.push(
            SceneError::new(format!("{} has no parameter \"{name}\" to set", path.display()))
                .help("only Mitsuba scenes have parameters"),
        );
    }
    match errors.ok(sources.read(path, None)) {
        Some(file) => Reader::new(path, sources, errors).read(file),
        None => Err(errors.into_diagnostics(sources)),
    }
}

/// Reads a pbrt scene that is at hand as text. Files that it names are relative to the directory of `path`.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn parse(path: &Path, text: &str) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut sources = SourceMap::default();
    let mut errors = ErrorList::default();
    if let Some(file) = sources.add(path, text) {
        return Reader::new(path, sources, errors).read(file);
    }
    errors.push(SceneError::new("the scene is larger than 1 GiB"));
    Err(errors.into_diagnostics(sources))
}

/// Everything that reading makes and needs.
#[derive(Debug)]
struct Reader {
    sources: SourceMap,
    errors: ErrorList,
    ignored: Vec<Ignored>,
    /// Directory of the scene file.
    dir: Rc<Path>,
    /// Files that are being read, the scene file first, with the place that includes each.
    open: Vec<(PathBuf, Option<Span>)>,
    state: State,
    settings: Settings,
    textures: Textures,
    materials: Registry<MaterialDesc>,
    default_material: Option<MaterialId>,
    media: Registry<MediumDesc>,
    fillings: Fillings,
    groups: Registry<GroupDesc>,
    /// The object that is being defined, and where its definition starts.
    group: Option<(u32, Span)>,
    shapes: Vec<ShapeDesc>,
    instances: Vec<InstanceDesc>,
    lights: Vec<LightDesc>,
}

impl Reader {
    fn new(path: &Path, sources: SourceMap, errors: ErrorList) -> Self {
        Self {
            sources,
            errors,
            ignored: Vec::new(),
            dir: path.parent().unwrap_or(Path::new("")).into(),
            open: Vec::new(),
            state: State::default(),
            settings: Settings::default(),
            textures: Textures::default(),
            materials: Registry::new("material"),
            default_material: None,
            media: Registry::new("medium"),
            fillings: Fillings::default(),
            groups: Registry::new("object"),
            group: None,
            shapes: Vec::new(),
            instances: Vec::new(),
            lights: Vec::new(),
        }
    }

    fn read(mut self, file: FileId) -> Result<(SceneDesc, SourceMap), Diagnostics> {
        let path = self.sources.get(file).map(|f| f.path.clone()).unwrap_or_default();
        let path = path.canonicalize().unwrap_or(path);
        self.run(file, path, None);
        self.finish(Span::new(file, 0, 0))
    }

    /// Carries out the statements of a file.
    fn run(&mut self, file: FileId, path: PathBuf, from: Option<Span>) {
        let Some(text) = self.sources.get(file).map(|f| Arc::clone(&f.text)) else { return };
        self.open.push((path, from));
        let mut parser = Parser::new(file, &text);
        while !self.errors.is_full()
            && let Some(statement) = parser.next_statement(&mut self.errors)
        {
            self.execute(statement);
        }
        self.open.pop();
    }

    /// Reads another file in a scope of its own: what it makes and names stays, what it sets does not.
    fn import(&mut self, name: &str, span: Span) {
        let named = self.state.named_spaces();
        self.checked(|r| r.state.push(Block::Import, span));
        self.include(name, span);
        if !self.errors.is_full() {
            self.checked(|r| r.state.pop(Block::Import, span));
        }
        self.state.restore_named_spaces(named);
    }

    /// Reads another file as if it stood here.
    fn include(&mut self, name: &str, span: Span) {
        // The same file by another name is the same file.
        let path = self.dir.join(name);
        let path = path.canonicalize().unwrap_or(path);
        if let Some((_, from)) = self.open.iter().find(|(open, _)| *open == path) {
            let mut error = SceneError::at(span, format!("{} includes itself", path.display()))
                .help("take the Include out of one of the files");
            if let Some(from) = from {
                error = error.related(*from, "it is being read for this Include");
            }
            self.errors.push(error);
        } else if self.open.len() > MAX_INCLUDE_DEPTH {
            let message = format!("includes are nested more than {MAX_INCLUDE_DEPTH} deep");
            self.errors.push(SceneError::at(span, message).help("does a file include itself by another name?"));
        } else if let Some(file) = self.errors.ok(self.sources.read(&path, Some(span))) {
            let before = self.errors.as_slice().len();
            self.run(file, path, Some(span));
            self.errors.explain(before, span, "included here");
        }
    }

    /// The scene, if nothing was wrong.
    fn finish(mut self, start: Span) -> Result<(SceneDesc, SourceMap), Diagnostics> {
        if self.errors.is_full() {
            // Reading stopped early: what is missing at the end says nothing.
            return Err(self.errors.into_diagnostics(self.sources));
        }
        for opened in self.state.open_blocks().collect::<Vec<_>>() {
            self.errors.push(SceneError::at(opened, "this block is never ended").help("add its End directive"));
        }
        let mut errors = self.errors;
        let settings = self.settings.finish(start, &mut errors);
        let materials = self.materials.finish(&mut errors);
        let mut groups = self.groups.finish(&mut errors);
        self.fillings.check_mixtures(&materials, &mut errors);
        self.fillings.fill(self.shapes.iter_mut().chain(groups.iter_mut().flat_map(|group| &mut group.shapes)));
        let desc = SceneDesc {
            options: settings.options,
            camera: settings.camera,
            film: settings.film,
            sampler: settings.sampler,
            integrator: settings.integrator,
            textures: self.textures.list,
            materials,
            media: self.media.finish(&mut errors),
            shapes: self.shapes,
            groups,
            instances: self.instances,
            lights: self.lights,
            ignored: self.ignored,
            warnings: errors.warnings(),
        };
        errors.finish(desc, self.sources)
    }
}
