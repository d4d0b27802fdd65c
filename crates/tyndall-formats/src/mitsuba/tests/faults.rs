//! Faulty scenes and the words that tell it.

use proptest::prelude::*;

use super::*;

/// Every fault as `line:column: message` and, behind `|`, what to do.
fn faults(text: &str, overrides: &[(String, String)]) -> Vec<String> {
    let Err(errors) = parse(Path::new("scene.xml"), text, overrides) else { return Vec::new() };
    let fault = |error: &SceneError| {
        let place = error.span.map_or(String::new(), |span| {
            let place = errors.sources.place(span);
            format!("{}: ", place.trim_start_matches("scene.xml:"))
        });
        let help = error.help.as_ref().map_or(String::new(), |help| format!(" | {help}"));
        format!("{place}{}{help}", error.message)
    };
    errors.errors.iter().map(fault).collect()
}

/// Elements on the second line of a scene, and the one fault that they are.
const FAULTS: &[(&str, &str)] = &[
    // Words.
    (r#"<shpe type="cube"/>"#, r#"2:2: there is no element <shpe> | did you mean "shape"?"#),
    (r#"<shape type="spere"/>"#, r#"2:14: there is no shape "spere" | did you mean "sphere"?"#),
    (r#"<shape kind="cube"/>"#, r#"2:8: <shape> has no attribute "kind" | known are "type", "id", "name", "version""#),
    (r"<shape/>", r#"2:2: <shape> lacks the attribute "type""#),
    (
        r#"<shape type="cube"><bsdf type="pplastic"/></shape>"#,
        r#"2:32: the bsdf "pplastic" is not known yet | known are "diffuse", "twosided", "dielectric", "roughdielectric", "thindielectric", "conductor", "roughconductor", "null", "plastic", "roughplastic", "measured", "principled", "principledthin", "blendbsdf", "mask", "bumpmap", "normalmap", "hair""#,
    ),
    (
        r#"<medium type="heterogeneous"><float name="x" value="1"/></medium>"#,
        r#"2:15: the medium "heterogeneous" is not known yet | known are "homogeneous""#,
    ),
    (
        r#"<shape type="sdfgrid"/>"#,
        r#"2:14: the shape "sdfgrid" is not known yet | known are "sphere", "rectangle", "cube", "disk", "cylinder", "obj", "ply", "serialized", "bsplinecurve", "linearcurve", "shapegroup", "instance""#,
    ),
    (
        r#"<shape type="sphere"><float name="radios" value="1"/></shape>"#,
        r#"2:35: the shape "sphere" has no parameter "radios" | did you mean "radius"?"#,
    ),
    (
        r#"<shape type="cube"><transform name="toWorld"/></shape>"#,
        r#"2:37: the shape "cube" has no parameter "toWorld" | did you mean "to_world"?"#,
    ),
    (r#"<shape type="cube"><phase type="hg"/></shape>"#, r#"2:20: the shape "cube" takes no <phase>"#),
    (r#"<shape type="cube">cube</shape>"#, "2:20: text inside <shape> has no meaning"),
    // Values.
    (r#"<shape type="sphere"><float name="radius" value="1m"/></shape>"#, r#"2:50: "1m" is not a number"#),
    (
        r#"<shape type="sphere"><float name="radius" value="-1"/></shape>"#,
        r#"2:50: "radius" must be greater than 0, not -1"#,
    ),
    (
        r#"<shape type="sphere"><string name="radius" value="1"/></shape>"#,
        r#"2:36: "radius" is a <float>, not a <string>"#,
    ),
    (
        r#"<shape type="sphere"><float name="radius" value="1"/><float name="radius" value="2"/></shape>"#,
        r#"2:67: "radius" is given twice"#,
    ),
    (
        r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.5 0.5"/></bsdf>"#,
        "2:53: 1 or 3 numbers are needed here, not 2",
    ),
    (
        r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.5 0.5 1.5"/></bsdf>"#,
        r#"2:53: "reflectance" must be in [0, 1], not 0.5 0.5 1.5"#,
    ),
    (
        r#"<bsdf type="diffuse"><texture name="reflectance" type="volume"/></bsdf>"#,
        r#"2:56: the texture "volume" is not known yet | known are "bitmap", "checkerboard", "mesh_attribute""#,
    ),
    (
        r#"<shape type="cube"><boolean name="flip_normals" value="yes"/></shape>"#,
        r#"2:56: "yes" is neither true nor false"#,
    ),
    (
        r#"<bsdf type="roughdielectric"><string name="distribution" value="ggxx"/></bsdf>"#,
        r#"2:65: "distribution" cannot be "ggxx" | did you mean "ggx"?"#,
    ),
    (
        r#"<bsdf type="dielectric"><string name="int_ior" value="watr"/></bsdf>"#,
        r#"2:55: no refractive index is known for "watr" | did you mean "water"?"#,
    ),
    (
        r#"<bsdf type="roughdielectric"><float name="alpha_u" value="0.2"/></bsdf>"#,
        r#"2:59: give either "alpha", or both "alpha_u" and "alpha_v""#,
    ),
    (
        r#"<bsdf type="twosided"><bsdf type="dielectric"/></bsdf>"#,
        r#"2:35: "dielectric" is not a surface that only reflects | leave the "twosided" out"#,
    ),
    (
        r#"<bsdf type="twosided"><bsdf type="principled"><float name="spec_trans" value="0.5"/></bsdf></bsdf>"#,
        r#"2:35: "principled" is not a surface that only reflects | leave the "twosided" out"#,
    ),
    (
        r#"<bsdf type="principled"><float name="eta" value="1.5"/><float name="specular" value="0.5"/></bsdf>"#,
        r#"2:86: "specular" and "eta" say the same: give one of them"#,
    ),
    (
        r#"<bsdf type="roughplastic"><string name="distribution" value="phong"/></bsdf>"#,
        r#"2:62: "distribution" cannot be "phong" | known are "beckmann", "ggx""#,
    ),
    (
        r#"<medium type="homogeneous"><phase type="hg"><float name="g" value="1"/></phase></medium>"#,
        r#"2:68: "g" must be greater than -1 and less than 1, not 1"#,
    ),
    (
        r#"<medium type="homogeneous"><phase type="tabphase"/></medium>"#,
        r#"2:28: "tabphase" lacks its "values" | from straight back to straight on, at regular cosines"#,
    ),
    (
        r#"<medium type="homogeneous"><phase type="blendphase"><float name="weight" value="1"/><phase type="hg"/></phase></medium>"#,
        r#"2:28: "blendphase" is made of 2 <phase>, not of 1"#,
    ),
    (
        r#"<phase type="blendphase" id="a"><float name="weight" value="1"/><phase type="hg"/><ref id="a"/></phase><medium type="homogeneous"><ref id="a"/></medium>"#,
        "2:1: phase functions are blended more than 5 deep",
    ),
    (
        r#"<integrator type="path"><integer name="max_depth" value="0"/></integrator>"#,
        r#"2:58: with "max_depth" 0 nothing is seen at all | -1 is without limit, 1 shows lights, 2 what they shine on"#,
    ),
    // Transforms.
    (
        r#"<shape type="cube"><transform name="to_world"><scale value="0"/></transform></shape>"#,
        "2:47: this <scale> cannot be undone: it flattens space",
    ),
    (
        r#"<shape type="cube"><transform name="to_world"><rotate x="2" angle="nine"/></transform></shape>"#,
        r#"2:68: "nine" is not a number"#,
    ),
    (
        r#"<shape type="cube"><transform name="to_world"><lookat origin="0 0 1" target="0 0 0" up="0 0 1"/></transform></shape>"#,
        "2:89: up is parallel to the line from origin to target",
    ),
    (
        r#"<shape type="cube"><transform name="to_world"><matrix value="1 2"/></transform></shape>"#,
        "2:62: 16 numbers are needed here, not 2 | a matrix has 16 numbers, or 9",
    ),
    // References.
    (
        r#"<bsdf type="diffuse" id="white"/><shape type="cube"><ref id="whit"/></shape>"#,
        r#"2:62: nothing has the id "whit" | did you mean "white"?"#,
    ),
    (r#"<bsdf type="null" id="a"/><bsdf type="null" id="a"/>"#, r#"2:49: the id "a" is taken"#),
    (
        r#"<bsdf type="twosided" id="a"><ref id="a"/></bsdf>"#,
        r#"2:13: "twosided" is two-sided already | leave the "twosided" out"#,
    ),
    (
        r#"<bsdf type="blendbsdf" id="a"><float name="weight" value="1"/><ref id="a"/><bsdf type="null"/></bsdf>"#,
        "2:1: this material contains itself",
    ),
    (r#"<bsdf type="mask"/>"#, r#"2:1: "mask" is made of 1 <bsdf>, not of 0"#),
    (r#"<shape type="instance"><shape type="cube"/></shape>"#, r#"2:24: the shape "cube" is no "shapegroup""#),
    (
        r#"<shape type="cube"><medium type="homogeneous" name="inside"/></shape>"#,
        r#"2:53: the medium of a shape is named "interior" or "exterior" | known are "interior", "exterior""#,
    ),
    (r#"<emitter type="area"/>"#, r#"2:16: the emitter "area" stands alone | put it inside the shape that shines"#),
    // Parameters.
    (
        r#"<default name="spp" value="4"/><shape type="$shap"/>"#,
        r#"2:45: the parameter "$shap" is not defined | the only one known is "spp""#,
    ),
    (r#"<include filename="none.xml"/>"#, "2:20: cannot read none.xml: No such file or directory (os error 2)"),
    (r#"<path value="none"/>"#, "2:14: there is no directory none"),
];

#[test]
fn every_fault_is_told_with_its_place_and_what_to_do() {
    for (elements, fault) in FAULTS {
        let found = faults(&scene(elements), &[]);
        // A word that stands for nothing is no plugin either.
        assert_eq!(found.first().map(String::as_str), Some(*fault), "{elements}\n{found:#?}");
        assert!(found.len() == 1 || elements.contains('$'), "{elements}\n{found:#?}");
    }
}

#[test]
fn a_file_that_is_no_scene_is_told_so() {
    let cases = [
        ("", "1:1: this is not XML: the document does not have a root node"),
        ("<scene version=\"3.0.0\">\n<shape></scene>", "2:8: this is not XML: expected 'shape' tag, not 'scene'"),
        (
            "<scene version=\"0.6.0\"><sensor type=\"perspective\"/></scene>",
            "1:17: scenes of Mitsuba 0.6.0 cannot be read | versions 2 and 3 can; Mitsuba 3 converts older scenes",
        ),
        ("<scene><sensor type=\"perspective\"/></scene>", "1:2: <scene> lacks the attribute \"version\""),
        ("<scene version=\"3.0.0\"/>", "1:1: the scene has no <sensor> | add a <sensor type=\"perspective\">"),
        ("<bsdf type=\"null\" version=\"3.0.0\"/>", "1:2: the file holds a <bsdf>, not a <scene>"),
    ];
    for (text, fault) in cases {
        assert_eq!(faults(text, &[]).first().map(String::as_str), Some(fault), "{text}");
    }
    let error = load(Path::new("no/such.xml"), &[], Unsupported::Refuse).unwrap_err().to_string();
    assert!(error.contains("no/such.xml"), "{error}");
}

#[test]
fn all_faults_of_a_file_are_told_at_once() {
    let text = scene(
        "<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/><ref id=\"none\"/></shape>\n\
         <shape type=\"spere\"/>\n<emitter type=\"area\"/>",
    );
    let found = faults(&text, &[]);
    let places: Vec<_> = found.iter().map(|fault| fault.split(": ").next().unwrap()).collect();
    assert_eq!(places, ["2:35", "2:63", "3:14", "4:16"], "{found:#?}");
}

/// Every word that is not known yet, each in its place.
#[test]
fn what_is_not_known_yet_is_told_down_to_the_last_plugin() {
    let text = scene(
        "<shape type=\"sdfgrid\"><string name=\"filename\" value=\"hair.txt\"/><bsdf type=\"pplastic\"/></shape>\n\
         <shape type=\"cube\"><medium name=\"interior\" type=\"heterogeneous\">\n\
         <volume name=\"sigma_t\" type=\"gridvolume\"/><phase type=\"hg\"/></medium></shape>",
    );
    let found: Vec<_> = faults(&text, &[]).iter().map(|fault| fault.split(" | ").next().unwrap().to_owned()).collect();
    assert_eq!(
        found,
        [
            "2:14: the shape \"sdfgrid\" is not known yet",
            "2:77: the bsdf \"pplastic\" is not known yet",
            "3:50: the medium \"heterogeneous\" is not known yet",
            "4:30: the volume \"gridvolume\" is not known yet",
        ]
    );
}

#[test]
fn an_override_that_the_scene_does_not_know_is_a_fault() {
    let text = scene("<default name=\"spp\" value=\"4\"/><default name=\"res\" value=\"9\"/>");
    let set = |name: &str| vec![(name.to_owned(), "1".to_owned())];
    assert_eq!(faults(&text, &set("sp")), ["-D sp=1: the scene has no parameter \"sp\" | did you mean \"spp\"?"]);
    assert_eq!(
        faults(&text, &set("threads")),
        ["-D threads=1: the scene has no parameter \"threads\" | known are \"spp\", \"res\""]
    );
    assert!(faults(&text, &set("spp")).is_empty());
}

#[test]
fn a_million_nested_elements_are_a_fault() {
    let text = format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{}",
        "<bsdf type=\"twosided\">".repeat(1_000_000)
    );
    assert!(faults(&text, &[])[0].contains("this is not XML"));
    let text = format!("{text}{}</scene>", "</bsdf>".repeat(1_000_000));
    assert!(faults(&text, &[]).iter().any(|fault| fault.ends_with("elements are nested more than 32 deep")));
}

/// Every default is twice the one before: 2⁶⁴ characters, if one let it.
#[test]
fn parameters_that_grow_without_end_are_a_fault() {
    let mut defaults = String::from("<default name=\"a00\" value=\"x\"/>");
    for i in 0..64 {
        let (name, next) = (format!("a{i:02}"), format!("a{:02}", i + 1));
        defaults.extend(["<default name=\"", &next, "\" value=\"$", &name, "$", &name, "\"/>"]);
    }
    let found = faults(&scene(&defaults), &[]);
    assert!(found[0].ends_with("the parameters make a value of more than 1 MiB"), "{:.200}", found[0]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn no_damage_to_a_scene_makes_the_reader_panic(
        which in 0usize..5,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0usize..16), 1..8),
    ) {
        const PIECES: [&str; 16] = [
            "", "<", ">", "\"", "/>", "$", "-1", "nan", "1e400", "é", "0", "&amp;", "<ref id=\"white\"/>",
            "<shape type=\"instance\"/>", "</shape>", " name=\"\"",
        ];
        let names = ["a_marble_cube.xml", "a3_marble_cube_rough_spot.xml", "c_milk_sphere.xml", "d_fog_box.xml", "g_cornell.xml"];
        let mut text: Vec<char> = std::fs::read_to_string(peer(names[which])).unwrap().chars().collect();
        for (at, length, piece) in damage {
            let at = at.index(text.len());
            let end = (at + length.index(12)).min(text.len());
            text.splice(at..end, PIECES[piece].chars());
        }
        let text: String = text.into_iter().collect();
        if let Err(errors) = parse(Path::new("scene.xml"), &text, &[]) {
            prop_assert!(!errors.errors.is_empty());
            prop_assert!(!errors.to_string().is_empty());
        }
    }
}

/// A batch of nothing that is known, and one that does not divide its film: errors, no division by zero.
#[test]
fn a_batch_has_sensors_that_share_its_film() {
    let faults = |inside: &str| {
        let text = format!("<scene version=\"3.0.0\"><sensor type=\"batch\">{inside}</sensor></scene>");
        parse(Path::new("a.xml"), &text, &[]).map(|_| ()).unwrap_err().to_string()
    };
    for inside in ["", "<sensor type=\"telescope\"/>", "<sensor type=\"batch\"/>"] {
        assert!(faults(inside).contains("the batch has no <sensor> that can be used"), "{inside}");
    }
    let five = "<sensor type=\"perspective\"/>".repeat(5);
    assert!(faults(&five).contains("5 sensors do not divide 768 columns"));
}

/// Mitsuba's `path` counts the surfaces that it passes straight, its `volpath` and tyndall do not.
#[test]
fn a_depth_for_which_open_surfaces_count_is_told() {
    let told = |integrator: &str, depth: i32, bsdf: &str| {
        let words = format!(
            "<integrator type=\"{integrator}\"><integer name=\"max_depth\" value=\"{depth}\"/></integrator>\
             <shape type=\"sphere\">{bsdf}</shape>"
        );
        parsed(&scene(&words)).warnings.iter().filter(|w| w.message.contains("passed straight")).count()
    };
    let null = "<bsdf type=\"null\"/>";
    let mask = "<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>";
    assert_eq!([told("path", 5, null), told("path", 5, mask), told("prb", 5, null)], [1, 1, 1]);
    assert_eq!([told("path", -1, null), told("volpath", 5, null), told("path", 5, "")], [0, 0, 0]);
}
