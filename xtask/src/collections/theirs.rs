//! Mitsuba's side, and images as Mitsuba reads them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::limits::{End, Limits};
use crate::peers::image::Image;
use crate::peers::mitsuba::PACKAGES;
use crate::shell::root;
use crate::venv::python_with;

/// What the Python side was asked for and says that it did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Account {
    version: String,
    spp: u32,
    runs: u32,
    seed: u32,
    resolution: Option<String>,
}

/// Mitsuba, installed.
#[derive(Debug)]
pub(crate) struct Theirs {
    python: PathBuf,
    limits: Limits,
}

impl Theirs {
    /// Finds it, or installs it.
    pub(crate) fn install(limits: Limits) -> Result<Self> {
        Ok(Self { python: python_with("mitsuba, numpy", &PACKAGES)?, limits: Limits { gibibytes: None, ..limits } })
    }

    /// Independent renders of a scene by `scalar_rgb`, or why it does not. What an earlier call left under the name `stem`
    /// is taken if it was the same request: the scenes of a collection do not change.
    pub(crate) fn render(
        &self,
        scene: &Path,
        size: [usize; 2],
        spp: u32,
        runs: u32,
        stem: &Path,
    ) -> Result<Result<Vec<Image>, String>> {
        let resolution = format!("{}x{}", size[0], size[1]);
        let note = stem.with_extension("note.json");
        let is_asked = |account: &Account| {
            (account.spp, account.runs, account.resolution.as_ref()) == (spp, runs, Some(&resolution))
        };
        let kept = std::fs::read_to_string(&note).ok().and_then(|text| serde_json::from_str::<Account>(&text).ok());
        if !kept.is_some_and(|account| is_asked(&account)) {
            let end = self.limits.run(&self.python, |command| {
                command.arg(root().join("xtask/python/mitsuba_render.py")).arg(scene);
                command.args(["--variant", "scalar_rgb", "--spp", &spp.to_string(), "--runs", &runs.to_string()]);
                command.args(["--seed", "1", "--resolution", &resolution, "--out"]).arg(stem);
            })?;
            match end {
                End::Done(stdout) => std::fs::write(&note, stdout.lines().last().context("no account")?)?,
                End::Failed(stderr) | End::Broken(stderr) => return Ok(Err(last_line(&stderr))),
                End::TooLong => return Ok(Err("takes too long".to_owned())),
            }
        }
        let file = |run: u32| PathBuf::from(format!("{}_{run}.npy", stem.display()));
        (0..runs).map(|run| Image::read(&file(run))).collect::<Result<_>>().map(Ok)
    }

    /// An image in any format that Mitsuba reads, in linear sRGB, through a file at `npy`.
    pub(crate) fn read_image(&self, image: &Path, npy: &Path) -> Result<Image> {
        const SCRIPT: &str = "import sys, numpy, mitsuba as mi; mi.set_variant('scalar_rgb'); \
            bitmap = mi.Bitmap(sys.argv[1]).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False); \
            numpy.save(sys.argv[2], numpy.array(bitmap))";
        match self.limits.run(&self.python, |command| {
            command.args(["-c", SCRIPT]).arg(image).arg(npy);
        })? {
            End::Done(_) => Image::read(npy),
            End::Failed(stderr) | End::Broken(stderr) => anyhow::bail!("{}", last_line(&stderr)),
            End::TooLong => anyhow::bail!("{} takes too long to read", image.display()),
        }
    }
}

/// The last line that says something: the message of a Python exception.
fn last_line(stderr: &str) -> String {
    let lines = || stderr.lines().map(str::trim).filter(|line| !line.is_empty());
    lines().rfind(|line| line.contains("Error")).or_else(|| lines().next_back()).unwrap_or("says nothing").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_traceback_the_message_is_told() {
        let traceback = "Traceback (most recent call last):\n  File \"a.py\"\nRuntimeError: no plugin\n  at line 3\n";
        assert_eq!(last_line(traceback), "RuntimeError: no plugin");
        assert_eq!(last_line(""), "says nothing");
    }
}
