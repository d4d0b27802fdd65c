//! What the user may ask for.

use std::{path::PathBuf, time::Duration};

use clap::{Args, Parser, Subcommand, ValueEnum};
use tyndall::film::Crop;

use crate::{
    commands::{
        lab::options::Instrument, layers::options::LayersOptions, mix::options::MixOptions, pack::PackOptions,
        separate::options::SeparateOptions,
    },
    values::{self, LayerList},
};

/// A renderer for light that scatters many times: milk, marble, skin, fog.
#[derive(Debug, Parser)]
#[command(version, propagate_version = true, max_term_width = 110)]
#[command(after_help = "Start with `tyndall render scenes/milk/scene.pbrt`; `tyndall help render` tells more.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene (pbrt-v4 or Mitsuba 3) to an image with its standard error
    Render(Box<RenderOptions>),
    /// Compare two images: error measures, a z-test from their standard errors, a difference image
    Compare(CompareOptions),
    /// Write a scene in the other scene language: Mitsuba's as pbrt's, pbrt's as Mitsuba's
    Convert(ConvertOptions),
    /// Render the lecture's eight estimators side by side: images, contact sheet, plot, table
    Lecture(LectureOptions),
    /// Tell what is in a scene, without rendering it
    Info(InfoOptions),
    /// Measure with a virtual instrument: plane layers, beams, furnaces, a goniometer, point sources, balls, walks
    #[command(subcommand)]
    Lab(Box<Instrument>),
    /// Mix milk, cloud, fog, ink, smoke or sea water from what is in it: coefficients, plots, media for scenes
    #[command(subcommand)]
    Mix(Box<MixOptions>),
    /// Fill a box, ball or cylinder with grains: packing fraction, mean free path, an instanced scene
    Pack(PackOptions),
    /// List all materials that have a name, each with its colour
    Materials(MaterialsOptions),
    /// Layers of light: their names, what an expression selects, what an image has of them, a page that mixes them
    Layers(LayersOptions),
    /// Separate direct from global light by patterns that a projector throws, and show the truth beside it
    Separate(Box<SeparateOptions>),
    /// Measure published numbers, and say whether the program reproduces them
    Verify(VerifyOptions),
}

/// Renders a scene to an image with its standard error.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall render scenes/milk/scene.pbrt             milk.exr and milk.png, in this directory
  tyndall render scene.xml --spp 1024 -o out/fog    out/fog.exr and out/fog.png
  tyndall render scene.pbrt --time 2m -o fog.exr    as many samples as two minutes give
  tyndall render scene.xml -D spp=64 -D g=0.9       set the scene's $parameters
  tyndall render scene.pbrt --crop 100,50,164,98    a part of the image, the same bits as in the whole
  tyndall render scene.pbrt --json - --quiet        statistics on standard output, nothing else
  tyndall render scene.pbrt --layers orders:8       light apart by the number of collisions: see tyndall layers

Ctrl-C ends the render and saves what is done; a second Ctrl-C leaves at once. The image so far is also saved every
ten seconds. Exit status: 0 done, 2 failed, 130 stopped by Ctrl-C.")]
pub(crate) struct RenderOptions {
    #[command(flatten)]
    pub(crate) input: SceneOptions,
    /// Where to write: a name in .exr (numbers) or .png (for the eye), or one without ending for both; repeatable
    /// [default: the scene's name, both, in this directory]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) tone: ToneOptions,
    /// Write statistics as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub(crate) json: Option<PathBuf>,
    /// Show the image in a running tev viewer (its default address is 127.0.0.1:14158)
    #[arg(long, value_name = "HOST:PORT", help_heading = "Output")]
    pub(crate) tev: Option<String>,
    /// Parts of the light as layers of the EXR file, with their standard errors: direct, single, orders:8,
    /// NAME=EXPRESSION, …; see tyndall layers [default: the scene's]
    #[arg(long, value_name = "LIST", value_parser = values::layers, help_heading = "Output")]
    pub(crate) layers: Option<LayerList>,
    /// Say nothing but errors
    #[arg(short, long, help_heading = "Output")]
    pub(crate) quiet: bool,

    /// Samples a pixel [default: the scene's, or no limit if --time is given]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Effort")]
    pub(crate) spp: Option<u32>,
    /// More samples where the image is noisy: after 8 for each pixel, in proportion to the standard deviation around it, from
    /// half of the mean to 16 times as many. Unbiased; a crop of such an image is not the image of the crop
    #[arg(long, help_heading = "Effort")]
    pub(crate) adaptive: bool,
    /// Stop after this time, such as 30s, 2m or 1h; every pixel gets one sample at least
    #[arg(long, value_name = "TIME", value_parser = values::duration, help_heading = "Effort")]
    pub(crate) time: Option<Duration>,
    /// Threads [default: one for each core]; the image does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Effort")]
    pub(crate) threads: Option<u16>,

    /// Seed of the random numbers [default: the scene's, or 0]
    #[arg(long, value_name = "N", help_heading = "What to render")]
    pub(crate) seed: Option<u64>,
    /// Only the pixels X0 ≤ x < X1, Y0 ≤ y < Y1 [default: the scene's]
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = values::crop, help_heading = "What to render")]
    pub(crate) crop: Option<Crop>,
    /// Size of the whole image instead of the scene's, for previews
    #[arg(long, value_name = "WxH", value_parser = values::resolution, help_heading = "What to render")]
    pub(crate) resolution: Option<[u32; 2]>,

    /// How light is transported
    #[arg(long, value_name = "NAME", default_value = "volpath", help_heading = "How to render")]
    pub(crate) integrator: IntegratorName,
    /// What the lanes of a path carry [default: rgb, or spectral for a film that records wavelengths]
    #[arg(long, value_name = "MODE", help_heading = "How to render")]
    pub(crate) color: Option<ColorName>,
    /// Where the first dimensions of a sample come from
    #[arg(long, value_name = "NAME", default_value = "sobol", help_heading = "How to render")]
    pub(crate) sampler: SamplerName,
    /// Most scatterings of a path, 0 for light seen directly; the energy that it loses is reported [default: the
    /// scene's, or no limit]
    #[arg(long, value_name = "N", help_heading = "How to render")]
    pub(crate) max_depth: Option<u32>,
    /// Grains that a path leaves before it goes on in the proxy that the scene has for them; faster and not exact: how far
    /// it is from explicit paths is measured beside, and told [default: the scene's, or explicit to the end]
    #[arg(long, value_name = "N", help_heading = "How to render")]
    pub(crate) explicit_grains: Option<u32>,
}

/// A scene file, and how to read it.
#[derive(Debug, Default, Args)]
pub(crate) struct SceneOptions {
    /// The scene: .pbrt (pbrt-v4) or .xml (Mitsuba 3)
    pub(crate) scene: PathBuf,
    /// Set a parameter of the scene, such as a Mitsuba $parameter; repeatable
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = values::definition, help_heading = "What to render")]
    pub(crate) define: Vec<(String, String)>,
    /// Leave out what tyndall does not know yet, with a warning, instead of refusing the scene
    #[arg(long, help_heading = "What to render")]
    pub(crate) lenient: bool,
}

/// From radiance to a PNG.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ToneOptions {
    /// Exposure of PNG files [stops]
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, help_heading = "Output")]
    #[arg(value_parser = values::finite)]
    pub(crate) exposure: f32,
    /// Curve of PNG files
    #[arg(long, value_name = "NAME", default_value = "srgb", help_heading = "Output")]
    pub(crate) curve: CurveName,
}

/// Lists all materials that have a name.
#[derive(Debug, Args)]
pub(crate) struct MaterialsOptions {
    /// Write the list as a page (index.html) in this directory
    #[arg(long, value_name = "DIR")]
    pub(crate) page: Option<PathBuf>,
}

/// Compares two images.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall compare a.exr b.exr                       two estimates of one scene
  tyndall compare a.exr truth.exr --reference       truth.exr is taken as exact where it tells no standard error
  tyndall compare a.exr b.exr --diff diff.png       red where A is brighter, blue where B is
  tyndall compare a.exr b.exr --check               exit status 1 if they differ by more than noise

The z-test divides the image into tiles. In each tile and channel z = (mean A − mean B) / standard error; the largest
|z| and the χ² of all tiles are judged together, corrected for their number. Standard errors of Sobol renders are upper
bounds: there the test is on the safe side, and `--sampler independent` makes it sharp.")]
pub(crate) struct CompareOptions {
    /// The first image (.exr)
    pub(crate) a: PathBuf,
    /// The second image (.exr): relative errors are relative to it
    pub(crate) b: PathBuf,
    /// Take an image without standard errors as exact
    #[arg(long)]
    pub(crate) reference: bool,
    /// Write the signed difference of luminance as PNG
    #[arg(long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,
    /// Edge of the tiles of the z-test [pixels]
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) tiles: u32,
    /// Chance of calling two renders of one image different
    #[arg(long, value_name = "P", default_value_t = 0.001, value_parser = values::probability)]
    pub(crate) significance: f64,
    /// Exit with status 1 if the images differ by more than noise
    #[arg(long)]
    pub(crate) check: bool,
    /// Write all numbers as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

/// Writes a scene in the other scene language.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall convert scene.xml scene.pbrt              from Mitsuba 3 to pbrt-v4
  tyndall convert scene.pbrt scene.xml              and back
  tyndall convert scene.xml out/scene.pbrt          meshes and pictures stay where they are, and are found there
  tyndall convert scene.xml small.pbrt -D res=64    set the scene's $parameters on the way
  tyndall convert old.pbrt new.pbrt                 the same language: what is said, in one file, in order

Includes and $parameters are carried out, defaults are left out, names are kept, and every number reads back to the same
bits: where both languages have the words, `tyndall render` makes the same image of both files, bit for bit. What the other
language has no word for is an error that shows the place; with --lenient it is left out, with a warning here and a comment
in the new file. Warnings alone tell of words that mean something slightly different there. Meshes that stand in the scene
itself and that the other language cannot say are written beside the new file as SCENE-NAME.ply. A file that the scene is read
from is never written. Exit status: 0 done, 2 failed, and then nothing is written.

The words and what becomes of them: docs/src/convert.md.")]
pub(crate) struct ConvertOptions {
    #[command(flatten)]
    pub(crate) input: SceneOptions,
    /// The new file: .pbrt (pbrt-v4) or .xml (Mitsuba 3); one that is there is replaced
    pub(crate) output: PathBuf,
    /// Say nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Renders the lecture's estimators side by side.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall lecture                           into ./lecture: images, contact sheet, plot and table
  tyndall lecture --spp 256 --out slides    finer, elsewhere")]
pub(crate) struct LectureOptions {
    /// Samples a pixel of each estimator; the equal-time images get as long as the slowest of them took
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) spp: u32,
    /// Samples a pixel of the reference, by volpath
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) reference_spp: u32,
    /// Size of the images [default: that of the scenes]
    #[arg(long, value_name = "WxH", value_parser = values::resolution)]
    pub(crate) resolution: Option<[u32; 2]>,
    /// Directory to write to
    #[arg(long, value_name = "DIR", default_value = "lecture")]
    pub(crate) out: PathBuf,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Tells what is in a scene.
#[derive(Debug, Args)]
pub(crate) struct InfoOptions {
    #[command(flatten)]
    pub(crate) input: SceneOptions,
}

/// Measures published numbers, and says whether the program reproduces them.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall verify                      a part of every table, under a minute
  tyndall verify --full               every figure, to a standard error of 0.1 % of the light or better
  tyndall verify --filter slabs       one table
  tyndall verify --list               the tables, what they hold and who made them
  tyndall verify --json report.json   every figure with expectation, standard error and z

A figure is measured with its standard error, and z is its deviation from the table in such errors. The verdict is over
all figures of all tables together: the greatest |z|, and for every table whether its figures are off in one direction
(shift), reflectances against transmittances (tilt), or in any direction (χ²), corrected for the number of these tests. Exit status: 0 reproduced, 1 not reproduced, 2 failed.")]
pub(crate) struct VerifyOptions {
    /// Every figure, instead of a part of them
    #[arg(long)]
    pub(crate) full: bool,
    /// A part of the figures in under a minute; this is the default
    #[arg(long, conflicts_with = "full")]
    pub(crate) quick: bool,
    /// Only tables whose names contain this
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub(crate) filter: String,
    /// List the tables
    #[arg(long)]
    pub(crate) list: bool,
    /// Show every figure, not only those that are far off
    #[arg(long)]
    pub(crate) all: bool,
    /// Write all figures as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
    /// Write a page with tables and plots into a directory
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Chance of calling a program wrong that is right
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = values::probability)]
    pub(crate) alpha: f64,
    /// Threads [default: one for each core]; the figures do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
}

/// Estimators by the names of the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// The workhorse: next event estimation, multiple importance sampling, spectral MIS
    Volpath,
    /// … one path after the other: the same bits
    VolpathAlone,
    /// … with a ray for each flight and a light sample at each collision, in dense media too
    VolpathTraced,
    /// Its naive twin: an oracle of a page
    Analog,
    /// Kajiya-style, surfaces only: walks until the light goes out
    #[value(name = "lecture-surface-0")]
    LectureSurface0,
    /// … with Russian roulette
    #[value(name = "lecture-surface-0.5")]
    LectureSurface05,
    /// … and importance sampling of the BRDF
    #[value(name = "lecture-surface-0.75")]
    LectureSurface075,
    /// … and luminaire sampling
    #[value(name = "lecture-surface-1.0")]
    LectureSurface10,
    /// Kajiya-style, with a homogeneous volume: walks until the light goes out
    #[value(name = "lecture-volume-0")]
    LectureVolume0,
    /// … with Russian roulette
    #[value(name = "lecture-volume-0.5")]
    LectureVolume05,
    /// … and importance sampling of BRDF and phase function
    #[value(name = "lecture-volume-0.75")]
    LectureVolume075,
    /// … and luminaire sampling
    #[value(name = "lecture-volume-1.0")]
    LectureVolume10,
}

/// Colour modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorName {
    /// Linear sRGB
    Rgb,
    /// One grey value
    Mono,
    /// Four hero wavelengths; dispersion works
    Spectral,
}

/// Samplers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SamplerName {
    /// Owen-scrambled Sobol points: less error; standard errors are upper bounds
    Sobol,
    /// Independent random numbers: standard errors are exact
    Independent,
}

/// Display curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CurveName {
    /// Straight sRGB, cut off at white
    Srgb,
    /// Hable's filmic curve (2010): rich shadows, soft highlights
    Filmic,
}

/// The word of the command line for a value.
pub(crate) fn word(value: &impl ValueEnum) -> String {
    value.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
