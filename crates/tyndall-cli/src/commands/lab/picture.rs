//! Pictures of instruments: numbers as EXR, and a logarithmic view as PNG.

use std::path::{Path, PathBuf};

use tyndall::film::Crop;
use tyndall_formats::film::{Image, Metadata, Tone, exr, png};
use tyndall_lab::run::Estimate;

use crate::outputs::{Outputs, command_line, is_png};

/// The files of a picture that was asked for, found to be writable.
pub(super) fn files(asked: Option<&Path>) -> anyhow::Result<Vec<PathBuf>> {
    let Some(asked) = asked else { return Ok(Vec::new()) };
    let outputs = Outputs::new(&[asked.to_owned()], asked, Tone::default())?;
    outputs.check()?;
    Ok(outputs.files)
}

/// Writes a square picture of red, green and blue, row by row.
pub(super) fn write(
    files: &[PathBuf],
    pixels: u32,
    channels: [&[Estimate]; 3],
    title: &str,
    decades: f64,
) -> anyhow::Result<()> {
    let image = image([pixels, pixels], channels, title);
    for file in files {
        if is_png(file) {
            let texts = [("tyndall.decades", decades.to_string()), ("tyndall.scene", title.to_owned())];
            png::write_rgb8(file, [pixels, pixels], &logarithmic(&image.mean, decades), &texts)?;
        } else {
            exr::write(file, &image)?;
        }
    }
    Ok(())
}

/// Means and standard errors of so many columns and rows.
pub(super) fn image([width, height]: [u32; 2], channels: [&[Estimate]; 3], title: &str) -> Image {
    let of = |value: fn(&Estimate) -> f64| -> Vec<[f32; 3]> {
        (0..channels[0].len()).map(|i| channels.map(|channel| value(&channel[i]) as f32)).collect()
    };
    Image {
        width,
        height,
        crop: Crop::full(width, height),
        mean: of(|e| e.mean),
        standard_error: Some(of(|e| e.standard_error)),
        layers: Vec::new(),
        rounding: f32::EPSILON / 2.0,
        metadata: Some(Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: title.to_owned(),
            command: command_line(),
            ..Metadata::default()
        }),
    }
}

/// sRGB bytes: the brightest channel of a pixel on a logarithmic scale, the whole picture's brightest white, black so
/// many powers of ten below; the hue is kept.
pub(super) fn logarithmic(mean: &[[f32; 3]], decades: f64) -> Vec<u8> {
    let most = |p: &[f32; 3]| p.iter().copied().fold(0.0, f32::max);
    let white = f64::from(mean.iter().map(most).fold(0.0, f32::max));
    let color = |p: &[f32; 3]| {
        let peak = f64::from(most(p));
        let value = if peak > 0.0 { 1.0 + (peak / white).log10() / decades } else { 0.0 };
        p.map(|c| {
            let share = (f64::from(c.max(0.0)) / peak.max(f64::MIN_POSITIVE)).powf(1.0 / 2.2);
            (255.0 * (value.clamp(0.0, 1.0) * share).min(1.0)).round() as u8
        })
    };
    mean.iter().flat_map(color).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_of_the_light_is_one_decade_darker() {
        let bytes = logarithmic(&[[100.0; 3], [1.0, 0.0, 0.0], [1e-3; 3], [0.0; 3]], 4.0);
        assert_eq!(bytes, [255, 255, 255, 128, 0, 0, 0, 0, 0, 0, 0, 0]);
    }
}
