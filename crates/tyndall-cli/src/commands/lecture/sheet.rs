//! The contact sheet: every estimator side by side, at equal samples and at equal time, beside the reference.

use std::path::Path;

use tyndall_formats::film::{FilmError, Image, png};

use super::{Chapter, Run, TONE, Version, measure::Reference};
use crate::{
    canvas::{Canvas, Type},
    progress::time,
};

/// One of the two renders of an estimator.
type Choose = fn(&Version) -> &Run;

const REFERENCE: &str = "reference (volpath)";
const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [20; 3];
const PALE: [u8; 3] = [110; 3];
/// Between pictures [pixels].
const GAP: u32 = 16;
/// Of a heading and of the two lines under a picture [pixels].
const HEADING: u32 = 36;
const CAPTION: u32 = 40;

/// Draws and writes it.
pub(crate) fn write(path: &Path, chapters: &[Chapter]) -> Result<(), FilmError> {
    let largest = |size: fn(&Image) -> u32| chapters.iter().map(|c| size(&c.reference.image)).max().unwrap_or(1);
    let (w, h) = (largest(|i| i.crop.width()).max(caption_width(chapters)), largest(|i| i.crop.height()));
    let columns = 1 + chapters.iter().map(|c| c.versions.len()).max().unwrap_or(0) as u32;
    let row = HEADING + h + CAPTION + GAP;
    let mut page = Canvas::new(GAP + columns * (w + GAP), 2 * chapters.len() as u32 * row + GAP, PAPER);

    for (i, chapter) in chapters.iter().enumerate() {
        let top = GAP + 2 * i as u32 * row;
        let runs: [(&str, Choose); 2] =
            [("equal samples", |version| &version.equal_samples), ("equal time", |version| &version.equal_time)];
        for (k, (title, run)) in runs.into_iter().enumerate() {
            let top = top + k as u32 * row;
            page.text(GAP, top, &format!("{}, {title}", chapter.name), Type::Large, INK);
            for (column, version) in chapter.versions.iter().enumerate() {
                let at = (GAP + column as u32 * (w + GAP), top + HEADING);
                show(&mut page, at, &run(version).image, &caption(version.label, run(version), &chapter.reference));
            }
            let at = (GAP + chapter.versions.len() as u32 * (w + GAP), top + HEADING);
            show(&mut page, at, &chapter.reference.image, &[REFERENCE.into(), spp(&chapter.reference.image)]);
        }
    }
    png::write_rgb8(path, [page.width, page.height], &page.pixels, &[])
}

/// Of the longest line under a picture [pixels].
fn caption_width(chapters: &[Chapter]) -> u32 {
    let captions = chapters.iter().flat_map(|chapter| {
        let runs = chapter.versions.iter().flat_map(|v| [(v.label, &v.equal_samples), (v.label, &v.equal_time)]);
        runs.flat_map(|(label, run)| caption(label, run, &chapter.reference))
    });
    captions.map(|line| Type::Small.width(&line)).max().unwrap_or(0).max(Type::Small.width(REFERENCE))
}

/// A picture and two lines under it.
fn show(page: &mut Canvas, (x, y): (u32, u32), image: &Image, lines: &[String; 2]) {
    let pixels: Vec<u8> = image.mean.iter().flat_map(|&p| TONE.apply(p)).collect();
    page.picture(x, y, image.crop.width().max(1), &pixels);
    let below = y + image.crop.height() + 4;
    page.text(x, below, &lines[0], Type::Small, INK);
    page.text(x, below + 18, &lines[1], Type::Small, PALE);
}

fn caption(label: &str, run: &Run, reference: &Reference) -> [String; 2] {
    let error = 100.0 * run.mse.max(0.0).sqrt() / reference.mean;
    [format!("{label}: {error:.1} % error"), format!("{}, {} CPU", spp(&run.image), time(run.seconds))]
}

fn spp(image: &Image) -> String {
    image.metadata.as_ref().map(|m| format!("{:.0} spp", m.samples_per_pixel)).unwrap_or_default()
}
