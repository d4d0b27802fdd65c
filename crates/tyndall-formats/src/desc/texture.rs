//! What varies over surfaces.

use glam::DMat4;

use super::{FileRef, Span, Spanned, SpectrumDesc};

/// A texture of [`SceneDesc::textures`](super::SceneDesc::textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// A quantity that may vary over a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Varying {
    /// It does not.
    Everywhere(SpectrumDesc),
    /// As a texture says.
    Texture(TextureId),
}

impl From<SpectrumDesc> for Varying {
    fn from(spectrum: SpectrumDesc) -> Self {
        Self::Everywhere(spectrum)
    }
}

impl Varying {
    /// The same number everywhere.
    pub const fn constant(value: f64) -> Self {
        Self::Everywhere(SpectrumDesc::Constant(value))
    }

    /// The number, if it is the same everywhere and at every wavelength.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Everywhere(SpectrumDesc::Constant(value)) => Some(*value),
            _ => None,
        }
    }
}

/// A texture. Parts are ids of textures that the file defined before.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureDesc {
    /// The words that made it.
    pub span: Span,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// What kind.
    pub kind: TextureKind,
}

/// What kind of texture.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureKind {
    /// Another value: pbrt's `constant`, or a name for another texture.
    Plain(Spanned<Varying>),
    /// A product.
    Scale([Spanned<Varying>; 2]),
    /// `(1 − amount)·of[0] + amount·of[1]`.
    Mix {
        /// What is mixed.
        of: [Spanned<Varying>; 2],
        /// How much of the second.
        amount: Spanned<Varying>,
    },
    /// `|n·dir|·of[0] + (1 − |n·dir|)·of[1]`, n the shading normal.
    DirectionMix {
        /// What is mixed.
        of: [Spanned<Varying>; 2],
        /// A direction in the world, not zero.
        dir: [f64; 3],
    },
    /// Linear between the corners (0, 0), (1, 0), (0, 1), (1, 1).
    Bilinear {
        /// The values there.
        corners: [Spanned<Varying>; 4],
        /// To the unit square.
        mapping: MappingDesc,
    },
    /// Fields that alternate: the first from the origin to (1, 1).
    Checkerboard {
        /// The two fields.
        of: [Spanned<Varying>; 2],
        /// Squares of this mapping, or cubes of a space (world to texture).
        board: Board,
    },
    /// Dots in half of the unit cells.
    Dots {
        /// Outside of dots and inside.
        of: [Spanned<Varying>; 2],
        /// To the cells.
        mapping: MappingDesc,
    },
    /// A picture.
    Image(ImageDesc),
    /// Colours that meshes have themselves (Mitsuba).
    Attribute {
        /// Whether each face has one, or each vertex.
        of_faces: bool,
        /// Factor on them.
        scale: f64,
    },
    /// Fractional Brownian motion.
    Fbm(NoiseDesc),
    /// Turbulence.
    Wrinkled(NoiseDesc),
    /// Waves under gusts.
    Windy {
        /// World to texture space.
        from_world: DMat4,
    },
    /// Veined stone.
    Marble {
        /// The noise in its layers.
        noise: NoiseDesc,
        /// Factor on the coordinates.
        scale: f64,
        /// How much the noise disturbs the layers.
        variation: f64,
    },
}

/// The fields of a checkerboard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Board {
    /// Unit squares.
    Squares(MappingDesc),
    /// Unit cubes of texture space.
    Cubes {
        /// World to texture space.
        from_world: DMat4,
    },
}

/// A sum of noises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseDesc {
    /// Number of terms.
    pub octaves: u32,
    /// Ratio of the sizes of one term and the one before.
    pub roughness: f64,
    /// World to texture space.
    pub from_world: DMat4,
}

/// To a pattern in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MappingDesc {
    /// `(s, t) = M·(u, v, 1)`: the rows of M.
    Uv([[f64; 3]; 2]),
    /// `(θ/π, φ/2π)` of the point in texture space.
    Spherical {
        /// World to texture space.
        from_world: DMat4,
    },
    /// `((π + φ)/2π, z)` of the point in texture space.
    Cylindrical {
        /// World to texture space.
        from_world: DMat4,
    },
    /// `(p·axes[0], p·axes[1]) + offset` in texture space.
    Planar {
        /// World to texture space.
        from_world: DMat4,
        /// The two axes \[1/scene unit\].
        axes: [[f64; 3]; 2],
        /// The place of the origin.
        offset: [f64; 2],
    },
}

impl MappingDesc {
    /// The surface parameters as they are.
    pub const UV: Self = Self::Uv([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
}

/// A picture as a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageDesc {
    /// The file.
    pub path: FileRef,
    /// To the unit square, t upwards.
    pub mapping: MappingDesc,
    /// What is beyond it.
    pub wrap: WrapKind,
    /// Whether values are linear between the centres of pixels, or those of the nearest.
    pub smooth: bool,
    /// Factor on the values.
    pub scale: f64,
    /// Whether `1 − v` is meant, after the factor.
    pub invert: bool,
    /// Whether a colour that is asked for a number gives its luminance (Mitsuba) or the mean of its channels (pbrt).
    pub by_luminance: bool,
    /// How codes become numbers.
    pub encoding: Encoding,
}

/// What is beyond the edges of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrapKind {
    /// The picture again.
    Repeat,
    /// The picture in a mirror.
    Mirror,
    /// The pixel at the edge.
    Clamp,
    /// Nothing.
    Black,
}

/// How the codes of a picture of 8 or 16 bits become numbers. Formats of floating point hold the numbers themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// sRGB's curve.
    Srgb,
    /// Code over the greatest code.
    Linear,
    /// A power of that.
    Gamma(f64),
}
