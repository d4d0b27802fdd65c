//! A goniometer: light falls on a specimen from one direction, and what leaves is told apart by direction.
//!
//! | specimen | light falls | what is shown |
//! |---|---|---|
//! | [`Specimen::Surface`], the BSDF of a material | from above, at an angle | sampled and evaluated, and whether they agree |
//! | [`Specimen::Phase`], a phase function | along +z | sampled and evaluated, and whether they agree |
//! | [`Specimen::Slab`], plane layers | from above, at an angle | what leaves after collisions |
//! | [`Specimen::Grain`], a ball as wide as the beam | along +z | what leaves, and by how many segments of the way were inside |
//! | [`Specimen::Body`], a closed mesh, lit where it is | along +z, the mesh's −z | the same |
//!
//! A [`Map`] has columns of equal azimuth and rows of equal height on the unit sphere (Lambert's cylindrical projection):
//! the cosine to +z falls from 1 in the upper row to −1 in the lower one, azimuth 0 (+x, where light that is mirrored goes)
//! is in the middle. Every pixel has the same solid angle. Its value is the power that leaves per solid angle \[1/sr\], of light
//! of power 1: `f |cos|` of a BSDF. Light that a mirror or glass sends into a single direction (Dirac lobes), and light that
//! passes layers without a collision, is told as `specular`, and is not in the map.
//!
//! Surfaces are sampled as the renderer does it, mixtures, textures and relief included; what passes into another index is
//! told in power and not in radiance, so without its `1/η²`.
//!
//! **Agreement.** Sampling gives a histogram, evaluation at a random place of every pixel its integral; both are means over
//! batches, and so is their difference, whose `z` in each pixel is a standard normal number. Pixels that few samples reach
//! are taken together.

mod agreement;
mod body;
mod grain;
mod surface;

use std::f32::consts::{PI, TAU};

use tyndall::{math::Vec3, phase::Phase, sampling::rng::Rng, shape::Mesh, tally::Tally};

pub use agreement::Agreement;
pub use grain::{Exact, exact as exact_grain};
pub use surface::Surface;

use crate::ball::{self, Source};
use crate::photon::{Detector, Photon, shoot};
use crate::run::{BATCH, Batch, Estimate, Sums, Verdict, photons_of, run};
use crate::slab;
use crate::world::{SetupError, Substance, within};

/// What light falls on.
#[derive(Debug)]
pub enum Specimen {
    /// A material.
    Surface(Box<Surface>),
    /// A phase function.
    Phase(Phase),
    /// Plane layers, by the incidence of the setup.
    Slab(slab::Setup),
    /// A ball of radius 1 [length].
    Grain(Substance),
    /// A grain of any shape.
    Body(Box<Mesh>, Substance),
}

/// Directions, told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Map {
    /// By the cosine to +z.
    pub rows: u32,
    /// By azimuth.
    pub columns: u32,
}

impl Map {
    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        self.rows as usize * self.columns as usize
    }

    /// Of a pixel \[sr\].
    pub fn solid_angle(&self) -> f64 {
        4.0 * std::f64::consts::PI / self.pixels() as f64
    }

    /// The pixel of a direction.
    pub fn pixel(&self, dir: Vec3) -> usize {
        let place = |part: f32, of: u32| ((part * of as f32) as u32).min(of - 1);
        let row = place((0.5 * (1.0 - dir.z)).clamp(0.0, 1.0), self.rows);
        let column = place((dir.y.atan2(dir.x) + PI) / TAU, self.columns);
        row as usize * self.columns as usize + column as usize
    }

    /// The cosines between which a row lies, the greater first.
    pub fn cosines(&self, row: u32) -> [f64; 2] {
        [row, row + 1].map(|edge| 1.0 - 2.0 * f64::from(edge) / f64::from(self.rows))
    }

    /// A direction of a pixel, for two numbers in [0, 1).
    fn direction(self, pixel: usize, [u, v]: [f32; 2]) -> Vec3 {
        let (row, column) = (pixel / self.columns as usize, pixel % self.columns as usize);
        let z = 1.0 - 2.0 * (row as f32 + u) / self.rows as f32;
        let (sin, cos) = ((column as f32 + v) / self.columns as f32 * TAU - PI).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }

    fn check(self) -> Result<(), SetupError> {
        for count in [self.rows, self.columns] {
            within("the rows and columns of a map", f64::from(count), "from 2 to 512", |_| (2..=512).contains(&count))?;
        }
        Ok(())
    }
}

/// What was measured, of light of power 1.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Photons, or samples.
    pub photons: u64,
    /// Leaves at all \[1\]; mean over the channels.
    pub albedo: Estimate,
    /// Leaves into the upper half of the map \[1\].
    pub upper: Estimate,
    /// Leaves into the lower half of the map \[1\].
    pub lower: Estimate,
    /// Of all this, what is not in the map \[1\].
    pub specular: Estimate,
    /// Mean cosine between where light came from and where it goes \[1\]; +1 is straight on.
    pub mean_cosine: Estimate,
    /// Of a grain: leaves unscattered after 0, 1, 2, 3 segments inside \[1\].
    pub by_segments: [Estimate; SEGMENTS],
    /// Power per solid angle \[1/sr\], by channels and pixels.
    pub map: Vec<Vec<Estimate>>,
    /// Whether sampling and evaluation agree, where there is evaluation.
    pub agreement: Option<Agreement>,
}

/// Segments of the way of which light that leaves a grain is told apart.
pub const SEGMENTS: usize = 4;
/// The first quantities: albedo, power times cosine, their product, upper, lower, specular.
const TOTALS: usize = 6;
/// Where the pixels begin.
const PIXELS: usize = TOTALS + SEGMENTS;
/// Lights the specimen.
///
/// # Errors
/// It cannot be.
pub fn measure(
    specimen: &Specimen,
    map: Map,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Measured, SetupError> {
    map.check()?;
    let layout =
        Layout { map, channels: if matches!(specimen, Specimen::Surface(_)) { 3 } else { 1 }, evaluated: false };
    let evaluated = Layout { evaluated: true, ..layout };
    let (layout, sums) = match specimen {
        Specimen::Surface(surface) => {
            let batch = |number| sample(&**surface, &evaluated, number, seed);
            (evaluated, run(evaluated.quantities(), photons, batch, look))
        }
        Specimen::Phase(phase) => {
            let batch = |number| sample(phase, &evaluated, number, seed);
            (evaluated, run(evaluated.quantities(), photons, batch, look))
        }
        Specimen::Slab(setup) => {
            setup.check()?;
            let scene = setup.scene()?;
            let recorder =
                || Recorder { totals: Totals::new(layout), turn: 1.0, travel: None, keep_unscattered: false };
            (layout, shoot(&scene, photons, seed, |photon| setup.ray(photon, seed), recorder, look))
        }
        Specimen::Grain(substance) => {
            let scene = ball::scene(substance, 1.0, Source::Beam)?;
            let ray = |photon| ball::ray_of(Source::Beam, 1.0, photon, seed);
            (layout, shoot(&scene, photons, seed, ray, || Recorder::of_grain(layout), look))
        }
        Specimen::Body(mesh, substance) => {
            let scene = body::scene(mesh, substance)?;
            let ray = |photon| body::ray(&scene, photon, seed);
            (layout, shoot(&scene, photons, seed, ray, || Recorder::of_grain(layout), look))
        }
    };
    Ok(layout.read(&sums))
}

/// Something that is sampled and evaluated.
trait Scatterer: Sync {
    /// What light meets.
    type Met<'s>: Scattering
    where
        Self: 's;
    /// Light comes in; what it meets is drawn at random.
    fn meet<'s>(&'s self, rng: &mut Rng) -> Self::Met<'s>;
}

/// What light has met.
trait Scattering {
    /// The direction of travel before.
    fn travel(&self) -> Vec3;
    /// A direction after, its power by channels \[1\], and whether it is Dirac.
    fn sample(&self, rng: &mut Rng) -> Option<(Vec3, [f64; 3], bool)>;
    /// The power per solid angle that goes into a direction \[1/sr\].
    fn eval(&self, dir: Vec3) -> [f64; 3];
}

/// A batch of samples, and one evaluation in every pixel for it.
fn sample(scatterer: &impl Scatterer, layout: &Layout, batch: u64, seed: u64) -> Batch {
    let mut totals = Totals::new(*layout);
    let stream = |photon: u64, index| Rng::for_sample((photon as u32, (photon >> 32) as u32), index, seed);
    for photon in photons_of(batch) {
        let mut rng = stream(photon, 0);
        let met = scatterer.meet(&mut rng);
        if let Some((dir, power, specular)) = met.sample(&mut rng) {
            totals.leave(dir, met.travel().dot(dir), power, specular);
        }
    }
    let mut rng = stream(batch, 1);
    for pixel in 0..layout.map.pixels() {
        let met = scatterer.meet(&mut rng);
        let dir = layout.map.direction(pixel, [rng.next_1d(), rng.next_1d()]);
        totals.evaluate(pixel, met.eval(dir));
    }
    (totals.finish(), Tally::default())
}

/// What is where among the quantities.
#[derive(Debug, Clone, Copy)]
struct Layout {
    map: Map,
    channels: usize,
    /// Whether there is a second map, by evaluation, and a third one with the difference of both.
    evaluated: bool,
}

impl Layout {
    fn quantities(&self) -> usize {
        let maps = if self.evaluated { 2 * self.channels + 1 } else { self.channels };
        PIXELS + maps * self.map.pixels()
    }

    /// The first quantity of a map.
    fn start(&self, map: usize) -> usize {
        PIXELS + map * self.map.pixels()
    }

    fn read(&self, sums: &Sums) -> Measured {
        let omega = self.map.solid_angle();
        let read = |map: usize| -> Vec<Estimate> {
            let quantities = self.start(map)..self.start(map + 1);
            quantities.map(|quantity| sums.estimate(quantity).scaled(1.0 / omega)).collect()
        };
        let [albedo, cosine, product, upper, lower, specular] = std::array::from_fn(|i| sums.estimate(i));
        Measured {
            photons: sums.photons(),
            mean_cosine: ratio(cosine, albedo, product, sums.batches as f64),
            albedo,
            upper,
            lower,
            specular,
            by_segments: std::array::from_fn(|i| sums.estimate(TOTALS + i)),
            map: (0..self.channels).map(read).collect(),
            agreement: self
                .evaluated
                .then(|| self.compare(sums, (0..self.channels).map(|c| read(self.channels + c)).collect())),
        }
    }
}

/// `a/b` with its error, from the mean of their product over batches.
fn ratio(a: Estimate, b: Estimate, product: Estimate, batches: f64) -> Estimate {
    if b.mean == 0.0 {
        return Estimate { mean: 0.0, standard_error: f64::INFINITY };
    }
    let mean = a.mean / b.mean;
    let covariance = (product.mean - a.mean * b.mean) / (batches - 1.0).max(1.0);
    let variance = a.standard_error.powi(2) + (mean * b.standard_error).powi(2) - 2.0 * mean * covariance;
    Estimate { mean, standard_error: variance.max(0.0).sqrt() / b.mean.abs() }
}

/// The sums of a batch.
struct Totals {
    layout: Layout,
    values: Vec<f64>,
}

impl Totals {
    fn new(layout: Layout) -> Self {
        Self { layout, values: vec![0.0; layout.quantities()] }
    }

    fn leave(&mut self, dir: Vec3, cosine: f32, power: [f64; 3], specular: bool) {
        let channels = self.layout.channels;
        let mean = power[..channels].iter().sum::<f64>() / channels as f64;
        self.values[0] += mean;
        self.values[1] += mean * f64::from(cosine);
        self.values[3 + usize::from(dir.z < 0.0)] += mean;
        if specular {
            self.values[5] += mean;
            return;
        }
        let pixel = self.layout.map.pixel(dir);
        for (c, power) in power[..channels].iter().enumerate() {
            self.values[self.layout.start(c) + pixel] += power;
        }
        if self.layout.evaluated {
            self.values[self.layout.start(2 * channels) + pixel] += mean;
        }
    }

    /// One evaluation in a pixel, for all samples of a batch.
    fn evaluate(&mut self, pixel: usize, density: [f64; 3]) {
        let (channels, by) = (self.layout.channels, BATCH as f64 * self.layout.map.solid_angle());
        for (c, density) in density[..channels].iter().enumerate() {
            self.values[self.layout.start(channels + c) + pixel] += density * by;
        }
        let mean = density[..channels].iter().sum::<f64>() / channels as f64;
        self.values[self.layout.start(2 * channels) + pixel] -= mean * by;
    }

    fn finish(mut self) -> Vec<f64> {
        self.values[2] = self.values[0] * self.values[1] / BATCH as f64;
        self.values
    }
}

/// Watches photons that leave layers or a grain.
struct Recorder {
    totals: Totals,
    /// The map's +z is this times the world's.
    turn: f32,
    /// The direction of travel before, in the map; where it is not given, it is that of the photon.
    travel: Option<Vec3>,
    /// Whether light without a collision is in the map.
    keep_unscattered: bool,
}

impl Recorder {
    fn of_grain(layout: Layout) -> Self {
        Self { totals: Totals::new(layout), turn: -1.0, travel: Some(Vec3::Z), keep_unscattered: true }
    }
}

impl Detector for Recorder {
    fn awaits(&self, _order: u32) -> u32 {
        u32::MAX
    }

    fn leave(&mut self, photon: &Photon) {
        let dir = photon.dir();
        let weight = photon.weight();
        let unscattered = photon.order() == 0;
        let dir_of = |dir: Vec3| Vec3::new(dir.x, dir.y, self.turn * dir.z);
        let travel = self.travel.unwrap_or(dir_of(photon.launched));
        let dir = dir_of(dir);
        self.totals.leave(dir, travel.dot(dir), [weight; 3], unscattered && !self.keep_unscattered);
        if unscattered && photon.vertices() > 0 {
            let segment = photon.vertices() as usize - 1;
            if segment < SEGMENTS {
                self.totals.values[TOTALS + segment] += weight;
            }
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals.finish()
    }
}

/// A phase function in a medium without end.
impl Scatterer for Phase {
    type Met<'s> = &'s Self;

    fn meet<'s>(&'s self, _rng: &mut Rng) -> &'s Self {
        self
    }
}

impl Scattering for &Phase {
    fn travel(&self) -> Vec3 {
        Vec3::Z
    }

    fn sample(&self, rng: &mut Rng) -> Option<(Vec3, [f64; 3], bool)> {
        let cosine = Phase::sample(self, rng.next_1d());
        Some((tyndall::phase::deflect(Vec3::Z, cosine, rng.next_1d()), [1.0; 3], false))
    }

    fn eval(&self, dir: Vec3) -> [f64; 3] {
        [f64::from(Phase::eval(self, dir.z)); 3]
    }
}

#[cfg(test)]
mod tests;
