//! Materials that are made of others.

use tyndall::relief::Rule;

use super::*;
use crate::desc::{MaterialKind, ReliefMap, TextureKind, Varying};

#[test]
fn plastic_is_polypropylene_of_a_grey_base_that_keeps_its_hue() {
    let MaterialKind::Plastic { eta, reflectance, nonlinear, roughness, tint } =
        material("<bsdf type=\"plastic\"/>").kind
    else {
        panic!()
    };
    assert_eq!(eta.value, crate::desc::SpectrumDesc::Constant(1.49 / 1.000277));
    assert_eq!((reflectance.value, nonlinear, roughness, tint), (Varying::constant(0.5), false, None, None));
}

#[test]
fn a_blend_has_two_parts_a_mask_one_and_two_faces_are_made_two_sided() {
    let scene = parsed(&scene(
        r#"<shape type="sphere"><bsdf type="blendbsdf"><float name="weight" value="0.3"/>
            <bsdf type="mask"><bsdf type="diffuse" id="a"/></bsdf><bsdf type="twosided"><bsdf type="blendbsdf">
            <float name="weight" value="0.1"/><bsdf type="conductor"/><ref id="a"/></bsdf></bsdf></bsdf></shape>
        <shape type="sphere"><bsdf type="twosided"><ref id="a"/><bsdf type="conductor"/></bsdf></shape>"#,
    ));
    let of = |i: usize| scene.material(scene.shapes[i].material.value).unwrap();
    let MaterialKind::Mix { of: [mask, both], amount } = &of(0).kind else { panic!() };
    assert_eq!(amount.value, Varying::constant(0.3));
    let MaterialKind::Mask { of: diffuse, opacity } = &scene.material(mask.value).unwrap().kind else { panic!() };
    assert_eq!(opacity.value, Varying::constant(0.5));
    assert!(!scene.material(diffuse.value).unwrap().two_sided);
    let MaterialKind::Mix { of: parts, .. } = &scene.material(both.value).unwrap().kind else { panic!() };
    assert!(parts.iter().all(|part| scene.material(part.value).unwrap().two_sided));
    let MaterialKind::TwoFaced { of: faces } = &of(1).kind else { panic!() };
    assert!(faces.iter().all(|face| scene.material(face.value).unwrap().two_sided));
}

/// `r₀ = 0.08 specular` and `r₀ = ((η − 1)/(η + 1))²`: 0.5 gives η = 1.5. An index of 1 does not bend, and is 1.001 where
/// light passes.
#[test]
fn principled_has_the_index_of_its_specular_and_bends_what_it_lets_through() {
    let eta = |parameters: &str| {
        let text = format!("<bsdf type=\"principled\">{parameters}</bsdf>");
        let MaterialKind::Principled(desc) = material(&text).kind else { panic!() };
        desc.eta
    };
    assert!((eta("") - 1.5).abs() < 1e-12);
    assert!((eta("<float name=\"specular\" value=\"0\"/>") - 1.0).abs() < 1e-12);
    assert_eq!(eta("<float name=\"eta\" value=\"1\"/>"), 1.0);
    assert_eq!(eta("<float name=\"eta\" value=\"1\"/><float name=\"spec_trans\" value=\"0.1\"/>"), 1.001);
    assert_eq!(eta("<float name=\"eta\" value=\"1\"/><float name=\"spec_trans\" value=\"0\"/>"), 1.0);
}

/// Mitsuba's checkerboard, asked for a number, has its colours the other way round.
#[test]
fn a_checkerboard_of_roughnesses_is_turned_round_and_one_of_colours_is_not() {
    let scene = parsed(&scene(
        r#"<texture type="checkerboard" id="t"><float name="color0" value="0.1"/><float name="color1" value="0.3"/></texture>
        <shape type="sphere"><bsdf type="diffuse"><ref name="reflectance" id="t"/></bsdf></shape>
        <shape type="sphere"><bsdf type="roughconductor"><ref name="alpha" id="t"/></bsdf></shape>
        <shape type="sphere"><bsdf type="mask"><ref name="opacity" id="t"/><bsdf type="diffuse"/></bsdf></shape>"#,
    ));
    let first = |varying: &Varying| {
        let Varying::Texture(id) = varying else { panic!() };
        let TextureKind::Checkerboard { of, .. } = &scene.texture(*id).unwrap().kind else { panic!() };
        of[0].value.number()
    };
    let of = |i: usize| &scene.material(scene.shapes[i].material.value).unwrap().kind;
    let MaterialKind::Diffuse { reflectance } = of(0) else { panic!() };
    let MaterialKind::Conductor { roughness, .. } = of(1) else { panic!() };
    let MaterialKind::Mask { opacity, .. } = of(2) else { panic!() };
    assert_eq!(
        [&reflectance.value, &roughness.u.value, &roughness.v.value, &opacity.value].map(first),
        [Some(0.1), Some(0.3), Some(0.3), Some(0.3)]
    );
    assert_eq!(scene.textures.len(), 2);
}

/// `twosided` around a relief mirrors it on the back, inside of it does not; the texture of a bump map may have any name.
#[test]
fn a_relief_knows_whether_its_back_is_a_mirror_image() {
    let texture =
        |name| format!(r#"<texture type="bitmap" name="{name}"><string name="filename" value="a.png"/></texture>"#);
    let text = format!(
        r#"<shape type="sphere"><bsdf type="twosided"><bsdf type="bumpmap">{}<float name="scale" value="3"/>
            <bsdf type="diffuse"/></bsdf></bsdf></shape>
        <shape type="sphere"><bsdf type="normalmap">{}<boolean name="flip_invalid_normals" value="false"/>
            <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf></shape>"#,
        texture("anything"),
        texture("normalmap"),
    );
    let scene = parsed(&scene(&text));
    let of = |i: usize| match &scene.material(scene.shapes[i].material.value).unwrap().kind {
        MaterialKind::Embossed { of, map, rule } => (scene.material(of.value).unwrap().two_sided, map.clone(), *rule),
        kind => panic!("{kind:?}"),
    };
    let (two_sided, map, rule) = of(0);
    assert_eq!((two_sided, rule), (true, Rule::Mitsuba { flips: true, shadows: true, mirrored: true }));
    assert!(matches!(map, ReliefMap::Heights { scale: 3.0, .. }));
    let (two_sided, map, rule) = of(1);
    assert_eq!((two_sided, rule), (true, Rule::Mitsuba { flips: false, shadows: true, mirrored: false }));
    assert!(matches!(map, ReliefMap::Normals(_)));
}
