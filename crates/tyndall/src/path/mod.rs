//! A path as a value: where it is, what it weighs, what it has been through.

pub mod ahead;
pub mod aim;
pub mod deep;
pub mod event;
pub mod history;
mod passage;
pub mod shadow;
pub mod sight;
pub mod turn;
pub mod vertex;
pub mod weights;

pub use deep::{Attempt, Surroundings};
pub use event::Event;
pub use history::History;
pub use sight::Sight;
pub use turn::{Kind, Source, Turn};
pub use vertex::Vertex;
pub use weights::PathWeights;

use crate::{
    granular::Stage,
    integrator::CameraSample,
    light::Reference,
    math::Ray,
    medium::{Inside, Within},
    sampling::Sampler,
    scene::Scene,
    spectrum::Wavelengths,
};

/// One path of light, followed from the camera.
#[derive(Debug, Clone)]
pub struct Path {
    /// Where it goes next.
    pub ray: Ray,
    /// The medium that it is in.
    pub inside: Inside,
    /// The bodies that it is in, where bodies can overlap.
    pub within: Within,
    /// Those that it is in once it has passed the surface that it is at.
    pub beyond: Within,
    /// What it knows of its surroundings.
    pub around: Surroundings,
    /// What it would carry.
    pub weights: PathWeights,
    /// What its lanes mean.
    pub wavelengths: Wavelengths,
    /// The lane that makes the decisions.
    pub hero: usize,
    /// Its random numbers.
    pub sampler: Sampler,
    /// What it has been through.
    pub history: History,
    /// How far it has come among grains.
    pub stage: Stage,
    /// The last vertex from which a light could have been sampled.
    pub last_vertex: Reference,
    /// How it was sampled.
    pub sight: Sight,
    /// Whether the light at the end of its way has been found: see [`ahead`].
    pub foreseen: bool,
}

impl Path {
    /// A path that leaves the camera.
    pub fn new(scene: &Scene, seen: &CameraSample) -> Self {
        let CameraSample { ray, wavelengths, u_hero, sampler } = *seen;
        Self {
            ray,
            inside: scene.around_camera().inside(scene, &wavelengths),
            within: *scene.around_camera(),
            beyond: *scene.around_camera(),
            around: Surroundings::default(),
            weights: PathWeights::default(),
            wavelengths,
            hero: ((u_hero * 4.0) as usize).min(3),
            sampler,
            history: History::default(),
            stage: Stage::default(),
            last_vertex: Reference { p: ray.origin, normal: None },
            sight: Sight::Straight,
            foreseen: false,
        }
    }
}
