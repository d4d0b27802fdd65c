//! Direct and global light apart by patterns: where the method is exact, and where it fails.

mod common;

use common::Desk;
use serde_json::Value;

/// A scene of 32 × 32 pixels before a pinhole that sees a window of ±0.5 at distance 1, from z = 4 down to the origin.
fn scene(world: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n\
         LookAt 0 0 4  0 0 0  0 1 0\n\
         PixelFilter \"box\"\nCamera \"perspective\" \"float fov\" 53.130102\n\
         WorldBegin\n{world}\n"
    )
}

/// A square of the plane z = 0.
const FLOOR: &str = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.5 0.2]\n\
     Shape \"bilinearmesh\" \"point3 P\" [-3 -3 0  3 -3 0  -3 3 0  3 3 0]";

/// Separates it, and returns what the program says of each pattern.
fn separate(desk: &Desk, world: &str, arguments: &[&str]) -> Vec<Value> {
    std::fs::write(desk.0.join("scene.pbrt"), scene(world)).unwrap();
    let common = ["separate", "scene.pbrt", "--pixels", "256x256", "--json", "-", "--quiet", "-o", "out"];
    let output = desk.program().args(common).args(arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Mean and standard error of a figure.
fn figure(figures: &Value, name: &str) -> [f64; 2] {
    ["mean", "standard_error"].map(|part| figures[name][part].as_f64().unwrap())
}

/// A flat floor sees nothing of itself: all of its light is direct, by squares and by waves, with dark pixels that shine a
/// little too. Its light has no noise but what anti-aliasing makes.
#[test]
fn on_a_flat_floor_all_light_is_direct() {
    let desk = Desk::new("floor");
    let squares: &[&str] = &["--spp", "4", "--square", "32", "--dark", "0.2"];
    let waves: &[&str] = &["--spp", "16", "--pattern", "waves", "--period", "128"];
    // A pixel sees 1/18 of a wave: the mean over it lowers the amplitude by sinc(π/18), half a percent.
    for (arguments, bound) in [(squares, 1e-4), (waves, 0.006)] {
        let found = &separate(&desk, FLOOR, arguments)[0];
        let [direct, _] = figure(found, "separated_direct");
        let [truth, _] = figure(found, "true_direct");
        let [global, _] = figure(found, "separated_global");
        assert!(truth > 0.1 && figure(found, "true_global")[0].abs() < 1e-6 * truth, "{found:#}");
        assert!((direct / truth - 1.0).abs() < bound && global.abs() < bound * truth, "{found:#}");
    }
    assert!(desk.0.join("out.exr").exists() && desk.0.join("out.png").exists());
}

/// Between two white planes at a right angle a tenth of the light is global, and smooth: squares of two pixels tell it, to 0.2 % of
/// all light and better.
#[test]
fn between_planes_fine_squares_tell_the_truth() {
    let desk = Desk::new("planes");
    let planes = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n\
         Shape \"bilinearmesh\" \"point3 P\" [-2 -3 1  -0.5 -3 -0.5  -2 3 1  -0.5 3 -0.5]\n\
         Shape \"bilinearmesh\" \"point3 P\" [0.5 -3 -0.5  2 -3 1  0.5 3 -0.5  2 3 1]";
    let found = &separate(&desk, planes, &["--spp", "256", "--square", "16"])[0];
    let all = found["all"].as_f64().unwrap();
    for part in ["direct", "global"] {
        let [truth, e1] = figure(found, &format!("true_{part}"));
        let [told, e2] = figure(found, &format!("separated_{part}"));
        let error = e1.hypot(e2);
        assert!(truth > 0.08 * all && error < 0.002 * all && (told - truth).abs() < 4.0 * error, "{part}: {found:#}");
    }
}

/// What scatters in a body within the size of a square counts as direct, and in truth nothing does: the finer the squares,
/// the nearer to the truth.
#[test]
fn translucent_bodies_need_patterns_finer_than_their_blur() {
    let desk = Desk::new("milk");
    let slab = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.01 0.01 0.01] \"rgb sigma_s\" [2 2 2]\n\
         MediumInterface \"m\" \"\"\nMaterial \"interface\"\n\
         Translate 0 0 -4 Scale 4 4 4\n\
         Shape \"sphere\"";
    let share = |square: &str| {
        let found = &separate(&desk, slab, &["--spp", "16", "--square", square])[0];
        assert_eq!(figure(found, "true_direct")[0], 0.0);
        let [direct, error] = figure(found, "separated_direct");
        [direct, error].map(|x| x / found["all"].as_f64().unwrap())
    };
    let ([coarse, e1], [fine, e2]) = (share("64"), share("16"));
    assert!(coarse > 0.3 && coarse - fine > 5.0 * e1.hypot(e2) && fine < 0.8 * coarse, "{coarse} {fine}");
}

#[test]
fn what_cannot_be_projected_ends_with_status_2() {
    let desk = Desk::new("hostile");
    std::fs::write(desk.0.join("scene.pbrt"), scene(FLOOR)).unwrap();
    for arguments in [
        ["--square", "0"],
        ["--dark", "1"],
        ["--dark", "nan"],
        ["--projector", "scene"],
        ["--phases", "x"],
        ["--pixels", "9999x9999"],
        ["--offset", "1,2"],
        ["--shifts", "2"],
        ["--square", "4294967295"],
        ["--resolution", "65536x65536"],
        ["-o", "nowhere/out"],
    ] {
        let output = desk.program().args(["separate", "scene.pbrt", "--spp", "4"]).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    }
    assert_eq!(std::fs::read_dir(&desk.0).unwrap().count(), 1, "nothing but the scene");
}
