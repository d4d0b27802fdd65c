//! From a scene to a film: tiles, threads, passes, progress, cancellation.
//!
//! The image depends on the scene and the settings alone. Every sample owns its random numbers (pixel, index, seed) and
//! every pixel adds its samples in the order of their index, so threads, tiles, passes and crops cannot be seen in it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use crate::{
    camera::CameraRay,
    feature::FirstHit,
    film::{Cell, Crop, Film, Part, Pixel, Recorded},
    integrator::{CameraSample, Integrator},
    sampling::{Sampler, SamplerKind},
    scene::Scene,
    spectrum::{Lanes, Wavelengths, film_rgb},
    tally::Tally,
};

/// Edge of a tile [pixels].
const TILE: u32 = 16;

/// What to render of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Samples a pixel. The observer may stop earlier.
    pub spp: u32,
    /// Index of the first sample: a resumed render begins where the last one ended.
    pub first_sample: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Where the first dimensions of a sample come from.
    pub sampler: SamplerKind,
    /// The part of the image to render; `None` for all.
    pub crop: Option<Crop>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { spp: 16, first_sample: 0, seed: 0, sampler: SamplerKind::default(), crop: None }
    }
}

/// How far a render has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Samples taken so far, over all pixels.
    pub samples: u64,
    /// Samples asked for, over all pixels.
    pub total: u64,
}

/// Watches a render and may stop it. Called from the render's threads.
pub trait Observer: Sync {
    /// Asked before every tile; `true` leaves the rest undone.
    fn cancelled(&self) -> bool {
        false
    }
    /// A tile has got more samples.
    fn tile_done(&self, _progress: Progress) {}
    /// Every pixel has got more samples: a good moment to show the image.
    fn pass_done(&self, _film: &Film, _progress: Progress) {}
}

/// The observer that lets everything pass.
impl Observer for () {}

/// A finished (or stopped) render.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendering {
    /// The image with its errors.
    pub film: Film,
    /// What the paths did.
    pub tally: Tally,
    /// Whether the observer stopped it before all samples were taken.
    pub stopped: bool,
}

/// The pixels of one tile, while they are being rendered.
#[derive(Debug)]
struct Tile {
    area: Crop,
    pixels: Vec<Pixel>,
    /// Layer by layer of a pixel, pixel by pixel.
    cells: Vec<Cell>,
    tally: Tally,
}

/// Renders a scene on the current rayon thread pool.
pub fn render(scene: &Scene, integrator: &dyn Integrator, settings: &Settings, observer: &dyn Observer) -> Rendering {
    let camera = &scene.camera;
    let mut film =
        Film::new(camera.width, camera.height, settings.crop.unwrap_or(Crop::full(camera.width, camera.height)))
            .with_layers(&camera.layers);
    let mut tiles = tiles_of(film.crop, camera.layers.len());
    let total = film.pixels.len() as u64 * u64::from(settings.spp);
    let samples = AtomicU64::new(0);
    let stopped = AtomicBool::new(false);

    for pass in passes(settings.spp) {
        tiles.par_iter_mut().with_max_len(1).for_each(|tile| {
            if observer.cancelled() {
                stopped.store(true, Relaxed);
                return;
            }
            let first = settings.first_sample.saturating_add(pass.start);
            let last = settings.first_sample.saturating_add(pass.end);
            render_tile(scene, integrator, settings, first..last, tile);
            let taken = tile.pixels.len() as u64 * u64::from(pass.end - pass.start);
            let samples = samples.fetch_add(taken, Relaxed) + taken;
            observer.tile_done(Progress { samples, total });
        });
        copy_tiles(&tiles, &mut film);
        observer.pass_done(&film, Progress { samples: samples.load(Relaxed), total });
        if stopped.load(Relaxed) {
            break;
        }
    }
    let tally = tiles.iter().fold(Tally::default(), |sum, tile| sum.merged(&tile.tally));
    Rendering { film, tally, stopped: stopped.load(Relaxed) }
}

/// Sample ranges of the passes: 1, 1, 2, 4, … at most 32 at a time, so that a first image comes at once and later
/// passes cost little to show.
fn passes(spp: u32) -> impl Iterator<Item = std::ops::Range<u32>> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let size = start.clamp(1, 32).min(spp - start);
        let range = start..start + size;
        start = range.end;
        (!range.is_empty()).then_some(range)
    })
}

fn tiles_of(crop: Crop, layers: usize) -> Vec<Tile> {
    let mut tiles = Vec::new();
    // Tiles lie on a grid fixed to the image, not to the crop.
    for y in crop.min.1 / TILE..crop.max.1.div_ceil(TILE) {
        for x in crop.min.0 / TILE..crop.max.0.div_ceil(TILE) {
            let area = Crop {
                min: (crop.min.0.max(x * TILE), crop.min.1.max(y * TILE)),
                max: (crop.max.0.min((x + 1) * TILE), crop.max.1.min((y + 1) * TILE)),
            };
            let pixels = vec![Pixel::default(); (area.width() * area.height()) as usize];
            if !pixels.is_empty() {
                let cells = vec![Cell::default(); pixels.len() * layers];
                tiles.push(Tile { area, pixels, cells, tally: Tally::default() });
            }
        }
    }
    tiles
}

fn copy_tiles(tiles: &[Tile], film: &mut Film) {
    let crop = film.crop;
    let layers = film.layers.len();
    for tile in tiles {
        let columns = tile.area.width() as usize;
        for (row, source) in tile.pixels.chunks(columns).enumerate() {
            let y = tile.area.min.1 - crop.min.1 + row as u32;
            let start = (y * crop.width() + (tile.area.min.0 - crop.min.0)) as usize;
            film.pixels[start..start + columns].copy_from_slice(source);
            for (i, layer) in film.layers.iter_mut().enumerate() {
                let cells = tile.cells.iter().skip(row * columns * layers + i).step_by(layers);
                for (to, from) in layer.cells[start..start + columns].iter_mut().zip(cells) {
                    *to = *from;
                }
            }
        }
    }
}

fn render_tile(
    scene: &Scene,
    integrator: &dyn Integrator,
    settings: &Settings,
    samples: std::ops::Range<u32>,
    tile: &mut Tile,
) {
    let seen: Vec<_> = tile
        .area
        .pixels()
        .flat_map(|pixel| samples.clone().map(move |index| Seen::new(scene, settings, pixel, index)))
        .collect();
    tile.tally.paths += seen.len() as u64;
    let passed: Vec<_> = seen.iter().filter(|seen| seen.weight != 0.0).map(|seen| seen.sample).collect();
    let kinds = parts_of(scene);
    let found = integrator.li_many(scene, &passed, &kinds, &mut tile.tally);
    let mut radiances = found.radiance.into_iter().enumerate();
    let none = vec![Lanes::ZERO; kinds.len()];

    let (layers, per_pixel) = (scene.camera.layers.len(), samples.len());
    for (i, seen) in seen.iter().enumerate() {
        let pixel = &mut tile.pixels[i / per_pixel];
        let Some((ray, radiance)) = (seen.weight != 0.0).then(|| radiances.next()).flatten() else {
            pixel.add([0.0; 3]);
            continue;
        };
        let value = seen.value(scene, radiance);
        let cells = &mut tile.cells[i / per_pixel * layers..][..layers];
        if radiance.is_finite() && radiance.min_lane() >= 0.0 {
            seen.fill(scene, radiance, &found.parts[ray * kinds.len()..][..kinds.len()], cells);
            pixel.add(value);
        } else {
            seen.fill(scene, Lanes::ZERO, &none, cells);
            // Counted and located, and left out of the sums, which one such sample would spoil for good.
            tile.tally.bad_sample(seen.pixel, seen.index, value);
            pixel.add([0.0; 3]);
        }
    }
}

/// The parts of the light that the film records.
fn parts_of(scene: &Scene) -> Vec<Part> {
    let part = |recorded| if let Recorded::Part(part) = recorded { Some(part) } else { None };
    scene.camera.layers.iter().filter_map(|layer| part(layer.recorded)).collect()
}

/// A sample of a pixel, as the camera sees it.
struct Seen {
    pixel: (u32, u32),
    index: u32,
    /// What it weighs: nothing if the lens stopped it \[1\].
    weight: f32,
    sample: CameraSample,
}

impl Seen {
    fn new(scene: &Scene, settings: &Settings, pixel: (u32, u32), index: u32) -> Self {
        let mut sampler = Sampler::new(settings.sampler, pixel, index, settings.seed);
        let CameraRay { ray, weight } = scene.camera.sample_ray(pixel, sampler.camera());
        let [u_wavelength, u_hero] = sampler.wavelength();
        let wavelengths = Wavelengths::sample(scene.color, u_wavelength);
        let sample = CameraSample { ray, wavelengths, u_hero, sampler };
        Self { pixel, index, weight, sample }
    }

    /// Linear sRGB (which may be negative for a single wavelength, and where the filter is).
    fn value(&self, scene: &Scene, radiance: Lanes) -> [f32; 3] {
        let factor = scene.camera.exposure * self.weight;
        film_rgb(radiance, &self.sample.wavelengths).map(|v| v * factor)
    }

    /// Adds the sample to the layers of its pixel.
    fn fill(&self, scene: &Scene, radiance: Lanes, parts: &[Lanes], cells: &mut [Cell]) {
        let (wavelengths, mut sampler) = (&self.sample.wavelengths, self.sample.sampler);
        let mut parts = parts.iter();
        let mut first = None;
        for (cell, layer) in cells.iter_mut().zip(&scene.camera.layers) {
            cell.add(match layer.recorded {
                Recorded::Light(bands) => bands.sample(radiance, wavelengths).map(|v| v * self.weight),
                Recorded::Part(_) => {
                    let [r, g, b] = self.value(scene, parts.next().copied().unwrap_or(Lanes::ZERO));
                    [r, g, b, 0.0]
                }
                Recorded::Surface(feature) => {
                    let first = first.get_or_insert_with(|| {
                        let mut places = self.sample.sampler;
                        FirstHit::of(scene, self.pixel, places.camera())
                    });
                    first.sample(feature, wavelengths, &mut sampler)
                }
            });
        }
    }
}
