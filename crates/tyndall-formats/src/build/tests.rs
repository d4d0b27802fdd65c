//! What becomes of priorities.

use std::path::Path;

use tyndall::scene::Scene;
use tyndall::spectrum::ColorMode;

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
