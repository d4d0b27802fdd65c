//! An object of the scene (`<shape type="sphere">`) as a set of parameters that are asked for by name.
//!
//! Each question marks its answer as used; [`Object::finish`] reports what nobody asked for, with the nearest word that
//! somebody did. So the reader of a plugin is also the list of its words.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use glam::{DMat4, DVec3};

use super::number::{number, vector};
use super::transform::transform;
use super::tree::{self, Element};
use super::words;
use crate::desc::{FileRef, Ignored};
use crate::error::{ErrorList, SceneError};
use crate::source::{SourceMap, Span, Spanned};

/// What was found wrong, and what was found to have no effect.
#[derive(Default)]
pub(super) struct Report {
    pub(super) errors: ErrorList,
    pub(super) ignored: Vec<Ignored>,
}

/// Objects by their `id`.
pub(super) type Ids<'t> = HashMap<&'t str, &'t Element>;

/// Where files may lie.
#[derive(Clone, Copy)]
pub(super) struct Files<'t> {
    pub(super) sources: &'t SourceMap,
    pub(super) directories: &'t [PathBuf],
}

impl Files<'_> {
    /// The file of this name.
    pub(super) fn resolve(&self, name: Spanned<&str>) -> FileRef {
        name.map(|text| tree::resolve(text, name.span.file, self.directories, self.sources))
    }
}

/// A child, with references followed.
#[derive(Clone, Copy)]
pub(super) struct Child<'t> {
    pub(super) element: &'t Element,
    /// Where it stands in its parent: for a reference, the `<ref>`.
    pub(super) at: &'t Element,
    used: bool,
}

impl<'t> Child<'t> {
    pub(super) fn name(&self) -> Option<&'t str> {
        self.at.attribute("name").map(|name| name.value.as_str())
    }
}

/// What a spectrum measures, and so what numbers it may hold and what a single number means.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Measure {
    /// A part, in [0, 1].
    Part,
    /// At least 0.
    Amount,
    /// At least 0; a single number is white light, as an RGB triple is.
    Light,
}

/// An object being read.
pub(super) struct Object<'t> {
    pub(super) element: &'t Element,
    pub(super) files: Files<'t>,
    children: Vec<Child<'t>>,
    known: Vec<&'static str>,
}

impl<'t> Object<'t> {
    pub(super) fn new(element: &'t Element, ids: &Ids<'t>, files: Files<'t>, report: &mut Report) -> Self {
        let mut children = Vec::new();
        for at in &element.children {
            if at.tag != "ref" {
                children.push(Child { element: at, at, used: false });
            } else if let Some(&element) = ids.get(at.text("id")) {
                children.push(Child { element, at, used: false });
            } else if let Some(id) = at.attribute("id").filter(|_| !report.errors.is_full()) {
                let mut names: Vec<_> = ids.keys().copied().collect();
                names.sort_unstable();
                let error = SceneError::at(id.span, format!("nothing has the id \"{}\"", id.value));
                report.errors.push(error.suggest(&id.value, names));
            }
        }
        Self { element, files, children, known: Vec::new() }
    }

    /// The plugin.
    pub(super) fn kind(&self) -> &'t str {
        self.element.text("type")
    }

    /// `shape "sphere"`.
    fn title(&self) -> String {
        format!("{} \"{}\"", self.element.tag, self.kind())
    }

    /// The parameter of this name, if it is one of these elements.
    pub(super) fn parameter(&mut self, name: &'static str, tags: &[&str], report: &mut Report) -> Option<&'t Element> {
        self.known.push(name);
        let mut found: Option<&'t Element> = None;
        for child in self.children.iter_mut().filter(|child| child.name() == Some(name)) {
            child.used = true;
            let here = child.at.span_of("name");
            if let Some(first) = found {
                let error = SceneError::at(here, format!("\"{name}\" is given twice"));
                report.errors.push(error.related(first.span_of("name"), "first here"));
            } else {
                found = Some(child.at);
            }
        }
        let found = found?;
        if tags.contains(&found.tag) {
            return Some(found);
        }
        let here = found.span_of("name");
        report.errors.push(if matches!(found.tag, "texture" | "volume" | "ref") {
            SceneError::not_yet(here, format!("a <{}> for \"{name}\" is not known yet", found.tag))
                .help(format!("write a <{}>", tags[0]))
        } else {
            SceneError::at(here, format!("\"{name}\" is a <{}>, not a <{}>", tags[0], found.tag))
        });
        None
    }

    /// A parameter of one value, read by `read`.
    fn value<T>(
        &mut self,
        name: &'static str,
        tags: &[&str],
        report: &mut Report,
        read: impl FnOnce(&'t Element) -> Result<T, SceneError>,
    ) -> Option<Spanned<T>> {
        let element = self.parameter(name, tags, report)?;
        let value = report.errors.ok(read(element))?;
        Some(Spanned::new(value, element.span_of("value")))
    }

    /// A number for which `holds`; `wanted` says what that is, after "must be".
    pub(super) fn float(
        &mut self,
        name: &'static str,
        holds: impl Fn(f64) -> bool,
        wanted: &str,
        report: &mut Report,
    ) -> Option<Spanned<f64>> {
        self.value(name, &["float", "integer"], report, |element| {
            let (text, span) = (element.text("value"), element.span_of("value"));
            let value = number(text, span)?;
            if holds(value) { Ok(value) } else { Err(must_be(name, wanted, text, span)) }
        })
    }

    /// A whole number, at least `least`.
    pub(super) fn integer(&mut self, name: &'static str, least: i64, report: &mut Report) -> Option<Spanned<i64>> {
        self.value(name, &["integer"], report, |element| {
            let (text, span) = (element.text("value"), element.span_of("value"));
            match text.trim().parse::<i64>() {
                Ok(value) if value >= least && value <= i64::from(u32::MAX) => Ok(value),
                Ok(_) => Err(must_be(name, &format!("at least {least}, and less than 2³²"), text, span)),
                Err(_) => Err(SceneError::at(span, format!("\"{text}\" is not a whole number"))),
            }
        })
    }

    /// A whole number that fits an unsigned 32-bit one, or `default`.
    pub(super) fn count(&mut self, name: &'static str, least: u32, default: u32, report: &mut Report) -> Spanned<u32> {
        let found = self.integer(name, least.into(), report).map(|count| count.map(|c| c as u32));
        found.unwrap_or(Spanned::new(default, self.element.span))
    }

    /// Yes or no; no if it is not there.
    pub(super) fn flag(&mut self, name: &'static str, default: bool, report: &mut Report) -> bool {
        let found = self.value(name, &["boolean"], report, |element| {
            match element.text("value").to_ascii_lowercase().as_str() {
                "true" => Ok(true),
                "false" => Ok(false),
                other => {
                    Err(SceneError::at(element.span_of("value"), format!("\"{other}\" is neither true nor false")))
                }
            }
        });
        found.map_or(default, |flag| flag.value)
    }

    pub(super) fn string(&mut self, name: &'static str, report: &mut Report) -> Option<Spanned<&'t str>> {
        self.value(name, &["string"], report, |element| Ok(element.text("value")))
    }

    /// One of these words, or the first of them.
    pub(super) fn choice<T: Copy>(&mut self, name: &'static str, words: &[(&str, T)], report: &mut Report) -> T {
        let Some(word) = self.string(name, report) else { return words[0].1 };
        let lower = word.value.to_ascii_lowercase();
        if let Some((_, value)) = words.iter().find(|(known, _)| *known == lower) {
            return *value;
        }
        let error = SceneError::at(word.span, format!("\"{name}\" cannot be \"{}\"", word.value));
        report.errors.push(error.suggest(word.value, words.iter().map(|(known, _)| *known)));
        words[0].1
    }

    /// The text of a number or of a string: an index of refraction, given by value or by name.
    pub(super) fn number_or_name(
        &mut self,
        name: &'static str,
        report: &mut Report,
    ) -> Option<(&'t str, Spanned<&'t str>)> {
        let element = self.parameter(name, &["float", "integer", "string"], report)?;
        Some((element.tag, Spanned::new(element.text("value"), element.span_of("value"))))
    }

    pub(super) fn point(&mut self, name: &'static str, report: &mut Report) -> Option<Spanned<DVec3>> {
        self.value(name, &["point", "vector"], report, |element| vector(element, 0.0))
    }

    /// The object of this name and tag, given here or by reference.
    pub(super) fn object_of(&mut self, name: &'static str, tag: &str) -> Option<Child<'t>> {
        let child = self.children.iter_mut().find(|child| child.name() == Some(name) && child.element.tag == tag)?;
        self.known.push(name);
        child.used = true;
        Some(*child)
    }

    /// `to_world`, or the identity.
    pub(super) fn transform(&mut self, report: &mut Report) -> DMat4 {
        self.named_transform("to_world", report)
    }

    /// The transform of this name, or the identity.
    pub(super) fn named_transform(&mut self, name: &'static str, report: &mut Report) -> DMat4 {
        let element = self.parameter(name, &["transform"], report);
        element.map_or(DMat4::IDENTITY, |element| transform(element, &mut report.errors))
    }

    /// Whether a parameter is there, whatever it is.
    pub(super) fn has(&self, name: &str) -> bool {
        self.children.iter().any(|child| child.name() == Some(name))
    }

    /// The objects of this tag inside it, given here or by reference.
    pub(super) fn nested(&mut self, tag: &str) -> Vec<Child<'t>> {
        let children = self.children.iter_mut().filter(|child| child.element.tag == tag);
        children
            .map(|child| {
                child.used = true;
                *child
            })
            .collect()
    }

    /// The one object of this tag inside it; more than one is an error.
    pub(super) fn only(&mut self, tag: &str, report: &mut Report) -> Option<Child<'t>> {
        let all = self.nested(tag);
        if let [first, second, ..] = all[..] {
            let error =
                SceneError::at(second.at.span, format!("the {} takes one <{tag}>, not {}", self.title(), all.len()));
            report.errors.push(error.related(first.at.span, "first here"));
        }
        all.first().copied()
    }

    /// Objects that stand here only for others to refer to.
    pub(super) fn leave_to_references(&mut self, referred: &HashSet<Span>) {
        for child in self.children.iter_mut().filter(|child| referred.contains(&child.element.span)) {
            child.used = true;
        }
    }

    /// Parameters that are known and change nothing here.
    pub(super) fn ignore(&mut self, names: &[&'static str], reason: &'static str, report: &mut Report) {
        self.known.extend(names);
        for child in self.children.iter_mut().filter(|child| child.name().is_some_and(|name| names.contains(&name))) {
            child.used = true;
            report.ignored.push(Ignored { span: child.at.span, reason });
        }
    }

    /// Parameters that Mitsuba knows and tyndall does not, if they are given.
    pub(super) fn not_yet(&mut self, names: &[&'static str], report: &mut Report) {
        let title = self.title();
        for child in &mut self.children {
            if let Some(name) = child.name().filter(|name| names.contains(name)) {
                child.used = true;
                let message = format!("\"{name}\" of the {title} is not known yet");
                report.errors.push(SceneError::not_yet(child.at.span_of("name"), message).help("leave it out"));
            }
        }
    }

    /// Reports every child that nobody asked for.
    pub(super) fn finish(self, report: &mut Report) {
        let title = self.title();
        for child in self.children.iter().filter(|child| !child.used) {
            let is_object = words::is_object(child.element.tag);
            report.errors.push(match child.name() {
                Some(name) if !is_object => {
                    let message = format!("the {title} has no parameter \"{name}\"");
                    SceneError::at(child.at.span_of("name"), message).suggest(name, self.known.iter().copied())
                }
                _ => SceneError::at(child.at.span, format!("the {title} takes no <{}>", child.element.tag)),
            });
        }
    }
}

pub(super) fn must_be(name: &str, wanted: &str, text: &str, span: Span) -> SceneError {
    SceneError::at(span, format!("\"{name}\" must be {wanted}, not {text}"))
}
