//! `tyndall lab gonio`.

use std::{
    f64::consts::{PI, TAU},
    path::Path,
};

use anyhow::{Context, bail, ensure};
use glam::Vec3;
use tyndall::{
    scene::{MaterialId, Scene},
    spectrum::ColorMode,
};
use tyndall_formats::film::{Channel, Image, exr, png};
use tyndall_lab::{
    gonio::{Agreement, Map, Measured, Specimen, Surface, exact_grain, measure},
    run::Estimate,
    slab::{Bins, Incidence, Setup},
};

use super::{
    bin, figure,
    furnace::quoted,
    options::GonioOptions,
    picture,
    polar::{Line, Polar},
    report::{Curve, Figure, Model, Report, chance},
};
use crate::{
    args::SceneOptions,
    load::{Loaded, load},
    outputs::is_png,
};

/// Edge of the picture of a hemisphere [pixels].
const DISC: u32 = 256;

/// Lights the specimen, and tells what leaves it.
pub(super) fn run(options: &GonioOptions) -> anyhow::Result<Report> {
    let files = picture::files(options.picture.as_deref())?;
    let (title, specimen) = specimen(options)?;
    let map = Map { rows: options.rows, columns: 2 * options.rows };
    let measurement = &options.measurement;
    let photons = measurement.most_photons(None);
    let m = measure(&specimen, map, photons, measurement.seed, measurement.look(photons)?)?;
    for file in &files {
        write(file, map, &m, &title, options.decades)?;
    }
    Ok(tell(title, &specimen, map, &m, options.decades))
}

fn specimen(options: &GonioOptions) -> anyhow::Result<(String, Specimen)> {
    let angle = options.angle;
    let cosine = angle.to_radians().cos() * if options.inside { -1.0 } else { 1.0 };
    if let Some(phase) = options.phase.clone() {
        return Ok((format!("a phase function of mean cosine {}", phase.mean_cosine()), Specimen::Phase(phase)));
    }
    if let (Some(grain), Some(file)) = (options.grain, &options.mesh) {
        let title =
            format!("{} of index {}, σ_a = {}, σ_s = {}", file.display(), grain.n, grain.sigma_a, grain.sigma_s);
        return Ok((title, Specimen::Body(Box::new(super::beam::mesh(file, 1.0)?), grain)));
    }
    if let Some(grain) = options.grain {
        let title = format!("a grain of index {}, σ_a R = {}, σ_s R = {}", grain.n, grain.sigma_a, grain.sigma_s);
        return Ok((title, Specimen::Grain(grain)));
    }
    if !options.layer.is_empty() {
        ensure!(!options.inside, "layers are lit from above: leave out --inside");
        let layers = options.layer.clone();
        let incidence = Incidence::Beam(cosine);
        let setup = Setup { layers, n_above: 1.0, n_below: 1.0, incidence, bins: Bins::default() };
        return Ok((format!("{} layers, lit at {angle}°", options.layer.len()), Specimen::Slab(setup)));
    }
    if let (Some(file), Some(medium)) = (&options.scene, &options.medium) {
        let loaded = read(file, options)?;
        let names: Vec<_> = loaded.desc.media.iter().map(|m| m.name.as_deref()).collect();
        let id = place_of(medium, "medium", &names, file)?;
        return Ok((format!("the medium {medium}"), Specimen::Phase(loaded.scene.media[id].phase.clone())));
    }
    let Some(material) = &options.material else { bail!("name a --material, --phase, --layer or --grain") };
    let (scene, id) = match &options.scene {
        Some(file) => of_scene(file, material, options)?,
        None => in_words(material)?,
    };
    let side = if options.inside { "inside" } else { "outside" };
    Ok((
        format!("{material}, lit from {side} at {angle}°"),
        Specimen::Surface(Box::new(Surface::new(scene, id, cosine)?)),
    ))
}

/// A scene file.
fn read(file: &Path, options: &GonioOptions) -> anyhow::Result<Loaded> {
    let input = SceneOptions { scene: file.to_owned(), define: options.define.clone(), lenient: options.lenient };
    let loaded = load(&input, None, Some(ColorMode::Rgb), None)?;
    loaded.warn();
    Ok(loaded)
}

/// The place of a name among those of a scene.
fn place_of(name: &str, what: &str, names: &[Option<&str>], file: &Path) -> anyhow::Result<usize> {
    let known = || names.iter().flatten().copied().collect::<Vec<_>>().join(", ");
    let place = names.iter().position(|known| *known == Some(name));
    place.with_context(|| format!("{} has no {what} named `{name}`; it has: {}", file.display(), known()))
}

/// A material of a scene file by its name.
fn of_scene(file: &Path, name: &str, options: &GonioOptions) -> anyhow::Result<(Scene, MaterialId)> {
    let loaded = read(file, options)?;
    let names: Vec<_> = loaded.desc.materials.iter().map(|m| m.name.as_deref()).collect();
    let id = place_of(name, "material", &names, file)?;
    Ok((loaded.scene, MaterialId(id as u32)))
}

/// A material in pbrt's words.
fn in_words(words: &str) -> anyhow::Result<(Scene, MaterialId)> {
    let text = format!("WorldBegin\nMaterial {}\nShape \"sphere\"\n", quoted(words));
    let (desc, sources) = tyndall_formats::pbrt::parse(Path::new("--material"), &text)?;
    let id = desc.shapes.first().context("a material is the words of one Material directive")?.material.value;
    let (scene, _) = tyndall_formats::build::build(&desc, sources, ColorMode::Rgb)?;
    Ok((scene, MaterialId(id.0)))
}

/// The map as numbers, or its two halves as discs.
fn write(file: &Path, map: Map, m: &Measured, title: &str, decades: f64) -> anyhow::Result<()> {
    let channel = |c: usize| &*m.map[c % m.map.len()];
    let mut image = picture::image([map.columns, map.rows], [channel(0), channel(1), channel(2)], title);
    if is_png(file) {
        let texts = [("tyndall.decades", decades.to_string()), ("tyndall.scene", title.to_owned())];
        png::write_rgb8(file, [2 * DISC, DISC], &picture::logarithmic(&discs(map, &image), decades), &texts)?;
        return Ok(());
    }
    if let Some(agreement) = &m.agreement {
        image.layers = layers(agreement);
    }
    Ok(exr::write(file, &image)?)
}

/// The upper half of the map on the left, the lower one on the right, each from its pole to its rim: areas are true.
fn discs(map: Map, image: &Image) -> Vec<[f32; 3]> {
    let pixel = |i: u32| {
        let (x, y) = (i % (2 * DISC), i / (2 * DISC));
        let side = if x < DISC { 1.0 } else { -1.0 };
        let place = |v: u32| 2.0 * (v as f32 + 0.5) / DISC as f32 - 1.0;
        let (x, y) = (place(x % DISC), -place(y));
        let squared = x * x + y * y;
        if squared >= 1.0 {
            return [0.0; 3];
        }
        // r² = 1 − |z|
        let z = 1.0 - squared;
        let scale = ((1.0 - z * z) / squared.max(f32::MIN_POSITIVE)).sqrt();
        image.mean[map.pixel(Vec3::new(x * scale, y * scale, side * z))]
    };
    (0..2 * DISC * DISC).map(pixel).collect()
}

/// What evaluation says, and how far sampling is from it.
fn layers(agreement: &Agreement) -> Vec<Channel> {
    let names = ["evaluated.R", "evaluated.G", "evaluated.B"];
    let channel = |c: usize| agreement.map[c % agreement.map.len()].iter().map(|e| e.mean as f32).collect();
    let mut layers: Vec<_> =
        names.iter().enumerate().map(|(c, name)| Channel { name: (*name).into(), values: channel(c) }).collect();
    layers.push(Channel { name: "z".into(), values: agreement.z.iter().map(|z| *z as f32).collect() });
    layers
}

fn tell(title: String, specimen: &Specimen, map: Map, m: &Measured, decades: f64) -> Report {
    let [upper, lower] = match specimen {
        Specimen::Surface(_) | Specimen::Slab(_) => ["reflected side", "far side"],
        Specimen::Phase(_) | Specimen::Grain(_) | Specimen::Body(..) => ["forward", "backward"],
    };
    let mut figures = vec![
        figure("albedo", "", m.albedo),
        figure(upper, "", m.upper),
        figure(lower, "", m.lower),
        figure("specular, not in the map", "", m.specular),
        figure("mean cosine", "", m.mean_cosine),
    ];
    match specimen {
        Specimen::Phase(phase) => {
            figures[0].exact = Some(1.0);
            figures[4].exact = Some(f64::from(phase.mean_cosine()));
        }
        Specimen::Grain(grain) => tell_grain(&mut figures, m, exact_grain(grain)),
        Specimen::Body(..) => tell_grain(&mut figures, m, None),
        Specimen::Surface(_) | Specimen::Slab(_) => {}
    }
    let agreement = m.agreement.as_ref();
    if let Some(agreement) = agreement {
        figures.push(figure("albedo by evaluation", "", agreement.evaluated));
    }
    Report {
        title,
        photons: m.photons,
        figures,
        curves: vec![by_angle(map, m)],
        verdict: agreement.map(verdict),
        polar: Some(Polar { decades, lines: lines(map, m) }),
    }
}

fn tell_grain(figures: &mut Vec<Figure>, m: &Measured, exact: Option<tyndall_lab::gonio::Exact>) {
    let names = ["reflected outside", "after 1 segment inside", "after 2 segments inside", "after 3 segments inside"];
    figures.extend(names.into_iter().zip(m.by_segments).map(|(name, estimate)| figure(name, "", estimate)));
    if let Some(exact) = exact {
        (figures[0].exact, figures[4].exact) = (Some(exact.albedo), Some(exact.mean_cosine));
        for (figure, part) in figures[5..].iter_mut().zip(exact.by_segments) {
            figure.exact = Some(part);
        }
    }
}

fn verdict(a: &Agreement) -> String {
    let says = if a.p < 1e-3 { "DISAGREE" } else { "agree" };
    format!(
        "Sampling and evaluation {says} ({}); the greatest |z| of {} pixels is {:.2}, χ²/n = {:.3}.",
        chance(a.p),
        a.tests,
        a.max_z,
        a.chi_square / a.tests.max(1) as f64
    )
}

/// The mean of some pixels.
fn mean(estimates: &[Estimate], pixels: &[usize]) -> Estimate {
    let n = pixels.len().max(1) as f64;
    let sum = pixels.iter().map(|i| estimates[*i].mean).sum::<f64>() / n;
    let variance = pixels.iter().map(|i| estimates[*i].standard_error.powi(2)).sum::<f64>();
    Estimate { mean: sum, standard_error: variance.sqrt() / n }
}

/// All channels as one.
fn grey(maps: &[Vec<Estimate>], pixels: &[usize]) -> Estimate {
    let channels: Vec<_> = maps.iter().map(|channel| mean(channel, pixels)).collect();
    let n = channels.len().max(1) as f64;
    // The channels of a sample are not independent: at most their errors are equal.
    Estimate {
        mean: channels.iter().map(|e| e.mean).sum::<f64>() / n,
        standard_error: channels.iter().map(|e| e.standard_error).sum::<f64>() / n,
    }
}

/// The mean over azimuth, by the angle to +z.
fn by_angle(map: Map, m: &Measured) -> Curve {
    let row = |row: u32| {
        let start = row as usize * map.columns as usize;
        (start..start + map.columns as usize).collect::<Vec<_>>()
    };
    let degrees = |row: u32| map.cosines(row).map(|cosine| cosine.clamp(-1.0, 1.0).acos().to_degrees());
    let evaluated = m.agreement.as_ref().map(|agreement| Model {
        name: "by evaluation",
        values: (0..map.rows).map(|r| grey(&agreement.map, &row(r)).mean).collect(),
    });
    Curve {
        name: "power per solid angle".into(),
        unit: "1/sr",
        of: "angle",
        of_unit: "°",
        bins: (0..map.rows).map(|r| bin(degrees(r), grey(&m.map, &row(r)))).collect(),
        models: evaluated.into_iter().collect(),
    }
}

/// The plane of incidence, once around.
fn lines(map: Map, m: &Measured) -> Vec<Line> {
    let line = |name: &'static str, maps: &[Vec<Estimate>]| {
        // The two columns on either side of azimuth 0, and of 180°.
        let at = |row: u32, columns: [u32; 2]| {
            let pixels = columns.map(|column| row as usize * map.columns as usize + column as usize);
            let [high, low] = map.cosines(row);
            (f64::midpoint(high, low).acos(), grey(maps, &pixels).mean)
        };
        let middle = map.columns / 2;
        let right = (0..map.rows).map(|row| at(row, [middle - 1, middle]));
        let left = (0..map.rows).rev().map(|row| at(row, [0, map.columns - 1])).map(|(angle, v)| (TAU - angle, v));
        Line { name, points: right.chain(left).map(|(angle, value)| (angle.rem_euclid(2.0 * PI), value)).collect() }
    };
    let mut lines = vec![line("sampled", &m.map)];
    lines.extend(m.agreement.as_ref().map(|agreement| line("evaluated", &agreement.map)));
    lines
}
