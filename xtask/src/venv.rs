//! Peers that come from PyPI, in one virtual environment under `target/venv`.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Result;

use crate::shell::{answers, root, tee};

/// The environment's Python, with these packages installed; `modules` is what they are called in an import.
pub(crate) fn python_with(modules: &str, packages: &[&str]) -> Result<PathBuf> {
    let venv = root().join("target/venv");
    let python = venv.join("bin/python");
    if !python.exists() {
        tee(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
    }
    if !answers(Command::new(&python).args(["-c", &format!("import {modules}")])) {
        eprintln!("installing {} in {}", packages.join(", "), venv.display());
        tee(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages))?;
    }
    Ok(python)
}
