//! `cargo xtask tidy`: the rules of STYLE.md that a program can check.
//!
//! Every rule is a function from the files of the repository to complaints, so that each is tested on a few made-up
//! lines. The repository itself is held to them by a test, too: `cargo test` finds what `tidy` finds.

mod markdown;
mod models;
mod source;
mod tree;

use anyhow::{Result, bail};

use tree::Tree;

/// Checks the repository: prints what is wrong and fails if anything is.
pub(crate) fn run() -> Result<()> {
    let tree = Tree::of_repository()?;
    for (path, lines) in source::long_files(&tree) {
        eprintln!("note: {path} has {lines} lines (over {}); would two rooms be clearer?", source::LONG);
    }
    let complaints = check(&tree);
    for complaint in &complaints {
        eprintln!("error: {complaint}");
    }
    match complaints.len() {
        0 => {
            eprintln!("tidy: {} files", tree.files.len());
            Ok(())
        }
        count => bail!("tidy: {count} complaints"),
    }
}

/// All complaints of all rules, each `path:line: what and what to do`.
fn check(tree: &Tree) -> Vec<String> {
    let rules: [fn(&Tree) -> Vec<String>; 7] = [
        source::starts_with_a_manual,
        source::is_not_too_long,
        source::is_finished,
        models::stands_in_the_sampler_table,
        models::has_units,
        markdown::links_resolve,
        markdown::scenes_are_explained,
    ];
    rules.iter().flat_map(|rule| rule(tree)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_repository_is_tidy() {
        let complaints = check(&Tree::of_repository().unwrap());
        assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    }
}
