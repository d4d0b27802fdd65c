//! `$parameters`: `<default name="spp" value="16"/>` declares one, `-D spp=64` overrides it, `$spp` in any attribute stands
//! for it.
//!
//! As in Mitsuba, a name ends where no longer known name goes on (`$resolution` is `$res` and `olution` if only `res` is
//! known), `\$` is a plain dollar, and a parameter is known from its `<default>` on.

use crate::error::{ErrorList, SceneError};
use crate::source::Span;

/// The longest value that substitution may make, so that defaults that use each other cannot fill the memory.
const LONGEST_VALUE: usize = 1 << 20;

struct Parameter {
    name: String,
    value: String,
    /// Whether the scene declares or uses it; an override that the scene never mentions is a mistake.
    mentioned: bool,
}

/// What is known, longest names first.
pub(super) struct Parameters(Vec<Parameter>);

impl Parameters {
    pub(super) fn new(overrides: &[(String, String)]) -> Self {
        let mut parameters = Self(Vec::new());
        // Of several overrides the last one counts.
        for (name, value) in overrides.iter().rev() {
            parameters.declare(name, value, false);
        }
        parameters
    }

    /// `<default>`: an override, or an earlier default, wins.
    pub(super) fn default(&mut self, name: &str, value: &str) {
        self.declare(name, value, true);
    }

    fn declare(&mut self, name: &str, value: &str, mentioned: bool) {
        if let Some(known) = self.0.iter_mut().find(|p| p.name == name) {
            known.mentioned |= mentioned;
            return;
        }
        let at = self.0.partition_point(|p| p.name.len() >= name.len());
        self.0.insert(at, Parameter { name: name.into(), value: value.into(), mentioned });
    }

    /// `raw` with its parameters replaced by their values.
    pub(super) fn substitute(&mut self, raw: &str, span: Span, errors: &mut ErrorList) -> String {
        let mut out = String::new();
        let mut rest = raw;
        while let Some(at) = rest.find('$') {
            let (before, name) = (&rest[..at], &rest[at + 1..]);
            rest = name;
            if let Some(before) = before.strip_suffix('\\') {
                out.push_str(before);
                out.push('$');
                continue;
            }
            out.push_str(before);
            if let Some(known) = self.0.iter_mut().find(|p| name.starts_with(&p.name)) {
                known.mentioned = true;
                out.push_str(&known.value);
                rest = &name[known.name.len()..];
            } else {
                let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
                let (word, names) = (&name[..end], self.0.iter().map(|p| p.name.as_str()));
                errors.push(
                    SceneError::at(span, format!("the parameter \"${word}\" is not defined")).suggest(word, names),
                );
                rest = &name[end..];
            }
            if out.len() > LONGEST_VALUE {
                errors.push(SceneError::at(span, "the parameters make a value of more than 1 MiB"));
                return String::new();
            }
        }
        out + rest
    }

    /// Overrides that the scene never mentions.
    pub(super) fn check_overrides(&self, errors: &mut ErrorList) {
        let known = self.0.iter().filter(|p| p.mentioned).map(|p| p.name.as_str());
        for Parameter { name, value, .. } in self.0.iter().filter(|p| !p.mentioned) {
            let error = SceneError::new(format!("-D {name}={value}: the scene has no parameter \"{name}\""));
            errors.push(error.suggest(name, known.clone()));
        }
    }
}
