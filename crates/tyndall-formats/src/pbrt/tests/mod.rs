//! Tests of the pbrt reader.

mod errors;
mod fuzz;
mod materials;
mod scenes;
mod strands;
mod subsurface;
mod textures;
mod values;

use std::path::{Path, PathBuf};

use super::parse;
use crate::desc::SceneDesc;

/// The peers' scenes in the repository.
fn peers() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/peers/pbrt")
}

/// A scene from what comes after `WorldBegin`.
fn world(text: &str) -> SceneDesc {
    scene(&format!("WorldBegin\n{text}"))
}

fn scene(text: &str) -> SceneDesc {
    match parse(Path::new("scene.pbrt"), text) {
        Ok((desc, _)) => desc,
        Err(diagnostics) => panic!("{diagnostics}"),
    }
}
