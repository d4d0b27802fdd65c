//! What grains are of: a refractive index at 589 nm, and how much they absorb by wavelength, `σ_a = 4π k / λ` with the imaginary
//! part `k` of the index.

use std::f64::consts::PI;

use clap::ValueEnum;

/// A substance. Glass, salt, sugar and sand absorb too little for a grain of a millimetre to show it.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Material {
    /// Crown glass N-BK7, 1.5168 (Schott's data sheet)
    Glass,
    /// Green window glass, 1.5234, which absorbs (Rubin 1985)
    Green,
    /// Sodium chloride, 1.544 (Li 1976)
    Salt,
    /// Sucrose, 1.558: the mean of 1.538, 1.565, 1.571 along its axes (CRC Handbook)
    Sugar,
    /// Ice, 1.31, which absorbs red light over metres (Warren and Brandt 2008)
    Snow,
    /// Quartz, 1.544 (Ghosh 1999, ordinary ray)
    Sand,
}

/// Wavelength [nm] and `k` of green window glass: M. Rubin, Optical properties of soda lime silica glasses, 1985.
const GREEN: [(f64, f64); 7] = [
    (400.0, 1.025e-6),
    (450.0, 9.902e-7),
    (500.0, 8.659e-7),
    (550.0, 1.169e-6),
    (600.0, 2.264e-6),
    (650.0, 3.942e-6),
    (700.0, 5.363e-6),
];
/// Of ice: S. G. Warren and R. E. Brandt, Optical constants of ice from the ultraviolet to the microwave, 2008.
const ICE: [(f64, f64); 7] = [
    (400.0, 2.365e-11),
    (450.0, 9.239e-11),
    (500.0, 5.889e-10),
    (550.0, 2.289e-9),
    (600.0, 5.730e-9),
    (650.0, 1.430e-8),
    (700.0, 2.900e-8),
];

impl Material {
    /// Refractive index \[1\].
    pub(super) fn eta(self) -> f64 {
        match self {
            Self::Glass => 1.5168,
            Self::Green => 1.5234,
            Self::Salt | Self::Sand => 1.544,
            Self::Sugar => 1.558,
            Self::Snow => 1.31,
        }
    }

    /// Wavelengths [nm] with absorption coefficients [1/mm], of what absorbs.
    pub(super) fn absorption(self) -> Option<Vec<(f64, f64)>> {
        let table = match self {
            Self::Green => GREEN,
            Self::Snow => ICE,
            Self::Glass | Self::Salt | Self::Sugar | Self::Sand => return None,
        };
        // A wavelength in millimetres is a millionth of it in nanometres.
        Some(table.iter().map(|&(nm, k)| (nm, 4.0 * PI * k / (nm * 1e-6))).collect())
    }
}
