//! The material `subsurface`: what its words mean, and that the colour asked for is the colour seen.

use std::path::Path;

use tyndall::integrator::VolPath;
use tyndall::material::Material;
use tyndall::render::{Settings, render};
use tyndall::scene::Scene;
use tyndall::spectrum::ColorMode;

use super::parse;
use crate::build::build;
use crate::error::{Diagnostics, Severity};

fn scene(text: &str, color: ColorMode) -> Result<Scene, Diagnostics> {
    let (desc, sources) = parse(Path::new("scene.pbrt"), text)?;
    Ok(build(&desc, sources, color)?.0)
}

/// The σ_a and σ_s [1/unit] of the only medium, which is inside of the only shape.
fn medium(options: &str, params: &str) -> [[f32; 3]; 2] {
    let text = format!("{options} WorldBegin Material \"subsurface\" {params} Shape \"sphere\"");
    let scene = scene(&text, ColorMode::Rgb).unwrap();
    assert!(matches!(scene.materials[scene.objects[0].material.0 as usize], Material::Dielectric { .. }));
    let interface = scene.objects[0].interface.unwrap();
    assert_eq!((interface.inside.map(|m| m.0), interface.outside), (Some(0), None));
    [&scene.media[0].sigma_a, &scene.media[0].sigma_s].map(tyndall::spectrum::Spectrum::rgb)
}

fn assert_near(found: [[f32; 3]; 2], expected: [[f32; 3]; 2]) {
    for (f, e) in found.as_flattened().iter().zip(expected.as_flattened()) {
        assert!((f - e).abs() <= 2e-6 * e.abs(), "{found:?}, {expected:?}");
    }
}

/// Per millimetre, whatever the unit of the scene; pbrt's defaults are those of skimmed milk, nearly.
#[test]
fn coefficients_are_per_millimetre_and_have_pbrts_defaults() {
    let default = [[0.0011, 0.0024, 0.014], [2.55, 3.21, 3.77]];
    assert_near(medium("", ""), default);
    assert_near(medium("", "\"float scale\" 10"), default.map(|sigma| sigma.map(|v| 10.0 * v)));
    assert_near(medium("Option \"string unit\" \"cm\"", ""), default.map(|sigma| sigma.map(|v| 10.0 * v)));
    assert_near(medium("", r#""rgb sigma_a" [1 2 3] "rgb sigma_s" [4 5 6]"#), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_near(medium("", r#""string name" "Skimmilk""#), [[0.0014, 0.0025, 0.0142], [0.70, 1.22, 1.90]]);
    for name in tyndall_optics::measured::names() {
        medium("", &format!("\"string name\" \"{name}\""));
    }
}

/// `1/σ_t` is `mfp · scale`; white scatters only, black absorbs only.
#[test]
fn a_colour_and_a_mean_free_path_make_a_medium() {
    let [sigma_a, sigma_s] = medium("", r#""rgb reflectance" [1 0.5 0] "rgb mfp" [2 4 8] "float scale" 0.5"#);
    for (c, sigma_t) in [1.0, 0.5, 0.25].into_iter().enumerate() {
        assert!((sigma_a[c] + sigma_s[c] - sigma_t).abs() < 1e-6, "{sigma_a:?} {sigma_s:?}");
    }
    assert_eq!((sigma_a[0], sigma_s[2]), (0.0, 0.0));
    let [one_a, one_s] = medium("", r#""rgb reflectance" [0.5 0.5 0.5]"#);
    assert!((one_a[1] + one_s[1] - 1.0).abs() < 1e-6, "by default 1 mm");
    assert!((sigma_s[1] / 0.5 - one_s[1]).abs() < 1e-6, "the albedo does not depend on the path");
    // 2 mm are 0.2 cm.
    let [long_a, long_s] =
        medium("Option \"string unit\" \"cm\"", r#""rgb reflectance" [0.5 0.5 0.5] "rgb mfp" [2 2 2]"#);
    assert!((long_a[1] + long_s[1] - 5.0).abs() < 1e-5, "{long_a:?} {long_s:?}");
}

/// A colour is seen through the boundary and by the phase function that the material has.
#[test]
fn the_albedo_for_a_colour_is_that_of_its_own_boundary_and_phase_function() {
    for (params, g, eta) in [("", 0.0, 1.33), ("\"float eta\" 1.6", 0.0, 1.6), ("\"float g\" 0.8", 0.8, 1.33)] {
        let [sigma_a, sigma_s] = medium("", &format!("\"rgb reflectance\" [0.7 0.4 0.1] {params}"));
        for (c, colour) in [0.7, 0.4, 0.1].into_iter().enumerate() {
            let expected = tyndall_optics::half_space::HalfSpace::new(g, eta).albedo(colour);
            let found = f64::from(sigma_s[c] / (sigma_a[c] + sigma_s[c]));
            assert!((found - expected).abs() < 1e-6, "{params} {colour}: {found}, {expected}");
        }
    }
}

#[test]
fn the_medium_is_inside_and_what_was_outside_stays() {
    let text = r#"WorldBegin MakeNamedMedium "fog" "string type" "homogeneous"
        MakeNamedMaterial "wax" "string type" "subsurface"
        MediumInterface "fog" "fog" NamedMaterial "wax" Shape "sphere" ObjectBegin "o" Shape "sphere" ObjectEnd
        Material "diffuse" Shape "sphere""#;
    let scene = scene(text, ColorMode::Rgb).unwrap();
    let sides = |i: usize| scene.objects[i].interface.map(|s| (s.inside.map(|m| m.0), s.outside.map(|m| m.0)));
    let [wax, plain] = [Some((Some(1), Some(0))), Some((Some(0), Some(0)))];
    assert_eq!([0, 1, 2].map(sides), [wax, plain, wax], "objects of groups come last");
}

#[test]
fn a_medium_given_in_two_ways_or_by_half_is_an_error() {
    let fault = |params: &str| {
        let text = format!("WorldBegin Material \"subsurface\" {params} Shape \"sphere\"");
        scene(&text, ColorMode::Rgb).unwrap_err().errors[0].message.clone()
    };
    let rgb = |name: &str| format!("\"rgb {name}\" [1 1 1] ");
    assert_eq!(fault(&rgb("sigma_a")), "\"sigma_a\" needs \"sigma_s\"");
    assert_eq!(fault(&rgb("sigma_s")), "\"sigma_s\" needs \"sigma_a\"");
    assert_eq!(fault(&rgb("mfp")), "\"mfp\" needs \"reflectance\"");
    assert_eq!(fault(&format!("{} \"string name\" \"Marble\"", rgb("reflectance"))), "the medium is given in two ways");
    assert_eq!(fault(r#""string name" "Marbel""#), "no medium \"Marbel\" has been measured");
    assert_eq!(fault(r#""rgb reflectance" [1 1 1] "rgb mfp" [1 0 1]"#), "0 is no mean free path");
    let mix = r#"MakeNamedMaterial "a" "string type" "subsurface" MakeNamedMaterial "b" "string type" "diffuse"
        Material "mix" "string materials" ["a" "b"]"#;
    assert_eq!(fault(mix), "a mixture with the material \"subsurface\" is not supported yet");
    for word in ["sigma_a", "sigma_s", "reflectance", "mfp"] {
        let text = format!(
            "WorldBegin Texture \"t\" \"spectrum\" \"constant\"\nMaterial \"subsurface\" \"texture {word}\" \"t\" Shape \"sphere\""
        );
        let refused = scene(&text, ColorMode::Rgb).unwrap_err();
        let error = &refused.errors[0];
        assert!(error.message.contains(&format!("\"{word}\"")) && error.severity == Severity::NotYet, "{refused}");
        assert!(refused.to_string().contains("which is the same everywhere"), "{refused}");
    }
}

/// Seen from afar, a ball under a uniform sky shows its surface at all angles, weighted by their cosines: the mean over its
/// disk is `F + (1 − F) ρ`, all that it reflects of diffuse light, if it is 10⁴ mean free paths thick. `F` is the
/// reflectance of a smooth boundary of index 1.33 for diffuse light, 0.0667 (Walsh's integral, here summed).
#[test]
fn the_reflectance_asked_for_is_seen() {
    seen_as_asked_for([0.8, 0.5, 0.2], ColorMode::Rgb);
}

/// With wavelengths, a white light and a grey reflectance: each wavelength sees what red, green and blue see above.
#[test]
fn the_reflectance_asked_for_is_seen_at_every_wavelength() {
    seen_as_asked_for([0.5; 3], ColorMode::Spectral);
}

fn seen_as_asked_for(colour: [f64; 3], color: ColorMode) {
    let [r, g, b] = colour;
    let text = format!(
        r#"Scale -1 1 1 LookAt 0 0 -5  0 0 0  0 1 0
        Camera "orthographic" Film "rgb" "integer xresolution" 32 "integer yresolution" 32
        PixelFilter "box" WorldBegin LightSource "infinite" "rgb L" [1 1 1]
        Material "subsurface" "rgb reflectance" [{r} {g} {b}] "rgb mfp" [0.0001 0.0001 0.0001] "float g" 0.3
        Shape "sphere""#
    );
    let scene = scene(&text, color).unwrap();
    let film = render(&scene, &VolPath::default(), &Settings { spp: 64, ..Settings::default() }, &()).film;
    let fresnel = diffuse_fresnel(1.33);
    let disk = std::f64::consts::FRAC_PI_4;
    for (c, colour) in colour.into_iter().enumerate() {
        let count = film.pixels.len() as f64;
        let mean = film.pixels.iter().map(|p| f64::from(p.mean()[c])).sum::<f64>() / count;
        let square: f64 = film.pixels.iter().map(|p| f64::from(p.standard_error()[c]).powi(2)).sum();
        let (seen, error) = ((mean - (1.0 - disk)) / disk, square.sqrt() / count / disk);
        let expected = fresnel + (1.0 - fresnel) * colour;
        // Three channels at 3.3 standard errors: one false alarm in 350 seeds, and the seed is fixed.
        assert!((seen - expected).abs() < 3.3 * error && error < 0.01, "{c}: {seen} ± {error}, {expected}");
    }
}

/// `∫ R(μ) 2μ dμ` outside of a boundary.
fn diffuse_fresnel(eta: f64) -> f64 {
    let at = |mu: f64| {
        let inner = (1.0 - (1.0 - mu * mu) / (eta * eta)).sqrt();
        let (s, p) = ((mu - eta * inner) / (mu + eta * inner), (eta * mu - inner) / (eta * mu + inner));
        0.5 * (s * s + p * p) * 2.0 * mu
    };
    (0..10_000).map(|i| at((f64::from(i) + 0.5) / 10_000.0)).sum::<f64>() / 10_000.0
}
