//! Portable float map: three lines of text (`PF` or `Pf`, width and height, a scale whose sign is the byte order), then
//! 32-bit floats, rows from the bottom.

use super::{Image, check_size};

pub(super) fn parse(bytes: &[u8]) -> Result<Image, String> {
    let mut rest = bytes;
    let mut word = || next_word(&mut rest);
    let channels = match word().as_deref() {
        Some("PF") => 3,
        Some("Pf") => 1,
        _ => return Err("does not begin with `PF` or `Pf`".into()),
    };
    let (width, height) = (word(), word());
    let side = |word: Option<String>| word.and_then(|w| w.parse::<u32>().ok()).ok_or("has no width and height");
    let (width, height) = check_size(side(width)?.into(), side(height)?.into())?;
    let scale = word().and_then(|w| w.parse::<f32>().ok()).filter(|s| s.is_finite() && *s != 0.0);
    let scale = scale.ok_or("has no scale (negative: little-endian)")?;

    let row = width as usize * channels;
    let (needed, found) = (row * height as usize * 4, rest.len());
    if found < needed {
        return Err(format!("ends too early: {needed} bytes of pixels expected, {found} found"));
    }
    let from_bytes = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let values: Vec<f32> = rest[..needed].chunks_exact(4).map(|b| from_bytes([b[0], b[1], b[2], b[3]])).collect();
    let pixel = |c: &[f32]| if channels == 3 { [c[0], c[1], c[2]] } else { [c[0]; 3] };
    let pixels = values.chunks_exact(row).rev().flat_map(|row| row.chunks_exact(channels).map(pixel)).collect();
    Ok(Image { width, height, pixels })
}

/// Takes the next word of the header and the one white space behind it.
fn next_word(rest: &mut &[u8]) -> Option<String> {
    let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
    let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
    let word = String::from_utf8_lossy(&rest[start..start + length]).into_owned();
    *rest = &rest[start + length + 1..];
    Some(word)
}
