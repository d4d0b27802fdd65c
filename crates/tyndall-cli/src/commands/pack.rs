//! `tyndall pack CONTAINER`: grains in a container, what part of it they fill, how far light goes between them, and a scene.

mod material;
mod scene;
mod shapes;

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use tyndall_formats::{
    film::save,
    gzip::{deflate, is_gzip},
};
use tyndall_grains::{
    pack::{Pack, Recipe},
    radii::Radii,
    settle::settle,
};

use self::material::Material;
use crate::{interrupt, outputs::say};

/// Lines that measure the mean free path: a standard error below a percent.
const LINES: u32 = 100_000;

/// Fills a container with grains.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall pack sphere:8 --radius 0.5 --count 1500 -o ball.pbrt
  tyndall pack box:20:20:10 --radius lognormal:0.4:0.3 --count 5000 --material salt -o salt.pbrt
  tyndall pack cylinder:10:20 --radius 1 --count 5000 --settle -o poured.pbrt
  tyndall pack jar.ply --grain ellipsoid:1:1:2 --radius 0.5 --settle --material green -o jar.pbrt
  tyndall pack heap.obj --grain cube.obj --radius 0.3 --settle --material salt --bare -o salt.pbrt.gz

A radius is that of the ball with the volume of the grain. Ctrl-C ends the packing and keeps what has been packed.
Lengths are millimetres.")]
pub(crate) struct PackOptions {
    /// What to fill: box:X:Y:Z (edges), sphere:R, cylinder:R:H, or a closed mesh (.ply, .obj, .serialized)
    container: String,
    /// Radii of the grains: R, uniform:MIN:MAX, lognormal:MEDIAN:SIGMA
    #[arg(long)]
    radius: Radii,
    /// Their shape: ball, ellipsoid:A:B:C (proportions of its axes), or a closed mesh
    #[arg(long, default_value = "ball")]
    grain: String,
    /// How many grains; fewer if the container is full before
    #[arg(long, default_value_t = 1000)]
    count: u64,
    /// Let them fall and come to rest, instead of random places
    #[arg(long)]
    settle: bool,
    /// Coefficient of friction of grains that settle
    #[arg(long, value_name = "MU", default_value_t = 0.3, requires = "settle")]
    friction: f64,
    /// What the grains of the scene are of
    #[arg(long, value_enum, default_value_t = Material::Glass)]
    material: Material,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The pbrt scene to write, compressed if it ends in .gz
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Write the grains only, for a scene of yours that includes the file: an object with the file's name, and its instances
    #[arg(long, requires = "out")]
    bare: bool,
}

pub(crate) fn run(options: &PackOptions) -> anyhow::Result<ExitCode> {
    if let Some(path) = &options.out {
        save::check(path)?;
    }
    let recipe = Recipe {
        container: shapes::container(&options.container)?,
        form: shapes::form(&options.grain)?,
        radii: options.radius,
        count: options.count,
        seed: options.seed,
    };
    interrupt::listen()?;
    let start = Instant::now();
    let (pack, rest) = packed(&recipe, options)?;
    say(&format!(
        "grains             {} of {} in {:.2} s",
        pack.grains.len(),
        options.count,
        start.elapsed().as_secs_f64()
    ))?;
    if let Some(rest) = rest {
        say(&rest)?;
    }
    say(&format!("packing fraction   {:.5}", pack.fraction()))?;
    say(&format!("mean free path     {:.5} mm by formula", pack.free_path_by_formula()))?;
    if let Some(rays) = pack.free_path_by_rays(LINES, options.seed) {
        say(&format!("                   {:.5} ± {:.5} mm by {LINES} rays", rays.mean, rays.error))?;
    }
    if let Some(bulk) = pack.bulk(options.seed) {
        say(&format!("in the bulk        {:.5} ± {:.5} is grain", bulk.fraction, bulk.error))?;
        say(&format!("                   {:.5} mm mean free path", bulk.free_path))?;
    }
    if let Some(path) = &options.out {
        write(path, &pack, options)?;
        say(&format!("scene              {}", path.display()))?;
    }
    Ok(if interrupt::requested() { ExitCode::from(interrupt::EXIT) } else { ExitCode::SUCCESS })
}

/// The scene, or its part.
fn write(path: &Path, pack: &Pack, options: &PackOptions) -> anyhow::Result<()> {
    let text = if options.bare {
        scene::grains(pack, options.material, &name(path))
    } else {
        scene::text(pack, options.material)
    };
    let bytes = if is_gzip(path) { deflate(text.as_bytes())? } else { text.into_bytes() };
    Ok(save::replace(path, &bytes)?)
}

/// What a file is called before its first dot, in letters that need no quotes.
fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.split('.').next().unwrap_or_default();
    stem.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

/// The pack, and how much at rest it is if it has settled.
fn packed(recipe: &Recipe, options: &PackOptions) -> anyhow::Result<(Pack, Option<String>)> {
    if !options.settle {
        let bar = bar(recipe.count, "{bar:30} {percent:>3} %  {pos} of {len} grains   {eta} left");
        let pack = Pack::fill(recipe, |grains| {
            bar.set_position(grains);
            !interrupt::requested()
        });
        bar.finish_and_clear();
        return Ok((pack?, None));
    }
    let bar = bar(1000, "{bar:30} {percent:>3} %  {msg} grains   about {eta} left");
    let settled = settle(recipe, options.friction, |progress| {
        bar.set_message(progress.grains.to_string());
        bar.set_position((1000.0 * progress.done) as u64);
        !interrupt::requested()
    });
    bar.finish_and_clear();
    let settled = settled?;
    let rest = format!(
        "at rest            to {:.2} % of the speed that lifts a grain by its radius; {} taken out that overlapped or moved",
        100.0 * settled.unrest,
        settled.removed
    );
    Ok((settled.pack, Some(rest)))
}

fn bar(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style)
}
