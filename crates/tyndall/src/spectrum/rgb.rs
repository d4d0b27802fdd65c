//! A colour of the scene file as a spectrum.
//!
//! - a reflectance: the smooth spectrum in \[0, 1\] of that colour under D65, [`super::uplift`];
//! - a coefficient, which may exceed 1: twice its greatest component times the reflectance of the rest, so that the
//!   reflectance peaks near one half, where it is smoothest;
//! - a light: the same, times D65.
//!
//! Source: Jakob and Hanika 2019, section 4; Pharr, Jakob and Humphreys 2023, section 4.6.6.

use super::{cie, uplift::Sigmoid};

/// What a spectrum is used for: it decides which colour it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Something that filters light, seen under D65.
    Reflectance,
    /// Light.
    Illuminant,
}

/// `scale · sigmoid(λ)`, times D65 for a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RgbSpectrum {
    /// Linear-sRGB colour, scaled.
    pub rgb: [f32; 3],
    /// Whether D65 is a factor.
    pub role: Role,
    scale: f32,
    sigmoid: Sigmoid,
}

impl RgbSpectrum {
    /// A reflectance in \[0, 1\]; a colour that exceeds 1 is taken as [`Self::unbounded`].
    pub fn albedo(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| v.max(0.0));
        if rgb.iter().any(|&v| v > 1.0) {
            return Self::unbounded(rgb);
        }
        Self { rgb, role: Role::Reflectance, scale: 1.0, sigmoid: Sigmoid::fit(rgb) }
    }

    /// A coefficient of components in [0, ∞).
    pub fn unbounded(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| v.max(0.0));
        let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        let reflectance = if scale > 0.0 { rgb.map(|v| v / scale) } else { [0.0; 3] };
        Self { rgb, role: Role::Reflectance, scale, sigmoid: Sigmoid::fit(reflectance) }
    }

    /// A light of components in [0, ∞).
    pub fn illuminant(rgb: [f32; 3]) -> Self {
        Self { role: Role::Illuminant, ..Self::unbounded(rgb) }
    }

    /// The value at `lambda` [nm].
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        let value = self.scale * self.sigmoid.at(lambda);
        match self.role {
            Role::Reflectance => value,
            Role::Illuminant => value * cie::d65(lambda),
        }
    }

    /// Times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { rgb: self.rgb.map(|v| v * factor), scale: self.scale * factor, ..self }
    }
}
