//! Example 1: from a scene file to a picture, in the three steps that `tyndall render` takes too.
//!
//! ```text
//! cargo run --release -p tyndall-formats --example 01_first_picture -- scenes/lecture/surface.pbrt picture.png
//! ```
//!
//! 1. [`load`] reads what the user wrote, in pbrt's or Mitsuba's language.
//! 2. [`build`] makes the immutable [`tyndall::scene::Scene`] of it: meshes and images are read, units converted, the
//!    physics checked.
//! 3. [`render`] estimates the light that reaches each pixel, and how far off the estimate may be.
//!
//! Steps 1 and 2 fail with everything that is wrong with the scene, each fault shown in its line of the file.
#![allow(clippy::print_stdout)] // an example talks

use std::{env::args, path::Path};

use tyndall::{
    integrator::VolPath,
    render::{Settings, render},
    spectrum::ColorMode,
};
use tyndall_formats::{
    build::build,
    error::Unsupported,
    film::{Curve, Image, Metadata, Tone, png},
    load,
};

fn main() {
    if let Err(fault) = run() {
        println!("{fault}");
    }
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    let scene_file = args().nth(1).ok_or("name a scene and a picture")?;
    let picture = args().nth(2).ok_or("name a picture too, in .png")?;

    let (desc, sources) =
        load(Path::new(&scene_file), &[], Unsupported::Refuse).map_err(|faults| faults.render(true))?;
    let (scene, _) = build(&desc, sources, ColorMode::Rgb).map_err(|faults| faults.render(true))?;

    let settings = Settings { spp: 16, seed: 1, ..Settings::default() };
    let rendering = render(&scene, &VolPath::default(), &settings, &()); // `()` watches nothing and stops nothing

    let image = Image::of(&rendering.film, Metadata::default());
    png::write(Path::new(&picture), &image, Tone { exposure: 0.0, curve: Curve::Srgb })?;

    let middle = (rendering.film.width / 2, rendering.film.height / 2);
    let pixel = rendering.film.pixel(middle.0, middle.1).ok_or("the middle was cropped away")?;
    println!("{picture}: {} paths, {} rays", rendering.tally.paths, rendering.tally.rays);
    println!("the pixel in the middle is {:?} ± {:?} (linear sRGB)", pixel.mean(), pixel.standard_error());
    Ok(())
}
