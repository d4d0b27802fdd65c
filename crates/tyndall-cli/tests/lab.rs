//! The instruments as a user meets them: files, words, exit status.

mod common;

use std::{fs, process::Output};

use common::Desk;
use tyndall_formats::film::{Image, exr};

impl Desk {
    fn lab(&self, arguments: &[&str]) -> Output {
        self.program().arg("lab").args(arguments).output().unwrap()
    }

    /// What a measurement that must work says on standard output.
    fn measure(&self, arguments: &[&str]) -> String {
        let output = self.lab(arguments);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{arguments:?}: {told}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn image(&self, name: &str) -> Image {
        exr::read(&self.0.join(name)).unwrap()
    }
}

#[test]
fn a_beam_leaves_a_table_a_plot_and_a_picture() {
    let desk = Desk::new("beam");
    let marble = ["beam", "--material", "marble", "--photons", "2000", "--pixels", "16"];
    let files = ["--cube", "40mm", "--picture", "cube", "--csv", "r.csv", "--json", "r.json", "--plot", "r.svg"];
    let table = desk.measure(&[&marble[..], &files].concat());
    for word in ["a cube of 40 mm of marble", "returned, green", "photon beam diffusion", "classical dipole", "better"]
    {
        assert!(table.contains(word), "{word}: {table}");
    }
    let picture = desk.image("cube.exr");
    let brightest = (0..256).max_by(|a, b| picture.mean[*a][0].total_cmp(&picture.mean[*b][0])).unwrap();
    assert!([7, 8].contains(&(brightest % 16)) && [7, 8].contains(&(brightest / 16)), "{brightest}");
    assert!(picture.standard_error.is_some() && desk.0.join("cube.png").exists());
    let csv = fs::read_to_string(desk.0.join("r.csv")).unwrap();
    assert!(csv.contains("\"R(r), red\"") || csv.contains("R(r), red"), "{csv}");
    assert!(fs::read_to_string(desk.0.join("r.json")).unwrap().contains("better dipole"));
    assert!(fs::read_to_string(desk.0.join("r.svg")).unwrap().contains("<svg"));
}

/// The same photons give the same figures on any number of threads.
#[test]
fn figures_do_not_depend_on_the_number_of_threads() {
    let desk = Desk::new("threads");
    let run = |threads| {
        let medium = ["beam", "--sigma-s", "2", "--sigma-a", "0.1", "--g", "0.5", "--slab", "1mm", "--photons", "5000"];
        desk.measure(&[&medium[..], &["--threads", threads, "--json", "-"]].concat())
    };
    assert_eq!(run("1"), run("3"));
}

const SCENE: &str = r#"
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "distant" "rgb L" [ 9 1 1 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 1 1 ] "rgb sigma_a" [ 0.5 0.5 0.5 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.5 0.1 0.1 ]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 1
AttributeEnd
NamedMaterial "red"
Translate 0 0 0
Shape "sphere" "float radius" 0.3
"#;

#[test]
fn a_furnace_tells_what_takes_the_light() {
    let desk = Desk::new("furnace");
    fs::write(desk.0.join("s.pbrt"), SCENE).unwrap();
    let told = desk.measure(&["furnace", "s.pbrt", "--photons", "20000", "--picture", "f"]);
    for word in ["taken by material red", "taken by medium fog", "Energy is lost", "none is made"] {
        assert!(told.contains(word), "{word}: {told}");
    }
    let deviation = desk.image("f.exr");
    assert!(deviation.mean[8 * 16 + 8][0] < -0.3 && deviation.mean[0][0].abs() < 1e-5, "{:?}", deviation.mean[0]);
    let told = desk.measure(&["furnace", "s.pbrt", "--photons", "20000", "--lossless"]);
    assert!(told.contains("taken by material red") && !told.contains("taken by medium fog"), "{told}");
    let told =
        desk.measure(&["furnace", "--material", "marble", "--radius", "1mm", "--lossless", "--resolution", "8x8"]);
    assert!(told.contains("Energy is kept"), "{told}");
}

/// A sheet that reflects 0.52 and transmits 0.5 makes energy: the furnace says so by its exit status too.
#[test]
fn a_furnace_finds_energy_that_is_made() {
    let desk = Desk::new("made");
    let scene = r#"
        Film "rgb" "integer xresolution" 16 "integer yresolution" 16
        LookAt 0 0 -4  0 0 0  0 1 0
        Camera "perspective" "float fov" 30
        WorldBegin
        Material "diffusetransmission" "rgb reflectance" [ 0.52 0.5 0.5 ] "rgb transmittance" [ 0.5 0.5 0.5 ]
        Shape "disk" "float radius" 0.5
    "#;
    fs::write(desk.0.join("s.pbrt"), scene).unwrap();
    let output = desk.lab(&["furnace", "s.pbrt", "--photons", "30000"]);
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1), "{told}{}", String::from_utf8_lossy(&output.stderr));
    assert!(told.contains("Energy is MADE"), "{told}");
}

#[test]
fn a_goniometer_compares_sampling_with_evaluation() {
    let desk = Desk::new("gonio");
    fs::write(desk.0.join("s.pbrt"), SCENE).unwrap();
    let few = ["--photons", "20000", "--rows", "8"];
    let told = desk.measure(&[&["gonio", "s.pbrt", "--material", "red", "--picture", "m"], &few[..]].concat());
    assert!(told.contains("Sampling and evaluation agree"), "{told}");
    let map = desk.image("m.exr");
    assert_eq!((map.width, map.height), (16, 8));
    // 0.5 cos/π in the first row, whose mean cosine is 7/8; nothing below.
    let mean = map.mean[..16].iter().map(|p| p[0]).sum::<f32>() / 16.0;
    assert!((mean / (0.5 * 0.875 * std::f32::consts::FRAC_1_PI) - 1.0).abs() < 0.1, "{mean}");
    assert!(map.mean[64..].iter().all(|p| *p == [0.0; 3]));
    let metal = "conductor \"float roughness\" 0.3";
    let told = desk.measure(&[&["gonio", "--material", metal, "--angle", "40", "--plot", "p.png"], &few[..]].concat());
    assert!(told.contains("agree") && desk.0.join("p.png").exists(), "{told}");
    let told = desk.measure(&[&["gonio", "s.pbrt", "--medium", "fog"], &few[..]].concat());
    assert!(told.contains("mean cosine") && told.contains("agree"), "{told}");
    let told = desk.measure(&[&["gonio", "--grain", "n=1.5 sigma_a=0.1"], &few[..]].concat());
    assert!(told.contains("exact 0.841596") && told.contains("exact 0.660274"), "{told}");
}

/// Whatever is asked for wrongly is told with exit status 2, and nothing is overwritten.
#[test]
fn what_cannot_be_measured_is_refused() {
    let desk = Desk::new("hostile");
    fs::write(desk.0.join("kept.csv"), "mine").unwrap();
    fs::write(desk.0.join("s.pbrt"), SCENE).unwrap();
    fs::write(desk.0.join("junk.ply"), [0u8, 159, 146, 150, 10, 255]).unwrap();
    fs::create_dir(desk.0.join("dir.exr")).unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["beam", "--material", "chocolat"], "no material `chocolat`"),
        (&["beam", "--sigma-s", "-1", "--csv", "kept.csv"], "at least 0"),
        (&["beam", "--sigma-s", "nan", "--csv", "kept.csv"], "expected a number"),
        (&["beam", "--sigma-s", "1", "--g", "1", "--csv", "kept.csv"], "mean cosine"),
        (&["beam", "--sigma-s", "1", "--n", "NaN"], "refractive index"),
        (&["beam", "--sigma-a", "0"], "nothing"),
        (&["beam"], "required"),
        (&["beam", "--material", "marble", "--cube", "-1mm"], "length"),
        (&["beam", "--material", "marble", "--cube", "0"], "edge of the box"),
        (&["beam", "--material", "marble", "--cube", "1", "--slab", "1"], "cannot be used with"),
        (&["beam", "--material", "marble", "--box", "1,2"], "3"),
        (&["beam", "--material", "marble", "--mesh", "junk.ply"], "junk.ply"),
        (&["beam", "--material", "marble", "--mesh", "none.ply"], "none.ply"),
        (&["beam", "--material", "marble", "--acceptance", "95", "--picture", "x"], "acceptance"),
        (&["beam", "--material", "marble", "--picture", "nowhere/x.exr"], "nowhere"),
        (&["beam", "--material", "marble", "--picture", "dir.exr"], "dir.exr"),
        (&["beam", "--material", "marble", "--plot", "x.pdf"], "svg or .png"),
        (&["beam", "--material", "marble", "--json", "nowhere/x.json"], "nowhere/x.json"),
        (&["furnace"], "required"),
        (&["furnace", "none.pbrt"], "none.pbrt"),
        (&["furnace", "s.pbrt", "--color", "spectral"], "grey"),
        (&["furnace", "--material", "nosuchthing"], "nosuchthing"),
        (&["furnace", "--material", "marble", "--radius", "0"], "above zero"),
        (&["gonio"], "required"),
        (&["gonio", "s.pbrt", "--material", "blue"], "it has: red"),
        (&["gonio", "--material", "diffuse \"float reflectence\" 1"], "reflectence"),
        (&["gonio", "--phase", "1.5"], "between -1 and 1"),
        (&["gonio", "--phase", "nan"], "between -1 and 1"),
        (&["gonio", "--grain", "n=-1"], "refractive index"),
        (&["gonio", "--grain", "n=1.5 d=2"], "no `d`"),
        (&["gonio", "--grain", "n=1.5", "--mesh", "junk.ply"], "junk.ply"),
        (&["gonio", "--phase", "0.5", "--angle", "90"], "less than 90"),
        (&["gonio", "--phase", "0.5", "--rows", "1"], "2..=256"),
    ];
    for (arguments, told) in cases {
        let output = desk.lab(arguments);
        let says = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {says}");
        assert!(says.contains(told), "{arguments:?} should tell `{told}`: {says}");
        assert!(!says.contains("panicked"), "{arguments:?}: {says}");
    }
    assert_eq!(fs::read_to_string(desk.0.join("kept.csv")).unwrap(), "mine");
    let mut left: Vec<_> = fs::read_dir(&desk.0).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["dir.exr", "junk.ply", "kept.csv", "s.pbrt"]);
}
