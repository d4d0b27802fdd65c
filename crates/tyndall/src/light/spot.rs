//! A point that shines into a cone, with a soft rim.

use super::{LightSample, Reference, Slide, Target};
use crate::{
    math::Vec3,
    spectrum::{Spectrum, Wavelengths},
};

/// How intensity falls from full at `cos_inner` to nothing at `cos_outer`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Falloff {
    /// `3x² − 2x³` in the cosine (pbrt-v4).
    SmoothStepCosine,
    /// Linear in the angle (Mitsuba 3).
    LinearAngle,
}

/// A spot light.
#[derive(Debug, Clone)]
pub struct SpotLight {
    /// Place [length].
    pub position: Vec3,
    /// Unit vector along the axis, in the direction of travel.
    pub axis: Vec3,
    /// Intensity on the axis [W·sr⁻¹].
    pub intensity: Spectrum,
    /// Luminance of that intensity, for the choice of lights [W·sr⁻¹].
    pub luminance: f32,
    /// Cosine of the half angle of full intensity [1].
    pub cos_inner: f32,
    /// Cosine of the half angle beyond which no light goes [1].
    pub cos_outer: f32,
    /// The rim between.
    pub falloff: Falloff,
    /// A picture in front of it, if there is one: light beyond its edges sees what its texture has there.
    pub slide: Option<Box<Slide>>,
}

impl SpotLight {
    /// The share of the axial intensity at an angle from the axis.
    #[inline]
    pub fn share(&self, cos_theta: f32) -> f32 {
        if cos_theta >= self.cos_inner {
            return 1.0;
        }
        if cos_theta <= self.cos_outer {
            return 0.0;
        }
        match self.falloff {
            Falloff::SmoothStepCosine => {
                let x = (cos_theta - self.cos_outer) / (self.cos_inner - self.cos_outer);
                x * x * (3.0 - 2.0 * x)
            }
            Falloff::LinearAngle => {
                let (outer, inner) = (self.cos_outer.acos(), self.cos_inner.acos());
                (outer - cos_theta.acos()) / (outer - inner)
            }
        }
    }

    /// The one direction in which the light is seen, inside its cone.
    #[inline]
    pub fn sample(&self, from: &Reference, wavelengths: &Wavelengths) -> Option<LightSample> {
        let to_light = self.position - from.p;
        let d2 = to_light.length_squared();
        let dir = to_light / d2.sqrt();
        let share = self.share(-dir.dot(self.axis));
        if !(d2 > 0.0 && share > 0.0) {
            return None;
        }
        let mut li = self.intensity.eval(wavelengths) * (share / d2);
        if let Some(slide) = &self.slide {
            let (uv, _) = slide.place(-dir)?;
            li *= slide.filter(uv, wavelengths);
        }
        let target = Target::Point(self.position);
        (!li.is_zero()).then_some(LightSample { dir, li, pdf: 1.0, dirac: true, target })
    }

    /// Irradiance made at `p` [W·m⁻²].
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let to_p = p - self.position;
        let d2 = to_p.length_squared().max(f32::MIN_POSITIVE);
        self.luminance * self.share(to_p.dot(self.axis) / d2.sqrt()) / d2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rims_fall_from_one_to_nothing_and_meet_half_way_where_they_must() {
        let spot = |falloff| SpotLight {
            position: Vec3::ZERO,
            axis: Vec3::Z,
            intensity: Spectrum::constant(1.0),
            luminance: 1.0,
            cos_inner: 20f32.to_radians().cos(),
            cos_outer: 30f32.to_radians().cos(),
            falloff,
            slide: None,
        };
        for falloff in [Falloff::SmoothStepCosine, Falloff::LinearAngle] {
            let s = spot(falloff);
            assert_eq!(s.share(1.0), 1.0);
            assert_eq!(s.share(s.cos_outer), 0.0);
        }
        let linear = spot(Falloff::LinearAngle).share(25f32.to_radians().cos());
        assert!((linear - 0.5).abs() < 1e-4, "{linear}");
        let middle = 0.5 * (20f32.to_radians().cos() + 30f32.to_radians().cos());
        let smooth = spot(Falloff::SmoothStepCosine).share(middle);
        assert!((smooth - 0.5).abs() < 1e-4, "{smooth}");
    }
}
