//! Names: those that the user gave, and made ones for what has none but must be referred to.

use std::collections::HashSet;

/// Names that are taken.
#[derive(Default)]
pub(super) struct Names(HashSet<String>);

impl Names {
    /// The name that was given, or one made of `what`; with a number behind it if it is taken.
    pub(super) fn unique(&mut self, given: Option<&str>, what: &str) -> String {
        let given = given.filter(|name| !name.is_empty()).map(printable);
        let wanted = given.unwrap_or_else(|| what.to_owned());
        let numbered = (2..).map(|n| format!("{wanted}-{n}"));
        let free = std::iter::once(wanted.clone()).chain(numbered).find(|name| !self.0.contains(name));
        let name = free.unwrap_or(wanted);
        self.0.insert(name.clone());
        name
    }
}

/// Without line breaks and the like, which no language keeps in a name.
pub(super) fn printable(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

/// As part of the name of a file.
pub(super) fn for_a_file(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' };
    name.chars().take(64).map(safe).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_kept_until_they_are_taken() {
        let mut names = Names::default();
        assert_eq!(names.unique(Some("milk"), "medium"), "milk");
        assert_eq!(names.unique(Some("milk"), "medium"), "milk-2");
        assert_eq!(names.unique(None, "medium"), "medium");
        assert_eq!(names.unique(Some(""), "medium"), "medium-2");
        assert_eq!(for_a_file("../a b/ü"), "___a_b__");
    }
}
