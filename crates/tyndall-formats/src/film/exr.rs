//! OpenEXR: the image as numbers, with its standard error and its settings.
//!
//! One part, ZIP-compressed, 32-bit floats. Channels `R`, `G`, `B` hold the mean, the layer `stderr` (channels
//! `stderr.R`, `stderr.G`, `stderr.B`) the standard error of the mean, infinite where a pixel has fewer than two
//! samples. Layers of the film follow by their own names (`P.X`, `stderr.P.X`). The data window is the crop, the display window the whole image, the chromaticities are those of Rec. 709.
//! Settings are text attributes named `tyndall.*` ([`Metadata`]).

use std::{collections::HashMap, io::Cursor, path::Path};

use ::exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatImage, FlatSamples, Image as ExrImage, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, ReadChannels, ReadLayers, Text, Vec2, WritableImage,
    attribute::{AttributeValue, Chromaticities},
};
use tyndall::film::Crop;

use super::{Channel, FilmError, Image, Metadata, ROUNDING_F32, save};

/// More pixels than this are taken for a damaged header, not for an image.
const MOST_PIXELS: usize = 1 << 30;

/// Writes an image with its errors and settings.
///
/// # Errors
/// The image is empty, or the file cannot be written.
pub fn write(path: &Path, image: &Image) -> Result<(), FilmError> {
    let encode_error = |reason: String| FilmError::Encode { path: path.to_owned(), reason };
    if image.mean.is_empty() {
        return Err(encode_error("the image has no pixels".into()));
    }
    let mut channels = rgb_channels("", &image.mean);
    if let Some(errors) = &image.standard_error {
        channels.extend(rgb_channels("stderr.", errors));
    }
    channels.extend(
        image
            .layers
            .iter()
            .map(|channel| AnyChannel::new(utf8(&channel.name), FlatSamples::F32(channel.values.clone()))),
    );
    let crop = image.crop;
    let layer = Layer::new(
        Vec2(crop.width() as usize, crop.height() as usize),
        LayerAttributes {
            layer_position: Vec2(crop.min.0.cast_signed(), crop.min.1.cast_signed()),
            software_name: image.metadata.as_ref().map(|m| utf8(&format!("tyndall {}", m.version))),
            other: text_attributes(image),
            ..LayerAttributes::default()
        },
        Encoding { compression: Compression::ZIP16, ..Encoding::SMALL_LOSSLESS },
        AnyChannels::sort(channels.into()),
    );
    let mut attributes =
        ImageAttributes::new(IntegerBounds::from_dimensions((image.width as usize, image.height as usize)));
    attributes.chromaticities = Some(rec_709());

    let mut bytes = Cursor::new(Vec::new());
    let file = ExrImage { attributes, layer_data: layer };
    file.write().non_parallel().to_buffered(&mut bytes).map_err(|e| encode_error(e.to_string()))?;
    save::replace(path, bytes.get_ref())
}

/// Reads an image of tyndall's or of another program's: `R`, `G`, `B` (or `Y` for all three) of the first part that has
/// them, or else of its first layer that does, and beside them all other channels in full resolution; without standard
/// errors and settings if it tells none.
///
/// # Errors
/// The file cannot be read, is damaged, or holds no such channels.
pub fn read(path: &Path) -> Result<Image, FilmError> {
    let bytes =
        std::fs::read(path).map_err(|source| FilmError::Io { action: "read", path: path.to_owned(), source })?;
    decode(&bytes).map_err(|reason| FilmError::Malformed { path: path.to_owned(), reason })
}

fn decode(bytes: &[u8]) -> Result<Image, String> {
    check_sizes(bytes)?;
    let file: FlatImage = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    let (layer, mean) = file
        .layer_data
        .iter()
        .find_map(|layer| Some((layer, mean_channels(layer)?)))
        .ok_or("it has no channels R, G, B (or Y) that cover the image")?;
    let standard_error = find_channels(layer, |name| name, "stderr.").map(|channels| gather(channels, layer.size));

    let display = file.attributes.display_window;
    let crop = crop_within(layer, display).ok_or("its data window reaches out of its display window")?;
    let half = mean.iter().any(|samples| matches!(samples, FlatSamples::F16(_)));
    Ok(Image {
        width: display.size.0 as u32,
        height: display.size.1 as u32,
        crop,
        mean: gather(mean, layer.size),
        standard_error,
        layers: other_channels(layer),
        rounding: if half { 1.0 / 2048.0 } else { ROUNDING_F32 },
        metadata: Metadata::from_entries(|name| text_attribute(&layer.attributes.other, name)),
    })
}

/// Refuses images whose header promises more than the file could hold, before memory is taken for them.
fn check_sizes(bytes: &[u8]) -> Result<(), String> {
    let meta = ::exr::meta::MetaData::read_from_buffered(bytes, false).map_err(|e| e.to_string())?;
    for header in &meta.headers {
        let pixels = header.layer_size.0.saturating_mul(header.layer_size.1);
        // No compression that OpenEXR knows packs more than a thousand pixels into a byte.
        if pixels > MOST_PIXELS || pixels / 1024 > bytes.len() {
            return Err(format!("its header promises {pixels} pixels, more than the file can hold"));
        }
    }
    Ok(())
}

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

fn mean_channels(layer: &FlatLayer) -> Option<[&FlatSamples; 3]> {
    let first_layer = layer.channel_data.list.iter().find_map(|channel| {
        let name = channel.name.to_string();
        name.strip_suffix(".R").filter(|layer| *layer != "stderr").map(|layer| format!("{layer}."))
    });
    find_channels(layer, |name| name, "")
        .or_else(|| find_channels(layer, |_| "Y", ""))
        .or_else(|| find_channels(layer, |name| name, &first_layer?))
}

/// The three channels `prefix` + `name(R | G | B)`, if all are there in full resolution.
fn find_channels<'a>(
    layer: &'a FlatLayer,
    name: impl Fn(&'static str) -> &'static str,
    prefix: &str,
) -> Option<[&'a FlatSamples; 3]> {
    let find = |c| {
        let wanted = format!("{prefix}{}", name(c));
        let channel = layer.channel_data.list.iter().find(|channel| channel.name.eq(&wanted))?;
        (channel.sample_data.len() == layer.size.area()).then_some(&channel.sample_data)
    };
    Some([find("R")?, find("G")?, find("B")?])
}

/// What the file holds beside mean and standard error.
fn other_channels(layer: &FlatLayer) -> Vec<Channel> {
    let own = |name: &str| ["R", "G", "B"].contains(&name.strip_prefix("stderr.").unwrap_or(name));
    let channels = layer.channel_data.list.iter().filter(|channel| channel.sample_data.len() == layer.size.area());
    let named = channels.map(|channel| (channel.name.to_string(), &channel.sample_data));
    let others = named.filter(|(name, _)| !own(name));
    others.map(|(name, samples)| Channel { name, values: samples.values_as_f32().collect() }).collect()
}

fn gather(channels: [&FlatSamples; 3], size: Vec2<usize>) -> Vec<[f32; 3]> {
    (0..size.area()).map(|i| channels.map(|samples| samples.value_by_flat_index(i).to_f32())).collect()
}

/// The data window as a crop of the display window.
fn crop_within(layer: &FlatLayer, display: IntegerBounds) -> Option<Crop> {
    let offset = |axis: fn(Vec2<i32>) -> i32| {
        u32::try_from(i64::from(axis(layer.attributes.layer_position)) - i64::from(axis(display.position))).ok()
    };
    let min = (offset(|v| v.0)?, offset(|v| v.1)?);
    let max = (min.0.checked_add(layer.size.0 as u32)?, min.1.checked_add(layer.size.1 as u32)?);
    (max.0 as usize <= display.size.0 && max.1 as usize <= display.size.1).then_some(Crop { min, max })
}

fn rgb_channels(prefix: &str, pixels: &[[f32; 3]]) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |(c, name): (usize, &str)| {
        let samples = FlatSamples::F32(pixels.iter().map(|p| p[c]).collect());
        AnyChannel::new(utf8(&format!("{prefix}{name}")), samples)
    };
    ["R", "G", "B"].into_iter().enumerate().map(channel).collect()
}

/// How the image was made, and what spectral layers (`S0.550,000nm`) ask for: Fichet et al. 2021, "An OpenEXR layout for
/// spectral images".
fn text_attributes(image: &Image) -> HashMap<Text, AttributeValue> {
    let made = image.metadata.iter().flat_map(Metadata::entries);
    let is_spectral = image.layers.iter().any(|channel| channel.name.starts_with("S0."));
    let layout = [("spectralLayoutVersion", "1.0"), ("emissiveUnits", "W.m^-2.sr^-1")];
    let layout = layout.into_iter().filter(|_| is_spectral).map(|(name, value)| (name, value.to_owned()));
    let entries = made.chain(layout).filter(|(_, value)| !value.is_empty());
    entries.map(|(name, value)| (utf8(name), AttributeValue::Text(utf8(&value)))).collect()
}

fn text_attribute(attributes: &HashMap<Text, AttributeValue>, name: &str) -> Option<String> {
    match attributes.get(name.as_bytes())? {
        AttributeValue::Text(text) => Some(String::from_utf8_lossy(text.bytes()).into_owned()),
        _ => None,
    }
}

/// Texts of EXR files are bytes; like everybody we take them for UTF-8.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// ITU-R BT.709: the primaries and white of linear sRGB.
fn rec_709() -> Chromaticities {
    Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    }
}

#[cfg(test)]
mod tests {
    use tyndall::film::Film;

    use super::{super::save::tests::scratch, *};

    fn sample_image() -> Image {
        let mut film = Film::new(23, 17, Crop { min: (3, 2), max: (20, 15) });
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            for k in 0..=(i % 3) {
                pixel.add([0.1 * i as f32, 1e-7 * k as f32, 1e9 / (1.0 + i as f32)]);
            }
        }
        let metadata = Metadata {
            version: "0.1.0".into(),
            scene: "scènes/牛奶.pbrt".into(),
            scene_hash: "2d06800538d394c2".into(),
            integrator: "volpath".into(),
            color: "rgb".into(),
            sampler: "sobol".into(),
            spp: 3,
            samples_per_pixel: 1.987_654_321,
            seed: u64::MAX,
            crop: "3,2,20,15".into(),
            wall_seconds: 0.1,
            command: "tyndall render scènes/牛奶.pbrt".into(),
        };
        Image::of(&film, metadata)
    }

    fn bytes_of(image: &Image, name: &str) -> Vec<u8> {
        let dir = scratch(name);
        write(&dir.join("a.exr"), image).unwrap();
        let bytes = std::fs::read(dir.join("a.exr")).unwrap();
        std::fs::remove_dir_all(dir).unwrap();
        bytes
    }

    /// Infinite standard errors (pixels of one sample) included.
    #[test]
    fn an_image_comes_back_bit_by_bit_with_its_errors_layers_crop_and_settings() {
        let mut image = sample_image();
        image.layers = ["direct.B", "stderr.direct.B"]
            .map(|name| Channel { name: name.into(), values: image.mean.iter().map(|p| p[1] / 3.0).collect() })
            .into();
        assert!(image.standard_error.as_ref().unwrap().iter().any(|se| se[0].is_infinite()));
        let back = decode(&bytes_of(&image, "exr-round")).unwrap();
        assert_eq!(back.metadata, image.metadata);
        assert!(back == image);
    }

    /// As readers of the layout for spectral images look for it.
    #[test]
    fn spectral_layers_come_with_the_attributes_of_their_layout() {
        let channel = Channel { name: "S0.550,000nm".into(), values: vec![1.5; 17 * 13] };
        let bytes = bytes_of(&Image { layers: vec![channel], ..sample_image() }, "exr-spectral");
        let file = ::exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().all_layers();
        let file: FlatImage = file.all_attributes().from_buffered(Cursor::new(&bytes)).unwrap();
        let layer = &file.layer_data[0];
        let text = |name| text_attribute(&layer.attributes.other, name);
        assert_eq!(text("spectralLayoutVersion").as_deref(), Some("1.0"));
        assert_eq!(text("emissiveUnits").as_deref(), Some("W.m^-2.sr^-1"));
        assert!(layer.channel_data.list.iter().any(|channel| channel.name.to_string() == "S0.550,000nm"));
        let plain = decode(&bytes_of(&sample_image(), "exr-plain")).unwrap();
        assert_eq!(plain.metadata, sample_image().metadata);
    }

    #[test]
    fn an_image_of_another_program_has_no_errors_and_no_settings() {
        let image = Image { standard_error: None, metadata: None, ..sample_image() };
        let back = decode(&bytes_of(&image, "exr-foreign")).unwrap();
        assert!(back == image);
    }

    /// Half floats have 11 significant bits; a luminance channel fills all three.
    #[test]
    fn half_floats_and_luminance_are_understood() {
        let samples = FlatSamples::F16(vec![::exr::prelude::f16::from_f32(0.1); 6]);
        let channels = AnyChannels::sort(vec![AnyChannel::new("Y", samples)].into());
        let layer = Layer::new((3, 2), LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
        let mut bytes = Cursor::new(Vec::new());
        ExrImage::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
        let image = decode(bytes.get_ref()).unwrap();
        assert!((image.mean[5][2] - 0.1).abs() <= 0.1 * image.rounding);
        assert_eq!((image.width, image.height), (3, 2));
    }

    #[test]
    fn cut_short_and_empty_files_are_errors() {
        let bytes = bytes_of(&sample_image(), "exr-cut");
        for length in (0..bytes.len() - 1).step_by(7) {
            assert!(decode(&bytes[..length]).is_err(), "the first {length} bytes");
        }
        assert!(decode(b"PNG is not what this is").is_err());
    }

    /// Every byte of the header, and some of the pixels, turned over: an error or another image, never a panic.
    #[test]
    fn damaged_files_do_not_panic() {
        let bytes = bytes_of(&sample_image(), "exr-damaged");
        for i in (0..bytes.len().min(1400)).chain((1400..bytes.len()).step_by(31)) {
            for flip in [0x01, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[i] ^= flip;
                let _ = decode(&damaged);
            }
        }
    }

    #[test]
    fn a_missing_file_is_an_error_that_names_it() {
        let message = super::read(Path::new("no/such.exr")).unwrap_err().to_string();
        assert!(message.contains("cannot read no/such.exr"), "{message}");
    }
}
