//! Film files: what a render leaves behind.
//!
//! | file | holds | for |
//! |---|---|---|
//! | [`exr`] | mean and standard error of every pixel in 32-bit floats, and how they were made | numbers |
//! | [`png`] | the mean after exposure and a display curve, in 8 bits | eyes |
//!
//! Every file is written beside its final name and renamed when it is whole ([`save`]): a crash or a full disk never
//! leaves half an image, and never harms the one that was there before.

pub mod exr;
pub mod hash;
mod metadata;
pub mod png;
pub mod save;
pub mod tone;

use std::path::PathBuf;

use tyndall::film::{Crop, Film, Pixel};

pub use metadata::Metadata;
pub use tone::{Curve, Tone};

/// An image with its errors, as a file holds it. Values are linear sRGB (Rec. 709 primaries, white D65).
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Columns of the whole image [pixels].
    pub width: u32,
    /// Rows of the whole image [pixels].
    pub height: u32,
    /// The part that the pixels below cover.
    pub crop: Crop,
    /// Means, row by row.
    pub mean: Vec<[f32; 3]>,
    /// Standard errors of the means; `None` if the file tells none.
    pub standard_error: Option<Vec<[f32; 3]>>,
    /// Largest relative error by which storing a value rounded it: 2⁻²⁴ for 32-bit floats, 2⁻¹¹ for 16-bit ones.
    pub rounding: f32,
    /// How the image was made; `None` for files of other programs.
    pub metadata: Option<Metadata>,
}

impl Image {
    /// The image that a film holds so far.
    pub fn of(film: &Film, metadata: Metadata) -> Self {
        Self {
            width: film.width,
            height: film.height,
            crop: film.crop,
            mean: film.pixels.iter().map(Pixel::mean).collect(),
            standard_error: Some(film.pixels.iter().map(Pixel::standard_error).collect()),
            rounding: ROUNDING_F32,
            metadata: Some(metadata),
        }
    }
}

/// Half a unit in the last place of a 32-bit float.
pub(crate) const ROUNDING_F32: f32 = f32::EPSILON / 2.0;

/// Why a film file cannot be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The operating system refuses.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// `"read"` or `"write"`.
        action: &'static str,
        /// The file that the user named.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file's contents are not what they should be.
    #[error("{} cannot be read as an OpenEXR image: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The image cannot be put into this format.
    #[error("cannot encode {}: {reason}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What is wrong with the image.
        reason: String,
    },
}
