//! The peer: Mitsuba 3 from PyPI, in a virtual environment under `target/venv`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use super::image::Image;
use super::runs::{Runs, Turn};
use super::settings::{Duel, Variant};
use crate::shell::{output, root};
use crate::venv::python_with;

/// The version that the figures of this repository were measured against.
pub(crate) const PACKAGES: [&str; 2] = ["mitsuba==3.9.1", "numpy"];

/// Mitsuba, installed.
#[derive(Debug)]
pub(crate) struct Mitsuba {
    python: PathBuf,
    has_llvm: bool,
}

/// What the Python side says about its runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Account {
    version: String,
    variant: String,
    parameters: Vec<String>,
    spp: u32,
    runs: u32,
    seed: u32,
    cpu_seconds: Vec<f64>,
}

impl Mitsuba {
    /// Finds it, or installs it.
    pub(crate) fn install() -> Result<Self> {
        let python = python_with("mitsuba, numpy", &PACKAGES)?;
        Ok(Self { python, has_llvm: install_llvm() })
    }

    /// The backend to use where this one is wanted.
    pub(crate) fn available(&self, variant: Variant) -> Variant {
        if self.has_llvm { variant } else { Variant::Scalar }
    }

    /// Renders the runs of one turn. With `reuse`, takes what an earlier call left behind if it was the same request.
    pub(crate) fn render(&self, duel: &Duel, turn: Turn, directory: &Path, reuse: bool) -> Result<Runs> {
        let variant = self.available(duel.variant);
        let stem = directory.join(format!("{}_{}", variant.name(), turn.index));
        let image = |run: u32| directory.join(format!("{}_{}_{run}.npy", variant.name(), turn.index));
        let note = stem.with_extension("json");

        let parameters: Vec<String> = duel.parameters.split_whitespace().map(str::to_owned).collect();
        let is_asked = |account: &Account| {
            (account.variant.as_str(), &account.parameters) == (variant.name(), &parameters)
                && (account.spp, account.runs, account.seed) == (duel.mitsuba_spp, turn.runs, turn.seed())
        };
        let kept = std::fs::read_to_string(&note).ok().filter(|_| reuse);
        let kept: Option<Account> = kept.and_then(|text| serde_json::from_str(&text).ok());
        let account = if let Some(account) = kept.filter(|account| is_asked(account)) {
            account
        } else {
            let mut command = Command::new(&self.python);
            command.arg(root().join("xtask/python/mitsuba_render.py"));
            command.arg(super::scene_file(duel.scene));
            command.args(["--variant", variant.name(), "--spp", &duel.mitsuba_spp.to_string()]);
            command.args(["--runs", &turn.runs.to_string(), "--seed", &turn.seed().to_string()]);
            command.args(parameters.iter().flat_map(|pair| ["-D", pair])).arg("--out").arg(&stem);
            let text = output(&mut command)?;
            let line = text.lines().last().context("Mitsuba's side says nothing")?;
            std::fs::write(&note, line)?;
            serde_json::from_str(line).with_context(|| format!("not an account of runs: {line}"))?
        };
        ensure!(is_asked(&account), "Mitsuba's side rendered something else: {account:?}");
        let images = (0..turn.runs).map(|run| Image::read(&image(run))).collect::<Result<_>>()?;
        Ok(Runs { images, cpu_seconds: account.cpu_seconds.iter().sum() })
    }
}

/// Mitsuba's compiling backend needs a libLLVM from 17 on (it aborts on 15 and 16). True if there is one in the end.
fn install_llvm() -> bool {
    let is_there =
        || (17..=22).any(|version| Path::new(&format!("/usr/lib/x86_64-linux-gnu/libLLVM-{version}.so")).exists());
    if !is_there() && output(Command::new("id").arg("-u")).is_ok_and(|id| id.trim() == "0") {
        eprintln!("installing libllvm19 for Mitsuba's llvm_ad_rgb");
        let installed = output(Command::new("apt-get").args(["update", "-qq"]))
            .and_then(|_| output(Command::new("apt-get").args(["install", "-y", "-qq", "libllvm19"])));
        if let Err(error) = installed {
            eprintln!("{error:#}");
        }
    }
    if !is_there() {
        eprintln!("━━ SKIPPED: no libLLVM 17 or later, so llvm_ad_rgb is left out and scalar_rgb stands in for it.");
        eprintln!("   Mitsuba is 2 to 3 times slower so on some scenes: `apt-get install libllvm19`");
    }
    is_there()
}
