//! Spectra as users write them.

use std::path::PathBuf;

/// A function of wavelength, not yet resolved. What it measures (a reflectance, a coefficient \[1/length\], a radiance
/// \[W·m⁻²·sr⁻¹\], an index) is said by the field that holds it, and so is what an RGB triple becomes.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumDesc {
    /// The same at every wavelength.
    Constant(f64),
    /// Linear sRGB.
    Rgb([f64; 3]),
    /// A black body. Its size is said by [`Magnitude`](super::Magnitude).
    Blackbody {
        /// Temperature \[K\], positive.
        kelvin: f64,
    },
    /// Piecewise linear between samples; nothing beyond the first and the last.
    Samples {
        /// Wavelengths \[nm\], increasing.
        lambda: Vec<f64>,
        /// Values, as many.
        values: Vec<f64>,
    },
    /// Measured data known by name: `glass-BK7`, `metal-Cu-eta`, `stdillum-D65`.
    Named(String),
    /// A file of pairs of wavelength \[nm\] and value.
    File(PathBuf),
}
