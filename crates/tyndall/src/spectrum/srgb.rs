//! Linear sRGB: primaries and white of IEC 61966-2-1 (Rec. 709).
//!
//! The matrix is computed from the primaries' chromaticities and from the white that the table of D65 in [`super::cie`]
//! has, so that D65 is exactly `(1, 1, 1)`. (The standard rounds its white to (0.3127, 0.3290): differences below 2·10⁻⁴.)

use std::sync::LazyLock;

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::cie;

/// Chromaticities (x, y) of red, green and blue.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

/// Rec. 709 weights of luminance.
pub const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Columns are the XYZ of red, green and blue, scaled so that they add to white.
static TO_XYZ: LazyLock<DMat3> = LazyLock::new(|| {
    let unscaled = DMat3::from_cols_array_2d(&PRIMARIES.map(|[x, y]| [x / y, 1.0, (1.0 - x - y) / y]));
    let white = DVec3::from_array(cie::xyz_under_d65(&[], |_| 1.0));
    unscaled * DMat3::from_diagonal(unscaled.inverse() * white)
});

static FROM_XYZ: LazyLock<Mat3> = LazyLock::new(|| TO_XYZ.inverse().as_mat3());

/// Tristimulus values to linear sRGB; a colour outside of the gamut has negative components.
#[inline]
pub fn from_xyz(xyz: [f32; 3]) -> [f32; 3] {
    (*FROM_XYZ * Vec3::from_array(xyz)).to_array()
}

/// Linear sRGB to tristimulus values.
pub fn to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    (*TO_XYZ * DVec3::from_array(rgb)).to_array()
}

/// Rec. 709 luminance of linear sRGB.
#[inline]
pub fn luminance(rgb: [f32; 3]) -> f32 {
    LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2]
}

/// The colour of `xyz` without negative components and of the same luminance: what `rgb` mode can carry.
pub fn from_xyz_in_gamut(xyz: [f64; 3]) -> [f32; 3] {
    let rgb = from_xyz(xyz.map(|v| v as f32));
    if rgb.iter().all(|&v| v >= 0.0) {
        return rgb;
    }
    let clipped = rgb.map(|v| v.max(0.0));
    let y = luminance(clipped);
    if y > 0.0 { clipped.map(|v| v * xyz[1] as f32 / y) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IEC 61966-2-1 gives this matrix to four digits, for its rounded white.
    #[test]
    fn the_matrix_is_that_of_the_standard_to_its_rounding() {
        let standard = [[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192], [0.1805, 0.0722, 0.9505]];
        for (primary, exact) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().zip(standard) {
            for (a, b) in to_xyz(primary).into_iter().zip(exact) {
                assert!((a - b).abs() < 5e-4, "{a} {b}");
            }
        }
    }

    #[test]
    fn white_is_one_and_conversions_are_inverse() {
        let white = from_xyz(cie::xyz_under_d65(&[], |_| 1.0).map(|v| v as f32));
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-6), "{white:?}");
        let back = from_xyz(to_xyz([0.2, 0.5, 0.9]).map(|v| v as f32));
        assert!(back.iter().zip([0.2, 0.5, 0.9]).all(|(a, b)| (a - b).abs() < 1e-6), "{back:?}");
    }

    #[test]
    fn a_laser_keeps_its_luminance_in_the_gamut() {
        let laser = cie::observer(532.0).map(|v| f64::from(v) * 100.0);
        let rgb = from_xyz_in_gamut(laser);
        assert!(rgb.iter().all(|&v| v >= 0.0) && (f64::from(luminance(rgb)) - laser[1]).abs() < 1e-5, "{rgb:?}");
    }
}
