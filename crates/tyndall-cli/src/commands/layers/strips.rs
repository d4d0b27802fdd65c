//! Strips: the image and the layers that add up to it, side by side, for a page.
//!
//! Layers that are much darker than the image are shown brighter, by a power of two that stands beneath: by the largest that
//! leaves the brightest of them (all but a hundredth of its pixels) no brighter than the brightest of the image.

use std::path::Path;

use tyndall::spectrum::srgb::luminance;
use tyndall_formats::film::{FilmError, Image, Tone, png};

use super::groups::Group;
use crate::{
    canvas::{Canvas, Type},
    shrink::shrink,
};

/// Of the pictures of a strip, at most [pixels].
const WIDTH: u32 = 640;
const GAP: u32 = 6;
const CAPTION: u32 = 40;
const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [20; 3];
const PALE: [u8; 3] = [110; 3];
/// Light that is not worth a picture, as a share of all.
const DARK: f64 = 1e-6;

/// A picture with two lines beneath.
struct Cell<'a> {
    values: &'a [[f32; 3]],
    lines: [String; 2],
    gain: i32,
}

/// Writes the strip of a group.
pub(super) fn write(path: &Path, image: &Image, group: &Group, exposure: f32) -> Result<(), FilmError> {
    let bright = group.layers.iter().filter(|layer| layer.share.abs() > DARK);
    let layers = bright.map(|layer| {
        let gain = gain(&image.mean, &layer.values);
        let share = format!("{:.2} %", 100.0 * layer.share);
        let shown = if gain > 0 { format!("{share}, ×{}", 1 << gain) } else { share };
        Cell { values: &layer.values, lines: [layer.name.clone(), shown], gain }
    });
    let all = Cell { values: &image.mean, lines: ["all light".into(), String::new()], gain: 0 };
    let cells: Vec<_> = [all].into_iter().chain(layers).collect();

    let size = [image.crop.width(), image.crop.height()];
    let edge = size[0].saturating_mul(cells.len() as u32).div_ceil(WIDTH).min(size[0]).min(size[1]).max(1);
    let [width, height] = shrink(&image.mean, size, edge).0;
    let words = cells.iter().flat_map(|cell| &cell.lines).map(|line| Type::Small.width(line)).max().unwrap_or(0);
    let step = width.max(words) + GAP;
    let mut page = Canvas::new(cells.len() as u32 * step - GAP, height + CAPTION, PAPER);
    for (x, cell) in (0..).map(|i| i * step).zip(cells) {
        let tone = Tone { exposure: exposure + cell.gain as f32, ..Tone::default() };
        let bytes: Vec<u8> = shrink(cell.values, size, edge).1.into_iter().flat_map(|v| tone.apply(v)).collect();
        page.picture(x, 0, width, &bytes);
        page.text(x, height + 3, &cell.lines[0], Type::Small, INK);
        page.text(x, height + 20, &cell.lines[1], Type::Small, PALE);
    }
    png::write_rgb8(path, [page.width, page.height], &page.pixels, &[])
}

/// How many stops brighter a layer may be shown.
fn gain(whole: &[[f32; 3]], layer: &[[f32; 3]]) -> i32 {
    let bright = |values: &[[f32; 3]]| {
        let mut sizes: Vec<f32> = values.iter().map(|v| luminance(*v)).filter(|v| v.is_finite()).collect();
        sizes.sort_by(f32::total_cmp);
        sizes.get(sizes.len() * 99 / 100).copied().unwrap_or(0.0)
    };
    let stops = (bright(whole) / bright(layer)).log2().floor();
    if stops.is_finite() { stops.clamp(0.0, 20.0) as i32 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dark_layer_is_shown_brighter_by_a_power_of_two_and_no_brighter_than_the_image() {
        let grey = |v: f32| vec![[v; 3]; 100];
        assert_eq!(gain(&grey(1.0), &grey(0.9)), 0);
        assert_eq!(gain(&grey(1.0), &grey(0.12)), 3);
        assert_eq!(gain(&grey(1.0), &grey(0.0)), 0);
    }
}
