//! Pictures as textures.
//!
//! Row 0 is the top of the picture, at t = 1: t runs upwards, as in pbrt and as Mitsuba has it after its flip of v. Between
//! the centres of pixels values are linear ([`Interpolation::Bilinear`]) or those of the nearest.
//!
//! In spectral mode a colour becomes a smooth spectrum by interpolation in the table of [`crate::spectrum::uplift_table`].

use std::sync::Arc;

use super::{TexturePoint, mapping::Mapping2};
use crate::{
    math::Vec2,
    spectrum::{Lanes, Wavelengths, srgb, uplift_table},
};

/// Pixels in linear sRGB, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Number of columns, at least 1.
    pub width: u32,
    /// Number of rows, at least 1.
    pub height: u32,
    /// Row by row.
    pub pixels: Vec<[f32; 3]>,
}

/// What is beyond the edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    Repeat,
    /// The picture in a mirror.
    Mirror,
    /// The pixel at the edge.
    Clamp,
    /// Nothing: 0.
    Black,
}

/// What is between the centres of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The nearest pixel.
    Nearest,
    /// A weighted mean of the four around.
    Bilinear,
}

/// The number that a colour stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grey {
    /// The mean of its channels (pbrt-v4).
    Mean,
    /// Its luminance (Mitsuba 3).
    Luminance,
}

impl Grey {
    fn of(self, rgb: [f32; 3]) -> f32 {
        match self {
            Self::Mean => super::mean(rgb),
            Self::Luminance => srgb::luminance(rgb),
        }
    }
}

/// A picture on a surface: a reflectance or a number.
#[derive(Debug, Clone)]
pub struct ImageTexture {
    /// The picture; many textures may show one.
    pub picture: Arc<Picture>,
    /// To the unit square of the picture.
    pub mapping: Mapping2,
    /// Beyond its edges.
    pub wrap: Wrap,
    /// Between its pixels.
    pub interpolation: Interpolation,
    /// A factor on every value [1].
    pub scale: f32,
    /// Whether a value `v` stands for `1 − v`, after the factor.
    pub invert: bool,
    /// What number a colour stands for.
    pub grey: Grey,
    /// The least value: 0 but for heights, which may be negative [1].
    pub least: f32,
    /// The greatest value, for what must be a share of light [1].
    pub most: f32,
}

impl ImageTexture {
    /// Linear sRGB at a point.
    #[inline]
    pub fn rgb(&self, at: &TexturePoint) -> [f32; 3] {
        let st = self.mapping.at(at);
        let found = self.picture.look_up(Vec2::new(st.x, 1.0 - st.y), self.wrap, self.interpolation);
        found.map(|v| {
            let v = v * self.scale;
            (if self.invert { 1.0 - v } else { v }).clamp(self.least, self.most)
        })
    }

    /// One number at a point.
    #[inline]
    pub fn number(&self, at: &TexturePoint) -> f32 {
        self.grey.of(self.rgb(at))
    }

    /// The slope of the number by u and v, within a cell between the centres of four pixels; values are not limited.
    /// `None` where the place does not follow from u and v alone.
    pub fn gradient(&self, at: &TexturePoint) -> Option<Vec2> {
        let Mapping2::Uv(map) = &self.mapping else { return None };
        if self.interpolation == Interpolation::Nearest {
            return Some(Vec2::ZERO);
        }
        let st = self.mapping.at(at);
        let slope = self.picture.slope(Vec2::new(st.x, 1.0 - st.y), self.wrap).map(|rgb| self.grey.of(rgb));
        let by_st = Vec2::new(slope[0], -slope[1]) * if self.invert { -self.scale } else { self.scale };
        Some(map.matrix2.transpose() * by_st)
    }

    /// The lanes of a path at a point.
    #[inline]
    pub fn eval(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> Lanes {
        reflectance(self.rgb(at), wavelengths)
    }
}

/// A colour that filters light, in the lanes of a path.
pub(super) fn reflectance(rgb: [f32; 3], wavelengths: &Wavelengths) -> Lanes {
    match wavelengths {
        Wavelengths::Rgb => Lanes::rgb(rgb[0], rgb[1], rgb[2]),
        Wavelengths::Mono => Lanes::splat(srgb::luminance(rgb)),
        Wavelengths::Spectral { lambda, .. } => {
            let scale = rgb.into_iter().fold(1.0, f32::max);
            let sigmoid = uplift_table::look_up(rgb.map(|v| v / scale));
            Lanes::new(lambda.map(|l| scale * sigmoid.at(l)))
        }
    }
}

impl Picture {
    /// The value at a place, (0, 0) the upper left corner and (1, 1) the lower right one.
    #[inline]
    pub fn look_up(&self, at: Vec2, wrap: Wrap, interpolation: Interpolation) -> [f32; 3] {
        if !at.is_finite() {
            return [0.0; 3];
        }
        let x = f64::from(at.x) * f64::from(self.width);
        let y = f64::from(at.y) * f64::from(self.height);
        if interpolation == Interpolation::Nearest {
            return self.pixel(x.floor() as i64, y.floor() as i64, wrap);
        }
        let (corners, [dx, dy]) = self.cell(x, y, wrap);
        let weights = [(1.0 - dx) * (1.0 - dy), dx * (1.0 - dy), (1.0 - dx) * dy, dx * dy];
        std::array::from_fn(|c| (0..4).map(|i| weights[i] * corners[i][c]).sum())
    }

    /// How fast the bilinear value changes to the right and downwards, over the width and the height of the picture.
    fn slope(&self, at: Vec2, wrap: Wrap) -> [[f32; 3]; 2] {
        if !at.is_finite() {
            return [[0.0; 3]; 2];
        }
        let [width, height] = [self.width, self.height].map(f64::from);
        let (corners, [dx, dy]) = self.cell(f64::from(at.x) * width, f64::from(at.y) * height, wrap);
        let [upper_left, upper_right, lower_left, lower_right] = corners;
        let across = |c: usize, w: f32, [a, b, p, q]: [[f32; 3]; 4]| (b[c] - a[c]) * (1.0 - w) + (q[c] - p[c]) * w;
        let rows = [upper_left, upper_right, lower_left, lower_right];
        let columns = [upper_left, lower_left, upper_right, lower_right];
        [
            std::array::from_fn(|c| across(c, dy, rows) * width as f32),
            std::array::from_fn(|c| across(c, dx, columns) * height as f32),
        ]
    }

    /// The four pixels around a place, in pixels, and how far it is from the first to the others.
    fn cell(&self, x: f64, y: f64, wrap: Wrap) -> ([[f32; 3]; 4], [f32; 2]) {
        let (x, y) = (x - 0.5, y - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let part = [(x - column) as f32, (y - row) as f32];
        let (column, row) = (column as i64, row as i64);
        ([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| self.pixel(column + i, row + j, wrap)), part)
    }

    fn pixel(&self, column: i64, row: i64, wrap: Wrap) -> [f32; 3] {
        match (wrap.index(column, self.width), wrap.index(row, self.height)) {
            (Some(x), Some(y)) => self.pixels[y * self.width as usize + x],
            _ => [0.0; 3],
        }
    }
}

impl Wrap {
    fn index(self, i: i64, size: u32) -> Option<usize> {
        let size = i64::from(size);
        let index = match self {
            Self::Repeat => i.rem_euclid(size),
            Self::Mirror => {
                let i = i.rem_euclid(2 * size);
                i.min(2 * size - 1 - i)
            }
            Self::Clamp => i.clamp(0, size - 1),
            Self::Black => return (0..size).contains(&i).then_some(i as usize),
        };
        Some(index as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    /// 2 × 2 pixels: 0 1 above 2 3.
    fn four() -> Picture {
        Picture { width: 2, height: 2, pixels: [0.0, 1.0, 2.0, 3.0].map(|v| [v; 3]).to_vec() }
    }

    #[test]
    fn beyond_the_edge_comes_what_the_wrapping_says() {
        let at = |x: f32, wrap| four().look_up(Vec2::new(x, 0.25), wrap, Interpolation::Nearest)[0];
        assert_eq!([at(0.25, Wrap::Repeat), at(0.75, Wrap::Repeat), at(1.25, Wrap::Repeat)], [0.0, 1.0, 0.0]);
        assert_eq!([at(1.25, Wrap::Mirror), at(-0.25, Wrap::Mirror), at(-0.75, Wrap::Mirror)], [1.0, 0.0, 1.0]);
        assert_eq!([at(7.0, Wrap::Clamp), at(-7.0, Wrap::Clamp), at(1.25, Wrap::Black)], [1.0, 0.0, 0.0]);
    }

    /// Half way between the four centres lies their mean, 1.5; at a centre the pixel itself.
    #[test]
    fn between_the_centres_of_pixels_values_are_linear() {
        let at = |x: f32, y: f32| four().look_up(Vec2::new(x, y), Wrap::Clamp, Interpolation::Bilinear)[0];
        assert_eq!([at(0.5, 0.5), at(0.25, 0.25), at(0.75, 0.75)], [1.5, 0.0, 3.0]);
        assert_eq!(at(0.5, 0.25), 0.5);
    }

    /// Rec. 709: a pure green of 1 has the luminance 0.7152, and the mean 1/3.
    #[test]
    fn a_colour_stands_for_its_mean_or_for_its_luminance() {
        let texture = |grey| ImageTexture {
            picture: Arc::new(Picture { width: 1, height: 1, pixels: vec![[0.0, 1.0, 0.0]] }),
            mapping: Mapping2::UV,
            wrap: Wrap::Repeat,
            interpolation: Interpolation::Nearest,
            scale: 1.0,
            invert: false,
            grey,
            least: 0.0,
            most: 1.0,
        };
        let at = TexturePoint { p: Vec3::ZERO, uv: Vec2::ZERO.into(), n: Vec3::Z, part: None };
        assert!((texture(Grey::Mean).number(&at) - 1.0 / 3.0).abs() < 1e-6);
        assert!((texture(Grey::Luminance).number(&at) - 0.7152).abs() < 1e-4);
    }

    #[test]
    fn t_runs_upwards_and_inverted_values_are_one_less_the_value() {
        let texture = |invert| ImageTexture {
            picture: Arc::new(four()),
            mapping: Mapping2::UV,
            wrap: Wrap::Repeat,
            interpolation: Interpolation::Nearest,
            scale: 0.25,
            invert,
            grey: Grey::Mean,
            least: 0.0,
            most: 1.0,
        };
        let at = |u: f32, v: f32| TexturePoint { p: Vec3::ZERO, uv: Vec2::new(u, v).into(), n: Vec3::Z, part: None };
        assert_eq!(texture(false).rgb(&at(0.25, 0.25))[0], 0.5); // lower left: 2
        assert_eq!(texture(true).rgb(&at(0.75, 0.25))[0], 0.25); // lower right: 3
    }

    /// The slope is the limit of differences, whatever the mapping, on either side of a pixel's centre.
    #[test]
    fn the_gradient_is_the_limit_of_differences() {
        let picture = Picture { width: 3, height: 2, pixels: [0.0, 1.0, 0.5, 2.0, 0.3, 0.9].map(|v| [v; 3]).to_vec() };
        let turned = glam::Affine2::from_scale_angle_translation(Vec2::new(1.3, 0.7), 0.4, Vec2::new(0.2, 0.1));
        for (mapping, invert) in [(Mapping2::UV, false), (Mapping2::Uv(turned), true)] {
            let texture = ImageTexture {
                picture: Arc::new(picture.clone()),
                mapping,
                wrap: Wrap::Repeat,
                interpolation: Interpolation::Bilinear,
                scale: 0.8,
                invert,
                grey: Grey::Mean,
                least: f32::MIN,
                most: f32::MAX,
            };
            let at =
                |u: f32, v: f32| TexturePoint { p: Vec3::ZERO, uv: Vec2::new(u, v).into(), n: Vec3::Z, part: None };
            for (u, v) in [(0.3, 0.6), (0.05, 0.1), (0.77, 0.93)] {
                let step = 1e-3;
                let difference = |du: f32, dv: f32| {
                    (texture.number(&at(u + du, v + dv)) - texture.number(&at(u - du, v - dv))) / (2.0 * step)
                };
                let expected = Vec2::new(difference(step, 0.0), difference(0.0, step));
                let found = texture.gradient(&at(u, v)).unwrap();
                assert!((found - expected).length() < 2e-3, "{u} {v}: {found} {expected}");
            }
        }
    }
}
