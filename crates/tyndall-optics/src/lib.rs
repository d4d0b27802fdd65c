//! Where scattering coefficients come from.
//!
//! - [`measured`]: tables of materials measured in the laboratory, by name.

pub mod measured;
