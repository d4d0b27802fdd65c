//! PNG: 8-bit sRGB for the eye, with the settings in its text chunks.

use std::path::Path;

use super::{FilmError, Image, Tone, save};

/// Writes the mean of an image (of a crop: the crop alone).
///
/// # Errors
/// The image is empty, or the file cannot be written.
pub fn write(path: &Path, image: &Image, tone: Tone) -> Result<(), FilmError> {
    let pixels: Vec<u8> = image.mean.iter().flat_map(|&p| tone.apply(p)).collect();
    let mut entries = image.metadata.as_ref().map(|m| m.entries().to_vec()).unwrap_or_default();
    entries.push(("tyndall.exposure", tone.exposure.to_string()));
    entries.push(("tyndall.curve", format!("{:?}", tone.curve).to_lowercase()));
    write_rgb8(path, [image.crop.width(), image.crop.height()], &pixels, &entries)
}

/// Writes sRGB bytes, three a pixel, row by row, with named texts.
///
/// # Errors
/// The bytes do not fill `size` (columns, rows), or the file cannot be written.
pub fn write_rgb8(
    path: &Path,
    size: [u32; 2],
    pixels: &[u8],
    texts: &[(&'static str, String)],
) -> Result<(), FilmError> {
    let bytes =
        encode(size, pixels, texts).map_err(|e| FilmError::Encode { path: path.to_owned(), reason: e.to_string() })?;
    save::replace(path, &bytes)
}

fn encode(size: [u32; 2], pixels: &[u8], texts: &[(&'static str, String)]) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::RelativeColorimetric);
    for (name, text) in texts {
        // International text: a path may be written in any script.
        encoder.add_itxt_chunk((*name).to_owned(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use tyndall::film::{Crop, Film};

    use super::{super::Metadata, *};

    #[test]
    fn a_crop_is_written_as_the_crop_with_its_settings_in_the_text() {
        let dir = super::save::tests::scratch("png");
        let path = dir.join("a.png");
        let mut film = Film::new(9, 5, Crop { min: (2, 1), max: (5, 3) });
        film.pixels[4].add([1.0, 0.5, 0.0]);
        let metadata = Metadata { scene: "scènes/牛奶.pbrt".into(), version: "1".into(), ..Metadata::default() };
        write(&path, &Image::of(&film, metadata), Tone::default()).unwrap();

        let mut reader =
            ::png::Decoder::new(std::io::BufReader::new(std::fs::File::open(&path).unwrap())).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((frame.width, frame.height), (3, 2));
        assert_eq!(pixels[12..15], [255, 188, 0]);
        let texts = &reader.info().utf8_text;
        let scene = texts.iter().find(|t| t.keyword == "tyndall.scene").unwrap();
        assert_eq!(scene.get_text().unwrap(), "scènes/牛奶.pbrt");
        std::fs::remove_dir_all(dir).unwrap();
    }

    #[test]
    fn an_empty_image_is_an_error() {
        let film = Film::new(0, 0, Crop::full(0, 0));
        assert!(write(Path::new("x.png"), &Image::of(&film, Metadata::default()), Tone::default()).is_err());
    }
}
