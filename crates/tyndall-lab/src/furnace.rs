//! The furnace: any scene in uniform light. Whatever neither absorbs nor shines cannot be seen in it, wherever light goes:
//! each pixel is 1. What is darker has lost energy, what is brighter has made some.
//!
//! - [`furnace`] puts a scene into it: its lights go out, the sky shines with radiance 1; with `lossless` media lose their
//!   absorption, so that only surfaces can take light.
//! - [`judge`] holds an image of it against 1, tile by tile: independent pixels make `z = (mean − 1) / s.e.` of every tile
//!   and channel, and of the whole image, a standard normal number. The greatest and the least of each are judged together,
//!   with Šidák's correction for their number.
//! - [`balance`] follows photons along the camera's rays, and tells which materials and media have taken what is missing.
//!
//! A camera inside of a body of index n sees n², which is what [`Balance::expected`] says.

use std::sync::Arc;

use statrs::distribution::{ContinuousCDF, Normal};
use tyndall::{
    camera::CameraModel,
    film::{Film, Filter},
    light::{ConstantEnvironment, Light, LightTable},
    sampling::rng::Rng,
    scene::{Emission, Scene},
    shape::Interaction,
    spectrum::Spectrum,
};

use crate::photon::{Collision, Detector, Photon, shoot};
use crate::point::source_stream;
use crate::run::{Estimate, Sums, Verdict};
use crate::world::SetupError;

/// Relative error that single precision may leave in a pixel.
const ARITHMETIC: f64 = 2e-6;

/// The scene with the sky as its only light, of radiance 1; without absorption of media if it is to be `lossless`.
///
/// # Errors
/// Its camera does not measure radiance.
pub fn furnace(scene: Scene, lossless: bool) -> Result<Scene, SetupError> {
    let Scene { color, mut camera, geometry, mut objects, materials, mut media, .. } = scene;
    let measures_radiance = matches!(
        camera.view.model,
        CameraModel::Perspective(_)
            | CameraModel::Orthographic(_)
            | CameraModel::Spherical(_)
            | CameraModel::RadianceMeter(_)
    );
    if !measures_radiance {
        return Err(SetupError::Missing("radiance in what this camera measures: put another into the scene"));
    }
    (camera.filter, camera.exposure, camera.layers) = (Filter::default(), 1.0, Vec::new());
    for object in Arc::make_mut(&mut objects) {
        object.emission = Emission::None;
    }
    for medium in Arc::make_mut(&mut media) {
        medium.emission = None;
        if lossless {
            medium.sigma_a = Spectrum::constant(0.0);
        }
    }
    let sky = ConstantEnvironment { radiance: Spectrum::constant(1.0), luminance: 1.0 };
    let lights = LightTable::new(vec![Light::Constant(sky)]);
    Ok(Scene::new(color, camera, geometry, objects, materials, media, lights))
}

/// A tile of an image in the furnace.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Tile {
    /// Its upper left pixel.
    pub corner: [u32; 2],
    /// Its mean radiance by channels.
    pub mean: [f64; 3],
    /// `(mean − expected) / s.e.` by channels.
    pub z: [f64; 3],
}

/// What an image in the furnace shows.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Judgement {
    /// What each pixel would be without gain or loss.
    pub expected: f64,
    /// The mean of the image by channels.
    pub mean: [Estimate; 3],
    /// All tiles.
    pub tiles: Vec<Tile>,
    /// The chance that an image as bright is noise.
    pub p_made: f64,
    /// The chance that an image as dark is noise.
    pub p_lost: f64,
}

impl Judgement {
    /// The tile with the greatest z.
    pub fn brightest(&self) -> Option<&Tile> {
        self.tiles.iter().max_by(|a, b| greatest(&a.z).total_cmp(&greatest(&b.z)))
    }

    /// The tile with the least z.
    pub fn darkest(&self) -> Option<&Tile> {
        self.tiles.iter().min_by(|a, b| least(&a.z).total_cmp(&least(&b.z)))
    }
}

/// Holds the image of a furnace against what it should be, in tiles of `edge` pixels.
pub fn judge(film: &Film, expected: f64, edge: u32) -> Judgement {
    let crop = &film.crop;
    let columns = crop.width().div_ceil(edge);
    let tile = |i: u32| {
        let (x, y) = (i % columns * edge, i / columns * edge);
        let row = |row: u32| (x..crop.width().min(x + edge)).map(move |column| row * crop.width() + column);
        let pixels: Vec<u32> = (y..crop.height().min(y + edge)).flat_map(row).collect();
        let mean = of_pixels(film, &pixels);
        Tile {
            corner: [crop.min.0 + x, crop.min.1 + y],
            mean: mean.map(|m| m.mean),
            z: mean.map(|m| deviation(&m, expected)),
        }
    };
    let tiles: Vec<Tile> = (0..columns * crop.height().div_ceil(edge)).map(tile).collect();
    let mean = of_pixels(film, &(0..film.pixels.len() as u32).collect::<Vec<_>>());
    let whole = mean.map(|m| deviation(&m, expected));
    let count = 3 * tiles.len();
    let above = tiles.iter().map(|tile| greatest(&tile.z)).fold(f64::NEG_INFINITY, f64::max);
    let below = tiles.iter().map(|tile| least(&tile.z)).fold(f64::INFINITY, f64::min);
    let chance = |of_tiles: f64, of_all: f64| sidak(sidak(tail(of_tiles), count).min(sidak(tail(of_all), 3)), 2);
    Judgement { expected, mean, p_made: chance(above, greatest(&whole)), p_lost: chance(-below, -least(&whole)), tiles }
}

fn greatest(z: &[f64; 3]) -> f64 {
    z.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn least(z: &[f64; 3]) -> f64 {
    z.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The mean over pixels, which are independent.
fn of_pixels(film: &Film, pixels: &[u32]) -> [Estimate; 3] {
    let n = pixels.len().max(1) as f64;
    std::array::from_fn(|c| {
        let of = |i: &u32| &film.pixels[*i as usize];
        let mean = pixels.iter().map(|i| f64::from(of(i).mean()[c])).sum::<f64>() / n;
        let variance = pixels.iter().map(|i| f64::from(of(i).standard_error()[c]).powi(2)).sum::<f64>();
        Estimate { mean, standard_error: variance.sqrt() / n }
    })
}

fn deviation(m: &Estimate, expected: f64) -> f64 {
    (m.mean - expected) / m.standard_error.hypot(ARITHMETIC * expected)
}

/// The chance of a standard normal number above `z`.
fn tail(z: f64) -> f64 {
    Normal::standard().cdf(-z)
}

/// The chance of the least of `count` independent chances.
fn sidak(p: f64, count: usize) -> f64 {
    -(count as f64 * (-p.min(1.0)).ln_1p()).exp_m1()
}

/// Where the light of a camera's rays goes.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Balance {
    /// Photons.
    pub photons: u64,
    /// Radiance that a pixel has if nothing is lost: the index around the camera, squared \[1\].
    pub expected: f64,
    /// Escapes to the sky \[1\].
    pub escaped: Estimate,
    /// Taken by each material \[1\]; those that a material is made of are not told apart.
    pub by_material: Vec<Estimate>,
    /// Taken by each medium, and last where several share a place \[1\].
    pub by_medium: Vec<Estimate>,
    /// Paths that left a medium without meeting its boundary, by rounding.
    pub leaks: u64,
    /// Crossings into more bodies than a path can keep count of.
    pub lost_bodies: u64,
}

/// Follows photons along rays of the camera through a scene that [`furnace`] has made, in grey.
pub fn balance(scene: &Scene, photons: u64, seed: u64, look: impl FnMut(&Sums) -> Verdict) -> Balance {
    let (materials, media) = (scene.materials.len(), scene.media.len());
    // Escaped, its compression, then materials, media and mixtures of media.
    let recorder = || Recorder { scene, totals: vec![0.0; 2 + materials + media + 1] };
    let ray = |photon| {
        let mut rng: Rng = source_stream(photon, seed);
        let mut pixel = |size: u32| ((f64::from(rng.next_1d()) * f64::from(size)) as u32).min(size - 1);
        let at = (pixel(scene.camera.width), pixel(scene.camera.height));
        scene.camera.sample_ray(at, std::array::from_fn(|_| rng.next_1d())).ray
    };
    let sums = shoot(scene, photons, seed, ray, recorder, look);
    let [escaped, compressed] = [0, 1].map(|i| sums.estimate(i));
    Balance {
        photons: sums.photons(),
        expected: if escaped.mean > 0.0 { compressed.mean / escaped.mean } else { 1.0 },
        escaped,
        by_material: sums.estimates(2..2 + materials),
        by_medium: sums.estimates(2 + materials..2 + materials + media + 1),
        leaks: sums.tally.leaks,
        lost_bodies: sums.tally.lost_bodies,
    }
}

struct Recorder<'a> {
    scene: &'a Scene,
    totals: Vec<f64>,
}

impl Detector for Recorder<'_> {
    fn awaits(&self, _order: u32) -> u32 {
        u32::MAX
    }

    fn collide(&mut self, c: &Collision) {
        let media = 2 + self.scene.materials.len();
        let medium = c.medium.map_or(self.scene.media.len(), |id| id.0 as usize);
        self.totals[media + medium] += c.absorbed;
    }

    fn meet(&mut self, surface: &Interaction, lost: f64) {
        self.totals[2 + self.scene.object(surface).material.0 as usize] += lost;
    }

    fn leave(&mut self, photon: &Photon) {
        self.totals[0] += photon.weight();
        self.totals[1] += photon.weight() * photon.compression();
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tyndall::{
        integrator::VolPath,
        render::{Settings, render},
        sampling::SamplerKind,
    };

    use super::*;
    use crate::world::{Substance, World};

    fn all(_: &Sums) -> Verdict {
        Verdict::GoOn
    }

    /// A ball with a camera in front of it that sees nothing else.
    fn ball(substance: Substance, lossless: bool) -> Scene {
        let mut world = World::default();
        world.sphere(1.0, &substance, &Substance::VACUUM).unwrap();
        let mut scene = world.build(&Substance::VACUUM, DVec3::new(0.0, 0.0, -4.0)).unwrap();
        (scene.camera.width, scene.camera.height) = (16, 16);
        if let CameraModel::Perspective(camera) = &mut scene.camera.view.model {
            *camera = tyndall::camera::Perspective::pinhole([-0.15, 0.15, -0.15, 0.15]);
        }
        furnace(scene, lossless).unwrap()
    }

    fn judged(scene: &Scene) -> Judgement {
        let settings = Settings { spp: 64, sampler: SamplerKind::Independent, ..Settings::default() };
        judge(&render(scene, &VolPath::default(), &settings, &()).film, 1.0, 8)
    }

    const GLOSSY: Substance = Substance { sigma_a: 0.4, sigma_s: 3.0, g: 0.6, n: 1.5 };

    /// A ball that scatters and refracts, and takes nothing, cannot be seen.
    #[test]
    fn a_ball_without_absorption_keeps_energy() {
        let scene = ball(GLOSSY, true);
        let judgement = judged(&scene);
        assert!(judgement.p_made > 1e-3 && judgement.p_lost > 1e-3, "{judgement:?}");
        let balance = balance(&scene, 20_000, 1, all);
        let z = (balance.escaped.mean - 1.0) / balance.escaped.standard_error.max(1e-7);
        assert!(z.abs() < 4.0 && (balance.expected - 1.0).abs() < 1e-5, "{balance:?}");
        assert!(balance.by_medium.iter().all(|medium| medium.mean.abs() < 1e-6), "{balance:?}");
    }

    /// What a ball is darker by is what its medium has taken, by another walk: without light sampling, and in power.
    #[test]
    fn what_is_missing_is_what_was_absorbed() {
        let scene = ball(GLOSSY, false);
        let judgement = judged(&scene);
        assert!(judgement.p_lost < 1e-6 && judgement.p_made > 0.5, "{judgement:?}");
        let balance = balance(&scene, 100_000, 1, all);
        let (image, taken) = (judgement.mean[0], balance.by_medium[0]);
        let z = (1.0 - image.mean - taken.mean) / image.standard_error.hypot(taken.standard_error);
        assert!(z.abs() < 4.0 && taken.mean > 0.1, "{image:?} {taken:?}");
        let sum = balance.escaped.mean + taken.mean + balance.by_material.iter().map(|m| m.mean).sum::<f64>();
        assert!((sum - 1.0).abs() < 0.01, "{balance:?}");
    }

    /// A surface that reflects half a percent too much is found out, and where.
    #[test]
    fn a_surface_that_makes_energy_is_found() {
        let mut scene = ball(Substance { sigma_s: 0.0, sigma_a: 0.0, ..GLOSSY }, false);
        for material in Arc::make_mut(&mut scene.materials) {
            if let tyndall::material::Material::Dielectric { transmission_tint, .. } = material {
                *transmission_tint = 1.0025.into();
            }
        }
        let judgement = judged(&scene);
        assert!(judgement.p_made < 1e-4, "{judgement:?}");
        let brightest = judgement.brightest().unwrap();
        assert!(greatest(&brightest.mean) > 1.001 && judgement.darkest().is_some());
    }

    /// From inside of glass the furnace has radiance n².
    #[test]
    fn a_camera_in_glass_sees_the_index_squared() {
        let glass = Substance { sigma_s: 0.0, sigma_a: 0.0, ..GLOSSY };
        let mut world = World::default();
        world.sphere(1.0, &glass, &Substance::VACUUM).unwrap();
        let scene = furnace(world.build(&glass, DVec3::new(0.0, 0.0, 0.2)).unwrap(), false).unwrap();
        let balance = balance(&scene, 5_000, 1, all);
        assert!((balance.expected - 2.25).abs() < 1e-4, "{balance:?}");
        let film = render(&scene, &VolPath::default(), &Settings { spp: 256, ..Settings::default() }, &()).film;
        assert!((film.pixels[0].mean()[0] - 2.25).abs() < 0.02, "{:?}", film.pixels[0].mean());
    }
}
