//! Rays beside Embree's. The measurement links the library, so it is a feature of xtask that only this bench builds, in
//! release mode: the other chores start without compiling tyndall, and work while it does not compile.

use anyhow::Result;

/// Measures and prints.
#[cfg(feature = "rays")]
pub(super) fn run() -> Result<()> {
    crate::bench_rays::run()
}

/// Installs Embree and starts the build that measures.
#[cfg(not(feature = "rays"))]
pub(super) fn run() -> Result<()> {
    if let Err(error) = crate::venv::python_with("embreex", &["embreex"]) {
        eprintln!("━━ SKIPPED: Embree is not here, so only our rays are measured: {error:#}");
    }
    crate::shell::tee(&mut crate::shell::cargo("run --release --package xtask --features rays -- bench rays"))?;
    Ok(())
}
