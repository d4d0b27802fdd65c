//! What fills space: scattering coefficients, a phase function, and which medium a path is in.

pub mod boundary;
pub mod homogeneous;

pub use boundary::{Inside, MediumInterface};
pub use homogeneous::{Coefficients, Homogeneous};

/// Index of a medium of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MediumId(pub u32);
