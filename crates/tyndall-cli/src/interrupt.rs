//! Ctrl-C: the first asks the render to end, the second ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context;

/// Whether somebody pressed Ctrl-C (or sent SIGTERM).
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Exit status of a program that was interrupted: 128 + SIGINT.
pub(crate) const EXIT: u8 = 130;

/// Listens from now on.
pub(crate) fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::SeqCst) {
            std::process::exit(EXIT.into());
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// Whether it was asked for.
pub(crate) fn requested() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
