//! Pictures as light: OpenEXR, Radiance HDR, PFM, and 8- or 16-bit PNG, JPEG, TIFF, TGA, BMP and QOI, all as linear RGB.
//!
//! What the numbers are mapped onto is not said here: pbrt reads an environment as an equal-area octahedral square,
//! Mitsuba as latitude and longitude.

mod openexr;
mod pfm;
mod qoi;

pub(crate) use openexr::write as write_openexr;

use std::io::Cursor;
use std::path::{Path, PathBuf};

use ::image::{DynamicImage, ImageFormat, ImageReader};

use crate::desc::Encoding;

/// The longest side that is read \[pixels\].
pub const MAX_SIDE: u32 = 32_768;
/// The most pixels that are read: 16,384 × 8,192, 1.6 GB.
pub const MAX_PIXELS: u64 = 1 << 27;

/// Linear-sRGB radiance or reflectance on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Rows from the top, each from the left.
    pub pixels: Vec<[f32; 3]>,
}

/// Why an image could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct ImageError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: String,
}

/// Reads an image; its format is that of its name's ending. Pixels that are not finite, or negative, are an error:
/// there is no such light. Codes of 8 and 16 bits are sRGB.
///
/// # Errors
/// The file cannot be read, is no such image, is too large, or holds numbers that are no light.
pub fn read_image(path: &Path) -> Result<Image, ImageError> {
    read_encoded(path, Encoding::Srgb)
}

/// As [`read_image`], with codes of 8 and 16 bits in another encoding.
///
/// # Errors
/// As [`read_image`].
pub fn read_encoded(path: &Path, encoding: Encoding) -> Result<Image, ImageError> {
    std::fs::read(path)
        .map_err(|error| error.to_string())
        .and_then(|bytes| parse_encoded(&bytes, &path.extension().unwrap_or_default().to_string_lossy(), encoding))
        .map_err(|problem| ImageError { path: path.to_owned(), problem })
}

/// Reads an image that is already in memory.
///
/// # Errors
/// As [`read_image`]; what is wrong, not where the bytes came from.
pub fn parse_image(bytes: &[u8], extension: &str) -> Result<Image, String> {
    parse_encoded(bytes, extension, Encoding::Srgb)
}

fn parse_encoded(bytes: &[u8], extension: &str, encoding: Encoding) -> Result<Image, String> {
    let parse_coded = |bytes, format| parse_coded(bytes, format, encoding);
    let image = match extension.to_ascii_lowercase().as_str() {
        "exr" => openexr::parse(bytes),
        "pfm" => pfm::parse(bytes),
        "hdr" | "rgbe" => parse_coded(bytes, ImageFormat::Hdr),
        "png" => parse_coded(bytes, ImageFormat::Png),
        "jpg" | "jpeg" => parse_coded(bytes, ImageFormat::Jpeg),
        "tif" | "tiff" => parse_coded(bytes, ImageFormat::Tiff),
        "tga" => parse_coded(bytes, ImageFormat::Tga),
        "bmp" => parse_coded(bytes, ImageFormat::Bmp),
        "qoi" => qoi::parse(bytes, encoding),
        other => {
            Err(format!("`.{other}` is no image format that is read: exr, hdr, pfm, png, jpg, tiff, tga, bmp, qoi"))
        }
    }?;
    match image.pixels.iter().position(|p| !p.iter().all(|c| c.is_finite() && *c >= 0.0)) {
        None => Ok(image),
        Some(i) => {
            let (x, y) = (i % image.width as usize, i / image.width as usize);
            Err(format!("pixel ({x}, {y}) is {:?}, which is no amount of light", image.pixels[i]))
        }
    }
}

/// Refuses a size that is empty or beyond the limits, before anything of that size is allocated.
fn check_size(width: u64, height: u64) -> Result<(u32, u32), String> {
    let side = u64::from(MAX_SIDE);
    if width == 0 || height == 0 {
        return Err(format!("is {width} × {height} pixels"));
    }
    if width > side || height > side || width * height > MAX_PIXELS {
        return Err(format!("is {width} × {height} pixels; at most {side} a side and {MAX_PIXELS} in all are read"));
    }
    Ok((width as u32, height as u32))
}

fn parse_coded(bytes: &[u8], format: ImageFormat, encoding: Encoding) -> Result<Image, String> {
    let reader = || ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader().into_dimensions().map_err(|error| error.to_string())?;
    let (width, height) = check_size(width.into(), height.into())?;
    let decoded = reader().decode().map_err(|error| error.to_string())?;
    let is_linear = matches!(decoded, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let encoding = if is_linear { Encoding::Linear } else { encoding };
    let pixels = decoded.into_rgb32f().pixels().map(|p| p.0.map(|code| decode(code, encoding))).collect();
    Ok(Image { width, height, pixels })
}

fn decode(code: f32, encoding: Encoding) -> f32 {
    match encoding {
        Encoding::Srgb => srgb_to_linear(code),
        Encoding::Linear => code,
        Encoding::Gamma(gamma) => code.powf(gamma as f32),
    }
}

/// The sRGB transfer curve undone (IEC 61966-2-1), both in `[0, 1]`.
fn srgb_to_linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests;
