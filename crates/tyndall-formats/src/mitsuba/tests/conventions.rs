//! Conventions of Mitsuba 3: transforms, cameras, defaults.

use std::path::PathBuf;

use glam::{DMat4, DVec3};
use tyndall::shape::Turn;

use super::*;
use crate::desc::{
    CameraKind, Coefficients, ConductorOptics, EnvironmentMapping, FilterDesc, FovAxis, LightKind, MaterialKind,
    MicrofacetKind, PhaseDesc, ShadowingKind, ShapeKind, SpectrumDesc, Varying,
};

fn transformed(steps: &str) -> DMat4 {
    shape(&format!("<shape type=\"cube\"><transform name=\"to_world\">{steps}</transform></shape>")).to_world
}

#[test]
fn transforms_do_to_points_what_mitsuba_says() {
    let point = DVec3::new(1.0, 2.0, 3.0);
    let cases = [
        ("", [1.0, 2.0, 3.0]),
        ("<translate x=\"1\" z=\"-1\"/>", [2.0, 2.0, 2.0]),
        ("<translate value=\"1, 2, 3\"/>", [2.0, 4.0, 6.0]),
        ("<scale value=\"2\"/>", [2.0, 4.0, 6.0]),
        ("<scale y=\"2\"/>", [1.0, 4.0, 3.0]),
        ("<scale value=\"1 2 3\"/>", [1.0, 4.0, 9.0]),
        // A quarter turn around z takes x to y.
        ("<rotate z=\"1\" angle=\"90\"/>", [-2.0, 1.0, 3.0]),
        // A third of a turn around the diagonal takes x to y to z.
        ("<rotate value=\"0.5773502691896258\" angle=\"120\"/>", [3.0, 1.0, 2.0]),
        // An axis twice as long, by the formula: x → −2z, z → 2x, y → 4y.
        ("<rotate y=\"2\" angle=\"90\"/>", [6.0, 8.0, -2.0]),
        ("<scale value=\"2\"/><translate x=\"1\"/>", [3.0, 4.0, 6.0]),
        ("<translate x=\"1\"/><scale value=\"2\"/>", [4.0, 4.0, 6.0]),
        ("<matrix value=\"0 1 0 5  1 0 0 6  0 0 1 7  0 0 0 1\"/>", [7.0, 7.0, 10.0]),
        ("<matrix value=\"0 1 0  1 0 0  0 0 1\"/>", [2.0, 1.0, 3.0]),
        // From (0,0,5) down on the origin, y up: z turns round, and so does x, which is left.
        ("<lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/>", [-1.0, 2.0, 2.0]),
    ];
    for (steps, wanted) in cases {
        let found = transformed(steps).transform_point3(point);
        assert!(found.abs_diff_eq(DVec3::from_array(wanted), 1e-12), "{steps}: {found}");
    }
    // Without `up` any will do, as long as nothing is mirrored or scaled.
    let free = transformed("<lookat origin=\"1,2,3\" target=\"4,0,2\"/>");
    assert!((free.determinant() - 1.0).abs() < 1e-12);
    assert!(free.transform_vector3(DVec3::Z).abs_diff_eq(DVec3::new(3.0, -2.0, -1.0).normalize(), 1e-12));
}

/// Mitsuba's own example: from (1,1,1) to (1,2,1), z up. Looking along +y with z up, +x is on the right.
#[test]
fn the_camera_sees_right_what_is_right() {
    let camera = camera(
        "<float name=\"fov\" value=\"45\"/><transform name=\"to_world\">\
         <lookat origin=\"1, 1, 1\" target=\"1, 2, 1\" up=\"0, 0, 1\"/></transform>",
    );
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| camera.to_world.transform_vector3(axis));
    assert_eq!(axes, [DVec3::X, DVec3::Z, DVec3::Y]);
    assert_eq!(camera.to_world.transform_point3(DVec3::ZERO), DVec3::ONE);
}

/// A 50 mm lens before a picture of 36 × 24 mm: tan(fov/2) = (√(36² + 24²)/2)/50 along the diagonal.
#[test]
fn a_focal_length_is_a_field_of_view_along_the_diagonal() {
    for parameters in ["", "<string name=\"focal_length\" value=\"50mm\"/>"] {
        let camera = camera(parameters);
        let CameraKind::Perspective { fov, frame, .. } = camera.kind else { panic!() };
        let tan = (fov.value.to_radians() / 2.0).tan();
        assert!((tan - 1872f64.sqrt() / 100.0).abs() < 1e-12);
        assert_eq!(frame.axis, FovAxis::Diagonal);
    }
}

#[test]
fn what_a_scene_leaves_out_is_as_mitsuba_documents_it() {
    let s = parsed(&scene(""));
    assert_eq!((s.film.width, s.film.height, s.sampler.spp.value), (768, 576, 4));
    assert_eq!(s.film.filter, FilterDesc::Gaussian { radius: [2.0; 2], sigma: 0.5 });
    assert_eq!((s.integrator.name.value.as_str(), s.integrator.max_depth), ("path", None));

    let diffuse = |m: MaterialDesc| match m.kind {
        MaterialKind::Diffuse { reflectance } => (reflectance.value, m.two_sided),
        other => panic!("{other:?}"),
    };
    assert_eq!(diffuse(material("<shape type=\"cube\"/>")), (Varying::constant(0.5), false));
    let shines = "<shape type=\"cube\"><emitter type=\"area\"/></shape>";
    assert_eq!(diffuse(material(shines)), (Varying::constant(0.0), false));
    assert_eq!(shape(shines).emission.unwrap().radiance.spectrum.value, SpectrumDesc::Rgb([1.0; 3]));

    let MaterialKind::Dielectric { eta, .. } = material("<bsdf type=\"dielectric\"/>").kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Constant(1.5046 / 1.000277));
    let pane =
        material("<bsdf type=\"thindielectric\"><rgb name=\"specular_transmittance\" value=\"0.5 0.6 0.7\"/></bsdf>");
    let MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } = pane.kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Constant(1.5046 / 1.000277));
    assert_eq!((reflection_tint, transmission_tint.unwrap().value), (None, SpectrumDesc::Rgb([0.5, 0.6, 0.7]).into()));
    let MaterialKind::Conductor { optics, roughness, .. } = material("<bsdf type=\"roughconductor\"/>").kind else {
        panic!()
    };
    assert_eq!((optics, roughness.distribution), (ConductorOptics::Mirror, MicrofacetKind::Beckmann));
    assert_eq!(roughness.shadowing, ShadowingKind::Separable);
    assert_eq!(roughness.alpha(), Some([0.1; 2]));

    let medium = &parsed(&scene("<medium type=\"homogeneous\"/>")).media[0];
    let Coefficients::ExtinctionAlbedo { sigma_t, albedo } = &medium.coefficients else { panic!() };
    assert_eq!((&sigma_t.value, &albedo.value), (&SpectrumDesc::Constant(1.0), &SpectrumDesc::Constant(0.75)));
    assert_eq!(medium.phase, PhaseDesc::Isotropic);
    let hg = &parsed(&scene("<medium type=\"homogeneous\"><phase type=\"hg\"/></medium>")).media[0].phase;
    assert!(matches!(hg, PhaseDesc::HenyeyGreenstein { g } if g.value == 0.8));

    let LightKind::Spot { cutoff, beam, .. } = light("<emitter type=\"spot\"/>").kind else { panic!() };
    assert_eq!((cutoff, beam), (20.0, 15.0));
}

#[test]
fn indices_are_known_by_the_names_of_substances() {
    let glass = "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"Diamond\"/>\
                 <string name=\"ext_ior\" value=\"water\"/></bsdf>";
    let MaterialKind::Dielectric { eta, .. } = material(glass).kind else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Constant(2.419 / 1.333));
    let MaterialKind::Conductor { optics, .. } =
        material("<bsdf type=\"conductor\"><string name=\"material\" value=\"Cu\"/></bsdf>").kind
    else {
        panic!()
    };
    let ConductorOptics::EtaK { eta, k } = optics else { panic!() };
    assert_eq!(eta.value, SpectrumDesc::Named("metal-Cu-eta".into()).into());
    assert_eq!(k.value, SpectrumDesc::Named("metal-Cu-k".into()).into());
}

#[test]
fn colours_are_three_numbers_or_one_and_a_number_is_white_only_where_it_is_light() {
    let reflectance = |parameter: &str| match material(&format!("<bsdf type=\"diffuse\">{parameter}</bsdf>")).kind {
        MaterialKind::Diffuse { reflectance } => reflectance.value,
        other => panic!("{other:?}"),
    };
    for value in ["0.1,0.2,0.3", "0.1 0.2 0.3", " 0.1, 0.2, 0.3 "] {
        let rgb = reflectance(&format!("<rgb name=\"reflectance\" value=\"{value}\"/>"));
        assert_eq!(rgb, SpectrumDesc::Rgb([0.1, 0.2, 0.3]).into());
    }
    assert_eq!(reflectance("<rgb name=\"reflectance\" value=\"0.4\"/>"), SpectrumDesc::Rgb([0.4; 3]).into());
    assert_eq!(reflectance("<float name=\"reflectance\" value=\"0.4\"/>"), Varying::constant(0.4));
    let LightKind::Constant { radiance } =
        light("<emitter type=\"constant\"><float name=\"radiance\" value=\"2\"/></emitter>").kind
    else {
        panic!()
    };
    assert_eq!(radiance.spectrum.value, SpectrumDesc::Rgb([2.0; 3]));
}

#[test]
fn lights_stand_and_face_where_they_are_told() {
    let point = light("<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/></emitter>");
    assert_eq!(point.to_world.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    for (x, y, z) in [(1, 0, 0), (0, 0, -1), (0, 0, 2), (-3, 4, 0)] {
        let parallel = light(&format!(
            "<emitter type=\"directional\"><vector name=\"direction\" value=\"{x} {y} {z}\"/></emitter>"
        ));
        let wanted = DVec3::new(x.into(), y.into(), z.into()).normalize();
        assert!(parallel.to_world.transform_vector3(DVec3::Z).abs_diff_eq(wanted, 1e-12), "{wanted}");
    }
    let sky = light("<emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/></emitter>");
    let LightKind::Environment { path, mapping, .. } = sky.kind else { panic!() };
    assert_eq!((path.value, mapping), (PathBuf::from("sky.exr"), EnvironmentMapping::LatitudeLongitude));
}

#[test]
fn shapes_keep_their_files_and_sides() {
    let sphere = shape(
        "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/><float name=\"radius\" value=\"4\"/>\
         <transform name=\"to_world\"><scale value=\"2\"/></transform><boolean name=\"flip_normals\" value=\"TRUE\"/></shape>",
    );
    assert_eq!(sphere.to_world.transform_point3(DVec3::ZERO), DVec3::new(2.0, 4.0, 6.0));
    assert_eq!((sphere.kind, sphere.reverse_orientation), (ShapeKind::sphere(4.0), true));
    // From its own z axis to that between the two points; azimuth 0 where Duff's frame has it: at +x for +z.
    let cylinder = shape(
        "<shape type=\"cylinder\"><point name=\"p0\" x=\"1\" y=\"2\" z=\"3\"/><point name=\"p1\" x=\"1\" y=\"4\" z=\"3\"/>\
         <float name=\"radius\" value=\"0.5\"/></shape>",
    );
    assert_eq!(cylinder.kind, ShapeKind::Cylinder { radius: 0.5, heights: [0.0, 2.0], turn: Turn::FULL });
    let to_world = |p| cylinder.to_world.transform_point3(p);
    assert_eq!(
        [to_world(DVec3::ZERO), to_world(DVec3::Z * 2.0)],
        [DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 4.0, 3.0)]
    );
    let ShapeKind::Obj { path, face_normals, smooth_normals, flip_tex_coords } =
        shape("<shape type=\"obj\"><string name=\"filename\" value=\"meshes/bunny.obj\"/></shape>").kind
    else {
        panic!()
    };
    assert_eq!(path.value, Path::new("meshes/bunny.obj"));
    // Mitsuba makes smooth normals for a mesh that has none, and turns v of OBJ files round.
    assert_eq!((face_normals, smooth_normals, flip_tex_coords), (false, true, true));
}

#[test]
fn a_crop_is_a_rectangle_of_the_film() {
    let s = parsed(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\">\
         <integer name=\"width\" value=\"100\"/><integer name=\"height\" value=\"50\"/>\
         <integer name=\"crop_offset_x\" value=\"10\"/><integer name=\"crop_width\" value=\"20\"/>\
         <rfilter type=\"lanczos\"/></film></sensor></scene>",
    );
    let crop = s.film.crop.unwrap();
    assert_eq!((crop.x0, crop.x1, crop.y0, crop.y1), (10, 30, 0, 50));
    assert_eq!(s.film.filter, FilterDesc::Sinc { radius: [3.0; 2], tau: 3.0 });
}

#[test]
fn a_camera_can_stand_in_a_medium() {
    let s = parsed(
        "<scene version=\"3.0.0\"><medium type=\"homogeneous\" id=\"fog\"/>\
         <sensor type=\"perspective\"><ref id=\"fog\" name=\"medium\"/></sensor></scene>",
    );
    assert_eq!((s.camera.medium.unwrap().value.0, s.media.len()), (0, 1));
}

/// Parameters may be made of others, names may be beginnings of others, and a later default changes nothing.
#[test]
fn parameters_are_replaced_wherever_they_stand() {
    let s = parsed(&scene(
        "<default name=\"r\" value=\"2\"/><default name=\"r2\" value=\"$r.5\"/><default name=\"r\" value=\"9\"/>\
         <shape type=\"sphere\" id=\"a\\$b\"><float name=\"radius\" value=\"$r2\"/></shape>",
    ));
    assert_eq!(s.shapes[0].kind, ShapeKind::sphere(2.5));
    assert_eq!(s.shapes[0].name.as_deref(), Some("a$b"));
}

#[test]
fn included_files_and_directories_are_found_beside_the_scene() {
    let room = std::env::temp_dir().join(format!("tyndall-include-{}", std::process::id()));
    std::fs::create_dir_all(room.join("parts/meshes")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(room.join(name), text).unwrap();
    write("parts/meshes/a.ply", "");
    write(
        "parts/all.xml",
        "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"grey\"/><include filename=\"one.xml\"/>\
         <shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/><ref id=\"grey\"/></shape></scene>",
    );
    write("parts/one.xml", "<shape type=\"sphere\" version=\"3.0.0\"><float name=\"radius\" value=\"$r\"/></shape>");
    write(
        "scene.xml",
        &scene(
            "<default name=\"r\" value=\"7\"/><path value=\"parts/meshes\"/><include filename=\"parts/all.xml\"/>\
             <alias id=\"grey\" as=\"gray\"/><shape type=\"cube\"><ref id=\"gray\"/></shape>",
        ),
    );
    write(
        "loop.xml",
        "<scene version=\"3.0.0\"><include filename=\"loop.xml\"/><sensor type=\"perspective\"/></scene>",
    );
    let (s, sources) =
        load(&room.join("scene.xml"), &[], Unsupported::Refuse).map_err(|errors| errors.to_string()).unwrap();
    let endless = load(&room.join("loop.xml"), &[], Unsupported::Refuse).unwrap_err().to_string();
    std::fs::remove_dir_all(&room).unwrap();
    assert_eq!(sources.files().len(), 3);
    assert_eq!(s.shapes[0].kind, ShapeKind::sphere(7.0));
    let ShapeKind::Ply { path, .. } = &s.shapes[1].kind else { panic!() };
    assert_eq!(path.value, room.join("parts/meshes/a.ply"));
    assert_eq!(s.shapes[1].material.value, s.shapes[2].material.value);
    assert!(endless.contains("files include each other more than 15 deep"), "{endless}");
}

/// Every form of `<spectrum>` as light, and what it is.
#[test]
fn spectra_are_written_as_a_value_as_pairs_as_a_file_or_by_type() {
    let intensity = |spectrum: &str| match light(&format!("<emitter type=\"point\">{spectrum}</emitter>")).kind {
        LightKind::Point { intensity } => intensity.spectrum.value,
        other => panic!("{other:?}"),
    };
    let samples =
        |lambda: &[f64], values: &[f64]| SpectrumDesc::Samples { lambda: lambda.into(), values: values.into() };
    for (written, read) in [
        // Equal energy: not the white of sRGB.
        ("<spectrum name=\"intensity\" value=\"2\"/>", samples(&[360.0, 830.0], &[2.0, 2.0])),
        (
            "<spectrum name=\"intensity\" value=\"400:1, 500:2.5 700:0\"/>",
            samples(&[400.0, 500.0, 700.0], &[1.0, 2.5, 0.0]),
        ),
        ("<spectrum name=\"intensity\" filename=\"lamp.spd\"/>", SpectrumDesc::File(PathBuf::from("lamp.spd"))),
        (
            "<spectrum name=\"intensity\" type=\"blackbody\"><float name=\"temperature\" value=\"5000\"/></spectrum>",
            SpectrumDesc::Blackbody { kelvin: 5000.0 },
        ),
        (
            "<spectrum name=\"intensity\" type=\"d65\"><float name=\"scale\" value=\"3\"/></spectrum>",
            SpectrumDesc::Rgb([3.0; 3]),
        ),
        (
            "<spectrum name=\"intensity\" type=\"regular\"><float name=\"wavelength_min\" value=\"400\"/>\
             <float name=\"wavelength_max\" value=\"700\"/><string name=\"values\" value=\"1, 2, 3, 4\"/></spectrum>",
            samples(&[400.0, 500.0, 600.0, 700.0], &[1.0, 2.0, 3.0, 4.0]),
        ),
        (
            "<spectrum name=\"intensity\" type=\"irregular\"><string name=\"wavelengths\" value=\"400, 650\"/>\
             <string name=\"values\" value=\"1, 2\"/></spectrum>",
            samples(&[400.0, 650.0], &[1.0, 2.0]),
        ),
    ] {
        assert_eq!(intensity(written), read, "{written}");
    }
    // What is no light is grey.
    let MaterialKind::Diffuse { reflectance } =
        material("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0.25\"/></bsdf>").kind
    else {
        panic!()
    };
    assert_eq!(reflectance.value, Varying::constant(0.25));
}

#[test]
fn a_medium_takes_constant_volumes_and_rayleigh_scattering() {
    let medium = &parsed(&scene(
        "<medium type=\"homogeneous\"><volume type=\"constvolume\" name=\"sigma_t\">\
         <rgb name=\"value\" value=\"1, 2, 3\"/></volume><phase type=\"rayleigh\"/></medium>",
    ))
    .media[0];
    let Coefficients::ExtinctionAlbedo { sigma_t, .. } = &medium.coefficients else { panic!() };
    assert_eq!((&sigma_t.value, &medium.phase), (&SpectrumDesc::Rgb([1.0, 2.0, 3.0]), &PhaseDesc::Rayleigh));
}

/// Mitsuba's conductor without a material has eta = 0 and k = 1 unless told.
#[test]
fn a_conductor_may_leave_out_one_part_of_its_index() {
    let optics = |parameters: &str| match material(&format!("<bsdf type=\"conductor\">{parameters}</bsdf>")).kind {
        MaterialKind::Conductor { optics: ConductorOptics::EtaK { eta, k }, .. } => (eta.value, k.value),
        other => panic!("{other:?}"),
    };
    let constant = Varying::constant;
    assert_eq!(optics("<float name=\"eta\" value=\"2\"/>"), (constant(2.0), constant(1.0)));
    let k = "<string name=\"material\" value=\"none\"/><float name=\"k\" value=\"3\"/>";
    assert_eq!(optics(k), (constant(0.0), constant(3.0)));
}

/// What each sensor needs, and nothing more.
#[test]
fn every_sensor_is_read_as_mitsuba_reads_it() {
    let kind = |sensor: &str| parsed(&format!("<scene version=\"3.0.0\">{sensor}</scene>")).camera;
    let lens = "<float name=\"aperture_radius\" value=\"0.5\"/><float name=\"focus_distance\" value=\"3\"/>";
    let thin = kind(&format!("<sensor type=\"thinlens\">{lens}</sensor>"));
    let CameraKind::Perspective { lens: Some(lens), .. } = thin.kind else { panic!() };
    assert_eq!((lens.radius, lens.focus), (0.5, 3.0));
    // The picture of parallel rays is two units wide, whatever its height.
    let window = kind("<sensor type=\"orthographic\"/>").window(400, 100).unwrap();
    assert_eq!((window.left, window.right, window.bottom, window.top), (-1.0, 1.0, -0.25, 0.25));
    let pixel =
        "<film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer name=\"height\" value=\"1\"/></film>";
    let ray = "<point name=\"origin\" value=\"1,2,3\"/><vector name=\"direction\" value=\"0,-2,0\"/>";
    let meter = kind(&format!("<sensor type=\"radiancemeter\">{pixel}{ray}</sensor>"));
    assert_eq!(meter.kind, CameraKind::RadianceMeter);
    assert_eq!(meter.to_world.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(meter.to_world.transform_vector3(DVec3::Z), -DVec3::Y);
    let on = "<shape type=\"cube\"/><shape type=\"disk\"><sensor type=\"irradiancemeter\"/></shape>";
    assert_eq!(kind(on).kind, CameraKind::IrradianceMeter { shape: 1 });
    let batch = "<sensor type=\"batch\"><sensor type=\"perspective\"/><sensor type=\"orthographic\"/></sensor>";
    let CameraKind::Batch(cameras) = kind(batch).kind else { panic!() };
    assert_eq!(cameras.len(), 2);
}

/// Mitsuba's names of channels.
#[test]
fn layers_have_the_names_that_mitsuba_gives_them() {
    let read = |list: &str| {
        let aov = format!(
            "<integrator type=\"aov\"><string name=\"aovs\" value=\"{list}\"/><integrator type=\"direct\"/></integrator>"
        );
        parse(&PathBuf::from("a.xml"), &scene(&aov), &[]).map(|(desc, _)| desc.integrator).map_err(|e| e.to_string())
    };
    let integrator = read("dd.y:depth, nn:sh_normal,i:shape_index").unwrap();
    let names: Vec<_> = integrator.layers.iter().flat_map(|layer| layer.channels.clone()).collect();
    assert_eq!(names, ["dd.y.T", "nn.X", "nn.Y", "nn.Z", "i.I"]);
    assert_eq!((integrator.name.value.as_str(), integrator.max_depth.map(|d| d.value)), ("direct", Some(1)));
    for (list, message) in [
        ("dd", "\"dd\" is no layer"),
        ("a:depth,a:uv", "a layer cannot be called \"a\""),
        ("stderr:albedo", "a layer cannot be called \"stderr\""),
        ("a:dept", "did you mean \"depth\"?"),
        ("a:dp_dv", "are not known yet"),
    ] {
        let error = read(list).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    let depth = parsed(&scene("<integrator type=\"depth\"/>"));
    assert_eq!(depth.integrator.layers[0].channels, ["depth.T"]);
}

/// What stands at the top of a scene and is referred to belongs to where the reference stands.
#[test]
fn a_lamp_and_a_sampler_may_stand_where_they_are_only_referred_to() {
    let scene = parsed(
        r#"<scene version="3.0.0">
        <emitter type="area" id="lamp"><rgb name="radiance" value="3"/></emitter>
        <sampler type="independent" id="sampler"><integer name="sample_count" value="7"/></sampler>
        <shape type="sphere"><ref id="lamp"/></shape>
        <sensor type="perspective"><float name="focus_distance" value="2"/><ref id="sampler"/></sensor></scene>"#,
    );
    assert!(scene.shapes[0].emission.is_some() && scene.lights.is_empty());
    assert_eq!(scene.sampler.spp.value, 7);
}

/// Mitsuba's v of a sphere runs from the pole at +z down (θ/π), the description's from the pole at −z up: the sphere is
/// mirrored in z, which changes nothing else of it.
#[test]
fn the_v_of_a_sphere_runs_down() {
    let sphere = "<shape type=\"sphere\"><point name=\"center\" value=\"1,2,3\"/></shape>";
    let to_world = parsed(&scene(sphere)).shapes[0].to_world;
    assert_eq!(to_world.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(to_world.transform_vector3(DVec3::Z), -DVec3::Z);
    assert_eq!(to_world.transform_vector3(DVec3::X), DVec3::X);
}

/// With a field of view of 90° the picture spans −1 to 1 of the plane z = 1, −½ to ½ upright. Half its width to the right
/// and a quarter of its height down, it spans 0 to 2, and −¾ to ¼.
#[test]
fn the_principal_point_moves_the_picture_over_the_view() {
    let camera = camera(
        "<float name=\"fov\" value=\"90\"/><float name=\"principal_point_offset_x\" value=\"0.5\"/>\
         <float name=\"principal_point_offset_y\" value=\"0.25\"/>",
    );
    let window = camera.window(200, 100).unwrap();
    for (found, expected) in [(window.left, 0.0), (window.right, 2.0), (window.bottom, -0.75), (window.top, 0.25)] {
        assert!((found - expected).abs() < 1e-12, "{window:?}");
    }
}
