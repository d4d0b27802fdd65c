//! The texts that a scene was read from, and places in them.
//!
//! A [`SourceMap`] owns every file that takes part in a scene (the scene file and what it includes). A [`Span`] is a range
//! of bytes in one of them: small enough to stand beside every value that the user wrote.
//!
//! Files come from anywhere, so sizes are bounded before anything is read into memory, and text must be UTF-8.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::error::SceneError;
use crate::gzip;

/// The largest scene file that is read \[bytes\]. A `u32` offset reaches further.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// The most text that one scene may have, includes together \[bytes\].
pub const MAX_TOTAL_BYTES: u64 = 1 << 31;

/// The most files that one scene may read, each include counted.
pub const MAX_FILES: usize = 10_000;

/// A file of a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A range of bytes in one file: `start..end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The bytes `start..end` of `file`. Offsets are below [`MAX_FILE_BYTES`], so they fit.
    pub fn new(file: FileId, start: usize, end: usize) -> Self {
        let fit = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self { file, start: fit(start), end: fit(end.max(start)) }
    }

    /// From the start of this span to the end of `last`. Spans of different files cannot be joined: then it is `self`.
    #[must_use]
    pub fn to(self, last: Self) -> Self {
        if self.file == last.file { Self { end: last.end.max(self.end), ..self } } else { self }
    }
}

/// A value and where the user wrote it. A default carries the place of the words that imply it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// `value`, as written at `span`.
    pub fn new(value: T, span: Span) -> Self {
        Self { value, span }
    }

    /// The same place, another value.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Spanned<U> {
        Spanned { value: f(self.value), span: self.span }
    }
}

/// One text.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Where it was read from.
    pub path: PathBuf,
    /// What it holds.
    pub text: Arc<str>,
    /// The byte at which each line starts.
    line_starts: Vec<u32>,
}

/// Every text of a scene.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
    total_bytes: u64,
}

/// A place as people count: both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl SourceMap {
    /// Reads a file. `from` is where it was asked for (an include), if anywhere.
    ///
    /// # Errors
    /// The file cannot be read, is larger than [`MAX_FILE_BYTES`], is not UTF-8, or is one too many.
    pub fn read(&mut self, path: &Path, from: Option<Span>) -> Result<FileId, SceneError> {
        let error = |message: String| SceneError { span: from, ..SceneError::new(message) };
        let shown = path.display();
        // A pipe or a device could go on for ever.
        if path.metadata().is_ok_and(|m| !m.is_file()) {
            return Err(error(format!("{shown} is not a file")).help("name a scene file"));
        }
        let file = std::fs::File::open(path).map_err(|e| error(format!("cannot read {shown}: {e}")))?;
        let mut bytes = Vec::new();
        // One byte more than the limit tells a file that is too long, also if it grows while it is read.
        file.take(MAX_FILE_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| error(format!("cannot read {shown}: {e}")))?;
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(error(format!("{shown} is larger than 1 GiB"))
                .help("keep large meshes in PLY files and name them in the scene"));
        }
        if gzip::is_gzip(path) {
            bytes = gzip::inflate(&bytes, MAX_FILE_BYTES).map_err(|problem| error(format!("{shown} {problem}")))?;
        }
        let text = String::from_utf8(bytes).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            error(format!("{shown} is not text: the byte at position {at} is not UTF-8"))
                .help("save the file as UTF-8, and check that it is a scene file")
        })?;
        self.add(path, text).ok_or_else(|| {
            error(format!("the scene reads more than {MAX_FILES} files or more than 2 GiB of text"))
                .help("does a file include itself? Keep large meshes in PLY files")
        })
    }

    /// Adds a text that is at hand already, such as a scene made by a program or a test. `None` when the map is full
    /// ([`MAX_FILES`], [`MAX_TOTAL_BYTES`]) or the text is larger than [`MAX_FILE_BYTES`].
    pub fn add(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>) -> Option<FileId> {
        let text = text.into();
        let bytes = text.len() as u64;
        if self.files.len() >= MAX_FILES || bytes > MAX_FILE_BYTES || self.total_bytes + bytes > MAX_TOTAL_BYTES {
            return None;
        }
        self.total_bytes += bytes;
        let line_starts = std::iter::once(0)
            .chain(text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at as u32 + 1))
            .collect();
        self.files.push(SourceFile { path: path.into(), text, line_starts });
        Some(FileId(self.files.len() as u32 - 1))
    }

    /// A file of this map. `None` for an id of another map.
    pub fn get(&self, file: FileId) -> Option<&SourceFile> {
        self.files.get(file.0 as usize)
    }

    /// All files, the scene file first.
    pub fn files(&self) -> &[SourceFile] {
        &self.files
    }

    /// The text of a file, empty for an id of another map.
    pub fn text(&self, file: FileId) -> &str {
        self.get(file).map_or("", |f| &f.text)
    }

    /// What the user wrote there.
    pub fn snippet(&self, span: Span) -> &str {
        self.text(span.file).get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// Line and column of the start of a span.
    pub fn line_column(&self, span: Span) -> LineColumn {
        self.get(span.file).map_or(LineColumn { line: 1, column: 1 }, |f| f.line_column(span.start))
    }

    /// `path:line:column` of the start of a span.
    pub fn place(&self, span: Span) -> String {
        let LineColumn { line, column } = self.line_column(span);
        let path = self.get(span.file).map_or_else(|| "?".into(), |f| f.path.display().to_string());
        format!("{path}:{line}:{column}")
    }
}

impl SourceFile {
    /// Line and column of a byte.
    pub fn line_column(&self, byte: u32) -> LineColumn {
        let line = self.line_starts.partition_point(|&start| start <= byte).max(1);
        let start = self.line_starts[line - 1] as usize;
        let end = (byte as usize).min(self.text.len());
        let column = self.text.as_bytes()[start..end].iter().filter(|&&b| b & 0xC0 != 0x80).count() + 1;
        LineColumn { line, column }
    }

    /// The bytes of a line (from 1), without its line break.
    pub fn line_range(&self, line: usize) -> std::ops::Range<usize> {
        let start = self.line_starts.get(line.saturating_sub(1)).map_or(self.text.len(), |&s| s as usize);
        let end = self.line_starts.get(line).map_or(self.text.len(), |&next| next as usize - 1);
        start..end.max(start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters_from_one() {
        let mut map = SourceMap::default();
        let file = map.add("a.pbrt", "Größe 1\nx").unwrap();
        let at = |start| map.line_column(Span::new(file, start, start + 1));
        assert_eq!(at(0), LineColumn { line: 1, column: 1 });
        // ö and ß are two bytes each, so byte 8 is the seventh character.
        assert_eq!(at(8), LineColumn { line: 1, column: 7 });
        assert_eq!(at(10), LineColumn { line: 2, column: 1 });
        assert_eq!(map.snippet(Span::new(file, 0, 7)), "Größe");
        assert_eq!(map.place(Span::new(file, 10, 11)), "a.pbrt:2:1");
    }

    #[test]
    fn a_file_that_is_not_utf8_is_refused_with_the_position_of_the_bad_byte() {
        let path = std::env::temp_dir().join(format!("tyndall-not-utf8-{}.pbrt", std::process::id()));
        std::fs::write(&path, b"Shape \xff").unwrap();
        let error = SourceMap::default().read(&path, None).unwrap_err();
        std::fs::remove_file(&path).unwrap();
        assert!(error.message.ends_with("is not text: the byte at position 6 is not UTF-8"), "{}", error.message);
    }

    #[test]
    fn a_compressed_file_is_read_as_its_text() {
        let path = std::env::temp_dir().join(format!("tyndall-gzip-{}.pbrt.gz", std::process::id()));
        std::fs::write(&path, gzip::deflate(b"WorldBegin").unwrap()).unwrap();
        let mut map = SourceMap::default();
        let read = map.read(&path, None);
        std::fs::write(&path, b"WorldBegin").unwrap();
        let broken = map.read(&path, None);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(map.text(read.unwrap()), "WorldBegin");
        assert!(broken.unwrap_err().message.contains("is no gzip file"));
    }

    #[test]
    fn spans_outside_of_a_text_are_empty_and_never_panic() {
        let mut map = SourceMap::default();
        let file = map.add("a", "é").unwrap();
        assert_eq!(map.snippet(Span::new(file, 1, 9)), "");
        assert_eq!(map.line_column(Span::new(file, 900, 901)).line, 1);
        assert_eq!(map.line_column(Span::new(FileId(7), 0, 1)).line, 1);
    }
}
