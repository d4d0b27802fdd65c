//! tyndall-formats

pub mod film;
