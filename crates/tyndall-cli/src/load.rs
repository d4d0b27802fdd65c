//! From a scene file to a scene, and the names of everything it was read from.

use std::{io::IsTerminal, path::PathBuf, time::Instant};

use tyndall::{film::Crop, scene::Scene, spectrum::ColorMode};
use tyndall_formats::{
    desc::{PartsDesc, SceneDesc},
    error::{Diagnostics, Unsupported},
    film::hash,
    missing::{self, Missing},
    source::SourceMap,
};

use crate::{args::SceneOptions, values::LayerList};

/// A scene, ready to be rendered, and what its file says about rendering it.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    /// What the user wrote.
    pub(crate) desc: SceneDesc,
    /// The texts that it was written in.
    pub(crate) sources: SourceMap,
    pub(crate) crop: Option<Crop>,
    /// Hash over all files and definitions.
    pub(crate) hash: String,
    /// Reading the scene's own files [s].
    pub(crate) load_seconds: f64,
    /// Reading meshes and images and building the scene [s].
    pub(crate) build_seconds: f64,
}

/// Reads and builds a scene, at another resolution and with other layers of light if asked; its colour is what its film needs, if nothing is said.
pub(crate) fn load(
    input: &SceneOptions,
    resolution: Option<[u32; 2]>,
    color: Option<ColorMode>,
    layers: Option<&LayerList>,
) -> anyhow::Result<Loaded> {
    let missing = if input.lenient { Missing::All } else { Missing::Unused };
    load_without(missing, input, resolution, color, layers)
}

/// The same, with grey for some of the pictures that are missing.
pub(crate) fn load_without(
    missing: Missing,
    input: &SceneOptions,
    resolution: Option<[u32; 2]>,
    color: Option<ColorMode>,
    layers: Option<&LayerList>,
) -> anyhow::Result<Loaded> {
    let start = Instant::now();
    let unsupported = if input.lenient { Unsupported::Warn } else { Unsupported::Refuse };
    let (mut desc, sources) = tyndall_formats::load(&input.scene, &input.define, unsupported)?;
    missing::replace(&mut desc, missing);
    if let Some([width, height]) = resolution {
        resize(&mut desc, width, height);
    }
    if let Some(LayerList(layers)) = layers {
        desc.film.parts = PartsDesc { span: None, layers: layers.clone() };
    }
    let load_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let color = color.unwrap_or(desc.film.color());
    let (scene, sources) = tyndall_formats::build::build(&desc, sources, color)?;
    let build_seconds = start.elapsed().as_secs_f64();
    let hash = hash::of_scene(files(&desc, &sources), &input.define)?;
    let crop = tyndall_formats::build::crop(&desc.film);
    Ok(Loaded { scene, desc, sources, crop, hash, load_seconds, build_seconds })
}

impl Loaded {
    /// Tells what was left out of the scene.
    pub(crate) fn warn(&self) {
        if !self.desc.warnings.is_empty() {
            let warnings = Diagnostics::new(self.desc.warnings.clone(), self.sources.clone());
            eprintln!("{}\n", warnings.render(std::io::stderr().is_terminal()));
        }
    }
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

/// Every file that the scene was read from: its texts, then what they name.
fn files(desc: &SceneDesc, sources: &SourceMap) -> Vec<PathBuf> {
    let texts = sources.files().iter().map(|file| &file.path);
    texts.chain(desc.files()).cloned().collect()
}
