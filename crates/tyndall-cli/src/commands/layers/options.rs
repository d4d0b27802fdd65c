//! The arguments of `tyndall layers`.

use std::path::PathBuf;

use clap::Args;

use crate::values;

/// Lists the layers of light that have names, says what an expression selects, or shows those of an image.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall layers milk.exr                   the layers of an image, in groups that add up to it
  tyndall layers milk.exr --page milk.html  a page with sliders that mixes them, for a browser; no server is needed
  tyndall layers                            the layers that have names, with their expressions
  tyndall layers --explain 'CD+S+L'         what an expression selects, in words
  tyndall layers --explain orders:2         the same of a list of layers
  tyndall render scene.pbrt --layers emission,direct,indirect
  tyndall render scene.pbrt --layers \"caustic=CDS+L,milk=C.*V'milk'.*[LOB]\"

An expression is a pattern over what a path of light goes through, from the camera: C the camera, R and T reflection and
transmission, S, G and D a sharp, glossy or diffuse one, V scattering in a medium, L a light, O matter that glows, B the
background, . anything. <RD> is both; V'milk' bears a name; [RV] is one of several, [^V] any other; * + ? {2} {2,4} repeat;
| and parentheses as usual. The book has more: docs/src/layers.md.")]
pub(crate) struct LayersOptions {
    /// An image with layers of light, by tyndall render --layers
    #[arg(value_name = "IMAGE.exr", conflicts_with = "explain")]
    pub(crate) image: Option<PathBuf>,
    /// An expression, or a list of layers as --layers of tyndall render takes it
    #[arg(long, value_name = "EXPR|LIST")]
    pub(crate) explain: Option<String>,
    /// Write a page that mixes the layers of the image: one file, with all that it needs
    #[arg(long, value_name = "FILE.html", requires = "image")]
    pub(crate) page: Option<PathBuf>,
    /// Write the image and its layers side by side, a picture for each group: STEM-ways.png, STEM-media.png, …
    #[arg(long, value_name = "STEM", requires = "image")]
    pub(crate) strips: Option<PathBuf>,
    /// Exposure of page and pictures [stops]
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, requires = "image")]
    #[arg(value_parser = values::finite)]
    pub(crate) exposure: f32,
    /// Exit with status 1 if the layers of a group do not add up to the image, to a unit in the last place
    #[arg(long, requires = "image")]
    pub(crate) check: bool,
}
