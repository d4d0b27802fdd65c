//! The threads of a render.

use anyhow::Context;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Of each thread [bytes]: the estimators of the lecture recur a thousand times and more, as the slides do.
const STACK: usize = 16 << 20;

/// So many threads, or one for each core.
pub(crate) fn pool(threads: Option<u16>) -> anyhow::Result<ThreadPool> {
    let threads = threads.map_or(0, usize::from);
    ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build().context("cannot start the threads")
}
