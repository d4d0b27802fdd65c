//! Scene languages, meshes, images and film files.
//!
//! ```text
//! scene.pbrt | scene.xml ─▶ load ─▶ SceneDesc   the user's words, spans and units kept
//! ```
//!
//! The readers of the two languages, [`pbrt`] and [`mitsuba`], give the same [`desc::SceneDesc`]. What they do not know is
//! an error that names file, line, column, the word and what to do ([`error`]).

pub mod build;
pub mod desc;
pub mod error;
pub mod film;
mod gzip;
pub mod image;
pub mod mesh;
pub mod mitsuba;
pub mod pbrt;
pub mod source;

use std::path::Path;

use desc::SceneDesc;
use error::{Diagnostics, ErrorList, SceneError};
use source::SourceMap;

/// Reads a scene, in the language that the file's ending names. `overrides` are parameters of the scene (`-D name=value`).
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("pbrt") => pbrt::load(path, overrides),
        Some("xml") => mitsuba::load(path, overrides),
        _ => {
            let mut errors = ErrorList::default();
            errors.push(
                SceneError::new(format!("{} is in no scene language that is known here", path.display()))
                    .help("scenes end in .pbrt (pbrt-v4) or .xml (Mitsuba 3)"),
            );
            Err(errors.into_diagnostics(SourceMap::default()))
        }
    }
}
