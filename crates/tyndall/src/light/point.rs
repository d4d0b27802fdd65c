//! A point that shines alike in all directions: irradiance `I / d²` on a plane that faces it.

use super::{LightSample, Reference, Target};
use crate::{
    math::Vec3,
    spectrum::{Spectrum, Wavelengths},
};

/// An isotropic point light.
#[derive(Debug, Clone)]
pub struct PointLight {
    /// Place [length].
    pub position: Vec3,
    /// Intensity [W·sr⁻¹].
    pub intensity: Spectrum,
    /// Luminance of the intensity, for the choice of lights [W·sr⁻¹].
    pub luminance: f32,
}

impl PointLight {
    /// The one direction in which the light is seen.
    #[inline]
    pub fn sample(&self, from: &Reference, wavelengths: &Wavelengths) -> Option<LightSample> {
        let to_light = self.position - from.p;
        let d2 = to_light.length_squared();
        (d2 > 0.0).then(|| LightSample {
            dir: to_light / d2.sqrt(),
            li: self.intensity.eval(wavelengths) / d2,
            pdf: 1.0,
            dirac: true,
            target: Target::Point(self.position),
        })
    }
}
