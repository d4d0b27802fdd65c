//! A point that projects a picture: pbrt's `projection` and Mitsuba's `projector`.
//!
//! They differ in what the picture says ([`Even`]): a clear slide gives the same intensity in all directions (pbrt), or the
//! same irradiance `E` all over a wall square to the axis (Mitsuba): `I(θ) = E / cos³θ` with the wall at distance 1.
//!
//! Power: `Φ = ∫ I dω = A ⟨I cos³θ⟩`, the mean over the picture, whose area in the plane z = 1 is `A`.

use super::{LightSample, Reference, Slide, Target};
use crate::{
    math::Vec3,
    spectrum::{Lanes, Spectrum, Wavelengths},
};

/// What is even where the slide is clear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Even {
    /// Intensity (pbrt-v4).
    Intensity,
    /// Irradiance on a wall square to the axis (Mitsuba 3).
    Irradiance,
}

impl Even {
    /// Intensity at an angle from the axis over that on the axis [1].
    #[inline]
    pub fn share(self, cos: f32) -> f32 {
        match self {
            Self::Intensity => 1.0,
            Self::Irradiance => 1.0 / (cos * cos * cos),
        }
    }
}

/// A projector.
#[derive(Debug, Clone)]
pub struct Projector {
    /// Place [length].
    pub position: Vec3,
    /// The picture.
    pub slide: Slide,
    /// Intensity on the axis behind a clear slide [W·sr⁻¹].
    pub intensity: Spectrum,
    /// What is even.
    pub even: Even,
    /// Mean luminance of the intensity over the picture, for the choice of lights [W·sr⁻¹].
    pub luminance: f32,
}

impl Projector {
    /// Intensity along the unit vector `dir` [W·sr⁻¹].
    #[inline]
    pub fn intensity(&self, dir: Vec3, wavelengths: &Wavelengths) -> Lanes {
        match self.slide.place(dir) {
            Some((uv, cos)) if Slide::holds(uv) => {
                self.intensity.eval(wavelengths) * self.slide.filter(uv, wavelengths) * self.even.share(cos)
            }
            _ => Lanes::ZERO,
        }
    }

    /// The one direction in which the light is seen.
    #[inline]
    pub fn sample(&self, from: &Reference, wavelengths: &Wavelengths) -> Option<LightSample> {
        let to_light = self.position - from.p;
        let d2 = to_light.length_squared();
        let dir = to_light / d2.sqrt();
        let li = if d2 > 0.0 { self.intensity(-dir, wavelengths) / d2 } else { Lanes::ZERO };
        (!li.is_zero()).then_some(LightSample { dir, li, pdf: 1.0, dirac: true, target: Target::Point(self.position) })
    }

    /// A guess at the irradiance made at `p` [W·m⁻²]: zero only outside of the picture.
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let to_p = p - self.position;
        let d2 = to_p.length_squared().max(f32::MIN_POSITIVE);
        match self.slide.place(to_p / d2.sqrt()) {
            Some((uv, cos)) if Slide::holds(uv) => self.luminance * self.even.share(cos) / d2,
            _ => 0.0,
        }
    }

    /// Cosine of the angle from the axis to a corner of the picture [1].
    pub fn cos_corner(&self) -> f32 {
        1.0 / (1.0 + self.slide.half.length_squared()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        math::{Transform, Vec2},
        texture::{Grey, ImageTexture, Interpolation, Mapping2, Picture, Texture, Wrap},
    };

    fn projector(texture: Texture, even: Even) -> Projector {
        let slide = Slide { to_world: Transform::IDENTITY, half: Vec2::new(0.75, 0.5), texture };
        Projector { position: Vec3::ZERO, slide, intensity: Spectrum::constant(2.0), even, luminance: 2.0 }
    }

    /// 3 × 2 pixels, brightness by place: row 0 on top, column 0 on the left of one who looks along the axis with +x to
    /// the right.
    fn picture() -> Texture {
        let pixels = (0..6).map(|i| [i as f32; 3]).collect();
        Texture::Image(ImageTexture {
            picture: Arc::new(Picture { width: 3, height: 2, pixels }),
            mapping: Mapping2::UV,
            wrap: Wrap::Clamp,
            interpolation: Interpolation::Nearest,
            scale: 1.0,
            invert: false,
            grey: Grey::Mean,
            least: 0.0,
            most: f32::MAX,
        })
    }

    #[test]
    fn the_picture_stands_upright() {
        let p = projector(picture(), Even::Intensity);
        let at = |x: f32, y: f32, z: f32| p.intensity(Vec3::new(x, y, z).normalize(), &Wavelengths::Rgb).lane(0) / 2.0;
        assert_eq!([at(-0.5, 0.25, 1.0), at(0.0, 0.25, 1.0), at(0.5, 0.25, 1.0)], [0.0, 1.0, 2.0]);
        assert_eq!([at(-0.5, -0.25, 1.0), at(0.0, -0.25, 1.0), at(0.5, -0.25, 1.0)], [3.0, 4.0, 5.0]);
        assert_eq!([at(0.8, 0.0, 1.0), at(0.0, 0.6, 1.0), at(0.0, 0.25, -1.0)], [0.0; 3]);
    }

    /// A clear slide of intensity 2 with half sides a, b: Φ = 2 Ω, and the solid angle of a rectangle seen from its axis is
    /// `4 asin(ab / √((1 + a²)(1 + b²)))`. With an even wall Φ = 2 A, A = 4ab.
    #[test]
    fn its_power_is_that_of_its_window() {
        let grid = [400, 400];
        let cubed = |cos: f64| cos * cos * cos;
        let (a, b) = (0.75f64, 0.5f64);
        let omega = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
        for (even, expected) in [(Even::Intensity, 2.0 * omega), (Even::Irradiance, 2.0 * 4.0 * a * b)] {
            let p = projector(1.0.into(), even);
            let share = |cos: f64| f64::from(even.share(cos as f32)) * cubed(cos);
            let power = f64::from(p.slide.area()) * p.slide.mean_luminance(&p.intensity, grid, share);
            assert!((power / expected - 1.0).abs() < 1e-5, "{even:?}: {power}, expected {expected}");
        }
    }

    /// On a wall at distance 2 the irradiance `I cos θ / d²` is the same everywhere: E / 4.
    #[test]
    fn an_even_wall_is_even() {
        let p = projector(1.0.into(), Even::Irradiance);
        for (x, y) in [(0.0, 0.0), (1.4, 0.9), (-1.0, 0.3)] {
            let on_wall = Vec3::new(x, y, 2.0);
            let s = p.sample(&Reference { p: on_wall, normal: None }, &Wavelengths::Rgb).unwrap();
            assert!((s.li.lane(0) * -s.dir.z / 0.5 - 1.0).abs() < 1e-5, "{on_wall}");
        }
    }
}
