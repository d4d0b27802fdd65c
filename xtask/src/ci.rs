//! `cargo xtask ci`: everything that must hold for every commit, the cheapest check first.
//!
//! Tests in a module called `slow` are left to `cargo xtask full`.

use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::shell::{Stages, answers, cargo, root, target, tee};
use crate::{docs, tidy};

/// All stages, in turn; stops at the first that fails.
pub(crate) fn run() -> Result<()> {
    let mut stages = Stages::new("ci");
    stages.stage("tidy", tidy::run)?;
    stages.stage("format", || tee(&mut cargo("fmt --all --check")))?;
    stages.stage("lints", || tee(&mut cargo("clippy --workspace --all-targets --all-features -- -D warnings")))?;
    stages.stage("docs", docs::check)?;
    let tests = stages.stage("tests", || run_tests(Which::Quick))?;
    let doc_tests = stages.stage("doc-tests", || Ok(Counts::read(&tee(&mut cargo("test --doc --workspace"))?)))?;
    stages.stage("smoke test", || smoke_test(tested_program()))?;
    stages.close();
    eprintln!("   tests: {tests}\n   doc-tests: {doc_tests}");
    Ok(())
}

/// What `ci` leaves out because it takes minutes: slow tests, and the first command of the README as it is written.
pub(crate) fn run_slow() -> Result<()> {
    smoke_test(cargo("run --release --"))?;
    let counts = run_tests(Which::Slow)?;
    eprintln!("slow tests: {counts}");
    Ok(())
}

#[derive(Clone, Copy, PartialEq)]
enum Which {
    Quick,
    Slow,
}

/// With nextest if it is installed (it runs the tests of all crates side by side), else with plain cargo.
fn run_tests(which: Which) -> Result<Counts> {
    let text = if answers(&mut cargo("nextest --version")) {
        let filter = if which == Which::Slow { "test(/(^|::)slow::/)" } else { "not test(/(^|::)slow::/)" };
        tee(cargo("nextest run --workspace --no-fail-fast --no-tests=pass -E").arg(filter))?
    } else {
        eprintln!("cargo-nextest is not installed: using `cargo test` (`cargo install cargo-nextest --locked`)");
        let filter = if which == Which::Slow { "slow::" } else { "--skip slow::" };
        tee(&mut cargo(&format!("test --workspace --lib --bins --tests --no-fail-fast -- {filter}")))?
    };
    Ok(Counts::read(&text))
}

/// The first command of the README, at the cheapest setting.
fn smoke_test(mut tyndall: Command) -> Result<()> {
    let image = root().join("target/ci/milk.exr");
    std::fs::create_dir_all(image.parent().context("a file in a directory")?)?;
    if image.exists() {
        std::fs::remove_file(&image)?;
    }
    tee(tyndall.args(["render", "scenes/milk/scene.pbrt", "--spp", "1", "-o"]).arg(&image).current_dir(root()))?;
    ensure!(std::fs::metadata(&image).is_ok_and(|file| file.len() > 0), "no image at {}", image.display());
    Ok(())
}

/// The program that the tests were run with: cargo has put it there for them.
fn tested_program() -> Command {
    Command::new(target().join("debug/tyndall"))
}

/// How many tests ran, summed over all closing lines of a test runner.
#[derive(Debug, PartialEq, Default)]
struct Counts {
    passed: usize,
    skipped: usize,
}

impl Counts {
    /// Reads the closing lines of `cargo nextest run` and of `cargo test`.
    fn read(text: &str) -> Self {
        let text = strip_colours(text);
        let closing = text.lines().filter(|line| line.contains("Summary [") || line.contains("test result:"));
        let mut sum = Self::default();
        for line in closing {
            sum.passed += number_before(line, "passed");
            sum.skipped += number_before(line, "skipped") + number_before(line, "filtered out");
        }
        sum
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} passed, {} left out", self.passed, self.skipped)
    }
}

/// The number in front of a word: `12 tests run: 11 passed` holds 11 before `passed`.
fn number_before(line: &str, word: &str) -> usize {
    let Some(end) = line.find(word) else { return 0 };
    line[..end].split_whitespace().next_back().and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// Text without terminal escape sequences.
fn strip_colours(text: &str) -> String {
    let mut plain = String::new();
    let mut in_escape = false;
    for character in text.chars() {
        match character {
            '\u{1b}' => in_escape = true,
            'm' if in_escape => in_escape = false,
            _ if in_escape => {}
            _ => plain.push(character),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closing_line_of_nextest_is_counted() {
        let text = "     Summary [   3.1s] 12 tests run: 12 passed (1 slow), 3 skipped\n";
        assert_eq!(Counts::read(text), Counts { passed: 12, skipped: 3 });
    }

    #[test]
    fn a_coloured_closing_line_is_counted() {
        let text = "\u{1b}[32;1m     Summary\u{1b}[0m [   0.1s] 5 tests run: \u{1b}[1m5\u{1b}[0m passed, 0 skipped\n";
        assert_eq!(Counts::read(text), Counts { passed: 5, skipped: 0 });
    }

    #[test]
    fn closing_lines_of_several_crates_add_up() {
        let text = "test result: ok. 4 passed; 0 failed; 0 ignored; 0 measured; 1 filtered out; finished in 0.00s\n\
                    test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s\n";
        assert_eq!(Counts::read(text), Counts { passed: 6, skipped: 1 });
    }
}
