//! An element of XML.

use crate::write::number::double;
use crate::write::sheet::Sheet;

/// An element in the making.
pub(super) struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Child>,
}

enum Child {
    Element(Element),
    Gap,
}

impl Element {
    pub(super) fn new(tag: &'static str) -> Self {
        Self { tag, attributes: Vec::new(), children: Vec::new() }
    }

    /// A plugin.
    pub(super) fn plugin(tag: &'static str, kind: &str) -> Self {
        Self::new(tag).with("type", kind)
    }

    /// A parameter `<tag name="…" value="…"/>`.
    pub(super) fn parameter(tag: &'static str, name: &str, value: &str) -> Self {
        Self::new(tag).with("name", name).with("value", value)
    }

    pub(super) fn with(mut self, name: &'static str, value: &str) -> Self {
        self.attributes.push((name, value.to_owned()));
        self
    }

    /// An attribute whose value is made here.
    pub(super) fn text(self, name: &'static str, value: &str) -> Self {
        self.with(name, value)
    }

    pub(super) fn number(self, name: &'static str, value: f64) -> Self {
        self.with(name, &double(value))
    }

    pub(super) fn numbers(self, name: &'static str, values: &[f64]) -> Self {
        self.with(name, &values.iter().map(|v| double(*v)).collect::<Vec<_>>().join(", "))
    }

    pub(super) fn push(&mut self, child: Self) {
        self.children.push(Child::Element(child));
    }

    pub(super) fn extend(&mut self, children: impl IntoIterator<Item = Self>) {
        children.into_iter().for_each(|child| self.push(child));
    }

    /// With a child.
    pub(super) fn around(mut self, child: Self) -> Self {
        self.push(child);
        self
    }

    /// An empty line between its children.
    pub(super) fn gap(&mut self) {
        if !matches!(self.children.last(), Some(Child::Gap) | None) {
            self.children.push(Child::Gap);
        }
    }

    pub(super) fn float(&mut self, name: &str, value: f64) {
        self.push(Self::parameter("float", name, &double(value)));
    }

    /// A number, unless it is what Mitsuba takes anyway.
    pub(super) fn float_unless(&mut self, name: &str, value: f64, default: f64) {
        if value != default {
            self.float(name, value);
        }
    }

    pub(super) fn integer(&mut self, name: &str, value: i64) {
        self.push(Self::parameter("integer", name, &value.to_string()));
    }

    pub(super) fn string(&mut self, name: &str, value: &str) {
        self.push(Self::parameter("string", name, value));
    }

    pub(super) fn boolean(&mut self, name: &str, value: bool) {
        self.push(Self::parameter("boolean", name, if value { "true" } else { "false" }));
    }

    pub(super) fn into_text(mut self) -> String {
        if let Some(Child::Gap) = self.children.last() {
            self.children.pop();
        }
        let mut sheet = Sheet::default();
        self.write(&mut sheet);
        sheet.into_text()
    }

    fn write(self, sheet: &mut Sheet) {
        let attributes: Vec<_> =
            self.attributes.iter().map(|(name, value)| format!(" {name}=\"{}\"", escaped(value))).collect();
        let head = format!("<{}{}", self.tag, attributes.concat());
        if self.children.is_empty() {
            return sheet.line(&format!("{head}/>"));
        }
        sheet.line(&format!("{head}>"));
        sheet.indent();
        for child in self.children {
            match child {
                Child::Element(element) => element.write(sheet),
                Child::Gap => sheet.gap(),
            }
        }
        sheet.outdent();
        sheet.line(&format!("</{}>", self.tag));
    }
}

/// As the value of an attribute: `$` would be a parameter of the scene.
fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;").replace('$', "\\$")
}
