//! What a point is in, when nobody says: found once, when the scene is made.
//!
//! Rays go out from the point in several directions, through everything. A closed surface is left once more than it is
//! entered if the point is inside of it, whatever its shape. Each ray can err where it grazes an edge, so the majority
//! holds. Surfaces with edges have no inside, and are not asked.
//!
//! Of closed surfaces without a priority the innermost says what the medium is: the first of those that enclose the
//! point which a ray meets, on the side from which it is met.

use std::collections::HashMap;

use super::{
    BodyId, MediumId, Within,
    bodies::inward,
    crossing::{COINCIDENT, coincident},
};
use crate::{
    math::{Ray, Vec2, Vec3},
    scene::Scene,
    shape::{Interaction, ObjectId},
};

/// Directions that are asked: an odd number, in no plane and along no axis.
const DIRECTIONS: usize = 9;
/// Surfaces after which a ray has seen enough.
const MOST_SURFACES: usize = 10_000;

/// A surface that may enclose a point: a body, or an object without a priority; and which copy of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Shell {
    Body(BodyId, u32),
    Object(u32, u32),
}

/// What the camera is in, where the ray through the middle of the image starts. What the scene says about its medium holds.
pub(crate) fn around_camera(scene: &Scene) -> Within {
    let middle = Vec2::splat(0.5);
    let mut within = within(scene, scene.camera.view.ray(middle, middle).ray.origin);
    if let Some(medium) = scene.camera.medium {
        within.say(medium);
    }
    within
}

/// What the point `p` is in.
pub fn within(scene: &Scene, p: Vec3) -> Within {
    if !scene.objects.iter().any(|o| o.body.is_some() || o.interface.is_some()) {
        return Within::default();
    }
    let rays: Vec<_> = (0..DIRECTIONS).map(|i| surfaces(scene, Ray::new(p, direction(i)))).collect();
    let mut votes: HashMap<Shell, usize> = HashMap::new();
    for ray in &rays {
        let mut depth: HashMap<Shell, i32> = HashMap::new();
        for (shell, _, leaves) in ray {
            *depth.entry(*shell).or_default() += if *leaves { 1 } else { -1 };
        }
        depth.into_iter().filter(|(_, d)| *d > 0).for_each(|(shell, _)| *votes.entry(shell).or_default() += 1);
    }
    votes.retain(|_, n| 2 * *n > DIRECTIONS);
    let mut within = Within::outside(innermost(&rays, &votes));
    let mut shells: Vec<_> = votes.into_keys().collect();
    shells.sort_unstable();
    for shell in shells {
        if let Shell::Body(body, copy) = shell {
            // More bodies than a record holds are tallied when a path crosses them.
            let _ = within.cross_body(body, copy, true, true);
        }
    }
    within
}

/// A surface that a ray meets: its shell, the medium on the side from which it is met, and whether the ray leaves.
type Met = (Shell, Option<MediumId>, bool);

/// The closed surfaces with media or priorities along a ray.
fn surfaces(scene: &Scene, mut ray: Ray) -> Vec<Met> {
    let mut met = Vec::new();
    let mut closed: HashMap<ObjectId, bool> = HashMap::new();
    for _ in 0..MOST_SURFACES {
        let Some(hit) = scene.geometry.intersect(&ray, f32::INFINITY) else { break };
        let mut surface = scene.geometry.interaction(&ray, &hit);
        surface.error *= COINCIDENT;
        let own = (surface, inward(ray.dir, surface.ng));
        for (face, enters) in std::iter::once(own).chain(coincident(scene, &surface, ray.dir)) {
            met.extend(shell(scene, &face, enters, &mut closed).map(|(shell, medium)| (shell, medium, !enters)));
        }
        ray = surface.spawn(ray.dir);
    }
    met
}

fn shell(
    scene: &Scene,
    surface: &Interaction,
    enters: bool,
    closed: &mut HashMap<ObjectId, bool>,
) -> Option<(Shell, Option<MediumId>)> {
    let object = scene.object(surface);
    if let Some(member) = object.body {
        let body = &scene.bodies()[member.body.0 as usize];
        return body.closed.then_some((Shell::Body(member.body, surface.instance), None));
    }
    let interface = object.interface?;
    let is_closed = *closed.entry(surface.object).or_insert_with(|| scene.geometry.is_closed(&[surface.object]));
    let near = interface.towards(if enters { 1.0 } else { -1.0 });
    is_closed.then_some((Shell::Object(surface.object.0, surface.instance), near))
}

/// What the first enclosing surface without a priority says, by most rays.
fn innermost(rays: &[Vec<Met>], enclosing: &HashMap<Shell, usize>) -> Option<MediumId> {
    let says = |ray: &Vec<Met>| {
        ray.iter()
            .find(|(shell, ..)| matches!(shell, Shell::Object(..)) && enclosing.contains_key(shell))
            .and_then(|(_, medium, _)| *medium)
    };
    let said: Vec<_> = rays.iter().map(says).collect();
    let votes = |medium: Option<MediumId>| said.iter().filter(|s| **s == medium).count();
    said.iter().copied().max_by_key(|medium| (votes(*medium), medium.map(|m| std::cmp::Reverse(m.0)))).flatten()
}

/// Points of a spiral from pole to pole (Rakhmanov, Saff and Zhou 1994), tilted.
fn direction(i: usize) -> Vec3 {
    let z = 1.0 - (2.0 * i as f32 + 1.0) / DIRECTIONS as f32;
    let (sin, cos) = (2.399_963_2 * i as f32 + 0.613).sin_cos();
    let r = (1.0 - z * z).sqrt();
    let tilt = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.37, 0.71, 0.19);
    (tilt * Vec3::new(r * cos, r * sin, z)).normalize()
}
