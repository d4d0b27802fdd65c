//! Perlin's noise, and the sums of it that make clouds, waves and wrinkles.
//!
//! ```text
//! fBm(p)        = Σ ωⁱ N(1.99ⁱ p),      i = 0 … octaves − 1
//! turbulence(p) = Σ ωⁱ |N(1.99ⁱ p)|
//! windy(p)      = |fBm(p/10; ω = ½, 3 octaves)| · fBm(p; ω = ½, 6 octaves)
//! ```
//!
//! `N` has the gradients and the permutation of Perlin 2002, "Improving Noise"; the frequency ratio is 1.99, so that the
//! zeros of the octaves do not fall together. Source of the sums: Pharr, Jakob and Humphreys 2023, § 10.5 (third edition
//! § 10.6 for `windy` and `wrinkled`).

use super::mapping::Mapping3;
use crate::math::Vec3;

/// A number that wanders at random through space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Which sum.
    pub kind: Kind,
    /// To the space of the noise.
    pub mapping: Mapping3,
}

/// Which sum of noises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Fractional Brownian motion.
    Fbm {
        /// Number of terms.
        octaves: u32,
        /// ω, the ratio of their sizes [1].
        omega: f32,
    },
    /// Turbulence: the sum of absolute values.
    Wrinkled {
        /// Number of terms.
        octaves: u32,
        /// ω, the ratio of their sizes [1].
        omega: f32,
    },
    /// Waves under gusts.
    Windy,
}

impl Noise {
    /// The value at a point of the world.
    pub fn at(&self, p: Vec3) -> f32 {
        let p = self.mapping.at(p);
        match self.kind {
            Kind::Fbm { octaves, omega } => fbm(p, omega, octaves),
            Kind::Wrinkled { octaves, omega } => sum(p, omega, octaves, f32::abs),
            Kind::Windy => fbm(0.1 * p, 0.5, 3).abs() * fbm(p, 0.5, 6),
        }
    }
}

/// `Σ ωⁱ N(1.99ⁱ p)`.
pub fn fbm(p: Vec3, omega: f32, octaves: u32) -> f32 {
    sum(p, omega, octaves, |n| n)
}

fn sum(p: Vec3, omega: f32, octaves: u32, of: impl Fn(f32) -> f32) -> f32 {
    let (mut total, mut frequency, mut size) = (0.0, 1.0, 1.0);
    for _ in 0..octaves {
        total += size * of(perlin(frequency * p));
        frequency *= 1.99;
        size *= omega;
    }
    total
}

/// Perlin's improved noise: zero on the integer lattice, smooth, of mean 0.
pub fn perlin(p: Vec3) -> f32 {
    // Beyond 2³⁰ there are no cells to tell apart.
    let p = p % (1 << 30) as f32;
    let cell = p.floor();
    let d = p - cell;
    let [x, y, z] = cell.to_array().map(|c| c as i64);
    let corner = |i: i64, j: i64, k: i64| gradient(x + i, y + j, z + k, d - Vec3::new(i as f32, j as f32, k as f32));
    let [u, v, w] = d.to_array().map(fade);
    let lerp = |t: f32, a: f32, b: f32| (1.0 - t) * a + t * b;
    let edge = |j: i64, k: i64| lerp(u, corner(0, j, k), corner(1, j, k));
    lerp(w, lerp(v, edge(0, 0), edge(1, 0)), lerp(v, edge(0, 1), edge(1, 1)))
}

/// The dot product of the lattice point's gradient, one of the twelve edges of a cube, with the way from it.
fn gradient(x: i64, y: i64, z: i64, d: Vec3) -> f32 {
    let step = |i: i64, c: i64| i64::from(PERMUTATION[((i + c) & 255) as usize]);
    let h = step(step(step(0, x), y), z) & 15;
    let u = if h < 8 || h == 12 || h == 13 { d.x } else { d.y };
    let v = if h < 4 || h == 12 || h == 13 { d.y } else { d.z };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// 6t⁵ − 15t⁴ + 10t³.
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Perlin's permutation of 0 … 255.
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17,
    182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129,
    22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238,
    210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184,
    84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_permutation_has_every_number_once() {
        let mut sorted = PERMUTATION;
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i == v as usize));
    }

    #[test]
    fn noise_is_zero_on_the_lattice_and_continuous_across_it() {
        for i in -40..40i32 {
            let p = Vec3::new(i as f32, (i * 7 % 13) as f32, (i * 5 % 11) as f32);
            assert_eq!(perlin(p), 0.0);
            let off = Vec3::new(0.3, 0.6, 0.2);
            let (left, right) = (perlin(p + off - Vec3::X * 0.3001), perlin(p + off - Vec3::X * 0.2999));
            assert!((left - right).abs() < 1e-3, "{left} {right}");
        }
    }

    /// The sum 1 + ω + … bounds the sums of noises, for |N| ≤ 1.
    #[test]
    fn noise_and_its_sums_stay_within_their_bounds() {
        let mut greatest = 0.0f32;
        for i in 0..20_000 {
            let p = Vec3::new(i as f32 * 0.137, i as f32 * 0.0731 - 300.0, i as f32 * 0.0213);
            greatest = greatest.max(perlin(p).abs());
            assert!(fbm(p, 0.5, 8).abs() < 2.0);
        }
        assert!(greatest > 0.5 && greatest <= 1.0, "{greatest}");
        assert!(perlin(Vec3::splat(1e30)).is_finite());
    }
}
