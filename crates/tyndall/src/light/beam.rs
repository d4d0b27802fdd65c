//! A flat surface that shines along its normal only: Mitsuba's `directionalarea`.
//!
//! Its light does not spread: a plane square to it has the irradiance `M` of the surface's radiant exitance wherever the
//! surface is straight above it, near or far, and nothing elsewhere. So it is a Dirac in direction, which only light
//! sampling finds: the way back is the normal.

use super::{EmitterShape, LightSample, Reference, Target};
use crate::{
    math::{Vec3, rounding::gamma},
    spectrum::{Spectrum, Wavelengths},
};

/// A collimated surface.
#[derive(Debug, Clone)]
pub struct Beam {
    /// A flat piece of surface.
    pub shape: EmitterShape,
    /// Radiant exitance [W·m⁻²].
    pub exitance: Spectrum,
    /// Its luminance, for the choice of lights [W·m⁻²].
    pub luminance: f32,
}

impl Beam {
    /// The one direction in which the light is seen, within its beam.
    #[inline]
    pub fn sample(&self, from: &Reference, wavelengths: &Wavelengths) -> Option<LightSample> {
        let (ng, foot) = self.foot(from.p)?;
        Some(LightSample {
            dir: -ng,
            li: self.exitance.eval(wavelengths),
            pdf: 1.0,
            dirac: true,
            target: Target::Surface { p: foot, error: (foot.abs() + from.p.abs()) * gamma(8), ng },
        })
    }

    /// Irradiance made at `p` [W·m⁻²].
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        if self.foot(p).is_some() { self.luminance } else { 0.0 }
    }

    /// The side that shines, and the point of the surface straight above `p`.
    fn foot(&self, p: Vec3) -> Option<(Vec3, Vec3)> {
        let ng = self.shape.normal()?;
        let height = self.shape.height(p).filter(|h| *h > 0.0)?;
        let foot = p - ng * height;
        self.shape.holds(foot).then_some((ng, foot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_shines_straight_ahead_and_nowhere_else() {
        let shapes = [
            EmitterShape::Triangle { a: Vec3::ZERO, e1: Vec3::X, e2: Vec3::Y, ng: Vec3::Z },
            EmitterShape::Parallelogram { a: Vec3::ZERO, e1: Vec3::X, e2: Vec3::Y, ng: Vec3::Z },
            EmitterShape::Disk { centre: Vec3::new(0.3, 0.3, 0.0), ng: Vec3::Z, radius: 0.3, inner: 0.0 },
        ];
        for shape in shapes {
            let beam = Beam { shape, exitance: Spectrum::constant(5.0), luminance: 5.0 };
            let at = |x: f32, y: f32, z: f32| {
                let from = Reference { p: Vec3::new(x, y, z), normal: None };
                beam.sample(&from, &Wavelengths::Rgb).map_or(0.0, |s| s.li.lane(0) * -s.dir.z)
            };
            assert_eq!([at(0.3, 0.3, 0.1), at(0.3, 0.3, 100.0)], [5.0; 2], "{shape:?}");
            assert_eq!([at(0.3, 0.3, -0.1), at(1.2, 0.3, 0.1), at(0.3, -0.1, 0.1)], [0.0; 3], "{shape:?}");
        }
    }
}
