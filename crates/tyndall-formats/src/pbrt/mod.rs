//! pbrt-v4 scenes.

use std::path::Path;

use crate::desc::SceneDesc;
use crate::error::{Diagnostics, ErrorList, SceneError};
use crate::source::SourceMap;

/// Reads a pbrt-v4 scene.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn load(path: &Path, _overrides: &[(String, String)]) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut errors = ErrorList::default();
    errors.push(SceneError::new(format!("{}: pbrt scenes cannot be read yet", path.display())));
    Err(errors.into_diagnostics(SourceMap::default()))
}
