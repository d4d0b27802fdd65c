//! Spheres with nothing else inside. A ray within one meets the sphere next: no tree need be asked. Half of all rays among clear
//! grains are such rays.

use rayon::prelude::*;

use super::{
    Geometry, Hit, Interaction, ObjectId,
    bvh::{NONE, Primitive},
    sphere,
};
use crate::math::{Ray, Vec2, Vec3};

/// How far outside of a sphere, in its radii, other things still count as inside: a hundred times what rounding can do to a distance
/// \[1\].
const BESIDE: f32 = 1e-5;

/// A sphere in the world with nothing else inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hollow {
    centre: Vec3,
    radius: f32,
    object: u32,
    instance: u32,
}

/// The hollow spheres of a geometry.
#[derive(Debug, Default)]
pub struct Hollows {
    /// By object; empty if there are none.
    alone: Vec<Option<Hollow>>,
    /// By instance; empty if there are none.
    placed: Vec<Option<Hollow>>,
}

impl Geometry {
    /// The hollow ones among the spheres that objects of some kind are.
    pub fn hollows(&self, is_wanted: impl Fn(ObjectId) -> bool + Sync) -> Hollows {
        let hollow = |primitive: &Primitive| match *primitive {
            Primitive::Sphere { centre, radius, object, instance } if is_wanted(ObjectId(object)) => {
                let is_free = self.is_alone(centre, radius * (1.0 + BESIDE), (object, instance));
                is_free.then_some(Hollow { centre, radius, object, instance })
            }
            _ => None,
        };
        let found: Vec<_> = self.world.others.par_iter().filter_map(hollow).collect();
        let mut hollows = Hollows::default();
        for hollow in found {
            let (table, len, index) = match hollow.instance {
                NONE => (&mut hollows.alone, self.shapes.len(), hollow.object),
                instance => (&mut hollows.placed, self.instances.len(), instance),
            };
            table.resize(len, None);
            table[index as usize] = Some(hollow);
        }
        hollows
    }
}

impl Hollows {
    /// The hollow sphere into which a ray along `dir` leaves its surface.
    #[inline]
    pub fn entered(&self, hit: &Interaction, dir: Vec3) -> Option<Hollow> {
        let (table, index) = match hit.instance {
            NONE => (&self.alone, hit.object.0),
            instance => (&self.placed, instance),
        };
        let hollow = (*table.get(index as usize)?)?;
        // Two spheres may stand in one instance.
        (hollow.object == hit.object.0 && dir.dot(hit.p - hollow.centre) < 0.0).then_some(hollow)
    }
}

impl Hollow {
    /// Where a ray from within meets the sphere.
    #[inline]
    pub fn exit(&self, ray: &Ray) -> Option<Hit> {
        let t = sphere::nearest(self.centre, self.radius, ray, f32::INFINITY)?;
        let Self { object, instance, .. } = *self;
        Some(Hit { t, object: ObjectId(object), prim: 0, uv: Vec2::ZERO, instance })
    }
}
