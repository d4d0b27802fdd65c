//! `tyndall lab furnace`.

use std::{
    path::Path,
    process::ExitCode,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
    time::Instant,
};

use anyhow::{bail, ensure};
use statrs::distribution::{ContinuousCDF, Normal};
use tyndall::{
    film::Film,
    integrator::VolPath,
    render::{self, Observer, Rendering, Settings, render},
    sampling::SamplerKind,
    scene::Scene,
    spectrum::ColorMode,
};
use tyndall_formats::{
    desc::SceneDesc,
    film::{Image, Metadata, exr, png},
};
use tyndall_lab::{
    furnace::{self, Balance, Judgement, Tile, furnace},
    run::Estimate,
};

use super::{
    beam::published,
    bin, figure,
    options::FurnaceOptions,
    picture,
    report::{Curve, Figure, Model, Report, chance},
};
use crate::{
    args::{ColorName, SceneOptions},
    false_color,
    integrators::integrator,
    interrupt,
    load::load,
    outputs::{command_line, is_png},
    progress::Progress,
};

/// Edge of the tiles that are judged [pixels].
const TILE: u32 = 8;
/// The chance of calling a scene wrong that is right.
const ALPHA: f64 = 0.001;
/// Pixels of the image of a material.
const PIXELS: u32 = 128;
/// Exit status where energy is made.
const MADE: u8 = 1;

/// Renders the scene in the furnace and says what has become of energy.
pub(super) fn run(options: &FurnaceOptions) -> anyhow::Result<(Report, ExitCode)> {
    let files = picture::files(options.picture.as_deref())?;
    let measurement = &options.measurement;
    let color = if options.color == ColorName::Mono { ColorMode::Mono } else { ColorMode::Rgb };
    ensure!(options.color != ColorName::Spectral, "the furnace is grey: --color rgb or mono");
    // The balance follows grey photons, the image has colours: each reads the scene for itself.
    let (desc, scene) = scene(options, ColorMode::Mono)?;
    let photons = measurement.most_photons(None);
    let balance =
        furnace::balance(&scene, photons.min(BALANCE), measurement.seed, measurement.look_at_one_of(4, BALANCE)?);
    let scene = if color == ColorMode::Mono { scene } else { self::scene(options, color)?.1 };

    let rendering = image(options, &scene);
    let judgement = furnace::judge(&rendering.film, balance.expected, TILE);
    let title = title(options);
    write(&files, &rendering.film, balance.expected, &title)?;
    let made = judgement.p_made < ALPHA;
    let exit = if made { ExitCode::from(MADE) } else { ExitCode::SUCCESS };
    Ok((tell(title, &desc, &rendering, &balance, &judgement), exit))
}

/// Photons that look for what has taken the light.
const BALANCE: u64 = 200_000;

fn title(options: &FurnaceOptions) -> String {
    let what = match (&options.scene, &options.material) {
        (Some(file), _) => file.display().to_string(),
        (None, Some(material)) => format!("a ball of {material}"),
        (None, None) => String::new(),
    };
    format!("{what} in the furnace{}", if options.lossless { ", its media without absorption" } else { "" })
}

/// The scene that was asked for, in the furnace.
fn scene(options: &FurnaceOptions, color: ColorMode) -> anyhow::Result<(SceneDesc, Scene)> {
    let (desc, scene) = match (&options.scene, &options.material) {
        (Some(file), _) => {
            let input = SceneOptions { scene: file.clone(), define: options.define.clone(), lenient: options.lenient };
            let loaded = load(&input, options.resolution, Some(color), None)?;
            loaded.warn();
            (loaded.desc, loaded.scene)
        }
        (None, Some(material)) => ball(material, options, color)?,
        (None, None) => bail!("name a scene file, or a --material"),
    };
    Ok((desc, furnace(scene, options.lossless)?))
}

/// A ball of a measured medium, or with a surface in pbrt's words, that fills the image.
fn ball(material: &str, options: &FurnaceOptions, color: ColorMode) -> anyhow::Result<(SceneDesc, Scene)> {
    let radius = options.radius;
    let [width, height] = options.resolution.unwrap_or([PIXELS; 2]);
    let matter = if is_words(material) {
        format!("Material {}", quoted(material))
    } else {
        let medium = published(material)?;
        format!(
            "MakeNamedMedium \"inside\" \"string type\" \"homogeneous\" \"string preset\" \"{}\"\n\
             MediumInterface \"inside\" \"\"\nMaterial \"dielectric\" \"float eta\" {}",
            medium.name, medium.eta
        )
    };
    let text = format!(
        "Option \"string unit\" \"mm\"\n\
         Film \"rgb\" \"integer xresolution\" {width} \"integer yresolution\" {height}\n\
         LookAt 0 0 {}  0 0 0  0 1 0\n\
         Camera \"orthographic\" \"float screenwindow\" [ -{radius} {radius} -{radius} {radius} ]\n\
         WorldBegin\n{matter}\nShape \"sphere\" \"float radius\" {radius}\n",
        2.0 * radius
    );
    let (desc, sources) = tyndall_formats::pbrt::parse(Path::new("--material"), &text)?;
    let (scene, _) = tyndall_formats::build::build(&desc, sources, color)?;
    Ok((desc, scene))
}

/// Whether it is the rest of pbrt's directive `Material`, and not the name of something measured.
pub(super) fn is_words(material: &str) -> bool {
    material.contains('"') || tyndall_optics::measured::named(material).is_none() && !material.contains(' ')
}

/// The first word in quotes, which may be left out on the command line.
pub(super) fn quoted(material: &str) -> String {
    if material.trim_start().starts_with('"') {
        return material.to_owned();
    }
    match material.split_once(' ') {
        Some((kind, rest)) => format!("\"{kind}\" {rest}"),
        None => format!("\"{material}\""),
    }
}

/// Renders until there are enough samples, or the time is up, or the error of the mean is small enough.
fn image(options: &FurnaceOptions, scene: &Scene) -> Rendering {
    let measurement = &options.measurement;
    let pixels = u64::from(scene.camera.width) * u64::from(scene.camera.height);
    let photons = measurement.most_photons(None);
    let spp = u32::try_from(photons.div_ceil(pixels).max(2)).unwrap_or(u32::MAX);
    let settings = Settings { spp, seed: measurement.seed, sampler: SamplerKind::Independent, ..Settings::default() };
    let watch = Watch {
        progress: Progress::new(pixels, measurement.time, spp < u32::MAX, false),
        deadline: measurement.time.and_then(|time| Instant::now().checked_add(time)),
        error: measurement.error,
        enough: AtomicBool::new(false),
    };
    let rendering = render(scene, integrator(options.integrator, VolPath::default()).as_ref(), &settings, &watch);
    watch.progress.finish();
    rendering
}

/// Ends a render after two samples a pixel or more.
struct Watch {
    progress: Progress,
    deadline: Option<Instant>,
    error: Option<f64>,
    enough: AtomicBool,
}

impl Observer for Watch {
    fn cancelled(&self) -> bool {
        interrupt::requested() || self.enough.load(Relaxed)
    }

    fn batch_done(&self, progress: render::Progress) {
        self.progress.tell(progress);
    }

    fn pass_done(&self, film: &Film, progress: render::Progress) {
        let sampled = progress.samples >= 2 * film.pixels.len() as u64;
        let late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        let error = self.error.is_some_and(|wanted| {
            furnace::judge(film, 1.0, u32::MAX).mean.iter().all(|mean| mean.standard_error <= wanted)
        });
        if sampled && (late || error) {
            self.enough.store(true, Relaxed);
        }
    }
}

/// The deviation as numbers, and red where energy is made, blue where it is lost.
fn write(files: &[std::path::PathBuf], film: &Film, expected: f64, title: &str) -> anyhow::Result<()> {
    let metadata = Metadata {
        version: env!("CARGO_PKG_VERSION").into(),
        scene: title.to_owned(),
        command: command_line(),
        ..Metadata::default()
    };
    let mut image = Image::of(film, metadata);
    for pixel in &mut image.mean {
        *pixel = pixel.map(|v| (f64::from(v) - expected) as f32);
    }
    for file in files {
        if is_png(file) {
            let nothing = Image { mean: vec![[0.0; 3]; image.mean.len()], ..image.clone() };
            let (pixels, scale) = false_color::difference(&image, &nothing);
            let texts = [("tyndall.deviation_in_full_color", scale.to_string()), ("tyndall.scene", title.to_owned())];
            png::write_rgb8(file, [image.crop.width(), image.crop.height()], &pixels, &texts)?;
            eprintln!("{}: blue −{scale:.3e} · white 0 · red +{scale:.3e}", file.display());
        } else {
            exr::write(file, &image)?;
        }
    }
    Ok(())
}

fn tell(title: String, desc: &SceneDesc, rendering: &Rendering, balance: &Balance, judgement: &Judgement) -> Report {
    let mut figures: Vec<Figure> = ["red", "green", "blue"]
        .into_iter()
        .zip(judgement.mean)
        .map(|(channel, mean)| figure(format!("mean radiance, {channel}"), "", mean))
        .collect();
    figures.push(figure("radiance without loss", "", Estimate { mean: judgement.expected, standard_error: 0.0 }));
    figures.push(figure("escapes to the sky", "", balance.escaped));
    figures.extend(taken(desc, balance));
    let tally = &rendering.tally;
    for (name, count) in [
        ("paths that leaked", balance.leaks + tally.leaks),
        ("bodies lost count of", balance.lost_bodies + tally.lost_bodies),
        ("samples that are no radiance", tally.bad_samples),
    ] {
        figures.push(figure(name, "", Estimate { mean: count as f64, standard_error: 0.0 }));
    }
    Report {
        title,
        photons: tally.paths,
        figures,
        curves: vec![by_z(judgement)],
        verdict: Some(verdict(balance, judgement)),
        polar: None,
    }
}

/// What each material and medium has taken, where it is more than noise.
fn taken(desc: &SceneDesc, balance: &Balance) -> Vec<Figure> {
    let name = |kind: &str, i: usize, known: Option<&str>| match known {
        Some(name) => format!("taken by {kind} {name}"),
        None => format!("taken by {kind} {i}"),
    };
    let material = |i: usize| name("material", i, desc.materials.get(i).and_then(|m| m.name.as_deref()));
    let medium = |i: usize| name("medium", i, desc.media.get(i).and_then(|m| m.name.as_deref()));
    let of = |estimates: &[Estimate], name: &dyn Fn(usize) -> String| -> Vec<Figure> {
        let all = estimates.iter().enumerate();
        let told = all.filter(|(_, e)| e.mean.abs() > 1e-6 && e.mean.abs() > 4.0 * e.standard_error);
        told.map(|(i, e)| figure(name(i), "", *e)).collect()
    };
    let mut taken = of(&balance.by_material, &material);
    taken.extend(of(&balance.by_medium, &medium));
    taken
}

/// How many tiles have which z, beside how many would by noise alone.
fn by_z(judgement: &Judgement) -> Curve {
    const BINS: i32 = 24;
    let z = || judgement.tiles.iter().flat_map(|tile| tile.z);
    let count = z().count() as f64;
    let edge = |i: i32| f64::from(i - BINS / 2) / 2.0;
    let normal = Normal::standard();
    let bins = (0..BINS).map(|i| {
        let found = z().filter(|z| (edge(i)..edge(i + 1)).contains(z)).count() as f64;
        bin([edge(i), edge(i + 1)], Estimate { mean: found, standard_error: found.sqrt() })
    });
    Curve {
        name: "tiles".into(),
        unit: "",
        of: "z",
        of_unit: "",
        bins: bins.collect(),
        models: vec![Model {
            name: "by noise alone",
            values: (0..BINS).map(|i| count * (normal.cdf(edge(i + 1)) - normal.cdf(edge(i)))).collect(),
        }],
    }
}

/// Kept, lost or made, how sure, and where.
fn verdict(balance: &Balance, judgement: &Judgement) -> String {
    let place = |tile: Option<&Tile>, of: fn(f64, f64) -> f64| {
        tile.map_or(String::new(), |tile| {
            let z = tile.z.into_iter().reduce(of).unwrap_or_default();
            format!("tile at {},{} (z {z:+.1}, mean {:.4})", tile.corner[0], tile.corner[1], tile.mean[0])
        })
    };
    let (bright, dark) = (place(judgement.brightest(), f64::max), place(judgement.darkest(), f64::min));
    let taken = 1.0 - balance.escaped.mean;
    let (made, lost) = (chance(judgement.p_made), chance(judgement.p_lost));
    match (judgement.p_made < ALPHA, judgement.p_lost < ALPHA) {
        (true, _) => format!("Energy is MADE ({made}): most in the {bright}."),
        (false, true) => format!(
            "Energy is lost ({lost}), none is made ({made}): most in the {dark}; what is named above has taken {:.3} % of the \
             light.",
            100.0 * taken
        ),
        (false, false) => {
            format!("Energy is kept (made: {made}, lost: {lost}). Farthest off are the {bright} and the {dark}.")
        }
    }
}
