//! `tyndall render SCENE`.

use std::{process::ExitCode, time::Instant};

use anyhow::ensure;
use cpu_time::ProcessTime;
use rayon::ThreadPool;
use tyndall::{
    film::{Crop, Film},
    integrator::{Integrator, VolPath},
    render::{Allocation, Rendering, Settings, render},
    sampling::SamplerKind,
    spectrum::ColorMode,
};
use tyndall_formats::film::{Image, Metadata};

use crate::{
    args::{ColorName, IntegratorName, RenderOptions, SamplerName, word},
    beside::Beside,
    integrators::{self, integrator},
    interrupt,
    load::{Loaded, load},
    outputs::{Outputs, command_line, write_text},
    progress::Progress,
    report::{Course, End, Startup, Statistics, samples_per_pixel},
    tev::Tev,
    threads::pool,
    watch::Watch,
};

/// A film needs 56 bytes a pixel: this one 15 GB.
const MOST_PIXELS: u64 = 1 << 28;

/// Loads, renders, saves, tells.
pub(crate) fn run(options: &RenderOptions) -> anyhow::Result<ExitCode> {
    interrupt::listen()?;
    let outputs = Outputs::new(&options.output, &options.input.scene, options.tone.into())?;
    outputs.check()?;
    let pool = pool(options.threads)?;
    let loaded = pool
        .install(|| load(&options.input, options.resolution, options.color.map(color_mode), options.layers.as_ref()))?;
    loaded.warn();
    let settings = settings(options, &loaded)?;
    let beside = beside(options, &loaded)?;
    let job = Job { options, loaded: &loaded, settings, beside, outputs: &outputs, pool, start: Instant::now() };

    let cpu = ProcessTime::now();
    let rendering = job.render();
    let cpu_seconds = cpu.elapsed().as_secs_f64();
    if rendering.tally.paths == 0 {
        eprintln!("stopped before the first sample: nothing was saved");
        return Ok(ExitCode::from(interrupt::EXIT));
    }

    let image = Image::of(&rendering.film, job.metadata(&rendering.film));
    outputs.write(&image)?;
    let statistics = job.statistics(&image, &rendering, cpu_seconds);
    if !options.quiet {
        eprintln!("{}", statistics.sentences());
    }
    if let Some(to) = &options.json {
        write_text(to, &serde_json::to_string_pretty(&statistics)?)?;
    }
    Ok(match statistics.ended {
        End::Interrupted => {
            eprintln!("stopped by Ctrl-C: {} what is done", outputs.hold());
            ExitCode::from(interrupt::EXIT)
        }
        End::Complete | End::Time => ExitCode::SUCCESS,
    })
}

/// A render on its way.
struct Job<'a> {
    options: &'a RenderOptions,
    loaded: &'a Loaded,
    settings: Settings,
    /// Paths with proxies of grains, if there are such.
    beside: Option<Beside>,
    outputs: &'a Outputs,
    pool: ThreadPool,
    start: Instant,
}

impl Job<'_> {
    fn render(&self) -> Rendering {
        let Self { options, loaded, settings, .. } = self;
        let alone = integrator(options.integrator, path_tracer(options, loaded));
        let integrator: &dyn Integrator = self.beside.as_ref().map_or(alone.as_ref(), |beside| beside);
        let camera = &loaded.scene.camera;
        let crop = settings.crop.unwrap_or(Crop::full(camera.width, camera.height));
        let pixels = u64::from(crop.width()) * u64::from(crop.height());
        let progress = Progress::new(pixels, options.time, settings.spp < u32::MAX, options.quiet);
        let tev = options.tev.as_deref().and_then(|address| self.tev(address, &progress));
        let save = |film: &Film| self.outputs.write(&Image::of(film, self.metadata(film)));
        let watch = Watch::new(progress, options.time, save, tev);

        let rendering = self.pool.install(|| render(&loaded.scene, integrator, settings, &watch));
        watch.progress.finish();
        rendering
    }

    /// A connection to the viewer; without one the render goes on.
    fn tev(&self, address: &str, progress: &Progress) -> Option<Tev> {
        Tev::connect(address, &self.options.input.scene.display().to_string())
            .map_err(|error| progress.say(&format!("warning: {error:#}")))
            .ok()
    }

    /// How the image was made, as far as it has come.
    fn metadata(&self, film: &Film) -> Metadata {
        let Self { options, loaded, settings, .. } = self;
        Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: options.input.scene.display().to_string(),
            scene_hash: loaded.hash.clone(),
            integrator: word(&options.integrator),
            color: word(&color_name(loaded.scene.color)),
            sampler: word(&options.sampler),
            spp: if settings.spp == u32::MAX { 0 } else { settings.spp },
            samples_per_pixel: samples_per_pixel(film),
            seed: settings.seed,
            crop: format!("{},{},{},{}", film.crop.min.0, film.crop.min.1, film.crop.max.0, film.crop.max.1),
            wall_seconds: self.start.elapsed().as_secs_f64(),
            command: command_line(),
        }
    }

    fn statistics(&self, image: &Image, rendering: &Rendering, cpu_seconds: f64) -> Statistics {
        let ended = match rendering.stopped {
            false => End::Complete,
            true if interrupt::requested() => End::Interrupted,
            true => End::Time,
        };
        let course = Course {
            threads: self.pool.current_num_threads(),
            outputs: self.outputs.files.iter().map(|f| f.display().to_string()).collect(),
            ended,
            startup: Startup { load: self.loaded.load_seconds, build: self.loaded.build_seconds },
            cpu_seconds,
            proxy: self.beside.as_ref().map(Beside::difference),
        };
        Statistics::new(image, image.metadata.clone().unwrap_or_default(), &rendering.tally, course)
    }
}

/// The settings of paths among grains without a proxy.
fn path_tracer(options: &RenderOptions, loaded: &Loaded) -> VolPath {
    let said = integrators::explicit(&loaded.desc.integrator);
    VolPath { max_depth: options.max_depth.or(said.max_depth), ..said }
}

/// Paths with proxies of grains, if they are asked for.
fn beside(options: &RenderOptions, loaded: &Loaded) -> anyhow::Result<Option<Beside>> {
    let said = loaded.desc.integrator.explicit_grains.map(|grains| grains.value);
    let Some(grains) = options.explicit_grains.or(said) else { return Ok(None) };
    ensure!(
        loaded.scene.proxied().is_some(),
        "no shape of this scene stands for grains: `tyndall pack --proxy` writes one, or leave out --explicit-grains"
    );
    let explicit = path_tracer(options, loaded);
    let proxied = VolPath { explicit_grains: Some(grains), ..explicit };
    let [proxied, explicit] = [proxied, explicit].map(|settings| integrator(options.integrator, settings));
    ensure!(
        proxied.apart().is_some(),
        "{} knows no proxies of grains: render with volpath, or without them",
        word(&options.integrator)
    );
    Ok(Some(Beside::new(proxied, explicit, grains)))
}

/// What the command line says, and where it is silent, the scene.
fn settings(options: &RenderOptions, loaded: &Loaded) -> anyhow::Result<Settings> {
    ensure!(
        options.max_depth.is_none() || options.integrator == IntegratorName::Volpath,
        "--max-depth is for the integrator volpath; {} has no limit",
        word(&options.integrator),
    );
    ensure!(
        loaded.scene.paths.is_none() || integrator(options.integrator, VolPath::default()).apart().is_some(),
        "{} cannot take light apart: leave out the layers (--layers '' if the scene asks for them), or render with \
         volpath",
        word(&options.integrator),
    );
    let desc = &loaded.desc;
    let spp = match (options.spp, options.time) {
        (Some(spp), _) => spp,
        (None, Some(_)) => u32::MAX,
        (None, None) => desc.sampler.spp.value,
    };
    let seed = [desc.sampler.seed, desc.options.seed].into_iter().flatten().map(|seed| seed.value).next();
    let crop = options.crop.or(loaded.crop);
    let (width, height) = (loaded.scene.camera.width, loaded.scene.camera.height);
    let pixels = crop.map_or(u64::from(width) * u64::from(height), |c| u64::from(c.width()) * u64::from(c.height()));
    fit_into_memory(pixels, 1 + loaded.scene.camera.layers.len() as u64)?;
    if let Some(crop) = crop {
        ensure!(
            crop.max.0 <= width && crop.max.1 <= height,
            "the crop {},{},{},{} reaches out of the image, which is {width}x{height}",
            crop.min.0,
            crop.min.1,
            crop.max.0,
            crop.max.1,
        );
    }
    let sampler = match options.sampler {
        SamplerName::Sobol => SamplerKind::Sobol,
        SamplerName::Independent => SamplerKind::Independent,
    };
    let allocation = if options.adaptive { Allocation::ByError } else { Allocation::Even };
    let seed = options.seed.or(seed).unwrap_or(0);
    Ok(Settings { spp, allocation, first_sample: 0, seed, sampler, crop })
}

/// Whether so many pixels, each with so many values and their sums, can be held.
pub(crate) fn fit_into_memory(pixels: u64, values: u64) -> anyhow::Result<()> {
    ensure!(
        pixels.saturating_mul(values) <= MOST_PIXELS,
        "{pixels} pixels are more than fit into memory: render the image in parts, by --crop"
    );
    Ok(())
}

pub(crate) fn color_mode(name: ColorName) -> ColorMode {
    match name {
        ColorName::Rgb => ColorMode::Rgb,
        ColorName::Mono => ColorMode::Mono,
        ColorName::Spectral => ColorMode::Spectral,
    }
}

fn color_name(mode: ColorMode) -> ColorName {
    match mode {
        ColorMode::Rgb => ColorName::Rgb,
        ColorMode::Mono => ColorName::Mono,
        ColorMode::Spectral => ColorName::Spectral,
    }
}
