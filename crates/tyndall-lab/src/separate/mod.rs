//! Direct light apart from global light by projected patterns, as Nayar, Krishnan, Grossberg and Raskar (2006) did with a
//! camera and a projector: as a virtual experiment, beside the truth.
//!
//! A projector lights half of its pixels, the others with the part `b` of that ([`Pattern`]). Where its own pixel is lit, a
//! point shows its direct light `L_d` and, of the light `L_g` that reaches it by way of others, what lit and dark pixels give:
//!
//! ```text
//! L⁺ = L_d + (1 + b) L_g/2        lit             L_d = (L⁺ − L⁻)/(1 − b)
//! L⁻ = b L_d + (1 + b) L_g/2      dark            L_g = 2 (L⁻ − b L⁺)/(1 − b²)
//! ```
//!
//! A checkerboard is shifted until each point was lit once and dark once: `L⁺` is the greatest of all its images, `L⁻` the
//! least. A wave of n ≥ 3 phases is seen as `M + A cos(φ + 2πk/n)`, with `M = (1 + b)(L_d + L_g)/2` and
//! `A = (1 − b) L_d/2`, so that `L_d = 2A/(1 − b)` and `L_g = 2M/(1 + b) − L_d`.
//!
//! All of it holds where `L_g` does not notice how the pattern is shifted: where global light comes from afar, and the
//! pattern is fine. It fails in mirrors, and in bodies that are translucent over less than the pattern.
//!
//! The truth comes from one render under a clear slide: direct is what one surface has scattered (`C[RT][LOB]`), all else is
//! global, light that a medium has scattered too.
//!
//! The greatest of noisy numbers is too great. So every picture is taken by two halves of its samples: each half says which
//! picture is the greatest, and the other how great that is. All pictures are taken with the same random numbers.

mod observed;
mod pattern;

use observed::Observed;
pub use observed::{Parts, truth};
pub use pattern::{Pattern, Projection};

use std::sync::Arc;

use glam::{DMat4, Vec3};
use tyndall::{
    camera::CameraModel,
    film::{Film, Filter},
    light::{Even, Light, LightTable, Projector, Slide},
    lpe::{Names, named},
    math::{Transform, Vec2},
    scene::{Emission, Scene},
    spectrum::Spectrum,
    texture::Texture,
};

use crate::world::SetupError;

/// The layer of the film that holds the true direct light.
const DIRECT: &str = "direct_surface";
/// How much wider than the camera sees a projector throws that stands at it \[1\].
pub const MARGIN: f32 = 1.1;

/// Where the projector stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// Where the scene has one.
    Scene,
    /// At the camera, moved by so much in its space (to the right, up, ahead) \[length\].
    Camera(Vec3),
}

/// A scene whose only light is the projector.
#[derive(Debug)]
pub struct Stage(Scene);

/// What patterns have shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The parts of the light.
    pub parts: Parts,
    /// How much brighter direct light would be, by luminance and on average, if one and the same noisy picture said which is
    /// the greatest and how great it is \[radiance\]; of checkerboards.
    pub bias: Option<f64>,
}

impl Stage {
    /// Puts a scene's projector, or one at its camera, in the place of all other lights.
    ///
    /// # Errors
    /// There is no projector in the scene; the camera is none that one could stand at.
    pub fn new(scene: Scene, place: Place) -> Result<Self, SetupError> {
        let projector = match place {
            Place::Scene => of_scene(&scene)?,
            Place::Camera(offset) => at_camera(&scene, offset)?,
        };
        let Scene { color, mut camera, geometry, mut objects, materials, mut media, .. } = scene;
        // A pixel should see little of the pattern, and nothing of it with a negative weight.
        (camera.filter, camera.layers) = (Filter::default(), Vec::new());
        for object in Arc::make_mut(&mut objects) {
            object.emission = Emission::None;
        }
        for medium in Arc::make_mut(&mut media) {
            medium.emission = None;
        }
        let lights = LightTable::new(vec![Light::Projector(Box::new(projector))]);
        let mut scene = Scene::new(color, camera, geometry, objects, materials, media, lights);
        let layer = named::named(DIRECT).map_err(|_| SetupError::Missing("layer of direct light"))?;
        scene.take_apart(&[layer], &Names::default()).map_err(|_| SetupError::Missing("layer of direct light"))?;
        Ok(Self(scene))
    }

    /// The scene as it is lit now.
    pub fn scene(&self) -> &Scene {
        &self.0
    }

    /// Puts a clear slide into the projector.
    pub fn clear(&mut self) {
        self.insert(Spectrum::constant(1.0).into());
    }

    /// Throws all patterns. `render` takes a picture of the scene by two halves of its samples, always with the same random
    /// numbers. `None` if it has none any more: some of the patterns tell nothing.
    pub fn throw(
        &mut self,
        projection: &Projection,
        mut render: impl FnMut(&Scene) -> Option<[Film; 2]>,
    ) -> Option<Outcome> {
        let mut observed = Observed::new(projection.dark);
        for number in 0..projection.pattern.count() {
            self.insert(projection.slide(number));
            observed.add(&render(&self.0)?, projection.pattern.phase(number));
        }
        Some(Outcome { parts: observed.parts(), bias: observed.bias() })
    }

    fn insert(&mut self, texture: Texture) {
        if let Some(Light::Projector(projector)) = Arc::make_mut(&mut self.0.lights).lights.first_mut() {
            projector.slide.texture = texture;
        }
    }
}

/// The scene's own projector.
fn of_scene(scene: &Scene) -> Result<Projector, SetupError> {
    let projector = |light: &Light| match light {
        Light::Projector(projector) => Some((**projector).clone()),
        _ => None,
    };
    let missing = SetupError::Missing("projector in the scene: let it stand at the camera");
    scene.lights.lights.iter().find_map(projector).ok_or(missing)
}

/// One at the camera, that makes a white wall in the middle of the scene shine with radiance 1.
fn at_camera(scene: &Scene, offset: Vec3) -> Result<Projector, SetupError> {
    let CameraModel::Perspective(camera) = &scene.camera.view.model else {
        return Err(SetupError::Missing("place for a projector at this camera: only a perspective one has it"));
    };
    let space = scene.camera.view.to_world;
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| space.vector(axis).normalize());
    let position = space.point(Vec3::ZERO) + axes[0] * offset.x + axes[1] * offset.y + axes[2] * offset.z;
    let distance = scene.geometry.bounds().centre().distance(position).max(f32::MIN_POSITIVE);
    let [left, right, bottom, top] = camera.window.map(f32::abs);
    let half = Vec2::new(left.max(right), bottom.max(top)) * MARGIN + offset.truncate().abs() / distance;
    let columns = [axes[0].extend(0.0), axes[1].extend(0.0), axes[2].extend(0.0), position.extend(1.0)];
    let columns = columns.map(glam::Vec4::as_dvec4);
    let to_world = Transform::new(DMat4::from_cols(columns[0], columns[1], columns[2], columns[3]))
        .ok_or(SetupError::Missing("place for a projector at this camera"))?;
    let intensity = std::f32::consts::PI * distance * distance;
    Ok(Projector {
        position,
        slide: Slide { to_world, half, texture: 1.0.into() },
        intensity: Spectrum::constant(intensity),
        even: Even::Irradiance,
        luminance: intensity,
    })
}
