//! One parameter: a type, a name and values.

use std::rc::Rc;

use super::lexer::{Token, TokenKind, shorten};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ParamType {
    Bool,
    Integer,
    Float,
    Point2,
    Point3,
    Vector2,
    Vector3,
    Normal3,
    Rgb,
    Blackbody,
    Spectrum,
    String,
    Texture,
}

impl ParamType {
    /// Every type with its words, the usual one first.
    pub(super) const WORDS: [(&'static str, Self); 16] = [
        ("bool", Self::Bool),
        ("integer", Self::Integer),
        ("float", Self::Float),
        ("point2", Self::Point2),
        ("point3", Self::Point3),
        ("point", Self::Point3),
        ("vector2", Self::Vector2),
        ("vector3", Self::Vector3),
        ("vector", Self::Vector3),
        ("normal", Self::Normal3),
        ("normal3", Self::Normal3),
        ("rgb", Self::Rgb),
        ("blackbody", Self::Blackbody),
        ("spectrum", Self::Spectrum),
        ("string", Self::String),
        ("texture", Self::Texture),
    ];

    pub(super) fn parse(word: &str) -> Option<Self> {
        Self::WORDS.into_iter().find(|(name, _)| *name == word).map(|(_, kind)| kind)
    }

    pub(super) fn word(self) -> &'static str {
        Self::WORDS.into_iter().find(|(_, kind)| *kind == self).map_or("?", |(name, _)| name)
    }

    /// How many numbers make one value.
    pub(super) fn numbers_each(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal3 | Self::Rgb => 3,
            _ => 1,
        }
    }
}

/// The values of a parameter as they were written.
#[derive(Clone, Debug, Default)]
pub(super) struct Values {
    pub(super) numbers: Vec<f64>,
    pub(super) strings: Vec<Spanned<String>>,
    pub(super) bools: Vec<bool>,
}

impl Values {
    pub(super) fn push(&mut self, token: Token<'_>) {
        match token.kind {
            TokenKind::Number(number) => self.numbers.push(number),
            TokenKind::String(text) => self.strings.push(Spanned::new(text.into_owned(), token.span)),
            TokenKind::Word(word) => self.bools.push(word == "true"),
            TokenKind::Open | TokenKind::Close => {}
        }
    }

    fn kinds(&self) -> [bool; 3] {
        [!self.numbers.is_empty(), !self.strings.is_empty(), !self.bools.is_empty()]
    }
}

/// One parameter, its values checked against its type.
#[derive(Clone, Debug)]
pub(super) struct Param {
    pub(super) kind: ParamType,
    pub(super) name: String,
    pub(super) values: Rc<Values>,
    /// The declaration `"float radius"`.
    pub(super) declared: Span,
    /// With the values.
    pub(super) span: Span,
    /// Whether it comes from an `Attribute` directive: such a parameter need not be used.
    pub(super) inherited: bool,
}

impl Param {
    /// # Errors
    /// The values are not of the type.
    pub(super) fn new(
        kind: ParamType,
        name: String,
        mut values: Values,
        declared: Span,
        span: Span,
    ) -> Result<Self, SceneError> {
        if kind == ParamType::Bool {
            values.unquote_bools();
        }
        let (wanted, what) = match kind {
            ParamType::Bool => ([false, false, true], "true or false"),
            ParamType::String | ParamType::Texture => ([false, true, false], "strings in quotes"),
            ParamType::Spectrum if values.numbers.is_empty() => {
                ([false, true, false], "pairs of wavelength and value, or the name of a spectrum")
            }
            _ => ([true, false, false], "numbers"),
        };
        let shown = shorten(&name).into_owned();
        let error = |message: String| SceneError::at(declared, message);
        if values.kinds() == [false; 3] {
            // An empty list is a list of nothing, as in `"integer indices" [ ]`.
            if kind.numbers_each() == 1 && !matches!(kind, ParamType::Float | ParamType::Integer) {
                return Err(error(format!("the parameter \"{shown}\" has no value")).help("write its value after it"));
            }
        } else if values.kinds() != wanted {
            return Err(error(format!("\"{} {shown}\" takes {what}", kind.word())));
        }
        let each = kind.numbers_each();
        if !values.numbers.len().is_multiple_of(each) {
            let count = values.numbers.len();
            return Err(error(format!("\"{} {shown}\" has {count} numbers, but takes {each} each", kind.word())));
        }
        if kind == ParamType::Integer
            && let Some(wrong) = values.numbers.iter().find(|n| n.fract() != 0.0 || n.abs() > i32::MAX as f64)
        {
            return Err(
                error(format!("{wrong} is no integer of 32 bits")).help(format!("the type of \"{shown}\" is integer"))
            );
        }
        Ok(Self { kind, name, values: Rc::new(values), declared, span, inherited: false })
    }

    /// The same as a default of an `Attribute` directive.
    pub(super) fn inherit(self) -> Self {
        Self { inherited: true, ..self }
    }
}

impl Values {
    /// Older files write "true" in quotes.
    fn unquote_bools(&mut self) {
        if self.numbers.is_empty() && self.strings.iter().all(|s| s.value == "true" || s.value == "false") {
            self.bools.extend(self.strings.drain(..).map(|s| s.value == "true"));
        }
    }
}
