//! What is probably not meant, although the scene can be rendered: warnings for `tyndall info`.
//!
//! | warning | told from |
//! |---|---|
//! | a picture of a texture is missing | its file is not there ([`crate::missing`]) |
//! | a definition is not used | its name occurs nowhere else |
//! | a body is a thousand mean free paths across, or a thousandth of one | its box and its medium's `σ_t` |
//! | a surface that bounds a medium or a body has edges | the edges of its faces |
//! | a light cannot be sampled from inside a medium | it has no size, and every way out leads through polished glass |
//!
//! They are [`SceneError`]s of severity [`Warning`](crate::error::Severity::Warning), with the place in the file.

use std::collections::HashSet;

use tyndall::scene::Scene;
use tyndall::shape::{ObjectId, Seams};

use crate::build::made::parts;
use crate::desc::{Coefficients, LightKind, MaterialKind, MediumId, SceneDesc, ShapeDesc, ShapeKind};
use crate::error::SceneError;

/// A body larger than this many mean free paths, or smaller than its inverse, is told of.
const FAR_FROM_ONE: f32 = 1000.0;

/// All that is worth knowing about a scene before it is rendered.
pub fn warnings(desc: &SceneDesc, scene: &Scene) -> Vec<SceneError> {
    let mut warnings = desc.warnings.clone();
    unused(desc, &mut warnings);
    media_out_of_scale(desc, scene, &mut warnings);
    lights_behind_glass(desc, scene, &mut warnings);
    open_bodies(desc, scene, &mut warnings);
    warnings
}

/// Every shape of a scene, placed or not.
fn shapes(desc: &SceneDesc) -> impl Iterator<Item = &ShapeDesc> {
    desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes))
}

/// Named materials, media, textures and groups that nothing refers to.
fn unused(desc: &SceneDesc, warnings: &mut Vec<SceneError>) {
    let made_of = desc.materials.iter().flat_map(|material| parts(&material.kind));
    let materials = shapes(desc).map(|shape| shape.material.value.0).chain(made_of.map(|part| part.value.0));
    let materials: HashSet<_> = materials.collect();
    let interfaces = shapes(desc).filter_map(|shape| shape.interface).flat_map(|i| [i.inside, i.outside]);
    let lights = desc.lights.iter().map(|light| light.medium.map(|m| m.value));
    let camera = desc.camera.medium.map(|m| m.value);
    let media: HashSet<_> = interfaces.chain(lights).chain([camera]).flatten().map(|id| id.0).collect();
    let groups: HashSet<_> = desc.instances.iter().map(|instance| instance.group.value.0).collect();

    let textures: HashSet<_> = desc.textures_in_use().map(|id| id.0).collect();

    let mut tell = |what: &str, name: Option<&str>, span, is_used: bool| {
        if let (Some(name), false) = (name, is_used) {
            warnings.push(SceneError::warning(span, format!("the {what} \"{name}\" is not used")));
        }
    };
    for (i, material) in (0..).zip(&desc.materials) {
        tell("material", material.name.as_deref(), material.span, materials.contains(&i));
    }
    for (i, medium) in (0..).zip(&desc.media) {
        tell("medium", medium.name.as_deref(), medium.span, media.contains(&i));
    }
    for (i, texture) in (0..).zip(&desc.textures) {
        tell("texture", texture.name.as_deref(), texture.span, textures.contains(&i));
    }
    for (i, group) in (0..).zip(&desc.groups) {
        tell("object", Some(&group.name), group.span, groups.contains(&i));
    }
}

/// Media in which a body is all but clear, or opaque within a thousandth of its size: a unit of length may be wrong.
fn media_out_of_scale(desc: &SceneDesc, scene: &Scene, warnings: &mut Vec<SceneError>) {
    for (index, (medium, words)) in scene.media.iter().zip(&desc.media).enumerate() {
        let id = tyndall::medium::MediumId(index as u32);
        let extent = largest_body(scene, id);
        let (sigma_a, sigma_s) = (medium.sigma_a.rgb(), medium.sigma_s.rgb());
        let sigma_t = [0, 1, 2].map(|c| sigma_a[c] + sigma_s[c]);
        let across = sigma_t.map(|sigma| sigma * extent);
        let most = across.into_iter().fold(0.0, f32::max);
        let least = across.into_iter().filter(|&depth| depth > 0.0).fold(f32::INFINITY, f32::min);
        if !extent.is_finite() || extent == 0.0 || most == 0.0 {
            continue;
        }
        let name = words.name.as_deref().unwrap_or("(without a name)");
        let told = if most < 1.0 / FAR_FROM_ONE {
            format!(
                "the largest body of the medium \"{name}\" is only {most:.1e} mean free paths across: nearly nothing"
            )
        } else if least > FAR_FROM_ONE {
            format!("the largest body of the medium \"{name}\" is {least:.1e} mean free paths across")
        } else {
            continue;
        };
        let measured = matches!(
            words.coefficients,
            Coefficients::Preset { .. }
                | Coefficients::Recipe { .. }
                | Coefficients::PerMillimetre { .. }
                | Coefficients::Reflectance { .. }
        );
        warnings.push(SceneError::warning(words.span, told).help(if measured {
            "its coefficients are per mm: does `Option \"string unit\"` say what a unit of the scene is?"
        } else {
            "coefficients are per scene unit: are they meant for a scene of this size?"
        }));
    }
}

/// The longest side of the largest object that has the medium inside, as it stands in the world [length].
fn largest_body(scene: &Scene, medium: tyndall::medium::MediumId) -> f32 {
    let holds = |o: &tyndall::scene::Object| o.interface.is_some_and(|i| i.inside == Some(medium));
    let objects = (0..).zip(&scene.objects).filter(|(_, object)| holds(object));
    let placed = objects.flat_map(|(i, _)| scene.geometry.placed_bounds(ObjectId(i)));
    placed.map(|bounds| bounds.extent().max_element()).fold(0.0, f32::max)
}

/// Lights without size, where a medium can be reached through polished boundaries only: no path and no light sample finds
/// the way.
fn lights_behind_glass(desc: &SceneDesc, scene: &Scene, warnings: &mut Vec<SceneError>) {
    let has_no_size = |kind: &LightKind| match kind {
        LightKind::Point { .. }
        | LightKind::Spot { .. }
        | LightKind::Distant { .. }
        | LightKind::Goniometric { .. }
        | LightKind::Projector { .. } => true,
        LightKind::Constant { .. } | LightKind::Environment { .. } | LightKind::Portal { .. } => false,
    };
    let Some(light) = desc.lights.iter().find(|light| has_no_size(&light.kind)) else { return };
    for (index, words) in desc.media.iter().enumerate() {
        let id = MediumId(index as u32);
        let walls: Vec<_> = shapes(desc)
            .filter(|shape| shape.interface.is_some_and(|i| [i.inside, i.outside].contains(&Some(id))))
            .collect();
        let is_lit = scene.light_can_reach(Some(tyndall::medium::MediumId(id.0)));
        if is_lit || walls.is_empty() || !walls.iter().all(|shape| is_polished(desc, shape)) {
            continue;
        }
        let name = words.name.as_deref().unwrap_or("(without a name)");
        warnings.push(
            SceneError::warning(
                light.span,
                format!("this light has no size, and light reaches the medium \"{name}\" only through polished surfaces"),
            )
            .help("no path can meet it: give the light a size, make the boundary rough, or use a boundary without a material")
            .related(walls[0].span, "the boundary"),
        );
    }
}

/// Surfaces that bound a medium or a body and have edges: a path around the edge changes sides without a word.
fn open_bodies(desc: &SceneDesc, scene: &Scene, warnings: &mut Vec<SceneError>) {
    let mut first = 0;
    for shape in shapes(desc) {
        // Objects are numbered in this order; each patch is one.
        let count = match &shape.kind {
            ShapeKind::BilinearMesh(patches) => patches.indices.len() as u32,
            _ => 1,
        };
        let objects: Vec<_> = (first..first + count).map(ObjectId).collect();
        first += count;
        let bounds = shape.priority.is_some() || shape.interface.is_some_and(|i| i.inside != i.outside);
        if !bounds {
            continue;
        }
        if scene.geometry.is_closed(&objects) {
            if let [object] = objects[..]
                && scene.geometry.faces_inward(object)
            {
                warnings.push(
                    SceneError::warning(shape.span, "the normals of this surface point to its inside".to_owned())
                        .help("its interior medium is all around it then; turn it round if that is not meant"),
                );
            }
            continue;
        }
        let Seams { edges, open } = scene.geometry.seams(&objects);
        warnings.push(
            SceneError::warning(
                shape.span,
                format!("this surface bounds a medium and is not closed: {open} of {edges} edges are open"),
            )
            .help("behind it is what the last surface that was crossed says; close it, so that nothing gets around it"),
        );
    }
}

/// Whether the surface has nothing but mirror images and refractions of what is around it.
fn is_polished(desc: &SceneDesc, shape: &ShapeDesc) -> bool {
    match desc.material(shape.material.value).map(|material| &material.kind) {
        Some(MaterialKind::Dielectric { roughness, .. }) => roughness.alpha() == Some([0.0, 0.0]),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tyndall::spectrum::ColorMode;

    use super::*;
    use crate::error::{Diagnostics, Severity};

    /// The warnings of a pbrt world, as they are shown.
    fn warned(world: &str) -> String {
        let text = format!("WorldBegin\n{world}");
        let (desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), &text).unwrap();
        let (scene, sources) = crate::build::build(&desc, sources, ColorMode::Rgb).unwrap();
        let warnings = warnings(&desc, &scene);
        assert!(warnings.iter().all(|w| w.severity == Severity::Warning));
        Diagnostics::new(warnings, sources).to_string()
    }

    const BALL: &str = r#"MediumInterface "m" "" Material "interface" Shape "sphere""#;

    #[test]
    fn what_is_defined_and_not_used_is_told() {
        let told = warned(
            r#"MakeNamedMaterial "red" "string type" "diffuse"
               MakeNamedMedium "m" "string type" "homogeneous"
               Texture "bark" "float" "constant" Texture "moss" "float" "constant"
               Texture "wood" "float" "scale" "texture tex" "moss" Shape "sphere" "texture alpha" "wood"
               ObjectBegin "tree" Shape "sphere" ObjectEnd
               Shape "sphere""#,
        );
        for what in
            ["the material \"red\" is not used", "the medium \"m\" is not used", "the object \"tree\" is not used"]
        {
            assert!(told.contains(what), "{told}");
        }
        assert!(told.contains("the texture \"bark\" is not used"), "{told}");
        assert!(!told.contains("the texture \"moss\"") && !told.contains("the texture \"wood\""), "{told}");
        assert!(told.contains("scene.pbrt:2:1"), "{told}");
    }

    /// A ball of diameter 2 with σ_t = 1e4 is 2e4 mean free paths across; with 1e-4 it is 2e-4; with 10 all is well.
    #[test]
    fn a_body_far_from_its_mean_free_path_is_told() {
        let ball = |sigma: &str| {
            let coefficients = format!(r#""rgb sigma_a" [0 0 0] "rgb sigma_s" [{sigma} {sigma} {sigma}]"#);
            warned(&format!(r#"MakeNamedMedium "m" "string type" "homogeneous" {coefficients} {BALL}"#))
        };
        assert!(ball("10000").contains("is 2.0e4 mean free paths across"), "{}", ball("10000"));
        assert!(ball("0.0001").contains("is only 2.0e-4 mean free paths across"), "{}", ball("0.0001"));
        assert_eq!(ball("10"), "");
        // Milk is 2.56 mm⁻¹ thick: of 1000 balls in a row, or of one whose unit is no millimetre.
        let milk = |scale: u32| {
            let words = format!(r#""string type" "homogeneous" "string preset" "Wholemilk" "float scale" {scale}"#);
            warned(&format!(r#"MakeNamedMedium "m" {words} {BALL}"#))
        };
        assert!(
            milk(1000).contains("does `Option \"string unit\"` say what a unit of the scene is?"),
            "{}",
            milk(1000)
        );
        assert_eq!(milk(1), "");
    }

    /// A ball of diameter 2 that is placed a thousandth as large with σ_t = 1e4 is 20 mean free paths across; placed also as it
    /// is, 2e4; and one that is never placed is not there.
    #[test]
    fn an_instanced_body_counts_as_large_as_it_is_placed() {
        let placed = |instances: &str| {
            warned(&format!(
                r#"MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_s" [10000 10000 10000]
                   ObjectBegin "grain" {BALL} ObjectEnd {instances}"#
            ))
        };
        let small = r#"AttributeBegin Scale 1e-3 1e-3 1e-3 ObjectInstance "grain" AttributeEnd"#;
        assert_eq!(placed(small), "");
        let both = placed(&format!(r#"{small} ObjectInstance "grain""#));
        assert!(both.contains("is 2.0e4 mean free paths across"), "{both}");
        assert!(!placed("").contains("mean free paths"), "{}", placed(""));
    }

    #[test]
    fn a_body_that_is_inside_out_is_told() {
        let told = warned(&format!("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" ReverseOrientation {BALL}"));
        assert!(told.contains("the normals of this surface point to its inside"), "{told}");
        assert!(!warned(&format!("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" {BALL}")).contains("normals"));
    }

    /// Two triangles have six edges, of which they share one; a disk is all edge; a sphere has none.
    #[test]
    fn an_open_surface_with_a_medium_behind_it_is_told() {
        let shape = |words: &str| {
            warned(&format!(r#"MakeNamedMedium "m" "string type" "homogeneous" Material "interface" {words}"#))
        };
        let square = r#"Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "integer indices" [0 1 2 0 2 3]"#;
        let told = shape(&format!(r#"MediumInterface "m" "" {square}"#));
        assert!(told.contains("4 of 6 edges are open"), "{told}");
        let disk = shape(r#"MediumInterface "m" "" Shape "disk" "integer priority" 1"#);
        assert!(disk.contains("1 of 1 edges are open"), "{disk}");
        assert!(!shape(r#"MediumInterface "m" "" Shape "sphere""#).contains("edges"));
        assert!(!shape(&format!(r#"MediumInterface "m" "m" {square}"#)).contains("edges"));
    }

    #[test]
    fn a_point_light_outside_of_polished_glass_is_told() {
        let glass = |material: &str, light: &str| {
            warned(&format!(
                r#"MakeNamedMedium "m" "string type" "homogeneous" {light}
                   MediumInterface "m" "" Material {material} Shape "sphere""#
            ))
        };
        let point = r#"LightSource "point" "point3 from" [0 0 5]"#;
        assert!(glass(r#""dielectric""#, point).contains("only through polished surfaces"));
        assert_eq!(glass(r#""dielectric" "float roughness" 0.3"#, point), "");
        assert_eq!(glass(r#""interface""#, point), "");
        assert_eq!(glass(r#""dielectric""#, r#"LightSource "infinite""#), "");
    }
}
