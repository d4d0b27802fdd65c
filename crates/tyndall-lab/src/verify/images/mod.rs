//! Figures of the image renderer: a small world, a camera whose pixels all look along the same ray, every integrator that
//! can render it.

pub(super) mod fibres;
pub(super) mod media;
mod stage;
pub(super) mod surfaces;

use tyndall::{
    integrator::{Analog, Integrator, VolPath},
    lecture::Lecture,
    render::{Settings, render},
    sampling::SamplerKind,
    scene::Scene,
};

use super::experiment::{Check, Share};
use crate::run::Estimate;
use crate::world::SetupError;

/// Pixels a side of a film.
const SIDE: u32 = 32;

/// An integrator with its name.
pub(super) struct Named {
    name: String,
    integrator: Box<dyn Integrator>,
}

/// What integrators can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Can {
    /// Surfaces, of lights that a ray can meet: all of them.
    Surfaces,
    /// Surfaces around the camera on all sides: there the versions 0 of the lecture never end.
    ClosedSurfaces,
    /// The same, of lights so wide that a point of them drawn at random is hardly ever near.
    WideLamps,
    /// Surfaces, of lights without extent too.
    PointsOnSurfaces,
    /// Media, of lights that a ray can meet.
    Media,
    /// Media, of lights without extent too.
    PointsInMedia,
    /// What the workhorse is asked alone.
    Everything,
    /// Media that glow, which the lecture's do not, or that scatter much or with a peak, where its weights have no finite
    /// variance.
    AllMedia,
}

/// The integrators that can render such a world.
fn integrators(can: Can) -> Vec<Named> {
    let lecture = |version: Lecture| Named { name: version.name().to_owned(), integrator: Box::new(version) };
    let gathers = |version: &Lecture| matches!(version, Lecture::SurfaceV1 | Lecture::VolumeV1);
    let endless = |version: &Lecture| matches!(version, Lecture::SurfaceV0 | Lecture::VolumeV0);
    let versions = Lecture::ALL.into_iter().filter(|version| match can {
        Can::Surfaces => true,
        Can::ClosedSurfaces => !endless(version),
        Can::WideLamps => !gathers(version) && !endless(version),
        Can::PointsOnSurfaces => gathers(version),
        Can::Media => version.sees_media(),
        Can::PointsInMedia => version.sees_media() && gathers(version),
        Can::AllMedia | Can::Everything => false,
    });
    let analog = (can != Can::Everything).then(|| Named { name: "analog".to_owned(), integrator: Box::new(Analog) });
    std::iter::once(volpath(None)).chain(analog).chain(versions.map(lecture)).collect()
}

/// The workhorse, up to a number of scatterings.
fn volpath(max_depth: Option<u32>) -> Named {
    Named { name: "volpath".to_owned(), integrator: Box::new(VolPath { max_depth, ..VolPath::default() }) }
}

/// The mean over a film of samples of the same radiance, until its error is small enough.
fn mean(scene: &Scene, with: &Named, share: Share) -> Estimate {
    let pixels = u64::from(scene.camera.width * scene.camera.height);
    let most = (share.photons / pixels).max(2) as u32;
    let (mut sum, mut squares, mut count, mut first_sample) = (0.0, 0.0, 0.0, 0);
    loop {
        let spp = (first_sample.max(4)).min(most - first_sample);
        let sampler = SamplerKind::Independent;
        let settings = Settings { spp, first_sample, seed: share.seed, sampler, ..Settings::default() };
        let film = render(scene, &*with.integrator, &settings, &()).film;
        for pixel in &film.pixels {
            sum += pixel.sum[0];
            squares += pixel.sum_of_squares[0];
            count += pixel.count as f64;
        }
        first_sample += spp;
        let mean = sum / count;
        let standard_error = ((squares / count - mean * mean).max(0.0) / (count - 1.0)).sqrt();
        if first_sample >= most || standard_error <= share.error {
            return Estimate { mean, standard_error };
        }
    }
}

/// One figure by each of some integrators: `what` with its expected value.
fn by_each(share: Share, can: Can, scene: Scene, what: &str, expected: [f64; 2]) -> Vec<Check> {
    let scene = share.scene(scene);
    let [expected, uncertainty] = expected;
    // Of each its own random numbers: where they do the same they would else say the same once more.
    let check = |(number, with): (u32, &Named)| {
        let measured = mean(&scene, with, share.again(number));
        Check::new(format!("{what}, {}", with.name), expected, uncertainty, measured)
    };
    (0..).zip(&integrators(can)).map(check).collect()
}

/// Figures of which more scattering makes less.
fn falling(checks: Vec<Check>) -> Vec<Check> {
    checks.into_iter().map(Check::falling).collect()
}

/// Nothing, if it cannot be set up.
type Made<T> = Result<T, SetupError>;
