//! What the program can do, a page each.

pub(crate) mod compare;
