//! What the user may ask of the furnace and of the goniometer.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use tyndall::phase::{Isotropic, Phase, Rayleigh};
use tyndall_lab::{slab::Layer, world::Substance};

use super::{Measurement, layer};
use crate::{
    args::{ColorName, IntegratorName},
    values,
};

/// A scene in uniform light.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall lab furnace scene.pbrt --lossless --picture furnace        what of this scene is not 1 in a sky of 1
  tyndall lab furnace --material marble --lossless                   a ball of a measured medium
  tyndall lab furnace --material 'conductor \"float roughness\" 0.5'  a surface in pbrt's words, on a ball
  tyndall lab furnace scene.xml --integrator analog --time 1m --json -

The scene's own lights go out, and the sky shines with radiance 1 from everywhere. What neither absorbs nor makes energy
is then 1 in every pixel (from inside of a body of index n: n²). Every tile of 8×8 pixels and the whole image are held
against that with their standard errors; the verdict is over all of them, with the chance p that noise alone does it.
Photons that follow the camera's rays tell which material and which medium has taken the light that is missing.

--lossless takes the absorption out of media, so that only surfaces can take light. The picture is the deviation
(mean − 1): NAME.exr with its standard error, NAME.png red where energy is made, blue where it is lost.
Exit status: 0 nothing is made, 1 energy is made, 2 failed.")]
pub(crate) struct FurnaceOptions {
    /// The scene: .pbrt (pbrt-v4) or .xml (Mitsuba 3)
    #[arg(required_unless_present = "material", conflicts_with = "material")]
    pub(crate) scene: Option<PathBuf>,
    /// Instead of a scene a ball: of a measured medium (marble), or with a surface in pbrt's words
    #[arg(long, value_name = "NAME|WORDS", help_heading = "Experiment")]
    pub(crate) material: Option<String>,
    /// Radius of the ball [mm]
    #[arg(long, value_name = "LENGTH", value_parser = values::size, allow_hyphen_values = true)]
    #[arg(default_value = "10mm", help_heading = "Experiment")]
    pub(crate) radius: f64,
    /// Take the absorption out of all media
    #[arg(long, help_heading = "Experiment")]
    pub(crate) lossless: bool,
    /// Set a parameter of the scene, such as a Mitsuba $parameter; repeatable
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = values::definition, help_heading = "Experiment")]
    pub(crate) define: Vec<(String, String)>,
    /// Leave out what tyndall does not know yet, with a warning, instead of refusing the scene
    #[arg(long, help_heading = "Experiment")]
    pub(crate) lenient: bool,
    /// Size of the image [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = values::resolution, help_heading = "Experiment")]
    pub(crate) resolution: Option<[u32; 2]>,
    /// How light is transported
    #[arg(long, value_name = "NAME", default_value = "volpath", help_heading = "Experiment")]
    pub(crate) integrator: IntegratorName,
    /// rgb, or mono
    #[arg(long, value_name = "MODE", default_value = "rgb", hide_possible_values = true, help_heading = "Experiment")]
    pub(crate) color: ColorName,
    /// Write the deviation: a name in .exr (numbers) or .png (red and blue), or one without ending for both
    #[arg(long, value_name = "FILE", help_heading = "Picture")]
    pub(crate) picture: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// Something lit from one direction.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("specimen").required(true)))]
#[command(after_help = "\
Examples:
  tyndall lab gonio scene.pbrt --material gold --angle 60 --picture gold     a material of a scene, by its name
  tyndall lab gonio --material 'conductor \"float roughness\" 0.3' --angle 45 --plot lobe.svg
                                                                             a material in pbrt's words
  tyndall lab gonio --material 'dielectric \"float roughness\" 0.5' --inside  ground glass, from inside
  tyndall lab gonio --phase 0.8                                              Henyey and Greenstein's phase function
  tyndall lab gonio --layer 'albedo=0.9 tau=2 g=0.75' --angle 60             plane layers
  tyndall lab gonio --grain 'n=1.5 sigma_a=0.1'                              a grain of glass, beside the exact values
  tyndall lab gonio --grain 'n=1.5 sigma_a=0.1' --mesh sand.ply              a grain of any shape

Light of power 1 comes in at --angle; what leaves is power per solid angle [1/sr], f·|cos| of a BSDF, over the sphere.
The map has rows of equal height (cosine 1 on top, −1 below) and columns of equal azimuth (0, where a mirror sends
light, is in the middle): pixels of one solid angle. For surfaces and layers +z is the side that light comes from; for
phase functions and grains it is straight on. Dirac lobes and light that has not collided in layers are told as
specular, and are not in the map.

A BSDF or phase function is sampled (a histogram) and evaluated (an integral over each pixel); both must agree, and z
says whether they do. The picture: NAME.exr has the map, its standard error, and as layers evaluation and z; NAME.png
shows both hemispheres, each from its pole to its rim. --plot draws the plane of incidence as a polar diagram.")]
pub(crate) struct GonioOptions {
    /// A scene (.pbrt or .xml), of which --material or --medium names a part
    #[arg(conflicts_with_all = ["phase", "layer", "grain"])]
    pub(crate) scene: Option<PathBuf>,
    /// A material of the scene by its name, or one in pbrt's words
    #[arg(long, value_name = "NAME|WORDS", group = "specimen", help_heading = "Experiment")]
    pub(crate) material: Option<String>,
    /// The phase function of a medium of the scene, by its name
    #[arg(long, value_name = "NAME", group = "specimen", requires = "scene", help_heading = "Experiment")]
    pub(crate) medium: Option<String>,
    /// A phase function: a mean cosine g (Henyey and Greenstein), isotropic or rayleigh
    #[arg(long, value_name = "G|NAME", value_parser = phase, group = "specimen", allow_hyphen_values = true)]
    #[arg(help_heading = "Experiment")]
    pub(crate) phase: Option<Phase>,
    /// A layer, as of lab slab, from top to bottom; repeatable
    #[arg(long, value_name = "NAME=VALUE…", value_parser = layer, group = "specimen", help_heading = "Experiment")]
    pub(crate) layer: Vec<Layer>,
    /// A ball of radius 1 in a beam as wide: n, sigma_a, sigma_s, g
    #[arg(long, value_name = "NAME=VALUE…", value_parser = grain, group = "specimen", help_heading = "Experiment")]
    pub(crate) grain: Option<Substance>,
    /// Instead of the ball a closed mesh (.ply, .obj, .serialized), lit along its -z; lengths are those of the file
    #[arg(long, value_name = "FILE", requires = "grain", help_heading = "Experiment")]
    pub(crate) mesh: Option<PathBuf>,
    /// Angle of incidence on a surface or layers [degrees]
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = values::incidence)]
    #[arg(help_heading = "Experiment")]
    pub(crate) angle: f64,
    /// Light from inside of the surface
    #[arg(long, requires = "material", help_heading = "Experiment")]
    pub(crate) inside: bool,
    /// Set a parameter of the scene, such as a Mitsuba $parameter; repeatable
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = values::definition, help_heading = "Experiment")]
    pub(crate) define: Vec<(String, String)>,
    /// Leave out what tyndall does not know yet, with a warning, instead of refusing the scene
    #[arg(long, help_heading = "Experiment")]
    pub(crate) lenient: bool,
    /// Rows of the map; it has twice as many columns
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(2..=256))]
    #[arg(help_heading = "Picture")]
    pub(crate) rows: u32,
    /// Write the map: a name in .exr (numbers) or .png (both hemispheres), or one without ending for both
    #[arg(long, value_name = "FILE", help_heading = "Picture")]
    pub(crate) picture: Option<PathBuf>,
    /// Powers of ten from black to white, and from the middle to the rim of the plot
    #[arg(long, value_name = "N", default_value_t = 3.0, value_parser = values::decades, help_heading = "Picture")]
    pub(crate) decades: f64,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// `n=1.5 sigma_a=0.1`, of a ball of radius 1.
fn grain(text: &str) -> Result<Substance, String> {
    let grain = layer(&format!("sigma_a=0 {text}"))?;
    if grain.thickness.is_finite() { Err("a grain has no `d`: its radius is 1".into()) } else { Ok(grain.substance) }
}

/// `0.8`, `isotropic`, `rayleigh`.
fn phase(text: &str) -> Result<Phase, String> {
    match text {
        "isotropic" => Ok(Phase::Isotropic(Isotropic)),
        "rayleigh" => Ok(Phase::Rayleigh(Rayleigh)),
        number => {
            let g = number.parse().map_err(|_| "expected a mean cosine, such as 0.8, isotropic or rayleigh")?;
            Phase::henyey_greenstein(g).map_err(|fault| fault.to_string())
        }
    }
}
