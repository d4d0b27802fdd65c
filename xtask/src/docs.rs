//! The documentation must build without a warning, with one exception: units stand in brackets, `[length]`, and rustdoc
//! takes a word in brackets for a link. So broken links are collected, and those to units are let pass.
//!
//! `Cargo.toml` switches the lint off, for a quiet `cargo doc`; here it is forced on again.

use anyhow::{Result, bail, ensure};

use crate::shell::cargo;

/// Units that are one word; rustdoc leaves `[1/length]` or `[W·m⁻²]` alone.
const UNITS: [&str; 27] = [
    "1", "GiB", "K", "MPa", "bits", "bytes", "cm", "dB", "degrees", "length", "length²", "length³", "lm", "m", "m²",
    "mm", "ms", "nm", "ns", "pixels", "rad", "s", "sr", "stops", "°", "µm", "µm²",
];

/// Builds the documentation of the workspace and reads rustdoc's complaints.
pub(crate) fn check() -> Result<()> {
    let mut command = cargo("doc --workspace --no-deps --document-private-items --color never");
    command
        .env("RUSTDOCFLAGS", "-D warnings --force-warn rustdoc::broken_intra_doc_links")
        .env_remove("CARGO_TERM_COLOR");
    let output = command.output()?;
    let text = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "`cargo doc` failed\n{text}");
    let broken = broken_links(&text);
    if !broken.is_empty() {
        bail!(
            "links in the documentation lead nowhere (or are units that xtask/src/docs.rs lacks):\n{}",
            broken.join("\n")
        );
    }
    Ok(())
}

/// Unresolved links that are no units, each with its place.
fn broken_links(text: &str) -> Vec<String> {
    let mut broken = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let target = line.strip_prefix("warning: unresolved link to `").and_then(|rest| rest.split('`').next());
        if let Some(target) = target.filter(|target| !UNITS.contains(target)) {
            let place = lines.next().unwrap_or_default().trim().trim_start_matches("--> ");
            broken.push(format!("{place}: [{target}]"));
        }
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_link_is_found_and_a_unit_is_none() {
        let text = "warning: unresolved link to `length`\n  --> a.rs:8:23\n   |\n\
                    warning: unresolved link to `Sphere`\n  --> b.rs:1:2\n   |\nwarning: `a` generated 2 warnings\n";
        assert_eq!(broken_links(text), ["b.rs:1:2: [Sphere]"]);
    }
}
