//! From a scene file to a scene, and the names of everything it was read from.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use tyndall::{film::Crop, scene::Scene, spectrum::ColorMode};
use tyndall_formats::{
    desc::{LightKind, SceneDesc, ShapeKind},
    film::hash,
    source::SourceMap,
};

/// A scene, ready to be rendered, and what its file says about rendering it.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    /// What the user wrote.
    pub(crate) desc: SceneDesc,
    pub(crate) crop: Option<Crop>,
    /// Hash over all files and definitions.
    pub(crate) hash: String,
    /// Reading the scene's own files [s].
    pub(crate) load_seconds: f64,
    /// Reading meshes and images and building the scene [s].
    pub(crate) build_seconds: f64,
}

/// Reads and builds a scene, at another resolution if asked.
pub(crate) fn load(
    path: &Path,
    definitions: &[(String, String)],
    resolution: Option<[u32; 2]>,
    color: ColorMode,
) -> anyhow::Result<Loaded> {
    let start = Instant::now();
    let (mut desc, sources) = tyndall_formats::load(path, definitions)?;
    if let Some([width, height]) = resolution {
        resize(&mut desc, width, height);
    }
    let load_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let (scene, sources) = tyndall_formats::build::build(&desc, sources, color)?;
    let build_seconds = start.elapsed().as_secs_f64();
    let hash = hash::of_scene(files(&desc, &sources), definitions)?;
    let crop = tyndall_formats::build::crop(&desc.film);
    Ok(Loaded { scene, desc, crop, hash, load_seconds, build_seconds })
}

/// Another resolution shows the same picture in other pixels: the scene's crop goes with it.
fn resize(desc: &mut SceneDesc, width: u32, height: u32) {
    let film = &mut desc.film;
    let scale = |x: u32, from: u32, to: u32| (u64::from(x) * u64::from(to) / u64::from(from.max(1))) as u32;
    if let Some(crop) = &mut film.crop {
        crop.x0 = scale(crop.x0, film.width, width);
        crop.y0 = scale(crop.y0, film.height, height);
        crop.x1 = scale(crop.x1, film.width, width).max(crop.x0 + 1);
        crop.y1 = scale(crop.y1, film.height, height).max(crop.y0 + 1);
    }
    (film.width, film.height) = (width, height);
}

/// Every file that the scene was read from: its texts, meshes and environment images, in the order of their mention.
fn files(desc: &SceneDesc, sources: &SourceMap) -> Vec<PathBuf> {
    let texts = sources.files().iter().map(|file| file.path.clone());
    let shapes = desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes));
    let meshes = shapes.filter_map(|shape| match &shape.kind {
        ShapeKind::Ply { path, .. } | ShapeKind::Obj { path, .. } => Some(path.value.clone()),
        _ => None,
    });
    let images = desc.lights.iter().filter_map(|light| match &light.kind {
        LightKind::Environment { path, .. } => Some(path.value.clone()),
        _ => None,
    });
    texts.chain(meshes).chain(images).collect()
}
