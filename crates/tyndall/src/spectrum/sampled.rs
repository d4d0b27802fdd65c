//! A spectrum given by values at wavelengths: linear between them, zero outside of them (as in pbrt-v4).

use std::sync::Arc;

use super::{cie, rgb::Role, srgb};

/// Why a table is not a spectrum.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// The two lists have different lengths.
    #[error("{lambdas} wavelengths but {values} values")]
    Lengths {
        /// Number of wavelengths.
        lambdas: usize,
        /// Number of values.
        values: usize,
    },
    /// There is no value at all.
    #[error("a sampled spectrum needs at least one value")]
    Empty,
    /// A wavelength does not exceed the one before.
    #[error("wavelength {index} ({lambda} nm) is not greater than the one before")]
    NotIncreasing {
        /// Position in the list.
        index: usize,
        /// The wavelength [nm].
        lambda: f32,
    },
    /// A value is negative or not finite.
    #[error("value {index} is {value}, but a spectrum is finite and not negative")]
    BadValue {
        /// Position in the list.
        index: usize,
        /// The value.
        value: f32,
    },
}

/// Piecewise linear data.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Linear-sRGB colour, scaled.
    pub rgb: [f32; 3],
    scale: f32,
    lambda: Arc<[f32]>,
    values: Arc<[f32]>,
}

impl Sampled {
    /// From `values` at `lambda` [nm], which must increase.
    ///
    /// # Errors
    /// As [`super::Spectrum::sampled`].
    pub fn new(lambda: &[f32], values: &[f32], role: Role) -> Result<Self, SpectrumError> {
        if lambda.len() != values.len() {
            return Err(SpectrumError::Lengths { lambdas: lambda.len(), values: values.len() });
        }
        if lambda.is_empty() {
            return Err(SpectrumError::Empty);
        }
        for (index, &l) in lambda.iter().enumerate() {
            if !l.is_finite() || (index > 0 && l <= lambda[index - 1]) {
                return Err(SpectrumError::NotIncreasing { index, lambda: l });
            }
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite() || *v < 0.0) {
            return Err(SpectrumError::BadValue { index, value: values[index] });
        }
        let mut sampled = Self { rgb: [0.0; 3], scale: 1.0, lambda: lambda.into(), values: values.into() };
        let xyz = match role {
            Role::Reflectance => cie::xyz_under_d65(lambda, |l| f64::from(sampled.at(l))),
            Role::Illuminant => cie::xyz(lambda, |l| f64::from(sampled.at(l))),
        };
        sampled.rgb = srgb::from_xyz_in_gamut(xyz);
        Ok(sampled)
    }

    /// The value at `lambda` [nm].
    pub fn at(&self, lambda: f32) -> f32 {
        let above = self.lambda.partition_point(|&l| l <= lambda);
        if above == 0 {
            return 0.0;
        }
        let below = above - 1;
        if above == self.lambda.len() {
            return if lambda == self.lambda[below] { self.scale * self.values[below] } else { 0.0 };
        }
        let f = (lambda - self.lambda[below]) / (self.lambda[above] - self.lambda[below]);
        self.scale * (self.values[below] + f * (self.values[above] - self.values[below]))
    }

    /// Whether every value is zero.
    pub fn is_zero(&self) -> bool {
        self.scale == 0.0 || self.values.iter().all(|&v| v == 0.0)
    }

    /// Times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { rgb: self.rgb.map(|v| v * factor), scale: self.scale * factor, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_linear_between_and_zero_outside() {
        let s = Sampled::new(&[400.0, 500.0, 700.0], &[1.0, 3.0, 0.0], Role::Reflectance).unwrap();
        for (lambda, value) in [(399.9, 0.0), (400.0, 1.0), (450.0, 2.0), (600.0, 1.5), (700.0, 0.0), (701.0, 0.0)] {
            assert!((s.at(lambda) - value).abs() < 1e-6, "{lambda}");
        }
        assert_eq!(s.at(f32::NAN), 0.0);
    }

    /// A triangle of half width 0.1 nm and height 10 has area 1: X, Y, Z are the observer's values there.
    #[test]
    fn a_spectral_line_narrower_than_the_table_is_not_missed() {
        let line = |l: f32| Sampled::new(&[l - 0.1, l, l + 0.1], &[0.0, 10.0, 0.0], Role::Illuminant).unwrap();
        let y = srgb::luminance(line(555.43).rgb);
        assert!((y * 106.857 - 1.0).abs() < 2e-3, "{y}");
    }

    #[test]
    fn what_is_not_a_spectrum_is_refused() {
        let new = |l: &[f32], v: &[f32]| Sampled::new(l, v, Role::Reflectance).unwrap_err();
        assert_eq!(new(&[400.0], &[]), SpectrumError::Lengths { lambdas: 1, values: 0 });
        assert_eq!(new(&[], &[]), SpectrumError::Empty);
        assert_eq!(new(&[400.0, 400.0], &[1.0, 1.0]), SpectrumError::NotIncreasing { index: 1, lambda: 400.0 });
        assert!(matches!(new(&[f32::NAN], &[1.0]), SpectrumError::NotIncreasing { index: 0, .. }));
        assert_eq!(new(&[400.0], &[-1.0]), SpectrumError::BadValue { index: 0, value: -1.0 });
    }
}
