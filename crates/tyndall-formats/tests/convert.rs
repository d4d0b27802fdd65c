//! Scenes from one language to the other and back: the same picture, bit for bit.
//!
//! Every scene of `scenes/` takes the way there and back. What the other language has no word for is refused with the place in
//! the file. What is not refused
//! - gives the same image after the way there and back,
//! - gives the same image on the way, if there was no warning,
//! - is written the same way the second time: nothing wears off.
#![allow(clippy::print_stderr)] // what the round trips come to is told

use std::path::{Path, PathBuf};

use tyndall::{
    film::Crop,
    integrator::VolPath,
    render::{Settings, render},
    spectrum::ColorMode,
};
use tyndall_formats::{
    build::build,
    desc::SceneDesc,
    error::{Severity, Unsupported},
    load,
    source::SourceMap,
    write::{Language, Written, write},
};

/// A directory of a test's own.
fn scratch(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("tyndall-convert-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}

/// The bits of a few pixels in the middle.
fn image(desc: &SceneDesc, sources: &SourceMap, side: u32) -> Vec<[u32; 3]> {
    let (scene, _) = build(desc, sources.clone(), ColorMode::Rgb).unwrap_or_else(|e| panic!("{e}"));
    let (width, height) = (scene.camera.width, scene.camera.height);
    let middle = |n: u32| (n.saturating_sub(side) / 2, n.saturating_sub(side) / 2 + side.min(n));
    let ((x0, x1), (y0, y1)) = (middle(width), middle(height));
    let crop = Some(Crop { min: (x0, y0), max: (x1, y1) });
    let film = render(&scene, &VolPath::default(), &Settings { spp: 2, crop, ..Settings::default() }, &()).film;
    let pixels = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
    pixels.map(|(x, y)| film.pixel(x, y).unwrap().mean().map(f32::to_bits)).collect()
}

fn save(path: &Path, written: &Written) {
    std::fs::write(path, &written.text).unwrap();
    for (path, bytes) in &written.beside {
        std::fs::write(path, bytes).unwrap();
    }
}

fn read(path: &Path) -> (SceneDesc, SourceMap) {
    load(path, &[], Unsupported::Refuse)
        .unwrap_or_else(|e| panic!("{e}\n{}", std::fs::read_to_string(path).unwrap_or_default()))
}

/// The text without its first comment, which names the file that it comes from.
fn body(text: &str) -> &str {
    text.split_once("\n\n").or_else(|| text.split_once("-->\n")).map_or(text, |(_, body)| body)
}

/// What became of a scene.
#[derive(Debug, PartialEq)]
enum Outcome {
    /// The same picture everywhere.
    Same,
    /// The same picture after the way there and back; in the other language it differs, as a warning says.
    Back,
    /// The same light in the other language, from pictures that were sampled anew.
    Resampled,
    /// The other language has no word for something.
    Refused,
}

/// What became of it, or what went wrong.
fn there_and_back(from: &Path, dir: &Path, side: u32) -> Result<Outcome, String> {
    let (mut desc, sources) = read(from);
    let (there, back) = match Language::of(from).unwrap() {
        Language::Mitsuba => ("there.pbrt", "back.xml"),
        Language::Pbrt => ("there.xml", "back.pbrt"),
    };
    let (there, back) = (dir.join(there), dir.join(back));
    let first = match write(&desc, &sources, &there, Unsupported::Refuse) {
        Ok(first) => first,
        Err(refused) => {
            let faults: Vec<_> = refused.errors.iter().filter(|e| e.severity != Severity::Warning).collect();
            assert!(
                faults.iter().all(|e| e.severity == Severity::NotYet && e.span.is_some()),
                "{}: {refused}",
                from.display()
            );
            let lenient = write(&desc, &sources, &there, Unsupported::Warn).unwrap_or_else(|e| panic!("{e}"));
            assert!(faults.iter().all(|e| lenient.text.contains(&e.message.replace("--", "- -"))), "{}", lenient.text);
            eprintln!(
                "{}: {}",
                from.file_name().unwrap().display(),
                faults.iter().map(|e| &*e.message).collect::<Vec<_>>().join("; ")
            );
            return Ok(Outcome::Refused);
        }
    };
    save(&there, &first);
    let (mut desc_there, sources_there) = read(&there);
    if first.warnings.iter().any(|w| w.message.contains("resampled")) {
        return Ok(Outcome::Resampled);
    }
    let second = write(&desc_there, &sources_there, &back, Unsupported::Refuse).map_err(|e| e.to_string())?;
    save(&back, &second);
    let (mut desc_back, sources_back) = read(&back);
    let third = write(&desc_back, &sources_back, &there, Unsupported::Refuse).map_err(|e| e.to_string())?;
    let texts = format!("{}\n{}", first.text, second.text);
    if body(&first.text) != body(&third.text) {
        let lines = body(&first.text).lines().zip(body(&third.text).lines());
        let (one, two) = lines.into_iter().find(|(one, two)| one != two).unwrap_or(("", "another length"));
        return Err(format!("is written otherwise the second time:\n{one}\n{two}"));
    }
    // The filter that pbrt takes by default is the one word that has no way back.
    if first.warnings.iter().any(|w| w.message.contains("Gaussian filter")) {
        let filter = desc.film.filter;
        for desc in [&mut desc_there, &mut desc_back] {
            desc.film.filter = filter;
        }
    }
    // pbrt's materials have two sides.
    if first.warnings.iter().any(|w| w.message.contains("both sides")) {
        desc.materials.iter_mut().for_each(|material| material.two_sided = true);
    }
    let before = image(&desc, &sources, side);
    if before != image(&desc_back, &sources_back, side) {
        return Err(format!("has another image after the way there and back\n{texts}"));
    }
    let is_same = before == image(&desc_there, &sources_there, side);
    if first.warnings.is_empty() && !is_same {
        return Err(format!("has another image on the way, and no warning says so\n{texts}"));
    }
    Ok(if is_same { Outcome::Same } else { Outcome::Back })
}

/// Every scene file below a directory of `scenes/`. Pieces that others include are no scenes: among words they have no `-` in
/// their names, elsewhere, in pbrt's language, no world begins in them.
fn scenes(below: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(below);
    let mut files: Vec<_> = std::fs::read_dir(root)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| Language::of(path).is_some())
        .filter(|path| {
            if below.starts_with("words") {
                return path.file_stem().unwrap().to_string_lossy().contains('-');
            }
            path.extension().unwrap() != "pbrt" || std::fs::read_to_string(path).unwrap().contains("WorldBegin")
        })
        .collect();
    files.sort();
    files
}

fn check(below: &str, side: u32, least: usize) {
    let dir = scratch(&below.replace('/', "-"));
    let mut wrong = Vec::new();
    let mut outcomes = Vec::new();
    for path in scenes(below) {
        match there_and_back(&path, &dir, side) {
            Ok(outcome) => outcomes.push(outcome),
            Err(what) => wrong.push(format!("{} {what}", path.file_name().unwrap().display())),
        }
    }
    assert!(wrong.is_empty(), "{} scenes of {below}:\n{}", wrong.len(), wrong.join("\n\n"));
    let count = |wanted| outcomes.iter().filter(|outcome| **outcome == wanted).count();
    let [same, back, resampled, refused] =
        [Outcome::Same, Outcome::Back, Outcome::Resampled, Outcome::Refused].map(count);
    eprintln!("{below}: {same} the same, {back} there and back, {resampled} resampled, {refused} refused");
    assert!(same + back >= least, "{below}: only {same} and {back} of {} scenes", outcomes.len());
    std::fs::remove_dir_all(dir).unwrap();
}

/// Layers of light are asked for alike in both languages: what one reads is what the other reads, written by it, angles and
/// quotes included; and their paths bear the names that the file gives to media, materials and shining shapes.
#[test]
fn layers_of_light_go_from_either_language_to_the_other() {
    let dir = scratch("layers");
    let (first, other, back) = (dir.join("first.pbrt"), dir.join("other.xml"), dir.join("back.pbrt"));
    let text = r#"
        Film "rgb" "integer xresolution" 4 "integer yresolution" 4
            "string layers" [ "direct" "orders:1" "milk=C.*V'milk'.*[LOB]" "wall=C<RD'wall'>(.|V{2,3})*L"
            "lamp=C.*L'lamp'" "key=C.*L'key'" "ball=C'ball'.*[LOB]" ]
        WorldBegin
        MakeNamedMedium "milk" "string type" "homogeneous"
        MakeNamedMaterial "wall" "string type" "diffuse"
        NamedMaterial "wall"
        AttributeBegin
            AreaLightSource "diffuse" "string name" "lamp"
            Shape "sphere" "float radius" 9
        AttributeEnd
        LightSource "point" "string name" "key"
        MediumInterface "milk" ""
        Material "interface"
        Shape "sphere" "string name" "ball""#;
    std::fs::write(&first, text).unwrap();
    let (desc, sources) = read(&first);
    let names: Vec<_> = desc.film.parts.layers.iter().map(|layer| &*layer.name).collect();
    assert_eq!(names, ["direct", "order0", "order1", "beyond1", "milk", "wall", "lamp", "key", "ball"]);
    let written = write(&desc, &sources, &other, Unsupported::Refuse).unwrap();
    save(&other, &written);
    let (translated, sources) = read(&other);
    assert_eq!(translated.film.parts.layers, desc.film.parts.layers, "{}", written.text);
    save(&back, &write(&translated, &sources, &back, Unsupported::Refuse).unwrap());
    let (again, sources) = read(&back);
    assert_eq!(again.film.parts.layers, desc.film.parts.layers);
    let (scene, _) = build(&again, sources, ColorMode::Rgb).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.camera.layers.len(), names.len());

    // Lights of one name are a group in pbrt, and two things in Mitsuba.
    std::fs::write(
        &first,
        text.replace("\"point\" \"string name\" \"key\"", "\"point\" \"string name\" \"lamp\"").replace("L'key'", "L"),
    )
    .unwrap();
    let (desc, sources) = read(&first);
    let written = write(&desc, &sources, &other, Unsupported::Refuse).unwrap();
    let told = written.warnings.iter().any(|w| w.message.contains("\"lamp\" is called \"lamp-2\" there"));
    assert!(told && written.text.contains("id=\"lamp-2\""), "{}", written.text);

    for (from, to, message) in
        [("V'milk'", "V'mlik'", "nothing in the scene is called 'mlik'"), ("<RD'", "<RX'", "`X` is not a kind")]
    {
        std::fs::write(&first, text.replace(from, to)).unwrap();
        let error = match load(&first, &[], Unsupported::Refuse) {
            Err(error) => error.to_string(),
            Ok((desc, sources)) => build(&desc, sources, ColorMode::Rgb).unwrap_err().to_string(),
        };
        assert!(error.contains(message) && error.contains("first.pbrt:3:") && error.contains('^'), "{error}");
    }
}

#[test]
fn each_word_of_mitsuba_goes_to_pbrt_and_back() {
    check("words/mitsuba", 24, 45);
}

#[test]
fn each_word_of_pbrt_goes_to_mitsuba_and_back() {
    check("words/pbrt", 24, 35);
}

#[test]
fn the_scenes_of_other_renderers_go_there_and_back() {
    check("peers/mitsuba", 13, 12);
    check("peers/pbrt", 12, 8);
}

#[test]
fn the_lecture_and_the_glass_of_milk_go_there_and_back() {
    check("lecture", 12, 1);
    check("milk", 6, 1);
}

#[test]
fn the_scenes_of_the_gallery_go_there_and_back() {
    check("cornell", 6, 0); // its walls, as measured, are no plane: Mitsuba has no word for them
    check("marble", 6, 2);
    check("fog", 6, 1);
    // What these have is no word of the other language: absorption by wavelength, strands, a metal by its reflectance.
    check("grains", 6, 0);
    check("hair", 6, 0);
    check("separate", 6, 0);
}

/// Whatever line of a scene is left out, if it is a scene still, it is written in both languages, and read again.
#[test]
fn every_scene_with_a_line_less_is_written_and_read_again() {
    let dir = scratch("lines");
    for path in scenes("words/mitsuba").into_iter().chain(scenes("words/pbrt")) {
        let text = std::fs::read_to_string(&path).unwrap();
        for left_out in 0..text.lines().count() {
            let less: Vec<_> = text.lines().enumerate().filter(|(i, _)| *i != left_out).map(|(_, line)| line).collect();
            let less = less.join("\n");
            let read = match Language::of(&path).unwrap() {
                Language::Pbrt => tyndall_formats::pbrt::parse(&path, &less),
                Language::Mitsuba => tyndall_formats::mitsuba::parse(&path, &less, &[]),
            };
            let Ok((desc, sources)) = read else { continue };
            for name in ["less.pbrt", "less.xml"] {
                let target = dir.join(name);
                let written = write(&desc, &sources, &target, Unsupported::Warn).unwrap_or_else(|e| panic!("{e}"));
                save(&target, &written);
                // Without a camera that the language knows, Mitsuba takes it for no scene.
                let blind = written.warnings.iter().any(|w| w.message.contains("a camera"));
                if !blind || name == "less.pbrt" {
                    self::read(&target);
                }
            }
        }
    }
    std::fs::remove_dir_all(dir).unwrap();
}

/// A body of a PLY file with normals against its winding is on the way to pbrt what it was: lit outside, and its medium
/// inside. (pbrt takes the side from the normals.)
#[test]
fn a_body_with_normals_against_its_winding_is_not_turned_inside_out() {
    let dir = scratch("winding");
    let corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let properties = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let vertices = corners.map(|[x, y, z]| format!("{x} {y} {z} {} {} {}\n", -x, -y, -z)).concat();
    let face = |octant: usize| {
        let [x, y, z] = [octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2)];
        let is_even = [0, 3, 5, 6].contains(&octant);
        if is_even { format!("3 {x} {y} {z}\n") } else { format!("3 {x} {z} {y}\n") }
    };
    let faces: String = (0..8).map(face).collect();
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 6\n{properties}element face 8\nproperty list uchar int vertex_indices\n\
         end_header\n{vertices}{faces}"
    );
    std::fs::write(dir.join("body.ply"), ply).unwrap();
    let xml = r#"<scene version="3.0.0"><integrator type="volpath"/>
        <sensor type="perspective"><transform name="to_world"><lookat origin="1,2,5" target="0,0,0" up="0,1,0"/></transform>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/>
        <rfilter type="box"/></film></sensor>
        <shape type="ply"><string name="filename" value="body.ply"/><bsdf type="dielectric"/>
        <medium name="interior" type="homogeneous"><rgb name="sigma_t" value="1,2,3"/><rgb name="albedo" value="0.5"/></medium>
        </shape><emitter type="constant"/></scene>"#;
    let from = dir.join("scene.xml");
    std::fs::write(&from, xml).unwrap();
    let (desc, sources) = read(&from);
    let there = dir.join("there.pbrt");
    let written = write(&desc, &sources, &there, Unsupported::Refuse).unwrap_or_else(|e| panic!("{e}"));
    save(&there, &written);
    assert_eq!(written.beside.len(), 1, "the mesh is written anew");
    let (desc_there, sources_there) = read(&there);
    assert_eq!(image(&desc, &sources, 16), image(&desc_there, &sources_there, 16));
    std::fs::remove_dir_all(dir).unwrap();
}

/// Environments are seen through other pictures in the other language: the same light within noise, at each of some hundred
/// pixels and in the mean: |z| above 4.9 in one of 2 · 432 has a chance of 1e-3, above 4 in one of 6 means 4e-4. What is seen
/// is a ball that reflects all, for in a sky of so few pixels their edges are seen, softened over half of one.
#[test]
fn an_environment_in_the_other_language_lights_a_ball_alike() {
    let dir = scratch("sky");
    let picture = |name: &str, width: usize, height: usize| {
        let value =
            |i: usize| [1.0 + (i * 7 % 5) as f32, (i * 3 % 7) as f32, if i.is_multiple_of(11) { 30.0 } else { 0.5 }];
        let bytes: Vec<u8> = (0..width * height).flat_map(value).flat_map(f32::to_le_bytes).collect();
        let header = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
        std::fs::write(dir.join(name), [header, bytes].concat()).unwrap();
    };
    picture("square.pfm", 11, 11);
    picture("long.pfm", 16, 8);
    let pbrt = r#"LookAt 1 2 5 0 0 0 0 1 0 Camera "perspective" "float fov" 12
        Film "rgb" "integer xresolution" 12 "integer yresolution" 12 PixelFilter "box"
        WorldBegin AttributeBegin Rotate 40 1 2 3
        LightSource "infinite" "string filename" "square.pfm" "float illuminance" 3 "float scale" 0.5 AttributeEnd
        Material "diffuse" "rgb reflectance" [ 1 1 1 ] Shape "sphere""#;
    let xml = r#"<scene version="3.0.0"><integrator type="path"/>
        <sensor type="perspective"><float name="fov" value="12"/>
        <transform name="to_world"><lookat origin="1,2,5" target="0,0,0" up="0,1,0"/></transform>
        <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="12"/>
        <rfilter type="box"/></film></sensor>
        <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf></shape>
        <emitter type="envmap"><string name="filename" value="long.pfm"/><float name="scale" value="0.25"/>
        <transform name="to_world"><rotate x="1" y="2" z="3" angle="40"/></transform></emitter></scene>"#;
    for (name, text, target) in [("a.pbrt", pbrt, "there-a.xml"), ("b.xml", xml, "there-b.pbrt")] {
        let (from, there) = (dir.join(name), dir.join(target));
        std::fs::write(&from, text).unwrap();
        let (desc, sources) = read(&from);
        let written = write(&desc, &sources, &there, Unsupported::Refuse).unwrap_or_else(|e| panic!("{e}"));
        save(&there, &written);
        assert!(written.text.contains("resampled"), "{}", written.text);
        let film = |seed: u64, path: &Path| {
            let (desc, sources) = read(path);
            let (scene, _) = build(&desc, sources, ColorMode::Rgb).unwrap_or_else(|e| panic!("{e}"));
            render(&scene, &VolPath::default(), &Settings { spp: 256, seed, ..Settings::default() }, &()).film
        };
        let (old, new) = (film(1, &from), film(2, &there));
        let pixels = || (0..12).flat_map(|y| (0..12).map(move |x| (x, y)));
        let of = |film: &tyndall::film::Film, channel: usize| -> Vec<(f64, f64)> {
            let pixel = |(x, y)| film.pixel(x, y).unwrap();
            let value = |p: &tyndall::film::Pixel| (p.mean()[channel].into(), p.standard_error()[channel].into());
            pixels().map(pixel).map(value).collect()
        };
        for channel in 0..3 {
            let pairs: Vec<_> = of(&old, channel).into_iter().zip(of(&new, channel)).collect();
            let (mut gap, mut variance) = (0.0, 0.0);
            for (i, ((a, da), (b, db))) in pairs.into_iter().enumerate() {
                (gap, variance) = (gap + a - b, variance + da * da + db * db);
                let z = (a - b) / da.hypot(db).max(1e-9);
                assert!(z.abs() < 4.9, "{name}, pixel {i}, channel {channel}: {a} {b}, z {z}");
            }
            let z = gap / f64::sqrt(variance);
            assert!(z.abs() < 4.0, "{name}, channel {channel}: {gap} ± {}", variance.sqrt());
        }
    }
    std::fs::remove_dir_all(dir).unwrap();
}

/// Pheomelanin is 0 in pbrt and 0.2 in Mitsuba if nothing is said, eumelanin nothing or 1.3: what is a default in one language
/// only is written, and every number comes back from both.
#[test]
fn hair_keeps_its_numbers_whatever_the_other_language_takes_by_default() {
    use tyndall_formats::desc::{HairColourDesc, HairDesc, MaterialKind};
    let dir = scratch("hair");
    let strands =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/words/data/strands.txt").canonicalize().unwrap();
    let hair = |desc: &SceneDesc| -> HairDesc {
        let hair =
            desc.materials.iter().find_map(|m| if let MaterialKind::Hair(hair) = &m.kind { Some(hair) } else { None });
        HairDesc::clone(hair.unwrap())
    };
    let numbers = |hair: &HairDesc| {
        let HairColourDesc::Pigments { eumelanin, pheomelanin } = &hair.colour else { panic!("{hair:?}") };
        [eumelanin, pheomelanin, &hair.beta_m, &hair.beta_n, &hair.alpha].map(|n| n.value.number().unwrap())
    };
    for (words, expected) in [
        ("", [1.3, 0.0, 0.3, 0.3, 2.0]),
        ("\"float eumelanin\" 0.6", [0.6, 0.0, 0.3, 0.3, 2.0]),
        ("\"float eumelanin\" 1.3 \"float pheomelanin\" 0.2", [1.3, 0.2, 0.3, 0.3, 2.0]),
        (
            "\"float pheomelanin\" 0.7 \"float beta_m\" 0.1 \"float beta_n\" 0.8 \"float alpha\" 5",
            [0.0, 0.7, 0.1, 0.8, 5.0],
        ),
    ] {
        let first = dir.join("first.pbrt");
        let shape =
            format!("Shape \"hair\" \"string filename\" \"{}\" \"string basis\" \"bspline\"", strands.display());
        std::fs::write(&first, format!("PixelFilter \"box\" WorldBegin Material \"hair\" {words} {shape}")).unwrap();
        let (mut desc, mut sources) = read(&first);
        assert_eq!(numbers(&hair(&desc)), expected, "{words}");
        for next in ["second.xml", "third.pbrt"].map(|name| dir.join(name)) {
            let written = write(&desc, &sources, &next, Unsupported::Refuse).unwrap_or_else(|e| panic!("{e}"));
            save(&next, &written);
            (desc, sources) = read(&next);
            assert_eq!(numbers(&hair(&desc)), expected, "{words}\n{}", written.text);
        }
    }
    std::fs::remove_dir_all(dir).unwrap();
}

/// A scene that is written in its own language says what only this language can: full scattering of a measured medium,
/// priorities, lamps with two sides, how finely a mesh is cut that heights move.
#[test]
fn what_only_pbrt_says_is_written_in_pbrt() {
    let dir = scratch("own");
    let first = dir.join("first.pbrt");
    let text = r#"PixelFilter "box" WorldBegin
        MakeNamedMedium "milk" "string type" "homogeneous" "string preset" "Lowfat Milk" "bool reduced" false
        AttributeBegin MediumInterface "milk" "" Shape "sphere" "integer priority" 3 AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "bool twosided" true Shape "disk" AttributeEnd
        Texture "h" "float" "constant" "float value" 0.1
        Shape "plymesh" "string filename" "a.ply" "texture displacement" "h" "float edgelength" 0.25"#;
    std::fs::write(&first, text).unwrap();
    let (desc, sources) = read(&first);
    let second = dir.join("second.pbrt");
    let written = write(&desc, &sources, &second, Unsupported::Refuse).unwrap_or_else(|e| panic!("{e}"));
    save(&second, &written);
    for word in [
        "\"string preset\" \"Lowfat Milk\"",
        "\"bool reduced\" false",
        "\"integer priority\" 3",
        "\"bool twosided\" true",
        "\"float edgelength\" 0.25",
    ] {
        assert!(written.text.contains(word), "{word} is lost:\n{}", written.text);
    }
    let again =
        write(&read(&second).0, &read(&second).1, &second, Unsupported::Refuse).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(body(&again.text), body(&written.text));
    std::fs::remove_dir_all(dir).unwrap();
}
