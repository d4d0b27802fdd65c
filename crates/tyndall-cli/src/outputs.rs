//! Where images go, and putting them there.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use anyhow::{Context, bail};
use tyndall_formats::film::{Curve, Image, Tone, exr, png, save};

use crate::args::{CurveName, ToneOptions};

/// Endings of image files that somebody may expect and that are not written here.
const UNKNOWN_ENDINGS: [&str; 10] = ["jpg", "jpeg", "tif", "tiff", "hdr", "pfm", "bmp", "gif", "webp", "tga"];

/// The files of a render.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outputs {
    pub(crate) files: Vec<PathBuf>,
    pub(crate) tone: Tone,
}

impl Outputs {
    /// The files that were asked for, or those named after the scene.
    pub(crate) fn new(asked: &[PathBuf], scene: &Path, tone: Tone) -> anyhow::Result<Self> {
        let mut files = Vec::new();
        for name in asked {
            files.extend(expand(name)?);
        }
        if files.is_empty() {
            files = expand(&stem_of_scene(scene))?;
        }
        Ok(Self { files, tone })
    }

    /// Whether all of them could be written: better known before the render than after it.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        for file in &self.files {
            save::check(file).with_context(|| hint(file))?;
        }
        Ok(())
    }

    /// Writes all of them, each whole or not at all.
    pub(crate) fn write(&self, image: &Image) -> anyhow::Result<()> {
        for file in &self.files {
            if is_png(file) { png::write(file, image, self.tone) } else { exr::write(file, image) }?;
        }
        Ok(())
    }

    /// `a.exr and a.png hold`.
    pub(crate) fn hold(&self) -> String {
        format!("{} hold{}", self.names(), if self.files.len() == 1 { "s" } else { "" })
    }

    /// `a.exr and a.png`.
    pub(crate) fn names(&self) -> String {
        self.files.iter().map(|f| f.display().to_string()).collect::<Vec<_>>().join(" and ")
    }
}

impl From<ToneOptions> for Tone {
    fn from(options: ToneOptions) -> Self {
        let curve = match options.curve {
            CurveName::Srgb => Curve::Srgb,
            CurveName::Filmic => Curve::Filmic,
        };
        Self { exposure: options.exposure, curve }
    }
}

/// Writes a line to standard output; a reader that has gone away is no fault.
pub(crate) fn say(line: &str) -> anyhow::Result<()> {
    write_text("-".as_ref(), line)
}

/// Writes text to a file, or to standard output if its name is `-`.
pub(crate) fn write_text(to: &Path, text: &str) -> anyhow::Result<()> {
    if to == Path::new("-") {
        let mut stdout = std::io::stdout().lock();
        return match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
            // The reader has seen enough: `tyndall info SCENE | head`.
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
            outcome => outcome.context("cannot write to standard output"),
        };
    }
    Ok(save::replace(to, format!("{text}\n").as_bytes())?)
}

/// The command line, with quotes where words hold spaces.
pub(crate) fn command_line() -> String {
    let quoted = |word: String| if word.contains(' ') { format!("'{word}'") } else { word };
    std::env::args_os().map(|word| quoted(word.to_string_lossy().into_owned())).collect::<Vec<_>>().join(" ")
}

/// What may be wrong with a file that cannot be written.
fn hint(file: &Path) -> String {
    match file.parent() {
        Some(dir) if !dir.as_os_str().is_empty() && !dir.exists() => {
            format!("the directory {} does not exist", dir.display())
        }
        _ => "the image could not be saved".into(),
    }
}

/// Whether a name ends in `.png`.
pub(crate) fn is_png(file: &Path) -> bool {
    ending(file) == "png"
}

fn ending(file: &Path) -> String {
    file.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// A name with a known ending stands for itself, any other for a stem of both files.
fn expand(name: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let ending = ending(name);
    if ending == "exr" || ending == "png" {
        return Ok(vec![name.to_owned()]);
    }
    if UNKNOWN_ENDINGS.contains(&ending.as_str()) {
        bail!("images are written as .exr or .png, not as .{ending}: {}", name.display());
    }
    if name.file_name().is_none() {
        bail!("{} is no name for an image", name.display());
    }
    let with = |ending| {
        let mut file = name.as_os_str().to_owned();
        file.push(ending);
        PathBuf::from(file)
    };
    Ok(vec![with(".exr"), with(".png")])
}

/// `milk` for `scenes/milk.pbrt` and, because `scene` says nothing, for `scenes/milk/scene.pbrt`.
pub(crate) fn stem_of_scene(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().unwrap_or("image".as_ref());
    let parent = std::path::absolute(scene).ok().and_then(|p| Some(p.parent()?.file_name()?.to_owned()));
    match parent {
        Some(parent) if stem == "scene" => parent.into(),
        _ => stem.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(asked: &[&str], scene: &str) -> Vec<String> {
        let asked: Vec<PathBuf> = asked.iter().map(PathBuf::from).collect();
        let outputs = Outputs::new(&asked, Path::new(scene), Tone::default()).unwrap();
        outputs.files.iter().map(|f| f.display().to_string()).collect()
    }

    #[test]
    fn a_stem_writes_both_files_and_a_name_writes_itself() {
        assert_eq!(files(&["out/a"], "s.pbrt"), ["out/a.exr", "out/a.png"]);
        assert_eq!(files(&["a.PNG", "b.v2"], "s.pbrt"), ["a.PNG", "b.v2.exr", "b.v2.png"]);
        assert!(Outputs::new(&["a.jpg".into()], Path::new("s.pbrt"), Tone::default()).is_err());
        assert!(Outputs::new(&["..".into()], Path::new("s.pbrt"), Tone::default()).is_err());
    }

    #[test]
    fn the_scene_names_the_image() {
        assert_eq!(files(&[], "dir/fog.xml"), ["fog.exr", "fog.png"]);
        assert_eq!(files(&[], "scenes/milk/scene.pbrt"), ["milk.exr", "milk.png"]);
    }
}
