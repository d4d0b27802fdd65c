//! What came of the scenes: a row each, kept in JSON between calls, told as a page of the book.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::comparison::Comparison;
use super::ours::Failure;
use super::published::Likeness;
use super::sources::{Language, Source};

/// Why scenes come out otherwise than they should, by their files: what was found out about each.
const REASONS: &str = include_str!("reasons.tsv");

/// What came of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Outcome {
    /// Rendered by both, compared with Mitsuba
    Compared(Comparison),
    /// Rendered by us, compared with the image that its author published
    Published(Likeness),
    /// Rendered, and nothing to compare with, for this reason
    Rendered(String),
    /// No picture, and whether it loads if what is not known yet is left out
    Failed {
        /// Why
        failure: Failure,
        /// Whether `--lenient` helps
        lenient: bool,
    },
    /// No picture, and the scene is to blame: this is wrong with it
    Wrong(String),
}

/// A scene, and what came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The scene
    pub(crate) source: Source,
    /// What came of it
    pub(crate) outcome: Outcome,
    /// To load and to render it [s]
    pub(crate) seconds: Option<(f64, f64)>,
}

impl Row {
    /// Whether all that is missing is words that are not known yet.
    pub(crate) fn is_not_yet(&self) -> bool {
        matches!(self.outcome, Outcome::Failed { failure: Failure::NotYet(_), .. })
    }

    /// What was found out about a scene that comes out otherwise than it should.
    fn reason(&self) -> Option<&'static str> {
        let file = self.source.file.to_string_lossy();
        REASONS
            .lines()
            .filter_map(|line| line.split_once('\t'))
            .find_map(|(part, why)| file.contains(part).then_some(why))
    }

    /// In one word, and in a sentence.
    pub(crate) fn told(&self, level: f64) -> (&'static str, String) {
        match &self.outcome {
            Outcome::Compared(found) => found.told(level),
            Outcome::Published(found) => {
                let word = if found.is_near() { "near its image" } else { "**unlike its image**" };
                let ratio = found.ratio.map(|ratio| format!("{ratio:.3}")).join(" ");
                (word, format!("means {ratio} of the published, correlation {:.4}", found.correlation))
            }
            Outcome::Rendered(why) => ("renders", why.clone()),
            Outcome::Wrong(why) => ("the scene is wrong", why.clone()),
            Outcome::Failed { failure, lenient } => {
                let (word, mut text) = match failure {
                    Failure::NotYet(messages) => ("not yet", list(messages)),
                    Failure::FileMissing(messages) => ("file missing", list(messages)),
                    Failure::Refused(messages) => ("**refused**", list(messages)),
                    Failure::Broken(message) => ("**breaks**", message.clone()),
                    Failure::TooLong => ("**too slow**", "not done in the time that was given".to_owned()),
                };
                if *lenient {
                    text += " (loads with `--lenient`)";
                }
                (word, text)
            }
        }
    }
}

/// The first two messages, and how many more there are.
fn list(messages: &[String]) -> String {
    let mut text = messages.iter().take(2).cloned().collect::<Vec<_>>().join("; ");
    if messages.len() > 2 {
        let _ = write!(text, "; and {} more", messages.len() - 2);
    }
    text
}

/// The rows of earlier calls.
pub(crate) fn read(path: &Path) -> Result<Vec<Row>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(path)?;
    serde_json::from_str(&text).with_context(|| format!("{} is of another version: delete it", path.display()))
}

/// The page of the book.
pub(crate) fn page(rows: &[Row], level: f64) -> String {
    let mut text = String::from(
        "# Other people's scenes\n\n\
         Scenes of public repositories, in both languages, as their authors wrote them: what tyndall does with each. None of \
         them is in this repository; `cargo xtask collections DIR` makes this page from a collection whose table is \
         `DIR/sources.tsv`.\n\n\
         Each is rendered 128 pixels wide, or about that, in the ratio of its sides. Scenes of Mitsuba are rendered by Mitsuba 3.9.1 \
         (`scalar_rgb`) too, four times by each with independent noise. They *agree* if the tiles of 8 × 8 pixels, their χ² and \
         the means say nothing against it, at a chance of 1 % of a false alarm in the whole table; the rim of the pictures is left \
         out, where Mitsuba's filters lack samples beyond the edge. Scenes of pbrt are compared with the image beside them if there is one: \
         *near* means within 5 %, and a correlation over 0.98, for nobody knows that image's noise or tones.\n",
    );
    for (language, title) in [(Language::Pbrt, "pbrt-v4"), (Language::Mitsuba, "Mitsuba 3")] {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.source.language == language).collect();
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for row in &rows {
            *counts.entry(row.told(level).0.trim_matches('*')).or_default() += 1;
        }
        let counts = counts.iter().map(|(word, count)| format!("{word} {count}")).collect::<Vec<_>>().join(", ");
        let _ = write!(
            text,
            "\n## {title}\n\n{} scenes: {counts}.\n\n| scene | commit | load [s] | render [s] | | |\n|---|---|---|---|---|---|\n",
            rows.len()
        );
        for row in rows {
            let (word, mut remark) = row.told(level);
            if let Some(reason) = row.reason().filter(|_| word.contains("**")) {
                let _ = write!(remark, ". {reason}");
            }
            let seconds = |value: Option<f64>| value.map_or("–".to_owned(), crate::peers::report::figure);
            let _ = writeln!(
                text,
                "| {} `{}` | {:.8} | {} | {} | {word} | {} |",
                row.source.repository,
                row.source.path,
                row.source.commit,
                seconds(row.seconds.map(|(load, _)| load)),
                seconds(row.seconds.map(|(_, render)| render)),
                cell(&remark),
            );
        }
    }
    text
}

/// Text of a program as a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(outcome: Outcome) -> Row {
        let source = Source {
            language: Language::Mitsuba,
            file: "a.xml".into(),
            repository: "o/r".to_owned(),
            commit: "0123456789".to_owned(),
            path: "a.xml".to_owned(),
            reference: None,
            verdict: None,
        };
        Row { source, outcome, seconds: Some((0.5, 2.0)) }
    }

    #[test]
    fn a_row_of_the_page_tells_what_came_of_the_scene() {
        let comparison =
            Comparison { p: 0.5, extreme_z: -3.0, extreme_at: (8, 16, 1), ratio: [Some((1.0, 0.001)), None, None] };
        let messages = ["a <b>", "c", "d"].map(str::to_owned).to_vec();
        let failed = Outcome::Failed { failure: Failure::NotYet(messages), lenient: true };
        let page = page(&[row(Outcome::Compared(comparison)), row(failed)], 0.01);
        assert!(page.contains("2 scenes: agrees 1, not yet 1."), "{page}");
        assert!(page.contains(
            "| o/r `a.xml` | 01234567 | 0.500 | 2.00 | agrees | means 1.0000±0.0010 – –; largest z -3.0 at (8, 16) g"
        ));
        assert!(page.contains("| not yet | a &lt;b>; c; and 1 more (loads with `--lenient`) |"), "{page}");
    }

    #[test]
    fn rows_come_back_from_json() {
        let rows = vec![row(Outcome::Rendered("no image beside it".to_owned()))];
        let path = std::env::temp_dir().join(format!("tyndall_collections_{}.json", std::process::id()));
        std::fs::write(&path, serde_json::to_string(&rows).unwrap()).unwrap();
        assert_eq!(read(&path).unwrap(), rows);
        std::fs::remove_file(&path).unwrap();
    }
}
