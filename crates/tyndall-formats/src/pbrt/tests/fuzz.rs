//! No text makes the reader panic or run for ever.

use std::path::Path;

use proptest::prelude::*;

use super::{parse, peers};

/// Reads a text and draws its faults; both must end.
fn survive(text: &str) {
    if let Err(diagnostics) = parse(Path::new("/nowhere/fuzz.pbrt"), text) {
        assert!(!diagnostics.errors.is_empty());
        assert!(!diagnostics.to_string().is_empty());
    }
}

/// Words that get far into the reader.
const WORDS: [&str; 60] = [
    "WorldBegin",
    "AttributeBegin",
    "AttributeEnd",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Shape",
    "Material",
    "NamedMaterial",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "MediumInterface",
    "LightSource",
    "AreaLightSource",
    "Attribute",
    "Include",
    "Import",
    "Transform",
    "Translate",
    "Rotate",
    "Scale",
    "LookAt",
    "Identity",
    "Option",
    "Camera",
    "Film",
    "PixelFilter",
    "Sampler",
    "Integrator",
    "ReverseOrientation",
    "CoordSysTransform",
    "CoordinateSystem",
    "\"sphere\"",
    "\"trianglemesh\"",
    "\"bilinearmesh\"",
    "\"diffuse\"",
    "\"dielectric\"",
    "\"homogeneous\"",
    "\"spot\"",
    "\"infinite\"",
    "\"perspective\"",
    "\"rgb\"",
    "\"shape\"",
    "\"float radius\"",
    "\"point3 P\"",
    "\"integer indices\"",
    "\"spectrum eta\"",
    "\"rgb L\"",
    "\"string type\"",
    "\"blackbody I\"",
    "[",
    "]",
    "0",
    "1",
    "-1",
    "2.5",
    "1e308",
    "true",
    "\"\"",
    "#",
];

proptest! {
    #[test]
    fn random_bytes_are_survived(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        survive(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_words_are_survived(words in proptest::collection::vec(0..WORDS.len(), 0..120)) {
        let text: Vec<_> = words.into_iter().map(|i| WORDS[i]).collect();
        survive(&format!("WorldBegin {}", text.join(" ")));
        survive(&text.join("\n"));
    }

    #[test]
    fn mutated_scenes_are_survived(
        scene in prop::sample::select(vec!["a_marble_rough_spot.pbrt", "c_wholemilk_sphere.pbrt", "d_fog_cornell.pbrt"]),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..8, ".{0,3}"), 1..6),
    ) {
        let mut text = std::fs::read_to_string(peers().join(scene)).unwrap();
        for (at, cut, put) in edits {
            let start = text.floor_char_boundary(at.index(text.len() + 1));
            let end = text.ceil_char_boundary((start + cut).min(text.len()));
            text.replace_range(start..end, &put);
        }
        survive(&text);
    }
}

#[test]
fn deep_nesting_is_refused_and_not_recursed_into() {
    survive(&format!("WorldBegin {}", "AttributeBegin ".repeat(200_000)));
    survive(&"[".repeat(200_000));
    survive(&format!("WorldBegin Shape \"sphere\" {}", "\"float radius\" [".repeat(20_000)));
}

/// Work that grows with the square of the text would take hours at a few megabytes: each of these takes seconds at most.
#[test]
fn large_hostile_texts_end_soon() {
    let many = |count: usize, item: &dyn Fn(usize) -> String| (0..count).map(item).collect::<String>();
    survive(&format!("WorldBegin Shape \"sphere\" {}", many(30_000, &|i| format!("\"float p{i}\" 1 "))));
    survive(&format!(
        "WorldBegin {} Shape \"sphere\"",
        many(30_000, &|i| format!("Attribute \"shape\" \"float p{i}\" 1 "))
    ));
    survive(&format!(
        "WorldBegin {}",
        many(20_000, &|i| format!("MakeNamedMaterial \"m{i}\" \"string type\" \"interface\" NamedMaterial \"n{i}\" "))
    ));
    survive(&format!(
        "WorldBegin {} {}",
        many(20_000, &|i| format!("CoordinateSystem \"c{i}\" ")),
        many(20_000, &|i| format!("CoordSysTransform \"d{i}\" "))
    ));
}
