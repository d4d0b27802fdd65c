//! QOI, the "quite OK image" format: 8-bit codes in chunks of one pixel or of a run.
//!
//! Source: Szablewski 2021, The QOI File Format, specification 1.0 (qoiformat.org).

use super::{Image, check_size, decode};
use crate::desc::Encoding;

/// Bytes before the first chunk.
const HEADER: usize = 14;

pub(super) fn parse(bytes: &[u8], encoding: Encoding) -> Result<Image, String> {
    let header = bytes.get(..HEADER).filter(|h| h.starts_with(b"qoif")).ok_or("no QOI image")?;
    let size = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let (width, height) = check_size(size(4).into(), size(8).into())?;
    // The last byte of the header says whether codes are sRGB or linear.
    let encoding = if header[13] == 1 { Encoding::Linear } else { encoding };
    let count = width as usize * height as usize;
    // A chunk is a run of up to 62 pixels: a short file cannot ask for a large picture.
    if (count / 62) > bytes.len() {
        return Err(format!("{width} × {height} pixels are more than the file can hold"));
    }
    let table: Vec<f32> = (0..=255).map(|code| decode(code as f32 / 255.0, encoding)).collect();
    let mut chunks = Chunks { bytes: &bytes[HEADER..], seen: [[0; 4]; 64], last: [0, 0, 0, 255] };
    let mut pixels = Vec::with_capacity(count);
    while pixels.len() < count {
        let (pixel, run) = chunks.next().ok_or("the picture ends early")?;
        let rgb = [pixel[0], pixel[1], pixel[2]].map(|code| table[usize::from(code)]);
        pixels.extend(std::iter::repeat_n(rgb, run.min(count - pixels.len())));
    }
    Ok(Image { width, height, pixels })
}

struct Chunks<'a> {
    bytes: &'a [u8],
    /// Pixels by their hash.
    seen: [[u8; 4]; 64],
    last: [u8; 4],
}

impl Chunks<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.bytes.split_first_chunk()?;
        self.bytes = rest;
        Some(*taken)
    }

    /// A pixel, and how often it comes.
    fn next(&mut self) -> Option<([u8; 4], usize)> {
        let [tag] = self.take()?;
        let [r, g, b, a] = self.last;
        let low = tag & 0x3f;
        let pixel = match (tag, tag >> 6) {
            (0xfe, _) => self.take().map(|[r, g, b]: [u8; 3]| [r, g, b, a])?,
            (0xff, _) => self.take()?,
            (_, 0) => self.seen[usize::from(low)],
            (_, 1) => {
                let step = |shift: u8| ((low >> shift) & 3).wrapping_sub(2);
                [r.wrapping_add(step(4)), g.wrapping_add(step(2)), b.wrapping_add(step(0)), a]
            }
            (_, 2) => {
                let [second] = self.take()?;
                let green = low.wrapping_sub(32);
                let relative = |nibble: u8| green.wrapping_add(nibble).wrapping_sub(8);
                [r.wrapping_add(relative(second >> 4)), g.wrapping_add(green), b.wrapping_add(relative(second & 15)), a]
            }
            _ => return Some((self.last, usize::from(low) + 1)),
        };
        let [r, g, b, a] = pixel.map(usize::from);
        self.seen[(3 * r + 5 * g + 7 * b + 11 * a) % 64] = pixel;
        self.last = pixel;
        Some((pixel, 1))
    }
}
