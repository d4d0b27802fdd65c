//! Materials that are made of others, and surfaces with holes.

use std::path::Path;

use tyndall::{
    bsdf::Bsdf,
    material::Material,
    math::{Vec2, Vec3},
    relief::Rule,
    spectrum::{ColorMode, Lanes, Wavelengths},
    texture::TexturePoint,
};

use super::{parse, world};
use crate::build::build;
use crate::desc::{
    BaseDesc, ConductorOptics, Encoding, MaterialKind, ReliefMap, SpectrumDesc, TextureId, TextureKind, Varying,
    WrapKind,
};
use crate::source::Spanned;

#[test]
fn a_mix_names_two_materials_that_may_come_later() {
    let desc = world(
        r#"MakeNamedMaterial "m" "string type" "mix" "string materials" [ "a" "b" ] "float amount" 0.25
        MakeNamedMaterial "b" "string type" "diffuse" MakeNamedMaterial "a" "string type" "interface"
        NamedMaterial "m" Shape "sphere""#,
    );
    let kind = |name: &str| &desc.materials.iter().find(|m| m.name.as_deref() == Some(name)).unwrap().kind;
    let MaterialKind::Mix { of: [a, b], amount } = kind("m") else { panic!() };
    assert_eq!(desc.material(a.value).unwrap().name.as_deref(), Some("a"));
    assert_eq!(desc.material(b.value).unwrap().name.as_deref(), Some("b"));
    assert_eq!(amount.value, Varying::constant(0.25));
}

#[test]
fn a_shape_with_alpha_has_holes_and_one_of_alpha_1_has_none() {
    let text = r#"WorldBegin Material "diffuse" Shape "sphere" "float alpha" 0.5 Shape "sphere" "float alpha" 1
        Shape "sphere" "float alpha" 0.5 Texture "t" "float" "checkerboard" Shape "sphere" "texture alpha" "t""#;
    let (desc, sources) = parse(Path::new("scene.pbrt"), text).unwrap();
    let opacity = |i: usize| desc.shapes[i].opacity.as_ref().map(|o| o.value.number());
    assert_eq!([0, 1, 2, 3].map(opacity), [Some(Some(0.5)), None, Some(Some(0.5)), Some(None)]);
    let (scene, _) = build(&desc, sources, ColorMode::Rgb).unwrap();
    let material = |i: usize| &scene.materials[scene.objects[i].material.0 as usize];
    assert!(matches!(material(1), Material::Diffuse { .. }));
    let Material::Mix { of: [hole, diffuse], .. } = material(0) else { panic!() };
    assert!(matches!(scene.materials[hole.0 as usize], Material::Hole));
    assert!(matches!(scene.materials[diffuse.0 as usize], Material::Diffuse { .. }));
    assert_eq!(scene.objects[0].material, scene.objects[2].material, "made once");
    assert!(scene.has_null_surfaces());
}

/// 2¹¹ parts are too many, and so are endless ones.
#[test]
fn a_material_that_contains_itself_is_an_error() {
    let fault = |text: &str| {
        let (desc, sources) = parse(Path::new("scene.pbrt"), &format!("WorldBegin {text}")).unwrap();
        build(&desc, sources, ColorMode::Rgb).unwrap_err().errors[0].message.clone()
    };
    let mix = |name: &str, of: &str| {
        format!(r#"MakeNamedMaterial "{name}" "string type" "mix" "string materials" [ "{of}" "{of}" ] "#)
    };
    let message = "this material contains itself, or more than 1024 others";
    assert_eq!(fault(&(mix("a", "b") + &mix("b", "a"))), message);
    let mut doubled = r#"MakeNamedMaterial "0" "string type" "diffuse" "#.to_owned();
    for i in 0..11 {
        doubled += &mix(&format!("{}", i + 1), &format!("{i}"));
    }
    assert_eq!(fault(&doubled), message);
}

/// A normal map comes before heights; heights may be a number, and stay in scene units. The even material is another one, and
/// the name is that of both together.
#[test]
fn a_material_with_a_relief_is_another_material_embossed() {
    let desc = world(
        r#"Texture "bumps" "float" "fbm" MakeNamedMaterial "m" "string type" "conductor" "texture displacement" "bumps"
        Material "dielectric" "float displacement" -2 "string normalmap" "n.png" Material "diffuse""#,
    );
    let kind = |kind: &MaterialKind| match kind {
        MaterialKind::Embossed { of, map, rule: Rule::Pbrt } => Some((of.value, map.clone())),
        _ => None,
    };
    let embossed: Vec<_> = desc.materials.iter().filter_map(|m| kind(&m.kind).zip(Some(m.name.as_deref()))).collect();
    let [((metal, heights), Some("m")), ((glass, normals), None)] = &embossed[..] else { panic!("{embossed:?}") };
    assert!(matches!(desc.material(*metal).unwrap().kind, MaterialKind::Conductor { .. }));
    assert!(
        matches!(heights, ReliefMap::Heights { texture, scale: 1.0 } if texture.value == Varying::Texture(TextureId(0)))
    );
    assert!(matches!(desc.material(*glass).unwrap().kind, MaterialKind::Dielectric { .. }));
    let ReliefMap::Normals(Spanned { value: Varying::Texture(id), .. }) = normals else { panic!() };
    let TextureKind::Image(image) = &desc.texture(*id).unwrap().kind else { panic!() };
    assert_eq!((image.encoding, image.wrap), (Encoding::Linear, WrapKind::Repeat));
}

/// pbrt's defaults, and each parameter by its name.
#[test]
fn coats_have_the_defaults_of_pbrt() {
    let desc = world(
        r#"Material "coateddiffuse" Shape "sphere"
        Material "coatedconductor" "rgb reflectance" [ 0.9 0.6 0.3 ] "float interface.roughness" 0.1
          "float conductor.uroughness" 0.2 "float interface.eta" 1.7 "float thickness" 0.5 "rgb albedo" [ 0.1 0.2 0.3 ]
          "float g" -0.5 "integer maxdepth" 100 "integer nsamples" 4 "bool remaproughness" false Shape "sphere""#,
    );
    let coat = |i: usize| match &desc.materials[i].kind {
        MaterialKind::Coated(coat) => coat,
        other => panic!("{other:?}"),
    };
    let number = |v: &crate::source::Spanned<Varying>| v.value.number().unwrap();
    let paint = coat(0);
    assert_eq!((&paint.eta.value, paint.roughness.alpha()), (&SpectrumDesc::Constant(1.5), Some([0.0, 0.0])));
    assert_eq!([&paint.thickness, &paint.albedo, &paint.g].map(number), [0.01, 0.0, 0.0]);
    assert_eq!((paint.max_depth, paint.walks), (10, 1));
    assert!(matches!(&paint.base, BaseDesc::Diffuse(r) if number(r) == 0.5));
    let metal = coat(1);
    assert_eq!((&metal.eta.value, metal.roughness.alpha()), (&SpectrumDesc::Constant(1.7), Some([0.1, 0.1])));
    assert_eq!([&metal.thickness, &metal.g].map(number), [0.5, -0.5]);
    assert_eq!((metal.max_depth, metal.walks), (100, 4));
    let BaseDesc::Conductor { optics: ConductorOptics::Reflectance(_), roughness } = &metal.base else { panic!() };
    assert_eq!(roughness.alpha(), Some([0.2, 0.0]));
    let (desc, sources) =
        parse(Path::new("scene.pbrt"), r#"WorldBegin Material "coateddiffuse" "float g" -2 Shape "sphere""#).unwrap();
    assert!(build(&desc, sources, ColorMode::Rgb).is_ok(), "g is held, as in pbrt");
}

#[test]
fn coats_that_make_no_sense_are_told() {
    let told = |text: &str| parse(Path::new("scene.pbrt"), &format!("WorldBegin {text}")).unwrap_err().to_string();
    let both = told(r#"Material "coatedconductor" "rgb reflectance" [ 1 1 1 ] "spectrum conductor.k" "metal-Au-k""#);
    assert!(both.contains("either \"reflectance\" or \"conductor.eta\" and \"conductor.k\""), "{both}");
    assert!(told(r#"Material "coateddiffuse" "integer maxdepth" 70000"#).contains("at most 65535"));
    assert!(told(r#"Material "coateddiffuse" "integer nsamples" 0"#).contains("at least 1"));
    assert!(told(r#"Material "coateddiffuse" "float interface.eta" 2"#).contains("no parameter"));
}

/// pbrt cuts what a surface reflects, not the factors of a texture.
#[test]
fn a_texture_may_be_scaled_by_more_than_1() {
    let text = r#"WorldBegin Texture "a" "spectrum" "scale" "rgb tex" [ 0.4 0.8 0.2 ] "float scale" 1.5
        Material "diffuse" "texture reflectance" "a" Shape "sphere""#;
    let (desc, sources) = parse(Path::new("scene.pbrt"), text).unwrap();
    let (scene, _) = build(&desc, sources, ColorMode::Rgb).unwrap();
    let at = TexturePoint { p: Vec3::ZERO, uv: Vec2::ZERO.into(), n: Vec3::Z, part: None };
    let Bsdf::Diffuse(diffuse) = scene.materials[0].bsdf(&at, &Wavelengths::Rgb, 0) else { panic!() };
    let expected = Lanes::rgb(0.6, 1.0, 0.3);
    assert!((diffuse.reflectance - expected).map(f32::abs).max_lane() < 1e-6, "{diffuse:?}");
}
