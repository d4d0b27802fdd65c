//! Mitsuba 3 scenes (XML).
//!
//! ```text
//! scene.xml ─▶ tree ─▶ scene ─▶ SceneDesc
//!              XML, includes,   plugins and their
//!              $parameters      parameters, references
//! ```
//!
//! What is read, with Mitsuba's defaults, stands in the book's table of words (docs/src/words.md), which a test makes. Any
//! other word is an error, with the nearest word that is known; a word that Mitsuba has and tyndall does not have yet is said
//! to be that. Words that change nothing here are kept in [`SceneDesc::ignored`].
//!
//! Where Mitsuba's conventions differ from pbrt's, the description says which holds: see [`crate::desc`]. A plain number
//! for a light is white light, as an RGB triple is; for anything else it is the same at every wavelength.

mod aov;
mod bsdf;
mod camera;
mod emitter;
mod hair;
mod integrator;
mod medium;
mod number;
mod object;
mod parameters;
mod principled;
mod scene;
mod shape;
mod spectrum;
mod texture;
mod transform;
mod tree;
mod words;

pub(crate) use aov::word as layer_word;
pub(crate) use bsdf::INDICES;
pub(crate) use camera::{NEAR_CLIP, NO_NEAR_CLIP};
pub(crate) use emitter::facing;
pub(crate) use texture::Answer;
pub(crate) use transform::look_at;

use std::path::Path;

use crate::desc::SceneDesc;
use crate::error::{Diagnostics, ErrorList, SceneError, Unsupported};
use crate::source::{FileId, SourceMap};

/// Reads a Mitsuba scene. `overrides` are its parameters, as `-D name=value` gives them.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn load(
    path: &Path,
    overrides: &[(String, String)],
    unsupported: Unsupported,
) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut sources = SourceMap::default();
    match sources.read(path, None) {
        Ok(file) => read(sources, file, overrides, unsupported),
        Err(error) => Err(Diagnostics::new(vec![error], sources)),
    }
}

/// Reads a Mitsuba scene from a text. Files that it names lie beside `path`, which need not exist.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn parse(path: &Path, text: &str, overrides: &[(String, String)]) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut sources = SourceMap::default();
    if let Some(file) = sources.add(path, text) {
        return read(sources, file, overrides, Unsupported::Refuse);
    }
    let error = SceneError::new(format!("{} is too large", path.display()));
    Err(Diagnostics::new(vec![error], sources))
}

fn read(
    mut sources: SourceMap,
    file: FileId,
    overrides: &[(String, String)],
    unsupported: Unsupported,
) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut errors = ErrorList::new(unsupported);
    let Some(tree) = tree::read(file, overrides, &mut sources, &mut errors) else {
        return Err(errors.into_diagnostics(sources));
    };
    let (scene, mut errors) = scene::build(&tree, &sources, errors);
    if let Some(mut scene) = scene {
        scene.warnings = errors.warnings();
        return errors.finish(scene, sources);
    }
    if errors.is_empty() {
        errors.push(SceneError::new("without what is not known yet, no image is left to be made"));
    }
    Err(errors.into_diagnostics(sources))
}

#[cfg(test)]
mod tests;
