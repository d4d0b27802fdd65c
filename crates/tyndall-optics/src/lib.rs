//! Where the numbers of real materials come from.
//!
//! Measured or defined by others:
//! - [`half_space`]: the medium that has the colour a user asks for.
//! - [`measured`]: scattering coefficients measured in the laboratory, by name.
//! - [`spectra`]: indices of metals and standard illuminants, by name.
//!
//! Computed from what is in them:
//! - [`recipe`]: milk, cloud, fog, ink, smoke and sea water, by their parameters.
//! - [`mixture`]: particles in a host; [`milk`] is one, [`sizes`] and [`substance`] say of what.
//! - [`mie`]: one sphere.
//! - [`medium`]: a mixture as a renderer takes it.

pub mod half_space;
mod matrix;
pub mod measured;
pub mod medium;
pub mod mie;
pub mod milk;
pub mod mixture;
pub mod recipe;
pub mod sizes;
pub mod spectra;
pub mod substance;
