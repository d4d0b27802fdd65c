//! How far round a surface of revolution goes, and between which heights.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::math::{Vec2, fast};

/// The azimuths of a surface of revolution: from 0 (its own x axis) to a full turn or a part of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn(f64);

impl Turn {
    /// All the way round.
    pub const FULL: Self = Self(1.0);

    /// As far as an angle \[degrees\], held in 0 to 360.
    pub fn degrees(angle: f64) -> Self {
        Self((angle / 360.0).clamp(0.0, 1.0))
    }

    /// In turns \[1\].
    pub fn turns(self) -> f64 {
        self.0
    }

    /// In radians.
    pub fn radians(self) -> f64 {
        self.0 * TAU
    }

    /// Whether the azimuth of a vector across the axis is within.
    #[inline]
    pub(super) fn holds(self, across: DVec2) -> bool {
        self.0 >= 1.0 || turns(across) <= self.0
    }
}

/// The azimuth of a vector in turns, in [0, 1) up to rounding \[1\].
#[inline]
pub(super) fn turns(across: DVec2) -> f64 {
    let turn = fast::atan2(across.y, across.x) / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// A part of a sphere: between two planes across its axis, and some way round it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpherePart {
    /// Heights of the planes over the radius, in [−1, 1] and in order \[1\].
    pub z: [f64; 2],
    /// How far round.
    pub turn: Turn,
}

impl SpherePart {
    /// All of it.
    pub const WHOLE: Self = Self { z: [-1.0, 1.0], turn: Turn::FULL };

    /// Between two heights of a sphere of this radius [length].
    pub fn new(radius: f64, heights: [f64; 2], turn: Turn) -> Self {
        let [a, b] = heights.map(|z| (z / radius).clamp(-1.0, 1.0));
        Self { z: [a.min(b), a.max(b)], turn }
    }

    /// Whether nothing is missing.
    pub fn is_whole(&self) -> bool {
        *self == Self::WHOLE
    }

    /// Whether the part holds a unit vector from the centre.
    #[inline]
    pub(super) fn holds(&self, n: DVec3) -> bool {
        let [low, high] = self.z;
        (low <= -1.0 || n.z >= low) && (high >= 1.0 || n.z <= high) && self.turn.holds(n.truncate())
    }

    /// Angles of its southern and northern rim from the axis [rad].
    #[inline]
    pub(super) fn rims(&self) -> [f64; 2] {
        if self.z == Self::WHOLE.z { [PI, 0.0] } else { self.z.map(f64::acos) }
    }

    /// The parameters of a direction from the centre: `u` is the azimuth over its range, `v` the angle from the southern rim over
    /// that between the rims \[1\].
    pub(super) fn parameters(&self, n: DVec3) -> Vec2 {
        let [south, north] = self.rims();
        let u = turns(n.truncate()) / self.turn.turns();
        let v = (fast::atan2(n.truncate().length(), n.z) - south) / (north - south);
        Vec2::new(u as f32, v as f32)
    }

    /// Share of the area of the sphere \[1\].
    pub fn share(&self) -> f64 {
        0.5 * (self.z[1] - self.z[0]) * self.turn.turns()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Archimedes: the area between two planes is that of the cylinder around them; half the turn is half of it.
    #[test]
    fn the_share_of_a_part_is_that_of_the_cylinder_around_it() {
        let part = SpherePart::new(2.0, [1.0, -3.0], Turn::degrees(180.0));
        assert_eq!(part.share(), 0.375);
        assert!(part.holds(DVec3::Y) && !part.holds(-DVec3::Y) && !part.holds(DVec3::Z));
        assert!(SpherePart::new(2.0, [-2.0, 5.0], Turn::degrees(400.0)).is_whole());
    }
}
