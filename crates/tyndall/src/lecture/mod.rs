//! The eight estimators of the lecture ("Multiple scattering", Marschner, Cornell CS 6630, 2009): Kajiya-style path
//! tracing of surfaces and of homogeneous volumes, each version one page that can be laid beside its slide.
//!
//! | version | what it adds | what that buys |
//! |---|---|---|
//! | 0 | the transport equation, one random direction at each integral | it is right |
//! | 0.5 | roulette | it ends |
//! | 0.75 | directions drawn from the BRDF and the phase function | less variance where they are peaked |
//! | 1.0 | luminaires are sampled, direct and indirect light apart | small lights, and Dirac ones, are found |
//!
//! All share the slides' primitives ([`primitives`]) and are recursive as the slides are. Light is carried one lane at a
//! time, so that the radiance of the slide is a number; a camera sample picks its lane by chance.
//!
//! What the slides leave open is settled alike in all:
//! - Where nothing is hit, the ray meets the environment as a luminaire at infinity, which reflects nothing.
//! - A surface without a material is passed straight on, into the medium behind it.
//! - A Dirac lobe (mirror, smooth glass) is never met by a direction drawn from elsewhere: it is sampled in all versions.
//! - Lights without extent (point, spot, distant) are never met by a ray: only the versions 1.0 see them.
//! - The surface estimators ignore media.
//! - Media scatter and absorb, and do not glow.
//! - A recursion deeper than [`MAX_DEPTH`] is cut, and what it lost is tallied.

mod primitives;
mod surface_v0;
mod surface_v0_5;
mod surface_v0_75;
mod surface_v1;
mod volume_v0;
mod volume_v0_5;
mod volume_v0_75;
mod volume_v1;

pub use primitives::{MAX_DEPTH, SURVIVAL_PROBABILITY};

use crate::{
    integrator::{CameraSample, Integrator, in_one_lane},
    math::Vec3,
    scene::Scene,
    spectrum::Lanes,
    tally::Tally,
};
use primitives::{Point, Radiance, World};

/// The names of the estimators, in the order of the lecture.
pub const NAMES: [&str; 8] = [
    "lecture-surface-0",
    "lecture-surface-0.5",
    "lecture-surface-0.75",
    "lecture-surface-1.0",
    "lecture-volume-0",
    "lecture-volume-0.5",
    "lecture-volume-0.75",
    "lecture-volume-1.0",
];

/// An estimator of the lecture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lecture {
    /// Surfaces, version 0: the bare equation.
    SurfaceV0,
    /// Surfaces, version 0.5: with roulette.
    SurfaceV0_5,
    /// Surfaces, version 0.75: with BRDF sampling.
    SurfaceV0_75,
    /// Surfaces, version 1.0: with luminaire sampling.
    SurfaceV1,
    /// Volumes, version 0: the bare equation.
    VolumeV0,
    /// Volumes, version 0.5: with roulette.
    VolumeV0_5,
    /// Volumes, version 0.75: with BRDF and phase function sampling.
    VolumeV0_75,
    /// Volumes, version 1.0: with luminaire sampling.
    VolumeV1,
}

/// `rayRadianceEst(x, ω)` of a version.
type RayRadianceEst = fn(&mut World, &Point, Vec3) -> Radiance;

/// The estimator of a name of [`NAMES`].
pub fn named(name: &str) -> Option<Lecture> {
    NAMES.iter().position(|n| *n == name).map(|i| Lecture::ALL[i])
}

impl Lecture {
    /// All, in the order of [`NAMES`].
    pub const ALL: [Self; 8] = [
        Self::SurfaceV0,
        Self::SurfaceV0_5,
        Self::SurfaceV0_75,
        Self::SurfaceV1,
        Self::VolumeV0,
        Self::VolumeV0_5,
        Self::VolumeV0_75,
        Self::VolumeV1,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        NAMES[self as usize]
    }

    /// Whether it sees media.
    pub fn sees_media(self) -> bool {
        matches!(self, Self::VolumeV0 | Self::VolumeV0_5 | Self::VolumeV0_75 | Self::VolumeV1)
    }

    fn ray_radiance_est(self) -> RayRadianceEst {
        match self {
            Self::SurfaceV0 => surface_v0::ray_radiance_est,
            Self::SurfaceV0_5 => surface_v0_5::ray_radiance_est,
            Self::SurfaceV0_75 => surface_v0_75::ray_radiance_est,
            Self::SurfaceV1 => surface_v1::ray_radiance_est,
            Self::VolumeV0 => volume_v0::ray_radiance_est,
            Self::VolumeV0_5 => volume_v0_5::ray_radiance_est,
            Self::VolumeV0_75 => volume_v0_75::ray_radiance_est,
            Self::VolumeV1 => |world, x, omega| volume_v1::ray_radiance_est(world, x, omega, 1.0),
        }
    }
}

impl Integrator for Lecture {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        let CameraSample { ray, wavelengths, u_hero, mut sampler } = *seen;
        in_one_lane(scene.color, u_hero, |lane| {
            let mut world = World::new(scene, wavelengths, lane, self.sees_media(), &mut sampler, tally);
            let eye = world.eye(ray.origin);
            let estimate = self.ray_radiance_est()(&mut world, &eye, ray.dir);
            world.settle(estimate)
        })
    }
}
