//! Grains and containers of other shapes than balls.

use std::{f64::consts::PI, sync::Arc};

use glam::{DMat3, DVec3};
use tyndall_grains::{
    GrainError,
    container::Container,
    form::Form,
    pack::{Grain, Pack, Recipe},
    radii::Radii,
    settle::settle,
    solid::Solid,
};

const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn triangles() -> Vec<[u32; 3]> {
    FACES.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect()
}

/// A block around a centre.
fn block(half: DVec3, centre: DVec3) -> Solid {
    let corner = |i: u32| centre + half * DVec3::from_array([0, 1, 2].map(|bit| f64::from(2 * (i >> bit & 1)) - 1.0));
    Solid::new(&(0..8).map(corner).collect::<Vec<_>>(), &triangles()).unwrap()
}

fn recipe(container: Container, form: Form, radii: &str, count: u64) -> Recipe {
    Recipe { container, form, radii: radii.parse().unwrap(), count, seed: 9 }
}

/// Perram and Wertheim 1985: ellipsoids are apart if the greatest value over λ of
/// `λ (1 − λ) rᵀ [(1 − λ) A + λ B]⁻¹ r` is more than 1, with `A = R diag(a²) Rᵀ`.
fn contact(axes: DVec3, a: &Grain, b: &Grain) -> f64 {
    let matrix = |grain: &Grain| {
        let turn = DMat3::from_quat(grain.turn);
        turn * DMat3::from_diagonal((grain.radius * axes).powf(2.0)) * turn.transpose()
    };
    let (r, ma, mb) = (b.centre - a.centre, matrix(a), matrix(b));
    let value = |l: f64| l * (1.0 - l) * r.dot((ma * (1.0 - l) + mb * l).inverse() * r);
    (1..400).map(|i| value(f64::from(i) / 400.0)).fold(0.0, f64::max)
}

/// What is told of every pair agrees with a test of other hands; and grains come as close as they can.
#[test]
fn ellipsoids_overlap_when_perram_and_wertheim_say_so() {
    let form = Form::parse("ellipsoid:1:2:3").unwrap();
    let Form::Ellipsoid(axes) = form else { panic!("{form:?}") };
    assert!((axes.element_product() - 1.0).abs() < 1e-12 && (axes.z / axes.x - 3.0).abs() < 1e-12);
    let pack = Pack::fill(&recipe("box:14:14:14".parse().unwrap(), form, "uniform:0.7:1", 280), |_| true).unwrap();
    assert_eq!(pack.grains.len(), 280);
    let pairs = pack.grains.iter().enumerate().flat_map(|(i, a)| pack.grains[..i].iter().map(move |b| (a, b)));
    let least = pairs.map(|(a, b)| contact(axes, a, b)).fold(f64::INFINITY, f64::min);
    assert!((0.9999..1.02).contains(&least), "{least}");
}

/// The surface of a prolate ellipsoid in closed form, and of a block; rays against stereology for both, in a block of a mesh.
#[test]
fn rays_go_as_far_between_grains_of_any_shape_as_stereology_says() {
    let prolate = Form::parse("ellipsoid:1:1:2").unwrap();
    // S = 2π a² (1 + c/(a e) asin e), e² = 1 − a²/c², for the volume of a ball: a = 2^(−1/3), c = 2a.
    let (a, e) = (2f64.powf(-1.0 / 3.0), 0.75f64.sqrt());
    let surface = 2.0 * PI * a * a * (1.0 + 2.0 / e * e.asin());
    assert!((prolate.surface() / surface - 1.0).abs() < 1e-5, "{} {surface}", prolate.surface());
    let brick = Form::mesh(block(DVec3::new(1.0, 2.0, 3.0), DVec3::ONE)).unwrap();
    // 2 (ab + bc + ca) of 2 × 4 × 6, scaled to the volume 4π/3.
    let scaled = 88.0 * (4.0 / 3.0 * PI / 48.0f64).powf(2.0 / 3.0);
    assert!((brick.surface() / scaled - 1.0).abs() < 1e-9, "{} {scaled}", brick.surface());
    let solid = block(DVec3::new(9.0, 8.0, 7.0), DVec3::new(5.0, 0.0, 1.0));
    assert!((solid.volume() - 4032.0).abs() < 1e-6 && (solid.surface() - 1528.0).abs() < 1e-6);
    for form in [prolate, brick] {
        let container = Container::Mesh(Arc::new(solid.clone()));
        let pack = Pack::fill(&recipe(container, form.clone(), "uniform:0.6:1", 250), |_| true).unwrap();
        assert_eq!(pack.grains.len(), 250);
        let rays = pack.free_path_by_rays(30_000, 3).unwrap();
        let off = (rays.mean - pack.free_path_by_formula()) / rays.error;
        assert!(off.abs() < 4.0 && rays.error < 0.01 * rays.mean, "{form:?}: {rays:?}, {off} standard errors off");
    }
}

/// Ellipsoids that have settled overlap nowhere by the same test, and lie at the bottom.
#[test]
fn settled_ellipsoids_overlap_nowhere() {
    let form = Form::parse("ellipsoid:1:1.25:1.6").unwrap();
    let Form::Ellipsoid(axes) = form else { panic!("{form:?}") };
    let settled = settle(&recipe("box:6:6:8".parse().unwrap(), form, "1", 16), 0.3, |_| true).unwrap();
    let grains = settled.pack.grains;
    assert_eq!((grains.len(), settled.removed), (16, 0));
    for (i, a) in grains.iter().enumerate() {
        assert!(grains[..i].iter().all(|b| contact(axes, a, b) > 0.9999), "{a:?}");
    }
    assert!(grains.iter().map(|grain| grain.centre.z).sum::<f64>() < -16.0);
}

#[test]
fn a_mesh_that_bounds_no_body_is_an_error() {
    let points: Vec<DVec3> = (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|bit| f64::from(i >> bit & 1)))).collect();
    let wrong = |points: &[DVec3], triangles: &[[u32; 3]]| Solid::new(points, triangles).unwrap_err().to_string();
    assert!(wrong(&points, &triangles()[..11]).contains("not closed"));
    assert!(wrong(&points, &[]).contains("not closed"));
    assert!(wrong(&points, &triangles().iter().map(|&[a, b, c]| [a, c, b]).collect::<Vec<_>>()).contains("inwards"));
    assert!(wrong(&points[..7], &triangles()).contains("without its vertex"));
    let nan: Vec<DVec3> = points.iter().map(|p| p / 0.0 * 0.0).collect();
    assert!(wrong(&nan, &triangles()).contains("no number"));
    for text in ["cube", "ellipsoid:1:1", "ellipsoid:1:1:11", "ellipsoid:1:nan:1", "ellipsoid:0:1:1"] {
        assert!(Form::parse(text).is_err(), "{text}");
    }
    let long = Form::parse("ellipsoid:1:1:9").unwrap();
    let narrow = Recipe { radii: Radii::Mono(0.45), ..recipe("box:1:1:1".parse().unwrap(), long, "1", 3) };
    assert_eq!(Pack::fill(&narrow, |_| true).unwrap_err(), GrainError::NoRoom);
}
