//! `tyndall render --adaptive` as a user meets it.

mod common;

use std::fs;

use common::Desk;
use serde_json::Value;

/// A lamp that one half of the picture sees and the other does not.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 32 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
LookAt 0 6 0  0 0 0  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
  Translate -3 1 0
  Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]
Shape "bilinearmesh" "point3 P" [ 0 0 -9  0 0 9  0 4 -9  0 4 9 ]
"#;

fn report(desk: &Desk, arguments: &[&str]) -> Value {
    let mut command = desk.program();
    command.args(["render", "scene.pbrt", "--json", "-", "--quiet", "-o", "image.exr"]).args(arguments);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path} in {report}"))
}

/// As many samples as asked for, to the rounding of each pixel's share (half a sample at most); the mean of the picture the same
/// within four standard errors, and its noise less: one half of it is dark and needs no samples.
#[test]
fn as_many_samples_make_a_better_picture_of_the_same_light() {
    let desk = Desk::new("adaptive");
    fs::write(desk.0.join("scene.pbrt"), SCENE).unwrap();
    let even = report(&desk, &["--spp", "64"]);
    let adaptive = report(&desk, &["--spp", "64", "--adaptive", "--seed", "1"]);
    assert_eq!(number(&even, "/spp"), 64.0);
    assert!((number(&adaptive, "/spp") - 64.0).abs() < 0.5, "{adaptive}");
    let [a, b] = [&even, &adaptive].map(|r| number(r, "/image/rgb/1"));
    let [s, t] = [&even, &adaptive].map(|r| number(r, "/image/standard_error/1"));
    assert!((a - b).abs() < 4.0 * s.hypot(t), "{a} ± {s}, {b} ± {t}");
    let [even, adaptive] = [&even, &adaptive].map(|r| number(r, "/relative_error"));
    assert!(adaptive < 0.9 * even, "{adaptive} of {even}");
}

/// Where time says how long, there are as many samples as it gives: more than the eight of the first look, which are even.
#[test]
fn samples_are_shared_out_until_time_is_up() {
    let desk = Desk::new("adaptive-time");
    fs::write(desk.0.join("scene.pbrt"), SCENE).unwrap();
    let timed = report(&desk, &["--time", "300ms", "--adaptive"]);
    assert_eq!(timed["ended"], "time");
    assert!(number(&timed, "/spp") > 8.0, "{timed}");
}
