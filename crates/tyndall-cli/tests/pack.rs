//! Packs of grains from the command line to a picture.

mod common;

use std::process::Output;

use common::Desk;

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
}
