//! Our side: what `tyndall` does with a scene.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::limits::{End, Limits};
use crate::peers::image::Image;

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Failure {
    /// All that it complains of are words that it knows it does not know yet
    NotYet(Vec<String>),
    /// A file that the scene names is not there
    FileMissing(Vec<String>),
    /// It complains of other things (too)
    Refused(Vec<String>),
    /// It broke
    Broken(String),
    /// It took too long
    TooLong,
}

/// A picture of a scene.
#[derive(Debug)]
pub(crate) struct Picture {
    /// Its pixels
    pub(crate) image: Image,
    /// To read and to build the scene [s]
    pub(crate) load_seconds: f64,
    /// To render it [s]
    pub(crate) render_seconds: f64,
}

/// The part of tyndall's statistics that is looked at.
#[derive(Deserialize)]
struct Statistics {
    startup_seconds: Startup,
    wall_seconds: f64,
    non_finite_samples: u64,
}

#[derive(Deserialize)]
struct Startup {
    load: f64,
    build: f64,
}

/// The program, and what it may take.
#[derive(Debug)]
pub(crate) struct Ours {
    /// The binary
    pub(crate) binary: PathBuf,
    /// For each call
    pub(crate) limits: Limits,
}

impl Ours {
    /// Width and height of the image that the scene asks for; what is not known yet is left out if `lenient`.
    pub(crate) fn size(&self, scene: &Path, lenient: bool) -> Result<Result<[usize; 2], Failure>> {
        let end = self.limits.run(&self.binary, |command| {
            command.arg("info").arg(scene);
            if lenient {
                command.arg("--lenient");
            }
        })?;
        let stdout = match succeeded(end) {
            Ok(stdout) => stdout,
            Err(failure) => return Ok(Err(failure)),
        };
        let words = stdout.lines().find_map(|line| line.strip_prefix("image ")).context("info tells no size")?;
        let size = words.split(',').next().unwrap_or_default().trim();
        let (width, height) = size.split_once('x').context("info tells no size")?;
        Ok(Ok([width.parse()?, height.parse()?]))
    }

    /// One render, to `image` (without ending): `.exr`, `.png` and `.json`.
    pub(crate) fn render(
        &self,
        scene: &Path,
        size: [usize; 2],
        spp: u32,
        seed: u32,
        image: &Path,
    ) -> Result<Result<Picture, Failure>> {
        let (exr, json) = (image.with_extension("exr"), image.with_extension("json"));
        let end = self.limits.run(&self.binary, |command| {
            command.arg("render").arg(scene).args(["--quiet", "--spp", &spp.to_string(), "--seed", &seed.to_string()]);
            command.arg("--resolution").arg(format!("{}x{}", size[0], size[1]));
            command.arg("-o").arg(image).arg("--json").arg(&json);
        })?;
        if let Err(failure) = succeeded(end) {
            return Ok(Err(failure));
        }
        let statistics: Statistics = serde_json::from_str(&std::fs::read_to_string(&json)?)?;
        if statistics.non_finite_samples > 0 {
            let count = statistics.non_finite_samples;
            return Ok(Err(Failure::Broken(format!("{count} samples are no radiance (not finite or negative)"))));
        }
        Ok(Ok(Picture {
            image: Image::read(&exr)?,
            load_seconds: statistics.startup_seconds.load + statistics.startup_seconds.build,
            render_seconds: statistics.wall_seconds,
        }))
    }
}

fn succeeded(end: End) -> Result<String, Failure> {
    match end {
        End::Done(stdout) => Ok(stdout),
        End::Failed(stderr) => Err(classify(&stderr)),
        End::Broken(stderr) => Err(Failure::Broken(stderr.lines().take(3).collect::<Vec<_>>().join(" "))),
        End::TooLong => Err(Failure::TooLong),
    }
}

/// Sorts the messages of a refusal. Words that are not known yet say so themselves.
fn classify(stderr: &str) -> Failure {
    let mut messages: Vec<String> =
        stderr.lines().filter_map(|line| line.strip_prefix("error: ")).map(str::to_owned).collect();
    messages.dedup();
    let is_not_yet = |message: &String| {
        [" not known yet", " not supported yet", " is not supported", "are not supported"]
            .iter()
            .any(|words| message.contains(words))
    };
    let is_missing = |message: &String| message.contains("No such file");
    match () {
        () if messages.is_empty() => Failure::Broken(stderr.lines().take(3).collect::<Vec<_>>().join(" ")),
        () if messages.iter().all(is_not_yet) => Failure::NotYet(messages),
        () if messages.iter().all(|message| is_missing(message) || is_not_yet(message)) => {
            Failure::FileMissing(messages)
        }
        () => {
            messages.sort_by_key(is_not_yet); // what is wrong comes before what is not there yet
            Failure::Refused(messages)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_are_sorted_by_what_they_say() {
        let not_yet = "error: the bsdf \"hair\" is not known yet\n --> a.xml:1:1\n";
        let slip = "error: there is no shape \"spere\"\n";
        let missing = "error: cannot read a.ply: No such file or directory (os error 2)\n";
        assert!(matches!(classify(not_yet), Failure::NotYet(messages) if messages.len() == 1));
        assert!(matches!(classify(missing), Failure::FileMissing(_)));
        let Failure::Refused(both) = classify(&format!("{not_yet}{slip}")) else { panic!("not refused") };
        assert_eq!(both, ["there is no shape \"spere\"", "the bsdf \"hair\" is not known yet"]);
        assert!(matches!(classify("Killed"), Failure::Broken(_)));
    }
}
