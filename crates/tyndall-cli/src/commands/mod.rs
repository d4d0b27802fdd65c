//! What the program can do, a page each.

pub(crate) mod compare;
pub(crate) mod convert;
pub(crate) mod info;
pub(crate) mod lab;
pub(crate) mod layers;
pub(crate) mod lecture;
pub(crate) mod materials;
pub(crate) mod mix;
pub(crate) mod pack;
pub(crate) mod render;
pub(crate) mod separate;
pub(crate) mod verify;
