//! Things that are referred to by name, before or after they are defined.

use std::collections::HashMap;

use super::params::quote;
use crate::error::{ErrorList, SceneError};
use crate::source::Span;

/// Definitions by index. A name that is referred to has its index at once and its definition later.
#[derive(Debug)]
pub(super) struct Registry<T> {
    /// What they are, as messages say it: "material".
    what: &'static str,
    slots: Vec<Slot<T>>,
    by_name: HashMap<String, u32>,
}

#[derive(Debug)]
struct Slot<T> {
    name: String,
    /// Where it was first referred to.
    used: Option<Span>,
    /// Where and what it is.
    definition: Option<(Span, T)>,
}

impl<T> Registry<T> {
    pub(super) fn new(what: &'static str) -> Self {
        Self { what, slots: Vec::new(), by_name: HashMap::new() }
    }

    /// Adds something without a name.
    pub(super) fn push(&mut self, span: Span, value: T) -> u32 {
        self.slots.push(Slot { name: String::new(), used: None, definition: Some((span, value)) });
        self.slots.len() as u32 - 1
    }

    /// The index of a name, defined or not yet.
    pub(super) fn refer(&mut self, name: &str, span: Span) -> u32 {
        let index = self.index(name);
        self.slots[index as usize].used.get_or_insert(span);
        index
    }

    /// Defines a name.
    ///
    /// # Errors
    /// It has been defined before.
    pub(super) fn define(&mut self, name: &str, span: Span, value: T) -> Result<u32, SceneError> {
        let index = self.index(name);
        let slot = &mut self.slots[index as usize];
        if let Some((first, _)) = slot.definition {
            let message = format!("the {} {} is defined twice", self.what, quote(name));
            return Err(SceneError::at(span, message).help("give each its own name").related(first, "first here"));
        }
        slot.definition = Some((span, value));
        Ok(index)
    }

    /// The definition of an index, if it has been seen.
    pub(super) fn get_mut(&mut self, index: u32) -> Option<&mut T> {
        self.slots.get_mut(index as usize)?.definition.as_mut().map(|(_, value)| value)
    }

    fn index(&mut self, name: &str) -> u32 {
        if let Some(&index) = self.by_name.get(name) {
            return index;
        }
        let index = self.slots.len() as u32;
        self.slots.push(Slot { name: name.into(), used: None, definition: None });
        self.by_name.insert(name.into(), index);
        index
    }

    /// All definitions. Names that were referred to and never defined are errors; then the list is of no use.
    pub(super) fn finish(self, errors: &mut ErrorList) -> Vec<T> {
        let defined: Vec<_> = self.slots.iter().filter(|s| s.definition.is_some() && !s.name.is_empty()).collect();
        for slot in &self.slots {
            if errors.is_full() {
                break;
            }
            if let (None, Some(used)) = (&slot.definition, slot.used) {
                let message = format!("the {} {} is not defined", self.what, quote(&slot.name));
                errors.push(SceneError::at(used, message).suggest(&slot.name, defined.iter().map(|s| &*s.name)));
            }
        }
        self.slots.into_iter().filter_map(|slot| slot.definition).map(|(_, value)| value).collect()
    }
}
