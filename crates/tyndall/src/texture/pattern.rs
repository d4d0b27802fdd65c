//! Regular patterns: boards, dots and veins.
//!
//! Source: Pharr, Jakob and Humphreys 2023, § 10.4.2 and § 10.5.3; the colours of the marble are pbrt's.

use super::{
    TexturePoint,
    mapping::{Mapping2, Mapping3},
    noise::{fbm, perlin},
};
use crate::math::{Vec2, Vec3};

/// Fields that alternate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Checkerboard {
    /// Unit squares.
    Plane(Mapping2),
    /// Unit cubes.
    Space(Mapping3),
}

impl Checkerboard {
    /// 0 on the field from the origin to (1, 1), 1 on its neighbours, and so on.
    #[inline]
    pub fn at(&self, at: &TexturePoint) -> f32 {
        let odd = |x: f32| x.floor().rem_euclid(2.0);
        let sum = match self {
            Self::Plane(mapping) => mapping.at(at).to_array().map(odd).iter().sum::<f32>(),
            Self::Space(mapping) => mapping.at(at.p).to_array().map(odd).iter().sum::<f32>(),
        };
        sum.rem_euclid(2.0)
    }
}

/// Whether a place is within a dot. Half of the unit cells have one, of radius 0.35 and shifted at random.
pub fn in_a_dot(st: Vec2) -> bool {
    const RADIUS: f32 = 0.35;
    let cell = (st + 0.5).floor();
    let noise = |s: f32, t: f32| perlin(Vec3::new(cell.x + s, cell.y + t, 0.5));
    if noise(0.5, 0.5) <= 0.0 {
        return false;
    }
    let shift = Vec2::new(noise(1.5, 2.8), noise(4.5, 9.8)) * (0.5 - RADIUS);
    (st - cell - shift).length_squared() < RADIUS * RADIUS
}

/// Veined grey stone: a sine of height, disturbed by noise, through a spline of greys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marble {
    /// Terms of the noise.
    pub octaves: u32,
    /// Ratio of their sizes [1].
    pub omega: f32,
    /// Factor on the coordinates [1].
    pub scale: f32,
    /// How much the noise disturbs the layers.
    pub variation: f32,
    /// To the space of the layers.
    pub mapping: Mapping3,
}

/// Control points of the spline: stone, and veins of two kinds.
const GREYS: [[f32; 3]; 9] = {
    const STONE: [f32; 3] = [0.58, 0.58, 0.6];
    [STONE, STONE, STONE, [0.5, 0.5, 0.5], [0.6, 0.59, 0.58], STONE, STONE, [0.2, 0.2, 0.33], STONE]
};

impl Marble {
    /// Linear-sRGB reflectance, in [0, 1].
    pub fn rgb(&self, at: &TexturePoint) -> [f32; 3] {
        let p = self.mapping.at(at.p) * self.scale;
        let layer = p.y + self.variation * fbm(p, self.omega, self.octaves);
        let segments = (GREYS.len() - 3) as f32;
        let along = (0.5 + 0.5 * layer.sin()) * segments;
        let first = along.floor().clamp(0.0, segments - 1.0);
        let controls: [Vec3; 4] = std::array::from_fn(|i| Vec3::from_array(GREYS[first as usize + i]));
        (1.5 * bezier(controls, along - first)).to_array()
    }
}

/// De Casteljau's algorithm.
fn bezier(mut points: [Vec3; 4], t: f32) -> Vec3 {
    for last in (1..4).rev() {
        for i in 0..last {
            points[i] = points[i].lerp(points[i + 1], t);
        }
    }
    points[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Transform;

    fn at(p: Vec3) -> TexturePoint {
        TexturePoint { p, uv: p.truncate().into(), n: Vec3::Z, part: None }
    }

    #[test]
    fn neighbouring_fields_of_a_board_differ_also_below_zero() {
        let board = Checkerboard::Plane(Mapping2::UV);
        let field = |s: f32, t: f32| board.at(&at(Vec3::new(s, t, 0.0)));
        assert_eq!([field(0.5, 0.5), field(1.5, 0.5), field(1.5, 1.5), field(-0.5, 0.5)], [0.0, 1.0, 0.0, 1.0]);
        let cubes = Checkerboard::Space(Mapping3 { from_world: Transform::IDENTITY });
        assert_eq!(cubes.at(&at(Vec3::new(0.5, 0.5, -0.5))), 1.0);
    }

    /// Where the noise in the middle of a cell is positive there is a dot, which covers π·0.35² of the cell: no more, for
    /// it is shifted by at most 0.15 and stays within. The lattice of n² points a cell estimates that share to about 1/n.
    #[test]
    fn a_cell_has_one_whole_dot_or_none() {
        let n = 200;
        let whole = std::f32::consts::PI * 0.35 * 0.35;
        let mut dots = 0;
        for cell in 0..100 {
            let corner = Vec2::new((cell % 10) as f32, (cell / 10) as f32) - 0.5;
            let place = |i: usize| corner + (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32;
            let share = (0..n * n).filter(|&i| in_a_dot(place(i))).count() as f32 / (n * n) as f32;
            assert!(share == 0.0 || (share - whole).abs() < 1.0 / n as f32, "cell {cell}: {share}");
            dots += i32::from(share > 0.0);
        }
        assert!((20..80).contains(&dots), "{dots} of 100 cells have a dot");
    }

    #[test]
    fn marble_is_a_reflectance() {
        let mapping = Mapping3 { from_world: Transform::IDENTITY };
        let marble = Marble { octaves: 8, omega: 0.5, scale: 1.0, variation: 0.2, mapping };
        for i in 0..1_000 {
            let rgb = marble.rgb(&at(Vec3::new(i as f32 * 0.17, i as f32 * 0.07, 1.0)));
            assert!(rgb.iter().all(|c| (0.25..=0.95).contains(c)), "{rgb:?}");
        }
    }
}
