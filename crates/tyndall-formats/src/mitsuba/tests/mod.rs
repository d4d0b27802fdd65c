//! The peers' scenes, worked examples of every convention, and tables of errors.

mod conventions;
mod faults;
mod materials;
mod peers;

use std::path::{Path, PathBuf};

use super::*;
use crate::desc::{CameraDesc, LightDesc, MaterialDesc, ShapeDesc};

fn peer(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/peers/mitsuba").join(name)
}

/// A scene with an ordinary sensor, and these elements beside it.
fn scene(elements: &str) -> String {
    format!("<scene version=\"3.0.0\">\n{elements}\n<sensor type=\"perspective\"/></scene>")
}

fn parsed(text: &str) -> SceneDesc {
    parse(Path::new("scene.xml"), text, &[]).map_err(|errors| errors.to_string()).unwrap().0
}

fn shape(element: &str) -> ShapeDesc {
    parsed(&scene(element)).shapes.remove(0)
}

fn material(element: &str) -> MaterialDesc {
    parsed(&scene(element)).materials.remove(0)
}

fn light(element: &str) -> LightDesc {
    parsed(&scene(element)).lights.remove(0)
}

fn camera(parameters: &str) -> CameraDesc {
    parsed(&format!("<scene version=\"3.0.0\"><sensor type=\"perspective\">{parameters}</sensor></scene>")).camera
}
