//! A point whose intensity in each direction is read from a picture of all of them, as lamps are measured: pbrt's
//! `goniometric`.
//!
//! `I(ω) = I₀ · share(ω)`, the shares on an equal-area octahedral square (Clarberg 2008), constant over a pixel.
//! Power: `Φ = 4π I₀ ⟨share⟩`.

use super::{LightSample, Reference, Target, environment::equal_area_square};
use crate::{
    math::{Transform, Vec3},
    spectrum::{Spectrum, Wavelengths},
};

/// A measured point light.
#[derive(Debug, Clone)]
pub struct Goniometric {
    /// Its space, with +z in the middle of the picture, to world.
    pub to_world: Transform,
    /// Intensity where the share is 1 [W·sr⁻¹].
    pub intensity: Spectrum,
    /// Luminance of that intensity, for the choice of lights [W·sr⁻¹].
    pub luminance: f32,
    /// Pixels a side.
    pub side: u32,
    /// Shares by pixel, row by row, each at least 0 [1].
    pub shares: Vec<f32>,
}

impl Goniometric {
    /// The mean of the shares over all directions [1].
    pub fn mean_share(shares: &[f32]) -> f64 {
        shares.iter().map(|s| f64::from(*s)).sum::<f64>() / shares.len().max(1) as f64
    }

    /// Place [length].
    pub fn position(&self) -> Vec3 {
        self.to_world.matrix.w_axis.truncate()
    }

    /// The share of light along `dir` [1].
    #[inline]
    pub fn share(&self, dir: Vec3) -> f32 {
        let uv = equal_area_square(self.to_world.inverse.transform_vector3(dir).normalize()) * self.side as f32;
        let [x, y] = [uv.x, uv.y].map(|v| (v as u32).min(self.side.saturating_sub(1)));
        self.shares.get(y as usize * self.side as usize + x as usize).copied().unwrap_or(0.0)
    }

    /// The one direction in which the light is seen.
    #[inline]
    pub fn sample(&self, from: &Reference, wavelengths: &Wavelengths) -> Option<LightSample> {
        let position = self.position();
        let to_light = position - from.p;
        let d2 = to_light.length_squared();
        let dir = to_light / d2.sqrt();
        let share = if d2 > 0.0 { self.share(-dir) } else { 0.0 };
        (share > 0.0).then(|| LightSample {
            dir,
            li: self.intensity.eval(wavelengths) * (share / d2),
            pdf: 1.0,
            dirac: true,
            target: Target::Point(position),
        })
    }

    /// Irradiance made at `p` [W·m⁻²].
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let to_p = p - self.position();
        let d2 = to_p.length_squared().max(f32::MIN_POSITIVE);
        self.luminance * self.share(to_p) / d2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{light::environment::equal_area_sphere, math::Vec2};

    fn light(side: u32, shares: Vec<f32>) -> Goniometric {
        Goniometric { to_world: Transform::IDENTITY, intensity: Spectrum::constant(3.0), luminance: 3.0, side, shares }
    }

    /// With the same share everywhere it is a point light: `I/d²`.
    #[test]
    fn an_even_picture_is_a_point_light() {
        let light = light(4, vec![0.5; 16]);
        for p in [Vec3::new(1.0, -2.0, 0.5), Vec3::Z, -Vec3::Z, Vec3::new(0.0, 3.0, 0.0)] {
            let from = Reference { p, normal: None };
            let li = light.sample(&from, &Wavelengths::Rgb).unwrap().li.lane(0);
            assert!((li * p.length_squared() / 1.5 - 1.0).abs() < 1e-6, "{p}: {li}");
            assert!((light.importance(p) / li - 1.0).abs() < 1e-6);
        }
    }

    /// `∫ I dω = 4π I₀ ⟨share⟩`, by directions that have equal areas.
    #[test]
    fn its_power_is_the_mean_of_its_picture() {
        let light = light(5, (0..25).map(|i| (i * 7 % 11) as f32).collect());
        let n = 500;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let uv = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                sum += f64::from(light.share(equal_area_sphere(uv))) / f64::from(n * n);
            }
        }
        let mean = Goniometric::mean_share(&light.shares);
        assert!((sum / mean - 1.0).abs() < 1e-3, "{sum} {mean}");
    }
}
