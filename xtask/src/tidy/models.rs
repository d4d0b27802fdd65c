//! Rules for the models of the library: each sampler is tested, each physical field has its unit.

use super::tree::Tree;

/// Rooms whose models are drawn from.
const SAMPLED_ROOMS: [&str; 2] = ["bsdf", "phase"];
/// Where the table of sampler tests lies.
const TESTS: &str = "crates/tyndall/tests/";
/// Rooms whose fields are lengths, coefficients, angles and radiances.
const PHYSICAL_ROOMS: [&str; 4] = ["medium", "light", "shape", "camera"];

/// Every BSDF and phase function that can be sampled is named in the tests of its crate, where the shared table of
/// sampler tests lies: the files below `crates/tyndall/tests`.
pub(crate) fn stands_in_the_sampler_table(tree: &Tree) -> Vec<String> {
    let table: String = tree.ending(".rs").filter(|(path, _)| path.starts_with(TESTS)).map(|(_, text)| text).collect();
    let mut complaints = Vec::new();
    for (path, text) in SAMPLED_ROOMS.iter().flat_map(|room| tree.room(room)) {
        let stem = path.rsplit('/').next().unwrap_or(path).trim_end_matches(".rs");
        if stem != "mod" && text.contains("pub fn sample(") && !is_built(&table, stem) {
            complaints.push(format!("{path}: `{}` has no sampler test below {TESTS}", camel_case(stem)));
        }
    }
    complaints
}

/// Every public number of a physical room carries its unit, `[1]` if it has none: `/// Radius [length]`.
pub(crate) fn has_units(tree: &Tree) -> Vec<String> {
    let mut complaints = Vec::new();
    for (path, text) in PHYSICAL_ROOMS.iter().flat_map(|room| tree.room(room)) {
        let mut unit_seen = false;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if let Some(manual) = line.strip_prefix("///") {
                unit_seen |= names_a_unit(manual);
            } else if !line.starts_with("#[") {
                if let Some(field) = number_field(line).filter(|_| !unit_seen) {
                    complaints
                        .push(format!("{path}:{}: `{field}` needs its unit in brackets, as `[length]`", number + 1));
                }
                unit_seen = false;
            }
        }
    }
    complaints
}

/// The name of the field if the line is `pub name: f32,`.
fn number_field(line: &str) -> Option<&str> {
    let (name, kind) = line.strip_prefix("pub ")?.split_once(':')?;
    let is_name = name.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
    (is_name && kind.trim().trim_end_matches(',') == "f32").then_some(name)
}

/// Whether a line of documentation holds a unit in brackets; a link to code or to a page is none.
fn names_a_unit(manual: &str) -> bool {
    manual.match_indices('[').any(|(at, _)| {
        let inside = &manual[at + 1..];
        let end = inside.find(']');
        end.is_some_and(|end| end > 0 && !inside.starts_with('`') && !inside[end + 1..].starts_with(['(', '[']))
    })
}

/// Whether a source makes the model of that file: `HenyeyGreenstein { … }` or `Phase::henyey_greenstein(…)`. A rough
/// model is made by the constructor of the smooth one, `Bsdf::conductor(…)`, with a roughness.
fn is_built(source: &str, stem: &str) -> bool {
    let constructor = stem.trim_start_matches("rough_");
    has_word(source, &camel_case(stem)) || source.contains(&format!("::{constructor}("))
}

/// Whether a text holds the word by itself, not as a part of another: `RoughDielectric` holds no `Dielectric`.
fn has_word(text: &str, word: &str) -> bool {
    let belongs = |letter: Option<char>| letter.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    text.match_indices(word)
        .any(|(at, _)| !belongs(text[..at].chars().next_back()) && !belongs(text[at + word.len()..].chars().next()))
}

/// `rough_dielectric` becomes `RoughDielectric`.
fn camel_case(stem: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    stem.split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "//! A model.\nimpl Model {\n    pub fn sample(&self, u: f32) -> f32 {}\n}\n";

    #[test]
    fn a_model_that_no_sampler_test_names_is_found() {
        let tree = Tree::of(&[
            ("crates/tyndall/src/bsdf/dielectric.rs", MODEL),
            ("crates/tyndall/src/bsdf/rough_dielectric.rs", MODEL),
            ("crates/tyndall/src/bsdf/rough_conductor.rs", MODEL),
            ("crates/tyndall/src/bsdf/fresnel.rs", "//! Not sampled.\n"),
            ("crates/tyndall/src/phase/henyey_greenstein.rs", MODEL),
            (
                "crates/tyndall/tests/samplers.rs",
                "row(Phase::henyey_greenstein(0.8)); row(Bsdf::conductor(1.5, 0.3)); row(RoughDielectric { eta: 1.5 });\n",
            ),
        ]);
        assert_eq!(
            stands_in_the_sampler_table(&tree),
            ["crates/tyndall/src/bsdf/dielectric.rs: `Dielectric` has no sampler test below crates/tyndall/tests/"]
        );
    }

    #[test]
    fn a_length_without_a_unit_is_found() {
        let sphere = "//! S.\npub struct Sphere {\n    /// Radius [length]\n    pub radius: f32,\n    /// See [`Other`]\n    \
                      pub height: f32,\n    /// Centre\n    pub centre: Vec3,\n}\n";
        let tree =
            Tree::of(&[("crates/tyndall/src/shape/sphere.rs", sphere), ("crates/tyndall/src/math/a.rs", sphere)]);
        let complaints = has_units(&tree);
        assert_eq!(complaints.len(), 1, "{complaints:?}");
        assert!(complaints[0].starts_with("crates/tyndall/src/shape/sphere.rs:6: `height`"), "{complaints:?}");
    }

    #[test]
    fn a_unit_may_stand_on_any_line_of_the_manual() {
        let text = "//! M.\n    /// Mean free path [length]\n    /// of the light\n    #[serde(default)]\n    pub path: f32,\n";
        assert!(has_units(&Tree::of(&[("crates/tyndall/src/medium.rs", text)])).is_empty());
    }
}
