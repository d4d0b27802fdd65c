//! `tyndall separate`: direct light apart from global light, by patterns and in truth.

mod figures;
pub(crate) mod options;
mod plot;
mod sheet;

use std::{
    process::ExitCode,
    sync::atomic::{AtomicU64, Ordering::Relaxed},
};

use tyndall::{
    film::{Crop, Film},
    integrator::Integrator,
    light::Light,
    math::Vec3,
    render::{self, Observer, Settings, render},
    scene::Scene,
};
use tyndall_formats::film::{Channel, Image, Metadata, exr};
use tyndall_lab::separate::{MARGIN, Outcome, Parts, Pattern, Place, Projection, Stage, truth};

use super::render::fit_into_memory;
use crate::{
    args::{IntegratorName, SamplerName, word},
    integrators::{explicit, integrator},
    interrupt,
    load::{Loaded, load},
    outputs::{Outputs, command_line, is_png, stem_of_scene, write_text},
    progress::Progress,
    threads::pool,
};
use figures::Figures;
use options::{PatternName, PlaceName, SeparateOptions};

/// Sides of squares that a sweep throws [pixels of the projector].
const SWEEP: [u32; 7] = [64, 32, 16, 8, 4, 2, 1];

/// Loads, throws all patterns, saves, tells.
pub(crate) fn run(options: &SeparateOptions) -> anyhow::Result<ExitCode> {
    interrupt::listen()?;
    let outputs = outputs(options)?;
    let pool = pool(options.threads)?;
    let loaded = pool.install(|| load(&options.input, options.resolution, None, None))?;
    loaded.warn();
    let metadata = metadata(options, &loaded);
    let place = place(options, &loaded.scene);
    let projections = projections(options, place, loaded.scene.camera.width)?;
    let bench = Bench::new(options, &loaded, &projections)?;
    let mut stage = Stage::new(loaded.scene, place)?;
    stage.clear();
    let Some(clear) = pool.install(|| bench.picture(stage.scene())).and_then(whole) else {
        bench.progress.finish();
        eprintln!("stopped before the first picture was done: nothing was saved");
        return Ok(ExitCode::from(interrupt::EXIT));
    };
    let truth = truth(&clear);
    let mut throw = |projection: &Projection| {
        let outcome = pool.install(|| stage.throw(projection, |scene| bench.picture(scene)))?;
        Some((Figures::new(projection, &clear, &truth, &outcome), outcome))
    };
    let found: Vec<(Figures, Outcome)> = projections.iter().map_while(&mut throw).collect();
    bench.progress.finish();

    let image = Image::of(&clear, metadata);
    write(&outputs, &image, &truth, found.last().map(|(_, outcome)| &outcome.parts))?;
    let figures: Vec<Figures> = found.into_iter().map(|(figures, _)| figures).collect();
    tell(options, &outputs, &figures)?;
    if interrupt::requested() {
        eprintln!("stopped by Ctrl-C: {} what is done", outputs.hold());
        return Ok(ExitCode::from(interrupt::EXIT));
    }
    Ok(ExitCode::SUCCESS)
}

/// Both halves of a picture.
fn whole([mut film, other]: [Film; 2]) -> Option<Film> {
    film.merge(&other).ok()?;
    Some(film)
}

/// The files that were asked for, or those named after the scene: beside a render of it.
fn outputs(options: &SeparateOptions) -> anyhow::Result<Outputs> {
    let scene = &options.input.scene;
    let mut name = stem_of_scene(scene).into_os_string();
    name.push("-separated");
    let asked = if options.output.is_empty() { vec![name.into()] } else { options.output.clone() };
    let outputs = Outputs::new(&asked, scene, options.tone.into())?;
    outputs.check()?;
    Ok(outputs)
}

/// What is thrown, one after the other, for an image of so many columns.
fn projections(options: &SeparateOptions, place: Place, columns: u32) -> anyhow::Result<Vec<Projection>> {
    let patterns = match options.pattern {
        _ if options.sweep => SWEEP.map(Pattern::checkerboard).to_vec(),
        PatternName::Checkerboard => vec![checkerboard(options)],
        PatternName::Waves => vec![Pattern::Waves { period: options.period, phases: options.phases }],
    };
    patterns.iter().try_for_each(Pattern::check)?;
    // A projector at the camera throws so much wider than that sees.
    let seen = f64::from(MARGIN) * f64::from(columns);
    let widest = if options.sweep { Pattern::PAPER } else { patterns[0] }.widest_pixel();
    let told_apart = (seen * widest).clamp(16.0, 1024.0) as u32;
    let pixels = options.pixels.unwrap_or([told_apart, told_apart * 3 / 4]);
    let covered = f64::from(pixels[0]) / seen;
    if !options.sweep && place != Place::Scene && covered > widest + 0.01 {
        eprintln!(
            "warning: a pixel of the image covers {covered:.1} pixels of the projector, and this pattern allows {widest:.1}: direct \
             light comes out too dark; take fewer --pixels, or a coarser pattern"
        );
    }
    let projection = |pattern| Projection::new(pattern, pixels, options.dark);
    Ok(patterns.into_iter().map(projection).collect::<Result<_, _>>()?)
}

/// The checkerboard for squares of a side, changed where that was asked for.
fn checkerboard(options: &SeparateOptions) -> Pattern {
    match Pattern::checkerboard(options.square) {
        Pattern::Checkerboard { square, step, shifts } => Pattern::Checkerboard {
            square,
            step: options.step.unwrap_or(step),
            shifts: options.shifts.unwrap_or(shifts),
        },
        waves @ Pattern::Waves { .. } => waves,
    }
}

fn place(options: &SeparateOptions, scene: &Scene) -> Place {
    let has_one = || scene.lights.lights.iter().any(|light| matches!(light, Light::Projector(_)));
    match options.projector {
        Some(PlaceName::Scene) => Place::Scene,
        None if has_one() => Place::Scene,
        _ => Place::Camera(Vec3::from(options.offset)),
    }
}

fn metadata(options: &SeparateOptions, loaded: &Loaded) -> Metadata {
    Metadata {
        version: env!("CARGO_PKG_VERSION").into(),
        scene: options.input.scene.display().to_string(),
        scene_hash: loaded.hash.clone(),
        integrator: "volpath".into(),
        sampler: word(&SamplerName::Sobol),
        spp: options.spp,
        samples_per_pixel: f64::from(options.spp),
        seed: options.seed,
        command: command_line(),
        ..Metadata::default()
    }
}

/// What is kept of a pixel, as a film counts it: two halves of a picture, the whole one, and what was greatest and least.
const VALUES: u64 = 12;

/// Takes pictures, all with the same random numbers.
struct Bench {
    integrator: Box<dyn Integrator>,
    settings: Settings,
    progress: Progress,
    /// Samples of all pictures, and of those that are done.
    total: u64,
    done: AtomicU64,
}

impl Bench {
    fn new(options: &SeparateOptions, loaded: &Loaded, projections: &[Projection]) -> anyhow::Result<Self> {
        let (said, camera) = (&loaded.desc.integrator, &loaded.scene.camera);
        let crop = loaded.crop.unwrap_or(Crop::full(camera.width, camera.height));
        let pictures = 1 + projections.iter().map(|p| u64::from(p.pattern.count())).sum::<u64>();
        let pixels = u64::from(crop.width()) * u64::from(crop.height());
        fit_into_memory(pixels, VALUES)?;
        Ok(Self {
            integrator: integrator(IntegratorName::Volpath, explicit(said)),
            settings: Settings { spp: options.spp, seed: options.seed, crop: Some(crop), ..Settings::default() },
            progress: Progress::new(pixels, None, true, options.quiet),
            total: pixels * u64::from(options.spp) * pictures,
            done: AtomicU64::new(0),
        })
    }

    /// A picture by halves of its samples; `None` if somebody pressed Ctrl-C before it was whole.
    fn picture(&self, scene: &Scene) -> Option<[Film; 2]> {
        let first = self.half(scene, 0, self.settings.spp / 2)?;
        let second = self.half(scene, self.settings.spp / 2, self.settings.spp.div_ceil(2))?;
        Some([first, second])
    }

    fn half(&self, scene: &Scene, first_sample: u32, spp: u32) -> Option<Film> {
        let settings = Settings { first_sample, spp, ..self.settings };
        let rendering = render(scene, self.integrator.as_ref(), &settings, self);
        self.done.fetch_add(rendering.film.pixels.len() as u64 * u64::from(spp), Relaxed);
        (!rendering.stopped).then_some(rendering.film)
    }
}

impl Observer for Bench {
    fn cancelled(&self) -> bool {
        interrupt::requested()
    }

    fn batch_done(&self, progress: render::Progress) {
        let samples = self.done.load(Relaxed) + progress.samples;
        self.progress.tell(render::Progress { samples, total: self.total });
    }
}

/// The numbers as EXR, the sheet as PNG.
fn write(outputs: &Outputs, clear: &Image, truth: &Parts, separated: Option<&Parts>) -> anyhow::Result<()> {
    let mut image = Image { layers: Vec::new(), ..clear.clone() };
    add(&mut image, "direct", &truth.direct, Some(&truth.direct_error));
    add(&mut image, "global", &truth.global, Some(&truth.global_error));
    if let Some(parts) = separated {
        add(&mut image, "separated_direct", &parts.direct, Some(&parts.direct_error));
        add(&mut image, "separated_global", &parts.global, Some(&parts.global_error));
        let difference = parts.direct.iter().zip(&truth.direct).map(|(a, b)| std::array::from_fn(|c| a[c] - b[c]));
        add(&mut image, "error_direct", &difference.collect::<Vec<_>>(), None);
    }
    for file in &outputs.files {
        if is_png(file) {
            sheet::write(file, &image, truth, separated, outputs.tone)?;
        } else {
            exr::write(file, &image)?;
        }
    }
    Ok(())
}

/// Adds a layer of three channels, with its standard errors if they are known.
fn add(image: &mut Image, name: &str, values: &[[f32; 3]], errors: Option<&[[f32; 3]]>) {
    for (prefix, values) in [("", Some(values)), ("stderr.", errors)] {
        let Some(values) = values else { continue };
        for (c, channel) in ["R", "G", "B"].into_iter().enumerate() {
            let values = values.iter().map(|pixel| pixel[c]).collect();
            image.layers.push(Channel { name: format!("{prefix}{name}.{channel}"), values });
        }
    }
}

/// The table, and what else was asked for.
fn tell(options: &SeparateOptions, outputs: &Outputs, figures: &[Figures]) -> anyhow::Result<()> {
    if options.sweep && !figures.is_empty() {
        for file in plot::files(outputs) {
            plot::write(&file, figures)?;
        }
    }
    if let Some(to) = &options.json {
        write_text(to, &serde_json::to_string_pretty(figures)?)?;
    }
    if !options.quiet && !figures.is_empty() {
        write_text("-".as_ref(), &figures::table(figures))?;
        eprintln!("direct and global light are in {}", outputs.names());
    }
    Ok(())
}
