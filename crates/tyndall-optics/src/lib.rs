//! Where the numbers of real materials come from.
//!
//! - [`half_space`]: the medium that has the colour a user asks for.
//! - [`measured`]: scattering coefficients measured in the laboratory, by name.
//! - [`spectra`]: indices of metals and standard illuminants, by name.

pub mod half_space;
mod matrix;
pub mod measured;
pub mod spectra;
