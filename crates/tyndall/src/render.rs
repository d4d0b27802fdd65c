//! From a scene to a film: tiles, threads, passes, progress, cancellation.
//!
//! The image depends on the scene and the settings alone. Every sample owns its random numbers (pixel, index, seed) and
//! every pixel adds its samples in the order of their index, so threads, tiles, passes and crops cannot be seen in it.

mod allocation;

pub use allocation::Allocation;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use crate::{
    camera::CameraRay,
    feature::FirstHit,
    film::{Cell, Crop, Film, LayerKind, Pixel, Recorded, parts::Share},
    integrator::{CameraSample, Integrator, Parts, TakesApart},
    lpe::Automaton,
    sampling::{Sampler, SamplerKind},
    scene::Scene,
    spectrum::{Lanes, Wavelengths, film_rgb},
    tally::Tally,
};
use allocation::{FIRST_LOOK, Plan};

/// Edge of a tile [pixels].
const TILE: u32 = 16;

/// Samples that are taken together, where there are so many.
const BATCH: u64 = 1 << 12;
/// Samples that are taken together where paths are longest. Few paths deep in a medium are much longer than the others: the more
/// begin together, the more of these walk side by side.
const LARGEST_BATCH: u64 = 1 << 16;
/// Collisions a path above which batches are larger.
const DEEP: u64 = 64;
/// Batches a thread at least, so that none waits long for the others.
const BATCHES: usize = 4;

/// What to render of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Samples a pixel, in the mean of all pixels. The observer may stop earlier.
    pub spp: u32,
    /// Which pixels get more of them than others.
    pub allocation: Allocation,
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
        Self {
            spp: 16,
            allocation: Allocation::Even,
            first_sample: 0,
            seed: 0,
            sampler: SamplerKind::default(),
            crop: None,
        }
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
    /// Asked before every batch of tiles; `true` leaves the rest undone.
    fn cancelled(&self) -> bool {
        false
    }
    /// A batch of tiles has got more samples.
    fn batch_done(&self, _progress: Progress) {}
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
}

impl Tile {
    /// The samples that its pixels still want: which of its pixels, where it is, and the indices.
    fn missing(&self, wanted: impl Fn((u32, u32)) -> u32) -> impl Iterator<Item = (usize, (u32, u32), Range<u32>)> {
        let pixels = self.area.pixels().zip(&self.pixels).enumerate();
        pixels.map(move |(i, (at, pixel))| (i, at, pixel.count as u32..wanted(at)))
    }
}

/// Renders a scene on the current rayon thread pool. Layers that the integrator cannot tell are not on the film.
pub fn render(scene: &Scene, integrator: &dyn Integrator, settings: &Settings, observer: &dyn Observer) -> Rendering {
    let camera = &scene.camera;
    let is_part = |layer: &LayerKind| matches!(layer.recorded, Recorded::Paths(_));
    let paths = scene.paths.as_ref().filter(|_| camera.layers.iter().any(is_part));
    let work = Work { scene, integrator, settings, apart: paths.zip(integrator.apart()) };
    let layers: Vec<_> = camera.layers.iter().filter(|layer| work.can_record(layer)).cloned().collect();
    let mut film =
        Film::new(camera.width, camera.height, settings.crop.unwrap_or(Crop::full(camera.width, camera.height)))
            .with_layers(&layers);
    let mut tiles = tiles_of(film.crop, layers.len());
    let mut plan = Plan::even(film.pixels.len(), settings.spp);
    let samples = AtomicU64::new(0);
    let stopped = AtomicBool::new(false);

    let (mut level, mut tally) = (0, Tally::default());
    while level < plan.end && !stopped.load(Relaxed) {
        level = plan.next_level(level);
        let total = plan.total;
        let wanted = |pixel| plan.samples(film.crop.index(pixel), level);
        let batch = tiles_in_a_batch(&tiles, samples_in_a_batch(&tally, layers.len()), wanted);
        let tallies = tiles.par_chunks_mut(batch).with_max_len(1).map(|tiles| {
            if observer.cancelled() {
                stopped.store(true, Relaxed);
                return Tally::default();
            }
            let tally = work.render_batch(&layers, wanted, tiles);
            let samples = samples.fetch_add(tally.paths, Relaxed) + tally.paths;
            observer.batch_done(Progress { samples, total });
            tally
        });
        tally = tallies.collect::<Vec<_>>().iter().fold(tally, Tally::merged);
        copy_tiles(&tiles, &mut film);
        observer.pass_done(&film, Progress { samples: samples.load(Relaxed), total });
        if level == FIRST_LOOK && settings.allocation == Allocation::ByError {
            plan = Plan::by_error(&film, settings.spp);
        }
    }
    Rendering { film, tally, stopped: stopped.load(Relaxed) }
}

fn tiles_of(crop: Crop, layers: usize) -> Vec<Tile> {
    let mut tiles = Vec::new();
    // Tiles lie on a grid fixed to the image, not to the crop.
    for y in crop.min.1 / TILE..crop.max.1.div_ceil(TILE) {
        for x in crop.min.0 / TILE..crop.max.0.div_ceil(TILE) {
            let tile = Crop { min: (x * TILE, y * TILE), max: ((x + 1) * TILE, (y + 1) * TILE) };
            let area = crop.common(tile);
            let pixels = vec![Pixel::default(); (area.width() * area.height()) as usize];
            if !pixels.is_empty() {
                let cells = vec![Cell::default(); pixels.len() * layers];
                tiles.push(Tile { area, pixels, cells });
            }
        }
    }
    tiles
}

/// Samples that are taken together after paths that did this; fewer where each has many layers, which take memory.
fn samples_in_a_batch(tally: &Tally, layers: usize) -> u64 {
    let collisions = tally.collisions.checked_div(tally.paths).unwrap_or(0);
    let most = LARGEST_BATCH / (1 + layers as u64);
    (BATCH.saturating_mul(collisions) / DEEP).min(most).max(BATCH)
}

/// How many tiles make a batch of so many samples.
fn tiles_in_a_batch(tiles: &[Tile], batch: u64, wanted: impl Fn((u32, u32)) -> u32) -> usize {
    let samples: u64 =
        tiles.iter().map(|tile| tile.missing(&wanted).map(|(.., indices)| indices.len() as u64).sum::<u64>()).sum();
    let (count, batches) = (tiles.len(), BATCHES * rayon::current_num_threads());
    let by_size = (batch * count as u64).checked_div(samples).map_or(count, |tiles| tiles as usize);
    by_size.min(count / batches).max(1)
}

fn copy_tiles(tiles: &[Tile], film: &mut Film) {
    let crop = film.crop;
    let layers = film.layers.len();
    for tile in tiles {
        let columns = tile.area.width() as usize;
        for (row, source) in tile.pixels.chunks(columns).enumerate() {
            let start = crop.index((tile.area.min.0, tile.area.min.1 + row as u32));
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

/// What is to be rendered, and how.
struct Work<'a> {
    scene: &'a Scene,
    integrator: &'a dyn Integrator,
    settings: &'a Settings,
    /// How light is taken apart, if it is.
    apart: Option<(&'a Automaton, &'a dyn TakesApart)>,
}

impl Work<'_> {
    fn can_record(&self, layer: &LayerKind) -> bool {
        self.apart.is_some() || !matches!(layer.recorded, Recorded::Paths(_))
    }

    /// Takes samples until each pixel has as many as `wanted` says.
    fn render_batch(&self, layers: &[LayerKind], wanted: impl Fn((u32, u32)) -> u32, tiles: &mut [Tile]) -> Tally {
        let first = self.settings.first_sample;
        let mut seen = Vec::new();
        for (tile, of) in tiles.iter().enumerate() {
            for (i, at, indices) in of.missing(&wanted) {
                let look = |k| Seen::new(self.scene, self.settings, at, first.saturating_add(k));
                seen.extend(indices.map(|k| ((tile, i), look(k))));
            }
        }
        let mut tally = Tally { paths: seen.len() as u64, ..Tally::default() };
        let passed: Vec<_> = seen.iter().filter(|(_, seen)| seen.weight != 0.0).map(|(_, seen)| seen.sample).collect();
        let parts = match self.apart {
            Some((by, integrator)) => integrator.li_apart(self.scene, by, &passed, &mut tally),
            None => Parts::undivided(self.integrator.li_many(self.scene, &passed, &mut tally)),
        };

        let mut rays = 0..passed.len();
        for ((tile, i), seen) in &seen {
            let Tile { pixels, cells, .. } = &mut tiles[*tile];
            let pixel = &mut pixels[*i];
            let Some(ray) = (seen.weight != 0.0).then(|| rays.next()).flatten() else {
                pixel.add([0.0; 3]);
                continue;
            };
            let radiance = parts.radiance[ray];
            let (value, cells) = (seen.value(self.scene, radiance), &mut cells[i * layers.len()..]);
            seen.fill(self.scene, layers, radiance, cells);
            if radiance.is_finite() && radiance.min_lane() >= 0.0 {
                pixel.add(value);
                if self.apart.is_some() {
                    seen.fill_parts(self.scene, layers, value, parts.of(ray), cells);
                }
            } else {
                // Counted and located, and left out of the sums, which one such sample would spoil for good.
                tally.bad_sample(seen.pixel, seen.index, value);
                pixel.add([0.0; 3]);
            }
        }
        tally
    }
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
        let factor = self.factor(scene);
        film_rgb(radiance, &self.sample.wavelengths).map(|v| v * factor)
    }

    fn factor(&self, scene: &Scene) -> f32 {
        scene.camera.exposure * self.weight
    }

    /// Adds the sample to the layers of its pixel that are no parts of the light.
    fn fill(&self, scene: &Scene, layers: &[LayerKind], radiance: Lanes, cells: &mut [Cell]) {
        let (wavelengths, mut sampler) = (&self.sample.wavelengths, self.sample.sampler);
        let mut first = None;
        for (cell, layer) in cells.iter_mut().zip(layers) {
            let value = match layer.recorded {
                Recorded::Paths(_) => continue,
                Recorded::Light(bands) => bands.sample(radiance, wavelengths).map(|v| v * self.weight),
                Recorded::Surface(feature) => {
                    let first = first.get_or_insert_with(|| {
                        let mut places = self.sample.sampler;
                        FirstHit::of(scene, self.pixel, places.camera())
                    });
                    first.sample(feature, wavelengths, &mut sampler)
                }
            };
            cell.add(value.map(f64::from));
        }
    }

    /// Adds the parts of its light to the layers of its pixel.
    fn fill_parts(
        &self,
        scene: &Scene,
        layers: &[LayerKind],
        value: [f32; 3],
        (total, parts): (&[f64; 4], &[[f64; 4]]),
        cells: &mut [Cell],
    ) {
        if *total == [0.0; 4] {
            return;
        }
        let share = Share::new(&self.sample.wavelengths, self.factor(scene), total, value);
        for (cell, layer) in cells.iter_mut().zip(layers) {
            if let Recorded::Paths(number) = layer.recorded
                && parts[usize::from(number)] != [0.0; 4]
            {
                let [r, g, b] = share.color(&parts[usize::from(number)]);
                cell.add([r, g, b, 0.0]);
            }
        }
    }
}
