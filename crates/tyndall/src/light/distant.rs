//! Parallel light from infinitely far away.

use super::{LightSample, Target};
use crate::{
    math::Vec3,
    spectrum::{Spectrum, Wavelengths},
};

/// A directional light.
#[derive(Debug, Clone)]
pub struct Distant {
    /// Unit vector towards the light.
    pub towards: Vec3,
    /// Irradiance on a plane that faces it [W·m⁻²].
    pub irradiance: Spectrum,
    /// Its luminance, for the choice of lights [W·m⁻²].
    pub luminance: f32,
}

impl Distant {
    /// The one direction in which the light is seen.
    #[inline]
    pub fn sample(&self, wavelengths: &Wavelengths) -> LightSample {
        LightSample {
            dir: self.towards,
            li: self.irradiance.eval(wavelengths),
            pdf: 1.0,
            dirac: true,
            target: Target::Infinity,
        }
    }
}
