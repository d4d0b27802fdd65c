//! From XML to a tree of elements: files included, parameters replaced, attributes checked, every word with its place.
//!
//! What a plugin or its parameters mean is not known here.

use std::path::{Path, PathBuf};

use roxmltree::{Document, Node};

use super::parameters::Parameters;
use crate::error::{ErrorList, SceneError};
use crate::source::{FileId, SourceMap, Span, Spanned};

/// The deepest nesting of elements, and of includes (Mitsuba's own limit).
const DEEPEST: usize = 32;
const DEEPEST_INCLUDE: usize = 15;

/// Every element with the attributes that it takes; `!` marks those that it must have.
const TAGS: &[(&str, &[&str])] = &[
    ("scene", &["!version", "type", "id", "name"]),
    ("bsdf", OBJECT),
    ("emitter", OBJECT),
    ("film", OBJECT),
    ("integrator", OBJECT),
    ("medium", OBJECT),
    ("phase", OBJECT),
    ("rfilter", OBJECT),
    ("sampler", OBJECT),
    ("sensor", OBJECT),
    ("shape", OBJECT),
    ("texture", OBJECT),
    ("volume", OBJECT),
    ("boolean", VALUE),
    ("float", VALUE),
    ("integer", VALUE),
    ("string", VALUE),
    ("rgb", VALUE),
    ("spectrum", &["!name", "value", "filename", "type", "id"]),
    ("point", &["!name", "value", "x", "y", "z"]),
    ("vector", &["!name", "value", "x", "y", "z"]),
    ("transform", &["!name"]),
    ("translate", &["value", "x", "y", "z"]),
    ("scale", &["value", "x", "y", "z"]),
    ("rotate", &["!angle", "value", "x", "y", "z"]),
    ("lookat", &["!origin", "!target", "up"]),
    ("matrix", &["!value"]),
    ("ref", &["!id", "name"]),
    ("alias", &["!id", "!as"]),
    ("default", VALUE),
    ("include", &["!filename", "name"]),
    ("path", &["!value"]),
];
const OBJECT: &[&str] = &["!type", "id", "name", "version"];
const VALUE: &[&str] = &["!name", "!value"];

/// An attribute, its parameters replaced.
pub(super) struct Attribute {
    name: &'static str,
    pub(super) value: String,
    /// The value as written.
    pub(super) span: Span,
}

/// An element of the scene.
pub(super) struct Element {
    pub(super) tag: &'static str,
    /// The whole element: no two are the same.
    pub(super) span: Span,
    attributes: Vec<Attribute>,
    pub(super) children: Vec<Element>,
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|a| a.name == name)
    }

    /// Its `id`, which is what the scene calls it.
    pub(super) fn id(&self) -> Option<String> {
        self.attribute("id").map(|id| id.value.clone())
    }

    /// The value of an attribute, empty if it is not there.
    pub(super) fn text(&self, name: &str) -> &str {
        self.attribute(name).map_or("", |a| &a.value)
    }

    /// Where the value of an attribute stands, or else the element.
    pub(super) fn span_of(&self, name: &str) -> Span {
        self.attribute(name).map_or(self.span, |a| a.span)
    }
}

/// A scene as a tree.
pub(super) struct Tree {
    pub(super) root: Element,
    /// Names given by `<alias>`, with what they stand for.
    pub(super) aliases: Vec<(String, Spanned<String>)>,
    /// Directories in which files may lie: that of the scene file, then those of `<path>`.
    pub(super) directories: Vec<PathBuf>,
}

/// Reads the scene file and all that it includes. `None` if there is no tree; why is among the errors.
pub(super) fn read(
    file: FileId,
    overrides: &[(String, String)],
    sources: &mut SourceMap,
    errors: &mut ErrorList,
) -> Option<Tree> {
    let directory = directory(sources, file);
    let mut reader = Reader {
        sources,
        errors,
        parameters: Parameters::new(overrides),
        aliases: Vec::new(),
        directories: vec![directory],
    };
    let root = reader.file(file, None, 0)?;
    reader.parameters.check_overrides(reader.errors);
    Some(Tree { root, aliases: reader.aliases, directories: reader.directories })
}

fn directory(sources: &SourceMap, file: FileId) -> PathBuf {
    sources.get(file).and_then(|f| f.path.parent()).unwrap_or(Path::new("")).to_owned()
}

/// Where a file lies that is named in `from`: beside it, or in one of the directories. Beside it if nowhere, so that the
/// error of opening it names a sensible place.
pub(super) fn resolve(name: &str, from: FileId, directories: &[PathBuf], sources: &SourceMap) -> PathBuf {
    let beside = directory(sources, from).join(name);
    let elsewhere = directories.iter().map(|directory| directory.join(name));
    if beside.exists() { beside } else { elsewhere.into_iter().find(|path| path.exists()).unwrap_or(beside) }
}

struct Reader<'a> {
    sources: &'a mut SourceMap,
    errors: &'a mut ErrorList,
    parameters: Parameters,
    aliases: Vec<(String, Spanned<String>)>,
    directories: Vec<PathBuf>,
}

impl Reader<'_> {
    fn file(&mut self, file: FileId, included_from: Option<Span>, includes: usize) -> Option<Element> {
        // The document borrows the text while includes add to the map.
        let text = self.sources.text(file).to_owned();
        let document = match Document::parse(&text) {
            Ok(document) => document,
            Err(error) => {
                self.errors.push(xml_error(&error, &text, file));
                return None;
            }
        };
        let node = document.root_element();
        let root = self.element(node, file, includes, 0)?;
        if included_from.is_none() && root.tag != "scene" {
            let name = Span::new(file, node.range().start + 1, node.range().start + 1 + root.tag.len());
            self.errors.push(SceneError::at(name, format!("the file holds a <{}>, not a <scene>", root.tag)));
            return None;
        }
        self.check_version(&root);
        Some(root)
    }

    fn check_version(&mut self, root: &Element) {
        let Some(version) = root.attribute("version") else {
            if root.tag != "scene" {
                self.errors.push(SceneError::at(root.span, format!("<{}> lacks the attribute \"version\"", root.tag)));
            }
            return;
        };
        match version.value.split('.').next().and_then(|major| major.parse::<u32>().ok()) {
            Some(2 | 3) => {}
            Some(_) => self.errors.push(
                SceneError::at(version.span, format!("scenes of Mitsuba {} cannot be read", version.value))
                    .help("versions 2 and 3 can; Mitsuba 3 converts older scenes"),
            ),
            None => self.errors.push(SceneError::at(version.span, format!("\"{}\" is no version", version.value))),
        }
    }

    fn element(&mut self, node: Node, file: FileId, includes: usize, depth: usize) -> Option<Element> {
        let span = Span::new(file, node.range().start, node.range().end);
        let name = node.tag_name().name();
        let name_span = Span::new(file, node.range().start + 1, node.range().start + 1 + name.len());
        let Some(&(tag, allowed)) = TAGS.iter().find(|(tag, _)| *tag == name) else {
            let error = SceneError::at(name_span, format!("there is no element <{name}>"));
            self.errors.push(error.suggest(name, TAGS.iter().map(|(tag, _)| *tag)));
            return None;
        };
        if depth >= DEEPEST {
            self.errors.push(SceneError::at(name_span, format!("elements are nested more than {DEEPEST} deep")));
            return None;
        }
        let attributes = self.attributes(node, file, tag, allowed, name_span);
        let mut element = Element { tag, span, attributes, children: Vec::new() };
        for child in node.children() {
            if child.is_element() {
                self.child(child, &mut element, file, includes, depth);
            } else if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                let span = Span::new(file, child.range().start, child.range().end);
                self.errors.push(SceneError::at(span, format!("text inside <{tag}> has no meaning")));
            }
        }
        Some(element)
    }

    fn attributes(
        &mut self,
        node: Node,
        file: FileId,
        tag: &str,
        allowed: &'static [&'static str],
        name_span: Span,
    ) -> Vec<Attribute> {
        let plain = |allowed: &&'static str| allowed.trim_start_matches('!');
        let mut attributes = Vec::new();
        for attribute in node.attributes() {
            let Some(name) = allowed.iter().map(plain).find(|name| *name == attribute.name()) else {
                let range = attribute.range_qname();
                let message = format!("<{tag}> has no attribute \"{}\"", attribute.name());
                let error = SceneError::at(Span::new(file, range.start, range.end), message);
                self.errors.push(error.suggest(attribute.name(), allowed.iter().map(plain)));
                continue;
            };
            let range = attribute.range_value();
            let span = Span::new(file, range.start, range.end);
            let value = self.parameters.substitute(attribute.value(), span, self.errors);
            attributes.push(Attribute { name, value, span });
        }
        for required in allowed.iter().filter_map(|name| name.strip_prefix('!')) {
            // A name that the user got wrong has been told already.
            if attributes.len() == node.attributes().len() && !attributes.iter().any(|a| a.name == required) {
                self.errors.push(SceneError::at(name_span, format!("<{tag}> lacks the attribute \"{required}\"")));
            }
        }
        attributes
    }

    /// Reads a child into its parent, or does what it says.
    fn child(&mut self, node: Node, parent: &mut Element, file: FileId, includes: usize, depth: usize) {
        let Some(child) = self.element(node, file, includes, depth + 1) else { return };
        match child.tag {
            "default" => self.parameters.default(child.text("name"), child.text("value")),
            "alias" => {
                let id = Spanned::new(child.text("id").to_owned(), child.span_of("id"));
                self.aliases.push((child.text("as").to_owned(), id));
            }
            "path" => {
                let path = resolve(child.text("value"), file, &self.directories, self.sources);
                if !path.is_dir() {
                    let message = format!("there is no directory {}", path.display());
                    self.errors.push(SceneError::at(child.span_of("value"), message));
                }
                self.directories.push(path);
            }
            "include" => self.include(&child, parent, file, includes),
            "scene" => self.errors.push(SceneError::at(child.span, "a <scene> cannot stand inside another element")),
            _ => parent.children.push(child),
        }
    }

    /// The objects of an included scene, or the one object of an included file.
    fn include(&mut self, include: &Element, parent: &mut Element, file: FileId, includes: usize) {
        let span = include.span_of("filename");
        if includes >= DEEPEST_INCLUDE {
            let message = format!("files include each other more than {DEEPEST_INCLUDE} deep");
            self.errors.push(SceneError::at(span, message).help("does a file include itself?"));
            return;
        }
        let path = resolve(include.text("filename"), file, &self.directories, self.sources);
        let read = self.sources.read(&path, Some(span));
        let Some(root) = self.errors.ok(read).and_then(|file| self.file(file, Some(span), includes + 1)) else {
            return;
        };
        match root.tag {
            "scene" => parent.children.extend(root.children),
            _ => parent.children.push(root),
        }
    }
}

/// Says where a text is not XML. The parser counts lines and characters, errors point at bytes.
fn xml_error(error: &roxmltree::Error, text: &str, file: FileId) -> SceneError {
    let at = error.pos();
    let mut lines = text.split_inclusive('\n');
    let before: usize = lines.by_ref().take(at.row.saturating_sub(1) as usize).map(str::len).sum();
    let line = lines.next().unwrap_or_default();
    let column = line.char_indices().nth(at.col.saturating_sub(1) as usize).map_or(line.len(), |(byte, _)| byte);
    let message = error.to_string();
    let message = message.strip_suffix(&format!(" at {at}")).unwrap_or(&message);
    let length = line[column..].chars().next().map_or(0, char::len_utf8);
    SceneError::at(Span::new(file, before + column, before + column + length), format!("this is not XML: {message}"))
}
