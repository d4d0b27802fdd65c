//! How much room there is in media: where they end, how far the nearest surface is, and what the whole of a medium is where that is
//! simple, a ball or a block in which nothing else is. Paths in such a [`Room`] need not look for surfaces, see
//! [`crate::integrator::walk`].

use std::cell::LazyCell;

use glam::DVec3;

use super::{Object, Scene, overlap};
use crate::{
    camera::Camera,
    light::{Light, LightTable},
    material::Material,
    math::{Bounds, Vec3},
    medium::{Body, Homogeneous, MediumId},
    shape::{
        Ball, Block, Distances, Geometry, Hollow, Hollows, Interaction, ObjectId, Room, Shape, Touching, TouchingBalls,
    },
    spectrum::Wavelengths,
};

impl Scene {
    /// A lower bound on the distance from `p` to the nearest surface and to the nearest light without a surface, at most
    /// `cap` [length].
    pub fn clearance(&self, p: Vec3, cap: f32) -> f32 {
        self.nearest(p, cap).0
    }

    /// The same with the triangle that is nearest, or about as near, if one in the world itself was looked for and found.
    fn nearest(&self, p: Vec3, cap: f32) -> (f32, Option<(ObjectId, u32)>) {
        let cap = self.clear_of_lights(p, cap);
        let bound = self.facts.distances.as_ref().and_then(|d| d.bound(p, |centre| self.search(centre)));
        bound.map_or_else(|| self.geometry.nearest(p, cap), |bound| (bound.min(cap), None))
    }

    /// A ball around `p`, as large as its clearance and no larger than `cap` [length], and the triangle that is nearest.
    #[inline]
    pub fn ball(&self, p: Vec3, cap: f32) -> (Ball, Option<(ObjectId, u32)>) {
        let (clearance, triangle) = self.nearest(p, cap);
        (Ball::within(p, clearance), triangle)
    }

    /// The ball that touches a triangle from behind, where a medium with ends is; `None` where none is remembered.
    #[inline]
    pub fn touching(&self, triangle: (ObjectId, u32)) -> Option<Option<Touching>> {
        let find = |at, inward| {
            let medium = self.objects[triangle.0.0 as usize].interface?.inside?;
            self.find_touching(at, inward, medium)
        };
        self.facts.touching.behind(&self.geometry, triangle, find)
    }

    /// The ball in a medium that touches a surface at `at` on the side of its normal `inward`, if that is quickly found.
    pub fn touching_at(&self, at: Vec3, inward: Vec3, medium: MediumId) -> Option<Touching> {
        if !self.facts.has_few_surfaces {
            return None;
        }
        self.find_touching(at.as_dvec3(), inward.as_dvec3(), medium)
    }

    fn find_touching(&self, at: DVec3, inward: DVec3, medium: MediumId) -> Option<Touching> {
        let widest = self.facts.widest[medium.0 as usize];
        Touching::widest(at, inward, widest, |ball| {
            let most = self.facts.distances.as_ref().and_then(|d| d.at_most(ball.centre, |p| self.search(p)));
            most.is_none_or(|most| most >= ball.radius)
                && self.clear_of_lights(ball.centre, ball.radius) >= ball.radius
                && self.geometry.is_free(ball.centre, ball.radius, LEAVES)
        })
    }

    /// All that a medium fills, if that is one ball or block in which no other surface and no light is.
    #[inline]
    pub fn room(&self, medium: MediumId) -> Option<Room> {
        self.facts.room[medium.0 as usize]
    }

    /// The sphere into which a ray along `dir` leaves a surface, if nothing else is in it.
    #[inline]
    pub(crate) fn hollow(&self, hit: &Interaction, dir: Vec3) -> Option<Hollow> {
        self.facts.hollows.entered(hit, dir)
    }

    /// A lower bound on the distance to the nearest light without a surface, at most `cap` [length].
    fn clear_of_lights(&self, p: Vec3, cap: f32) -> f32 {
        self.facts.bare_lights.iter().map(|bounds| bounds.distance(p)).fold(cap, f32::min)
    }

    /// The distance to the nearest surface, however far that is [length].
    fn search(&self, p: Vec3) -> f32 {
        self.geometry.clearance(p, f32::INFINITY)
    }

    /// The greatest clearance that there can be in a medium [length]; where it has no ends, a guess: half of the scene.
    #[inline]
    pub fn deepest(&self, medium: MediumId) -> f32 {
        self.facts.deepest[medium.0 as usize]
    }
}

/// Whether the nearest surface is found quickly.
pub(super) fn has_few_surfaces(geometry: &Geometry) -> bool {
    const FEW: usize = 1000;
    geometry.census().surfaces() <= FEW
}

/// All of space, unless every surface that knows the medium has it inside, is closed with its normals outwards, and stands
/// in the world itself.
pub(super) fn extent(
    medium: MediumId,
    camera: &Camera,
    geometry: &Geometry,
    objects: &[(ObjectId, &Object)],
    bodies: &[Body],
) -> Bounds {
    let mut extent = Bounds::EMPTY;
    for &(id, object) in objects {
        let Some(interface) = object.interface else { continue };
        let is_closed = || match object.body {
            Some(member) => bodies[member.body.0 as usize].closed,
            None => geometry.is_closed(&[id]),
        };
        if interface.outside == Some(medium) {
            return Bounds::EVERYTHING;
        }
        if interface.inside == Some(medium) {
            if geometry.is_in_group(id) || !is_closed() || geometry.faces_inward(id) {
                return Bounds::EVERYTHING;
            }
            extent = extent.union(geometry.object_bounds(id));
        }
    }
    if camera.medium == Some(medium) { Bounds::EVERYTHING } else { extent }
}

/// A memory of distances over all media that have ends, where there are many surfaces.
pub(super) fn distances(scene: &Scene) -> Option<Distances> {
    let ends = scene.facts.extent.iter().filter(|extent| **extent != Bounds::EVERYTHING);
    let bodies = ends.fold(Bounds::EMPTY, |all, extent| all.union(*extent));
    (!scene.facts.has_few_surfaces).then(|| Distances::over(&bodies)).flatten()
}

/// Greatest radius of balls that touch a surface [mean free paths]: few walks leave one.
const WIDEST: f32 = 256.0;
/// Leaves of the tree that a search for such a ball looks into: of more all are about equally near, and a smaller ball will do.
const LEAVES: u32 = 64;

/// By medium, at the middle of the wavelengths: the greatest radius of balls that touch its surface [length].
pub(super) fn widest(scene: &Scene) -> Vec<f32> {
    let wavelengths = Wavelengths::sample(scene.color, 0.5);
    let free_path = |medium: &Homogeneous| 1.0 / medium.coefficients(&wavelengths).sigma_t.mean();
    scene.media.iter().zip(&scene.facts.deepest).map(|(m, deepest)| (WIDEST * free_path(m)).min(*deepest)).collect()
}

/// A memory of balls that touch the surfaces of media that have ends.
pub(super) fn touching(scene: &Scene) -> TouchingBalls {
    let has_ends =
        |medium: MediumId| scene.facts.extent[medium.0 as usize] != Bounds::EVERYTHING && scene.room(medium).is_none();
    let is_wanted = |id: ObjectId| {
        scene.objects[id.0 as usize].interface.and_then(|interface| interface.inside).is_some_and(has_ends)
    };
    TouchingBalls::of(&scene.geometry, scene.objects.len(), is_wanted)
}

/// See [`Scene::deepest`].
pub(super) fn deepest(extent: &Bounds, geometry: &Geometry) -> f32 {
    let world = geometry.bounds();
    if *extent != Bounds::EVERYTHING {
        0.5 * extent.extent().min_element()
    } else if world.is_empty() {
        f32::INFINITY
    } else {
        0.5 * world.extent().max_element()
    }
}

/// The places of lights that no clearance to surfaces tells of.
pub(super) fn bare_lights(lights: &LightTable) -> Vec<Bounds> {
    /// More would cost more than they tell.
    const MOST: usize = 16;
    let is_bare = |light: &&Light| !matches!(light, Light::Area(_));
    let places: Vec<_> = lights.lights.iter().filter(is_bare).filter_map(Light::bounds).collect();
    if places.len() <= MOST { places } else { vec![places.iter().fold(Bounds::EMPTY, |all, b| all.union(*b))] }
}

/// Spheres that light can enter and in which nothing else is.
pub(super) fn hollows(scene: &Scene) -> Hollows {
    let lets_light_in = |object: &Object| {
        matches!(scene.materials[object.material.0 as usize], Material::Null | Material::Dielectric { .. })
    };
    // Where a scene has faults, shapes may be more than objects.
    scene.geometry.hollows(|id| scene.objects.get(id.0 as usize).is_some_and(lets_light_in))
}

/// By medium: all that it fills, if that is a room.
pub(super) fn of_media(scene: &Scene, objects: &[(ObjectId, &Object)]) -> Vec<Option<Room>> {
    let media = (0..scene.media.len()).map(|medium| MediumId(medium as u32));
    let bodies: Vec<_> = media.map(|medium| body(scene, medium, objects)).collect();
    let boxes = LazyCell::new(|| boxes(scene, objects));
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
