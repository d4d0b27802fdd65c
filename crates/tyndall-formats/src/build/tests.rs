//! What becomes of priorities, of the power of lights, of hair, and of meshes that are displaced.

use std::path::Path;

use tyndall::light::{Light, Reference};
use tyndall::math::{Vec2, Vec3};
use tyndall::scene::Scene;
use tyndall::spectrum::{ColorMode, Wavelengths, srgb};

use crate::error::Diagnostics;

fn pbrt(world: &str) -> Result<Scene, Diagnostics> {
    let (desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), &format!("WorldBegin\n{world}"))?;
    Ok(super::build(&desc, sources, ColorMode::Rgb)?.0)
}

fn mitsuba(scene: &str) -> Result<Scene, Diagnostics> {
    let text = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{scene}</scene>"#);
    let (desc, sources) = crate::mitsuba::parse(Path::new("scene.xml"), &text, &[])?;
    Ok(super::build(&desc, sources, ColorMode::Rgb)?.0)
}

/// Priority, whether there is an index, and the medium, of each body.
fn bodies(scene: &Scene) -> Vec<(i32, bool, Option<u32>)> {
    scene.bodies().iter().map(|b| (b.priority, b.index.is_some(), b.medium.map(|m| m.0))).collect()
}

/// A shape's own word, the default of its scope, none outside of it; the patches of a mesh are one body, which is closed
/// together or not.
#[test]
fn a_shape_with_a_priority_is_a_body() {
    let scene = pbrt(
        r#"MakeNamedMedium "milk" "string type" "homogeneous"
           Shape "sphere"
           Material "dielectric" Shape "sphere" "integer priority" -2
           AttributeBegin
             Attribute "shape" "integer priority" 7
             MediumInterface "milk" "" Material "interface"
             Shape "sphere"
             Shape "bilinearmesh" "integer indices" [0 1 2 3 4 5 6 7]
                "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0  0 0 1 1 0 1 0 1 1 1 1 1.5]
           AttributeEnd
           Shape "sphere""#,
    );
    let scene = scene.unwrap();
    assert_eq!(bodies(&scene), [(-2, true, None), (7, false, Some(0)), (7, false, Some(0))]);
    assert_eq!(scene.bodies()[2].objects.len(), 2);
    assert_eq!(scene.bodies().iter().map(|b| b.closed).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(scene.objects.iter().filter(|o| o.body.is_none()).count(), 2);
}

#[test]
fn mitsuba_has_the_same_word() {
    let scene = mitsuba(
        r#"<shape type="sphere"><integer name="priority" value="-3"/><bsdf type="dielectric"/></shape>
           <shape type="cube"><integer name="priority" value="4"/><bsdf type="null"/>
             <medium name="interior" type="homogeneous"/></shape>"#,
    );
    assert_eq!(bodies(&scene.unwrap()), [(-3, true, None), (4, false, Some(0))]);
}

#[test]
fn what_cannot_have_a_priority_is_told() {
    let told = |world: &str| pbrt(world).unwrap_err().to_string();
    let opaque = told(r#"Material "diffuse" Shape "sphere" "integer priority" 1"#);
    assert!(opaque.contains("only a body that light can enter has a priority"), "{opaque}");
    let shining = told(
        r#"Material "interface" AttributeBegin AreaLightSource "diffuse" Shape "sphere" "integer priority" 1 AttributeEnd"#,
    );
    assert!(shining.contains("cannot shine"), "{shining}");
    let outside = told(
        r#"MakeNamedMedium "m" "string type" "homogeneous" MediumInterface "" "m"
           Material "interface" Shape "sphere" "integer priority" 1"#,
    );
    assert!(outside.contains("the other bodies say"), "{outside}");
    assert!(told(r#"Shape "sphere" "float priority" 1"#).contains("integer"));
}

/// An image of `n × n` pixels as PNG, brightness by place, in a directory of the test's own.
fn picture(name: &str, n: u32) -> std::path::PathBuf {
    let path = std::env::temp_dir().join(format!("tyndall_{}_{name}.png", std::process::id()));
    let pixels = image::RgbImage::from_fn(n, n, |x, y| image::Rgb([(40 * x) as u8, (60 * y) as u8, 90]));
    pixels.save(&path).unwrap();
    path
}

/// Luminance of the power of a light, by light samples at points around it, on a sphere of radius 100: each sees the
/// irradiance that passes the sphere there, `Φ = ∮ E dA`.
fn power_by_light_samples(lights: &[Light]) -> f64 {
    let (n, radius) = (200, 100.0f32);
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
            let out = tyndall::sampling::warp::uniform_sphere(u);
            let from = Reference { p: out * radius, normal: None };
            // Of a light with an extent, points by other numbers than the place.
            let v = Vec2::new((0.5 + 0.618_034 * (n * i + j) as f32).fract(), (0.754_878 * (n * i + j) as f32).fract());
            for light in lights {
                let Some(s) = light.sample(&from, v, &Wavelengths::Rgb) else { continue };
                let li = srgb::luminance([0, 1, 2].map(|lane| s.li.lane(lane)));
                sum += f64::from(li / s.pdf * -s.dir.dot(out));
            }
        }
    }
    sum * 4.0 * std::f64::consts::PI * f64::from(radius * radius) / f64::from(n * n)
}

/// pbrt's `power`: what comes out, summed up over a sphere around the light, is what was asked for; of a mesh each face has
/// it, of a patch that is flat the whole; `scale` and the size of an RGB colour are factors on it, that of a spectrum is none.
#[test]
fn lights_have_the_power_that_they_are_given() {
    let (square, wide) = (picture("square", 5), picture("wide", 4));
    let (square, wide) = (square.display().to_string(), wide.display().to_string());
    let mesh =
        r#"Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 0 3 4] "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0 -1 -1 1]"#;
    let patch = r#"Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1.5 1.5 0]"#;
    let bent = r#"Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0.8]"#;
    let cases: Vec<(String, f64, f64)> = vec![
        (r#"LightSource "point" "float power" 60"#.into(), 60.0, 1e-4),
        (r#"LightSource "point" "float power" 60 "float scale" 2 "rgb I" [3 3 3]"#.into(), 360.0, 1e-4),
        (r#"LightSource "point" "float power" 60 "blackbody I" 3000"#.into(), 60.0, 1e-3),
        (r#"LightSource "point" "float power" -1"#.into(), 4.0 * std::f64::consts::PI, 1e-4),
        (r#"LightSource "spot" "float power" 60 "float coneangle" 50 "float conedeltaangle" 30"#.into(), 60.0, 2e-3),
        (format!(r#"LightSource "goniometric" "float power" 60 "string filename" "{square}""#), 60.0, 1e-2),
        (format!(r#"LightSource "projection" "float power" 60 "float fov" 70 "string filename" "{wide}""#), 60.0, 2e-2),
        (r#"AreaLightSource "diffuse" "float power" 60 Shape "sphere" "float radius" 2"#.into(), 60.0, 3e-3),
        (r#"AreaLightSource "diffuse" "float power" 60 "bool twosided" true Shape "disk""#.into(), 60.0, 3e-3),
        (format!(r#"AreaLightSource "diffuse" "float power" 60 {mesh}"#), 180.0, 5e-3),
        (format!(r#"AreaLightSource "diffuse" "float power" 60 {patch}"#), 60.0, 5e-3),
        (format!(r#"AreaLightSource "diffuse" "float power" 60 {bent}"#), 60.0, 5e-3),
        (format!(r#"AreaLightSource "diffuse" "float power" 60 "string filename" "{square}" {bent}"#), 0.0, 0.0),
    ];
    for (world, expected, tolerance) in cases {
        let scene = pbrt(&world).unwrap_or_else(|e| panic!("{world}: {e}"));
        let power = power_by_light_samples(&scene.lights.lights);
        // A picture on a surface counts as if it lay on it without distortion: on a bent one that is only nearly so.
        let holds =
            (power / expected - 1.0).abs() <= tolerance || (expected == 0.0 && (power / 60.0 - 1.0).abs() < 0.1);
        assert!(holds, "{world}: {power} W, expected {expected}");
    }
    for file in [square, wide] {
        std::fs::remove_file(file).unwrap();
    }
}

/// `illuminance`: on a plate that faces a distant light E; under an even sky, whatever L is, E = π L; of an image pbrt takes
/// half of what its upper half (+z) gives.
#[test]
fn skies_and_suns_have_the_illuminance_that_they_are_given() {
    let sky = picture("sky", 64).display().to_string();
    let sun = pbrt(r#"LightSource "distant" "float illuminance" 7 "rgb L" [2 2 2]"#).unwrap();
    let Light::Distant(sun) = &sun.lights.lights[0] else { panic!() };
    assert!((sun.irradiance.luminance() - 14.0).abs() < 1e-4);
    let upward = |world: &str| {
        let scene = pbrt(world).unwrap();
        let (n, from) = (300, Reference { p: Vec3::new(0.1, 0.1, 0.0), normal: None });
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let u = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                let dir = tyndall::sampling::warp::cosine_hemisphere(u);
                let le = scene.lights.lights[0].le_from_infinity(from.p, dir, &Wavelengths::Rgb);
                sum += f64::from(srgb::luminance([0, 1, 2].map(|lane| le.lane(lane))));
            }
        }
        std::f64::consts::PI * sum / f64::from(n * n)
    };
    assert!((upward(r#"LightSource "infinite" "float illuminance" 7"#) - 7.0).abs() < 1e-4);
    assert!((upward(r#"LightSource "infinite" "rgb L" [2 2 2] "float illuminance" 7"#) - 14.0).abs() < 1e-4);
    let image = upward(&format!(r#"LightSource "infinite" "string filename" "{sky}" "float illuminance" 7"#));
    assert!((image / 14.0 - 1.0).abs() < 0.01, "{image}");
    let wide = r#""point3 portal" [-1e4 -1e4 1  -1e4 1e4 1  1e4 1e4 1  1e4 -1e4 1]"#;
    let open = upward(&format!(r#"LightSource "infinite" "rgb L" [2 2 2] {wide}"#));
    let turned = wide.replace(
        "[-1e4 -1e4 1  -1e4 1e4 1  1e4 1e4 1  1e4 -1e4 1]",
        "[-1e4 -1e4 1  1e4 -1e4 1  1e4 1e4 1  -1e4 1e4 1]",
    );
    let other = upward(&format!(r#"LightSource "infinite" "rgb L" [2 2 2] {turned}"#));
    assert!(
        (open.max(other) / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3 && open.min(other) == 0.0,
        "{open} {other}"
    );
    std::fs::remove_file(sky).unwrap();
}

/// A light straight ahead has no radiance to be seen, and is a light of its own for each face.
#[test]
fn a_surface_that_shines_straight_ahead_is_a_beam_and_a_curved_one_is_refused() {
    let shape = |kind: &str| {
        let light = r#"<emitter type="directionalarea"><rgb name="radiance" value="2"/></emitter>"#;
        mitsuba(&format!(r#"<shape type="{kind}">{light}</shape>"#))
    };
    let scene = shape("rectangle").unwrap();
    assert!(matches!(scene.lights.lights[..], [Light::Beam(_)]));
    assert_eq!(scene.objects[0].emission, tyndall::scene::Emission::None);
    assert_eq!(shape("cube").unwrap().lights.lights.len(), 12);
    assert!(shape("sphere").unwrap_err().to_string().contains("only flat faces"));
}

/// Emitters in a group: an error in Mitsuba, as there; in pbrt the shapes are there and dark.
#[test]
fn shapes_that_are_placed_by_copies_do_not_shine() {
    let scene = pbrt(
        r#"ObjectBegin "o" AreaLightSource "diffuse" Shape "sphere" ObjectEnd ObjectInstance "o" Translate 5 0 0 ObjectInstance "o""#,
    );
    let scene = scene.unwrap();
    assert!(scene.lights.lights.is_empty() && scene.geometry.census().instances == 2);
}

/// A shell of radius 0.3 around the eye: seen from within without a near clip, and skipped by one of 0.5. One that nothing
/// is nearer than is left out, so that rays keep their bits.
#[test]
fn what_is_nearer_than_the_near_clip_is_not_seen() {
    for (near, kept) in [("0.5", 0.5), ("0.2", 0.0), ("0.000001", 0.0)] {
        let text = format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"near_clip\" value=\"{near}\"/></sensor>
             <shape type=\"sphere\"><float name=\"radius\" value=\"0.3\"/></shape></scene>"
        );
        let (desc, sources) = crate::mitsuba::parse(std::path::Path::new("scene.xml"), &text, &[]).unwrap();
        let (scene, _) = super::build(&desc, sources, tyndall::spectrum::ColorMode::Rgb).unwrap();
        assert_eq!(scene.camera.view.near, kept);
        let ray = scene.camera.sample_ray((0, 0), [0.5; 4]).ray;
        assert_eq!(scene.geometry.intersect(&ray, f32::INFINITY).is_none(), kept > 0.0);
    }
}

/// A recipe is per millimetre: in a scene of centimetres ten times as much, at each of its wavelengths. Its phase function has
/// the mean cosine that reduced scattering was kept for, but for the steps of its table.
#[test]
fn a_recipe_is_its_mixture_in_the_scenes_unit_of_length() {
    let text = "Option \"string unit\" \"cm\" WorldBegin\n\
                MakeNamedMedium \"m\" \"string type\" \"milk\" \"float fat\" 1.5 \"float scale\" 2\n\
                MakeNamedMedium \"f\" \"string type\" \"fog\" \"float water\" 0\n";
    let (desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), text).unwrap();
    let scene = super::build(&desc, sources, ColorMode::Spectral).unwrap().0;
    let expected = tyndall_optics::medium::Medium::of(&tyndall_optics::milk::milk(1.5, 3.3, 20.0));
    let milk = &scene.media[0];
    for (i, lambda) in expected.lambda.iter().enumerate() {
        for (found, per_mm) in [(&milk.sigma_a, expected.sigma_a[i]), (&milk.sigma_s, expected.sigma_s[i])] {
            let ratio = f64::from(found.at(*lambda as f32)) / (20.0 * per_mm);
            assert!((ratio - 1.0).abs() < 1e-6, "{lambda}: {ratio}");
        }
    }
    assert!((f64::from(milk.phase.mean_cosine()) - expected.g).abs() < 1e-3, "{}", milk.phase.mean_cosine());
    // Fog without water is air.
    assert!(scene.media[1].sigma_s.is_zero() && scene.media[1].sigma_a.is_zero());
}

/// What a fibre of the first material scatters from 30 directions into 30, and what one of these numbers does. Three quarters across
/// a fibre `h` is 1/2.
fn assert_fibre(scene: &Scene, eta: f32, sigma_a: [f32; 3], beta: [f32; 2], degrees: f32) {
    use tyndall::{
        bsdf::{Bsdf, hair::Hair},
        spectrum::Lanes,
        texture::TexturePoint,
    };
    let at = TexturePoint { p: Vec3::ZERO, uv: Vec2::new(0.2, 0.75).into(), n: Vec3::Z, part: None };
    let found = scene.materials[0].bsdf(&at, &Wavelengths::Rgb, 0);
    let [r, g, b] = sigma_a;
    let expected = Bsdf::Hair(Hair::new(0.5, eta, Lanes::rgb(r, g, b), beta, degrees.to_radians()));
    let direction = |i: u16| {
        let (x, angle) = (f32::from(i) / 15.0 - 0.97, 2.4 * f32::from(i));
        Vec3::new(x, (1.0 - x * x).sqrt() * angle.cos(), (1.0 - x * x).sqrt() * angle.sin())
    };
    for (wo, wi) in (0..30).flat_map(|i| (0..30).map(move |j| (direction(i), direction(j)))) {
        let [found, expected] =
            [found.eval(wo, wi), expected.eval(wo, wi)].map(|value| [0, 1, 2].map(|c| value.lane(c)));
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= 2e-5 * e.abs() + 1e-7, "{found:?}, {expected:?} for {wo} {wi}");
        }
    }
}

/// All numbers differ, so that none can stand for another. Pigments absorb as d'Eon et al. 2011 write; the absorption for a colour is
/// that of Chiang et al. 2016, eq. 9.
#[test]
fn hair_scatters_by_the_numbers_that_it_is_given_in_both_languages() {
    let curve = r#"Shape "curve" "point3 P" [0 0 0  0 0 1  0 1 2  0 1 3] "string type" "cylinder""#;
    let rest = r#""float eta" 1.6 "float beta_m" 0.2 "float beta_n" 0.45 "float alpha" 5"#;
    let of_pbrt = |words: &str| pbrt(&format!("Material \"hair\" {words} {rest} {curve}")).unwrap();
    let strands = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/words/data/strands.txt");
    let of_mitsuba = |words: &str| {
        let rest = r#"<float name="int_ior" value="1.92"/><float name="ext_ior" value="1.2"/><float name="scale_tilt" value="5"/>
            <float name="longitudinal_roughness" value="0.2"/><float name="azimuthal_roughness" value="0.45"/>"#;
        let hair = format!("<bsdf type=\"hair\">{words}{rest}</bsdf>");
        let file = format!("<string name=\"filename\" value=\"{strands}\"/>");
        mitsuba(&format!("<shape type=\"bsplinecurve\">{file}{hair}</shape>")).unwrap()
    };
    let pigments =
        |brown: f32, red: f32| [0, 1, 2].map(|c| brown * [0.419, 0.697, 1.37][c] + red * [0.187, 0.4, 1.05][c]);
    let b = 0.45f32;
    let width = 5.969 - 0.215 * b + 2.532 * b.powi(2) - 10.73 * b.powi(3) + 5.574 * b.powi(4) + 0.245 * b.powi(5);
    let absorbed = [0.6f32, 0.4, 0.2].map(|colour| (colour.ln() / width).powi(2));
    let number = |name: &str, value: f32| format!("<float name=\"{name}\" value=\"{value}\"/>");
    let both = number("eumelanin", 0.7) + &number("pheomelanin", 0.4);
    let absorbing = r#"<rgb name="sigma_a" value="0.1, 0.2, 0.4"/><float name="scale" value="3"/>"#;
    for (scene, sigma_a) in [
        (of_pbrt(r#""rgb sigma_a" [0.1 0.2 0.4]"#), [0.1, 0.2, 0.4]),
        (of_pbrt(r#""rgb reflectance" [0.6 0.4 0.2]"#), absorbed),
        (of_pbrt(r#""float eumelanin" 0.7 "float pheomelanin" 0.4"#), pigments(0.7, 0.4)),
        (of_pbrt(""), pigments(1.3, 0.0)),
        (of_mitsuba(absorbing), [0.3, 0.6, 1.2]),
        (of_mitsuba(&both), pigments(0.7, 0.4)),
        (of_mitsuba(""), pigments(1.3, 0.2)),
    ] {
        assert_fibre(&scene, 1.6, sigma_a, [0.2, 0.45], 5.0);
    }
}

/// Without a word: a fibre of index 1.55 (in Mitsuba amber's, in air's), of roughness 0.3 both ways, scales at two degrees.
#[test]
fn hair_of_no_numbers_has_those_of_its_language() {
    let curve = r#"Material "hair" Shape "curve" "point3 P" [0 0 0  0 0 1  0 1 2  0 1 3]"#;
    assert_fibre(&pbrt(curve).unwrap(), 1.55, [0.5447, 0.9061, 1.781], [0.3, 0.3], 2.0);
    let strands = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/words/data/strands.txt");
    let hair =
        format!(r#"<shape type="bsplinecurve"><string name="filename" value="{strands}"/><bsdf type="hair"/></shape>"#);
    assert_fibre(&mitsuba(&hair).unwrap(), 1.55 / 1.000_277, [0.5821, 0.9861, 1.991], [0.3, 0.3], 2.0);
    let twice = hair.replace(
        "<bsdf type=\"hair\"/>",
        "<bsdf type=\"hair\"><float name=\"sigma_a\" value=\"1\"/><float name=\"eumelanin\" value=\"1\"/></bsdf>",
    );
    let refused = mitsuba(&twice).unwrap_err().to_string();
    assert!(refused.contains("either a \"sigma_a\" or pigments"), "{refused}");
}

/// A square of side 1 is cut until edges are below 0.3 of its side: 64 triangles (see `mesh::displace`). Edges are measured in the
/// world, times the scene's own factor; heights are moved there with the mesh.
#[test]
fn a_displaced_mesh_is_cut_by_its_edges_in_the_world() {
    let file = std::env::temp_dir().join(format!("tyndall-displaced-{}.ply", std::process::id()));
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  property float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
    std::fs::write(&file, format!("{header}0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2\n3 0 2 3\n")).unwrap();
    for (options, scale, edge) in
        [("", 1.0, 0.3), ("", 4.0, 1.2), ("Option \"float displacementedgescale\" 3", 4.0, 0.4)]
    {
        let text = format!(
            "{options} WorldBegin Texture \"h\" \"float\" \"constant\" \"float value\" 0.125 Scale {scale} {scale} {scale}
             Shape \"plymesh\" \"string filename\" \"{}\" \"texture displacement\" \"h\" \"float edgelength\" {edge}",
            file.display()
        );
        let (desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), &text).unwrap();
        let (scene, _) = super::build(&desc, sources, ColorMode::Rgb).unwrap();
        assert_eq!(scene.geometry.census().triangles, 64, "{options} {scale}");
        let height = scene.geometry.bounds().centre().z;
        assert!((height - 0.125 * scale).abs() < 1e-5, "{options} {scale}: {height}");
    }
    std::fs::remove_file(file).unwrap();
}
