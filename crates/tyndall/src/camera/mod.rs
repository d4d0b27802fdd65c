//! Cameras: from a place on the film and a place on the lens to a ray, and what the sample weighs.
//!
//! A camera looks along +z of its own space, with +x to the right of the image and +y up. The film holds the mean of
//! weight × radiance: radiance [W·m⁻²·sr⁻¹] for weights of 1, irradiance [W·m⁻²] for meters and for lenses in front of a
//! film.

pub mod batch;
pub mod distant;
pub mod irradiance_meter;
pub mod lens;
pub mod orthographic;
pub mod perspective;
pub mod radiance_meter;
pub mod realistic;
pub mod spherical;
pub mod surface;

pub use batch::Batch;
pub use distant::{Distant, Target};
pub use irradiance_meter::IrradianceMeter;
pub use lens::{Element, LensSystem, Stop};
pub use orthographic::Orthographic;
pub use perspective::{Perspective, ThinLens};
pub use radiance_meter::RadianceMeter;
pub use realistic::Realistic;
pub use spherical::{Spherical, SphericalMapping};
pub use surface::Surface;

use crate::{
    film::{Filter, LayerKind},
    math::{Ray, Transform, Vec2, Vec3},
    medium::MediumId,
};

/// A camera and the raster behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Where it stands and how it sees.
    pub view: View,
    /// Image width [pixels].
    pub width: u32,
    /// Image height [pixels].
    pub height: u32,
    /// Reconstruction filter.
    pub filter: Filter,
    /// A factor on every value of the film [1].
    pub exposure: f32,
    /// The medium around the camera, when the scene says so.
    pub medium: Option<MediumId>,
    /// What its film records beside light.
    pub layers: Vec<LayerKind>,
}

/// A model of a camera, in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Camera space to world.
    pub to_world: Transform,
    /// How it sees.
    pub model: CameraModel,
    /// Depth at which the rays of a perspective or an orthographic camera begin [length of its space].
    pub near: f32,
}

/// How places on the film become rays.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraModel {
    /// A pinhole, or a thin lens.
    Perspective(Perspective),
    /// Parallel rays.
    Orthographic(Orthographic),
    /// All directions around a point.
    Spherical(Spherical),
    /// A film behind glass.
    Realistic(Box<Realistic>),
    /// The light that falls on a surface.
    IrradianceMeter(IrradianceMeter),
    /// One ray.
    RadianceMeter(RadianceMeter),
    /// Parallel rays from outside.
    Distant(Distant),
    /// Several views side by side.
    Batch(Batch),
}

/// A ray into the scene, and what the sample weighs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraRay {
    /// Where light is looked for. Of a sample that weighs nothing it is any.
    pub ray: Ray,
    /// A factor on the radiance along it [1]; 0 for a ray that the lens stops, negative where the filter is.
    pub weight: f32,
}

impl Camera {
    /// A ray through pixel `(x, y)` (row 0 on top) for four uniform numbers: two for the place in the filter, two for
    /// the place on the lens.
    #[inline]
    pub fn sample_ray(&self, pixel: (u32, u32), u: [f32; 4]) -> CameraRay {
        self.ray_beside(pixel, u, Vec2::ZERO)
    }

    /// As [`Self::sample_ray`], from a place on the film that lies beside that ray's by `step` [pixels].
    #[inline]
    pub fn ray_beside(&self, pixel: (u32, u32), u: [f32; 4], step: Vec2) -> CameraRay {
        let ([dx, dy], weight) = self.filter.sample([u[0], u[1]]);
        let (x, y) = (pixel.0 as f32 + 0.5 + dx + step.x, pixel.1 as f32 + 0.5 + dy + step.y);
        let place = Vec2::new(x / self.width as f32, y / self.height as f32);
        let sample = self.view.ray(place, Vec2::new(u[2], u[3]));
        CameraRay { weight: weight * sample.weight, ..sample }
    }
}

impl View {
    /// The ray through a `place` of the image, (0, 0) at its upper left and (1, 1) at its lower right corner, and a place
    /// on the lens for two uniform numbers.
    #[inline]
    pub fn ray(&self, place: Vec2, lens: Vec2) -> CameraRay {
        let local = match &self.model {
            CameraModel::Perspective(camera) => camera.ray(place, lens),
            CameraModel::Orthographic(camera) => camera.ray(place),
            CameraModel::Spherical(camera) => camera.ray(place),
            CameraModel::Realistic(camera) => camera.ray(place, lens),
            CameraModel::IrradianceMeter(meter) => return meter.ray(place, lens),
            CameraModel::RadianceMeter(meter) => meter.ray(),
            CameraModel::Distant(camera) => return camera.ray(self.to_world.vector(Vec3::Z).normalize(), lens),
            CameraModel::Batch(batch) => return batch.ray(place, lens),
        };
        let Ray { origin, dir } = local.ray;
        // These have a depth of 1 for each unit of their length.
        let origin = if self.near > 0.0 { origin + dir * self.near } else { origin };
        let ray = Ray::new(self.to_world.point(origin), self.to_world.vector(dir).normalize());
        CameraRay { ray, ..local }
    }
}
