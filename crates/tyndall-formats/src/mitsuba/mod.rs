//! Mitsuba 3 scenes.

use std::path::Path;

use crate::desc::SceneDesc;
use crate::error::{Diagnostics, ErrorList, SceneError};
use crate::source::SourceMap;

/// Reads a Mitsuba scene.
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn load(path: &Path, _overrides: &[(String, String)]) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let mut errors = ErrorList::default();
    errors.push(SceneError::new(format!("{}: Mitsuba scenes cannot be read yet", path.display())));
    Err(errors.into_diagnostics(SourceMap::default()))
}
