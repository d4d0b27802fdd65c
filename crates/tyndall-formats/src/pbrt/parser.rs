//! Statements of a pbrt file: a directive and its arguments, as its row in [`DIRECTIVES`] says.
//!
//! ```text
//! file      = { statement }
//! statement = directive arguments
//! entity    = string { parameter }
//! parameter = "type name" ( value | "[" { value } "]" )
//! ```
//!
//! After an error the parser goes on at the next bare word, so that one slip hides no other.

use std::borrow::Cow;

use super::lexer::{Lexer, Token, TokenKind, shorten};
use super::param::{Param, ParamType, Values};
use crate::error::{ErrorList, SceneError};
use crate::source::{FileId, Span, Spanned};

/// What follows a directive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Grammar {
    /// Nothing.
    Nothing,
    /// So many numbers.
    Numbers(usize),
    /// Sixteen numbers in brackets.
    Matrix,
    /// One string.
    Name,
    /// One string or two.
    OneOrTwoNames,
    /// A bare word.
    Word,
    /// A string and then a string, number or bare word.
    Setting,
    /// A string and parameters.
    Entity,
    /// Three strings and parameters.
    Texture,
}

/// Every directive of the language with what follows it.
const DIRECTIVES: [(&str, Grammar); 40] = [
    ("Accelerator", Grammar::Entity),
    ("ActiveTransform", Grammar::Word),
    ("AreaLightSource", Grammar::Entity),
    ("Attribute", Grammar::Entity),
    ("AttributeBegin", Grammar::Nothing),
    ("AttributeEnd", Grammar::Nothing),
    ("Camera", Grammar::Entity),
    ("ColorSpace", Grammar::Name),
    ("ConcatTransform", Grammar::Matrix),
    ("CoordSysTransform", Grammar::Name),
    ("CoordinateSystem", Grammar::Name),
    ("Film", Grammar::Entity),
    ("Identity", Grammar::Nothing),
    ("Import", Grammar::Name),
    ("Include", Grammar::Name),
    ("Integrator", Grammar::Entity),
    ("LightSource", Grammar::Entity),
    ("LookAt", Grammar::Numbers(9)),
    ("MakeNamedMaterial", Grammar::Entity),
    ("MakeNamedMedium", Grammar::Entity),
    ("Material", Grammar::Entity),
    ("MediumInterface", Grammar::OneOrTwoNames),
    ("NamedMaterial", Grammar::Name),
    ("ObjectBegin", Grammar::Name),
    ("ObjectEnd", Grammar::Nothing),
    ("ObjectInstance", Grammar::Name),
    ("Option", Grammar::Setting),
    ("PixelFilter", Grammar::Entity),
    ("ReverseOrientation", Grammar::Nothing),
    ("Rotate", Grammar::Numbers(4)),
    ("Sampler", Grammar::Entity),
    ("Scale", Grammar::Numbers(3)),
    ("Shape", Grammar::Entity),
    ("Texture", Grammar::Texture),
    ("Transform", Grammar::Matrix),
    ("TransformBegin", Grammar::Nothing),
    ("TransformEnd", Grammar::Nothing),
    ("TransformTimes", Grammar::Numbers(2)),
    ("Translate", Grammar::Numbers(3)),
    ("WorldBegin", Grammar::Nothing),
];

/// A directive with its arguments. Which arguments there are depends on the directive only, so most are empty.
#[derive(Debug)]
pub(super) struct Statement<'a> {
    /// The directive.
    pub(super) word: &'static str,
    /// The directive's word.
    pub(super) span: Span,
    /// From the directive to its last argument.
    pub(super) whole: Span,
    /// Numbers.
    pub(super) numbers: Vec<f64>,
    /// Strings and bare words before the parameters.
    pub(super) names: Vec<Spanned<Cow<'a, str>>>,
    /// Parameters.
    pub(super) params: Vec<Param>,
}

/// Reads the statements of one file.
pub(super) struct Parser<'a> {
    lexer: Lexer<'a>,
    peeked: Option<Token<'a>>,
    last: Span,
}

/// An argument is missing or wrong: it has been reported, go on at the next bare word.
struct Broken;

impl<'a> Parser<'a> {
    pub(super) fn new(file: FileId, text: &'a str) -> Self {
        Self { lexer: Lexer::new(file, text), peeked: None, last: Span::new(file, 0, 0) }
    }

    /// The next statement that can be read; what cannot is reported. `None` at the end of the file.
    pub(super) fn next_statement(&mut self, errors: &mut ErrorList) -> Option<Statement<'a>> {
        loop {
            let token = self.take(errors)?;
            let TokenKind::Word(word) = token.kind else {
                errors.push(misplaced(&token));
                self.skip_to_word(errors);
                continue;
            };
            let Some((word, grammar)) = find(word) else {
                errors.push(unknown_directive(word, token.span));
                self.skip_to_word(errors);
                continue;
            };
            if let Ok(statement) = self.arguments(word, token.span, grammar, errors) {
                return Some(statement);
            }
            // The word at fault has been shown: it is no directive on top.
            self.take_if(errors, |k| matches!(k, TokenKind::Word(word) if find(word).is_none()));
            self.skip_to_word(errors);
        }
    }

    fn arguments(
        &mut self,
        word: &'static str,
        span: Span,
        grammar: Grammar,
        errors: &mut ErrorList,
    ) -> Result<Statement<'a>, Broken> {
        let mut s = Statement { word, span, whole: span, numbers: Vec::new(), names: Vec::new(), params: Vec::new() };
        self.last = span;
        match grammar {
            Grammar::Nothing => {}
            Grammar::Numbers(count) => {
                // pbrt takes them bare; brackets around them are a common slip that means the same.
                let bracketed = self.take_if(errors, |k| *k == TokenKind::Open).is_some();
                s.numbers = self.numbers(word, count, errors)?;
                if bracketed {
                    self.close(word, errors)?;
                }
            }
            Grammar::Matrix => {
                if self.take_if(errors, |k| *k == TokenKind::Open).is_none() {
                    return self.missing(errors, format!("\"{word}\" needs 16 numbers in [ ] here"));
                }
                s.numbers = self.numbers(word, 16, errors)?;
                self.close(word, errors)?;
            }
            Grammar::Name => s.names.push(self.name(word, errors)?),
            Grammar::OneOrTwoNames => {
                s.names.push(self.name(word, errors)?);
                if matches!(self.peek(errors).map(|t| &t.kind), Some(TokenKind::String(_))) {
                    s.names.push(self.name(word, errors)?);
                }
            }
            Grammar::Word => s.names.push(self.bare_word(word, errors)?),
            Grammar::Setting => {
                s.names.push(self.name(word, errors)?);
                match self.peek(errors).map(|t| t.kind.clone()) {
                    Some(TokenKind::Number(value)) => {
                        self.take(errors);
                        s.numbers.push(value);
                    }
                    Some(TokenKind::String(_)) => s.names.push(self.name(word, errors)?),
                    _ => s.names.push(self.bare_word(word, errors)?),
                }
            }
            Grammar::Entity => {
                s.names.push(self.name(word, errors)?);
                s.params = self.params(errors);
            }
            Grammar::Texture => {
                for _ in 0..3 {
                    s.names.push(self.name(word, errors)?);
                }
                s.params = self.params(errors);
            }
        }
        s.whole = span.to(self.last);
        Ok(s)
    }

    fn numbers(&mut self, word: &str, count: usize, errors: &mut ErrorList) -> Result<Vec<f64>, Broken> {
        let mut numbers = Vec::with_capacity(count);
        while numbers.len() < count {
            let Some(TokenKind::Number(number)) = self.peek(errors).map(|t| t.kind.clone()) else {
                let found = numbers.len();
                return self.missing(errors, format!("\"{word}\" needs {count} numbers and has {found}"));
            };
            self.take(errors);
            numbers.push(number);
        }
        Ok(numbers)
    }

    fn close(&mut self, word: &str, errors: &mut ErrorList) -> Result<(), Broken> {
        match self.take_if(errors, |k| *k == TokenKind::Close) {
            Some(_) => Ok(()),
            None => self.missing(errors, format!("the numbers of \"{word}\" must end with ] here")),
        }
    }

    fn name(&mut self, word: &str, errors: &mut ErrorList) -> Result<Spanned<Cow<'a, str>>, Broken> {
        match self.take_if(errors, |k| matches!(k, TokenKind::String(_))) {
            Some(Token { kind: TokenKind::String(name), span }) => Ok(Spanned::new(name, span)),
            _ => self.missing(errors, format!("\"{word}\" needs a name in quotes here")),
        }
    }

    fn bare_word(&mut self, word: &str, errors: &mut ErrorList) -> Result<Spanned<Cow<'a, str>>, Broken> {
        match self.take_if(errors, |k| matches!(k, TokenKind::Word(_))) {
            Some(Token { kind: TokenKind::Word(name), span }) => Ok(Spanned::new(name.into(), span)),
            _ => self.missing(errors, format!("\"{word}\" needs a word here")),
        }
    }

    /// Parameters up to the next bare word.
    fn params(&mut self, errors: &mut ErrorList) -> Vec<Param> {
        let mut params = Vec::new();
        while let Some(Token { kind: TokenKind::String(declaration), span }) =
            self.take_if(errors, |k| matches!(k, TokenKind::String(_)))
        {
            let values = self.values(span, &declaration, errors);
            let (Some(values), Some((kind, name))) = (values, declare(&declaration, span, errors)) else { continue };
            let whole = span.to(self.last);
            if let Some(param) = errors.ok(Param::new(kind, name, values, span, whole)) {
                params.push(param);
            }
        }
        params
    }

    /// One value or several in brackets. `None` if there is none: that has been reported.
    fn values(&mut self, declared: Span, declaration: &str, errors: &mut ErrorList) -> Option<Values> {
        let mut values = Values::default();
        if self.take_if(errors, |k| *k == TokenKind::Open).is_none() {
            let Some(one) = self.take_if(errors, is_value) else {
                let message = format!("the parameter \"{}\" has no value", shorten(declaration));
                errors.push(SceneError::at(declared, message).help("write its value, or several in [ ], after it"));
                return None;
            };
            values.push(one);
            return Some(values);
        }
        loop {
            if let Some(token) = self.take_if(errors, is_value) {
                values.push(token);
            } else if self.take_if(errors, |k| *k == TokenKind::Close).is_some() {
                return Some(values);
            } else {
                let message = format!("the values of \"{}\" have no closing ]", shorten(declaration));
                errors.push(SceneError::at(declared, message).help("add ] after the last value"));
                return None;
            }
        }
    }

    /// Reports what is missing at the next token.
    fn missing<T>(&mut self, errors: &mut ErrorList, message: String) -> Result<T, Broken> {
        let span = match self.peek(errors) {
            Some(token) => token.span,
            None => self.lexer.end(),
        };
        errors.push(SceneError::at(span, message));
        Err(Broken)
    }

    fn peek(&mut self, errors: &mut ErrorList) -> Option<&Token<'a>> {
        while self.peeked.is_none() {
            match self.lexer.next_token()? {
                Ok(token) => self.peeked = Some(token),
                Err(error) => errors.push(error),
            }
        }
        self.peeked.as_ref()
    }

    fn take(&mut self, errors: &mut ErrorList) -> Option<Token<'a>> {
        self.peek(errors)?;
        let token = self.peeked.take()?;
        self.last = token.span;
        Some(token)
    }

    fn take_if(&mut self, errors: &mut ErrorList, wanted: impl Fn(&TokenKind<'a>) -> bool) -> Option<Token<'a>> {
        if wanted(&self.peek(errors)?.kind) { self.take(errors) } else { None }
    }

    fn skip_to_word(&mut self, errors: &mut ErrorList) {
        while self.take_if(errors, |k| !matches!(k, TokenKind::Word(w) if !is_bool(w))).is_some() {}
    }
}

fn is_bool(word: &str) -> bool {
    word == "true" || word == "false"
}

fn is_value(kind: &TokenKind<'_>) -> bool {
    match kind {
        TokenKind::Number(_) | TokenKind::String(_) => true,
        TokenKind::Word(word) => is_bool(word),
        TokenKind::Open | TokenKind::Close => false,
    }
}

fn find(word: &str) -> Option<(&'static str, Grammar)> {
    DIRECTIVES.binary_search_by_key(&word, |(name, _)| name).ok().map(|at| DIRECTIVES[at])
}

fn misplaced(token: &Token<'_>) -> SceneError {
    let what = match &token.kind {
        TokenKind::Number(_) => "a number",
        TokenKind::String(_) => "a string",
        TokenKind::Open | TokenKind::Close => "a bracket",
        TokenKind::Word(_) => "a word",
    };
    SceneError::at(token.span, format!("{what} where a directive is expected"))
        .help("statements start with a directive such as Shape or Material")
}

fn unknown_directive(word: &str, span: Span) -> SceneError {
    let error = SceneError::at(span, format!("there is no directive \"{}\"", shorten(word)));
    match word {
        "WorldEnd" => error.help("pbrt-v4 has none: the world ends with the file; leave it out"),
        _ => match crate::error::nearest(word, DIRECTIVES.map(|d| d.0)) {
            Some(near) => error.help(format!("did you mean \"{near}\"?")),
            None => error.help("scenes are written in the language of pbrt-v4"),
        },
    }
}

/// Splits "float radius" into type and name.
fn declare(declaration: &str, span: Span, errors: &mut ErrorList) -> Option<(ParamType, String)> {
    let mut words = declaration.split_ascii_whitespace();
    let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
        let message = format!("\"{}\" declares no parameter", shorten(declaration));
        errors.push(SceneError::at(span, message).help("write its type and its name: \"float radius\""));
        return None;
    };
    let Some(kind) = ParamType::parse(kind) else {
        let message = format!("there is no parameter type \"{}\"", shorten(kind));
        errors.push(SceneError::at(span, message).suggest(kind, ParamType::WORDS.map(|w| w.0)));
        return None;
    };
    Some((kind, name.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_directives_is_sorted_for_the_search() {
        assert!(DIRECTIVES.is_sorted_by_key(|d| d.0));
        assert!(DIRECTIVES.iter().all(|d| find(d.0) == Some(*d)));
    }
}
