//! Example 2: a scene in code, and a number with its error.
//!
//! ```text
//! cargo run --release -p tyndall-formats --example 02_furnace
//! ```
//!
//! The furnace test: a ball that scatters and absorbs nothing, under a sky of the same radiance from everywhere, cannot
//! be seen. However often light is scattered, each direction carries the sky's radiance again: `L = 1`, exactly. The
//! ball is 10 mean free paths across, the rays go straight through its middle. With a little absorption, albedo 0.99,
//! the ball shows.
#![allow(clippy::print_stdout)] // an example talks

use tyndall::{
    camera::{Camera, CameraModel, Perspective, View},
    film::Filter,
    integrator::VolPath,
    light::{ConstantEnvironment, Light, LightTable},
    material::Material,
    math::{Transform, Vec3},
    medium::{Homogeneous, MediumId, MediumInterface},
    phase::Phase,
    render::{Settings, render},
    sampling::SamplerKind,
    scene::{Emission, MaterialId, Object, Scene},
    shape::{GeometryBuilder, Sphere},
    spectrum::{ColorMode, Spectrum},
};

/// A ball of radius 1 at z = 5, of extinction 5 and the given albedo, seen by one pixel under a sky of radiance 1.
fn ball(albedo: f32) -> Result<Scene, Box<dyn std::error::Error>> {
    let mut builder = GeometryBuilder::new();
    builder.add_sphere(Sphere::new(Vec3::Z * 5.0, 1.0), &Transform::IDENTITY, false)?;
    let medium = Homogeneous {
        sigma_a: Spectrum::constant(5.0 * (1.0 - albedo)),
        sigma_s: Spectrum::constant(5.0 * albedo),
        emission: None,
        phase: Phase::henyey_greenstein(0.5)?,
    };
    let interface = Some(MediumInterface { inside: Some(MediumId(0)), outside: None });
    let object = Object {
        name: "ball".into(),
        material: MaterialId(0),
        interface,
        emission: Emission::None,
        body: None,
        granular: None,
    };
    let window = [-0.001, 0.001, -0.001, 0.001]; // looks along +z, so narrowly that it is one ray
    let (to_world, filter) = (Transform::IDENTITY, Filter::default());
    let view = View { to_world, model: CameraModel::Perspective(Perspective::pinhole(window)), near: 0.0 };
    let camera = Camera { view, width: 1, height: 1, filter, exposure: 1.0, medium: None, layers: Vec::new() };
    let sky = Light::Constant(ConstantEnvironment { radiance: Spectrum::illuminant_rgb([1.0; 3]), luminance: 1.0 });
    let lights = LightTable::new(vec![sky]);
    Ok(Scene::new(ColorMode::Rgb, camera, builder.build()?, vec![object], vec![Material::Null], vec![medium], lights))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // With independent samples the standard error is exact; Sobol points would do better than it says.
    let settings = Settings { spp: 100_000, seed: 1, sampler: SamplerKind::Independent, ..Settings::default() };
    for albedo in [1.0, 0.99] {
        let rendering = render(&ball(albedo)?, &VolPath::default(), &settings, &());
        let pixel = &rendering.film.pixels[0];
        println!("albedo {albedo}: radiance {:.5} ± {:.5}", pixel.mean()[1], pixel.standard_error()[1]);
    }
    Ok(())
}
