//! From what the user wrote to what is rendered: reads meshes and images, converts units, checks the physics.

mod camera;
mod emitters;
mod granular;
pub(crate) mod lights;
pub(crate) mod made;
mod materials;
pub(crate) mod media;
mod meshes;
mod painted;
mod parts;
mod principled;
pub(crate) mod shapes;
pub(crate) mod spectra;
pub(crate) mod strands;
mod textures;
pub(crate) mod triangles;

#[cfg(test)]
mod tests;

use std::{collections::HashMap, path::PathBuf, sync::Arc};

use glam::DMat4;
use tyndall::{
    bsdf::{RoughCoat, measured::Tables},
    film::Crop,
    light::LightTable,
    math::Transform,
    scene::Scene,
    spectrum::ColorMode,
    texture::{Texture, attribute::Painted},
};

use crate::{
    desc::{FilmDesc, MaterialId, MediumId, SceneDesc, TextureId},
    error::{Diagnostics, ErrorList, SceneError},
    source::{SourceMap, Span},
};
use made::Made;
use meshes::Meshes;
use spectra::Measure;
use textures::Pictures;

/// Makes the world of a description. Everything that is wrong with it is found in one go.
///
/// # Errors
/// Files that cannot be read, unknown names of measured data, coefficients that are no physics.
pub fn build(desc: &SceneDesc, sources: SourceMap, color: ColorMode) -> Result<(Scene, SourceMap), Diagnostics> {
    let mut errors = ErrorList::default();
    let scene = Builder::new(desc, &mut errors, color).scene();
    match scene {
        Some(scene) if errors.is_empty() => Ok((scene, sources)),
        _ => Err(errors.into_diagnostics(sources)),
    }
}

/// A scene in the making.
struct Builder<'a> {
    desc: &'a SceneDesc,
    errors: &'a mut ErrorList,
    /// Textures that are made, or were found wrong.
    textures: HashMap<(TextureId, Measure), Option<Texture>>,
    pictures: Pictures,
    /// Measured materials by file.
    measured: Vec<(PathBuf, Arc<Tables>)>,
    /// Coats of rough plastics, each tabulated once.
    coats: Vec<Arc<RoughCoat>>,
    meshes: Meshes,
    /// Colours of meshes: of vertices, and of faces.
    painted: [Arc<Painted>; 2],
    made: Made,
    color: ColorMode,
}

impl<'a> Builder<'a> {
    fn new(desc: &'a SceneDesc, errors: &'a mut ErrorList, color: ColorMode) -> Self {
        Self {
            desc,
            errors,
            textures: HashMap::new(),
            pictures: Pictures::new(),
            measured: Vec::new(),
            color,
            coats: Vec::new(),
            meshes: Meshes::new(desc),
            painted: [Arc::default(), Arc::default()],
            made: Made::new(desc.materials.len()),
        }
    }
}

impl Builder<'_> {
    fn scene(&mut self) -> Option<Scene> {
        if self.desc.film.color() == ColorMode::Spectral && self.color != ColorMode::Spectral {
            return self.fail(
                SceneError::at(self.desc.film.span, "this film records wavelengths, and the render has colours only")
                    .help("render it with --color spectral"),
            );
        }
        // First the shapes: textures may show the colours of meshes.
        let shapes = self.shapes();
        let materials = self.materials();
        let media = self.desc.media.iter().map(|m| self.medium(m)).collect::<Vec<_>>();
        let lights = self.lights();
        let camera = shapes.as_ref().and_then(|shapes| self.camera(shapes));
        let mut materials = materials?;
        materials.extend(self.made.take());
        let media = media.into_iter().collect::<Option<Vec<_>>>()?;
        let (shapes, lights, camera) = (shapes?, lights?, camera?);
        let table = LightTable::new(shapes.lights.into_iter().chain(lights).collect());
        let mut scene = Scene::new(self.color, camera, shapes.geometry, shapes.objects, materials, media, table);
        if let Some(proxied) = shapes.proxied {
            scene = scene.with_proxy(proxied);
        }
        self.check_granular(&scene, &shapes.granular)?;
        self.take_apart(&mut scene, shapes.names)?;
        Some(scene)
    }

    fn transform(&mut self, matrix: DMat4, span: Span) -> Option<Transform> {
        match Transform::new(matrix) {
            Some(transform) => Some(transform),
            None => self.fail(
                SceneError::at(span, "this transform is singular: it squashes space flat, or is not finite")
                    .help("look for a scale of 0, or a look-at whose up points along the view"),
            ),
        }
    }

    /// Notes a fault; the value that could not be made is `None`.
    fn fail<T>(&mut self, error: SceneError) -> Option<T> {
        self.errors.push(error);
        None
    }
}

/// The crop of a film, if it has one.
pub fn crop(film: &FilmDesc) -> Option<Crop> {
    film.crop.map(|c| Crop { min: (c.x0, c.y0), max: (c.x1, c.y1) })
}

fn medium_id(id: MediumId) -> tyndall::medium::MediumId {
    tyndall::medium::MediumId(id.0)
}

fn material_id(id: MaterialId) -> tyndall::scene::MaterialId {
    tyndall::scene::MaterialId(id.0)
}
