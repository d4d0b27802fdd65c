//! Layers that have names, and lists of layers as users write them: `direct,indirect,orders:8,caustic=CDS+L`.
//!
//! | name | its light was scattered | expression |
//! |---|---|---|
//! | `all` | in any way | `C.*[LOB]` |
//! | `emission` | not at all | `C[LOB]` |
//! | `direct` | once, by a surface or a medium | `C.[LOB]` |
//! | `indirect` | more than once | `C..+[LOB]` |
//! | `unscattered` | by no medium | `C[RT]*[LOB]` |
//! | `single` | by media once, and by surfaces as often as it likes | `C[RT]*V[RT]*[LOB]` |
//! | `multiple` | by media more than once | `C[RT]*V[RT]*V.*[LOB]` |
//! | `order3` | by media three times | `C[RT]*(V[RT]*){3}[LOB]` |
//! | `beyond8` | by media more than eight times | `C[RT]*(V[RT]*){9,}[LOB]` |
//! | `depth3` | three times, by surfaces and media | `C.{3}[LOB]` |
//! | `deeper8` | more than eight times | `C.{9,}[LOB]` |
//! | `surface`, `volume` | in any way; what is seen there is a surface, a medium | `C[RT].*[LOB]`, `CV.*[LOB]` |
//!
//! With `_surface` or `_volume` behind it, a layer is that part of it in which a surface or a medium was the first to scatter,
//! seen from the camera: `direct_volume` is `CV[LOB]`. `orders:8` stands for `order0` to `order8` and `beyond8`, `depths:8` for
//! `depth0` to `depth8` and `deeper8`: the orders of scattering where there are no media, as in hair and grains.
//!
//! `single@'milk'` is the part of `single` whose paths meet what is called so, `direct@L'lamp'` the part of `direct` that comes from
//! that light: `C.[LOB] & .*L'lamp'.*`, in a layer `direct_lamp`. So for every name, and for `orders:8@V'milk'`.
//!
//! `emission`, `direct` and `indirect` add up to all light; so do `unscattered`, `single` and `multiple`, and `orders:N`, and `depths:N`.

use super::{PathLayer, parse};

/// A layer that has a name.
#[derive(Clone, Copy)]
struct Named {
    name: &'static str,
    whole: &'static str,
    /// The parts in which a surface or a medium was first to scatter, where it is divided so.
    parts: Option<[&'static str; 2]>,
    /// How its light was scattered.
    meaning: &'static str,
}

const fn undivided(name: &'static str, whole: &'static str, meaning: &'static str) -> Named {
    Named { name, whole, parts: None, meaning }
}

const fn divided(name: &'static str, whole: &'static str, parts: [&'static str; 2], meaning: &'static str) -> Named {
    Named { name, whole, parts: Some(parts), meaning }
}

const NAMED: [Named; 9] = [
    undivided("all", "C.*[LOB]", "in any way"),
    undivided("emission", "C[LOB]", "not at all"),
    divided("direct", "C.[LOB]", ["C[RT][LOB]", "CV[LOB]"], "once, by a surface or a medium"),
    divided("indirect", "C..+[LOB]", ["C[RT].+[LOB]", "CV.+[LOB]"], "more than once"),
    undivided("unscattered", "C[RT]*[LOB]", "by no medium"),
    divided("single", "C[RT]*V[RT]*[LOB]", ["C[RT]+V[RT]*[LOB]", "CV[RT]*[LOB]"], "by media once"),
    divided("multiple", "C[RT]*V[RT]*V.*[LOB]", ["C[RT]+V[RT]*V.*[LOB]", "CV[RT]*V.*[LOB]"], "by media more than once"),
    undivided("surface", "C[RT].*[LOB]", "in any way; what is seen there is a surface"),
    undivided("volume", "CV.*[LOB]", "in any way; what is seen there is a medium"),
];
/// Further forms, for messages.
const FORMS: [&str; 8] =
    ["order3", "beyond8", "orders:8", "depth3", "deeper8", "depths:8", "direct@'name'", "NAME=EXPRESSION"];
/// Orders that `orders:N` and `depths:N` tell apart.
const MOST_ORDERS: u32 = 64;
/// Names that the file has for other things.
const TAKEN: [&str; 4] = ["stderr", "R", "G", "B"];

/// What counts as a scattering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// Collisions in media.
    Media,
    /// These, and surfaces with a material.
    All,
}

/// Light that was scattered so often, which `order3`, `beyond8`, `depth3` and `deeper8` name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    /// What is counted.
    pub by: By,
    /// How often.
    pub n: u32,
    /// Or rather more often than that.
    pub more: bool,
}

impl By {
    /// How layers are called that are scattered a number of times, more often, and a list of them.
    const fn words(self) -> [&'static str; 3] {
        match self {
            Self::Media => ["order", "beyond", "orders:"],
            Self::All => ["depth", "deeper", "depths:"],
        }
    }
}

impl Count {
    /// What a name says of it, if it is such a name.
    pub fn named(name: &str) -> Option<Self> {
        [By::Media, By::All].into_iter().find_map(|by| {
            let [exactly, more, _] = by.words();
            let (digits, more) =
                name.strip_prefix(more).map(|n| (n, true)).or(name.strip_prefix(exactly).map(|n| (n, false)))?;
            let n = digits.parse().ok().filter(|n: &u32| *n <= MOST_ORDERS && digits == n.to_string())?;
            Some(Self { by, n, more })
        })
    }

    /// Its expression, or that of its part in which a surface (0) or a medium (1) was first; empty if it has no such part.
    fn expression(self, part: Option<usize>) -> String {
        let (n, up) = if self.more { (self.n + 1, ",") } else { (self.n, "") };
        let Some(less) = n.checked_sub(1) else {
            let whole = if self.by == By::Media { "C[RT]*[LOB]" } else { "C[LOB]" };
            return if part.is_none() { whole.into() } else { String::new() };
        };
        match (self.by, part) {
            (By::Media, None) => format!("C[RT]*(V[RT]*){{{n}{up}}}[LOB]"),
            (By::Media, Some(0)) => format!("C[RT]+(V[RT]*){{{n}{up}}}[LOB]"),
            (By::Media, Some(_)) => format!("CV[RT]*(V[RT]*){{{less}{up}}}[LOB]"),
            (By::All, None) => format!("C.{{{n}{up}}}[LOB]"),
            (By::All, Some(0)) => format!("C[RT].{{{less}{up}}}[LOB]"),
            (By::All, Some(_)) => format!("CV.{{{less}{up}}}[LOB]"),
        }
    }
}

/// What is wrong with a list of layers.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ListError(pub String);

/// Names, expressions and meanings of layers, for people.
pub fn table() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let plain = NAMED.into_iter().map(|Named { name, whole, meaning, .. }| (name, whole, meaning));
    let parts = [
        ("order3", "C[RT]*(V[RT]*){3}[LOB]", "by media three times"),
        ("beyond8", "C[RT]*(V[RT]*){9,}[LOB]", "by media more than eight times"),
        ("orders:8", "", "all of order0 to order8, and beyond8"),
        ("depth3", "C.{3}[LOB]", "three times, by surfaces and media"),
        ("deeper8", "C.{9,}[LOB]", "more than eight times, by surfaces and media"),
        ("depths:8", "", "all of depth0 to depth8, and deeper8"),
        ("direct_surface", "C[RT][LOB]", "as direct, first by a surface, seen from the camera"),
        ("direct_volume", "CV[LOB]", "as direct, first by a medium; so for indirect, single, multiple, order3"),
        ("single@'milk'", "C[RT]*V[RT]*[LOB] & .*'milk'.*", "as single, where paths meet what is called so"),
        ("direct@L'lamp'", "C.[LOB] & .*L'lamp'.*", "as direct, from that light; so for every layer"),
        ("NAME=EXPR", "", "what an expression selects, under a name of your own"),
    ];
    plain.chain(parts)
}

/// The layers that a list asks for, one after the other.
///
/// # Errors
/// Unknown or doubled names, faulty expressions.
pub fn list(text: &str) -> Result<Vec<PathLayer>, ListError> {
    items(pieces(text).into_iter())
}

/// The same of a list in pieces.
///
/// # Errors
/// As [`list`].
pub fn items<'a>(pieces: impl Iterator<Item = &'a str>) -> Result<Vec<PathLayer>, ListError> {
    let mut layers: Vec<PathLayer> = Vec::new();
    for item in pieces.map(str::trim).filter(|item| !item.is_empty()) {
        for layer in self::item(item)? {
            match layers.iter().find(|other| other.name == layer.name) {
                None => layers.push(layer),
                Some(other) if *other == layer => {} // asked for twice, recorded once
                Some(_) => return Err(ListError(format!("two layers are called `{}`", layer.name))),
            }
        }
    }
    Ok(layers)
}

/// Parts between commas, but for those in braces and quotes.
fn pieces(text: &str) -> Vec<&str> {
    let (mut pieces, mut start) = (Vec::new(), 0);
    let (mut braces, mut quote) = (0i32, None);
    for (at, c) in text.char_indices() {
        match (c, quote) {
            ('\'' | '"', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            ('{', None) => braces += 1,
            ('}', None) => braces -= 1,
            (',', None) if braces <= 0 => {
                pieces.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    pieces.push(&text[start..]);
    pieces
}

fn item(item: &str) -> Result<Vec<PathLayer>, ListError> {
    if let Some((name, text)) = item.split_once('=') {
        let name = name.trim();
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(is_word) || TAKEN.contains(&name) {
            let help = "letters, digits, `_` and `-` make a name; `stderr`, R, G and B are taken";
            return Err(ListError(format!("a layer cannot be called `{name}`: {help}")));
        }
        return Ok(vec![layer(name, text.trim())?]);
    }
    if let Some((base, event)) = item.split_once('@') {
        return self::item(base.trim())?.iter().map(|layer| crossed(layer, event.trim())).collect();
    }
    for [exactly, more, list] in [By::Media.words(), By::All.words()] {
        let Some(most) = item.strip_prefix(list) else { continue };
        let most: u32 = most.parse().ok().filter(|n| *n <= MOST_ORDERS).ok_or_else(|| {
            ListError(format!("`{item}` names no layers: {list}N has N from 0 to {MOST_ORDERS}, as in {list}8"))
        })?;
        let last = format!("{more}{most}");
        return (0..=most).map(|n| format!("{exactly}{n}")).chain([last]).map(|name| named(&name)).collect();
    }
    Ok(vec![named(item)?])
}

/// The part of a layer whose paths have an event with a name.
fn crossed(of: &PathLayer, event: &str) -> Result<PathLayer, ListError> {
    let name = event.split(['\'', '"']).nth(1).unwrap_or("");
    let word = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    if name.is_empty() {
        let help = "write what is to be met behind it, as in single@'milk', direct@L'lamp'";
        return Err(ListError(format!("`@{event}` has no name in quotes: {help}")));
    }
    let name: String = format!("{}_{name}", of.name).chars().map(word).collect();
    layer(&name, &format!("{} & .*{event}.*", of.text))
}

fn layer(name: &str, text: &str) -> Result<PathLayer, ListError> {
    let expr = parse(text).map_err(|e| ListError(format!("layer `{name}`: {}", e.shown(text))))?;
    Ok(PathLayer { name: name.into(), text: text.into(), expr })
}

/// The layer of a name.
///
/// # Errors
/// There is none.
pub fn named(name: &str) -> Result<PathLayer, ListError> {
    let (base, part) = match (name.strip_suffix("_surface"), name.strip_suffix("_volume")) {
        (Some(base), _) => (base, Some(0)),
        (_, Some(base)) => (base, Some(1)),
        _ => (name, None),
    };
    let text = match NAMED.iter().find(|known| known.name == base) {
        Some(Named { whole, parts, .. }) => Some(match part {
            None => (*whole).to_owned(),
            Some(part) => parts.map_or(String::new(), |parts| parts[part].to_owned()),
        }),
        None => Count::named(base).map(|count| count.expression(part)),
    };
    match text.as_deref() {
        Some("") => Err(ListError(format!("`{base}` is not divided by what scatters first: there is no `{name}`"))),
        Some(text) => layer(name, text),
        None => Err(unknown(name)),
    }
}

fn unknown(name: &str) -> ListError {
    if parse(name).is_ok() && name.starts_with('C') {
        return ListError(format!("`{name}` is an expression without a name: write NAME={name}"));
    }
    let names: Vec<_> = NAMED.iter().map(|known| known.name).chain(FORMS).collect();
    let distance = |known: &&&str| strsim::damerau_levenshtein(name, known);
    let near = names.iter().filter(|_| name.len() < 64).min_by_key(distance).filter(|near| distance(near) <= 2);
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known are {}", names.join(", ")),
    };
    ListError(format!("there is no layer `{name}`: {help}"))
}
