//! All expressions as one deterministic automaton: each event is one look into a table.
//!
//! An event is a letter and a class of names: things that bear the same of the mentioned names are of one class. Letter and
//! class are a byte, expressions become regular expressions over bytes, and these, by the crate `regex-automata`, one
//! automaton, of which only the tables are kept.

use std::collections::HashMap;

use regex_automata::{
    Anchored, MatchKind,
    dfa::{Automaton as _, StartKind, dense},
    nfa::thompson,
    util::{primitives::StateID, start, syntax},
};

use super::{Events, Expr, ExprError, PathLayer, letter, parse::error};
use crate::path::turn::{Source, Turn};

/// Layers of light of one film: a bit each.
pub const MOST_LAYERS: usize = 128;
/// Classes of names, so that letters and classes fit into a byte.
const MOST_CLASSES: usize = 255 / (letter::TURNS + letter::SOURCES);
/// Memory for the automaton, and for making it [bytes].
const MOST_MEMORY: usize = 1 << 21;
/// The byte of the camera.
const CAMERA: u8 = 255;

/// The names of the things that events happen to, by their indices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Names {
    /// Of each object: its own and its material's.
    pub objects: Vec<Vec<String>>,
    /// Of each medium.
    pub media: Vec<Vec<String>>,
    /// Of each light.
    pub lights: Vec<Vec<String>>,
}

impl Names {
    /// All of them, sorted.
    pub fn all(&self) -> Vec<&str> {
        let lists = [&self.objects, &self.media, &self.lights];
        let mut all: Vec<_> = lists.into_iter().flatten().flatten().map(String::as_str).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// The expressions of a film, ready to be followed.
#[derive(Debug, Clone, PartialEq)]
pub struct Automaton {
    /// Where each turn leads, state by state.
    next: Vec<u16>,
    /// The layers that light of each source belongs to, state by state: a bit each.
    selects: Vec<u128>,
    /// Classes of names.
    classes: usize,
    objects: Vec<u8>,
    media: Vec<u8>,
    lights: Vec<u8>,
    layers: usize,
}

/// Why expressions make no automaton.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// One of them is at fault.
    #[error("layer `{layer}`: {}", error.shown(text))]
    Layer {
        /// Its layer.
        layer: String,
        /// It.
        text: String,
        /// What is wrong.
        error: ExprError,
    },
    /// All of them together.
    #[error("{0}")]
    Together(String),
}

impl Automaton {
    /// Makes one of expressions and of the names in a scene.
    ///
    /// # Errors
    /// A name that nothing bears, an expression that no path fits, more layers, names or states than there is room for.
    pub fn new(layers: &[PathLayer], names: &Names) -> Result<Self, BuildError> {
        if layers.len() > MOST_LAYERS {
            return Err(BuildError::Together(format!("an image has at most {MOST_LAYERS} layers of light")));
        }
        let classes = Classes::of(layers, names)?;
        let patterns = |layer: &PathLayer| layer.expr.all.iter().map(|expr| pattern(expr, &classes.lists)).collect();
        let patterns: Vec<Vec<String>> = layers.iter().map(patterns).collect();
        let tables = Tables::of(&patterns, classes.lists.len()).map_err(BuildError::Together)?;
        let mut fits = tables.fits.iter();
        if let Some(layer) = layers.iter().find(|layer| fits.by_ref().take(layer.expr.all.len()).any(|fits| !fits)) {
            return Err(in_layer(layer, never(layer)));
        }
        let Classes { lists, objects, media, lights } = classes;
        let Tables { next, selects, .. } = tables;
        Ok(Self { next, selects, classes: lists.len(), objects, media, lights, layers: layers.len() })
    }

    /// How many layers there are.
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// How many states there are.
    pub fn states(&self) -> usize {
        self.next.len() / (letter::TURNS * self.classes)
    }

    /// Where a turn leads; the first state is 0.
    #[inline]
    pub fn turn(&self, state: u16, turn: Turn) -> u16 {
        self.next[usize::from(state) * letter::TURNS * self.classes + self.column(turn)]
    }

    #[inline]
    fn column(&self, turn: Turn) -> usize {
        let class = match turn {
            Turn::Surface { object, .. } => class(&self.objects, object.0),
            Turn::Medium(id) => class(&self.media, id.0),
        };
        letter::of_turn(turn) * self.classes + class
    }

    /// Where many of the same turns lead. From as many on as there are states, states come round again.
    pub fn turns(&self, mut state: u16, turn: Turn, times: u32) -> u16 {
        let mut left = times;
        let first = times.min(self.states() as u32);
        for _ in 0..first {
            let next = self.turn(state, turn);
            left -= 1;
            if next == state {
                return state;
            }
            state = next;
        }
        if left == 0 {
            return state;
        }
        let (mut round, mut other) = (1, self.turn(state, turn));
        while other != state {
            other = self.turn(other, turn);
            round += 1;
        }
        (0..left % round).fold(state, |state, _| self.turn(state, turn))
    }

    /// The layers that light of a source belongs to, a bit each.
    #[inline]
    pub fn selects(&self, state: u16, source: Source) -> u128 {
        let Some(letter) = letter::of_source(source) else { return 0 };
        let class = match source {
            Source::Light(id) | Source::Sky(id) => class(&self.lights, id.0),
            Source::Medium(id) => class(&self.media, id.0),
            Source::Fault => 0,
        };
        let column = (letter - letter::TURNS) * self.classes + class;
        self.selects[usize::from(state) * letter::SOURCES * self.classes + column]
    }
}

#[inline]
fn class(of: &[u8], index: u32) -> usize {
    usize::from(of.get(index as usize).copied().unwrap_or(0))
}

fn in_layer(layer: &PathLayer, error: ExprError) -> BuildError {
    BuildError::Layer { layer: layer.name.clone(), text: layer.text.clone(), error }
}

fn never(layer: &PathLayer) -> ExprError {
    let starts = layer.text.trim_start().starts_with(['C', '<', '(', '[', '.']);
    let help = if starts {
        "it ends with L, O or B, a light, matter that glows or the background: C.*[LOB] is all light"
    } else {
        "it begins with C, the camera, and ends with L, O or B: C.*[LOB] is all light"
    };
    error(0, "no path of light fits this").help(help)
}

/// Which things bear the same of the mentioned names.
struct Classes {
    /// The names of each class; none in the first.
    lists: Vec<Vec<String>>,
    objects: Vec<u8>,
    media: Vec<u8>,
    lights: Vec<u8>,
}

impl Classes {
    fn of(layers: &[PathLayer], names: &Names) -> Result<Self, BuildError> {
        let known = names.all();
        let mut mentioned: Vec<&str> = Vec::new();
        for layer in layers {
            let items = layer.expr.all.iter().flat_map(Expr::events).flat_map(|events| &events.items);
            for name in items.filter_map(|item| item.name.as_ref()) {
                if known.binary_search(&name.text.as_str()).is_err() {
                    return Err(in_layer(layer, no_name(&name.text, name.at, &known)));
                }
                mentioned.push(&name.text);
            }
        }
        let mut lists = vec![Vec::new()];
        let mut index = HashMap::from([(Vec::new(), 0)]);
        let mut classes = |things: &[Vec<String>]| -> Option<Vec<u8>> {
            let class = |names: &Vec<String>| {
                let mut list: Vec<_> = names.iter().filter(|n| mentioned.contains(&n.as_str())).cloned().collect();
                list.sort_unstable();
                let next = lists.len();
                let class = *index.entry(list.clone()).or_insert(next);
                if class == next {
                    lists.push(list);
                }
                (class < MOST_CLASSES).then_some(class as u8)
            };
            things.iter().map(class).collect()
        };
        let found = (classes(&names.objects), classes(&names.media), classes(&names.lights));
        let (Some(objects), Some(media), Some(lights)) = found else {
            let most = MOST_CLASSES - 1;
            return Err(BuildError::Together(format!("the layers tell more than {most} names apart: ask for fewer")));
        };
        Ok(Self { lists, objects, media, lights })
    }
}

fn no_name(name: &str, at: usize, known: &[&str]) -> ExprError {
    /// More would fill the screen.
    const MOST_SHOWN: usize = 12;
    let list: Vec<_> = known.iter().take(MOST_SHOWN).map(|name| format!("'{name}'")).collect();
    let help = match known.len() {
        0 => "nothing in this scene has a name".into(),
        n if n > MOST_SHOWN => format!("{n} names are known, among them {}", list.join(", ")),
        _ => format!("known are {}", list.join(", ")),
    };
    error(at, format!("nothing in the scene is called '{name}'")).help(help)
}

/// An expression as a regular expression over bytes.
fn pattern(expr: &Expr, classes: &[Vec<String>]) -> String {
    let all = |parts: &[Expr], between: &str| {
        let parts: Vec<_> = parts.iter().map(|part| pattern(part, classes)).collect();
        format!("(?:{})", parts.join(between))
    };
    match expr {
        Expr::Event(events) => set(events, classes),
        Expr::Sequence(parts) => all(parts, ""),
        Expr::Either(parts) => all(parts, "|"),
        Expr::Repeat { of, least, most } => {
            let most = most.map(|most| most.to_string()).unwrap_or_default();
            format!("(?:{}){{{least},{most}}}", pattern(of, classes))
        }
    }
}

fn set(events: &Events, classes: &[Vec<String>]) -> String {
    let mut bytes = Vec::new();
    for letter in 0..letter::COUNT {
        for (class, names) in classes.iter().enumerate() {
            let is_camera = letter == letter::COUNT - 1;
            // The camera bears no name: it is of the first class.
            if !(is_camera && class > 0) && events.contain(letter, |name| names.iter().any(|n| n == name)) {
                bytes.push(if is_camera { CAMERA } else { (letter * classes.len() + class) as u8 });
            }
        }
    }
    let bytes = bytes.iter().map(|byte| format!("\\x{byte:02X}")).collect::<Vec<_>>().concat();
    // Without any: a set that no byte is in.
    if bytes.is_empty() { r"[^\x00-\xFF]".into() } else { format!("[{bytes}]") }
}

/// The automaton as tables.
struct Tables {
    next: Vec<u16>,
    selects: Vec<u128>,
    /// Of each pattern, whether any path fits it. What several select together may be nothing.
    fits: Vec<bool>,
}

impl Tables {
    /// The automaton of layers, each with patterns of which a path must fit all.
    fn of(layers: &[Vec<String>], classes: usize) -> Result<Self, String> {
        let patterns = layers.concat();
        let too_large =
            || "these layers are too large together: ask for fewer, or for less repetition in them".to_owned();
        let dfa = dense::Builder::new()
            .syntax(syntax::Config::new().unicode(false).utf8(false))
            .thompson(
                thompson::Config::new()
                    .utf8(false)
                    .which_captures(thompson::WhichCaptures::None)
                    .nfa_size_limit(Some(MOST_MEMORY)),
            )
            .configure(
                dense::Config::new()
                    .match_kind(MatchKind::All)
                    .start_kind(StartKind::Anchored)
                    .accelerate(false)
                    .dfa_size_limit(Some(MOST_MEMORY))
                    .determinize_size_limit(Some(MOST_MEMORY)),
            )
            .build_many(&patterns)
            .map_err(|_| too_large())?;
        let eye = dfa.start_state(&start::Config::new().anchored(Anchored::Yes));
        let eye = eye.map_err(|e| e.to_string())?;
        Self::explore(&dfa, dfa.next_state(eye, CAMERA), layers, classes).ok_or_else(too_large)
    }

    /// All states that turns lead to from the first, in the order of their discovery; `None` if they are too many.
    fn explore(dfa: &dense::DFA<Vec<u32>>, first: StateID, layers: &[Vec<String>], classes: usize) -> Option<Self> {
        let mut states = vec![first];
        let mut index = HashMap::from([(first, 0)]);
        let patterns = layers.iter().map(Vec::len).sum();
        let mut tables = Self { next: Vec::new(), selects: Vec::new(), fits: vec![false; patterns] };
        let turns = letter::TURNS * classes;
        let mut done = 0;
        while let Some(&state) = states.get(done) {
            done += 1;
            for byte in 0..turns {
                let next = dfa.next_state(state, byte as u8);
                let fresh = u16::try_from(states.len()).ok()?;
                let id = *index.entry(next).or_insert(fresh);
                if id == fresh {
                    states.push(next);
                }
                tables.next.push(id);
            }
            for byte in turns..turns + letter::SOURCES * classes {
                let end = dfa.next_eoi_state(dfa.next_state(state, byte as u8));
                let fits = fitting(dfa, end, patterns);
                tables.fits.iter_mut().zip(&fits).for_each(|(any, fits)| *any |= fits);
                tables.selects.push(selected(&fits, layers));
            }
        }
        Some(tables)
    }
}

/// Of each of the patterns, whether it fits a path that has ended here.
fn fitting(dfa: &dense::DFA<Vec<u32>>, end: StateID, patterns: usize) -> Vec<bool> {
    let mut fits = vec![false; patterns];
    let found = if dfa.is_match_state(end) { dfa.match_len(end) } else { 0 };
    for i in 0..found {
        fits[dfa.match_pattern(end, i).as_usize()] = true;
    }
    fits
}

/// The layers all of whose patterns fit, a bit each.
fn selected(mut fits: &[bool], layers: &[Vec<String>]) -> u128 {
    layers.iter().enumerate().fold(0, |bits, (number, patterns)| {
        let (own, others) = fits.split_at(patterns.len());
        fits = others;
        bits | u128::from(own.iter().all(|fits| *fits)) << number
    })
}
