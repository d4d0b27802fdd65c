//! `tyndall pack CONTAINER`: grains in a container, what part of it they fill, how far light goes between them, and a scene.

mod scene;

use std::{path::PathBuf, process::ExitCode, time::Instant};

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use tyndall_formats::film::save;
use tyndall_grains::{container::Container, pack::Pack, radii::Radii};

use crate::interrupt;

/// Lines that measure the mean free path: a standard error below a percent.
const LINES: u32 = 100_000;

/// Fills a container with round grains.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall pack sphere:8 --radius 0.5 --count 1500 -o ball.pbrt
  tyndall pack box:20:20:10 --radius lognormal:0.4:0.3 --count 5000 --material salt -o salt.pbrt

Ctrl-C ends the packing and keeps what has been packed. Lengths are millimetres.")]
pub(crate) struct PackOptions {
    /// What to fill: box:X:Y:Z (edges), sphere:R, cylinder:R:H
    container: Container,
    /// Radii of the grains: R, uniform:MIN:MAX, lognormal:MEDIAN:SIGMA
    #[arg(long)]
    radius: Radii,
    /// How many grains; fewer if the container is full before
    #[arg(long, default_value_t = 1000)]
    count: u64,
    /// What the grains of the scene are of
    #[arg(long, value_enum, default_value_t = Material::Glass)]
    material: Material,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The pbrt scene to write
    #[arg(short, long)]
    out: Option<PathBuf>,
}

/// What clear grains are of: refractive index at 589 nm. None of them absorbs visible light over a grain of a millimetre.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Material {
    /// Crown glass N-BK7, 1.5168 (Schott's data sheet)
    Glass,
    /// Sodium chloride, 1.544 (Li 1976)
    Salt,
    /// Sucrose, 1.558: the mean of 1.538, 1.565, 1.571 along its axes (CRC Handbook)
    Sugar,
    /// Ice, 1.31 (Warren and Brandt 2008)
    Snow,
    /// Quartz, 1.544 (Ghosh 1999, ordinary ray)
    Sand,
}

impl Material {
    fn eta(self) -> f64 {
        match self {
            Self::Glass => 1.5168,
            Self::Salt | Self::Sand => 1.544,
            Self::Sugar => 1.558,
            Self::Snow => 1.31,
        }
    }
}

pub(crate) fn run(options: &PackOptions) -> anyhow::Result<ExitCode> {
    if let Some(path) = &options.out {
        save::check(path)?;
    }
    interrupt::listen()?;
    let start = Instant::now();
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {pos} of {len} grains   {eta} left");
    let bar = ProgressBar::new(options.count).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let pack = Pack::fill(options.container, options.radius, options.count, options.seed, |grains| {
        bar.set_position(grains);
        !interrupt::requested()
    });
    bar.finish_and_clear();
    let pack = pack?;
    let seconds = start.elapsed().as_secs_f64();
    println!("grains             {} of {} in {seconds:.2} s", pack.grains.len(), options.count);
    println!("packing fraction   {:.5}", pack.fraction());
    println!("mean free path     {:.5} mm by formula", pack.free_path_by_formula());
    if let Some(rays) = pack.free_path_by_rays(LINES, options.seed) {
        println!("                   {:.5} ± {:.5} mm by {LINES} rays", rays.mean, rays.error);
    }
    if let Some(path) = &options.out {
        save::replace(path, scene::text(&pack, options.material.eta()).as_bytes())?;
        println!("scene              {}", path.display());
    }
    Ok(if interrupt::requested() { ExitCode::from(interrupt::EXIT) } else { ExitCode::SUCCESS })
}
