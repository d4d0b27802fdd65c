//! Grains and their proxy in both scene languages, and what is told where they cannot be.

use std::path::Path;

use tyndall::{granular::Granular, scene::Scene, spectrum::ColorMode};
use tyndall_formats::{build::build, error::Diagnostics, mitsuba, pbrt};

fn scene(text: &str) -> Result<Scene, Diagnostics> {
    let (desc, sources) = pbrt::parse(Path::new("scene.pbrt"), text)?;
    Ok(build(&desc, sources, ColorMode::Rgb)?.0)
}

/// A ball of glass, placed twice, and what stands for it.
const HEAP: &str = r#"
    ObjectBegin "grain" Material "dielectric" Shape "sphere" "string granular" "grain" ObjectEnd
    ObjectInstance "grain" Translate 3 0 0 ObjectInstance "grain"
    MakeNamedMedium "dust" "string type" "homogeneous"
    Material "interface" MediumInterface "dust" "" Shape "sphere" "float radius" 9 "string granular" "proxy""#;

#[test]
fn both_languages_have_grains_and_their_proxy() {
    let scene = scene(&format!("Integrator \"volpath\" \"integer explicitgrains\" 2\nWorldBegin\n{HEAP}")).unwrap();
    let roles = |scene: &Scene| scene.objects.iter().filter_map(|o| o.granular).collect::<Vec<_>>();
    assert_eq!(roles(&scene), [Granular::Proxy, Granular::Grain]);
    let bounds = |scene: &Scene| scene.geometry.bounds().extent().x.round();
    // Two balls, 3 apart; a ball of radius 9.
    assert_eq!((bounds(&scene), bounds(scene.proxied().unwrap())), (5.0, 18.0));
    let text = r#"<scene version="3.0.0"><sensor type="perspective"/>
        <integrator type="volpath"><integer name="explicit_grains" value="2"/></integrator>
        <shape type="sphere"><string name="granular" value="grain"/><bsdf type="dielectric"/></shape>
        <shape type="cube"><string name="granular" value="proxy"/><bsdf type="null"/>
          <medium name="interior" type="homogeneous"/></shape></scene>"#;
    let (desc, sources) = mitsuba::parse(Path::new("scene.xml"), text, &[]).unwrap();
    assert_eq!(desc.integrator.explicit_grains.map(|grains| grains.value), Some(2));
    let scene = build(&desc, sources, ColorMode::Rgb).unwrap().0;
    assert_eq!(roles(&scene), [Granular::Grain, Granular::Proxy]);
    assert!(scene.proxied().is_some());
}

/// Each fault is told, at its line and column.
#[test]
fn what_is_no_grain_or_no_proxy_is_told() {
    let grain = "Material \"dielectric\" Shape \"sphere\" \"string granular\" \"grain\"";
    let medium = "MakeNamedMedium \"dust\" \"string type\" \"homogeneous\"";
    let proxy = "Material \"interface\" MediumInterface \"dust\" \"\"";
    let ball = "Shape \"sphere\" \"string granular\"";
    let lamp = "AreaLightSource \"diffuse\"";
    let cases = [
        (format!("{ball} \"grian\""), "\"grian\"", "did you mean \"grain\""),
        (format!("{proxy} {ball} \"proxy\""), "\"proxy\"", "there are none"),
        (format!("{grain} {lamp} {ball} \"grain\""), "\"grain\"", "do not shine"),
        (format!("{grain} {ball} \"grain\" \"integer priority\" 1"), "\"grain\"", "no priority"),
        (format!("Material \"interface\" {ball} \"grain\""), "\"grain\"", "light passes this grain unchanged"),
        (
            format!("Material \"diffuse\" {ball} \"grain\" \"float alpha\" 0.5"),
            "\"grain\"",
            "light passes this grain unchanged",
        ),
        ("Shape \"disk\" \"string granular\" \"grain\"".to_owned(), "\"grain\"", "are closed"),
        (format!("ReverseOrientation {ball} \"grain\""), "\"grain\"", "are closed"),
        (format!("{grain} {proxy} Material \"diffuse\" {ball} \"proxy\""), "\"proxy\"", "without a material"),
        (format!("{grain} Material \"interface\" {ball} \"proxy\""), "\"proxy\"", "no medium in this proxy"),
        (format!("ObjectBegin \"o\" {grain} {proxy} {ball} \"proxy\" ObjectEnd"), "\"proxy\"", "no part of an object"),
        (
            format!("ObjectBegin \"o\" {grain} Shape \"sphere\" ObjectEnd"),
            "Shape \"sphere\" ObjectEnd",
            "this is no grain",
        ),
    ];
    for (world, place, message) in cases {
        let column = world.rfind(place).unwrap() + 1;
        let told = scene(&format!("WorldBegin\n{medium}\n{world}")).unwrap_err().to_string();
        assert!(told.contains(&format!("scene.pbrt:3:{column}\n")) && told.contains(message), "{world}\n{told}");
    }
    let integrator = "Integrator \"volpath\" \"integer explicitgrains\"";
    for (count, message) in [("2", "nothing for a path to go on in"), ("-1", "at least 0"), ("1.5", "integer")] {
        let told = scene(&format!("{integrator} {count}\nWorldBegin\n{grain}")).unwrap_err().to_string();
        assert!(told.contains("scene.pbrt:1:") && told.contains(message), "{count}\n{told}");
    }
}
