//! Defaults, scopes, transformations, references and includes.

use std::path::PathBuf;

use glam::{DMat4, DVec3};
use tyndall::shape::{DiskMapping, SpherePart, Turn};

use super::{parse, scene, world};
use crate::desc::{
    ApertureDesc, CameraKind, Coefficients, ConductorOptics, CropDesc, EnvironmentMapping, FilterDesc, FovAxis,
    LengthUnit, LightKind, Magnitude, MaterialKind, MeshDesc, PhaseDesc, ShapeKind, SpectrumDesc, SphereMapping,
    TextureId, Varying,
};
use crate::error::Unsupported;
use crate::load;

#[test]
fn an_empty_world_has_the_defaults_of_pbrt() {
    let desc = world("");
    assert_eq!((desc.film.width, desc.film.height, desc.film.crop, desc.film.exposure), (1280, 720, None, 1.0));
    assert_eq!(desc.film.filter, FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 });
    let CameraKind::Perspective { fov, frame, lens: None } = &desc.camera.kind else { panic!() };
    assert_eq!((fov.value, frame.axis), (90.0, FovAxis::Smaller));
    assert_eq!(desc.camera.to_world, DMat4::IDENTITY);
    assert_eq!(desc.sampler.spp.value, 16);
    assert_eq!((&*desc.integrator.name.value, desc.integrator.max_depth), ("volpath", None));
    assert_eq!(desc.options.unit.value, LengthUnit::Millimetre);
}

#[test]
fn shapes_materials_media_and_lights_have_the_defaults_of_pbrt() {
    let desc = world(
        r#"Shape "sphere" Shape "disk"
        Material "diffuse" Material "conductor" Material "dielectric" Material "interface"
        Material "thindielectric" Material "diffusetransmission"
        MakeNamedMedium "m" "string type" "homogeneous"
        LightSource "point" LightSource "spot" LightSource "distant" LightSource "infinite"
        LightSource "infinite" "string filename" "sky.exr" "float scale" 2"#,
    );
    assert_eq!(desc.shapes[0].kind, ShapeKind::sphere(1.0));
    assert_eq!(
        desc.shapes[1].kind,
        ShapeKind::Disk {
            height: 0.0,
            radius: 1.0,
            inner_radius: 0.0,
            turn: Turn::FULL,
            mapping: DiskMapping::AzimuthInward
        }
    );
    // The material of shapes before any Material comes first.
    let [default, diffuse, conductor, dielectric, interface, pane, leaf] = &desc.materials[..] else { panic!() };
    for material in [default, diffuse] {
        let MaterialKind::Diffuse { reflectance } = &material.kind else { panic!() };
        assert_eq!((&reflectance.value, material.two_sided), (&Varying::constant(0.5), true));
    }
    let MaterialKind::Conductor { optics: ConductorOptics::EtaK { eta, k }, .. } = &conductor.kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Named("metal-Cu-eta".into()).into());
    assert_eq!(k.value, SpectrumDesc::Named("metal-Cu-k".into()).into());
    let MaterialKind::Dielectric { eta, roughness, .. } = &dielectric.kind else { panic!() };
    assert_eq!((&eta.value, roughness.alpha()), (&SpectrumDesc::Constant(1.5), Some([0.0; 2])));
    assert_eq!(interface.kind, MaterialKind::Interface);
    let MaterialKind::ThinDielectric { eta, .. } = &pane.kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Constant(1.5));
    let MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } = &leaf.kind else { panic!() };
    let quarter = &Varying::constant(0.25);
    assert_eq!((&reflectance.value, &transmittance.value, *scale), (quarter, quarter, 1.0));

    let medium = &desc.media[0];
    let Coefficients::AbsorptionScattering { sigma_a, sigma_s } = &medium.coefficients else { panic!() };
    assert_eq!((&sigma_a.value, &sigma_s.value), (&SpectrumDesc::Constant(1.0), &SpectrumDesc::Constant(1.0)));
    assert_eq!((&medium.phase, medium.scale.value, &medium.emission), (&PhaseDesc::Isotropic, 1.0, &None));

    let [point, spot, distant, constant, sky] = &desc.lights[..] else { panic!() };
    let LightKind::Point { intensity } = &point.kind else { panic!() };
    assert_eq!((&intensity.spectrum.value, intensity.scale), (&SpectrumDesc::Rgb([1.0; 3]), 1.0));
    assert_eq!(intensity.magnitude, Magnitude::UnitLuminance);
    assert!(matches!(spot.kind, LightKind::Spot { cutoff: 30.0, beam: 25.0, .. }));
    for light in [point, spot, distant] {
        assert_eq!(light.to_world.transform_point3(DVec3::ZERO), DVec3::ZERO);
        assert_eq!(light.to_world.transform_vector3(DVec3::Z), DVec3::Z);
    }
    assert!(matches!(constant.kind, LightKind::Constant { .. }));
    let LightKind::Environment { path, scale, mapping, .. } = &sky.kind else { panic!() };
    assert_eq!((path.value.to_str(), *scale), (Some("sky.exr"), 2.0));
    assert_eq!(*mapping, EnvironmentMapping::EqualAreaOctahedral);
}

#[test]
fn scopes_restore_everything() {
    let desc = world(
        r#"Material "interface"
        AttributeBegin
          Translate 1 2 3 Scale 2 2 2 ReverseOrientation
          AreaLightSource "diffuse" MediumInterface "fog"
          Material "dielectric"
          Shape "sphere"
        AttributeEnd
        Shape "sphere"
        MakeNamedMedium "fog" "string type" "homogeneous""#,
    );
    let [inner, outer] = &desc.shapes[..] else { panic!() };
    assert_eq!(inner.to_world.transform_point3(DVec3::X), DVec3::new(3.0, 2.0, 3.0));
    assert!(inner.reverse_orientation && inner.emission.is_some());
    // One name stands for both sides, and the medium is defined after its use.
    let interface = inner.interface.unwrap();
    assert_eq!((interface.inside.map(|m| m.0), interface.outside.map(|m| m.0)), (Some(0), Some(0)));
    assert_eq!((outer.to_world, outer.reverse_orientation), (DMat4::IDENTITY, false));
    assert_eq!((&outer.emission, outer.interface, outer.material.value.0), (&None, None, 0));
}

#[test]
fn matrices_are_written_column_by_column_and_named_spaces_recalled() {
    let desc = scene(
        r#"LookAt 0 0 -5  0 0 0  0 1 0
        Camera "perspective"
        WorldBegin
        Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  7 8 9 1 ]
        CoordinateSystem "here"
        ConcatTransform [ 2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1 ]
        Shape "sphere"
        CoordSysTransform "here" Shape "sphere"
        CoordSysTransform "camera" Shape "sphere"
        Identity Shape "sphere""#,
    );
    let origin = |i: usize| desc.shapes[i].to_world.transform_point3(DVec3::X);
    assert_eq!(origin(0), DVec3::new(9.0, 8.0, 9.0));
    assert_eq!(origin(1), DVec3::new(8.0, 8.0, 9.0));
    assert_eq!(origin(2), DVec3::new(1.0, 0.0, -5.0));
    assert_eq!(origin(3), DVec3::X);
}

/// Right-handed scenes put a mirror before LookAt: +x of the world then shows on the left when seen along +z.
#[test]
fn a_mirror_before_the_camera_mirrors_the_image() {
    let camera = scene("Scale -1 1 1 LookAt 0 0 -5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin").camera;
    assert_eq!(camera.to_world.transform_vector3(DVec3::X), -DVec3::X);
    assert_eq!(camera.to_world.transform_vector3(DVec3::Z), DVec3::Z);
    assert!(camera.to_world.determinant() < 0.0);
}

/// pbrt: a quadric under a mirror has its normal turned round, a mesh has not; ReverseOrientation turns either again.
#[test]
fn a_mirror_turns_quadrics_inside_out_and_meshes_not() {
    let mesh = r#"Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ]"#;
    let desc = world(&format!("Scale -1 1 1 Shape \"sphere\" {mesh} ReverseOrientation Shape \"sphere\" {mesh}"));
    let reversed: Vec<_> = desc.shapes.iter().map(|s| s.reverse_orientation).collect();
    assert_eq!(reversed, [true, false, false, true]);
}

#[test]
fn a_mesh_keeps_its_numbers_and_three_points_need_no_indices() {
    let desc = world(
        r#"Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ]
           "point2 uv" [ 0 0 1 0 0 1 ] "integer indices" [ 2 1 0 ]
        Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ]"#,
    );
    let ShapeKind::TriangleMesh(mesh) = &desc.shapes[0].kind else { panic!() };
    let expected = MeshDesc {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        indices: vec![[2, 1, 0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        uvs: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    };
    assert_eq!(*mesh, expected);
    let ShapeKind::TriangleMesh(mesh) = &desc.shapes[1].kind else { panic!() };
    assert_eq!(mesh.indices, [[0, 1, 2]]);
}

#[test]
fn spectra_keep_the_form_in_which_they_were_written() {
    let desc = world(
        r#"Material "diffuse" "spectrum reflectance" [ 400 .1 700 .9 ]
        Material "dielectric" "spectrum eta" "glass-BK7"
        Material "diffuse" "spectrum reflectance" "skin.spd"
        MakeNamedMaterial "gold" "string type" "conductor" "rgb reflectance" [ 1 .8 .3 ] "float roughness" .2
            "bool remaproughness" false
        NamedMaterial "gold" Shape "sphere""#,
    );
    let reflectance = |i: usize| match &desc.materials[i].kind {
        MaterialKind::Diffuse { reflectance } => reflectance.value.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(reflectance(0), SpectrumDesc::Samples { lambda: vec![400.0, 700.0], values: vec![0.1, 0.9] }.into());
    assert_eq!(reflectance(2), SpectrumDesc::File(PathBuf::from("skin.spd")).into());
    let MaterialKind::Dielectric { eta, .. } = &desc.materials[1].kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Named("glass-BK7".into()));
    let gold = desc.material(desc.shapes[0].material.value).unwrap();
    assert_eq!(gold.name.as_deref(), Some("gold"));
    let MaterialKind::Conductor { roughness, .. } = &gold.kind else { panic!() };
    assert_eq!(roughness.alpha(), Some([0.2; 2]));
}

#[test]
fn attribute_sets_defaults_that_a_shape_may_override_and_need_not_use() {
    let desc = world(
        r#"AttributeBegin
        Attribute "shape" "float radius" 3 "string nobody" "knows"
        Shape "sphere" Shape "sphere" "float radius" 4
        AttributeEnd
        Shape "sphere""#,
    );
    let radii: Vec<_> = desc.shapes.iter().map(|s| s.kind.clone()).collect();
    assert_eq!(radii, [3.0, 4.0, 1.0].map(ShapeKind::sphere));
}

#[test]
fn film_crop_and_exposure_are_those_of_pbrt() {
    let film = |text: &str| scene(&format!("{text} WorldBegin")).film;
    let crop =
        film(r#"Film "rgb" "integer xresolution" 100 "integer yresolution" 50 "float cropwindow" [ .255 .5 0 1 ]"#)
            .crop;
    assert_eq!(crop, Some(CropDesc { x0: 26, x1: 50, y0: 0, y1: 50 }));
    let crop = film(r#"Film "rgb" "integer pixelbounds" [ 10 20 30 4000 ]"#).crop;
    assert_eq!(crop, Some(CropDesc { x0: 10, x1: 20, y0: 30, y1: 720 }));
    let exposure = film(r#"Camera "perspective" "float shutterclose" .5 Film "rgb" "float iso" 200"#).exposure;
    assert_eq!(exposure, 1.0);
}

#[test]
fn the_unit_of_length_is_an_option() {
    let unit = |text: &str| scene(&format!("{text} WorldBegin")).options.unit.value;
    assert_eq!(unit(r#"Option "string unit" "um""#), LengthUnit::Micrometre);
    assert_eq!(unit(r#"Option "unit" "m""#).millimetres(), 1000.0);
}

#[test]
fn words_without_effect_are_kept_with_the_reason() {
    let text = "Accelerator \"bvh\"\nIntegrator \"path\" \"string lightsampler\" \"power\"\nWorldBegin";
    let (desc, sources) = parse("scene.pbrt".as_ref(), text).unwrap();
    let found: Vec<_> = desc.ignored.iter().map(|i| sources.snippet(i.span)).collect();
    assert_eq!(found, ["Accelerator \"bvh\"", "\"string lightsampler\" \"power\""]);
    assert!(desc.ignored.iter().all(|i| !i.reason.is_empty()));
}

#[test]
fn an_include_stands_for_its_file_relative_to_the_scene() {
    let dir = std::env::temp_dir().join(format!("tyndall-include-{}", std::process::id()));
    std::fs::create_dir_all(dir.join("parts")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(dir.join(name), text).unwrap();
    write("scene.pbrt", "WorldBegin\nInclude \"parts/ball.pbrt\"\nInclude \"parts/ball.pbrt\"\n");
    write("parts/ball.pbrt", "Translate 1 0 0\nShape \"plymesh\" \"string filename\" \"parts/ball.ply\"\n");
    let loaded = load(&dir.join("scene.pbrt"), &[], Unsupported::Refuse);
    write("loop.pbrt", "WorldBegin\nInclude \"parts/loop.pbrt\"\n");
    write("parts/loop.pbrt", "Include \"parts/../loop.pbrt\"\n");
    let looped = load(&dir.join("loop.pbrt"), &[], Unsupported::Refuse);
    std::fs::remove_dir_all(&dir).unwrap();

    let (desc, sources) = loaded.unwrap();
    assert_eq!(desc.shapes[1].to_world.w_axis.x, 2.0, "an include is no scope");
    let ShapeKind::Ply { path, .. } = &desc.shapes[0].kind else { panic!() };
    assert_eq!(path.value, dir.join("parts/ball.ply"));
    assert!(sources.place(path.span).ends_with("ball.pbrt:2:35"), "{}", sources.place(path.span));
    let message = looped.unwrap_err().errors[0].message.clone();
    assert!(message.ends_with("loop.pbrt includes itself"), "{message}");
}

#[test]
fn a_colour_space_holds_for_the_colours_of_its_scope() {
    let desc = world(
        r#"AttributeBegin ColorSpace "rec2020" Material "diffuse" "rgb reflectance" [ 0.5 0.4 0.3 ] AttributeEnd
        Material "diffuse" "rgb reflectance" [ 0.5 0.4 0.3 ]"#,
    );
    let colour = |i: usize| match &desc.materials[i].kind {
        MaterialKind::Diffuse { reflectance } => match reflectance.value {
            Varying::Everywhere(SpectrumDesc::Rgb(rgb)) => rgb,
            ref other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    };
    // 1.6605 · 0.5 − 0.5876 · 0.4 − 0.0728 · 0.3 (ITU-R BT.2087) is more than the greatest component, which holds it.
    assert_eq!(colour(0)[0], 0.5);
    assert!((colour(0)[2] - (-0.0182 * 0.5 - 0.1006 * 0.4 + 1.1187 * 0.3)).abs() < 1e-3);
    assert_eq!(colour(1), [0.5, 0.4, 0.3]);
}

#[test]
fn what_moves_stands_where_it_is_at_the_start_time() {
    let desc = world(
        r#"ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 5 0 0 ActiveTransform All
        Translate 0 2 0 Shape "sphere""#,
    );
    assert_eq!(desc.shapes[0].to_world, DMat4::from_translation(DVec3::new(1.0, 2.0, 0.0)));
    assert!(desc.ignored.iter().any(|i| i.reason.contains("start time")));
}

#[test]
fn an_import_keeps_what_it_makes_and_forgets_what_it_sets() {
    let dir = std::env::temp_dir().join(format!("tyndall-import-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    std::fs::write(
        dir.join("part.pbrt"),
        r#"Translate 1 0 0 CoordinateSystem "there" MakeNamedMaterial "red" "string type" "diffuse" Shape "sphere""#,
    )
    .unwrap();
    let main = |text: &str| {
        std::fs::write(dir.join("main.pbrt"), format!("WorldBegin {text}")).unwrap();
        load(&dir.join("main.pbrt"), &[], Unsupported::Refuse).map(|(desc, _)| desc).map_err(|e| e.to_string())
    };
    let imported = main(r#"Import "part.pbrt" NamedMaterial "red" Shape "sphere""#).unwrap();
    let forgotten = main(r#"Import "part.pbrt" CoordSysTransform "there""#).unwrap_err();
    std::fs::write(dir.join("part.pbrt"), "AttributeBegin").unwrap();
    let open = main(r#"Import "part.pbrt""#).unwrap_err();
    std::fs::remove_dir_all(&dir).unwrap();
    assert_eq!(imported.shapes[0].to_world, DMat4::from_translation(DVec3::X));
    assert_eq!(imported.shapes[1].to_world, DMat4::IDENTITY);
    assert!(forgotten.contains("there is no coordinate system"), "{forgotten}");
    assert!(open.contains("block"), "{open}");
}

#[test]
fn a_preset_is_reduced_unless_asked_for_in_full_and_a_medium_may_shine() {
    let desc = world(
        r#"MakeNamedMedium "a" "string type" "homogeneous" "string preset" "Skimmilk"
        MakeNamedMedium "b" "string type" "homogeneous" "string preset" "Skimmilk" "bool reduced" false
        MakeNamedMedium "c" "string type" "homogeneous" "rgb Le" [ 1 2 3 ] "float Lescale" 4"#,
    );
    for (i, expected) in [true, false].into_iter().enumerate() {
        let Coefficients::Preset { reduced, .. } = &desc.media[i].coefficients else { panic!() };
        assert_eq!(*reduced, expected);
    }
    let le = desc.media[2].emission.as_ref().unwrap();
    assert_eq!((&le.spectrum.value, le.scale), (&SpectrumDesc::Rgb([1.0, 2.0, 3.0]), 4.0));
}

#[test]
fn a_medium_may_be_a_recipe_and_a_measured_one_diluted() {
    let desc = world(
        r#"MakeNamedMedium "a" "string type" "milk" "float fat" 0.1
        MakeNamedMedium "b" "string type" "homogeneous" "string preset" "Lowfat Milk" "float concentration" 0.25 "float scale" 2"#,
    );
    let Coefficients::Recipe { name, values } = &desc.media[0].coefficients else { panic!() };
    assert_eq!((name.value.as_str(), &values[..]), ("milk", &[0.1, 3.3, 20.0][..]));
    assert_eq!(desc.media[1].scale.value, 0.5);
    for (wrong, told) in [
        (r#""milk" "float fat" 50"#, "between 0 and 10"),
        (r#""milk" "float fet" 3"#, "fat"),
        (r#""mlik""#, "milk"),
        (r#""homogeneous" "string preset" "Skimmilk" "float concentration" 0.5"#, "dilution"),
        (r#""homogeneous" "string preset" "Lowfat Milk" "float concentration" 2"#, "between 0 and 1"),
    ] {
        let text = format!("WorldBegin MakeNamedMedium \"m\" \"string type\" {wrong}");
        let faults = crate::pbrt::parse(std::path::Path::new("m.pbrt"), &text).unwrap_err().to_string();
        assert!(faults.contains(told), "{wrong}: {faults}");
    }
}

/// A lens is in millimetres; where the scene does not say its unit, pbrt takes it for a metre.
#[test]
fn every_camera_is_read_as_pbrt_reads_it() {
    let camera = |text: &str| scene(&format!("{text} WorldBegin")).camera;
    let thin = camera(r#"Camera "perspective" "float lensradius" .25 "float focaldistance" 3"#);
    let CameraKind::Perspective { lens: Some(lens), .. } = thin.kind else { panic!() };
    assert_eq!((lens.radius, lens.focus), (0.25, 3.0));
    let window = camera(r#"Camera "orthographic""#).window(400, 100).unwrap();
    assert_eq!((window.left, window.top), (-4.0, 1.0));
    let window = camera(r#"Camera "orthographic" "float screenwindow" [ -2 3 -5 7 ]"#).window(400, 100).unwrap();
    assert_eq!((window.left, window.right, window.bottom, window.top), (-2.0, 3.0, -5.0, 7.0));
    let mapping = |text: &str| camera(&format!("Camera \"spherical\" {text}")).kind;
    assert_eq!(mapping(""), CameraKind::Spherical { mapping: SphereMapping::EqualArea });
    let equirectangular = CameraKind::Spherical { mapping: SphereMapping::Equirectangular };
    assert_eq!(mapping(r#""string mapping" "equirectangular""#), equirectangular);
    let millimetre = |unit: &str| {
        let text = format!("{unit} Camera \"realistic\" \"string lensfile\" \"l.dat\" \"string aperture\" \"star\"");
        let CameraKind::Realistic(realistic) = camera(&text).kind else { panic!() };
        assert_eq!((realistic.aperture_diameter, realistic.focus_distance.value), (1.0, 10.0));
        assert_eq!(realistic.aperture, ApertureDesc::Star);
        realistic.millimetre
    };
    assert_eq!([millimetre(""), millimetre("Option \"string unit\" \"cm\"")], [1e-3, 0.1]);
}

#[test]
fn a_gbuffer_has_the_layers_of_pbrt() {
    let film = scene(r#"Film "gbuffer" "string coordinatesystem" "world" WorldBegin"#).film;
    let names: Vec<_> = film.layers.iter().flat_map(|layer| layer.channels.clone()).collect();
    let wanted = ["Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"];
    assert_eq!(names[..9], wanted);
    assert_eq!(names[9..], ["Ns.X", "Ns.Y", "Ns.Z", "u", "v", "dzdx", "dzdy"]);
}

/// Bounds may come in any order and reach beyond; a mirroring matrix turns quadrics inside out, as in pbrt.
#[test]
fn parts_of_quadrics_are_what_their_bounds_say() {
    let desc = world(
        r#"Shape "sphere" "float radius" 2 "float zmin" 1 "float zmax" -9 "float phimax" 90
        Shape "cylinder" "float zmin" 3 "float zmax" -1 Scale -1 1 1 Shape "cylinder" "float radius" 0.5
        Shape "disk" "float phimax" 270
        Shape "loopsubdiv" "integer levels" 2 "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 2 ]
        Texture "h" "float" "constant" Shape "plymesh" "string filename" "a.ply" "texture displacement" "h""#,
    );
    let part = SpherePart::new(2.0, [-2.0, 1.0], Turn::degrees(90.0));
    assert_eq!(desc.shapes[0].kind, ShapeKind::Sphere { radius: 2.0, part });
    let cylinder = |radius, heights| ShapeKind::Cylinder { radius, heights, turn: Turn::FULL };
    assert_eq!((&desc.shapes[1].kind, desc.shapes[1].reverse_orientation), (&cylinder(1.0, [-1.0, 3.0]), false));
    assert_eq!((&desc.shapes[2].kind, desc.shapes[2].reverse_orientation), (&cylinder(0.5, [-1.0, 1.0]), true));
    assert!(matches!(desc.shapes[3].kind, ShapeKind::Disk { turn, .. } if turn == Turn::degrees(270.0)));
    assert!(matches!(&desc.shapes[4].kind, ShapeKind::Subdivision { levels: 2, indices, .. } if indices.len() == 1));
    let ShapeKind::Ply { displacement: Some(displacement), .. } = &desc.shapes[5].kind else { panic!() };
    assert_eq!((displacement.edge_length, displacement.height.value.clone()), (1.0, Varying::Texture(TextureId(0))));
}

/// 470 nm in 16 bands of 29.375 nm, called by their middles; the render must have wavelengths.
#[test]
fn a_spectral_film_has_bands_of_wavelengths() {
    use tyndall::film::{Bands, Recorded};
    use tyndall::spectrum::ColorMode;
    let film = |params: &str| {
        let text = format!("Film \"spectral\" {params} WorldBegin Shape \"sphere\"");
        super::parse(std::path::Path::new("scene.pbrt"), &text)
    };
    let (desc, sources) = film("").unwrap();
    assert_eq!(desc.film.layers.len(), 4);
    assert_eq!(desc.film.layers[0].channels, ["S0.374,688nm", "S0.404,062nm", "S0.433,438nm", "S0.462,812nm"]);
    let bands = |i: usize| match desc.film.layers[i].recorded {
        Recorded::Light(bands) => bands,
        Recorded::Surface(_) | Recorded::Part(_) => panic!(),
    };
    assert_eq!(bands(1), Bands { first: 360.0 + 4.0 * 29.375, width: 29.375, count: 4 });
    assert_eq!(desc.film.color(), ColorMode::Spectral);
    let error = crate::build::build(&desc, sources.clone(), ColorMode::Rgb).unwrap_err();
    assert_eq!(error.errors[0].message, "this film records wavelengths, and the render has colours only");
    crate::build::build(&desc, sources, ColorMode::Spectral).unwrap();

    let (desc, _) = film(r#""integer nbuckets" 5 "float lambdamin" 400 "float lambdamax" 700"#).unwrap();
    assert_eq!(desc.film.layers[1].channels, ["S0.670,000nm"]);
    for wrong in [
        r#""integer nbuckets" 0"#,
        r#""integer nbuckets" 1025"#,
        r#""float lambdamin" 350"#,
        r#""float lambdamax" 831"#,
        r#""float lambdamin" 500 "float lambdamax" 500"#,
    ] {
        assert_eq!(film(wrong).unwrap_err().errors.len(), 1, "{wrong}");
    }
}

#[test]
fn a_sensor_is_the_observer_and_cameras_are_told_why_not() {
    let fault = |sensor: &str| {
        let text = format!("Film \"rgb\" \"string sensor\" \"{sensor}\" WorldBegin Shape \"sphere\"");
        super::parse(std::path::Path::new("scene.pbrt"), &text).map_err(|e| e.to_string())
    };
    assert!(fault("cie1931").is_ok());
    let canon = fault("canon_eos_5d").unwrap_err();
    assert!(canon.contains("is not part of tyndall") && canon.contains("may not be passed on"), "{canon}");
    let misspelt = fault("cie1391").unwrap_err();
    assert!(misspelt.contains("there is no sensor") && misspelt.contains("cie1931"), "{misspelt}");
}
