//! A renderer for light that scatters many times.
//!
//! The library takes no files, prints nothing and reads no clock: `tyndall-formats` turns what a user wrote into a
//! [`scene`], this crate turns a scene into an image with its standard error.
//!
//! The floors, from the ground up: [`math`] and [`sampling`], [`spectrum`], the models ([`phase`], [`medium`],
//! [`bsdf`], [`light`], [`shape`], [`camera`]), then paths and the integrators.

pub mod bsdf;
pub mod film;
pub mod math;
pub mod phase;
pub mod sampling;
pub mod shape;
pub mod spectrum;
pub mod tally;
