//! Rendering with a stopwatch, and comparing with the reference.
//!
//! An estimator with variance `V` a sample that costs `c` a sample reaches the error `MSE = V/N` after the time `N·c`:
//! its efficiency is `1/(V·c)`, independent of how long it runs. `V` is measured as `(MSE − e²)·N`, where `e` is the
//! reference's own standard error, as a mean over pixels and channels. Time is CPU time of all threads, so that what
//! else runs on the machine hardly matters.

use std::{sync::Mutex, time::Duration};

use cpu_time::ProcessTime;
use rayon::ThreadPool;
use tyndall::{
    film::Film,
    integrator::VolPath,
    render::{self, Observer, Settings, render},
    sampling::SamplerKind,
};
use tyndall_formats::film::{Image, Metadata};

use crate::{
    args::{IntegratorName, LectureOptions, word},
    integrators::integrator,
    interrupt,
    load::Loaded,
    progress::Progress,
    report::samples_per_pixel,
    threads::pool,
};

/// The reference has random numbers of its own: were they shared, errors would cancel.
const REFERENCE_SEED: u64 = 1 << 32;

/// A scene on the bench.
pub(crate) struct Bench<'a> {
    loaded: &'a Loaded,
    topic: &'static str,
    options: &'a LectureOptions,
    pool: ThreadPool,
}

/// The image that errors are measured against.
#[derive(Debug)]
pub(crate) struct Reference {
    pub(crate) image: Image,
    /// Its own mean squared error, from its standard errors.
    pub(crate) mse: f64,
    /// Mean over pixels and channels, the unit of relative errors.
    pub(crate) mean: f64,
}

/// One render of one estimator.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) image: Image,
    pub(crate) spp: f64,
    /// CPU time of all threads [s].
    pub(crate) seconds: f64,
    /// Squared error against the reference, its own noise taken off; mean over pixels and channels.
    pub(crate) mse: f64,
    /// CPU time [s] and squared error after each pass.
    pub(crate) course: Vec<(f64, f64)>,
}

impl Run {
    /// Variance of a sample.
    pub(crate) fn variance(&self) -> f64 {
        self.mse * self.spp
    }

    /// CPU time of a sample [µs].
    pub(crate) fn cost(&self) -> f64 {
        1e6 * self.seconds / (self.spp * self.image.mean.len() as f64)
    }

    /// `1/(variance · cost)` [1/µs].
    pub(crate) fn efficiency(&self) -> f64 {
        1.0 / (self.variance() * self.cost())
    }
}

impl<'a> Bench<'a> {
    pub(crate) fn new(loaded: &'a Loaded, topic: &'static str, options: &'a LectureOptions) -> anyhow::Result<Self> {
        Ok(Self { loaded, topic, options, pool: pool(options.threads)? })
    }

    /// The reference, by `volpath`.
    pub(crate) fn reference(&self) -> Reference {
        let settings = self.settings(self.options.reference_spp, REFERENCE_SEED);
        let stopwatch = self.stopwatch("reference", None, None);
        let film = self.render(IntegratorName::Volpath, &settings, &stopwatch);
        let image = self.image(&film, IntegratorName::Volpath, &settings, stopwatch.seconds());
        let mse = image.standard_error.as_deref().map_or(0.0, |se| mean(se, |e| e * e));
        let mean = mean(&image.mean, |v| v);
        Reference { image, mse, mean }
    }

    /// A render of so many samples a pixel.
    pub(crate) fn samples(&self, label: &str, name: IntegratorName, spp: u32, reference: &Reference) -> Run {
        self.run(label, name, &self.settings(spp, 0), None, reference)
    }

    /// A render of so many CPU seconds.
    pub(crate) fn time(&self, label: &str, name: IntegratorName, seconds: f64, reference: &Reference) -> Run {
        self.run(label, name, &self.settings(u32::MAX, 0), Some(seconds), reference)
    }

    fn run(
        &self,
        label: &str,
        name: IntegratorName,
        settings: &Settings,
        limit: Option<f64>,
        reference: &Reference,
    ) -> Run {
        let stopwatch = self.stopwatch(label, limit, Some(reference));
        let film = self.render(name, settings, &stopwatch);
        let seconds = stopwatch.seconds();
        let image = self.image(&film, name, settings, seconds);
        let course = stopwatch.course();
        Run { mse: squared_error(&film, reference), spp: samples_per_pixel(&film), image, seconds, course }
    }

    fn render(&self, name: IntegratorName, settings: &Settings, stopwatch: &Stopwatch) -> Film {
        let integrator = integrator(name, VolPath::default());
        let rendering = self.pool.install(|| render(&self.loaded.scene, integrator.as_ref(), settings, stopwatch));
        stopwatch.progress.finish();
        rendering.film
    }

    /// Independent samples, so that the variance of the mean is that of a sample over their number.
    fn settings(&self, spp: u32, seed: u64) -> Settings {
        Settings { spp, seed, sampler: SamplerKind::Independent, crop: self.loaded.crop, ..Settings::default() }
    }

    fn stopwatch<'b>(&self, label: &str, limit: Option<f64>, reference: Option<&'b Reference>) -> Stopwatch<'b> {
        let limit = limit.map(Duration::from_secs_f64);
        let camera = &self.loaded.scene.camera;
        let progress = Progress::new(
            u64::from(camera.width) * u64::from(camera.height),
            limit,
            limit.is_none(),
            self.options.quiet,
        );
        progress.say(&format!("{} {label}{}", self.topic, if limit.is_some() { ", equal time" } else { "" }));
        Stopwatch { progress, limit, reference, state: Mutex::new(State::new()) }
    }

    fn image(&self, film: &Film, name: IntegratorName, settings: &Settings, seconds: f64) -> Image {
        let metadata = Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: format!("lecture/{}.pbrt", self.topic),
            scene_hash: self.loaded.hash.clone(),
            integrator: word(&name),
            color: "mono".into(),
            sampler: "independent".into(),
            spp: if settings.spp == u32::MAX { 0 } else { settings.spp },
            samples_per_pixel: samples_per_pixel(film),
            seed: settings.seed,
            wall_seconds: seconds,
            ..Metadata::default()
        };
        Image::of(film, metadata)
    }
}

/// Takes the time and the error after each pass, and stops the clock while it looks at the image.
struct Stopwatch<'a> {
    progress: Progress,
    limit: Option<Duration>,
    reference: Option<&'a Reference>,
    state: Mutex<State>,
}

struct State {
    start: ProcessTime,
    paused: Duration,
    /// After the last pass.
    elapsed: Duration,
    course: Vec<(f64, f64)>,
}

impl State {
    fn new() -> Self {
        Self { start: ProcessTime::now(), paused: Duration::ZERO, elapsed: Duration::ZERO, course: Vec::new() }
    }

    fn running(&self) -> Duration {
        self.start.elapsed().saturating_sub(self.paused)
    }
}

impl Stopwatch<'_> {
    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Time until the last pass ended [s].
    fn seconds(&self) -> f64 {
        self.lock().elapsed.as_secs_f64()
    }

    fn course(&self) -> Vec<(f64, f64)> {
        std::mem::take(&mut self.lock().course)
    }
}

impl Observer for Stopwatch<'_> {
    fn cancelled(&self) -> bool {
        interrupt::requested() || {
            let state = self.lock();
            self.limit.is_some_and(|limit| !state.course.is_empty() && state.running() >= limit)
        }
    }

    fn batch_done(&self, progress: render::Progress) {
        self.progress.tell(progress);
    }

    fn pass_done(&self, film: &Film, _: render::Progress) {
        let mut state = self.lock();
        state.elapsed = state.running();
        let looking = ProcessTime::now();
        if let Some(reference) = self.reference {
            let at = state.elapsed.as_secs_f64();
            state.course.push((at, squared_error(film, reference)));
        }
        state.paused += looking.elapsed();
    }
}

/// Mean squared error against the reference, without the reference's own noise.
fn squared_error(film: &Film, reference: &Reference) -> f64 {
    let pairs = film.pixels.iter().zip(&reference.image.mean);
    let sum: f64 = pairs
        .flat_map(|(pixel, truth)| {
            let mean = pixel.mean();
            (0..3).map(move |c| (f64::from(mean[c]) - f64::from(truth[c])).powi(2))
        })
        .sum();
    sum / (3 * film.pixels.len()).max(1) as f64 - reference.mse
}

fn mean(pixels: &[[f32; 3]], f: impl Fn(f64) -> f64) -> f64 {
    pixels.iter().flatten().map(|&v| f(f64::from(v))).sum::<f64>() / (3 * pixels.len()).max(1) as f64
}
