//! The tyndall command line.
fn main() {}
