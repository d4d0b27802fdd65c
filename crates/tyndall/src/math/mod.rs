//! Vectors, rays, frames, transforms, bounds, and the few functions that scalar and SIMD code share bit for bit.

pub mod bounds;
pub mod fast;
pub mod frame;
pub mod ray;
pub mod rounding;
pub mod transform;

pub use bounds::Bounds;
pub use frame::Frame;
pub use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
pub use ray::Ray;
pub use transform::Transform;
