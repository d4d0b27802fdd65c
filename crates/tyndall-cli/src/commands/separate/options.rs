//! The arguments of `tyndall separate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::{
    args::{SceneOptions, ToneOptions},
    values,
};

/// Separates direct from global light as Nayar et al. did in 2006, and shows the truth beside it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall separate scenes/milk/scene.pbrt                    a projector at the camera, the paper's checkerboards
  tyndall separate scene.pbrt --square 2 --spp 256           finer squares, less noise
  tyndall separate scene.pbrt --pattern waves --period 16    three phases of a wave
  tyndall separate scene.xml --projector scene               the scene's own projector
  tyndall separate scene.pbrt --sweep                        how the method converges as squares get finer

All lights but the projector go out. The PNG shows what the patterns tell beside the truth, and their difference; the EXR
holds both as layers (direct, global, separated_direct, separated_global, error_direct) with standard errors. The camera's
filter becomes a box. Ctrl-C ends the experiment: the truth is saved, and what patterns told that were all seen. The book has
more: docs/src/separate.md.")]
pub(crate) struct SeparateOptions {
    #[command(flatten)]
    pub(crate) input: SceneOptions,
    /// Where to write: a name in .exr (numbers) or .png (for the eye), or one without ending for both; repeatable
    /// [default: the scene's name and -separated, both, in this directory]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) tone: ToneOptions,
    /// Write all figures as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub(crate) json: Option<PathBuf>,
    /// Say nothing but errors
    #[arg(short, long, help_heading = "Output")]
    pub(crate) quiet: bool,

    /// Where the projector stands [default: where the scene has one, else at the camera]
    #[arg(long, value_name = "WHERE", help_heading = "The projector")]
    pub(crate) projector: Option<PlaceName>,
    /// How far it stands from the camera: to the right, up, ahead [length of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, default_value = "0,0,0", allow_hyphen_values = true)]
    #[arg(help_heading = "The projector")]
    pub(crate) offset: [f32; 3],
    /// Its pixels [default: 1024x768, or as many as the pixels of a smaller image can tell apart]
    #[arg(long, value_name = "WxH", value_parser = values::resolution, help_heading = "The projector")]
    pub(crate) pixels: Option<[u32; 2]>,
    /// What it throws
    #[arg(long, value_name = "NAME", default_value = "checkerboard", help_heading = "The projector")]
    pub(crate) pattern: PatternName,
    /// Side of the checkerboard's squares [pixels of the projector]
    #[arg(long, value_name = "N", default_value_t = 8, help_heading = "The projector")]
    pub(crate) square: u32,
    /// Shift from one checkerboard to the next [pixels of the projector; default: 3/8 of a square]
    #[arg(long, value_name = "N", help_heading = "The projector")]
    pub(crate) step: Option<u32>,
    /// Shifts along each axis [default: 5, or as many as come round]
    #[arg(long, value_name = "N", help_heading = "The projector")]
    pub(crate) shifts: Option<u32>,
    /// Length of waves [pixels of the projector]
    #[arg(long, value_name = "N", default_value_t = 16, help_heading = "The projector")]
    pub(crate) period: u32,
    /// Phases of waves
    #[arg(long, value_name = "N", default_value_t = 3, help_heading = "The projector")]
    pub(crate) phases: u32,
    /// Brightness of dark pixels, of that of lit ones
    #[arg(long, value_name = "B", default_value_t = 0.0, help_heading = "The projector")]
    pub(crate) dark: f32,
    /// All sides of squares from 64 pixels down to 1, with a table and a plot of the error
    #[arg(long, help_heading = "The projector")]
    pub(crate) sweep: bool,

    /// Samples a pixel of each picture
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(4..))]
    #[arg(help_heading = "Effort")]
    pub(crate) spp: u32,
    /// Threads [default: one for each core]; the image does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Effort")]
    pub(crate) threads: Option<u16>,
    /// Seed of the random numbers, the same for all pictures
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Effort")]
    pub(crate) seed: u64,
    /// Size of the image instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = values::resolution, help_heading = "What to render")]
    pub(crate) resolution: Option<[u32; 2]>,
}

/// Where the projector stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlaceName {
    /// Where the scene has one
    Scene,
    /// At the camera
    Camera,
}

/// What it throws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PatternName {
    /// Squares, shifted along both axes
    Checkerboard,
    /// Waves of several phases
    Waves,
}
