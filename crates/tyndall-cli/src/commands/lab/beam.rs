//! `tyndall lab beam`.

use std::path::Path;

use anyhow::{Context, bail, ensure};
use glam::{DVec2, DVec3};
use tyndall::shape::Mesh;
use tyndall_formats::mesh::{read_obj, read_ply, read_serialized};
use tyndall_lab::{
    beam::{self, Body, Measured, Setup, View},
    diffusion::{HalfSpace, Model},
    run::Estimate,
    slab::Edges,
    world::Substance,
};
use tyndall_optics::measured::{self, Measured as Published};

use super::{bin, figure, options::BeamOptions, picture, report};
use crate::interrupt;
use report::{Curve, Report};

const CHANNELS: [&str; 3] = ["red", "green", "blue"];
/// Rings, where none are asked for.
const RINGS: usize = 24;
/// The middle of the largest of them, in transport mean free paths.
const FARTHEST: f64 = 20.0;

/// Sends the beam in every colour.
pub(super) fn run(options: &BeamOptions) -> anyhow::Result<Report> {
    let files = picture::files(options.picture.as_deref())?;
    let substances = substances(options)?;
    let body = body(options)?;
    let (radii, field) = scales(options, &body, &substances);
    let view = View {
        pixels: options.pixels,
        width: options.field.unwrap_or(field),
        acceptance: options.acceptance.to_radians(),
        tilt: options.tilt.to_radians(),
        azimuth: options.azimuth.to_radians(),
    };
    let aim = match &body {
        Body::Mesh(mesh) => {
            let (low, high) = beam::extent(mesh);
            0.5 * (low + high).truncate()
        }
        _ => DVec2::ZERO,
    };
    let view = (!files.is_empty()).then_some(view);
    let setup =
        |substance| Setup { body: body.clone(), substance, spot: options.spot, aim, radii: radii.clone(), view };
    let mut measured = Vec::new();
    for (i, substance) in substances.iter().enumerate() {
        measured.push(measure(options, &setup(*substance), i, substances.len())?);
        if interrupt::requested() {
            break;
        }
    }
    let name = options.material.as_deref().unwrap_or("a medium");
    let title = format!("a beam on {} of {name}", describe(options));
    if measured.len() == substances.len() {
        let channel = |c: usize| &measured[c % measured.len()].picture;
        picture::write(
            &files,
            view.map_or(0, |view| view.pixels),
            [channel(0), channel(1), channel(2)],
            &title,
            options.decades,
        )?;
    }
    tell(title, options.spot, &radii, &substances, &measured)
}

fn measure(options: &BeamOptions, setup: &Setup, channel: usize, channels: usize) -> anyhow::Result<Measured> {
    let measurement = &options.measurement;
    let photons = measurement.most_photons(None);
    // Each channel has random numbers of its own, so that its errors are its own too.
    let seed = measurement.seed ^ (channel as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    Ok(beam::measure(setup, photons, seed, measurement.look_at_one_of(channels as u32, photons)?)?)
}

/// What the body is made of in red, green and blue; once if these are the same.
fn substances(options: &BeamOptions) -> anyhow::Result<Vec<Substance>> {
    let zero = [0.0; 3];
    let [sigma_a, sigma_s, g, n] = match &options.material {
        Some(name) => coefficients(published(name)?, options.reduced),
        None => [options.sigma_a.unwrap_or(zero), options.sigma_s.unwrap_or(zero), options.g.unwrap_or(zero), [1.0; 3]],
    };
    let n = options.n.unwrap_or(n[0]);
    let substance = |c: usize| Substance { sigma_a: sigma_a[c], sigma_s: sigma_s[c], g: g[c], n };
    let mut substances: Vec<_> = (0..3).map(substance).collect();
    substances.dedup();
    let substances = if substances.len() == 2 { (0..3).map(substance).collect() } else { substances };
    substances.iter().try_for_each(Substance::check)?;
    ensure!(substances.iter().all(|s| s.sigma_t() > 0.0), "the beam would meet nothing: give --sigma-s or --sigma-a");
    Ok(substances)
}

/// A measured material by its name.
pub(super) fn published(name: &str) -> anyhow::Result<&'static Published> {
    let spelled = || {
        let start: String = name.chars().take(3).flat_map(char::to_lowercase).collect();
        let near: Vec<_> = measured::names().filter(|known| known.to_lowercase().starts_with(&start)).collect();
        let near = if near.is_empty() { measured::names().collect() } else { near };
        format!("no material `{name}` was measured; there are {}", near.join(", "))
    };
    measured::named(name).with_context(spelled)
}

/// σ_a, σ_s [1/mm], g and n of a material, by channels.
fn coefficients(material: &Published, reduced: bool) -> [[f64; 3]; 4] {
    let (sigma_s, g) = match (&material.full, reduced) {
        (Some(full), false) => (full.sigma_s, full.g),
        _ => (material.sigma_s_reduced, [0.0; 3]),
    };
    [material.sigma_a, sigma_s, g, [material.eta; 3]].map(|channels| channels.map(shortest))
}

/// The number that was written, not its neighbour in single precision.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

fn body(options: &BeamOptions) -> anyhow::Result<Body> {
    Ok(match (options.slab, options.sphere, options.cube, &*options.edges, &options.mesh) {
        (Some(thickness), ..) => Body::Slab(thickness),
        (_, Some(diameter), ..) => Body::Ball(0.5 * diameter),
        (_, _, Some(edge), ..) => Body::Box(DVec3::splat(edge)),
        (_, _, _, [x, y, z], _) => Body::Box(DVec3::new(*x, *y, *z)),
        (.., Some(file)) => Body::Mesh(mesh(file, options.mesh_scale)?),
        _ => Body::HalfSpace,
    })
}

pub(super) fn mesh(file: &Path, scale: f64) -> anyhow::Result<Mesh> {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let read = match ending.as_str() {
        "ply" => read_ply(file)?,
        "obj" => read_obj(file)?,
        "serialized" => read_serialized(file, 0)?,
        _ => bail!("{}: meshes are read from .ply, .obj and .serialized", file.display()),
    };
    Ok(Mesh {
        positions: read.positions.iter().map(|p| (p.as_dvec3() * scale).as_vec3()).collect(),
        indices: read.indices,
        normals: read.normals.unwrap_or_default(),
        ..Mesh::default()
    })
}

fn describe(options: &BeamOptions) -> String {
    match (options.slab, options.sphere, options.cube, &*options.edges, &options.mesh) {
        (Some(thickness), ..) => format!("a slab of {thickness} mm"),
        (_, Some(diameter), ..) => format!("a ball of {diameter} mm"),
        (_, _, Some(edge), ..) => format!("a cube of {edge} mm"),
        (_, _, _, [x, y, z], _) => format!("a box of {x} × {y} × {z} mm"),
        (.., Some(file)) => file.display().to_string(),
        _ => "a half-space".into(),
    }
}

/// Rings, and the width of the picture [mm]: by the body, or by how far light gets in it.
fn scales(options: &BeamOptions, body: &Body, substances: &[Substance]) -> (Edges, f64) {
    let reduced = substances.iter().map(|s| s.sigma_a + (1.0 - s.g) * s.sigma_s);
    let far = FARTHEST / reduced.fold(f64::INFINITY, f64::min);
    // The longest way across, and how far the face that the beam meets reaches from its middle.
    let (width, face) = match body {
        Body::HalfSpace | Body::Slab(_) => (2.0 * far, f64::INFINITY),
        Body::Ball(radius) => (2.2 * radius, *radius),
        Body::Box(edges) => {
            let across = if options.tilt == 0.0 { edges.truncate().max_element() } else { edges.length() };
            (1.1 * across, 0.5 * edges.truncate().min_element())
        }
        Body::Mesh(mesh) => {
            let (low, high) = beam::extent(mesh);
            (1.1 * (high - low).length(), 0.5 * (high - low).truncate().min_element())
        }
    };
    let last = far.min(face);
    let edges = match options.radii {
        Some((count, width)) => Edges::uniform(count, width),
        None => Edges((0..=RINGS).map(|i| last * (i as f64 / RINGS as f64).powi(2)).collect()),
    };
    (edges, width)
}

fn tell(
    title: String,
    spot: f64,
    radii: &Edges,
    substances: &[Substance],
    measured: &[Measured],
) -> anyhow::Result<Report> {
    let named = |what: &str, channel: usize| match substances.len() {
        1 => what.to_owned(),
        _ => format!("{what}, {}", CHANNELS[channel]),
    };
    let (mut figures, mut curves) = (Vec::new(), Vec::new());
    for (c, (m, substance)) in measured.iter().zip(substances).enumerate() {
        let totals: [(&str, Estimate); 4] = [
            ("returned", m.returned),
            ("leaves elsewhere", m.elsewhere),
            ("unscattered", m.unscattered),
            ("absorbed", m.absorbed),
        ];
        figures.extend(totals.map(|(what, estimate)| figure(named(what, c), "", estimate)));
        curves.push(Curve {
            name: named("R(r)", c),
            unit: "1/mm²",
            of: "radius",
            of_unit: "mm",
            bins: (0..radii.count()).map(|i| bin(radii.bin(i), m.by_radius[i])).collect(),
            // The theories are of a beam without width.
            models: if spot > 0.0 { Vec::new() } else { models(substance, radii)? },
        });
    }
    Ok(Report { title, photons: measured.iter().map(|m| m.photons).sum(), figures, curves, verdict: None, polar: None })
}

/// Diffusion theory of a half-space, per power that falls on it.
fn models(substance: &Substance, radii: &Edges) -> anyhow::Result<Vec<report::Model>> {
    if substance.sigma_s == 0.0 {
        return Ok(Vec::new());
    }
    let half_space = HalfSpace::new(substance)?;
    let enters = 1.0 - ((substance.n - 1.0) / (substance.n + 1.0)).powi(2);
    let model = |model: Model| report::Model {
        name: model.name(),
        values: (0..radii.count()).map(|i| enters * half_space.ring(model, radii.bin(i))).collect(),
    };
    Ok(Model::ALL.map(model).into())
}
