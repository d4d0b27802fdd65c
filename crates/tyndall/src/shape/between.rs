//! What lies on a short way, all of it: faces that coincide are each told.

use super::{
    Geometry, Hit, Interaction, ObjectId, Shape,
    bvh::{NONE, Primitive, between::between},
    curve::Line,
    sphere,
};
use crate::math::{Ray, Vec2, Vec3};

impl Geometry {
    /// Calls `visit` for every surface between two points, in no order. Where the way runs through an edge, every
    /// triangle at it is told, and a triangle may be told more than once.
    pub fn between(&self, a: Vec3, b: Vec3, visit: &mut impl FnMut(Interaction)) {
        let length = (b - a).length();
        if length.is_nan() || length <= 0.0 {
            return;
        }
        let ray = Ray::new(a, (b - a) / length);
        let mut hits = Vec::new();
        let found = |object, prim, uv, t, instance| Hit { t, object: ObjectId(object), prim, uv, instance };
        let mut placed = Vec::new();
        let mut triangles = Vec::new();
        between(&self.world, &ray, length, &mut |hit| triangles.push((hit, NONE)), &mut |primitive| match *primitive {
            Primitive::Instance(index) => placed.push(index),
            ref primitive => hits.extend(self.hit_between(primitive, NONE, &ray, length)),
        });
        for index in placed {
            let instance = &self.instances[index as usize];
            let local = instance.placement.ray_to_local(&ray);
            let group = &self.groups[instance.group as usize];
            between(group, &local, length, &mut |hit| triangles.push((hit, index)), &mut |primitive| {
                hits.extend(self.hit_between(primitive, index, &local, length));
            });
        }
        hits.extend(triangles.into_iter().map(|((t, object, prim, uv), copy)| found(object, prim, uv, t, copy)));
        for hit in &hits {
            visit(self.interaction(&ray, hit));
        }
    }

    /// A primitive that is no triangle and no group, in the space of the tree that holds it.
    fn hit_between(&self, primitive: &Primitive, copy: u32, ray: &Ray, length: f32) -> Option<Hit> {
        let of = |object: u32, instance: u32, t, uv| {
            let instance = if copy == NONE { instance } else { copy };
            Hit { t, object: ObjectId(object), prim: 0, uv, instance }
        };
        match *primitive {
            Primitive::Sphere { centre, radius, object, instance } => {
                sphere::nearest(centre, radius, ray, length).map(|t| of(object, instance, t, Vec2::ZERO))
            }
            Primitive::Shape { object, instance } => {
                let ray = match instance {
                    NONE => *ray,
                    index => self.instances[index as usize].placement.ray_to_local(ray),
                };
                self.shapes[object as usize].intersect(&ray, length).map(|(t, uv)| of(object, instance, t, uv))
            }
            Primitive::Curve { object, ref piece } => {
                let Shape::Curves(curves) = &self.shapes[object as usize] else { return None };
                let hit = |(t, uv)| Hit { prim: piece.segment, ..of(object, NONE, t, uv) };
                curves.intersect(piece, &Line::of(ray), length).map(hit)
            }
            Primitive::Instance(_) => None, // groups hold no instances
        }
    }
}
