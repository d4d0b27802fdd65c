//! Every fault says where, what, and what to do.

use std::path::Path;

use super::parse;

/// The faults of a scene as `line:column message [help]`.
fn faults(text: &str) -> Vec<String> {
    let diagnostics = parse(Path::new("scene.pbrt"), text).expect_err("the scene has faults");
    let place = |e: &crate::error::SceneError| {
        let at = diagnostics.sources.line_column(e.span.expect("a place"));
        format!("{}:{}", at.line, at.column)
    };
    let help = |e: &crate::error::SceneError| e.help.as_ref().map(|h| format!(" [{h}]")).unwrap_or_default();
    diagnostics.errors.iter().map(|e| format!("{} {}{}", place(e), e.message, help(e))).collect()
}

/// Each scene is what comes after `WorldBegin` on the first line, and has one fault.
fn check(table: &[(&str, &str)]) {
    for (text, expected) in table {
        assert_eq!(faults(&format!("WorldBegin {text}")), [*expected], "{text}");
    }
}

#[test]
fn misspelt_words_get_the_nearest_right_one() {
    check(&[
        ("Shap \"sphere\"", "1:12 there is no directive \"Shap\" [did you mean \"Shape\"?]"),
        ("Shape \"spere\"", "1:18 there is no shape \"spere\" [did you mean \"sphere\"?]"),
        (
            "Shape \"sphere\" \"float radios\" 1",
            "1:27 shape \"sphere\" has no parameter \"radios\" [did you mean \"radius\"?]",
        ),
        ("Shape \"sphere\" \"flaot radius\" 1", "1:27 there is no parameter type \"flaot\" [did you mean \"float\"?]"),
        ("Material \"difuse\"", "1:21 there is no material \"difuse\" [did you mean \"diffuse\"?]"),
        (
            "LightSource \"sun\"",
            "1:24 there is no light \"sun\" [supported are \"point\", \"spot\", \"distant\", \"infinite\", \"goniometric\", \"projection\"]",
        ),
        (
            "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" NamedMaterial \"Glas\"",
            "1:79 the material \"Glas\" is not defined [did you mean \"glass\"?]",
        ),
        ("CoordSysTransform \"wrld\"", "1:30 there is no coordinate system \"wrld\" [did you mean \"world\"?]"),
        (
            "WorldEnd",
            "1:12 there is no directive \"WorldEnd\" [pbrt-v4 has none: the world ends with the file; leave it out]",
        ),
    ]);
}

#[test]
fn what_pbrt_knows_and_this_reader_does_not_yet_is_said_to_be_so() {
    check(&[
        (
            "MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\" \"string filename\" \"smoke.nvdb\"",
            "1:50 the medium \"nanovdb\" is not supported yet [supported are \"homogeneous\", \"fog\", \"ink\", \"milk\", \"sea\", \"smoke\"]",
        ),
        ("Material \"diffuse\" \"texture reflectance\" \"wood\"", "1:53 no spectrum texture is called \"wood\""),
    ]);
}

#[test]
fn wrong_types_and_values_are_named() {
    check(&[
        (
            "Shape \"sphere\" \"integer radius\" 1",
            "1:27 \"radius\" of shape \"sphere\" cannot be of type integer [write \"float radius\"]",
        ),
        (
            "Material \"diffuse\" \"float reflectance\" .5",
            "1:31 \"reflectance\" of material \"diffuse\" cannot be of type float [write \"rgb reflectance\" or \"spectrum reflectance\" or \"blackbody reflectance\"]",
        ),
        ("Shape \"sphere\" \"float radius\" \"one\"", "1:27 \"float radius\" takes numbers"),
        ("Shape \"sphere\" \"float radius\" [ 1 2 ]", "1:27 \"radius\" of shape \"sphere\" takes one value and has 2"),
        ("Shape \"sphere\" \"float radius\" -1", "1:27 \"radius\" of shape \"sphere\" must be positive, not -1"),
        (
            "Material \"diffuse\" \"rgb reflectance\" [ 1 2 ]",
            "1:31 \"rgb reflectance\" has 2 numbers, but takes 3 each",
        ),
        ("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2", "1:44 the parameter \"radius\" is given twice"),
        (
            "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
            "1:66 \"indices\" of shape \"trianglemesh\" names corner 3, but it has 3 corners, counted from 0",
        ),
        (
            "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 ]",
            "1:66 \"indices\" of shape \"trianglemesh\" has 2 numbers, but a face takes 3",
        ),
        (
            "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ]",
            "1:18 a mesh needs \"point3 P\" with at least 3 points, and this one has 0",
        ),
        (
            "Material \"dielectric\" \"spectrum eta\" [ 500 ]",
            "1:34 \"eta\" of material \"dielectric\" takes pairs of wavelength and value",
        ),
        (
            "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float g\" 1",
            "1:60 \"g\" of medium \"m\" must be between -1 and 1, both excluded, not 1",
        ),
    ]);
}

#[test]
fn broken_structure_is_shown_where_it_breaks() {
    check(&[
        ("AttributeBegin", "1:12 this block is never ended [add its End directive]"),
        (
            "AttributeEnd",
            "1:12 AttributeEnd without AttributeBegin [leave it out, or add AttributeBegin where the block starts]",
        ),
        ("Translate 1 2 Shape \"sphere\"", "1:26 \"Translate\" needs 3 numbers and has 2"),
        (
            "Scale 1 0 1",
            "1:12 this makes a transformation that cannot be undone [do not scale by 0; the rows of a matrix must be independent]",
        ),
        (
            "LookAt 0 0 0 0 1 0 0 1 0",
            "1:12 this LookAt has no direction [eye and target must differ, and up must not point along the view]",
        ),
        ("Shape sphere", "1:18 \"Shape\" needs a name in quotes here"),
        (
            "\"float radius\" 2",
            "1:12 a string where a directive is expected [statements start with a directive such as Shape or Material]",
        ),
        (
            "Shape \"sphere\" \"float radius\" [ 1",
            "1:27 the values of \"float radius\" have no closing ] [add ] after the last value]",
        ),
        (
            "Shape \"sphere\" \"radius\" 1",
            "1:27 \"radius\" declares no parameter [write its type and its name: \"float radius\"]",
        ),
        ("Film \"rgb\"", "1:12 Film belongs before WorldBegin [move it up]"),
        ("ObjectInstance \"tree\"", "1:27 the object \"tree\" is not defined"),
        (
            "Include \"/no/such/file.pbrt\"",
            "1:12 cannot read /no/such/file.pbrt: No such file or directory (os error 2)",
        ),
    ]);
}

#[test]
fn a_scene_without_a_world_says_so() {
    assert_eq!(
        faults("Film \"rgb\""),
        ["1:1 the scene has no WorldBegin [write WorldBegin between the camera and the first shape]"]
    );
}

#[test]
fn all_faults_of_a_file_are_found_at_once() {
    let text = "Integrator \"function\"\nOption \"string unit\" \"furlong\"\nWorldBegin\nMaterial \"mix\"\nShape \"sphere\" \"float r\" 1 \"bool alpha\" true\nMediumInterface \"fog\" \"\"\n";
    let places: Vec<_> = faults(text).iter().map(|f| f.split(' ').next().unwrap_or("").to_string()).collect();
    assert_eq!(places, ["1:12", "2:1", "4:10", "5:16", "5:28", "6:17"]);
}

#[test]
fn a_fault_in_an_included_file_shows_both_files() {
    let dir = std::env::temp_dir().join(format!("tyndall-include-fault-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    std::fs::write(dir.join("part.pbrt"), "\nShape \"cone\"\n").unwrap();
    let shown = parse(&dir.join("scene.pbrt"), "WorldBegin\nInclude \"part.pbrt\"").unwrap_err().to_string();
    std::fs::remove_dir_all(&dir).unwrap();
    assert!(shown.contains("part.pbrt:2:7") && shown.contains("^^^^^^"), "{shown}");
    assert!(shown.contains("scene.pbrt:2:1") && shown.contains("included here"), "{shown}");
}

/// The message as a user sees it.
#[test]
fn the_rendered_error_points_at_the_words() {
    let text = "WorldBegin\nShape \"sphere\"\n    \"float raduis\" 2\n";
    let diagnostics = parse(Path::new("ball.pbrt"), text).unwrap_err();
    let expected = r#"
error: shape "sphere" has no parameter "raduis"
 --> ball.pbrt:3:5
  |
3 |     "float raduis" 2
  |     ^^^^^^^^^^^^^^
  |
help: did you mean "radius"?"#;
    assert_eq!(diagnostics.to_string(), expected.trim_start());
}

#[test]
fn a_scene_of_a_thousand_unknown_shapes_is_one_message() {
    let cone = "Shape \"cone\" \"point3 P\" [ 0 0 0 1 1 1 ]\n";
    let text = format!("WorldBegin\n{}", cone.repeat(1000));
    let shown = parse(Path::new("cones.pbrt"), &text).unwrap_err().to_string();
    assert_eq!(shown.matches("error:").count(), 1);
    assert!(shown.contains("the same occurs 999 times more"), "{shown}");
}
