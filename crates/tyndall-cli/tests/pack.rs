//! Packs of grains from the command line to a picture.

mod common;

use std::process::Output;

use common::Desk;
use tyndall::{math::Vec3, shape::ObjectId, spectrum::ColorMode};
use tyndall_formats::error::Unsupported;

fn tyndall(desk: &Desk, arguments: &[&str]) -> Output {
    desk.program().args(arguments).output().unwrap()
}

#[test]
fn a_pack_renders_at_once_and_is_the_same_again() {
    let desk = Desk::new("pack");
    for name in ["a.pbrt", "b.pbrt"] {
        let packed = tyndall(&desk, &["pack", "sphere:8", "--radius", "1", "--count", "40", "-o", name]);
        let told = String::from_utf8_lossy(&packed.stdout);
        assert!(packed.status.success() && told.contains("packing fraction   0.0781"), "{packed:?}");
    }
    let scene = std::fs::read_to_string(desk.0.join("a.pbrt")).unwrap();
    assert_eq!(scene.matches("ObjectInstance").count(), 40);
    assert_eq!(scene, std::fs::read_to_string(desk.0.join("b.pbrt")).unwrap());
    let rendered = tyndall(&desk, &["render", "a.pbrt", "--spp", "1"]);
    assert!(rendered.status.success(), "{rendered:?}");
}

/// A cube, closed, seen from outside.
const CUBE: &str = "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nv -4 -4 8\nv 4 -4 8\nv 4 4 8\nv -4 4 8\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[test]
fn grains_of_any_shape_settle_in_a_mesh_and_render() {
    let desk = Desk::new("pack-settle");
    std::fs::write(desk.0.join("jar.obj"), CUBE).unwrap();
    for (grain, shape) in [("ellipsoid:1:1:2", "Shape \"sphere\""), ("jar.obj", "trianglemesh")] {
        let settle = ["--settle", "--count", "12", "--radius", "0.9", "--material", "green", "-o", "s.pbrt"];
        let packed = tyndall(&desk, &[&["pack", "jar.obj", "--grain", grain], &settle[..]].concat());
        let told = String::from_utf8_lossy(&packed.stdout);
        // 12 · 4π/3 · 0.9³ / 512
        assert!(packed.status.success() && told.contains("packing fraction   0.0715"), "{packed:?}");
        assert!(told.contains("at rest") && told.contains("0 taken out"), "{told}");
        let scene = std::fs::read_to_string(desk.0.join("s.pbrt")).unwrap();
        assert!(scene.contains(shape) && scene.contains("Rotate") && scene.contains("sigma_a"), "{scene}");
        assert_grains_are_within(&desk, "s.pbrt", Vec3::ZERO);
        let rendered = tyndall(&desk, &["render", "s.pbrt", "--spp", "1"]);
        assert!(rendered.status.success(), "{rendered:?}");
    }
}

#[test]
fn grains_alone_stand_wherever_a_scene_includes_them() {
    let desk = Desk::new("pack-bare");
    std::fs::write(desk.0.join("jar.obj"), CUBE).unwrap();
    let salt = ["--count", "12", "--radius", "0.9", "--material", "green", "--bare", "-o", "my \"salt\".pbrt.gz"];
    let packed = tyndall(&desk, &[&["pack", "jar.obj", "--settle"], &salt[..]].concat());
    assert!(packed.status.success(), "{packed:?}");
    std::fs::rename(desk.0.join("my \"salt\".pbrt.gz"), desk.0.join("salt.pbrt.gz")).unwrap();
    let scene = r#"WorldBegin Translate 10 20 30 Include "salt.pbrt.gz" ObjectInstance "my__salt_""#;
    std::fs::write(desk.0.join("twice.pbrt"), scene).unwrap();
    let again = tyndall(&desk, &["info", "twice.pbrt"]);
    assert!(String::from_utf8_lossy(&again.stdout).contains("13 instances"), "{again:?}");
    std::fs::write(desk.0.join("once.pbrt"), r#"WorldBegin Translate 10 20 30 Include "salt.pbrt.gz""#).unwrap();
    assert_grains_are_within(&desk, "once.pbrt", Vec3::new(10.0, 20.0, 30.0));
}

/// The scene's last object is placed twelve times, its centre nowhere nearer to a wall of the cube than it can be: by half an edge
/// of a cube with the volume of a ball of radius 0.9, or by the short half axis of the ellipsoid.
fn assert_grains_are_within(desk: &Desk, scene: &str, shift: Vec3) {
    const NEAREST: f32 = 0.71;
    let (min, max) = (Vec3::new(-4.0, -4.0, 0.0) + shift, Vec3::new(4.0, 4.0, 8.0) + shift);
    let (desc, sources) = tyndall_formats::load(&desk.0.join(scene), &[], Unsupported::Refuse).unwrap();
    let (scene, _) = tyndall_formats::build::build(&desc, sources, ColorMode::Rgb).unwrap();
    let grain = ObjectId(scene.objects.len() as u32 - 1);
    assert_eq!(scene.geometry.placed_bounds(grain).count(), 12);
    for grain in scene.geometry.placed_bounds(grain) {
        let centre = 0.5 * (grain.min + grain.max);
        assert!((min + NEAREST).cmple(centre).all() && (centre + NEAREST).cmple(max).all(), "{centre}");
    }
}

#[test]
fn what_cannot_be_packed_ends_with_status_2() {
    let desk = Desk::new("pack-hostile");
    for (container, radius, count) in
        [("sphere:1", "2", "5"), ("sphere:NaN", "1", "5"), ("box:1:1:1", "0", "5"), ("box:9:9:9", "1", "99999999999")]
    {
        let packed = tyndall(&desk, &["pack", container, "--radius", radius, "--count", count, "-o", "x.pbrt"]);
        assert_eq!(packed.status.code(), Some(2), "{packed:?}");
        assert!(!desk.0.join("x.pbrt").exists());
    }
    std::fs::write(desk.0.join("open.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["open.obj"], "is not closed"),
        (&["none.ply"], "none.ply"),
        (&["box:9:9:9", "--grain", "open.obj"], "is not closed"),
        (&["box:9:9:9", "--grain", "ellipsoid:1:1:99"], "at most 10 times"),
        (&["box:9:9:9", "--grain", "ellipsoid:1:1:nan"], "axes of a grain"),
        (&["box:9:9:9", "--friction", "0.1"], "--settle"),
        (&["box:9:9:9", "--settle", "--friction", "nan"], "friction"),
        (&["box:9:9:9", "--settle", "--count", "400000"], "at most 300 thousand"),
        (&["box:9:9:9", "--settle", "--radius", "lognormal:0.1:0.9"], "tenfold"),
    ];
    for (arguments, told) in cases {
        let radius: &[&str] = if arguments.contains(&"--radius") { &[] } else { &["--radius", "1"] };
        let packed = tyndall(&desk, &[&["pack"], *arguments, radius, &["-o", "x.pbrt"]].concat());
        let says = String::from_utf8_lossy(&packed.stderr);
        assert_eq!(packed.status.code(), Some(2), "{arguments:?}: {says}");
        assert!(says.contains(told) && !says.contains("panicked"), "{arguments:?} should tell `{told}`: {says}");
        assert!(!desk.0.join("x.pbrt").exists());
    }
}
