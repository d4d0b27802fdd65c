//! What fills space: scattering coefficients, a phase function, and which medium and which bodies a path is in.

pub mod bodies;
pub mod boundary;
pub mod crossing;
pub mod enclosure;
pub mod homogeneous;

pub use bodies::{Body, BodyId, Member, Within};
pub use boundary::{Inside, MediumInterface};
pub use crossing::Skin;
pub use homogeneous::{Coefficients, Homogeneous};

/// Index of a medium of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MediumId(pub u32);
