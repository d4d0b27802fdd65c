//! What varies over surfaces: reflectances, roughnesses, opacities.
//!
//! A [`Texture`] is a tree of patterns and pictures with spectra at its leaves. It answers in two ways: [`Texture::eval`]
//! gives the four lanes of a path, [`Texture::scalar`] one number (a roughness, an opacity, a weight). Where a number is
//! asked of a colour it is the mean of the three channels; a picture says whether it is its luminance instead ([`Grey`]).
//!
//! Textures are looked up at points: there are no ray differentials, and the samples of a pixel do the filtering. Hence
//! pbrt's `trilinear` and `ewa` filters become `bilinear`, and its noise always sums all octaves.
//!
//! Source of the patterns: Pharr, Jakob and Humphreys 2023, § 10.4 and § 10.5; Perlin 2002, "Improving Noise".

pub mod attribute;
pub mod image;
pub mod mapping;
pub mod noise;
pub mod pattern;

use std::sync::Arc;

pub use attribute::Attribute;
pub use image::{Grey, ImageTexture, Interpolation, Picture, Wrap};
pub use mapping::{Mapping2, Mapping3};
pub use noise::Noise;

use crate::{
    math::{Vec2, Vec3},
    shape::{Interaction, Uv},
    spectrum::{Lanes, Spectrum, Wavelengths},
};

/// Where a texture is looked up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexturePoint {
    /// The point in the world [length].
    pub p: Vec3,
    /// Surface parameters.
    pub uv: Uv,
    /// Shading normal.
    pub n: Vec3,
    /// Whose surface it is, if it is that of a shape of the scene.
    pub part: Option<Part>,
}

/// A part of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Index of the object.
    pub object: u32,
    /// Index of the triangle, or 0.
    pub prim: u32,
    /// The placed copy of it, or [`crate::shape::Hit::NO_INSTANCE`].
    pub instance: u32,
}

impl From<&Interaction> for TexturePoint {
    #[inline]
    fn from(hit: &Interaction) -> Self {
        let part = Part { object: hit.object.0, prim: hit.prim, instance: hit.instance };
        Self { p: hit.p, uv: hit.uv, n: hit.ns, part: Some(part) }
    }
}

/// A quantity that may vary over a surface.
#[derive(Debug, Clone)]
pub enum Texture {
    /// The same everywhere.
    Constant(Spectrum),
    /// A picture.
    Image(ImageTexture),
    /// Colours of the mesh itself.
    Attribute(Attribute),
    /// A number that wanders at random through space.
    Noise(Noise),
    /// pbrt's marble: a veined grey.
    Marble(pattern::Marble),
    /// The product of two.
    Scale(Arc<[Texture; 2]>),
    /// `(1 − w)·a + w·b`.
    Mix {
        /// a and b.
        of: Arc<[Texture; 2]>,
        /// w.
        by: Arc<Weight>,
    },
    /// Between four corners of the parameter square, bilinearly.
    Bilinear {
        /// At (0, 0), (1, 0), (0, 1) and (1, 1).
        corners: Arc<[Texture; 4]>,
        /// To the parameter square.
        mapping: Mapping2,
    },
}

/// How much of the second of two textures there is [1].
#[derive(Debug, Clone)]
pub enum Weight {
    /// As another texture says.
    Texture(Texture),
    /// The absolute cosine between the shading normal and a unit vector.
    Direction(Vec3),
    /// 0 and 1 on the fields of a board.
    Checkerboard(pattern::Checkerboard),
    /// 1 within dots, 0 between them.
    Dots(Mapping2),
}

impl From<Spectrum> for Texture {
    fn from(spectrum: Spectrum) -> Self {
        Self::Constant(spectrum)
    }
}

impl From<f32> for Texture {
    fn from(value: f32) -> Self {
        Self::Constant(Spectrum::constant(value))
    }
}

impl Texture {
    /// The lanes of a path at a point.
    #[inline]
    pub fn eval(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(spectrum) => spectrum.eval(wavelengths),
            varying => varying.vary(at, &|leaf| leaf.lanes(at, wavelengths), Lanes::splat),
        }
    }

    /// One number at a point.
    #[inline]
    pub fn scalar(&self, at: &TexturePoint) -> f32 {
        match self {
            Self::Constant(Spectrum::Constant(value)) => *value,
            varying => varying.vary(at, &|leaf| leaf.number(at), |value| value),
        }
    }

    /// How fast [`Self::scalar`] changes with u and v \[1\], where the place changes by `tangents` [length]: exactly for
    /// pictures and their products; for others by a step of 0.0005 (which is pbrt's where it knows of no pixels).
    pub fn gradient(&self, at: &TexturePoint, tangents: [Vec3; 2]) -> Vec2 {
        match self {
            Self::Constant(_) => Vec2::ZERO,
            Self::Scale(of) => {
                let [a, b] = [0, 1].map(|i| of[i].gradient(at, tangents));
                a * of[1].scalar(at) + b * of[0].scalar(at)
            }
            Self::Image(image) => image.gradient(at).unwrap_or_else(|| self.difference(at, tangents)),
            _ => self.difference(at, tangents),
        }
    }

    fn difference(&self, at: &TexturePoint, [du, dv]: [Vec3; 2]) -> Vec2 {
        const STEP: f32 = 0.0005;
        let (here, uv) = (self.scalar(at), at.uv.get());
        let along = |tangent: Vec3, axis: Vec2| {
            let moved = uv + axis * STEP;
            // What is left of the step after rounding.
            let step = (moved - uv).dot(axis);
            let there = TexturePoint { p: at.p + tangent * STEP, uv: moved.into(), ..*at };
            (self.scalar(&there) - here) / if step > 0.0 { step } else { STEP }
        };
        Vec2::new(along(du, Vec2::X), along(dv, Vec2::Y))
    }

    /// Red, green and blue at a point, as they stand in a picture.
    pub fn rgb(&self, at: &TexturePoint) -> [f32; 3] {
        self.vary(at, &|leaf| leaf.channels(at), Vec3::splat).to_array()
    }

    /// The spectrum, if it is the same everywhere.
    pub fn constant(&self) -> Option<&Spectrum> {
        match self {
            Self::Constant(spectrum) => Some(spectrum),
            _ => None,
        }
    }

    /// How many leaves a look-up may visit: what a cautious reader limits.
    pub fn cost(&self) -> u64 {
        let sum = |parts: &[Self]| parts.iter().fold(1u64, |sum, part| sum.saturating_add(part.cost()));
        match self {
            Self::Constant(_) | Self::Image(_) | Self::Attribute(_) | Self::Noise(_) | Self::Marble(_) => 1,
            Self::Scale(of) => sum(of.as_slice()),
            Self::Mix { of, by } => match by.as_ref() {
                Weight::Texture(weight) => sum(of.as_slice()).saturating_add(weight.cost()),
                Weight::Direction(_) | Weight::Checkerboard(_) | Weight::Dots(_) => sum(of.as_slice()),
            },
            Self::Bilinear { corners, .. } => sum(corners.as_slice()),
        }
    }

    /// The patterns, for lanes and for numbers alike; `leaf` answers where nothing is combined.
    fn vary<T>(&self, at: &TexturePoint, leaf: &impl Fn(&Self) -> T, splat: impl Fn(f32) -> T + Copy) -> T
    where
        T: std::ops::Add<Output = T> + std::ops::Mul<Output = T>,
    {
        match self {
            Self::Scale(of) => of[0].vary(at, leaf, splat) * of[1].vary(at, leaf, splat),
            Self::Mix { of, by } => {
                let w = by.at(at);
                // One of them alone is not looked up in vain.
                if w == 0.0 {
                    return of[0].vary(at, leaf, splat);
                }
                if w == 1.0 {
                    return of[1].vary(at, leaf, splat);
                }
                splat(1.0 - w) * of[0].vary(at, leaf, splat) + splat(w) * of[1].vary(at, leaf, splat)
            }
            Self::Bilinear { corners, mapping } => {
                let Vec2 { x: s, y: t } = mapping.at(at);
                let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
                let part = |i: usize| splat(weights[i]) * corners[i].vary(at, leaf, splat);
                part(0) + part(1) + part(2) + part(3)
            }
            Self::Constant(_) | Self::Image(_) | Self::Attribute(_) | Self::Noise(_) | Self::Marble(_) => leaf(self),
        }
    }

    fn lanes(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(spectrum) => spectrum.eval(wavelengths),
            Self::Image(image) => image.eval(at, wavelengths),
            Self::Attribute(attribute) => image::reflectance(attribute.rgb(at), wavelengths),
            Self::Marble(marble) => image::reflectance(marble.rgb(at), wavelengths),
            other => Lanes::splat(other.number(at)),
        }
    }

    fn channels(&self, at: &TexturePoint) -> Vec3 {
        match self {
            Self::Constant(Spectrum::Constant(value)) => Vec3::splat(*value),
            Self::Constant(spectrum) => Vec3::from_array(spectrum.rgb()),
            Self::Image(image) => Vec3::from_array(image.rgb(at)),
            Self::Attribute(attribute) => Vec3::from_array(attribute.rgb(at)),
            Self::Marble(marble) => Vec3::from_array(marble.rgb(at)),
            other => Vec3::splat(other.number(at)),
        }
    }

    fn number(&self, at: &TexturePoint) -> f32 {
        match self {
            Self::Constant(Spectrum::Constant(value)) => *value,
            Self::Constant(spectrum) => mean(spectrum.rgb()),
            Self::Image(image) => image.number(at),
            Self::Attribute(attribute) => mean(attribute.rgb(at)),
            Self::Marble(marble) => mean(marble.rgb(at)),
            Self::Noise(noise) => noise.at(at.p),
            Self::Scale(_) | Self::Mix { .. } | Self::Bilinear { .. } => self.scalar(at),
        }
    }
}

impl Weight {
    fn at(&self, at: &TexturePoint) -> f32 {
        match self {
            Self::Texture(texture) => texture.scalar(at),
            Self::Direction(dir) => at.n.dot(*dir).abs(),
            Self::Checkerboard(board) => board.at(at),
            Self::Dots(mapping) => f32::from(u8::from(pattern::in_a_dot(mapping.at(at)))),
        }
    }
}

fn mean([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) * (1.0 / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(u: f32, v: f32) -> TexturePoint {
        TexturePoint { p: Vec3::new(u, v, 0.0), uv: Vec2::new(u, v).into(), n: Vec3::Z, part: None }
    }

    fn pair(a: f32, b: f32) -> Arc<[Texture; 2]> {
        Arc::new([a.into(), b.into()])
    }

    /// 0.25·2 + 0.75·6 = 5, for numbers and in every lane.
    #[test]
    fn a_mix_weighs_its_second_part_by_the_weight() {
        let mix = Texture::Mix { of: pair(2.0, 6.0), by: Arc::new(Weight::Texture(0.75.into())) };
        assert_eq!(mix.scalar(&at(0.3, 0.4)), 5.0);
        assert_eq!(mix.eval(&at(0.3, 0.4), &Wavelengths::Rgb), Lanes::splat(5.0));
        assert_eq!(Texture::Scale(pair(2.0, 6.0)).scalar(&at(0.0, 0.0)), 12.0);
    }

    /// At (s, t) the corners weigh (1−s)(1−t), s(1−t), (1−s)t, st: with corners 0, 1, 0, 1 the value is s, with 0, 0, 1, 1
    /// it is t.
    #[test]
    fn a_bilinear_texture_is_linear_along_both_parameters() {
        let corners =
            |c: [f32; 4]| Texture::Bilinear { corners: Arc::new(c.map(Texture::from)), mapping: Mapping2::UV };
        for (u, v) in [(0.0, 0.0), (0.25, 0.5), (1.0, 0.75)] {
            assert_eq!(corners([0.0, 1.0, 0.0, 1.0]).scalar(&at(u, v)), u);
            assert_eq!(corners([0.0, 0.0, 1.0, 1.0]).scalar(&at(u, v)), v);
        }
    }

    /// `|n · d|`: along the direction and against it the second part, across it the first.
    #[test]
    fn a_mix_by_direction_is_alike_on_both_sides() {
        let seen = |n: Vec3| {
            let mix = Texture::Mix { of: pair(1.0, 3.0), by: Arc::new(Weight::Direction(Vec3::Y)) };
            mix.scalar(&TexturePoint { n, ..at(0.0, 0.0) })
        };
        assert_eq!([seen(Vec3::Y), seen(-Vec3::Y), seen(Vec3::X)], [3.0, 3.0, 1.0]);
        assert!((seen(Vec3::new(0.8, -0.6, 0.0)) - 2.2).abs() < 1e-6);
    }

    /// Each level doubles the leaves: 2ⁿ and the nodes above them, 2ⁿ⁺¹ − 1.
    #[test]
    fn the_cost_of_a_look_up_counts_every_path_through_shared_parts() {
        let mut texture = Texture::from(0.5);
        for _ in 0..10 {
            texture = Texture::Scale(Arc::new([texture.clone(), texture]));
        }
        assert_eq!(texture.cost(), (1 << 11) - 1);
    }
}
