//! A renderer for light that scatters many times.
//!
//! The library takes no files, prints nothing and reads no clock: `tyndall-formats` turns what a user wrote into a
//! [`scene::Scene`], this crate turns a scene into an image with its standard error ([`render::render`]).
//!
//! The floors, from the ground up: [`math`] and [`sampling`], [`spectrum`] and [`texture`], the models ([`phase`], [`medium`],
//! [`bsdf`], [`light`], [`shape`], [`camera`]), then [`path`] and [`integrator`]; and beside
//! them the [`lecture`] that it all comes from.

pub mod bend;
pub mod bsdf;
pub mod camera;
pub mod feature;
pub mod film;
pub mod granular;
pub mod integrator;
pub mod lecture;
pub mod light;
pub mod lpe;
pub mod material;
pub mod math;
pub mod medium;
pub mod path;
pub mod phase;
pub mod relief;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod shape;
pub mod spectrum;
mod surface;
pub mod tally;
pub mod texture;
