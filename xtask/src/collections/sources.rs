//! Which scenes there are: the table `sources.tsv` of a collection.
//!
//! A line a scene, fields separated by tabs, under a line of headings: language (`pbrt` or `mitsuba`), file in the
//! collection, repository (`owner/name`), commit, file in the repository, reference image in the collection (or
//! nothing), and, where somebody has looked into it, why the scene itself is wrong (or nothing).

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

/// The language that a scene is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Language {
    /// pbrt-v4
    Pbrt,
    /// Mitsuba 3
    Mitsuba,
}

/// One scene, and where it comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Source {
    /// Its language
    pub(crate) language: Language,
    /// The file, relative to the collection
    pub(crate) file: PathBuf,
    /// `owner/name` at GitHub
    pub(crate) repository: String,
    /// The commit, in hexadecimal digits
    pub(crate) commit: String,
    /// The file, relative to the repository
    pub(crate) path: String,
    /// The image that its author published beside it, relative to the collection
    pub(crate) reference: Option<PathBuf>,
    /// What is wrong with the scene itself, as somebody found who looked
    pub(crate) verdict: Option<String>,
}

/// Reads the table of a collection.
pub(crate) fn read(directory: &Path) -> Result<Vec<Source>> {
    let path = directory.join("sources.tsv");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let lines = text.lines().enumerate().skip(1).filter(|(_, line)| !line.is_empty());
    lines.map(|(number, line)| parse(line).with_context(|| format!("{}:{}", path.display(), number + 1))).collect()
}

fn parse(line: &str) -> Result<Source> {
    let fields: Vec<&str> = line.split('\t').collect();
    let &[language, file, repository, commit, path, ref rest @ ..] = fields.as_slice() else {
        bail!("fewer than five fields");
    };
    let language = match language {
        "pbrt" => Language::Pbrt,
        "mitsuba" => Language::Mitsuba,
        other => bail!("no language is called `{other}`"),
    };
    let optional = |index: usize| rest.get(index).filter(|field| !field.is_empty());
    Ok(Source {
        language,
        file: file.into(),
        repository: repository.to_owned(),
        commit: commit.to_owned(),
        path: path.to_owned(),
        reference: optional(0).map(PathBuf::from),
        verdict: optional(1).map(ToString::to_string),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_read_with_and_without_what_may_be_left_out() {
        let whole = parse("mitsuba\tm/a.xml\to/r\tabc\ta.xml\tm/a.exr\tno light").unwrap();
        assert_eq!((whole.language, whole.reference.as_deref()), (Language::Mitsuba, Some(Path::new("m/a.exr"))));
        assert_eq!(whole.verdict.as_deref(), Some("no light"));
        let short = parse("pbrt\tp/a.pbrt\to/r\tabc\ta.pbrt\t").unwrap();
        assert_eq!((short.reference, short.verdict), (None, None));
    }

    #[test]
    fn a_line_that_is_no_scene_is_refused() {
        assert!(parse("pbrt\tp/a.pbrt").is_err());
        assert!(parse("blend\tp/a.blend\to/r\tabc\ta.blend").is_err());
    }
}
