//! Axis-aligned bounding boxes.

use glam::Vec3;

/// The box `min ≤ p ≤ max`; empty when `min > max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Least corner [length].
    pub min: Vec3,
    /// Greatest corner [length].
    pub max: Vec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// All of space.
    pub const EVERYTHING: Self = Self { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

    /// The smallest box around `points`.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// This box grown to hold `p`.
    #[must_use]
    pub fn with(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether nothing is inside.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether `p` is inside or on the boundary.
    #[inline]
    pub fn contains(&self, p: Vec3) -> bool {
        (p.cmpge(self.min) & p.cmple(self.max)).all()
    }

    /// A lower bound on the distance from `p` to the box; 0 inside [length].
    pub fn distance(&self, p: Vec3) -> f32 {
        (self.min - p).max(p - self.max).max(Vec3::ZERO).length() * (1.0 - 4.0 * f32::EPSILON)
    }

    /// Edge lengths [length].
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Half of the surface [length²].
    pub fn half_area(&self) -> f32 {
        let Vec3 { x, y, z } = self.extent();
        x * y + y * z + z * x
    }

    /// The middle [length].
    pub fn centre(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The eight corners [length].
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            Vec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }
}
