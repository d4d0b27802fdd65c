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

use tyndall::film::{Average, Cell, Crop, Film, Layer, Pixel};

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
    /// What the film recorded beside the image, by the names of channels.
    pub layers: Vec<Channel>,
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
            layers: film.layers.iter().flat_map(|layer| channels(film, layer)).collect(),
            rounding: ROUNDING_F32,
            metadata: Some(metadata),
        }
    }
}

/// A named number of every pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// As `P.X`; unique in an image.
    pub name: String,
    /// Row by row.
    pub values: Vec<f32>,
}

/// The lanes of a layer, and their standard errors where it is a plain mean.
fn channels(film: &Film, layer: &Layer) -> Vec<Channel> {
    let lanes = |of: &dyn Fn(&Cell, u64) -> [f32; 4], prefix: &str| -> Vec<Channel> {
        let cells = || layer.cells.iter().zip(&film.pixels);
        let lane = |(lane, name): (usize, &String)| Channel {
            name: format!("{prefix}{name}"),
            values: cells().map(|(cell, pixel)| of(cell, pixel.count)[lane]).collect(),
        };
        layer.kind.channels.iter().take(4).enumerate().map(lane).collect()
    };
    let average = layer.kind.average;
    let mut channels = lanes(&|cell, count| cell.value(average, count), "");
    if average == Average::Samples {
        channels.extend(lanes(&Cell::standard_error, "stderr."));
    }
    channels
}

/// Half a unit in the last place of a 32-bit float.
pub(crate) const ROUNDING_F32: f32 = f32::EPSILON / 2.0;

/// Why a film file cannot be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The operating system refuses.
    #[error("cannot {action} {}", path.display())]
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
