//! What tidy looks at: the files of the repository, read once.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use anyhow::Result;

use crate::shell::{output, root};

/// The files that git tracks or would add, by path from the root with `/` between the parts.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    /// Texts of sources and documents; other files have an empty text
    pub(crate) files: BTreeMap<String, String>,
}

impl Tree {
    /// The repository as it lies on disk.
    pub(crate) fn of_repository() -> Result<Self> {
        let root = root();
        let listing = output(
            Command::new("git").args(["ls-files", "--cached", "--others", "--exclude-standard"]).current_dir(&root),
        )?;
        let mut files = BTreeMap::new();
        for path in listing.lines().filter(|path| root.join(path).is_file()) {
            let is_text = Path::new(path).extension().is_some_and(|extension| extension == "rs" || extension == "md");
            let text = if is_text { std::fs::read_to_string(root.join(path))? } else { String::new() };
            files.insert(path.to_owned(), text);
        }
        Ok(Self { files })
    }

    /// Files whose names end so.
    pub(crate) fn ending<'a>(&'a self, ending: &'a str) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.files.iter().filter(move |(path, _)| path.ends_with(ending)).map(|(path, text)| (&**path, &**text))
    }

    /// Rust sources of one room of the library, such as `bsdf`.
    pub(crate) fn room<'a>(&'a self, room: &str) -> impl Iterator<Item = (&'a str, &'a str)> {
        let start = format!("crates/tyndall/src/{room}");
        self.ending(".rs")
            .filter(move |(path, _)| path.strip_prefix(&start).is_some_and(|rest| rest.starts_with(['/', '.'])))
    }

    /// Whether a file or a directory of that path is there.
    pub(crate) fn has(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        path.is_empty() || self.files.contains_key(path) || self.files.keys().any(|file| lies_in(file, path))
    }

    /// Names of the directories directly inside a directory.
    pub(crate) fn directories_in(&self, directory: &str) -> BTreeSet<&str> {
        let inside = self.files.keys().filter(|file| lies_in(file, directory));
        inside.filter_map(|file| file[directory.len() + 1..].split_once('/').map(|(name, _)| name)).collect()
    }

    /// A made-up tree for tests.
    #[cfg(test)]
    pub(crate) fn of(files: &[(&str, &str)]) -> Self {
        Self { files: files.iter().map(|&(path, text)| (path.to_owned(), text.to_owned())).collect() }
    }
}

fn lies_in(file: &str, directory: &str) -> bool {
    file.strip_prefix(directory).is_some_and(|rest| rest.starts_with('/'))
}
