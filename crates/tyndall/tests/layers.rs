//! Layers of the film: the first surface, by closed forms; light is not disturbed by them.

mod common;

use common::{World, diffuse};
use tyndall::{
    camera::{CameraModel, Orthographic, Perspective},
    feature::{Facing, Feature, FirstHit, Space},
    film::{Average, Crop, Film, LayerKind, Recorded},
    integrator::VolPath,
    math::Vec3,
    render::{Settings, render},
    sampling::{Sampler, SamplerKind},
    scene::Scene,
    spectrum::Wavelengths,
};

const ALL: [Feature; 10] = [
    Feature::Depth,
    Feature::Position(Space::World),
    Feature::Position(Space::Camera),
    Feature::GeometricNormal(Space::World, Facing::Outward),
    Feature::ShadingNormal(Space::Camera, Facing::Viewer),
    Feature::Primitive,
    Feature::Object,
    Feature::Albedo,
    Feature::Uv,
    Feature::DzDxy(Space::Camera),
];

/// Parallel rays along −z, a square of 2 units a side; a unit sphere at the origin of albedo 0.6, before a wall at
/// z = −1 that only the right half of the picture has.
fn scene(layers: &[Feature]) -> Scene {
    let mut world = World::seen(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
    world.camera.view.model = CameraModel::Orthographic(Orthographic { window: [-2.0, 2.0, -2.0, 2.0] });
    (world.camera.width, world.camera.height) = (40, 40);
    let kind =
        |feature| LayerKind { recorded: Recorded::Surface(feature), channels: Vec::new(), average: Average::Samples };
    world.camera.layers = layers.iter().copied().map(kind).collect();
    world.sphere(Vec3::ZERO, 1.0, diffuse(0.6), None);
    world.cuboid(Vec3::new(-9.0, -9.0, -3.0), Vec3::new(0.0, 9.0, -1.0), diffuse(0.25), None);
    world.sky(1.0);
    world.scene()
}

fn picture(scene: &Scene, crop: Option<Crop>, threads: usize) -> Film {
    let settings = Settings { spp: 64, seed: 2, crop, ..Settings::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| render(scene, &VolPath::default(), &settings, &())).film
}

#[test]
fn light_has_the_same_bits_with_and_without_layers() {
    let (with, without) = (picture(&scene(&ALL), None, 2), picture(&scene(&[]), None, 2));
    assert_eq!(with.pixels, without.pixels);
    assert_eq!(without.layers, []);
}

#[test]
fn layers_do_not_depend_on_threads_or_crop() {
    let scene = scene(&ALL);
    let whole = picture(&scene, None, 1);
    assert_eq!(whole, picture(&scene, None, 5));
    let crop = Crop { min: (5, 9), max: (37, 31) };
    let part = picture(&scene, Some(crop), 2);
    for (layer, cut) in whole.layers.iter().zip(&part.layers) {
        for (i, cell) in cut.cells.iter().enumerate() {
            let (x, y) = (crop.min.0 as usize + i % 32, crop.min.1 as usize + i / 32);
            assert_eq!(*cell, layer.cells[y * 40 + x]);
        }
    }
}

/// A pixel of the sphere, x to the right of the image (the camera looks along −z, so that is +x of the world, or −x when
/// it is mirrored: read from the position), covers 0.1 units: features at its middle, to the curvature within a pixel.
#[test]
fn features_are_those_of_the_first_surface() {
    let film = picture(&scene(&ALL), None, 2);
    let value = |layer: usize, x: usize, y: usize| film.layers[layer].cells[y * 40 + x].value(Average::Samples, 64);
    let near = |a: [f32; 4], b: [f32; 4], by: f32| (0..4).all(|i| (a[i] - b[i]).abs() < by);
    // 3.5 pixels right of and 5.5 below the middle: |x| = 0.35, y = −0.55.
    let (column, row) = (23, 25);
    let p = value(1, column, row);
    assert!((p[0].abs() - 0.35).abs() < 0.01 && (p[1] + 0.55).abs() < 0.01, "{p:?}");
    let z = (1.0f32 - 0.35 * 0.35 - 0.55 * 0.55).sqrt();
    assert!(near(value(0, column, row), [5.0 - z, 0.0, 0.0, 1.0], 0.01));
    assert!(near(value(2, column, row), [0.35, -0.55, 5.0 - z, 1.0], 0.01));
    assert!(near(value(3, column, row), [p[0], -0.55, z, 1.0], 0.01));
    assert!(near(value(4, column, row), [0.35, -0.55, -z, 1.0], 0.01));
    assert!(near(value(6, column, row), [0.0, 0.0, 0.0, 1.0], 1e-6));
    assert!(near(value(7, column, row), [0.6, 0.6, 0.6, 1.0], 1e-5));
    // On the sphere z falls off by x/z and y/z, over 0.1 units a pixel; it is mirrored where x is.
    let slope = value(9, column, row);
    assert!((slope[0].abs() - 0.035 / z).abs() < 1e-3 && (slope[1] - 0.055 / z).abs() < 1e-3, "{slope:?}");
    // In the corners: the wall, object 1, at distance 6 on the side where x < 0, and nothing on the other.
    let corner = if value(6, 1, 1)[3] == 1.0 { 1 } else { 38 };
    assert!(near(value(0, corner, 1), [6.0, 0.0, 0.0, 1.0], 1e-4));
    assert!(near(value(6, corner, 1), [1.0, 0.0, 0.0, 1.0], 1e-6));
    assert!(near(value(7, corner, 1), [0.25, 0.25, 0.25, 1.0], 1e-5));
    assert!((0..ALL.len()).all(|layer| value(layer, 39 - corner, 1) == [0.0; 4]));
}

/// Seen in perspective, `1/z` of a plane is linear over the image: `∂z = −z² ∂(1/z)`, exactly, from the pixels on both sides.
/// In the space of the world z is another combination, of the same points.
#[test]
fn depth_of_a_plane_changes_as_perspective_has_it() {
    let (eye, target) = (Vec3::new(3.0, 4.0, 5.0), Vec3::new(0.2, 0.0, -0.1));
    let mut world = World::seen(eye, target);
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.3, 0.3, -0.2, 0.2]));
    (world.camera.width, world.camera.height) = (60, 40);
    world.cuboid(Vec3::new(-50.0, -9.0, -50.0), Vec3::new(50.0, 0.0, 50.0), diffuse(0.5), None);
    let scene = world.scene();
    let mut sampler = Sampler::new(SamplerKind::Independent, (0, 0), 0, 1);
    let mut at = |x: u32, y: u32, feature| {
        let first = FirstHit::of(&scene, (x, y), [0.5; 4]);
        first.sample(feature, &Wavelengths::Rgb, &mut sampler).map(f64::from)
    };
    for (x, y) in [(10, 10), (30, 20), (50, 35), (5, 38)] {
        let mut place = |x, y| at(x, y, Feature::Position(Space::Camera))[2];
        let z = place(x, y);
        let exact = |before, after| -z * z * (1.0 / after - 1.0 / before) / 2.0;
        let [left, right, above, below] = [place(x - 1, y), place(x + 1, y), place(x, y - 1), place(x, y + 1)];
        let expected = [exact(left, right), exact(above, below)];
        let found = at(x, y, Feature::DzDxy(Space::Camera));
        for side in 0..2 {
            // Five digits are left of the differences of single numbers.
            assert!((found[side] - expected[side]).abs() < 2e-4 * z / 40.0, "{x} {y}: {found:?} {expected:?}");
        }
        // The plane is y = 0: what the derivative in the world leaves out is small of second order.
        let step = at(x + 1, y, Feature::Position(Space::World))[2] - at(x - 1, y, Feature::Position(Space::World))[2];
        let slope = at(x, y, Feature::DzDxy(Space::World))[0];
        assert!((slope - step / 2.0).abs() < 1e-3 * slope.abs() + 1e-5, "{x} {y}: {slope} {step}");
    }
}

/// Half of the samples of a pixel hit something at depth 3: over hits 3, over all 1.5, as a direction 1.
#[test]
fn layers_are_averaged_as_they_say() {
    let mut cell = tyndall::film::Cell::default();
    cell.add([3.0, 0.0, 4.0, 1.0]);
    cell.add([0.0; 4]);
    assert_eq!(cell.value(Average::Samples, 2), [1.5, 0.0, 2.0, 0.5]);
    assert_eq!(cell.value(Average::Hits, 2), [3.0, 0.0, 4.0, 1.0]);
    assert_eq!(cell.value(Average::Directions, 2)[..3], [0.6, 0.0, 0.8]);
    cell.add([-9.0, 0.0, 0.0, 1.0]);
    assert_eq!(cell.value(Average::Sizes, 3)[..3], [3.0, 0.0, 2.0]);
    let mut cell = tyndall::film::Cell::default();
    cell.add([3.0, 0.0, 4.0, 1.0]);
    cell.add([0.0; 4]);
    assert!((cell.standard_error(2)[0] - 1.5).abs() < 1e-6);
}
