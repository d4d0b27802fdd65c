//! `tyndall convert A B`.

use std::{fs, io::IsTerminal, path::Path, process::ExitCode};

use anyhow::{Context, ensure};
use tyndall_formats::{
    desc::SceneDesc,
    error::{Diagnostics, Unsupported},
    film::save::replace,
    source::SourceMap,
    write::write,
};

use crate::{args::ConvertOptions, outputs::say};

/// Reads a scene and writes it in the language of the other file's ending.
pub(crate) fn run(options: &ConvertOptions) -> anyhow::Result<ExitCode> {
    let unsupported = if options.input.lenient { Unsupported::Warn } else { Unsupported::Refuse };
    let (desc, sources) = tyndall_formats::load(&options.input.scene, &options.input.define, unsupported)?;
    let written = write(&desc, &sources, &options.output, unsupported)?;
    let beside = written.beside.iter().map(|(path, _)| path.as_path());
    for path in beside.chain([options.output.as_path()]) {
        ensure!(
            !is_read(path, &desc, &sources),
            "{} is part of the scene that is read: choose another name for what is written",
            path.display()
        );
    }
    // An earlier scene of this name may have left files for this one to replace; others' files stay.
    let before = fs::read_to_string(&options.output).unwrap_or_default();
    for (path, bytes) in &written.beside {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        ensure!(
            before.contains(&*name) || fs::read(path).map_or(!path.exists(), |there| there == *bytes),
            "{} is there already and is something else: remove it, or choose another name for the scene",
            path.display()
        );
    }
    let warnings: Vec<_> = desc.warnings.iter().chain(&written.warnings).cloned().collect();
    if !warnings.is_empty() {
        eprintln!("{}\n", Diagnostics::new(warnings, sources).render(std::io::stderr().is_terminal()));
    }
    for (path, bytes) in &written.beside {
        replace(path, bytes)?;
    }
    replace(&options.output, written.text.as_bytes()).context("the scene is not converted")?;
    if !options.quiet {
        let beside = match written.beside.len() {
            0 => String::new(),
            1 => ", and a file beside it".into(),
            n => format!(", and {n} files beside it"),
        };
        say(&format!("{}{beside}", options.output.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether a file is one that the scene is made of.
fn is_read(path: &Path, desc: &SceneDesc, sources: &SourceMap) -> bool {
    let Ok(path) = fs::canonicalize(path) else { return false };
    let texts = sources.files().iter().map(|file| &file.path);
    texts.chain(desc.files()).filter_map(|file| fs::canonicalize(file).ok()).any(|file| file == path)
}
