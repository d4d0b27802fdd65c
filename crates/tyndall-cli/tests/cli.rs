//! The program as a user meets it: what it says, what it leaves behind, how it ends.

mod common;

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    time::{Duration, Instant},
};

use common::Desk;
use tyndall_formats::film::{Image, exr};

/// A ball over a floor under a small light, in fog: every kind of event in a few pixels.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 24 "integer yresolution" 18
Sampler "independent" "integer pixelsamples" 4
LookAt 0 1 -5  0 0.8 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.4 0.6 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.4 0.5 0.6 ] "rgb sigma_a" [ 0.1 0.05 0 ] "float g" 0.5
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 1.5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
  Translate 0 2.4 0
  Shape "sphere" "float radius" 0.2
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 -2 -4  4 -2 -4  -4 -2 4  4 -2 4 ]
"#;

impl Desk {
    /// With the scene `ball.pbrt`.
    fn with_ball(name: &str) -> Self {
        let desk = Self::new(name);
        fs::write(desk.0.join("ball.pbrt"), SCENE).unwrap();
        desk
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = self.program();
        command.args(arguments.split_whitespace());
        command
    }

    fn tyndall(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Renders the ball, which must work.
    fn render(&self, arguments: &str, image: &str) -> Image {
        let output = self.tyndall(&format!("render ball.pbrt {arguments} -o {image}"));
        assert!(output.status.success(), "{arguments}: {}", err(&output));
        exr::read(&self.0.join(image)).unwrap()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Files that were there, but for the scene.
fn left_behind(desk: &Desk) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(&desk.0).unwrap().map(|f| f.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| name != "ball.pbrt");
    names.sort();
    names
}

#[test]
fn help_teaches_by_example() {
    let desk = Desk::with_ball("help");
    for (arguments, words) in [
        ("--help", ["render", "compare", "lecture"]),
        ("render --help", ["Examples:", "--spp", "lecture-volume-0.75"]),
        ("help compare", ["--reference", "z-test", "Examples:"]),
        ("lecture --help", ["--spp", "--out", "Examples:"]),
    ] {
        let output = desk.tyndall(arguments);
        assert!(output.status.success());
        for word in words {
            assert!(out(&output).contains(word), "{arguments}: no {word}");
        }
    }
}

#[test]
fn what_cannot_be_done_ends_with_status_2_and_says_why() {
    let desk = Desk::with_ball("bad");
    fs::write(desk.path("bad.pbrt"), SCENE.replace("\"float radius\" 1.5", "\"float radios\" 1.5")).unwrap();
    fs::write(desk.path("cut.exr"), [0x76, 0x2f, 0x31, 0x01, 2]).unwrap();
    for (arguments, words) in [
        ("render", "SCENE"),
        ("render ball.pbrt --spp 0", "--spp"),
        ("render ball.pbrt --spp many", "--spp"),
        ("render ball.pbrt --time 3x", "no unit of time"),
        ("render ball.pbrt --crop 9,9,9,9", "empty"),
        ("render ball.pbrt --crop 0,0,99,9", "24x18"),
        ("render ball.pbrt --resolution 60000x60000", "--crop"),
        ("render ball.pbrt --integrator bdpt", "volpath"),
        ("render ball.pbrt -o image.jpg", ".exr or .png"),
        ("render ball.pbrt -o nowhere/image.exr", "nowhere does not exist"),
        ("render missing.pbrt", "missing.pbrt"),
        ("render scene.blend", ".pbrt"),
        ("render bad.pbrt", "radius"),
        ("render ball.pbrt --max-depth 3 --integrator analog", "volpath"),
        ("render ball.pbrt -D g=0.5", "parameter"),
        ("compare cut.exr cut.exr", "cut.exr"),
        ("compare a.exr b.exr", "cannot read a.exr"),
    ] {
        let output = desk.tyndall(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", err(&output));
        assert!(err(&output).contains(words), "{arguments}: no `{words}` in\n{}", err(&output));
    }
    assert_eq!(left_behind(&desk), ["bad.pbrt", "cut.exr"]);
}

#[test]
fn a_fault_of_a_scene_is_shown_where_it_is() {
    let desk = Desk::with_ball("fault");
    fs::write(desk.path("bad.pbrt"), SCENE.replace("\"float fov\"", "\"float fow\"")).unwrap();
    let message = err(&desk.tyndall("render bad.pbrt"));
    assert!(message.contains("bad.pbrt:5:") && message.contains("fow") && message.contains("fov"), "{message}");
}

#[test]
fn the_image_is_named_after_the_scene_and_tells_how_it_was_made() {
    let desk = Desk::with_ball("names");
    let output = desk.tyndall("render ball.pbrt --seed 7 --crop 2,3,20,15");
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(left_behind(&desk), ["ball.exr", "ball.png"]);
    assert!(err(&output).contains("ball.exr and ball.png"), "{}", err(&output));
    let image = exr::read(&desk.path("ball.exr")).unwrap();
    assert_eq!((image.width, image.height, image.crop.min, image.crop.max), (24, 18, (2, 3), (20, 15)));
    assert!(image.mean.iter().flatten().all(|v| v.is_finite()));
    let metadata = image.metadata.unwrap();
    assert_eq!((metadata.seed, metadata.spp, metadata.samples_per_pixel), (7, 4, 4.0));
    assert_eq!(metadata.crop, "2,3,20,15");
    assert!(metadata.command.ends_with("render ball.pbrt --seed 7 --crop 2,3,20,15"), "{}", metadata.command);
    assert_eq!(metadata.scene_hash.len(), 16);
}

#[test]
fn the_image_depends_on_the_seed_and_on_nothing_else() {
    let desk = Desk::with_ball("bits");
    let first = desk.render("--spp 8", "a.exr");
    let same = |image: &Image| first.mean == image.mean && first.standard_error == image.standard_error;
    assert!(same(&desk.render("--spp 8", "b.exr")), "twice");
    assert!(same(&desk.render("--spp 8 --threads 1", "b.exr")), "one thread");
    assert!(same(&desk.render("--spp 8 --threads 3", "b.exr")), "three threads");
    assert!(!same(&desk.render("--spp 8 --seed 1", "b.exr")), "another seed");
}

#[test]
fn a_crop_of_the_image_is_the_image_of_the_crop() {
    let desk = Desk::with_ball("crop");
    let whole = desk.render("--spp 4", "whole.exr");
    let crop = desk.render("--spp 4 --crop 5,3,22,17", "crop.exr");
    for (i, mean) in crop.mean.iter().enumerate() {
        let (x, y) = (5 + i % 17, 3 + i / 17);
        assert_eq!(*mean, whole.mean[y * 24 + x], "pixel {x},{y}");
    }
}

/// Each layer with its standard error, once; the image is the same without them.
#[test]
fn parts_of_the_light_are_layers_of_the_image() {
    let desk = Desk::with_ball("parts");
    let with = desk.render("--layers direct,single,orders:1,direct", "with.exr");
    let without = desk.render("", "without.exr");
    assert_eq!(with.mean, without.mean);
    let bytes = fs::read(desk.path("with.exr")).unwrap();
    let count = |name: &str| bytes.windows(name.len()).filter(|window| *window == name.as_bytes()).count();
    for name in ["direct.R", "single.G", "order0.B", "order1.R", "beyond1.R"] {
        // A channel's name ends with a zero byte, in the list of channels.
        assert_eq!(count(&format!("\0{name}\0")), 1, "{name}");
        assert_eq!(count(&format!("\0stderr.{name}\0")), 1, "{name}");
    }
    let refused = |arguments: &str| err(&desk.tyndall(&format!("render ball.pbrt {arguments}")));
    assert!(refused("--layers singel").contains("did you mean `single`?"));
    assert!(refused("--layers orders:65").contains("from 0 to 64"));
    assert!(refused("--layers direct --integrator analog").contains("analog cannot take light apart"));
    assert!(refused("--layers x=CV'mlk'L").contains("nothing in the scene is called 'mlk'"));
}

/// Groups of layers add up to the image; what is missing is told; an image without layers is an error that says what to do.
#[test]
fn the_layers_of_an_image_are_told_in_groups_that_add_up() {
    let desk = Desk::with_ball("groups");
    desk.render("--layers emission,direct,indirect,orders:1", "whole.exr");
    let told = |arguments: &str| desk.tyndall(&format!("layers {arguments}"));
    let whole = told("whole.exr --check --strips whole");
    let text = String::from_utf8_lossy(&whole.stdout).into_owned();
    assert!(whole.status.success(), "{text}{}", err(&whole));
    assert!(
        text.starts_with("all = emission ") && text.contains("\nall = order0 ") && !text.contains("rest"),
        "{text}"
    );
    assert!(desk.path("whole-ways.png").exists() && desk.path("whole-orders.png").exists());
    desk.render("--layers direct", "part.exr");
    let part = told("part.exr --check");
    assert!(String::from_utf8_lossy(&part.stdout).contains(" + rest "));
    assert_eq!(part.status.code(), Some(1));
    desk.render("", "none.exr");
    let none = told("none.exr --page none.html");
    assert_eq!(none.status.code(), Some(2));
    assert!(err(&none).contains("none.exr has no layers of light") && !desk.path("none.html").exists());
}

#[test]
fn statistics_go_to_standard_output_alone() {
    let desk = Desk::with_ball("json");
    let output = desk.tyndall("render ball.pbrt --quiet --json - --max-depth 2");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", err(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["paths"], 24 * 18 * 4);
    assert_eq!(json["ended"], "complete");
    for name in ["rays", "shadow_rays", "collisions", "mean_path_length", "ns_per_collision", "energy_lost_to_limit"] {
        assert!(json[name].as_f64().unwrap() > 0.0, "{name} in {json:#}");
    }
    assert_eq!(json["non_finite_samples"], 0);
    let mean = json["image"]["rgb"][1].as_f64().unwrap();
    assert!(mean > 0.01 && json["image"]["standard_error"][1].as_f64().unwrap() < 0.2 * mean, "{json:#}");
}

#[test]
fn a_limit_of_time_ends_the_render_with_an_image() {
    let desk = Desk::with_ball("time");
    let image = desk.render("--time 300ms", "a.exr");
    let taken = image.metadata.unwrap().samples_per_pixel;
    assert!(taken > 1.0, "{taken} samples a pixel");
}

#[test]
fn two_renders_agree_and_a_brighter_one_does_not() {
    let desk = Desk::with_ball("compare");
    desk.render("--spp 64 --sampler independent", "a.exr");
    desk.render("--spp 64 --sampler independent --seed 1", "b.exr");
    fs::write(desk.path("ball.pbrt"), SCENE.replace("0.3 0.4 0.6", "0.32 0.43 0.64")).unwrap();
    desk.render("--spp 64 --sampler independent --seed 2", "c.exr");

    let agree = desk.tyndall("compare a.exr b.exr --check --json -");
    assert_eq!(agree.status.code(), Some(0), "{}", out(&agree));
    let json: serde_json::Value = serde_json::from_slice(&agree.stdout).unwrap();
    assert_eq!(json["verdict"], "agree");

    let differ = desk.tyndall("compare a.exr c.exr --check --diff diff.png");
    assert_eq!(differ.status.code(), Some(1), "{}", out(&differ));
    assert!(out(&differ).contains("DIFFER"));
    assert!(desk.path("diff.png").exists());
    assert!(out(&desk.tyndall("compare a.exr a.exr --check")).contains("identical"));
}

#[test]
fn ctrl_c_leaves_the_image_so_far() {
    let desk = Desk::with_ball("interrupt");
    let child = desk.command("render ball.pbrt --spp 4000000000 -o a").stderr(Stdio::piped()).spawn().unwrap();
    // Long enough that the first passes are done on a loaded machine; the first image is there within milliseconds.
    std::thread::sleep(Duration::from_millis(1500));
    // Twice at once, as `timeout` and some terminals do: still one wish.
    for _ in 0..2 {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    }
    let begun = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(begun.elapsed() < Duration::from_secs(20));
    assert_eq!(output.status.code(), Some(130), "{}", err(&output));
    assert!(err(&output).contains("a.exr and a.png"), "{}", err(&output));
    assert_eq!(left_behind(&desk), ["a.exr", "a.png"]);
    let image = exr::read(&desk.path("a.exr")).unwrap();
    assert!(image.metadata.unwrap().samples_per_pixel > 1.0);
}

#[test]
fn info_tells_media_by_their_lengths() {
    let desk = Desk::with_ball("info");
    let output = desk.tyndall("info ball.pbrt");
    assert!(output.status.success(), "{}", err(&output));
    // 1/(0.5 + 0.05) = 1.8182; 1/(0.05 + 0.5·0.5) = 3.3333.
    for words in ["24x18", "fog", "1.8182", "3.3333"] {
        assert!(out(&output).contains(words), "no {words} in\n{}", out(&output));
    }
}

#[test]
fn other_resolutions_show_the_same_picture() {
    let desk = Desk::with_ball("resolution");
    let image = desk.render("--resolution 12x9", "a.exr");
    assert_eq!((image.width, image.height), (12, 9));
    assert!(Path::new(&desk.path("a.exr")).exists());
}

/// Seventeen samples a pixel of everything in a few pixels: what counts is that all of it is there.
#[test]
fn the_lecture_leaves_images_a_contact_sheet_a_plot_and_a_table() {
    let desk = Desk::with_ball("lecture");
    let output = desk.tyndall("lecture --spp 2 --reference-spp 16 --resolution 16x16 --out slides");
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(out(&output).lines().count(), 1 + 8);
    for name in ["contact-sheet.png", "error-against-time.svg", "error-against-time.png", "table.md", "surface.pbrt"] {
        assert!(desk.path("slides").join(name).exists(), "no {name}");
    }
    let table = fs::read(desk.path("slides/table.json")).unwrap();
    let rows: Vec<serde_json::Value> = serde_json::from_slice(&table).unwrap();
    assert_eq!(rows.len(), 8);
    assert!(rows.iter().all(|row| row["efficiency"].is_f64()), "{rows:#?}");
    let reference = exr::read(&desk.path("slides/volume-reference.exr")).unwrap();
    let estimate = exr::read(&desk.path("slides/volume-version-0.75-equal-time.exr")).unwrap();
    assert_eq!(reference.mean.len(), estimate.mean.len());
}

/// The ball's filter is the one that pbrt takes by default, which Mitsuba does not have: with another one it is the same image.
#[test]
fn a_scene_in_the_other_language_is_the_same_image() {
    let desk = Desk::with_ball("convert");
    fs::write(desk.0.join("ball.pbrt"), format!("PixelFilter \"box\"\n{SCENE}")).unwrap();
    for arguments in ["convert ball.pbrt ball.xml", "convert ball.xml back.pbrt"] {
        let output = desk.tyndall(arguments);
        assert!(output.status.success(), "{arguments}: {}", err(&output));
    }
    let first = desk.render("--quiet", "first.exr");
    for scene in ["ball.xml", "back.pbrt"] {
        let output = desk.tyndall(&format!("render {scene} --quiet -o other.exr"));
        assert!(output.status.success(), "{scene}: {}", err(&output));
        let other = exr::read(&desk.0.join("other.exr")).unwrap();
        assert_eq!(first.mean, other.mean, "{scene}");
    }
}

#[test]
fn what_the_other_language_has_no_word_for_is_refused_where_it_stands_or_left_out_with_a_comment() {
    let desk = Desk::with_ball("convert-lenient");
    let scene = SCENE.replace("Camera \"perspective\" \"float fov\" 40", "PixelFilter \"sinc\"");
    fs::write(desk.0.join("ball.pbrt"), scene).unwrap();
    let refused = desk.tyndall("convert ball.pbrt ball.xml");
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("Mitsuba has no word for a filter of these radii"), "{}", err(&refused));
    assert!(err(&refused).contains("ball.pbrt:2:"), "{}", err(&refused));
    assert!(!desk.0.join("ball.xml").exists());
    assert!(desk.tyndall("convert ball.pbrt ball.xml --lenient").status.success());
    let text = fs::read_to_string(desk.0.join("ball.xml")).unwrap();
    assert!(text.starts_with("<!-- From ball.pbrt") && text.contains("no word for a filter of these radii"), "{text}");
}

#[test]
fn a_scene_is_never_written_over_itself() {
    let desk = Desk::with_ball("convert-itself");
    let before = fs::read(desk.0.join("ball.pbrt")).unwrap();
    let refused = desk.tyndall("convert ball.pbrt ./ball.pbrt");
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("is part of the scene that is read"), "{}", err(&refused));
    assert_eq!(fs::read(desk.0.join("ball.pbrt")).unwrap(), before);
}

#[test]
fn a_scene_with_missing_pictures_is_told_about_and_rendered_without_what_it_does_not_need() {
    let desk = Desk::with_ball("missing");
    let scene = |texture: &str| {
        let bark = "Texture \"bark\" \"spectrum\" \"imagemap\" \"string filename\" \"no-such.png\"";
        let text = SCENE.replace("WorldBegin", &format!("WorldBegin\n{bark}\n{texture}"));
        fs::write(desk.0.join("bark.pbrt"), text).unwrap();
    };
    scene("");
    let rendered = desk.tyndall("render bark.pbrt --spp 1 -o bark.exr");
    assert!(rendered.status.success(), "{}", err(&rendered));
    assert!(err(&rendered).contains("\"bark\" is missing"), "{}", err(&rendered));
    scene("Material \"diffuse\" \"texture reflectance\" \"bark\" Shape \"sphere\"");
    assert_eq!(desk.tyndall("render bark.pbrt --spp 1 -o bark.exr").status.code(), Some(2));
    assert!(desk.tyndall("render bark.pbrt --lenient --spp 1 -o bark.exr").status.success());
    let told = desk.tyndall("info bark.pbrt");
    assert!(told.status.success() && err(&told).contains("\"bark\" is missing"), "{}", err(&told));
}

#[test]
fn what_lies_beside_a_converted_scene_replaces_no_file_of_others() {
    let desk = Desk::with_ball("beside");
    let triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]";
    fs::write(desk.0.join("ball.pbrt"), format!("{SCENE}\n{triangle}\n")).unwrap();
    let mesh = desk.0.join("there-mesh.ply");
    fs::write(&mesh, "mine").unwrap();
    let refused = desk.tyndall("convert ball.pbrt there.xml");
    assert_eq!(refused.status.code(), Some(2), "{}", err(&refused));
    assert!(err(&refused).contains("there-mesh.ply is there already"), "{}", err(&refused));
    assert!(fs::read(&mesh).unwrap() == b"mine" && !desk.0.join("there.xml").exists());
    fs::remove_file(&mesh).unwrap();
    // What an earlier call left is replaced.
    assert!(desk.tyndall("convert ball.pbrt there.xml").status.success());
    fs::write(desk.0.join("ball.pbrt"), format!("{SCENE}\n{}\n", triangle.replace("0 1 0]", "0 2 0]"))).unwrap();
    let again = desk.tyndall("convert ball.pbrt there.xml");
    assert!(again.status.success(), "{}", err(&again));
}

/// `tyndall materials | head`: who has read enough goes away, and that is no fault of the program.
#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let desk = Desk::new("pipe");
    fs::write(desk.0.join("scene.pbrt"), SCENE).unwrap();
    for arguments in [
        &["layers"][..],
        &["layers", "--explain", "orders:2"],
        &["materials"],
        &["mix", "milk", "--fat", "3.5"],
        &["mix", "milk", "--fat", "3.5", "--json", "-"],
        &["pack", "sphere:8", "--radius", "1", "--count", "5"],
        &["info", "scene.pbrt"],
        &["convert", "scene.pbrt", "scene.xml"],
        &["render", "scene.pbrt", "--spp", "1", "--json", "-"],
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = desk.program().args(arguments).stdout(writer).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
    }
}
