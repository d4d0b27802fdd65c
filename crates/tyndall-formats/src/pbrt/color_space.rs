//! The colour spaces of `ColorSpace`, as linear sRGB.
//!
//! | name | red | green | blue | white |
//! |---|---|---|---|---|
//! | `srgb` | 0.64, 0.33 | 0.30, 0.60 | 0.15, 0.06 | D65 |
//! | `dci-p3` | 0.68, 0.32 | 0.265, 0.69 | 0.15, 0.06 | D65 |
//! | `rec2020` | 0.708, 0.292 | 0.17, 0.797 | 0.131, 0.046 | D65 |
//! | `aces2065-1` | 0.7347, 0.2653 | 0, 1 | 0.0001, −0.077 | 0.32168, 0.33767 |
//!
//! A light keeps its colour. What filters light keeps its colour as seen under the white of its space: white stays flat
//! (Bradford's transform to D65, Lam 1985). Colours outside of sRGB lose their negative components and keep their
//! luminance; what filters light then stays within its greatest component, so that a reflectance remains one. pbrt-v4 finds
//! spectra for each space instead: there the image of a saturated colour differs.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};
use tyndall::spectrum::{cie, srgb};

/// A colour space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ColorSpace {
    #[default]
    Srgb,
    DciP3,
    Rec2020,
    Aces,
}

/// To tristimulus values: of light, and of what is seen under the white of D65.
struct Matrices {
    light: DMat3,
    filter: DMat3,
}

static DCI_P3: LazyLock<Matrices> = LazyLock::new(|| matrices([[0.68, 0.32], [0.265, 0.69], [0.15, 0.06]], d65()));
static REC_2020: LazyLock<Matrices> =
    LazyLock::new(|| matrices([[0.708, 0.292], [0.17, 0.797], [0.131, 0.046]], d65()));
static ACES: LazyLock<Matrices> = LazyLock::new(|| {
    let white = of_chromaticity([0.32168, 0.33767]);
    matrices([[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077]], white)
});

impl ColorSpace {
    pub(super) const NAMES: [(&'static str, Self); 4] =
        [("srgb", Self::Srgb), ("dci-p3", Self::DciP3), ("rec2020", Self::Rec2020), ("aces2065-1", Self::Aces)];

    /// Linear sRGB of a light.
    pub(super) fn light(self, rgb: [f64; 3]) -> [f64; 3] {
        let Some(m) = self.matrices() else { return rgb };
        in_gamut(m.light * DVec3::from_array(rgb))
    }

    /// Linear sRGB of a reflectance or coefficient.
    pub(super) fn filter(self, rgb: [f64; 3]) -> [f64; 3] {
        let Some(m) = self.matrices() else { return rgb };
        let most = rgb[0].max(rgb[1]).max(rgb[2]);
        if rgb.iter().all(|c| *c == most) {
            return rgb; // grey is grey, without rounding
        }
        in_gamut(m.filter * DVec3::from_array(rgb)).map(|c| c.min(most))
    }

    fn matrices(self) -> Option<&'static Matrices> {
        match self {
            Self::Srgb => None,
            Self::DciP3 => Some(&DCI_P3),
            Self::Rec2020 => Some(&REC_2020),
            Self::Aces => Some(&ACES),
        }
    }
}

fn in_gamut(xyz: DVec3) -> [f64; 3] {
    srgb::from_xyz_in_gamut(xyz.to_array()).map(f64::from)
}

fn d65() -> DVec3 {
    DVec3::from_array(cie::xyz_under_d65(&[], |_| 1.0))
}

/// Tristimulus values of luminance 1.
fn of_chromaticity([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

fn matrices(primaries: [[f64; 2]; 3], white: DVec3) -> Matrices {
    // Green of ACES has y = 1 and its blue a negative y: columns are (x, y, z), which divide by nothing.
    let [r, g, b] = primaries.map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
    let unscaled = DMat3::from_cols(r, g, b);
    let light = unscaled * DMat3::from_diagonal(unscaled.inverse() * white);
    Matrices { light, filter: bradford(white, d65()) * light }
}

/// Bradford's adaptation from one white to another.
fn bradford(from: DVec3, to: DVec3) -> DMat3 {
    let cone = DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);
    cone.inverse() * DMat3::from_diagonal((cone * to) / (cone * from)) * cone
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3], tolerance: f64) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance), "{a:?} {b:?}");
    }

    /// White is white in every space, and a mirror reflects all.
    #[test]
    fn white_and_grey_stay_what_they_are() {
        for (_, space) in ColorSpace::NAMES {
            near(space.filter([1.0; 3]), [1.0; 3], 1e-6);
            near(space.filter([0.3, 0.300_001, 0.3]), [0.3; 3], 1e-5);
            let y = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
            assert!((y(space.light([1.0; 3])) - 1.0).abs() < 1e-3);
        }
        near(ColorSpace::Rec2020.light([1.0; 3]), [1.0; 3], 1e-4);
    }

    /// ITU-R BT.2087 gives the matrix from BT.2020 to BT.709: rows (1.6605, −0.5876, −0.0728), (−0.1246, 1.1329, −0.0083),
    /// (−0.0182, −0.1006, 1.1187). (0.5, 0.4, 0.3) lies within both.
    #[test]
    fn rec2020_becomes_rec709_by_the_matrix_of_the_itu() {
        let rgb = [0.5, 0.4, 0.3];
        let rows = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]];
        let expected: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| rows[i][j] * rgb[j]).sum());
        near(ColorSpace::Rec2020.light(rgb), expected, 5e-4);
    }

    /// The ACES matrix to linear Rec. 709 with Bradford's adaptation (TB-2014-004 and its published product):
    /// rows (2.5217, −1.1341, −0.3876), (−0.2765, 1.3727, −0.0963), (−0.0154, −0.1530, 1.1683).
    #[test]
    fn aces_reflectances_are_adapted_to_d65() {
        let rgb = [0.45, 0.4, 0.35];
        let rows = [[2.5217, -1.1341, -0.3876], [-0.2765, 1.3727, -0.0963], [-0.0154, -0.1530, 1.1683]];
        let expected: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| rows[i][j] * rgb[j]).sum());
        near(ColorSpace::Aces.filter(rgb), expected.map(|c: f64| c.min(0.45)), 1e-3);
    }

    /// The red of Rec. 2020 is more saturated than sRGB can say: its luminance is kept as light, and as a reflectance no
    /// component exceeds the 1 that was given.
    #[test]
    fn a_colour_outside_of_srgb_keeps_its_luminance_or_stays_a_reflectance() {
        let red = ColorSpace::Rec2020.light([1.0, 0.0, 0.0]);
        assert!(red.iter().all(|c| *c >= 0.0));
        let y = 0.2126 * red[0] + 0.7152 * red[1] + 0.0722 * red[2];
        assert!((y - 0.2627).abs() < 1e-3, "{y}"); // BT.2020's own weight of red
        near(ColorSpace::Rec2020.filter([1.0, 0.0, 0.0]), [1.0, 0.0, 0.0], 1e-9);
    }
}
