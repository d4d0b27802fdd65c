//! The scenes that peers are compared on.

use glam::DVec3;

use super::*;
use crate::desc::{
    CameraKind, Coefficients, FilterDesc, FovAxis, LightKind, MaterialKind, MicrofacetKind, PhaseDesc, ShapeKind,
};
use crate::desc::{SpectrumDesc, SpotFalloff};

fn loaded(name: &str) -> SceneDesc {
    load(&peer(name), &[], Unsupported::Refuse).map_err(|errors| errors.to_string()).unwrap().0
}

#[test]
fn every_scene_of_the_peers_loads_with_all_its_parts() {
    // shapes, groups, instances, materials, media, lights
    let scenes = [
        ("a_marble_cube.xml", [2, 0, 0, 2, 1, 0]),
        ("a2_marble_cube_spot.xml", [1, 0, 0, 1, 1, 1]),
        ("a3_marble_cube_rough_spot.xml", [1, 0, 0, 1, 1, 1]),
        ("b_marble_cube_matched.xml", [2, 0, 0, 2, 1, 0]),
        ("b2_furnace_matched.xml", [1, 0, 0, 1, 1, 1]),
        ("b3_grey_matched.xml", [2, 0, 0, 2, 1, 0]),
        ("c_milk_sphere.xml", [2, 0, 0, 2, 1, 1]),
        ("d_fog_box.xml", [9, 0, 0, 4, 1, 0]),
        ("f_grains.xml", [2, 1, 2000, 3, 0, 1]),
        ("f2_grains_direct.xml", [2002, 0, 0, 3, 0, 1]),
        ("g_cornell.xml", [8, 0, 0, 3, 0, 0]),
    ];
    for (name, counts) in scenes {
        let s = loaded(name);
        let found =
            [s.shapes.len(), s.groups.len(), s.instances.len(), s.materials.len(), s.media.len(), s.lights.len()];
        assert_eq!(found, counts, "{name}");
        assert_eq!((s.film.width, s.film.height, s.sampler.spp.value), (128, 128, 16), "{name}");
        assert_eq!(s.film.filter, FilterDesc::Box { radius: [0.5; 2] }, "{name}");
        assert_eq!(s.integrator.max_depth, None, "{name}");
        assert_eq!(s.integrator.rr_depth.map(|d| d.value), Some(5), "{name}");
        assert!(
            matches!(&s.camera.kind, CameraKind::Perspective { frame, lens: None, .. } if frame.axis == FovAxis::X),
            "{name}"
        );
        assert!(s.shapes.iter().all(|shape| s.material(shape.material.value).is_some()), "{name}");
    }
}

#[test]
fn marble_keeps_its_coefficients_and_glass_its_index() {
    let s = loaded("a_marble_cube.xml");
    let Coefficients::ExtinctionAlbedo { sigma_t, albedo } = &s.media[0].coefficients else { panic!() };
    assert_eq!(sigma_t.value, SpectrumDesc::Rgb([0.72897476, 0.87263476, 1.0]));
    assert_eq!(albedo.value, SpectrumDesc::Rgb([0.99904201, 0.99843756, 0.99763892]));
    assert_eq!((s.media[0].scale.value, &s.media[0].phase), (3.0071, &PhaseDesc::Isotropic));
    let MaterialKind::Dielectric { eta, roughness, .. } = &s.materials[0].kind else { panic!() };
    assert_eq!((&eta.value, roughness.alpha()), (&SpectrumDesc::Constant(1.5), Some([0.0; 2])));
    let interface = s.shapes[0].interface.unwrap();
    assert!(s.medium(interface.inside.unwrap()).is_some() && interface.outside.is_none());

    let milk = loaded("c_milk_sphere.xml");
    let PhaseDesc::HenyeyGreenstein { g } = milk.media[0].phase else { panic!() };
    assert_eq!((g.value, &milk.shapes[0].kind), (0.8, &ShapeKind::sphere(20.0)));
}

/// The file names no distribution: Mitsuba's is Beckmann's.
#[test]
fn rough_glass_without_a_distribution_is_beckmanns() {
    let s = loaded("a3_marble_cube_rough_spot.xml");
    let MaterialKind::Dielectric { roughness, .. } = &s.materials[0].kind else { panic!() };
    assert_eq!((roughness.distribution, roughness.alpha()), (MicrofacetKind::Beckmann, Some([0.1; 2])));
}

/// From (0, 0, 60) towards the origin; three quarters of the cutoff is full.
#[test]
fn the_spot_shines_down_on_the_cube_and_fades_linearly_in_the_angle() {
    let s = loaded("a2_marble_cube_spot.xml");
    let LightKind::Spot { intensity, cutoff, beam, falloff, .. } = &s.lights[0].kind else { panic!() };
    assert_eq!(intensity.spectrum.value, SpectrumDesc::Rgb([100_000.0; 3]));
    assert_eq!((*cutoff, *beam, *falloff), (3.0, 2.25, SpotFalloff::LinearAngle));
    assert_eq!(s.lights[0].to_world.transform_point3(DVec3::ZERO), DVec3::new(0.0, 0.0, 60.0));
    assert_eq!(s.lights[0].to_world.transform_vector3(DVec3::Z), -DVec3::Z);
}

/// scale 2, then half a turn around y, then 22 along z: the disk lies 2 above the cube and looks down on it.
#[test]
fn the_steps_of_a_transform_follow_each_other() {
    let disk = &loaded("a_marble_cube.xml").shapes[1];
    assert!(disk.to_world.transform_point3(DVec3::X).abs_diff_eq(DVec3::new(-2.0, 0.0, 22.0), 1e-12));
    assert!(disk.to_world.transform_vector3(DVec3::Z).abs_diff_eq(DVec3::new(0.0, 0.0, -2.0), 1e-12));
    assert!(disk.emission.is_some() && !disk.reverse_orientation);
    // scale 25, then lookat: the light stands at the origin of the lookat and faces its target.
    let lamp = &loaded("b3_grey_matched.xml").shapes[1];
    let (at, facing) = (DVec3::new(10.0, 70.0, 50.0), lamp.to_world.transform_vector3(DVec3::Z));
    assert_eq!(lamp.to_world.transform_point3(DVec3::ZERO), at);
    assert!(facing.abs_diff_eq(-25.0 * at.normalize(), 1e-12));
}

/// In the Cornell box the red wall is on the left of the image, the lamp above: x < 0 and y > 0 in camera space.
#[test]
fn the_picture_is_not_mirrored() {
    let s = loaded("g_cornell.xml");
    let seen = |p| s.camera.to_world.inverse().transform_point3(p);
    let (red, green, lamp) = (&s.shapes[3], &s.shapes[4], &s.shapes[5]);
    assert_eq!(s.materials[red.material.value.0 as usize].name.as_deref(), Some("red"));
    assert_eq!(s.materials[green.material.value.0 as usize].name.as_deref(), Some("green"));
    let middle = |shape: &ShapeDesc| seen(shape.to_world.transform_point3(DVec3::ZERO));
    assert!(middle(red).abs_diff_eq(DVec3::new(-1.0, 0.0, 3.9), 1e-12), "{}", middle(red));
    assert!(middle(green).abs_diff_eq(DVec3::new(1.0, 0.0, 3.9), 1e-12), "{}", middle(green));
    assert!(middle(lamp).abs_diff_eq(DVec3::new(0.0, 0.985, 3.9), 1e-12), "{}", middle(lamp));
    // The walls look into the box: the red one along +x.
    assert!(red.to_world.transform_vector3(DVec3::Z).abs_diff_eq(DVec3::X, 1e-12));
    assert!(s.materials.iter().all(|material| material.two_sided));
}

#[test]
fn instances_share_their_group_and_keep_their_places() {
    let s = loaded("f_grains.xml");
    assert_eq!((s.groups[0].name.as_str(), s.groups[0].shapes.len()), ("grain", 1));
    assert_eq!(s.groups[0].shapes[0].kind, ShapeKind::sphere(0.44));
    assert!(s.instances.iter().all(|instance| instance.group.value.0 == 0));
    let first = s.instances[0].to_world.transform_point3(DVec3::ZERO);
    assert_eq!(first, DVec3::new(-5.98890, -5.94910, -5.44553));
    assert_eq!(loaded("f2_grains_direct.xml").shapes[0].to_world.transform_point3(DVec3::ZERO), first);
}

#[test]
fn parameters_are_overridden_from_the_command_line() {
    let overrides = [("spp", "64"), ("res", "32"), ("max_depth", "3"), ("integrator", "volpathmis")];
    let overrides = overrides.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let s =
        load(&peer("g_cornell.xml"), &overrides, Unsupported::Refuse).map_err(|errors| errors.to_string()).unwrap().0;
    assert_eq!((s.sampler.spp.value, s.film.width), (64, 32));
    assert_eq!(s.integrator.name.value, "volpathmis");
    // Mitsuba counts three segments, which are two scatterings.
    assert_eq!(s.integrator.max_depth.map(|d| d.value), Some(2));
}
