//! A signed difference as colour: blue below zero, white at zero, red above.

use tyndall::spectrum::srgb::luminance;
use tyndall_formats::film::Image;

/// sRGB bytes, three a pixel, of the difference of luminance `a − b`, and the difference that is shown in full colour:
/// the largest but for one pixel in a thousand, so that a firefly does not wash out the rest.
pub(crate) fn difference(a: &Image, b: &Image) -> (Vec<u8>, f32) {
    let differences: Vec<f32> = a.mean.iter().zip(&b.mean).map(|(a, b)| luminance(*a) - luminance(*b)).collect();
    let mut sizes: Vec<f32> = differences.iter().map(|d| d.abs()).filter(|d| d.is_finite()).collect();
    sizes.sort_by(f32::total_cmp);
    let scale = sizes.get(sizes.len().saturating_sub(1 + sizes.len() / 1000)).copied().unwrap_or(0.0);
    let pixels = differences.iter().flat_map(|d| color(if scale > 0.0 { d / scale } else { *d })).collect();
    (pixels, scale)
}

/// Interpolates in sRGB between a blue and a red of equal lightness (ColorBrewer RdBu ends) through white; black is what
/// is not a number.
fn color(x: f32) -> [u8; 3] {
    if x.is_nan() {
        return [0; 3];
    }
    let end = if x < 0.0 { [33.0, 102.0, 172.0] } else { [178.0, 24.0, 43.0] };
    let t = x.abs().min(1.0);
    end.map(|e: f32| (255.0 + (e - 255.0) * t).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_white_more_is_red_less_is_blue() {
        assert_eq!(color(0.0), [255; 3]);
        assert_eq!(color(5.0), [178, 24, 43]);
        assert_eq!(color(-1.0), [33, 102, 172]);
        assert!(color(0.1)[0] > color(0.1)[2] && color(-0.1)[2] > color(-0.1)[0]);
        assert_eq!(color(f32::NAN), [0; 3]);
    }
}
