//! Rules for every Rust source: a manual on top, a readable length, nothing left unfinished.

use super::tree::Tree;

/// Files of more lines are listed.
pub(crate) const LONG: usize = 400;
/// Files of more lines are refused, unless they stand in [`LONG_FOR_A_REASON`].
const TOO_LONG: usize = 600;
/// Sources that are better long, each with its reason.
const LONG_FOR_A_REASON: [(&str, &str); 0] = [];

/// Words that say that something is not finished, spelt so that this file does not hold them.
const UNFINISHED: [&str; 5] = [
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
    concat!("to", "do!"),
    concat!("unimplem", "ented!"),
    concat!("#[ign", "ore"),
];

/// Every file starts with what it is.
pub(crate) fn starts_with_a_manual(tree: &Tree) -> Vec<String> {
    let bare = tree.ending(".rs").filter(|(_, text)| !text.starts_with("//!"));
    bare.map(|(path, _)| format!("{path}:1: begin with `//!` and say what the file is for")).collect()
}

/// The files over [`LONG`] lines with their lengths.
pub(crate) fn long_files(tree: &Tree) -> Vec<(&str, usize)> {
    tree.ending(".rs").map(|(path, text)| (path, text.lines().count())).filter(|&(_, lines)| lines > LONG).collect()
}

/// No file is too long to be read at one sitting.
pub(crate) fn is_not_too_long(tree: &Tree) -> Vec<String> {
    let excused = |path: &str| LONG_FOR_A_REASON.iter().any(|&(long, _)| long == path);
    let too_long = long_files(tree).into_iter().filter(|&(path, lines)| lines > TOO_LONG && !excused(path));
    too_long.map(|(path, lines)| format!("{path}: {lines} lines, over {TOO_LONG}: split it")).collect()
}

/// Nothing is promised for later in a comment, and no test is switched off.
pub(crate) fn is_finished(tree: &Tree) -> Vec<String> {
    let mut complaints = Vec::new();
    for (path, text) in tree.ending(".rs") {
        for (number, line) in text.lines().enumerate() {
            for word in UNFINISHED.iter().filter(|word| line.contains(**word)) {
                complaints.push(format!("{path}:{}: `{word}`: finish it or open an issue", number + 1));
            }
        }
    }
    complaints
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_starts_with_code_is_refused() {
        let tree = Tree::of(&[("a.rs", "//! Good.\n"), ("b.rs", "fn bad() {}\n"), ("c.txt", "no source")]);
        assert_eq!(starts_with_a_manual(&tree), ["b.rs:1: begin with `//!` and say what the file is for"]);
    }

    #[test]
    fn files_are_listed_over_400_lines_and_refused_over_600() {
        let tree =
            Tree::of(&[("a.rs", &"x\n".repeat(400)), ("b.rs", &"x\n".repeat(401)), ("c.rs", &"x\n".repeat(601))]);
        assert_eq!(long_files(&tree), [("b.rs", 401), ("c.rs", 601)]);
        assert_eq!(is_not_too_long(&tree), ["c.rs: 601 lines, over 600: split it"]);
    }

    #[test]
    fn every_unfinished_word_is_found_with_its_line() {
        for word in UNFINISHED {
            let tree = Tree::of(&[("a.rs", &format!("//! A.\n{word}\n"))]);
            assert_eq!(is_finished(&tree), [format!("a.rs:2: `{word}`: finish it or open an issue")]);
        }
    }
}
