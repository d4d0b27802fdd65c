//! Textures: what they refer to, what they may hold, and how they are mapped.

use glam::DVec3;

use super::{parse, world};
use crate::desc::{Board, Encoding, MappingDesc, MaterialKind, TextureKind, Varying, WrapKind};

/// The message of the only fault of what comes after `WorldBegin`.
fn fault(text: &str) -> String {
    let faults = parse(std::path::Path::new("scene.pbrt"), &format!("WorldBegin {text}")).expect_err(text);
    assert_eq!(faults.errors.len(), 1, "{faults}");
    faults.errors[0].message.clone()
        + faults.errors[0].help.as_deref().map(|h| format!(" [{h}]")).unwrap_or_default().as_str()
}

#[test]
fn a_material_finds_its_texture_by_name_and_kind() {
    let desc = world(
        r#"Texture "a" "float" "constant" "float value" 0.25
        Texture "a" "spectrum" "scale" "rgb tex" [ 1 0.5 0.25 ] "texture scale" "a"
        Material "diffuse" "texture reflectance" "a" Shape "sphere"
        Material "conductor" "texture roughness" "a" Shape "sphere""#,
    );
    let MaterialKind::Diffuse { reflectance } = &desc.materials[0].kind else { panic!() };
    let Varying::Texture(colour) = reflectance.value else { panic!() };
    let TextureKind::Scale([_, by]) = &desc.texture(colour).unwrap().kind else { panic!() };
    let MaterialKind::Conductor { roughness, .. } = &desc.materials[1].kind else { panic!() };
    assert_eq!(by.value, roughness.u.value, "both name the texture of numbers");
    assert_eq!(roughness.alpha(), None);
}

#[test]
fn wrong_textures_are_named() {
    let cases = [
        (r#"Material "diffuse" "texture reflectance" "a""#, "no spectrum texture is called \"a\""),
        (
            r#"Texture "a" "float" "fbm" Material "diffuse" "texture reflectance" "a""#,
            "no spectrum texture is called \"a\" [a float texture has this name; here a spectrum texture is needed]",
        ),
        (r#"Texture "a" "colour" "fbm""#, "a texture holds no \"colour\" [known are \"float\", \"spectrum\"]"),
        (r#"Texture "a" "float" "fbn""#, "there is no texture \"fbn\" [did you mean \"fbm\"?]"),
        (
            r#"Texture "a" "float" "fbm" "integer octave" 3"#,
            "texture \"fbm\" has no parameter \"octave\" [did you mean \"octaves\"?]",
        ),
        (r#"Texture "a" "float" "fbm" Texture "a" "float" "fbm""#, "the texture \"a\" is defined twice"),
        (r#"Texture "a" "float" "imagemap""#, "an imagemap needs \"string filename\""),
        (
            r#"Texture "a" "float" "imagemap" "string filename" "a.png" "string encoding" "gama 2""#,
            "there is no encoding \"gama 2\" [write \"sRGB\", \"linear\" or \"gamma 2.2\"]",
        ),
        (
            r#"Texture "a" "float" "constant" Material "dielectric" "texture eta" "a""#,
            "\"eta\" of material \"dielectric\" cannot be a texture [give it as a constant]",
        ),
    ];
    for (text, message) in cases {
        assert_eq!(fault(text), message, "{text}");
    }
}

#[test]
fn an_imagemap_has_the_defaults_of_pbrt() {
    let desc = world(
        r#"Texture "a" "spectrum" "imagemap" "string filename" "a.png"
        Texture "b" "spectrum" "imagemap" "string filename" "b.exr" "float uscale" 2 "float vdelta" 0.5"#,
    );
    let image = |i: usize| match &desc.textures[i].kind {
        TextureKind::Image(image) => image.clone(),
        other => panic!("{other:?}"),
    };
    let a = image(0);
    assert_eq!((a.mapping, a.wrap, a.smooth, a.scale, a.invert), (MappingDesc::UV, WrapKind::Repeat, true, 1.0, false));
    assert_eq!([a.encoding, image(1).encoding], [Encoding::Srgb, Encoding::Linear]);
    assert_eq!(image(1).mapping, MappingDesc::Uv([[2.0, 0.0, 0.0], [0.0, 1.0, 0.5]]));
}

/// The space of a texture is that of its definition: what stands at (3, 0, 0) in the world is its origin.
#[test]
fn a_texture_lies_in_the_space_of_its_definition() {
    let desc = world(
        r#"AttributeBegin Translate 3 0 0 Texture "a" "float" "checkerboard" "integer dimension" 3 AttributeEnd"#,
    );
    let TextureKind::Checkerboard { board: Board::Cubes { from_world }, .. } = desc.textures[0].kind else { panic!() };
    assert_eq!(from_world.transform_point3(DVec3::new(3.0, 0.0, 0.0)), DVec3::ZERO);
}

/// Two textures of one picture, in two materials, show one and the same: it was read once.
#[test]
fn a_picture_is_read_once_however_many_textures_show_it() {
    use tyndall::{material::Material, texture::Texture};
    let picture = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/words/data/picture.png");
    let material = |name: &str, scale: f64| {
        format!(
            r#"Texture "{name}" "spectrum" "imagemap" "string filename" "{picture}" "float scale" {scale}
            Material "diffuse" "texture reflectance" "{name}" Shape "sphere""#
        )
    };
    let text = format!("WorldBegin {} {}", material("a", 1.0), material("b", 0.5));
    let (desc, sources) = parse(std::path::Path::new("scene.pbrt"), &text).unwrap();
    let (scene, _) = crate::build::build(&desc, sources, tyndall::spectrum::ColorMode::Rgb).unwrap();
    let picture = |i: usize| match &scene.materials[i] {
        Material::Diffuse { reflectance: Texture::Image(image), .. } => std::sync::Arc::clone(&image.picture),
        other => panic!("{other:?}"),
    };
    assert!(std::sync::Arc::ptr_eq(&picture(0), &picture(1)));
}
