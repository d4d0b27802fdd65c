//! Where the numbers of real materials come from.
//!
//! - [`measured`]: scattering coefficients measured in the laboratory, by name.
//! - [`spectra`]: indices of metals and standard illuminants, by name.

pub mod measured;
pub mod spectra;
