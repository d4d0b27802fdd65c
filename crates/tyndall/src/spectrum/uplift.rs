//! From linear sRGB to a smooth reflectance spectrum.
//!
//! ```text
//! S(λ) = s(c₀ + c₁ t + c₂ t²),   s(x) = ½ + x / (2 √(1 + x²)),   t = (λ − 595 nm) / 235 nm ∈ [−1, 1]
//! ```
//!
//! Three coefficients for three components: a spectrum that is smooth, within \[0, 1\] and has exactly the wanted colour
//! under D65. They are found by Gauss–Newton steps in CIELab with Levenberg's damping, for each colour when the scene is
//! built (`docs/adr/0003-uplift.md` says why there is no table).
//!
//! Source: Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling".

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::{cie, srgb};

/// The spectrum `s(c₀ + c₁ t + c₂ t²)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sigmoid {
    /// c₀, c₁, c₂; c₀ is infinite for black and white.
    pub c: [f32; 3],
}

impl Sigmoid {
    /// The spectrum whose colour under D65 is `rgb`, each component in [0, 1].
    pub fn fit(rgb: [f32; 3]) -> Self {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return Self { c: [grey(f64::from(rgb[0])) as f32, 0.0, 0.0] };
        }
        Self { c: fit(rgb.map(f64::from)).as_vec3().to_array() }
    }

    /// The reflectance at `lambda` [nm].
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        let t = (lambda - 595.0) / 235.0;
        let x = self.c[0] + t * (self.c[1] + t * self.c[2]);
        // Written without the difference of near equals, and so that infinite x gives 0 or 1.
        let root = (1.0 + x * x).sqrt();
        let tail = 0.5 / (root * (root + x.abs()));
        if x < 0.0 { tail } else { 1.0 - tail }
    }
}

/// The x at which s(x) = v.
fn grey(v: f64) -> f64 {
    (v - 0.5) / (v * (1.0 - v)).sqrt()
}

/// The table at 1 nm: t and the weights that give XYZ under D65.
static NODES: LazyLock<Vec<(f64, DVec3)>> = LazyLock::new(|| {
    (360..=830)
        .map(|l| {
            let lambda = l as f32;
            let weight = if l == 360 || l == 830 { 0.5 } else { 1.0 };
            let observer = DVec3::from_array(cie::observer(lambda).map(f64::from));
            (f64::from(lambda - 595.0) / 235.0, observer * f64::from(cie::d65(lambda)) * weight)
        })
        .collect()
});

/// XYZ of the spectrum of `c`, and its derivatives by c₀, c₁, c₂ as columns.
fn colour(c: DVec3) -> (DVec3, DMat3) {
    let (mut xyz, mut jacobian) = (DVec3::ZERO, DMat3::ZERO);
    for &(t, weight) in NODES.iter() {
        let x = c.x + t * (c.y + t * c.z);
        let root = (1.0 + x * x).sqrt();
        xyz += weight * (0.5 + 0.5 * x / root);
        let slope = weight * (0.5 / (root * root * root));
        jacobian.x_axis += slope;
        jacobian.y_axis += slope * t;
        jacobian.z_axis += slope * (t * t);
    }
    (xyz, jacobian)
}

/// CIELab relative to `white`, and its derivatives by XYZ.
fn lab(xyz: DVec3, white: DVec3) -> (DVec3, DMat3) {
    // CIE 015: the cube root, continued below (6/29)³ by its tangent.
    let curve = |r: f64| {
        if r > (6.0f64 / 29.0).powi(3) {
            (r.cbrt(), r.cbrt() / (3.0 * r))
        } else {
            let slope = (29.0f64 / 6.0).powi(2) / 3.0;
            (slope * r + 4.0 / 29.0, slope)
        }
    };
    let ratio = xyz / white;
    let ((fx, dx), (fy, dy), (fz, dz)) = (curve(ratio.x), curve(ratio.y), curve(ratio.z));
    let (dx, dy, dz) = (dx / white.x, dy / white.y, dz / white.z);
    let value = DVec3::new(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz));
    let derivatives = DMat3::from_cols(
        DVec3::new(0.0, 500.0 * dx, 0.0),
        DVec3::new(116.0 * dy, -500.0 * dy, 200.0 * dy),
        DVec3::new(0.0, 0.0, -200.0 * dz),
    );
    (value, derivatives)
}

/// Coefficients for `rgb` in [0, 1]³, not grey.
fn fit(rgb: [f64; 3]) -> DVec3 {
    let white = DVec3::from_array(srgb::to_xyz([1.0; 3]));
    let target = lab(DVec3::from_array(srgb::to_xyz(rgb)), white).0;
    let y = (DVec3::from_array(srgb::to_xyz(rgb)).y).clamp(1e-3, 1.0 - 1e-3);
    let mut c = DVec3::new(grey(y), 0.0, 0.0);
    let residual = |c: DVec3| {
        let (xyz, dxyz) = colour(c);
        let (value, dlab) = lab(xyz, white);
        (value - target, dlab * dxyz)
    };
    let (mut r, mut jacobian) = residual(c);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        if r.length_squared() < 1e-16 {
            break;
        }
        let normal = jacobian.transpose() * jacobian;
        let diagonal = DMat3::from_diagonal(DVec3::new(normal.x_axis.x, normal.y_axis.y, normal.z_axis.z));
        let step = (normal + diagonal * damping).inverse() * (jacobian.transpose() * r);
        let (next_r, next_jacobian) = residual(c - step);
        if next_r.length_squared() < r.length_squared() {
            (c, r, jacobian) = (c - step, next_r, next_jacobian);
            damping = (0.1 * damping).max(1e-12);
        } else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    c
}

/// More than any colour needs: most take 8, the gamut's corners 30.
const STEPS: usize = 200;

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trip(rgb: [f32; 3]) -> f32 {
        let s = Sigmoid::fit(rgb);
        let xyz = cie::xyz_under_d65(&[], |l| f64::from(s.at(l)));
        let back = srgb::from_xyz(xyz.map(|v| v as f32));
        rgb.iter().zip(back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    /// Halton points in bases 2, 3, 5 fill the cube; the corners and edges are the hardest colours.
    #[test]
    fn every_colour_of_the_cube_comes_back_from_its_spectrum() {
        let halton = |base: u32, mut i: u32| {
            let (mut value, mut digit) = (0.0, 1.0);
            while i > 0 {
                digit /= base as f32;
                value += digit * (i % base) as f32;
                i /= base;
            }
            value
        };
        let interior = (1..=1000).map(|i| [2, 3, 5].map(|base| halton(base, i)));
        let steps = [0.0, 1e-4, 1e-2, 0.5, 0.99, 0.9999, 1.0];
        let boundary = (0..343).map(|i| [steps[i % 7], steps[i / 7 % 7], steps[i / 49]]);
        for rgb in interior.chain(boundary) {
            let error = round_trip(rgb);
            // 4.4e-5 is the worst that was measured: the trapezoid rule of the fit against Simpson's of the test.
            assert!(error < 1e-4, "{rgb:?} comes back {error} off: {:?}", Sigmoid::fit(rgb));
        }
    }

    #[test]
    fn spectra_stay_within_zero_and_one_and_grey_is_flat() {
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.9999], [0.3, 0.3, 0.3]] {
            let s = Sigmoid::fit(rgb);
            for lambda in 360..=830 {
                let v = s.at(lambda as f32);
                assert!((0.0..=1.0).contains(&v), "{rgb:?} at {lambda} nm: {v}");
                if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
                    assert!((v - rgb[0]).abs() < 1e-6, "{rgb:?} at {lambda} nm: {v}");
                }
            }
        }
    }

    /// s(x) → ¼x⁻² as x → −∞: the tail keeps its relative precision in single precision.
    #[test]
    fn dark_spectra_are_precise() {
        for x in [-1e2f32, -1e4, -1e8] {
            let v = f64::from(Sigmoid { c: [x, 0.0, 0.0] }.at(500.0));
            let x = f64::from(x);
            let exact = 0.5 / ((1.0 + x * x).sqrt() * ((1.0 + x * x).sqrt() - x));
            assert!((v / exact - 1.0).abs() < 1e-5, "{x}: {v} {exact}");
        }
    }
}
