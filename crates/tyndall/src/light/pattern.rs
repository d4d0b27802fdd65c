//! What varies over a shining surface: a picture of its light, and holes.
//!
//! The radiance at a point is that of the light times what the texture lets pass there, and light sampling, which does not
//! see holes, takes as much of it as there is surface. Where a sampled point lies on the texture is asked of the surface
//! itself, so that both ways to find the point see the same.

use super::EmitterShape;
use crate::{
    math::{Ray, Vec2, Vec3},
    shape::Shape,
    spectrum::{Lanes, Spectrum, Wavelengths, srgb},
    texture::{Part, Texture, TexturePoint},
};

/// What varies over an emitter.
#[derive(Debug, Clone)]
pub struct Pattern {
    /// A factor on the radiance: at least 0 [1].
    pub texture: Texture,
    /// How much of the surface is there, 0 to 1 [1].
    pub opacity: Texture,
    /// Its surface parameters.
    pub coordinates: Coordinates,
    /// Whose surface it is, if it is that of a shape of the scene.
    pub part: Option<Part>,
}

/// Surface parameters of an emitter.
#[derive(Debug, Clone)]
pub enum Coordinates {
    /// Of a triangle `a, a + e1, a + e2`, or the parallelogram of the same corners: those at these three corners.
    Flat([Vec2; 3]),
    /// Those of a shape in the world.
    Of(Box<Shape>),
}

impl Pattern {
    /// A factor on the radiance at a point, in the lanes of a path.
    #[inline]
    pub fn factor(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Lanes {
        self.texture.eval(at, wavelengths)
    }

    /// How much of the surface is there at a point [1].
    #[inline]
    pub fn opacity(&self, at: &TexturePoint) -> f32 {
        self.opacity.scalar(at).clamp(0.0, 1.0)
    }

    /// The point `p` of `shape`, of unit normal `ng`, as textures see it.
    pub fn texture_point(&self, shape: &EmitterShape, p: Vec3, ng: Vec3) -> TexturePoint {
        let uv = match &self.coordinates {
            Coordinates::Flat([at_a, at_1, at_2]) => {
                let [b1, b2] = shape.weights(p);
                *at_a + (*at_1 - *at_a) * b1 + (*at_2 - *at_a) * b2
            }
            Coordinates::Of(surface) => {
                let height = 1e-3 * shape.bounds().extent().max_element();
                surface.parameters(&Ray::new(p + ng * height, -ng))
            }
        };
        TexturePoint { p, uv: uv.into(), n: ng, part: self.part }
    }

    /// The mean over a surface, by `n²` points of equal areas, of the luminance of `light` under the pattern.
    pub fn mean_luminance(&self, light: &Spectrum, shape: &EmitterShape, n: u32) -> f64 {
        let light = light.eval(&Wavelengths::Rgb);
        let middle = |i: u32| (i as f32 + 0.5) / n as f32;
        let places = (0..n).flat_map(|i| (0..n).map(move |j| Vec2::new(middle(i), middle(j))));
        let luminance = |u: Vec2| {
            let point = shape.sample_area(u);
            let at = self.texture_point(shape, point.p, point.ng);
            let lanes = light * self.factor(&at, &Wavelengths::Rgb) * self.opacity(&at);
            f64::from(srgb::luminance([0, 1, 2].map(|lane| lanes.lane(lane))))
        };
        places.map(luminance).sum::<f64>() / f64::from(n * n)
    }
}
