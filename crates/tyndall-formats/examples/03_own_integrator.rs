//! Example 3: an estimator of one's own, ambient occlusion.
//!
//! ```text
//! cargo run --release -p tyndall-formats --example 03_own_integrator -- scenes/lecture/surface.pbrt occlusion.png
//! ```
//!
//! An [`Integrator`] is one function: a camera ray in, one estimate of what arrives along it out. Threads, samples,
//! films and files know nothing of how it does that. This one asks, where the ray meets a surface, what share of the
//! cosine-weighted hemisphere above it is free up to a distance `reach`:
//!
//! ```text
//! A = 1/π ∫ V(ω) cos θ dω  ≈  V(ω),   ω drawn with density cos θ / π
//! ```

use std::{env::args, path::Path};

use tyndall::{
    integrator::{CameraSample, Integrator},
    math::Frame,
    render::{Settings, render},
    sampling::warp::cosine_hemisphere,
    scene::Scene,
    spectrum::{ColorMode, Lanes},
    tally::Tally,
};
use tyndall_formats::{
    build::build,
    error::Unsupported,
    film::{Curve, Image, Metadata, Tone, png},
    load,
};

/// Ambient occlusion up to a distance [length].
#[derive(Debug)]
struct Occlusion {
    reach: f32,
}

impl Integrator for Occlusion {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        let CameraSample { ray, mut sampler, .. } = *seen;
        tally.rays += 1;
        let Some(hit) = scene.geometry.intersect(&ray, f32::INFINITY) else { return Lanes::ZERO };
        let point = scene.geometry.interaction(&ray, &hit);
        let viewer_side = if point.ns.dot(ray.dir) < 0.0 { point.ns } else { -point.ns };
        let dir = Frame::around(viewer_side).to_world(cosine_hemisphere(sampler.next_2d()));
        tally.shadow_rays += 1;
        // `spawn` starts beyond the rounding error of the hit: no epsilon to choose.
        let blocked = scene.geometry.occluded(&point.spawn(dir), self.reach);
        if blocked { Lanes::ZERO } else { Lanes::ONE }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [scene_file, picture] = [1, 2].map(|i| args().nth(i).unwrap_or_default());
    let (desc, sources) =
        load(Path::new(&scene_file), &[], Unsupported::Refuse).map_err(|faults| faults.render(false))?;
    let (scene, _) = build(&desc, sources, ColorMode::Mono).map_err(|faults| faults.render(false))?;
    let settings = Settings { spp: 64, ..Settings::default() };
    let rendering = render(&scene, &Occlusion { reach: 1.0 }, &settings, &());
    let image = Image::of(&rendering.film, Metadata::default());
    Ok(png::write(Path::new(&picture), &image, Tone { exposure: 0.0, curve: Curve::Srgb })?)
}
