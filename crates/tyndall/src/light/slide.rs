//! A picture that light from a point shines through: of a projector, or in front of a spot.
//!
//! It stands square to the axis +z of its own space. The direction `(x, y, z)`, z > 0, passes it at
//! `(u, v) = ½ + ½ (x / (z h_x), y / (z h_y))`, where `h_x` and `h_y` are the half sides of the picture in the plane z = 1.

use crate::{
    math::{Transform, Vec2, Vec3, Vec4},
    spectrum::{Lanes, Spectrum, Wavelengths, srgb},
    texture::{Texture, TexturePoint},
};

/// A picture in the way of light.
#[derive(Debug, Clone)]
pub struct Slide {
    /// Its space to world; without a scale.
    pub to_world: Transform,
    /// Half width and half height in the plane z = 1 [1].
    pub half: Vec2,
    /// What passes at each `(u, v)` [1]; more than 1 is brighter than a clear slide.
    pub texture: Texture,
}

impl Slide {
    /// Where light along the unit vector `dir` passes the plane of the picture, and its cosine to the axis; `None` for
    /// light away from it.
    #[inline]
    pub fn place(&self, dir: Vec3) -> Option<(Vec2, f32)> {
        let d = self.to_world.inverse.transform_vector3(dir);
        (d.z > 0.0).then(|| (Vec2::splat(0.5) + 0.5 * Vec2::new(d.x, d.y) / (d.z * self.half), d.z))
    }

    /// Whether a place is on the picture.
    #[inline]
    pub fn holds(uv: Vec2) -> bool {
        (uv.cmpge(Vec2::ZERO) & uv.cmple(Vec2::ONE)).all()
    }

    /// What passes at a place, in the lanes of a path.
    #[inline]
    pub fn filter(&self, uv: Vec2, wavelengths: &Wavelengths) -> Lanes {
        let [p, n] = [self.to_world.matrix.w_axis, self.to_world.matrix.z_axis].map(Vec4::truncate);
        self.texture.eval(&TexturePoint { p, uv: uv.into(), n, part: None }, wavelengths)
    }

    /// Area of the picture in the plane z = 1 [1].
    pub fn area(&self) -> f32 {
        4.0 * self.half.x * self.half.y
    }

    /// The mean over the picture, by its `columns` × `rows` middles, of the luminance of `light` behind it, times
    /// `weight(cos θ)`.
    pub fn mean_luminance(&self, light: &Spectrum, [columns, rows]: [u32; 2], weight: impl Fn(f64) -> f64) -> f64 {
        let light = light.eval(&Wavelengths::Rgb);
        let mut sum = 0.0;
        for row in 0..rows {
            for column in 0..columns {
                let uv = Vec2::new((column as f32 + 0.5) / columns as f32, (row as f32 + 0.5) / rows as f32);
                let passed = light * self.filter(uv, &Wavelengths::Rgb);
                let luminance = srgb::luminance([0, 1, 2].map(|lane| passed.lane(lane)));
                let aside = (2.0 * uv - Vec2::ONE) * self.half;
                let cos = 1.0 / (1.0 + aside.as_dvec2().length_squared()).sqrt();
                sum += f64::from(luminance) * weight(cos);
            }
        }
        sum / (f64::from(columns) * f64::from(rows))
    }
}
