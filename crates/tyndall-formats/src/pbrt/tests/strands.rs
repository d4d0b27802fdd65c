//! Curves and hair.

use tyndall::shape::{Basis, Style};
use tyndall::spectrum::ColorMode;

use crate::desc::{HairColourDesc, MaterialKind, SceneDesc, ShapeKind, Varying};

fn read(world: &str) -> Result<SceneDesc, String> {
    let text = format!("WorldBegin {world}");
    crate::pbrt::parse(std::path::Path::new("scene.pbrt"), &text).map(|(desc, _)| desc).map_err(|e| e.to_string())
}

fn built(world: &str) -> Result<tyndall::scene::Scene, String> {
    let text = format!("WorldBegin {world}");
    let (desc, sources) = crate::pbrt::parse(std::path::Path::new("scene.pbrt"), &text).map_err(|e| e.to_string())?;
    crate::build::build(&desc, sources, ColorMode::Rgb).map(|(scene, _)| scene).map_err(|e| e.to_string())
}

const POINTS: &str = r#""point3 P" [0 0 0  0 0 1  0 1 2  0 1 3]"#;

#[test]
fn a_curve_is_what_its_words_say() {
    let desc = read(&format!(
        r#"Shape "curve" {POINTS}
           Shape "curve" {POINTS} "string type" "cylinder" "string basis" "bspline" "float width0" 0.2 "float width1" 0
           Shape "curve" {POINTS} "string type" "ribbon" "string basis" "linear"
               "normal N" [1 0 0 1 0 0 1 0 0 1 0 0] "integer splitdepth" 3"#
    ))
    .unwrap();
    let found: Vec<_> = desc.shapes.iter().map(|shape| &shape.kind).collect();
    let [ShapeKind::Curve(a), ShapeKind::Curve(b), ShapeKind::Curve(c)] = found[..] else { panic!("{found:?}") };
    assert_eq!((a.basis, a.style, a.widths), (Basis::CubicBezier, Style::Flat, [1.0, 1.0]));
    assert_eq!((b.basis, b.style, b.widths), (Basis::CubicBSpline, Style::Round, [0.2, 0.0]));
    assert_eq!((c.basis, c.style, c.normals.len()), (Basis::Linear, Style::Ribbon, 4));
    assert!(desc.ignored.iter().any(|ignored| ignored.reason.contains("split")));
}

#[test]
fn hair_is_brown_unless_it_says_otherwise() {
    let hair = |words: &str| {
        let desc = read(&format!(r#"Material "hair" {words} Shape "curve" {POINTS}"#)).unwrap();
        let MaterialKind::Hair(hair) = &desc.materials[0].kind else { panic!() };
        hair.as_ref().clone()
    };
    let HairColourDesc::Pigments { eumelanin, pheomelanin } = hair("").colour else { panic!() };
    assert_eq!([eumelanin, pheomelanin].map(|p| p.value), [1.3, 0.0].map(Varying::constant));
    let HairColourDesc::Pigments { eumelanin, pheomelanin } = hair(r#""float pheomelanin" 2"#).colour else { panic!() };
    assert_eq!([eumelanin, pheomelanin].map(|p| p.value), [0.0, 2.0].map(Varying::constant));
    assert!(matches!(hair(r#""rgb color" [0.5 0.3 0.1]"#).colour, HairColourDesc::Reflectance(_)));
    assert!(matches!(hair(r#""rgb sigma_a" [5 3 1]"#).colour, HairColourDesc::SigmaA(_)));
    assert_eq!(hair(r#""float beta_m" 0.1"#).beta_m.value.number(), Some(0.1));
}

#[test]
fn what_cannot_be_a_strand_is_told_with_its_place() {
    let curve = |words: &str| format!("Shape \"curve\" {words}");
    for (world, expected) in [
        (curve(r#""point3 P" [0 0 0 1 0 0 2 0 0]"#), "3 points make no whole number of segments"),
        (curve(&format!("{POINTS} \"float width\" 0")), "width 0 is not there"),
        (curve(&format!("{POINTS} \"float width\" -1")), "must be at least 0"),
        (curve(&format!("{POINTS} \"string type\" \"tube\"")), "there is no type \"tube\""),
        (curve(&format!("{POINTS} \"string basis\" \"bspine\"")), "bspline"),
        (curve(&format!("{POINTS} \"integer degree\" 5")), "cannot have degree 5"),
        (curve(&format!("{POINTS} \"string type\" \"ribbon\"")), "needs 2 normals"),
        (format!("Scale 1 2 1 {}", curve(POINTS)), "stretched unevenly"),
        (format!("AreaLightSource \"diffuse\" {}", curve(POINTS)), "strands cannot shine yet"),
        (format!("Material \"hair\" \"float eta\" 1 {}", curve(POINTS)), "must be above 1"),
        (
            "Material \"hair\" \"float eumelanin\" 1 \"rgb color\" [1 1 1] Shape \"sphere\"".into(),
            "leave out one of them",
        ),
        ("Shape \"hair\" \"string filename\" \"nothing.hair\"".into(), "nothing.hair"),
    ] {
        let error = built(&world).err().unwrap_or_default();
        assert!(error.contains(expected) && error.contains("scene.pbrt:1:"), "{world}: {error}");
    }
}
