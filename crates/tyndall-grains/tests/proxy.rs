//! What a grain does to light, and the medium that stands for a pack.

use std::f64::consts::PI;

use glam::DMat4;
use tyndall::{
    bsdf::{Bsdf, Dielectric},
    camera::{Camera, CameraModel, Perspective, View},
    film::Filter,
    granular::Granular,
    integrator::VolPath,
    light::{EnvironmentMap, Light, LightTable, Projection},
    material::{Index, Material, Roughness},
    math::{Ray, Transform, Vec3},
    medium::{Homogeneous, MediumId, MediumInterface},
    path::Vertex,
    phase::Phase,
    render::{Settings, render},
    sampling::Rng,
    scene::{Emission, MaterialId, Object, Scene},
    shape::{GeometryBuilder, ObjectId, Sphere},
    spectrum::{ColorMode, Spectrum},
};
use tyndall_grains::{
    GrainError,
    form::Form,
    pack::{Pack, Recipe},
    proxy::{Body, ProxyError},
    scattering::{Meeting, Substance},
};

fn pack(container: &str, form: &str, radius: &str, count: u64, seed: u64) -> Pack {
    let (container, radii) = (container.parse().unwrap(), radius.parse().unwrap());
    Pack::fill(&Recipe { container, form: Form::parse(form).unwrap(), radii, count, seed }, |_| true).unwrap()
}

fn substance(eta: f64, sigma_a: &[f64]) -> Substance {
    Substance { eta, sigma_a: sigma_a.to_vec() }
}

/// The rows of the table of single balls: albedo and mean cosine of a row by geometric optics. Cosines lie in [-1, 1], and so does
/// what is left of light in [0, 1]: of 2^19 ways their means have standard errors below 0.0014 and 0.0007.
#[test]
fn balls_turn_and_absorb_light_as_geometric_optics_says() {
    let table = include_str!("../../tyndall-lab/data/granular_glass_sphere_grain.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let rows: Vec<Vec<f64>> = rows.map(|row| row.split(',').map(|n| n.parse().unwrap()).collect()).collect();
    let balls = pack("sphere:4", "ball", "1", 10, 1);
    let mut checked = 0;
    for eta in [1.33, 1.5] {
        let rows: Vec<_> = rows.iter().filter(|row| row[0] == eta).collect();
        let sigma_a: Vec<f64> = rows.iter().map(|row| row[1]).collect();
        let scattering = balls.scattering(&substance(eta, &sigma_a), 1).unwrap();
        for (row, met) in rows.iter().zip(&scattering.meetings) {
            assert!((met.albedo - row[2]).abs() < 4.0 * 0.0007, "{row:?} {met:?}");
            assert!((met.mean_cosine - row[3]).abs() < 4.0 * 0.0014 / met.albedo.sqrt(), "{row:?} {met:?}");
            checked += 1;
        }
    }
    assert!(checked >= 8);
}

/// Grains twice as large absorb as if they absorbed twice as much, and carry light twice as far; of a mixture of sizes the large ones
/// are met more often. One seed draws the same ways.
#[test]
fn what_a_grain_does_goes_with_its_size() {
    let met = |radius: &str, sigma_a: f64| {
        pack("sphere:9", "ball", radius, 9, 1).scattering(&substance(1.5, &[sigma_a]), 2).unwrap().meetings[0]
    };
    let (small, large) = (met("1", 0.6), met("2", 0.3));
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{small:?} {large:?}");
    close(large.albedo, small.albedo);
    close(large.advance, 2.0 * small.advance);
    close(large.square, 4.0 * small.square);
}

/// Through a ball of index 1 light goes straight: by a chord of mean length 4/3 and mean square 2 (its half is the cosine to the
/// normal, of density 2 mu). A chord has a variance of 2/9, its square one of 4/3.
#[test]
fn grains_of_index_1_let_light_go_on() {
    let Meeting { albedo, mean_cosine, advance, square } =
        pack("sphere:4", "ball", "1", 10, 1).scattering(&substance(1.0, &[0.0]), 3).unwrap().meetings[0];
    let error = |variance: f64| 4.0 * (variance / f64::from(1 << 19)).sqrt();
    assert!((albedo - 1.0).abs() < 1e-9 && (mean_cosine - 1.0).abs() < 1e-6);
    assert!((advance - 4.0 / 3.0).abs() < error(2.0 / 9.0), "{advance}");
    assert!((square - 2.0).abs() < error(4.0 / 3.0), "{square}");
}

/// Light comes as often one way as the other, whatever the form: an ellipsoid has the mean chord 4V/S too.
#[test]
fn ellipsoids_of_index_1_have_the_mean_chord_of_cauchy() {
    let grains = pack("sphere:6", "ellipsoid:1:1:3", "1", 5, 1);
    let met = grains.scattering(&substance(1.0, &[0.0]), 3).unwrap().meetings[0];
    let expected = 4.0 * (4.0 / 3.0 * PI) / grains.form.surface();
    assert!((met.advance / expected - 1.0).abs() < 0.004, "{} {expected}", met.advance);
}

/// A cylinder that is half full and a box: what they fill is what they hold, and as much grain is in the medium as in the pack.
/// With 1/sigma_t = sqrt((gap + A)^2 + ...) the extinction lies below that of the gaps alone, and is near it for few grains.
#[test]
fn a_proxy_fills_what_its_grains_do() {
    for (container, level, volume) in [
        ("box:20:30:40", None, 24_000.0),
        ("box:20:30:40", Some(0.0), 12_000.0),
        ("cylinder:10:40", Some(-10.0), PI * 1000.0),
        ("sphere:10", Some(0.0), 2.0 / 3.0 * PI * 1000.0),
    ] {
        let grains = pack(container, "ball", "0.5", 20, 2);
        let proxy = grains.proxy(&substance(1.5, &[0.0]), level, 1).unwrap();
        let Body::Mesh(points, triangles) = &proxy.body else { panic!("{container} is a mesh") };
        let corner = |i: u32| points[i as usize];
        let held: f64 = triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum();
        // Of slices of a ball a thousandth is lost.
        assert!((held / volume - 1.0).abs() < 1e-3, "{container} {level:?}: {held} {volume}");
        let dilute = 20.0 * PI * 0.25 / volume;
        assert!((proxy.sigma_s[0] / dilute - 1.0).abs() < 0.005, "{container}: {} {dilute}", proxy.sigma_s[0]);
        assert_eq!(proxy.sigma_a[0], 0.0);
    }
    assert!(
        matches!(pack("sphere:10", "ball", "1", 9, 1).proxy(&substance(1.5, &[0.0]), None, 1).unwrap().body, Body::Ball(r) if r == 10.0)
    );
}

/// Light that wanders over exponential gaps from ball to ball, and really goes through them, against the growth of its mean square
/// displacement in the medium, `2 / (sigma_t^2 (1 - g))` for each meeting: between 15 and 30 meetings, where `g^15` is left of the first
/// directions. The pack is dense: what a ball carries light along is half of it.
#[test]
fn light_wanders_among_grains_as_far_as_in_their_medium() {
    const WALKS: u32 = 30_000;
    let grains = pack("sphere:6", "ball", "1", 60, 1);
    let (gap, proxy) = (grains.free_path_by_formula(), grains.proxy(&substance(1.5, &[0.0]), None, 1).unwrap());
    let expected = 2.0 / (proxy.sigma_s[0].powi(2) * (1.0 - proxy.mean_cosine));
    let mut builder = GeometryBuilder::new();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false).unwrap();
    let (ball, bsdf) = (builder.build().unwrap(), Bsdf::Dielectric(Dielectric::new(1.5)));
    let growth = |walk: u32| {
        let mut rng = Rng::for_sample((0, 0), walk, 9);
        let (mut place, mut dir, mut half) = (Vec3::ZERO, Vec3::Z, 0.0);
        for meeting in 0..30 {
            place += dir * (gap as f32 * -rng.next_positive().ln());
            let (a, b) = dir.any_orthonormal_pair();
            let (off, turn) = (rng.next_1d().sqrt(), std::f32::consts::TAU * rng.next_1d());
            let mut ray = Ray::new(off * (turn.cos() * a + turn.sin() * b) - 2.0 * dir, dir);
            let mut entry = None;
            while let Some(hit) = ball.intersect(&ray, f32::INFINITY) {
                let at = ball.interaction(&ray, &hit);
                let start = *entry.get_or_insert(at.p);
                ray = Vertex::surface(at, bsdf, ray.dir).sample([rng.next_1d(), rng.next_1d(), rng.next_1d()])?.ray;
                if ray.dir.dot(at.ng) > 0.0 {
                    place += at.p - start;
                    break;
                }
            }
            dir = ray.dir;
            if meeting == 14 {
                half = place.length_squared();
            }
        }
        Some(f64::from(place.length_squared() - half) / 15.0)
    };
    let growth: Vec<f64> = (0..WALKS).filter_map(growth).collect();
    let n = growth.len() as f64;
    let mean = growth.iter().sum::<f64>() / n;
    let error = (growth.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n / n).sqrt();
    assert!((mean - expected).abs() < 4.0 * error && error < 0.015 * expected, "{mean} ± {error}, {expected}");
}

/// A half full mesh is refused.
#[test]
fn a_mesh_that_is_not_full_has_no_proxy() {
    let corner = |i: u32| glam::DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 8.0;
    let points: Vec<_> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let solid = tyndall_grains::solid::Solid::new(&points, &triangles).unwrap();
    let container = tyndall_grains::container::Container::Mesh(std::sync::Arc::new(solid));
    let recipe = Recipe { container, form: Form::Ball, radii: "1".parse().unwrap(), count: 9, seed: 1 };
    let grains = Pack::fill(&recipe, |_| true).unwrap();
    let refused = grains.proxy(&substance(1.5, &[0.0]), Some(0.0), 1);
    assert_eq!(refused.unwrap_err(), ProxyError::Grains(GrainError::NotFull));
    assert!(grains.proxy(&substance(1.5, &[0.0]), Some(3.5), 1).is_ok());
}

/// Glass balls in a ball of radius `reach`, or in their place a medium, seen from above under a sky of 1 above the horizon and of
/// `below` beneath.
fn heap(grains: &Pack, reach: f64, medium: Homogeneous, below: f32) -> Scene {
    let mut builder = GeometryBuilder::new();
    let group = builder.begin_group();
    builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    for grain in &grains.grains {
        let place = DMat4::from_translation(grain.centre) * DMat4::from_scale(glam::DVec3::splat(grain.radius));
        builder.add_instance(group, &Transform::new(place).unwrap()).unwrap();
    }
    builder.add_sphere(Sphere::new(Vec3::ZERO, reach as f32), &Transform::IDENTITY, false).unwrap();
    let object = |material, interface, granular| Object {
        name: String::new(),
        material: MaterialId(material),
        interface,
        emission: Emission::None,
        body: None,
        granular: Some(granular),
    };
    let inside = Some(MediumInterface { inside: Some(MediumId(0)), outside: None });
    let objects = vec![object(0, None, Granular::Grain), object(1, inside, Granular::Proxy)];
    let glass = Material::Dielectric {
        eta: Index::Constant(1.5),
        alpha: Roughness::constant([0.0; 2]),
        reflection_tint: 1.0.into(),
        transmission_tint: 1.0.into(),
    };
    // From above, looking down.
    let eye = DMat4::from_cols(
        glam::DVec4::X,
        glam::DVec4::Z,
        -glam::DVec4::Y,
        glam::DVec4::new(0.0, 10.0 * reach, 0.0, 1.0),
    );
    let camera = Camera {
        view: View {
            to_world: Transform::new(eye).unwrap(),
            model: CameraModel::Perspective(Perspective::pinhole([-0.1, 0.1, -0.1, 0.1])),
            near: 0.0,
        },
        width: 32,
        height: 32,
        filter: Filter::default(),
        exposure: 1.0,
        medium: None,
        layers: Vec::new(),
    };
    // In the map's own space the left half of an equal-area square has x < 0.
    let pixels = [[below; 3], [1.0; 3], [below; 3], [1.0; 3]];
    let upright = Transform::new(DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2)).unwrap();
    let sky = EnvironmentMap::new(upright, Projection::EqualArea, 2, 2, &pixels, 1.0).unwrap();
    let lights = LightTable::new(vec![Light::Map(Box::new(sky))]);
    let (geometry, proxied) = builder.build_granular(|id: ObjectId| objects[id.0 as usize].granular).unwrap();
    let scene =
        Scene::new(ColorMode::Mono, camera, geometry, objects, vec![glass, Material::Null], vec![medium], lights);
    scene.with_proxy(proxied.unwrap())
}

/// The mean of a picture with its standard error.
fn brightness(scene: &Scene, explicit_grains: Option<u32>, seed: u64) -> (f64, f64) {
    let settings = Settings { spp: 32, seed, ..Settings::default() };
    let rendering = render(scene, &VolPath { explicit_grains, ..VolPath::default() }, &settings, &());
    assert_eq!((rendering.tally.bad_samples, rendering.tally.leaks), (0, 0));
    let pixels = &rendering.film.pixels;
    let variance: f64 = pixels.iter().map(|pixel| f64::from(pixel.standard_error()[0]).powi(2)).sum();
    let n = pixels.len() as f64;
    (pixels.iter().map(|pixel| f64::from(pixel.mean()[0])).sum::<f64>() / n, variance.sqrt() / n)
}

/// Where grains fill 1 % of a ball they are a medium, of `n pi r^2` collisions per length with the phase function that was
/// measured: from packs to packs the pictures differ by chance alone, with none and with two explicit grains. (Centres are uniform
/// in the ball that the medium fills; of what grains are beside points there remain parts of the packing fraction.)
#[test]
fn few_grains_are_a_medium() {
    const REACH: f64 = 150.0;
    const PACKS: u64 = 12;
    const COUNT: u64 = 33_750;
    let mut differences = [0; 2].map(|_| Vec::new());
    let (mut denser, mut total) = (Vec::new(), 0.0);
    let scattering = pack("sphere:4", "ball", "1", 1, 1).scattering(&substance(1.5, &[0.0]), 1).unwrap();
    for seed in 0..PACKS {
        let grains = pack("sphere:151", "ball", "1", COUNT, seed);
        let sigma = COUNT as f64 * PI / (4.0 / 3.0 * PI * REACH.powi(3));
        let medium = |sigma_s: f64| Homogeneous {
            sigma_a: Spectrum::constant(0.0),
            sigma_s: Spectrum::constant(sigma_s as f32),
            emission: None,
            phase: Phase::tabulated(&scattering.phase).unwrap(),
        };
        let scene = heap(&grains, REACH, medium(sigma), 0.0);
        let explicit = brightness(&scene, None, 1 + seed).0;
        total += explicit;
        for (differences, grains) in differences.iter_mut().zip([0, 2]) {
            differences.push(brightness(&scene, Some(grains), 101 + seed).0 - explicit);
        }
        // A tenth more grains.
        let dense = heap(&grains, REACH, medium(1.1 * sigma), 0.0);
        denser.push(brightness(&dense, Some(0), 101 + seed).0 - explicit);
    }
    let z = |differences: &[f64]| {
        let n = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / n;
        let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean / (variance / n).sqrt(), (variance / n).sqrt() / (total / n))
    };
    for (differences, grains) in differences.iter().zip([0, 2]) {
        let (z, error) = z(differences);
        // Student's t of 11 degrees of freedom exceeds 6 once in 11,000 times.
        assert!(z.abs() < 6.0 && error < 0.01, "after {grains}: z = {z}, relative error {error}");
    }
    assert!(z(&denser).0.abs() > 6.0, "a tenth more grains is seen: {:?}", z(&denser));
}

/// Clear grains in a furnace, densely packed, with the medium that was measured for them: 1 for any number of explicit grains.
#[test]
fn clear_grains_and_their_proxy_vanish_in_a_furnace() {
    let grains = pack("sphere:6", "ball", "1", 60, 1);
    let proxy = grains.proxy(&substance(1.5, &[0.0]), None, 1).unwrap();
    let medium = Homogeneous {
        sigma_a: Spectrum::constant(proxy.sigma_a[0] as f32),
        sigma_s: Spectrum::constant(proxy.sigma_s[0] as f32),
        emission: None,
        phase: Phase::tabulated(&proxy.phase).unwrap(),
    };
    let scene = heap(&grains, 6.0, medium, 1.0);
    for explicit_grains in [None, Some(0), Some(1), Some(4)] {
        let (mean, error) = brightness(&scene, explicit_grains, 7);
        // Single precision, over some hundred refractions.
        assert!((mean - 1.0).abs() < 4.5 * error + 2e-5 && error < 0.005, "{explicit_grains:?}: {mean} ± {error}");
    }
}
