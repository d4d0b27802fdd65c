//! What the user may ask of the instruments.

mod specimen;

use std::{path::PathBuf, time::Duration};

use clap::{Args, Subcommand};
use tyndall_lab::slab::Layer;
use tyndall_lab::world::Substance;

use crate::values;
pub(crate) use specimen::{FurnaceOptions, GonioOptions};

/// A virtual instrument.
#[derive(Debug, Subcommand)]
pub(crate) enum Instrument {
    /// Plane layers under a beam: reflectance, transmittance, absorption, and where; also from MCML's .mci files
    Slab(SlabOptions),
    /// A narrow beam on a half-space, slab, ball, box or mesh of milk, marble, …: R(r), and the picture of what comes back
    Beam(BeamOptions),
    /// Any scene or material in uniform light: energy kept, lost or made, and where
    Furnace(FurnaceOptions),
    /// What leaves a surface, a phase function, layers or a grain, by direction; whether a BSDF's parts agree
    Gonio(GonioOptions),
    /// An isotropic point source in an infinite medium: fluence against distance
    Point(PointOptions),
    /// A scattering ball in a beam: what it absorbs, what leaves after how many scatterings
    Sphere(SphereOptions),
    /// A random walk: moments of its place after n free flights
    Walk(WalkOptions),
}

/// How long to measure, and where the figures go.
#[derive(Debug, Args)]
pub(crate) struct Measurement {
    /// Photons, at most [default: 1000000, or those of the .mci file, or no limit with --time or --error]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), help_heading = "Effort")]
    pub(crate) photons: Option<u64>,
    /// Stop after this time, such as 30s or 2m
    #[arg(long, value_name = "TIME", value_parser = values::duration, help_heading = "Effort")]
    pub(crate) time: Option<Duration>,
    /// Stop when the first figure of the table has this standard error
    #[arg(long, value_name = "ERROR", value_parser = values::probability, help_heading = "Effort")]
    pub(crate) error: Option<f64>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Effort")]
    pub(crate) seed: u64,
    /// Threads [default: one for each core]; the figures do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Effort")]
    pub(crate) threads: Option<u16>,
    /// Write all figures as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub(crate) json: Option<PathBuf>,
    /// Write all figures as CSV to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub(crate) csv: Option<PathBuf>,
    /// Draw the curves: a name in .svg or .png
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) plot: Option<PathBuf>,
}

/// Plane layers under a beam.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall lab slab --layer 'sigma_a=10 sigma_s=90 g=0.75 d=0.02'          van de Hulst's slab
  tyndall lab slab --layer 'albedo=0.99 tau=inf n=1.5' --error 1e-3       a half-space of index 1.5
  tyndall lab slab --layer 'sigma_a=1 sigma_s=100 g=0.9 n=1.37 d=0.1' --layer 'sigma_a=2 sigma_s=50 n=1.4'
                   --radii 50,0.01 --plot r.svg                           two layers, R(r) and T(r) drawn
  tyndall lab slab skin.mci --csv skin.csv                                every run of an input file of MCML 1.2

A layer is given by sigma_a and sigma_s [1/length] and its thickness d [length], or by albedo and tau (then its extinction
is 1 and its thickness tau); g is the mean cosine of Henyey and Greenstein's phase function [0], n the index [1]. Without d
or tau it goes on for ever. Lengths are in any unit. The standard error of every figure is told.")]
pub(crate) struct SlabOptions {
    /// An input file of MCML 1.2
    #[arg(value_name = "FILE.mci", conflicts_with_all = ["layer", "n_above", "n_below", "angle", "diffuse"])]
    #[arg(required_unless_present = "layer")]
    pub(crate) file: Option<PathBuf>,
    /// A layer, from top to bottom; repeatable
    #[arg(long, value_name = "NAME=VALUE…", value_parser = layer, help_heading = "Experiment")]
    pub(crate) layer: Vec<Layer>,
    /// Index above
    #[arg(long, value_name = "N", default_value_t = 1.0, help_heading = "Experiment")]
    pub(crate) n_above: f64,
    /// Index below
    #[arg(long, value_name = "N", default_value_t = 1.0, help_heading = "Experiment")]
    pub(crate) n_below: f64,
    /// Angle of incidence, less than 90 [degrees]
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = values::incidence, help_heading = "Experiment")]
    pub(crate) angle: f64,
    /// Light from all directions of the upper half-space alike, instead of a beam
    #[arg(long, conflicts_with = "angle", help_heading = "Experiment")]
    pub(crate) diffuse: bool,
    /// Tell where light ends up by exit angle, in N bins to 90°
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Bins")]
    pub(crate) angles: usize,
    /// … by the radius at which it leaves: N bins of a width [length]
    #[arg(long, value_name = "N,WIDTH", value_parser = bins, help_heading = "Bins")]
    pub(crate) radii: Option<(usize, f64)>,
    /// … fluence by depth: N bins of a height [length]
    #[arg(long, value_name = "N,HEIGHT", value_parser = bins, help_heading = "Bins")]
    pub(crate) depths: Option<(usize, f64)>,
    /// … by the number of scatterings, from 0 to N − 1
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Bins")]
    pub(crate) orders: usize,
    /// … by the length of the way (time of flight times speed): N bins of a width [length]
    #[arg(long, value_name = "N,WIDTH", value_parser = bins, help_heading = "Bins")]
    pub(crate) lengths: Option<(usize, f64)>,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// A narrow beam on a body.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tyndall lab beam --material skimmilk --plot r.svg --picture skim     R(r) and the picture, on a half-space
  tyndall lab beam --material marble --cube 40mm --spot 1mm --tilt 40 --picture cube
                                                                       the cube, from aside
  tyndall lab beam --sigma-a 0.1 --sigma-s 10 --g 0.9 --n 1.4 --slab 2mm --error 1e-3
  tyndall lab beam --material wholemilk --mesh bunny.ply --mesh-scale 100 --time 2m --picture bunny.exr

The beam comes from above (−z) and falls on the middle of the body. Where light leaves through what faces the beam is
told by the distance from its axis, per area and power of the beam, in the three colours of the material. Light that
has never collided is left out, also of the picture. Beside it stands what diffusion theory says of a half-space under
a beam without width: the classical dipole (Jensen et al. 2001), the better dipole (d'Eon 2012), photon beam diffusion
(Habel et al. 2013).

The picture shows the mean radiance [1/(mm² sr), of a beam of power 1] that leaves within --acceptance of the direction
of view: NAME.exr with its standard error, and NAME.png, logarithmic over --decades. Lengths are in mm unless they say
otherwise: 40mm, 4cm, 0.04m.")]
pub(crate) struct BeamOptions {
    /// A measured material, such as skimmilk, wholemilk or marble
    #[arg(long, value_name = "NAME", conflicts_with_all = ["sigma_a", "sigma_s", "g"], help_heading = "Material")]
    #[arg(required_unless_present_any = ["sigma_a", "sigma_s"])]
    pub(crate) material: Option<String>,
    /// Isotropic scattering with σ_s′ = (1 − g) σ_s, for materials of which g was measured (as pbrt has them)
    #[arg(long, requires = "material", help_heading = "Material")]
    pub(crate) reduced: bool,
    /// Absorption coefficient: one number, or red, green, blue [1/mm]
    #[arg(long, value_name = "A|R,G,B", value_parser = values::channels, allow_hyphen_values = true)]
    #[arg(help_heading = "Material")]
    pub(crate) sigma_a: Option<[f64; 3]>,
    /// Scattering coefficient: one number, or red, green, blue [1/mm]
    #[arg(long, value_name = "S|R,G,B", value_parser = values::channels, allow_hyphen_values = true)]
    #[arg(help_heading = "Material")]
    pub(crate) sigma_s: Option<[f64; 3]>,
    /// Mean cosine of Henyey and Greenstein's phase function [default: 0]
    #[arg(long, value_name = "G|R,G,B", value_parser = values::channels, allow_hyphen_values = true)]
    #[arg(help_heading = "Material")]
    pub(crate) g: Option<[f64; 3]>,
    /// Index of refraction [default: the material's, or 1]
    #[arg(long, value_name = "N", help_heading = "Material")]
    pub(crate) n: Option<f64>,

    /// A slab of this thickness, instead of a half-space
    #[arg(long, value_name = "THICKNESS", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(group = "body", help_heading = "Experiment")]
    pub(crate) slab: Option<f64>,
    /// A ball of this diameter
    #[arg(long, value_name = "DIAMETER", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(group = "body", help_heading = "Experiment")]
    pub(crate) sphere: Option<f64>,
    /// A cube of this edge
    #[arg(long, value_name = "EDGE", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(group = "body", help_heading = "Experiment")]
    pub(crate) cube: Option<f64>,
    /// A box of these edges
    #[arg(long = "box", value_name = "X,Y,Z", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(value_delimiter = ',', num_args = 3)]
    #[arg(group = "body", help_heading = "Experiment")]
    pub(crate) edges: Vec<f64>,
    /// A closed mesh: .ply, .obj or .serialized
    #[arg(long, value_name = "FILE", group = "body", help_heading = "Experiment")]
    pub(crate) mesh: Option<PathBuf>,
    /// Length of the mesh's unit
    #[arg(long, value_name = "LENGTH", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(default_value = "1mm", help_heading = "Experiment")]
    pub(crate) mesh_scale: f64,
    /// Diameter of the beam
    #[arg(long, value_name = "DIAMETER", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(default_value = "0", help_heading = "Experiment")]
    pub(crate) spot: f64,
    /// N rings of a width around the beam [default: 24, each wider than the one before]
    #[arg(long, value_name = "N,WIDTH", value_parser = bins, help_heading = "Experiment")]
    pub(crate) radii: Option<(usize, f64)>,

    /// Write the picture: a name in .exr (numbers) or .png (logarithmic), or one without ending for both
    #[arg(long, value_name = "FILE", help_heading = "Picture")]
    pub(crate) picture: Option<PathBuf>,
    /// Pixels along each edge
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(1..=512))]
    #[arg(help_heading = "Picture")]
    pub(crate) pixels: u32,
    /// What the picture is wide [default: the body, or 40 mean free paths of diffusion]
    #[arg(long, value_name = "LENGTH", value_parser = values::length, allow_hyphen_values = true)]
    #[arg(help_heading = "Picture")]
    pub(crate) field: Option<f64>,
    /// Half-angle of the cone of light that the camera accepts [degrees]: larger is less noisy, and blunter
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, help_heading = "Picture")]
    pub(crate) acceptance: f64,
    /// How far the camera stands from the beam [degrees]
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, help_heading = "Picture")]
    pub(crate) tilt: f64,
    /// … to which side [degrees]
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "Picture"
    )]
    pub(crate) azimuth: f64,
    /// Powers of ten from black to white
    #[arg(long, value_name = "N", default_value_t = 4.0, value_parser = values::decades, help_heading = "Picture")]
    pub(crate) decades: f64,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// A medium of extinction 1.
#[derive(Debug, Args)]
pub(crate) struct MediumOptions {
    /// Part of the extinction that scatters; the mean free path is the unit of length
    #[arg(long, value_name = "A", help_heading = "Experiment")]
    pub(crate) albedo: f64,
    /// Mean cosine of the phase function
    #[arg(long, value_name = "G", default_value_t = 0.0, allow_negative_numbers = true, help_heading = "Experiment")]
    pub(crate) g: f64,
}

/// A point source in an infinite medium.
#[derive(Debug, Args)]
pub(crate) struct PointOptions {
    #[command(flatten)]
    pub(crate) medium: MediumOptions,
    /// N shells of a width [mean free paths]
    #[arg(long, value_name = "N,WIDTH", value_parser = bins, default_value = "40,0.5", help_heading = "Bins")]
    pub(crate) radii: (usize, f64),
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// A scattering ball.
#[derive(Debug, Args)]
pub(crate) struct SphereOptions {
    #[command(flatten)]
    pub(crate) medium: MediumOptions,
    /// Radius [mean free paths]
    #[arg(long, value_name = "R", default_value_t = 1.0, help_heading = "Experiment")]
    pub(crate) radius: f64,
    /// Index of the ball
    #[arg(long, value_name = "N", default_value_t = 1.0, help_heading = "Experiment")]
    pub(crate) n: f64,
    /// Light that is made in the ball, everywhere and in all directions alike, instead of a beam
    #[arg(long, help_heading = "Experiment")]
    pub(crate) inside: bool,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// A random walk.
#[derive(Debug, Args)]
pub(crate) struct WalkOptions {
    /// Mean cosine of the phase function
    #[arg(long, value_name = "G", default_value_t = 0.0, allow_negative_numbers = true, help_heading = "Experiment")]
    pub(crate) g: f64,
    /// Free flights after which to measure
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,2,5,10,20,50,100")]
    #[arg(help_heading = "Experiment")]
    pub(crate) flights: Vec<u32>,
    #[command(flatten)]
    pub(crate) measurement: Measurement,
}

/// `sigma_a=10 sigma_s=90 g=0.75 n=1.4 d=0.02`, or `albedo=0.9 tau=2`.
fn layer(text: &str) -> Result<Layer, String> {
    const NAMES: [&str; 7] = ["sigma_a", "sigma_s", "albedo", "tau", "d", "g", "n"];
    let mut values = [None; NAMES.len()];
    for word in text.split([' ', ',', ';']).filter(|word| !word.is_empty()) {
        let (name, value) = word.split_once('=').ok_or(format!("`{word}` is not NAME=VALUE, such as g=0.75"))?;
        let at = NAMES.iter().position(|known| *known == name);
        let at = at.ok_or(format!("a layer has no `{name}`; it has {}", NAMES.join(", ")))?;
        values[at] = Some(value.parse::<f64>().map_err(|_| format!("`{value}` is no number"))?);
    }
    let [sigma_a, sigma_s, albedo, tau, d, g, n] = values;
    let (sigma_a, sigma_s, thickness) = match (sigma_a, sigma_s, albedo, tau, d) {
        (a, s, None, None, d) if a.or(s).is_some() => (a.unwrap_or(0.0), s.unwrap_or(0.0), d),
        (None, None, Some(albedo), tau, None) => (1.0 - albedo, albedo, tau),
        _ => return Err("a layer has either sigma_a, sigma_s and d, or albedo and tau".into()),
    };
    let substance = Substance { sigma_a, sigma_s, g: g.unwrap_or(0.0), n: n.unwrap_or(1.0) };
    substance.check().map_err(|fault| fault.to_string())?;
    Ok(Layer { substance, thickness: thickness.unwrap_or(f64::INFINITY) })
}

/// `N,WIDTH`.
fn bins(text: &str) -> Result<(usize, f64), String> {
    let read = || {
        let (count, width) = text.split_once(',')?;
        let width = width.trim().parse::<f64>().ok().filter(|w| *w > 0.0 && w.is_finite())?;
        Some((count.trim().parse().ok().filter(|n| (1..=100_000).contains(n))?, width))
    };
    read().ok_or_else(|| "expected a number of bins and their width, such as 50,0.01".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_is_given_by_coefficients_or_by_albedo_and_depth() {
        let a = layer("sigma_a=10 sigma_s=90 g=0.75 d=0.02").unwrap();
        assert_eq!(a.substance, Substance { sigma_a: 10.0, sigma_s: 90.0, g: 0.75, n: 1.0 });
        assert_eq!(a.thickness, 0.02);
        let b = layer("albedo=0.75,tau=inf,n=1.5").unwrap();
        assert_eq!((b.substance.sigma_a, b.substance.sigma_s, b.substance.n), (0.25, 0.75, 1.5));
        assert_eq!(b.thickness, f64::INFINITY);
        for (text, told) in [
            ("", "either"),
            ("sigma_a=1 albedo=1", "either"),
            ("sigma_a", "NAME=VALUE"),
            ("sigma_t=1", "it has sigma_a"),
            ("sigma_a=x", "no number"),
            ("sigma_a=-1", "at least 0"),
            ("sigma_a=1 g=1", "less than 1"),
        ] {
            assert!(layer(text).unwrap_err().contains(told), "{text}");
        }
    }
}
