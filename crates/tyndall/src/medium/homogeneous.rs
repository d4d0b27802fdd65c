//! A medium with the same coefficients everywhere.
//!
//! Transmittance over a distance `d` is `exp(−σ_t d)` (Beer–Lambert), free flights have the density
//! `σ_t exp(−σ_t s)`, a collision scatters with the albedo `σ_s / σ_t`. What absorbs may also emit: along a ray the radiance
//! grows by `σ_a L_e` [W·m⁻²·sr⁻¹ per length], so that a thick medium that only absorbs shines with `L_e` (Kirchhoff).

use crate::{
    phase::Phase,
    spectrum::{Lanes, Spectrum, Wavelengths},
};

/// Coefficients as the scene has them.
#[derive(Debug, Clone)]
pub struct Homogeneous {
    /// Absorption [1/length].
    pub sigma_a: Spectrum,
    /// Scattering [1/length].
    pub sigma_s: Spectrum,
    /// Radiance that it emits per unit of absorption, if any [W·m⁻²·sr⁻¹].
    pub emission: Option<Spectrum>,
    /// Where scattered light goes.
    pub phase: Phase,
}

/// Coefficients at the wavelengths of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Extinction `σ_a + σ_s` [1/length].
    pub sigma_t: Lanes,
    /// Scattering [1/length].
    pub sigma_s: Lanes,
    /// Emission `σ_a L_e` [W·m⁻²·sr⁻¹ per length].
    pub source: Lanes,
}

impl Homogeneous {
    /// The coefficients in the lanes of a path.
    #[inline]
    pub fn coefficients(&self, wavelengths: &Wavelengths) -> Coefficients {
        let (sigma_a, sigma_s) = (self.sigma_a.eval(wavelengths), self.sigma_s.eval(wavelengths));
        let source = self.emission.as_ref().map_or(Lanes::ZERO, |le| sigma_a * le.eval(wavelengths));
        Coefficients { sigma_t: sigma_a + sigma_s, sigma_s, source }
    }
}

impl Coefficients {
    /// `exp(−σ_t d)`; a lane without extinction passes everything, even over infinity.
    #[inline]
    pub fn transmittance(&self, distance: f32) -> Lanes {
        if distance.is_finite() {
            (self.sigma_t * -distance).exp()
        } else {
            self.sigma_t.map(|s| if s > 0.0 { 0.0 } else { 1.0 })
        }
    }
}
