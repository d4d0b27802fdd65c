//! The peers' scenes.

use glam::DVec3;

use super::peers;
use crate::desc::{
    Coefficients, FilterDesc, GroupId, LightKind, MaterialKind, PhaseDesc, SceneDesc, ShapeKind, SpectrumDesc,
};
use crate::error::Unsupported;
use crate::load;

fn peer(name: &str) -> SceneDesc {
    match load(&peers().join(name), &[], Unsupported::Refuse) {
        Ok((desc, _)) => desc,
        Err(diagnostics) => panic!("{diagnostics}"),
    }
}

#[test]
fn every_scene_of_the_peers_has_what_its_text_says() {
    // Scene, shapes, materials, media, lights, emissive shapes.
    let table = [
        ("a_marble_rough_spot.pbrt", 2, 2, 1, 1, 0),
        ("a_marble_smooth_area.pbrt", 3, 3, 1, 0, 1),
        ("a_marble_smooth_spot.pbrt", 2, 2, 1, 1, 0),
        ("b_marble_matched_area.pbrt", 3, 3, 1, 0, 1),
        ("b_marble_matched_spot.pbrt", 2, 2, 1, 1, 0),
        ("c_skimmilk_sphere.pbrt", 3, 3, 1, 1, 1),
        ("c_wholemilk_sphere.pbrt", 3, 3, 1, 1, 1),
        ("d_fog_cornell.pbrt", 17, 6, 1, 0, 1),
        ("f_grains2000.pbrt", 2, 3, 0, 1, 1),
        ("g_cornell.pbrt", 16, 5, 0, 0, 1),
    ];
    for (name, shapes, materials, media, lights, emissive) in table {
        let desc = peer(name);
        let found = (desc.shapes.len(), desc.materials.len(), desc.media.len(), desc.lights.len());
        assert_eq!(found, (shapes, materials, media, lights), "{name}");
        assert_eq!(desc.shapes.iter().filter(|s| s.emission.is_some()).count(), emissive, "{name}");
        assert_eq!((desc.film.width, desc.film.height, desc.sampler.spp.value), (256, 256, 16), "{name}");
        assert_eq!(desc.film.filter, FilterDesc::Box { radius: [0.5, 0.5] }, "{name}");
        assert_eq!(desc.integrator.max_depth.map(|d| d.value), Some(1000), "{name}");
        assert!(desc.ignored.is_empty(), "{name}");
    }
}

#[test]
fn the_milk_stands_inside_a_glass_sphere_and_the_lamp_looks_down_at_it() {
    let desc = peer("c_wholemilk_sphere.pbrt");
    let milk = &desc.media[0];
    assert!(matches!(&milk.coefficients, Coefficients::Preset { name, reduced: true } if name.value == "Wholemilk"));
    assert_eq!((&milk.phase, milk.scale.value), (&PhaseDesc::Isotropic, 1.0));

    let [lamp, _, sphere] = &desc.shapes[..] else { panic!("{} shapes", desc.shapes.len()) };
    assert_eq!(sphere.kind, ShapeKind::sphere(20.0));
    let interface = sphere.interface.unwrap();
    assert_eq!((interface.inside.map(|m| m.0), interface.outside), (Some(0), None));
    let glass = desc.material(sphere.material.value).unwrap();
    assert!(matches!(&glass.kind, MaterialKind::Dielectric { eta, .. } if eta.value == SpectrumDesc::Constant(1.33)));
    assert!(
        matches!(&desc.lights[0].kind, LightKind::Constant { radiance } if radiance.spectrum.value == SpectrumDesc::Rgb([0.3; 3]))
    );

    // Rotate 121 1 0 0 turns the disk's +z to (0, -sin 121°, cos 121°), towards the scene from (-50, 100, 60).
    let normal = lamp.to_world.transform_vector3(DVec3::Z);
    let angle = 121f64.to_radians();
    assert!((normal - DVec3::new(0.0, -angle.sin(), angle.cos())).length() < 1e-12, "{normal}");
    assert_eq!(lamp.to_world.w_axis.truncate(), DVec3::new(-50.0, 100.0, 60.0));
    let light = lamp.emission.as_ref().unwrap();
    assert_eq!((light.radiance.scale, light.two_sided), (60.0, false));
    assert_eq!(light.radiance.spectrum.value, SpectrumDesc::Blackbody { kelvin: 5500.0 });
}

#[test]
fn the_spot_sits_at_from_and_shines_at_to() {
    let desc = peer("a_marble_rough_spot.pbrt");
    let light = &desc.lights[0];
    let LightKind::Spot { intensity, cutoff, beam, .. } = &light.kind else { panic!("{light:?}") };
    assert_eq!((*cutoff, *beam, intensity.scale), (22.0, 18.0, 20000.0));
    let from = DVec3::new(-60.0, 110.0, 70.0);
    assert_eq!(light.to_world.transform_point3(DVec3::ZERO), from);
    assert!((light.to_world.transform_vector3(DVec3::Z) + from.normalize()).length() < 1e-12);
    let MaterialKind::Dielectric { roughness, .. } = &desc.materials[1].kind else { panic!() };
    assert!((roughness.alpha().unwrap()[0] - 0.1f64.sqrt()).abs() < 1e-12, "remapped: α = √roughness");
}

#[test]
fn two_thousand_grains_are_one_group_and_its_instances() {
    let desc = peer("f_grains2000.pbrt");
    assert_eq!((desc.groups.len(), desc.instances.len()), (1, 2000));
    let group = desc.group(GroupId(0)).unwrap();
    assert_eq!((&*group.name, group.shapes.len()), ("grain", 1));
    assert_eq!(group.shapes[0].kind, ShapeKind::sphere(1.0));
    assert!(desc.instances.iter().all(|i| i.group.value == GroupId(0)));
    assert_eq!(desc.instances[0].to_world.w_axis.truncate(), DVec3::new(-0.0444, 1.0915, 0.0));
}

#[test]
fn the_fog_box_has_its_coefficients_and_its_walls_lie_within() {
    let desc = peer("d_fog_cornell.pbrt");
    let fog = &desc.media[0];
    let Coefficients::AbsorptionScattering { sigma_a, sigma_s } = &fog.coefficients else { panic!("{fog:?}") };
    assert_eq!(sigma_s.value, SpectrumDesc::Rgb([0.002; 3]));
    assert_eq!(sigma_a.value, SpectrumDesc::Rgb([0.0001; 3]));
    assert!(matches!(fog.phase, PhaseDesc::HenyeyGreenstein { g } if g.value == 0.5));
    let wall = desc.shapes[1].interface.unwrap();
    assert_eq!((wall.inside, wall.outside), (desc.shapes[0].interface.unwrap().inside, wall.inside));
    let ShapeKind::TriangleMesh(cube) = &desc.shapes[0].kind else { panic!() };
    assert_eq!((cube.positions.len(), cube.indices.len()), (8, 12));
}

/// The Cornell box is seen from z = -800 towards +z with y up. pbrt's x to the right is then the world's +x.
#[test]
fn the_camera_of_the_cornell_box_is_not_mirrored() {
    let camera = peer("g_cornell.pbrt").camera;
    assert!((camera.to_world.w_axis.truncate() - DVec3::new(278.0, 273.0, -800.0)).length() < 1e-9);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        assert!((camera.to_world.transform_vector3(axis) - axis).length() < 1e-12);
    }
    let window = camera.window(256, 256).unwrap();
    assert!((window.right - (39.3f64 / 2.0).to_radians().tan()).abs() < 1e-12);
}
