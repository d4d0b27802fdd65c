//! Words of a pbrt file: bare words, numbers, strings, brackets; `#` starts a comment that ends with the line.

use std::borrow::Cow;

use crate::error::SceneError;
use crate::source::{FileId, Span};

/// One word of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind<'a>,
    pub(super) span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum TokenKind<'a> {
    /// `Shape`, `true`.
    Word(&'a str),
    /// `-.5e3`. Always finite.
    Number(f64),
    /// `"float radius"`, without the quotes and with escapes resolved.
    String(Cow<'a, str>),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// Reads the tokens of one file, in order.
pub(super) struct Lexer<'a> {
    text: &'a str,
    file: FileId,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(file: FileId, text: &'a str) -> Self {
        // A byte order mark is no word.
        let at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { text, file, at }
    }

    /// The next token. `None` at the end of the file. After an error reading can go on.
    pub(super) fn next_token(&mut self) -> Option<Result<Token<'a>, SceneError>> {
        self.skip_blanks();
        let start = self.at;
        let kind = match self.text.as_bytes().get(start)? {
            b'[' => Ok(self.bracket(TokenKind::Open)),
            b']' => Ok(self.bracket(TokenKind::Close)),
            b'"' => self.string(),
            _ => self.word(),
        };
        Some(kind.map(|kind| Token { kind, span: self.span_from(start) }))
    }

    /// The place just after the last character.
    pub(super) fn end(&self) -> Span {
        Span::new(self.file, self.text.len(), self.text.len())
    }

    fn span_from(&self, start: usize) -> Span {
        Span::new(self.file, start, self.at)
    }

    fn skip_blanks(&mut self) {
        let bytes = self.text.as_bytes();
        while let Some(byte) = bytes.get(self.at) {
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
                b'#' => self.at += bytes[self.at..].iter().take_while(|b| !matches!(b, b'\n' | b'\r')).count(),
                _ => break,
            }
        }
    }

    fn bracket(&mut self, kind: TokenKind<'a>) -> TokenKind<'a> {
        self.at += 1;
        kind
    }

    /// From the opening quote to the closing one, which must stand on the same line.
    fn string(&mut self) -> Result<TokenKind<'a>, SceneError> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut escaped = false;
        self.at += 1;
        loop {
            match bytes.get(self.at) {
                Some(b'"') => break,
                Some(b'\\') => {
                    escaped = true;
                    // The escaped byte may be the first of several: the others are no quotes.
                    self.at = (self.at + 2).min(bytes.len());
                }
                None | Some(b'\n') => {
                    return Err(SceneError::at(self.span_from(start), "this string has no closing quote")
                        .help("strings end with \" on the line where they start"));
                }
                Some(_) => self.at += 1,
            }
        }
        let inner = &self.text[start + 1..self.at];
        self.at += 1;
        let text = if escaped { Cow::Owned(self.unescape(start, inner)?) } else { Cow::Borrowed(inner) };
        Ok(TokenKind::String(text))
    }

    fn unescape(&self, start: usize, inner: &str) -> Result<String, SceneError> {
        let mut out = String::with_capacity(inner.len());
        let mut chars = inner.chars();
        while let Some(c) = chars.next() {
            if c != '\\' {
                out.push(c);
                continue;
            }
            out.push(match chars.next() {
                Some('n') => '\n',
                Some('t') => '\t',
                Some('r') => '\r',
                Some('b') => '\u{8}',
                Some('f') => '\u{c}',
                Some(c @ ('\\' | '"' | '\'')) => c,
                other => {
                    let shown = other.map(String::from).unwrap_or_default();
                    let message = format!("\"\\{shown}\" stands for no character");
                    return Err(SceneError::at(self.span_from(start), message)
                        .help("write \\\\ for a backslash, and / between directories"));
                }
            });
        }
        Ok(out)
    }

    /// A bare word or a number: whatever starts as a number does must be one.
    fn word(&mut self) -> Result<TokenKind<'a>, SceneError> {
        let start = self.at;
        let ends = |b: &u8| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'"' | b'[' | b']' | b'#');
        self.at += self.text.as_bytes()[start..].iter().take_while(|b| !ends(b)).count();
        let word = &self.text[start..self.at];
        if !word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
            return Ok(TokenKind::Word(word));
        }
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(TokenKind::Number(number)),
            _ => Err(SceneError::at(self.span_from(start), format!("{} is not a finite number", shorten(word)))
                .help("numbers look like 1, -0.5 or 2.5e3")),
        }
    }
}

/// A word as it is shown in a message.
pub(super) fn shorten(word: &str) -> Cow<'_, str> {
    match word.char_indices().nth(60) {
        Some((cut, _)) => Cow::Owned(format!("{}…", &word[..cut])),
        None => Cow::Borrowed(word),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<Result<TokenKind<'_>, String>> {
        let mut lexer = Lexer::new(FileId(0), text);
        std::iter::from_fn(|| lexer.next_token()).map(|t| t.map(|t| t.kind).map_err(|e| e.message)).collect()
    }

    #[test]
    fn words_numbers_strings_and_brackets_are_told_apart_and_comments_skipped() {
        let text = "Shape\"sphere\" # a ball \"here\"\n[-.5 1.e3]true";
        let expected = [
            TokenKind::Word("Shape"),
            TokenKind::String("sphere".into()),
            TokenKind::Open,
            TokenKind::Number(-0.5),
            TokenKind::Number(1000.0),
            TokenKind::Close,
            TokenKind::Word("true"),
        ];
        assert_eq!(kinds(text), expected.map(Ok));
    }

    #[test]
    fn escapes_stand_for_characters() {
        assert_eq!(kinds(r#""a\"b\\c\n""#), [Ok(TokenKind::String("a\"b\\c\n".into()))]);
        assert_eq!(kinds(r#""a\é""#), [Err(r#""\é" stands for no character"#.to_string())]);
    }

    #[test]
    fn what_is_no_token_is_an_error_and_reading_goes_on() {
        let found = kinds("1x2 \"open\nShape 1e999 \"\\");
        assert_eq!(found[0], Err("1x2 is not a finite number".into()));
        assert_eq!(found[1], Err("this string has no closing quote".into()));
        assert_eq!(found[2], Ok(TokenKind::Word("Shape")));
        assert_eq!(found[3], Err("1e999 is not a finite number".into()));
        assert_eq!(found[4], Err("this string has no closing quote".into()));
        assert_eq!(found.len(), 5);
    }
}
