//! What the whole of a medium is, where that is simple: a ball or a block in which nothing else is. Paths in it need not look for
//! surfaces, see [`crate::integrator::walk`].

use super::{Object, Scene, overlap};
use crate::{
    math::Bounds,
    medium::MediumId,
    shape::{Ball, Block, ObjectId, Room, Shape},
};

/// By medium.
pub(super) fn of_media(scene: &Scene, objects: &[(ObjectId, &Object)]) -> Vec<Option<Room>> {
    let media = (0..scene.media.len()).map(|medium| MediumId(medium as u32));
    let bodies: Vec<_> = media.map(|medium| body(scene, medium, objects)).collect();
    if bodies.iter().all(Option::is_none) {
        return bodies.iter().map(|_| None).collect();
    }
    let boxes = boxes(scene, objects);
    let is_free = |id: ObjectId, room: &Room| {
        let bounds = room.bounds();
        boxes.iter().all(|(other, b)| *other == Some(id) || !overlap(&bounds, b))
    };
    bodies.into_iter().map(|body| body.filter(|(id, room)| is_free(*id, room)).map(|(_, room)| room)).collect()
}

/// The object that alone bounds a medium, and what is inside it.
fn body(scene: &Scene, medium: MediumId, objects: &[(ObjectId, &Object)]) -> Option<(ObjectId, Room)> {
    // Only closed surfaces that stand in the world itself and are turned outwards give a medium an end.
    if scene.facts.extent[medium.0 as usize] == Bounds::EVERYTHING || scene.has_bodies() {
        return None;
    }
    let mut around = objects.iter().filter(|(_, object)| object.bounds(medium));
    let (Some((id, _)), None) = (around.next(), around.next()) else { return None };
    let room = match scene.geometry.shape(*id) {
        Shape::Sphere(sphere) => sphere.round().map(|(centre, radius)| Room::Ball(Ball::within(centre, radius))),
        Shape::Mesh(mesh) => Block::inside(mesh).map(Room::Block),
        _ => None,
    }?;
    Some((*id, room))
}

/// Boxes around all that there is: objects, instances, and lights that are no surfaces.
fn boxes(scene: &Scene, objects: &[(ObjectId, &Object)]) -> Vec<(Option<ObjectId>, Bounds)> {
    let geometry = &scene.geometry;
    let in_world = objects.iter().map(|(id, _)| *id).filter(|id| !geometry.is_in_group(*id));
    let in_world = in_world.map(|id| (Some(id), geometry.object_bounds(id)));
    let instances = geometry.placed_instances().map(|bounds| (None, bounds));
    let lights = scene.facts.bare_lights.iter().map(|bounds| (None, *bounds));
    in_world.chain(instances).chain(lights).collect()
}
