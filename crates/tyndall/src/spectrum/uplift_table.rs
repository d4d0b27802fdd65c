//! Smooth spectra for colours that are too many to be fitted one by one: the pixels of textures.
//!
//! The coefficients of [`Sigmoid`] are tabulated over the greatest component `z` (spaced more closely towards 0 and 1,
//! where they change most) and the ratios of the two others to it, and interpolated. The table is made by
//! [`Sigmoid::fit`] when the first colour is looked up; scenes without textures never pay for it.
//!
//! Source: Jakob and Hanika 2019, § 4.1; Pharr, Jakob and Humphreys 2023, § 4.6.6.

use std::sync::LazyLock;

use glam::Vec3;

use super::uplift::Sigmoid;

/// Nodes along each axis.
const NODES: usize = 20;
/// The greatest component at the first and the last node: black and white themselves have infinite coefficients.
const Z_RANGE: [f32; 2] = [1e-4, 1.0 - 1e-4];

/// By the index of the greatest component, then z, then the two ratios.
static TABLE: LazyLock<Vec<Vec3>> = LazyLock::new(|| {
    let mut table = Vec::with_capacity(3 * NODES * NODES * NODES);
    for greatest in 0..3 {
        for z in 0..NODES {
            for x in 0..NODES {
                for y in 0..NODES {
                    let ratio = |node: usize| node as f32 / (NODES - 1) as f32;
                    let z = z_of_node(z);
                    let mut rgb = [0.0; 3];
                    rgb[greatest] = z;
                    rgb[(greatest + 1) % 3] = z * ratio(x);
                    rgb[(greatest + 2) % 3] = z * ratio(y);
                    table.push(Vec3::from_array(Sigmoid::fit(rgb).c));
                }
            }
        }
    }
    table
});

/// A smooth step of a smooth step.
fn z_of_node(node: usize) -> f32 {
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let t = smooth(smooth(node as f32 / (NODES - 1) as f32));
    Z_RANGE[0] + (Z_RANGE[1] - Z_RANGE[0]) * t
}

/// The spectrum whose colour under D65 is nearly `rgb`, each component in [0, 1]: greys exactly, others to the
/// interpolation of the table.
pub fn look_up(rgb: [f32; 3]) -> Sigmoid {
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
        return Sigmoid::fit(rgb);
    }
    let greatest = (0..3).fold(0, |best, i| if rgb[i] > rgb[best] { i } else { best });
    let z = rgb[greatest].clamp(Z_RANGE[0], Z_RANGE[1]);
    let ratio = |i: usize| (rgb[(greatest + i) % 3] / rgb[greatest]).clamp(0.0, 1.0) * (NODES - 1) as f32;
    let (zi, zt) = z_cell(z);
    let cell = |along: f32| {
        let i = (along as usize).min(NODES - 2);
        (i, along - i as f32)
    };
    let ((xi, xt), (yi, yt)) = (cell(ratio(1)), cell(ratio(2)));
    let node =
        |dz: usize, dx: usize, dy: usize| TABLE[((greatest * NODES + zi + dz) * NODES + xi + dx) * NODES + yi + dy];
    let along_y = |dz: usize, dx: usize| node(dz, dx, 0).lerp(node(dz, dx, 1), yt);
    let along_x = |dz: usize| along_y(dz, 0).lerp(along_y(dz, 1), xt);
    Sigmoid { c: along_x(0).lerp(along_x(1), zt).to_array() }
}

/// The cell of `z` among the nodes, and the place in it.
fn z_cell(z: f32) -> (usize, f32) {
    let after = (1..NODES - 1).find(|&node| z_of_node(node) > z).unwrap_or(NODES - 1);
    let (low, high) = (z_of_node(after - 1), z_of_node(after));
    (after - 1, (z - low) / (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{cie, srgb};

    fn error(rgb: [f32; 3]) -> f32 {
        let sigmoid = look_up(rgb);
        let back = srgb::from_xyz(cie::xyz_under_d65(&[], |l| f64::from(sigmoid.at(l))).map(|v| v as f32));
        rgb.iter().zip(back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    /// The additive recurrence of the golden ratio's generalisation fills the cube. An 8-bit code is a step of 1/255.
    #[test]
    fn a_spectrum_of_the_table_has_nearly_the_colour_that_was_looked_up() {
        let (mut worst, mut sum) = (0.0f32, 0.0);
        let n = 1_000;
        for i in 0..n {
            let rgb = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|step: f32| (0.5 + i as f32 * step).fract());
            let error = error(rgb);
            worst = worst.max(error);
            sum += error / n as f32;
        }
        assert!(sum < 1.0 / 255.0, "mean {sum}");
        assert!(worst < 0.03, "worst {worst}");
    }

    #[test]
    fn greys_are_exact_and_black_is_black() {
        for grey in [0.0, 1e-5, 0.2, 0.5, 1.0] {
            let sigmoid = look_up([grey; 3]);
            assert!((sigmoid.at(500.0) - grey).abs() < 1e-6, "{grey}");
        }
    }
}
