//! Materials that are made of others.

use tyndall::relief::Rule;

use super::*;
use crate::desc::{MaterialKind, ReliefMap, Varying};

#[test]
fn plastic_is_polypropylene_of_a_grey_base_that_keeps_its_hue() {
    let MaterialKind::Plastic { eta, reflectance, nonlinear, tint } = material("<bsdf type=\"plastic\"/>").kind else {
        panic!()
    };
    assert_eq!(eta.value, crate::desc::SpectrumDesc::Constant(1.49 / 1.000277));
    assert_eq!((reflectance.value, nonlinear, tint), (Varying::constant(0.5), false, None));
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
