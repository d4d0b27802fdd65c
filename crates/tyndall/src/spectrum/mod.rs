//! Colour as it is carried along a path: four lanes.

pub mod lanes;

pub use lanes::Lanes;
