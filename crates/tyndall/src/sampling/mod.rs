//! Random numbers, low-discrepancy samples, and the maps that turn them into directions and choices.

pub mod discrete;
pub mod piecewise2d;
pub mod rng;
pub mod sampler;
pub mod spherical_rectangle;
pub mod spherical_triangle;
pub mod warp;
pub mod windowed2d;

pub use rng::Rng;
pub use sampler::{Sampler, SamplerKind};
