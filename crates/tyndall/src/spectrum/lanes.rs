//! The four values that a path carries: radiance, throughput or coefficients, one a lane.
//!
//! - `rgb`: lanes are linear-sRGB red, green, blue and **green again**. With the copy every mean over the lanes is a
//!   fair mixture of four techniques, so spectral MIS needs to know nothing of the mode; the film drops the copy.
//! - `spectral`: four hero wavelengths.
//! - `mono`: one value in all four.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub};

use glam::Vec4;

use crate::math::fast;

/// Four lanes of a spectral quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lanes(pub Vec4);

impl Lanes {
    /// No light.
    pub const ZERO: Self = Self(Vec4::ZERO);
    /// Unit throughput.
    pub const ONE: Self = Self(Vec4::ONE);

    /// The same value in every lane.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self(Vec4::splat(v))
    }

    /// From four values.
    #[inline]
    pub const fn new(values: [f32; 4]) -> Self {
        Self(Vec4::from_array(values))
    }

    /// Linear-sRGB as lanes (green stands twice).
    #[inline]
    pub const fn rgb(r: f32, g: f32, b: f32) -> Self {
        Self(Vec4::new(r, g, b, g))
    }

    /// The lanes as an array.
    #[inline]
    pub const fn to_array(self) -> [f32; 4] {
        self.0.to_array()
    }

    /// One lane.
    #[inline]
    pub fn lane(self, i: usize) -> f32 {
        self.0[i]
    }

    /// The mean over lanes.
    #[inline]
    pub fn mean(self) -> f32 {
        0.25 * self.0.element_sum()
    }

    /// The greatest lane.
    #[inline]
    pub fn max_lane(self) -> f32 {
        self.0.max_element()
    }

    /// The least lane.
    #[inline]
    pub fn min_lane(self) -> f32 {
        self.0.min_element()
    }

    /// `exp` of each lane.
    #[inline]
    #[must_use]
    pub fn exp(self) -> Self {
        let [a, b, c, d] = self.to_array();
        Self::new([fast::exp(a), fast::exp(b), fast::exp(c), fast::exp(d)])
    }

    /// Whether every lane is exactly zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.0 == Vec4::ZERO
    }

    /// Whether no lane is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// Each lane, held between `low` and `high`.
    #[inline]
    #[must_use]
    pub fn clamp(self, low: f32, high: f32) -> Self {
        Self(self.0.clamp(Vec4::splat(low), Vec4::splat(high)))
    }

    /// Each lane through `f`.
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(self.to_array().map(f))
    }
}

macro_rules! lane_wise {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self { Self($trait::$method(self.0, other.0)) }
        }
        impl $trait<f32> for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: f32) -> Self { Self($trait::$method(self.0, other)) }
        }
    )*};
}
lane_wise!(Add add, Sub sub, Mul mul, Div div);

impl Mul<Lanes> for f32 {
    type Output = Lanes;
    #[inline]
    fn mul(self, lanes: Lanes) -> Lanes {
        lanes * self
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Lanes {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl MulAssign for Lanes {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        self.0 *= other.0;
    }
}

impl MulAssign<f32> for Lanes {
    #[inline]
    fn mul_assign(&mut self, factor: f32) {
        self.0 *= factor;
    }
}

impl DivAssign<f32> for Lanes {
    #[inline]
    fn div_assign(&mut self, divisor: f32) {
        self.0 /= divisor;
    }
}
