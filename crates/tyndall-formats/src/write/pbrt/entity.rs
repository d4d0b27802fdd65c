//! A directive with its parameters.

use crate::write::number::{double, doubles, single};
use crate::write::sheet::Sheet;

/// Directives that are shorter stand on one line, in characters.
const LINE: usize = 100;
/// Numbers of long lists on a line.
const NUMBERS: usize = 12;

/// A string in quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A directive in the making.
pub(super) struct Entity {
    head: String,
    params: Vec<String>,
}

impl Entity {
    pub(super) fn new(directive: &str, names: &[&str]) -> Self {
        let names: Vec<_> =
            std::iter::once(directive.to_owned()).chain(names.iter().map(|name| quoted(name))).collect();
        Self { head: names.join(" "), params: Vec::new() }
    }

    /// A parameter with its value as it is written.
    pub(super) fn param(&mut self, kind: &str, name: &str, value: &str) {
        self.params.push(format!("\"{kind} {name}\" {value}"));
    }

    pub(super) fn float(&mut self, name: &str, value: f64) {
        self.param("float", name, &double(value));
    }

    /// A number, unless it is what pbrt takes anyway.
    pub(super) fn float_unless(&mut self, name: &str, value: f64, default: f64) {
        if value != default {
            self.float(name, value);
        }
    }

    /// A number, if there is one.
    pub(super) fn float_if(&mut self, name: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.float(name, value);
        }
    }

    pub(super) fn integer(&mut self, name: &str, value: i64) {
        self.param("integer", name, &value.to_string());
    }

    pub(super) fn boolean(&mut self, name: &str, value: bool) {
        self.param("bool", name, if value { "true" } else { "false" });
    }

    pub(super) fn string(&mut self, name: &str, value: &str) {
        self.param("string", name, &quoted(value));
    }

    pub(super) fn list(&mut self, kind: &str, name: &str, values: &[f64]) {
        let value = if values.len() > 2 * NUMBERS {
            lines(values.iter().map(|v| double(*v)))
        } else {
            format!("[ {} ]", doubles(values))
        };
        self.param(kind, name, &value);
    }

    /// Numbers in single precision, if there are any.
    pub(super) fn singles(&mut self, kind: &str, name: &str, values: &[f32]) {
        if !values.is_empty() {
            self.param(kind, name, &lines(values.iter().map(|v| single(*v))));
        }
    }

    pub(super) fn indices(&mut self, name: &str, values: &[u32]) {
        self.param("integer", name, &lines(values.iter().map(u32::to_string)));
    }

    /// On one line, or a parameter a line.
    pub(super) fn write(self, sheet: &mut Sheet) {
        let all = std::iter::once(self.head.clone()).chain(self.params.iter().cloned()).collect::<Vec<_>>().join(" ");
        if all.len() <= LINE {
            return sheet.line(&all);
        }
        sheet.line(&self.head);
        sheet.indent();
        for param in &self.params {
            param.split('\n').for_each(|line| sheet.line(line));
        }
        sheet.outdent();
    }
}

/// A list in brackets, on several lines if it is long.
fn lines(values: impl Iterator<Item = String>) -> String {
    let values: Vec<_> = values.collect();
    let rows: Vec<_> = values.chunks(NUMBERS).map(|row| row.join(" ")).collect();
    if rows.len() == 1 { format!("[ {} ]", rows[0]) } else { format!("[\n  {}\n]", rows.join("\n  ")) }
}
