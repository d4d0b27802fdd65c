//! Images as the comparison needs them: linear RGB in single precision, read from EXR (tyndall) and npy (Mitsuba).

use std::path::Path;

use anyhow::{Context, Result, ensure};
use exr::prelude::{ReadChannels, ReadLayers};

/// A picture, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Image {
    /// Pixels in a row
    pub(crate) width: usize,
    /// Rows
    pub(crate) height: usize,
    /// Linear RGB
    pub(crate) pixels: Vec<[f32; 3]>,
}

impl Image {
    /// Reads by the extension of the name.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let image = match path.extension().and_then(|extension| extension.to_str()) {
            Some("npy") => std::fs::read(path).map_err(Into::into).and_then(|bytes| Self::from_npy(&bytes)),
            _ => Self::read_exr(path),
        };
        image.with_context(|| format!("cannot read {}", path.display()))
    }

    /// The number of values that are not finite.
    pub(crate) fn non_finite(&self) -> usize {
        self.pixels.iter().flatten().filter(|value| !value.is_finite()).count()
    }

    /// The same picture with every pixel's luminance (of linear sRGB) in all channels.
    pub(crate) fn luminance(&self) -> Self {
        let grey = |&[r, g, b]: &[f32; 3]| [0.212_671 * r + 0.715_160 * g + 0.072_169 * b; 3];
        Self { pixels: self.pixels.iter().map(grey).collect(), ..*self }
    }

    /// The first layer that has red, green and blue.
    fn read_exr(path: &Path) -> Result<Self> {
        let layer = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| Self { width: size.0, height: size.1, pixels: vec![[0.0; 3]; size.0 * size.1] },
                |image, at, (r, g, b): (f32, f32, f32)| image.pixels[at.1 * image.width + at.0] = [r, g, b],
            )
            .first_valid_layer()
            .all_attributes()
            .from_file(path)?;
        Ok(layer.layer_data.channel_data.pixels)
    }

    /// NumPy's file format, version 1: a magic word, the length of a header, the header, the values.
    fn from_npy(bytes: &[u8]) -> Result<Self> {
        ensure!(bytes.len() > 10 && &bytes[..8] == b"\x93NUMPY\x01\x00", "not an npy file of version 1");
        let start = 10 + u16::from_le_bytes([bytes[8], bytes[9]]) as usize;
        let header = std::str::from_utf8(bytes.get(10..start).context("a cut header")?)?;
        ensure!(header.contains("'<f4'") && header.contains("'fortran_order': False"), "not rows of f32: {header}");
        let shape = header.split(['(', ')']).nth(1).context("no shape")?;
        let shape: Vec<usize> = shape.split(',').map(|side| side.trim().parse()).collect::<Result<_, _>>()?;
        let &[height, width, 3] = shape.as_slice() else { anyhow::bail!("not height × width × 3: {shape:?}") };
        let (values, _) = bytes[start..].as_chunks::<4>();
        let values: Vec<f32> = values.iter().map(|&value| f32::from_le_bytes(value)).collect();
        let (pixels, _) = values.as_chunks::<3>();
        ensure!(pixels.len() == width * height, "{} pixels in a picture of {width} × {height}", pixels.len());
        Ok(Self { width, height, pixels: pixels.to_vec() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn npy(header: &str, values: &[f32]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    #[test]
    fn an_array_of_numpy_is_read_row_by_row() {
        let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 3), }   \n";
        let image = Image::from_npy(&npy(header, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])).unwrap();
        assert_eq!(image, Image { width: 1, height: 2, pixels: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] });
    }

    #[test]
    fn arrays_of_other_kinds_are_refused() {
        let doubles = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 3), }\n";
        assert!(Image::from_npy(&npy(doubles, &[0.0; 6])).is_err());
        let short = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }\n";
        assert!(Image::from_npy(&npy(short, &[0.0; 3])).is_err());
        assert!(Image::from_npy(b"\x93NUMPY\x01\x00\xff\xff").is_err());
    }

    #[test]
    fn an_exr_is_read_as_it_was_written() {
        let path = std::env::temp_dir().join(format!("tyndall_xtask_{}.exr", std::process::id()));
        let pixel = |x: usize, y: usize| (x as f32, y as f32, 0.25);
        exr::prelude::write_rgb_file(&path, 3, 2, pixel).unwrap();
        let image = Image::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        assert_eq!(image.pixels[5], [2.0, 1.0, 0.25]);
    }

    #[test]
    fn the_luminance_of_white_is_one() {
        let white = Image { width: 1, height: 1, pixels: vec![[1.0; 3]] };
        assert!((white.luminance().pixels[0][0] - 1.0).abs() < 1e-6);
    }
}
