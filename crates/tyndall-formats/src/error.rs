//! What is wrong with a scene, shown where it is wrong.
//!
//! Readers collect [`SceneError`]s and go on, so that a user sees the faults of a file at once. [`Diagnostics`] joins them
//! with the texts and draws each with file, line, column, the offending words and what to do:
//!
//! ```text
//! error: the shape "sphere" has no parameter "radios"
//!  --> scene.pbrt:9:16
//!   |
//! 9 | Shape "sphere" "float radios" 1
//!   |                ^^^^^^^^^^^^^^
//!   |
//! help: did you mean "radius"?
//! ```
//!
//! A word that the scene language has and tyndall does not have [yet](Severity::NotYet) is an error as well, unless the
//! user asks for [`Unsupported::Warn`] (`--lenient`): then it is left out, with a warning.

use std::fmt;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::source::{SourceMap, Span};

/// Faults drawn in full; the rest is counted.
const MOST_SHOWN: usize = 20;
/// Faults kept in memory: a hostile file can have millions.
const MOST_KEPT: usize = 4_000;
/// Candidates that a misspelt word is compared with.
const MOST_CANDIDATES: usize = 500;
/// Candidates that are listed when none is near.
const MOST_LISTED: usize = 20;
/// Longer lines are not drawn, only located \[bytes\].
const LONGEST_LINE: usize = 1 << 16;

/// How much a fault matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene is wrong.
    Error,
    /// The scene is right, and tyndall cannot do this yet.
    NotYet,
    /// The scene can be rendered, and something about it is worth knowing.
    Warning,
}

/// What becomes of words that are not supported yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Unsupported {
    /// They are errors.
    #[default]
    Refuse,
    /// They are warnings, and what they say is left out of the scene.
    Warn,
}

/// One fault of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Whether it can be rendered nevertheless.
    pub severity: Severity,
    /// The words at fault. `None` when it is the file itself.
    pub span: Option<Span>,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Other places that explain it ("first defined here", "included from here").
    pub related: Vec<(Span, String)>,
}

impl SceneError {
    /// A fault of the scene as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        Self { severity: Severity::Error, span: None, message: message.into(), help: None, related: Vec::new() }
    }

    /// A fault of the words at `span`.
    pub fn at(span: Span, message: impl Into<String>) -> Self {
        Self { span: Some(span), ..Self::new(message) }
    }

    /// Words that the language has and tyndall does not have yet.
    pub fn not_yet(span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::NotYet, ..Self::at(span, message) }
    }

    /// Something about the words at `span` that is worth knowing.
    pub fn warning(span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::at(span, message) }
    }

    /// Adds what to do.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Adds "did you mean" when a candidate is near `word`, or else the list of what there is.
    #[must_use]
    pub fn suggest<'a>(self, word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> Self {
        if let Some(near) = nearest(word, candidates.clone()) {
            return self.help(format!("did you mean \"{near}\"?"));
        }
        let known: Vec<_> = candidates.into_iter().take(MOST_LISTED + 1).map(|c| format!("\"{c}\"")).collect();
        match known.len() {
            0 => self,
            1 => self.help(format!("the only one known is {}", known[0])),
            more if more > MOST_LISTED => self.help("check its spelling"),
            _ => self.help(format!("known are {}", known.join(", "))),
        }
    }

    /// Adds another place that explains the fault.
    #[must_use]
    pub fn related(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, label.into()));
        self
    }
}

/// The candidate that `word` was probably meant to be: another case or an edit distance of at most a third of its length.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Words are short; a longer one is not a slip of the pen, and comparing costs the product of the lengths.
    let is_short = |word: &str| word.len() <= 64;
    if !is_short(word) {
        return None;
    }
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .take(MOST_CANDIDATES)
        .filter(|candidate| is_short(candidate))
        .map(|candidate| (strsim::damerau_levenshtein(&lower, &candidate.to_lowercase()), candidate))
        .filter(|&(distance, candidate)| distance <= (candidate.chars().count() / 3).max(1))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Faults as a reader collects them, bounded in number.
#[derive(Clone, Debug, Default)]
pub struct ErrorList {
    errors: Vec<SceneError>,
    /// Kept apart: they do not end the reading, and the first ones tell enough.
    warnings: Vec<SceneError>,
    dropped: usize,
    unsupported: Unsupported,
}

impl ErrorList {
    /// No faults yet.
    pub fn new(unsupported: Unsupported) -> Self {
        Self { unsupported, ..Self::default() }
    }

    /// Adds a fault.
    pub fn push(&mut self, mut error: SceneError) {
        if (error.severity, self.unsupported) == (Severity::NotYet, Unsupported::Warn) {
            error.severity = Severity::Warning;
        }
        let list = if error.severity == Severity::Warning { &mut self.warnings } else { &mut self.errors };
        if list.len() < MOST_KEPT {
            list.push(error);
        } else if error.severity != Severity::Warning {
            self.dropped += 1;
        }
    }

    /// Adds the fault of a result, or gives its value.
    pub fn ok<T>(&mut self, result: Result<T, SceneError>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// Adds a place that explains every fault from the `first` on (by position in [`ErrorList::as_slice`]).
    pub fn explain(&mut self, first: usize, span: Span, label: &str) {
        for error in self.errors.iter_mut().skip(first) {
            error.related.push((span, label.into()));
        }
    }

    /// Whether there are as many faults as are kept: reading on is of no use.
    pub fn is_full(&self) -> bool {
        self.errors.len() >= MOST_KEPT
    }

    /// Whether nothing is wrong, but for what is only worth a warning.
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// What is only worth a warning.
    pub fn warnings(&self) -> Vec<SceneError> {
        self.warnings.clone()
    }

    /// What was found so far, in order.
    pub fn as_slice(&self) -> &[SceneError] {
        &self.errors
    }

    /// The value if nothing is wrong, or else all faults with the texts they are in.
    ///
    /// # Errors
    /// There are faults.
    pub fn finish<T>(self, value: T, sources: SourceMap) -> Result<(T, SourceMap), Diagnostics> {
        if self.is_empty() { Ok((value, sources)) } else { Err(self.into_diagnostics(sources)) }
    }

    /// All faults with the texts they are in, from top to bottom.
    pub fn into_diagnostics(self, sources: SourceMap) -> Diagnostics {
        let all = self.errors.into_iter().chain(self.warnings).collect();
        Diagnostics { dropped: self.dropped, ..Diagnostics::new(all, sources) }
    }
}

/// The faults of a scene, ready to be shown.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    /// The faults: those without a place, then by file and place.
    pub errors: Vec<SceneError>,
    /// How many more there were.
    pub dropped: usize,
    /// The texts that they point into.
    pub sources: SourceMap,
}

impl Diagnostics {
    /// These faults with the texts they are in, from top to bottom.
    pub fn new(mut errors: Vec<SceneError>, sources: SourceMap) -> Self {
        errors.sort_by_key(|e| e.span.map(|s| (s.file, s.start)));
        Self { errors, dropped: 0, sources }
    }

    /// Draws the faults for a terminal, with colours if asked. A fault that recurs is drawn once and counted.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let mut kinds: Vec<(&SceneError, usize)> = Vec::new();
        let mut seen = std::collections::HashMap::new();
        for error in &self.errors {
            let kind = *seen.entry(&error.message).or_insert_with(|| {
                kinds.push((error, 0));
                kinds.len() - 1
            });
            kinds[kind].1 += 1;
        }
        let mut out: Vec<String> = kinds
            .iter()
            .take(MOST_SHOWN)
            .map(|(error, count)| renderer.render(&self.report(error, count - 1)))
            .collect();
        let shown: usize = kinds.iter().take(MOST_SHOWN).map(|(_, count)| count).sum();
        let rest = self.errors.len() - shown + self.dropped;
        if rest > 0 {
            out.push(format!("and {rest} more"));
        }
        if self.errors.len() >= MOST_KEPT {
            out.push("too many faults: the rest of the scene was not read".into());
        }
        out.join("\n\n")
    }

    fn report<'a>(&'a self, error: &'a SceneError, recurs: usize) -> Vec<Group<'a>> {
        let level = if error.severity == Severity::Warning { Level::WARNING } else { Level::ERROR };
        let title = level.primary_title(error.message.as_str());
        let mut main = match error.span {
            Some(span) => self.place(Group::with_title(title), AnnotationKind::Primary, span, None),
            None => Group::with_title(title),
        };
        for (span, label) in &error.related {
            main = self.place(main, AnnotationKind::Context, *span, Some(label));
        }
        if recurs > 0 {
            let times = if recurs == 1 { "once".into() } else { format!("{recurs} times") };
            main = main.element(Level::NOTE.message(format!("the same occurs {times} more")));
        }
        let help = error.help.as_deref().map(|help| Group::with_title(Level::HELP.secondary_title(help)));
        std::iter::once(main).chain(help).collect()
    }

    /// Draws the line of a span: only that line is handed on, so that huge files cost nothing.
    fn place<'a>(&'a self, group: Group<'a>, kind: AnnotationKind, span: Span, label: Option<&'a str>) -> Group<'a> {
        let Some(file) = self.sources.get(span.file) else { return group };
        let path = file.path.display().to_string();
        let at = file.line_column(span.start);
        let line = file.line_range(at.line);
        if line.len() > LONGEST_LINE {
            return group.element(Origin::path(path).line(at.line).char_column(at.column));
        }
        // A span that a careless caller put inside a character is widened to it.
        let start = file.text.floor_char_boundary((span.start as usize).clamp(line.start, line.end));
        let end = file.text.ceil_char_boundary((span.end as usize).clamp(start, line.end));
        let annotation = kind.span(start - line.start..end - line.start).label(label);
        group.element(Snippet::source(&file.text[line]).line_start(at.line).path(path).annotation(annotation))
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> (SourceMap, crate::source::FileId) {
        let mut sources = SourceMap::default();
        let file = sources.add("scene.pbrt", text).unwrap();
        (sources, file)
    }

    #[test]
    fn an_error_shows_the_line_the_words_and_the_help() {
        let (sources, file) = scene("WorldBegin\nShape \"sphere\" \"float radios\" 1\n");
        let error = SceneError::at(Span::new(file, 26, 40), "the shape \"sphere\" has no parameter \"radios\"")
            .suggest("radios", ["radius", "zmin"]);
        let mut list = ErrorList::default();
        list.push(error);
        assert_eq!(
            list.into_diagnostics(sources).to_string(),
            "error: the shape \"sphere\" has no parameter \"radios\"\n \
              --> scene.pbrt:2:16\n  \
                |\n\
              2 | Shape \"sphere\" \"float radios\" 1\n  \
                |                ^^^^^^^^^^^^^^\n  \
                |\n\
              help: did you mean \"radius\"?"
        );
    }

    #[test]
    fn the_nearest_word_forgives_case_and_a_slip_but_invents_nothing() {
        let words = ["sphere", "disk", "trianglemesh"];
        assert_eq!(nearest("spere", words), Some("sphere"));
        assert_eq!(nearest("Disk", words), Some("disk"));
        assert_eq!(nearest("triangelmesh", words), Some("trianglemesh"));
        assert_eq!(nearest("cylinder", words), None);
        assert_eq!(nearest("", words), None);
        assert_eq!(nearest(&"x".repeat(1 << 20), words), None);
    }

    #[test]
    fn a_fault_that_recurs_is_drawn_once_and_counted() {
        let (sources, file) = scene("a a a");
        let mut list = ErrorList::default();
        for at in [0, 2, 4] {
            list.push(SceneError::at(Span::new(file, at, at + 1), "no such word \"a\""));
        }
        let text = list.into_diagnostics(sources).to_string();
        assert_eq!(text.matches("error:").count(), 1, "{text}");
        assert!(text.contains("the same occurs 2 times more"), "{text}");
    }

    #[test]
    fn any_span_can_be_drawn() {
        let (sources, file) = scene("é\n\n");
        for start in 0..6 {
            for end in 0..6 {
                let mut list = ErrorList::default();
                list.push(SceneError::at(Span::new(file, start, end), "x"));
                assert!(list.into_diagnostics(sources.clone()).to_string().contains("scene.pbrt"));
            }
        }
    }
}
