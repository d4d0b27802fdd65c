//! One page of HTML that mixes the layers of an image anew, in linear light: for a browser, without a server.
//!
//! Values are 16-bit floats (to 2⁻¹¹ of a layer; eight bits of sRGB are ten times coarser), as bytes: all upper ones, then all
//! lower ones, deflated, in base 64. They are divided by a power of two, so that the brightest is just below the largest
//! number that such a float holds. What the page looks like and does stands in `page/`.

use std::io::Write as _;

use base64::{Engine, prelude::BASE64_STANDARD};
use flate2::{Compression, write::ZlibEncoder};
use half::f16;
use serde::Serialize;
use tyndall_formats::film::Image;

use super::groups::{Group, Layer};
use crate::{outputs::stem_of_scene, shrink::shrink};

/// Pixels of all layers together, about as many as a mail takes: 20 MB.
const MOST_VALUES: usize = 1 << 22;

/// What the page is made of.
#[derive(Debug, Serialize)]
struct Content<'a> {
    scene: String,
    made: String,
    width: u32,
    height: u32,
    /// Edge of the squares of pixels that became one [pixels].
    shrunk: u32,
    /// What a value is multiplied by.
    unit: f32,
    /// At the beginning [stops].
    exposure: f32,
    groups: Vec<Section<'a>>,
}

#[derive(Debug, Serialize)]
struct Section<'a> {
    title: &'a str,
    layers: Vec<Part<'a>>,
}

#[derive(Debug, Serialize)]
struct Part<'a> {
    name: &'a str,
    meaning: &'a str,
    share: f64,
    data: String,
}

/// The page.
pub(super) fn page(image: &Image, groups: &[Group], exposure: f32) -> anyhow::Result<String> {
    let layers = || groups.iter().flat_map(|group| &group.layers);
    let size = [image.crop.width(), image.crop.height()];
    let shrunk = shrinking(size, layers().count());
    let unit = unit(layers());
    let mut sections = Vec::new();
    for group in groups {
        let mut section = Section { title: group.kind.title(), layers: Vec::new() };
        for layer in &group.layers {
            let data = packed(&shrink(&layer.values, size, shrunk).1, unit)?;
            let Layer { name, meaning, share, .. } = layer;
            section.layers.push(Part { name, meaning, share: *share, data });
        }
        sections.push(section);
    }
    let metadata = image.metadata.as_ref();
    let content = Content {
        scene: metadata.map(|m| stem_of_scene(m.scene.as_ref()).display().to_string()).unwrap_or_default(),
        made: metadata.map(|m| format!("{} (tyndall {})", m.command, m.version)).unwrap_or_default(),
        width: size[0] / shrunk,
        height: size[1] / shrunk,
        shrunk,
        unit,
        exposure,
        groups: sections,
    };
    // No text can end the element that it stands in.
    let data = serde_json::to_string(&content)?.replace('<', "\\u003c");
    Ok(include_str!("page/page.html")
        .replace("/* page.css */", include_str!("page/page.css"))
        .replace("/* page.js */", include_str!("page/page.js"))
        .replace("\"data\"", &data))
}

/// How many pixels to a side become one, so that the page stays small enough.
fn shrinking(size: [u32; 2], layers: usize) -> u32 {
    let values = |edge: u32| (size[0] / edge) as usize * (size[1] / edge) as usize * layers;
    let most = size[0].min(size[1]).max(1);
    (1..=most).find(|edge| values(*edge) <= MOST_VALUES).unwrap_or(most)
}

/// The power of two by which values are divided: the brightest is then between 2¹⁴ and 2¹⁵.
fn unit<'a>(layers: impl Iterator<Item = &'a Layer>) -> f32 {
    let sizes = layers.flat_map(|layer| layer.values.iter().flatten()).map(|v| v.abs());
    let brightest = sizes.filter(|v| v.is_finite()).fold(f32::MIN_POSITIVE, f32::max);
    (brightest.log2().ceil() - 15.0).max(-126.0).exp2()
}

fn packed(values: &[[f32; 3]], unit: f32) -> anyhow::Result<String> {
    let halves: Vec<[u8; 2]> = values.iter().flatten().map(|v| f16::from_f32(v / unit).to_be_bytes()).collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    for byte in 0..2 {
        let plane: Vec<u8> = halves.iter().map(|half| half[byte]).collect();
        encoder.write_all(&plane)?;
    }
    Ok(BASE64_STANDARD.encode(encoder.finish()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_images_shrink_until_all_layers_fit() {
        assert_eq!(shrinking([640, 480], 13), 1);
        assert_eq!(shrinking([1920, 1080], 10), 3);
        assert_eq!(shrinking([3, 2], usize::MAX >> 8), 2);
    }

    #[test]
    fn the_brightest_value_is_just_below_the_largest_half_float() {
        for brightest in [1e-30, 0.37, 1.0, 9e7] {
            let values = vec![[0.1 * brightest, brightest, f32::INFINITY]];
            let layer = Layer { name: String::new(), meaning: String::new(), values, share: 1.0 };
            let scaled = brightest / unit([&layer].into_iter());
            assert!(scaled > 16384.0 - 1.0 && scaled <= 32768.0, "{brightest}: {scaled}");
        }
    }
}
