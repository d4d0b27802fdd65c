//! Ctrl-C: the first asks the render to end, the second ends the program.

use std::{
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use anyhow::Context;

/// Whether somebody pressed Ctrl-C (or sent SIGTERM).
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Exit status of a program that was interrupted: 128 + SIGINT.
pub(crate) const EXIT: u8 = 130;

/// Supervisors such as `timeout` signal a process and its group, so that one wish arrives twice: a second signal is one
/// of its own after this time only.
const SAME_WISH: Duration = Duration::from_millis(500);

/// Listens from now on.
pub(crate) fn listen() -> anyhow::Result<()> {
    let mut first: Option<Instant> = None;
    ctrlc::set_handler(move || {
        INTERRUPTED.store(true, Ordering::Relaxed);
        if first.get_or_insert_with(Instant::now).elapsed() > SAME_WISH {
            std::process::exit(EXIT.into());
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// Whether it was asked for.
pub(crate) fn requested() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
