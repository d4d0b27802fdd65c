//! sampling

pub mod discrete;
pub mod piecewise2d;
pub mod spherical_rectangle;
pub mod spherical_triangle;
pub mod warp;
