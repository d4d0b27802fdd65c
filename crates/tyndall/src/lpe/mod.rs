//! Light path expressions: which light belongs to a layer, said as a pattern over what its path went through, from the
//! camera to the light.
//!
//! | letter | stands for |
//! |---|---|
//! | `C` | the camera: every expression begins with it |
//! | `R`, `T` | reflection, transmission at a surface |
//! | `S`, `G`, `D` | either of them by a sharp (Dirac), glossy or diffuse lobe |
//! | `V` | scattering in a medium |
//! | `L`, `O`, `B` | a light, matter that glows, the background: every expression ends with one |
//! | `.` | anything |
//!
//! `<RD>` is a reflection that is diffuse; `V'milk'`, `<RD'wall'>`, `L'lamp'` are those that bear a name (of a medium, of a
//! surface or its material, of a light); `'milk'` is anything that bears it. `[RV]` is one of several, `[^V]` any other.
//! `*`, `+`, `?`, `{2}`, `{2,}`, `{2,4}` repeat what stands before them, `|` separates alternatives, parentheses group.
//! `a & b` selects what both select.
//!
//! A boundary without a material is no event, nor is a hole. A surface is diffuse if all that it scatters beside Dirac lobes
//! follows Lambert's law, else glossy.
//!
//! All expressions of a film become one deterministic automaton ([`automaton`]); a path carries its state. The layers that
//! have names ([`named`]) are expressions like any other.
//!
//! Source: Heckbert 1990 (the alphabet), and the light path expressions of Open Shading Language and Arnold, with a letter
//! for volumes.

pub mod automaton;
pub mod explain;
pub mod letter;
pub mod named;
pub mod parse;

pub use automaton::{Automaton, Names};
pub use letter::Letters;
pub use parse::parse;

/// A whole expression: patterns of which a path must fit each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expression {
    /// One pattern or more.
    pub all: Vec<Expr>,
}

/// A pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Expr {
    /// One event.
    Event(Events),
    /// One after the other.
    Sequence(Vec<Self>),
    /// One of several.
    Either(Vec<Self>),
    /// The same several times.
    Repeat {
        /// What.
        of: Box<Self>,
        /// How often at least.
        least: u32,
        /// How often at most.
        most: Option<u32>,
    },
}

/// A set of events.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Events {
    /// Each of them; an event belongs to the set if it fits one.
    pub items: Vec<Item>,
    /// Whether those are meant that fit none.
    pub negated: bool,
}

/// Events of some letters, perhaps with a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// Letters.
    pub letters: Letters,
    /// The name that they must bear.
    pub name: Option<Name>,
}

/// A name in an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// It.
    pub text: String,
    /// Where it stands in the expression [bytes].
    pub at: usize,
}

impl Events {
    /// Whether an event of a letter (by its number) fits, if it bears the names for which `bears` says so.
    pub fn contain(&self, letter: usize, bears: impl Fn(&str) -> bool) -> bool {
        let fits = |item: &Item| item.letters.has(letter) && item.name.as_ref().is_none_or(|name| bears(&name.text));
        self.items.iter().any(fits) != self.negated
    }
}

impl Expr {
    /// Its sets of events, in the order of the text.
    pub(crate) fn events(&self) -> Vec<&Events> {
        match self {
            Self::Event(events) => vec![events],
            Self::Sequence(parts) | Self::Either(parts) => parts.iter().flat_map(Self::events).collect(),
            Self::Repeat { of, .. } => of.events(),
        }
    }
}

/// A layer of light.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathLayer {
    /// How it is called.
    pub name: String,
    /// The expression as it was written.
    pub text: String,
    /// What it selects.
    pub expr: Expression,
}

impl PathLayer {
    /// How a list of layers asks for it.
    pub fn word(&self) -> String {
        match named::named(&self.name) {
            Ok(known) if known == *self => self.name.clone(),
            _ => format!("{}={}", self.name, self.text),
        }
    }
}

/// What is wrong with an expression.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExprError {
    /// Where [bytes].
    pub at: usize,
    /// What.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}
