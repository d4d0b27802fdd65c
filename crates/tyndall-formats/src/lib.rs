//! tyndall-formats

pub mod image;
pub mod mesh;
