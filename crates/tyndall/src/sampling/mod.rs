//! Random numbers, low-discrepancy samples, and the maps that turn them into directions and choices.

pub mod rng;
pub mod sampler;

pub use rng::Rng;
pub use sampler::{Sampler, SamplerKind};
