//! What the patterns tell beside the truth, as one picture.

use std::path::Path;

use tyndall_formats::film::{FilmError, Image, Tone, png};
use tyndall_lab::separate::Parts;

use crate::{
    canvas::{Canvas, Type},
    false_color,
};

const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [20; 3];
/// Between pictures, and under each for its words [pixels].
const GAP: u32 = 12;
const CAPTION: u32 = 26;

/// Draws and writes it.
pub(super) fn write(
    path: &Path,
    all: &Image,
    truth: &Parts,
    separated: Option<&Parts>,
    tone: Tone,
) -> Result<(), FilmError> {
    let panels = panels(all, truth, separated, tone);
    let widest = panels.iter().map(|(words, _)| Type::Small.width(words)).max().unwrap_or(0);
    let (w, h) = (all.crop.width().max(widest), all.crop.height());
    let columns = 3;
    let rows = panels.len() as u32 / columns;
    let mut page = Canvas::new(GAP + columns * (w + GAP), GAP + rows * (h + CAPTION), PAPER);
    for (i, (words, pixels)) in (0..).zip(&panels) {
        let (x, y) = (GAP + i % columns * (w + GAP), GAP + i / columns * (h + CAPTION));
        page.picture(x, y, all.crop.width().max(1), pixels);
        page.text(x, y + h + 4, words, Type::Small, INK);
    }
    png::write_rgb8(path, [page.width, page.height], &page.pixels, &[])
}

/// Words and pixels of each, row by row.
fn panels(all: &Image, truth: &Parts, separated: Option<&Parts>, tone: Tone) -> Vec<(String, Vec<u8>)> {
    let picture = |values: &[[f32; 3]]| values.iter().flat_map(|&pixel| tone.apply(pixel)).collect::<Vec<u8>>();
    let mut panels = vec![
        ("all light".to_owned(), picture(&all.mean)),
        ("direct, in truth".to_owned(), picture(&truth.direct)),
        ("global, in truth".to_owned(), picture(&truth.global)),
    ];
    if let Some(parts) = separated {
        let image = |values: &Vec<[f32; 3]>| Image { mean: values.clone(), layers: Vec::new(), ..all.clone() };
        let (difference, scale) = false_color::difference(&image(&parts.direct), &image(&truth.direct));
        panels.extend([
            (format!("direct: red +{scale:.2}, blue -{scale:.2}"), difference),
            ("direct, by patterns".to_owned(), picture(&parts.direct)),
            ("global, by patterns".to_owned(), picture(&parts.global)),
        ]);
    }
    panels
}
