//! Parts of the light: they add up, disturb nothing, and are what depth limits and closed forms say.

mod common;

use common::{World, diffuse, glass, medium};
use tyndall::{
    camera::{CameraModel, Perspective},
    film::{Film, Layer, Part},
    integrator::{Analog, Deep, Integrator, VolPath},
    material::Material,
    math::Vec3,
    render::{Settings, render},
    sampling::SamplerKind,
    scene::Scene,
    spectrum::ColorMode,
};

const KINDS: [Part; 3] = [Part::Emission, Part::Direct, Part::Indirect];
const SCATTERINGS: [Part; 3] = [Part::Unscattered, Part::Single, Part::Multiple];
const ORDERS: [Part; 4] = [Part::Order(0), Part::Order(1), Part::Order(2), Part::Beyond(2)];

/// Milk with a glass boundary and fog without one on a floor, before a lamp and a sky.
fn still_life(color: ColorMode, parts: &[Part]) -> Scene {
    let mut world = World::seen(Vec3::new(0.0, 1.0, 6.0), Vec3::new(0.0, 0.4, 0.0));
    world.color = color;
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.4, 0.4, -0.3, 0.3]));
    (world.camera.width, world.camera.height) = (24, 18);
    world.camera.layers = parts.iter().map(|part| part.layer()).collect();
    let milk = Some(medium([0.01, 0.05, 0.2], [20.0, 30.0, 40.0], 0.7));
    world.sphere(Vec3::new(-1.0, 0.5, 0.0), 0.5, glass(1.4, 0.0), milk);
    let fog = Some(medium([0.1, 0.0, 0.1], [1.0, 2.0, 1.5], 0.0));
    world.cuboid(Vec3::new(-0.2, 0.0, -0.4), Vec3::new(1.4, 1.2, 0.4), Material::Null, fog);
    world.cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 0.0, 9.0), diffuse(0.5), None);
    world.shining_disk(3.0, 0.7, diffuse(0.0), 10.0);
    world.sky(0.3);
    world.scene()
}

fn picture(scene: &Scene, integrator: &dyn Integrator, spp: u32, seed: u64) -> Film {
    let settings = Settings { spp, seed, sampler: SamplerKind::Independent, ..Settings::default() };
    render(scene, integrator, &settings, &()).film
}

fn followed(deep: Deep) -> VolPath {
    VolPath { deep, ..VolPath::default() }
}

/// Every contribution is in exactly one part of a partition. The whole and its parts are sums in single precision of the same
/// numbers: of n ≤ 4096 contributions a sample they differ by less than n half units in the last place, and in the mean of
/// many samples by far less.
#[test]
fn parts_of_the_light_add_up_to_the_image() {
    for color in [ColorMode::Rgb, ColorMode::Spectral] {
        for parts in [&KINDS[..], &SCATTERINGS, &ORDERS] {
            let film = picture(&still_life(color, parts), &VolPath::default(), 16, 1);
            assert_eq!(film.layers.len(), parts.len());
            for (i, pixel) in film.pixels.iter().enumerate() {
                for c in 0..3 {
                    let sum: f64 = film.layers.iter().map(|layer| layer.cells[i].sum[c]).sum();
                    let scale: f64 = film.layers.iter().map(|layer| layer.cells[i].sum_of_squares[c].sqrt()).sum();
                    assert!((sum - pixel.sum[c]).abs() <= 1e-5 * scale, "{color:?} {i}: {sum} {}", pixel.sum[c]);
                }
            }
        }
    }
}

/// Nor do many paths at once mix up what belongs to whom.
#[test]
fn parts_change_no_bit_of_the_image_and_have_their_own_on_every_way() {
    let parts = [KINDS, SCATTERINGS].concat();
    let with = still_life(ColorMode::Rgb, &parts);
    let [together, alone] = [Deep::Together, Deep::Alone].map(|deep| picture(&with, &followed(deep), 8, 3));
    let without = picture(&still_life(ColorMode::Rgb, &[]), &VolPath::default(), 8, 3);
    assert_eq!(together.pixels, without.pixels);
    assert_eq!(together, alone);
    assert!(together.layers.iter().all(|layer| layer.cells.iter().any(|cell| cell.sum[0] > 0.0)), "none is empty");
}

/// The mean of a channel over an image, with its variance.
fn mean(sums: impl Iterator<Item = ([f64; 3], [f64; 3])>, spp: u32) -> (f64, f64) {
    let n = f64::from(spp);
    let (mut sum, mut variance, mut pixels) = (0.0, 0.0, 0.0);
    for (x, xx) in sums {
        sum += x[0] / n;
        variance += (xx[0] / n - (x[0] / n).powi(2)) / (n - 1.0);
        pixels += 1.0;
    }
    (sum / pixels, variance / (pixels * pixels))
}

fn of_layer(layer: &Layer, spp: u32) -> (f64, f64) {
    let three = |v: [f64; 4]| [v[0], v[1], v[2]];
    mean(layer.cells.iter().map(|cell| (three(cell.sum), three(cell.sum_of_squares))), spp)
}

fn assert_alike(what: &str, (a, va): (f64, f64), (b, vb): (f64, f64)) {
    let z = (a - b) / (va + vb).sqrt();
    assert!(z.abs() < 4.0 && b > 0.0, "{what}: {a} and {b}, z = {z}");
}

/// What a path finds before and at its first scattering is what one finds that ends there: by a limit on the depth.
#[test]
fn emission_and_direct_light_are_what_a_depth_limit_leaves() {
    let spp = 256;
    let film = picture(&still_life(ColorMode::Rgb, &KINDS), &VolPath::default(), spp, 5);
    let limited = |depth| {
        let volpath = VolPath { max_depth: Some(depth), ..VolPath::default() };
        let film = picture(&still_life(ColorMode::Rgb, &[]), &volpath, spp, 6 + u64::from(depth));
        mean(film.pixels.iter().map(|pixel| (pixel.sum, pixel.sum_of_squares)), spp)
    };
    let [emission, direct] = [0, 1].map(|i| of_layer(&film.layers[i], spp));
    assert_alike("emission", emission, limited(0));
    assert_alike("emission and direct", (emission.0 + direct.0, emission.1 + direct.1), limited(1));
}

/// Down into an isotropic half-space of albedo ϖ under a sky of radiance 1, once scattered light has the radiance
/// `ϖ/2 ∫ exp(−τ) E₂(τ) dτ = ϖ/2 (1 − ln 2)`, and nothing is seen through it. All of what is scattered once is direct.
#[test]
fn once_scattered_light_of_a_half_space_has_its_closed_form() {
    let albedo = 0.8;
    let mut world = World::seen(Vec3::new(0.0, 0.0, 1.0), Vec3::ZERO);
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-1e-4, 1e-4, -1e-4, 1e-4]));
    (world.camera.width, world.camera.height) = (8, 8);
    world.camera.layers = [KINDS, SCATTERINGS].concat().into_iter().map(Part::layer).collect();
    let dense = Some(medium([1.0 - albedo; 3], [albedo; 3], 0.0));
    world.cuboid(Vec3::new(-1e3, -1e3, -1e3), Vec3::new(1e3, 1e3, 0.0), Material::Null, dense);
    world.sky(1.0);
    let spp = 16_384;
    let film = picture(&world.scene(), &VolPath::default(), spp, 9);
    let single = of_layer(&film.layers[4], spp);
    assert_alike("single", single, (f64::from(albedo) / 2.0 * (1.0 - 2f64.ln()), 0.0));
    assert!(single.1.sqrt() < 2e-3 * single.0, "{single:?}");
    assert_eq!(film.layers[1].cells, film.layers[4].cells, "direct is single");
    assert_eq!(of_layer(&film.layers[3], spp).0, 0.0, "nothing is seen through it");
}

/// An integrator that does not know the histories of its paths must not claim that a part is dark.
#[test]
fn who_cannot_tell_parts_says_nan() {
    assert!(VolPath::default().tells_parts() && !Analog.tells_parts());
    let film = picture(&still_life(ColorMode::Rgb, &[Part::Direct]), &Analog, 1, 1);
    assert!(film.layers[0].cells.iter().all(|cell| cell.sum[0].is_nan()));
    assert!(film.pixels.iter().all(|pixel| pixel.sum[0].is_finite()));
}
