//! Our side: the release binary, called as a user calls it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use super::image::Image;
use super::runs::{Runs, Turn};
use crate::shell::{cargo, output, root, target, tee};

/// The binary `tyndall`.
#[derive(Debug)]
pub(crate) struct Tyndall {
    /// The file
    pub(crate) binary: PathBuf,
}

impl Tyndall {
    /// The binary that the environment variable `TYNDALL` names, so that any build can be measured; else builds the
    /// release binary.
    pub(crate) fn find() -> Result<Self> {
        if let Some(binary) = std::env::var_os("TYNDALL") {
            let binary = PathBuf::from(binary).canonicalize().context("TYNDALL names no file")?;
            return Ok(Self { binary });
        }
        tee(&mut cargo("build --release --package tyndall-cli"))?;
        Ok(Self { binary: target().join("release/tyndall") })
    }

    /// A call of `tyndall render` that says nothing.
    pub(crate) fn render_command(&self, scene: &Path, spp: u32, image: &Path) -> Command {
        let mut command = Command::new(&self.binary);
        command.arg("render").arg(scene).args(["--spp", &spp.to_string()]).arg("-o").arg(image).current_dir(root());
        command
    }

    /// Renders the runs of one turn; `label` names the files, `extra` are further arguments.
    pub(crate) fn render(&self, scene: &Path, spp: u32, turn: Turn, label: &Path, extra: &[&str]) -> Result<Runs> {
        let mut runs = Runs { images: Vec::new(), cpu_seconds: 0.0 };
        for run in 0..turn.runs {
            let image = image_of(label, turn, run);
            let mut command = self.render_command(scene, spp, &image);
            command.args(["--seed", &(turn.seed() + run).to_string()]).args(extra);
            command.arg("--json").arg(image.with_extension("json"));
            let begun = children_cpu_seconds()?;
            output(&mut command)?;
            runs.cpu_seconds += children_cpu_seconds()? - begun;
            runs.images.push(Image::read(&image)?);
        }
        Ok(runs)
    }
}

fn image_of(label: &Path, turn: Turn, run: u32) -> PathBuf {
    PathBuf::from(format!("{}_{}_{run}.exr", label.display(), turn.index))
}

/// What the first run of a turn says of itself.
pub(crate) fn report(label: &Path, turn: Turn) -> Result<serde_json::Value> {
    let path = image_of(label, turn, 0).with_extension("json");
    let text = std::fs::read_to_string(&path).with_context(|| format!("no report at {}", path.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// CPU seconds of all threads of all children that have ended: fields 16 and 17 of `/proc/self/stat`, in ticks of
/// 10 ms. Measured from outside, so the start and the reading of the scene count against tyndall.
pub(crate) fn children_cpu_seconds() -> Result<f64> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").context("CPU time of children is read from /proc (Linux)")?;
    let after_name = text.rsplit_once(')').context("a name in /proc/self/stat")?.1;
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3).and_then(|ticks| ticks.parse::<f64>().ok());
    let (user, system) = ticks(16).zip(ticks(17)).context("times in /proc/self/stat")?;
    Ok((user + system) / TICKS_PER_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A loop of 200,000 steps takes dash or bash between 0.1 and 2 s.
    #[test]
    fn the_time_of_an_ended_child_is_counted() {
        let begun = children_cpu_seconds().unwrap();
        output(Command::new("sh").args(["-c", "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done"])).unwrap();
        let spent = children_cpu_seconds().unwrap() - begun;
        assert!(spent > 0.02 && spent < 20.0, "{spent} s");
    }
}
