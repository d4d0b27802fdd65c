//! A grain of any shape in a beam as wide: rays fall along −z of the world, which is the map's +z, on what the grain covers of
//! the plane across. Light of power 1 is what meets the grain. It lies as its mesh has it.

use glam::DVec3;
use tyndall::{
    math::{Ray, Vec3},
    scene::Scene,
    shape::{Mesh, ObjectId},
};

use crate::{
    point::source_stream,
    world::{SetupError, Substance, World},
};

/// How often a ray is drawn until it meets the grain: of a needle that fills a thousandth of its box, all but 10⁻⁴ of them do.
const TRIES: u32 = 10_000;

/// The grain, in empty space.
pub(super) fn scene(mesh: &Mesh, substance: &Substance) -> Result<Scene, SetupError> {
    let mut world = World::default();
    world.mesh(mesh.clone(), substance, &Substance::VACUUM)?;
    let height = mesh.positions.iter().map(|p| f64::from(p.length())).fold(0.0, f64::max);
    let scene = world.build(&Substance::VACUUM, 2.0 * height * DVec3::Z)?;
    let closed = scene.geometry.is_closed(&[ObjectId(0)]);
    closed.then_some(scene).ok_or(SetupError::Missing("inside of a mesh that is not closed"))
}

/// The way of a photon from the source on.
pub(super) fn ray(scene: &Scene, photon: u64, seed: u64) -> Ray {
    let bounds = scene.geometry.bounds();
    let size = bounds.max - bounds.min;
    let mut rng = source_stream(photon, seed);
    let mut draw = || {
        let place = bounds.min + size * Vec3::new(rng.next_1d(), rng.next_1d(), 0.0);
        Ray::new(Vec3::new(place.x, place.y, bounds.max.z + size.max_element()), -Vec3::Z)
    };
    let meets = |ray: &Ray| scene.geometry.intersect(ray, f32::INFINITY).is_some();
    (0..TRIES).map(|_| draw()).find(meets).unwrap_or_else(|| Ray::new(Vec3::Z * bounds.max.z, Vec3::Z))
}
