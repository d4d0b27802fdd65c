//! All shapes of a scene, and the questions that transport asks of them.

use std::sync::Arc;

use fearless_simd::{Level, Simd, dispatch};

use super::{
    Curves, Cylinder, Disk, Interaction, Mesh, Patch, Sphere,
    bvh::{
        NONE, Primitive, Tree,
        traverse::{Met, Nearest, traverse},
    },
    curve::{Line, Piece},
    instance::Instance,
    interaction::Point,
    passage::{Passed, Placed, View},
    sphere,
};
use crate::math::{Bounds, Ray, Vec2, Vec3};

/// Index into the scene's objects: one shape directive, which may be many triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance [length if the ray's direction is unit].
    pub t: f32,
    /// The object.
    pub object: ObjectId,
    /// The part of the object: index of the triangle or of the segment, or 0.
    pub prim: u32,
    /// For triangles the weights of the second and third vertex, for patches `(u, v)`, for curves how far along the segment,
    /// else 0.
    pub uv: Vec2,
    /// The instance, or [`Hit::NO_INSTANCE`].
    pub instance: u32,
}

impl Hit {
    /// The object stands in the world itself.
    pub const NO_INSTANCE: u32 = NONE;
}

/// The kinds of shapes.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Triangles.
    Mesh(Mesh),
    /// A sphere or an ellipsoid.
    Sphere(Sphere),
    /// A disk or a ring.
    Disk(Disk),
    /// A cylinder without lids.
    Cylinder(Cylinder),
    /// A bilinear patch that is not flat.
    Patch(Patch),
    /// Strands.
    Curves(Curves),
}

impl Shape {
    pub(super) fn bounds(&self) -> Bounds {
        match self {
            Self::Mesh(mesh) => Bounds::of(mesh.positions.iter().copied()),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Disk(disk) => disk.bounds(),
            Self::Cylinder(cylinder) => cylinder.bounds(),
            Self::Patch(patch) => patch.bounds(),
            Self::Curves(curves) => curves.bounds(),
        }
    }

    /// The nearest hit before `t_max` on a shape that is in the tree as one.
    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<(f32, Vec2)> {
        match self {
            Self::Mesh(_) | Self::Curves(_) => None,
            Self::Sphere(sphere) => sphere.intersect(ray, t_max).map(|t| (t, Vec2::ZERO)),
            Self::Disk(disk) => disk.intersect(ray, t_max).map(|t| (t, Vec2::ZERO)),
            Self::Cylinder(cylinder) => cylinder.intersect(ray, t_max).map(|t| (t, Vec2::ZERO)),
            Self::Patch(patch) => patch.intersect(ray, t_max).map(|hit| (hit.t, hit.uv)),
        }
    }

    /// The surface parameters where a ray meets a shape that is not a mesh; (0, 0) where it does not.
    pub(crate) fn parameters(&self, ray: &Ray) -> Vec2 {
        self.intersect(ray, f32::INFINITY).map_or(Vec2::ZERO, |(t, uv)| self.point(ray, t, 0, uv).uv.get())
    }

    fn point(&self, ray: &Ray, t: f32, prim: u32, uv: Vec2) -> Point {
        match self {
            Self::Mesh(mesh) => mesh.point(prim, uv),
            Self::Sphere(sphere) => sphere.point(ray, t),
            Self::Disk(disk) => disk.point(ray, t),
            Self::Cylinder(cylinder) => cylinder.point(ray, t),
            Self::Patch(patch) => patch.point(uv),
            Self::Curves(curves) => curves.point(ray, prim, uv),
        }
    }
}

/// The shapes of a scene and the trees over them. Made by [`super::GeometryBuilder`], then never changed.
#[derive(Debug, Clone)]
pub struct Geometry {
    /// The instruction set, asked for once.
    pub(super) level: Level,
    pub(super) shapes: Arc<[Shape]>,
    /// By object: the group through whose instances alone it is seen.
    pub(super) group: Arc<[Option<u32>]>,
    pub(super) world: Tree,
    pub(super) groups: Arc<[Tree]>,
    pub(super) instances: Arc<[Instance]>,
}

impl Geometry {
    pub(super) fn new(
        shapes: Vec<Shape>,
        group: Vec<Option<u32>>,
        world: Tree,
        groups: Vec<Tree>,
        instances: Vec<Instance>,
    ) -> Self {
        let (shapes, group, groups) = (shapes.into(), group.into(), groups.into());
        Self { level: Level::new(), shapes, group, world, groups, instances: instances.into() }
    }

    /// The same shapes, groups and instances, others of which are placed.
    pub(super) fn with_world(&self, world: Tree) -> Self {
        Self {
            level: self.level,
            shapes: Arc::clone(&self.shapes),
            group: Arc::clone(&self.group),
            world,
            groups: Arc::clone(&self.groups),
            instances: Arc::clone(&self.instances),
        }
    }

    /// The nearest surface with `0 < t < t_max`.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        let mut nearest = Nearest::before(t_max);
        dispatch!(self.level, simd => self.search::<_, _, false>(simd, ray, &mut nearest));
        nearest.found().then(|| nearest.hit())
    }

    /// Whether there is any surface with `0 < t < t_max`.
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_max: f32) -> bool {
        let mut nearest = Nearest::before(t_max);
        dispatch!(self.level, simd => self.search::<_, _, true>(simd, ray, &mut nearest));
        nearest.found()
    }

    /// What there is on a segment whose `open` objects (by [`ObjectId`], all of them meshes) let light pass: whether another
    /// blocks it. If none does, `passed` holds the hits on those that are open.
    #[inline]
    pub fn occluded_but(&self, ray: &Ray, t_max: f32, open: &[bool], passed: &mut Passed) -> bool {
        let mut view = View { nearest: Nearest::before(t_max), open, passed };
        dispatch!(self.level, simd => self.search::<_, _, true>(simd, ray, &mut view));
        view.nearest.found()
    }

    /// The nearest surface with `0 < t < t_max` that is not `open`; `passed` holds those hits before `t_max` on open ones that the
    /// search has come by, all those before the surface among them.
    #[inline]
    pub fn intersect_but(&self, ray: &Ray, t_max: f32, open: &[bool], passed: &mut Passed) -> Option<Hit> {
        let mut view = View { nearest: Nearest::before(t_max), open, passed };
        dispatch!(self.level, simd => self.search::<_, _, false>(simd, ray, &mut view));
        let nearest = view.nearest;
        nearest.found().then(|| nearest.hit())
    }

    #[inline(always)]
    fn search<S: Simd, M: Met, const ANY: bool>(&self, simd: S, ray: &Ray, met: &mut M) {
        let mut line = None;
        traverse::<S, M, ANY>(simd, &self.world, ray, met, |primitive, met| {
            if let Primitive::Instance(index) = *primitive {
                self.search_instance::<S, M, ANY>(simd, index, ray, met);
            } else {
                self.test(primitive, ray, &mut line, met);
            }
        });
    }

    /// Not inlined: one traversal inside another is too much for the registers.
    #[inline(never)]
    fn search_instance<S: Simd, M: Met, const ANY: bool>(&self, simd: S, index: u32, ray: &Ray, met: &mut M) {
        let Instance { group, placement } = &self.instances[index as usize];
        let local = placement.ray_to_local(ray);
        let mut inside = Placed { met, instance: index };
        simd.vectorize(
            #[inline(always)]
            || {
                let tree = &self.groups[*group as usize];
                let mut line = None;
                traverse::<S, _, ANY>(simd, tree, &local, &mut inside, |primitive, met| {
                    self.test(primitive, &local, &mut line, met);
                });
            },
        );
    }

    /// `line` is that of the ray, once something asks for it.
    #[inline(always)]
    fn test(&self, primitive: &Primitive, ray: &Ray, line: &mut Option<Line>, met: &mut impl Met) {
        match *primitive {
            Primitive::Sphere { centre, radius, object, instance } => {
                if let Some(t) = sphere::nearest(centre, radius, ray, met.limit()) {
                    met.take(Nearest { t, object, prim: 0, instance, uv: Vec2::ZERO });
                }
            }
            Primitive::Shape { object, instance } => {
                if let Some((t, uv)) = self.test_shape(object, instance, ray, met.limit()) {
                    met.take(Nearest { t, object, prim: 0, instance, uv });
                }
            }
            Primitive::Curve { object, ref piece } => {
                if let Some((t, uv)) =
                    self.test_curve(object, piece, line.get_or_insert_with(|| Line::of(ray)), met.limit())
                {
                    met.take(Nearest { t, object, prim: piece.segment, instance: NONE, uv });
                }
            }
            Primitive::Instance(_) => {} // groups hold no instances
        }
    }

    #[inline(never)]
    fn test_shape(&self, object: u32, instance: u32, ray: &Ray, t_max: f32) -> Option<(f32, Vec2)> {
        let ray = if instance == NONE { *ray } else { self.instances[instance as usize].placement.ray_to_local(ray) };
        self.shapes[object as usize].intersect(&ray, t_max)
    }

    #[inline(never)]
    fn test_curve(&self, object: u32, piece: &Piece, line: &Line, t_max: f32) -> Option<(f32, Vec2)> {
        let Shape::Curves(curves) = &self.shapes[object as usize] else { return None };
        curves.intersect(piece, line, t_max)
    }

    /// The surface at a hit of this ray.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> Interaction {
        let shape = &self.shapes[hit.object.0 as usize];
        let point = if hit.instance == NONE {
            shape.point(ray, hit.t, hit.prim, hit.uv)
        } else {
            let placement = &self.instances[hit.instance as usize].placement;
            let local = placement.ray_to_local(ray);
            placement.place(&shape.point(&local, hit.t, hit.prim, hit.uv))
        };
        point.round(hit.object, hit.prim, hit.instance)
    }

    /// A box around everything.
    pub fn bounds(&self) -> Bounds {
        self.world.bounds
    }

    /// Whether an object is part of a group, and is seen through instances only.
    pub fn is_in_group(&self, object: ObjectId) -> bool {
        self.group[object.0 as usize].is_some()
    }

    /// A box around one object, in world space unless it is part of a group.
    pub fn object_bounds(&self, object: ObjectId) -> Bounds {
        self.shape(object).bounds()
    }

    /// Boxes around one object in the world, one for each place where it stands.
    pub fn placed_bounds(&self, object: ObjectId) -> impl Iterator<Item = Bounds> {
        let (bounds, group) = (self.object_bounds(object), self.group[object.0 as usize]);
        let in_world = group.is_none().then_some(bounds);
        let instances = self.instances.iter().filter(move |instance| Some(instance.group) == group);
        in_world.into_iter().chain(instances.map(move |instance| instance.placement.bounds(&bounds)))
    }

    /// Boxes around all instances that there are in the world.
    pub fn placed_instances(&self) -> impl Iterator<Item = Bounds> {
        self.world.others.iter().filter_map(|primitive| match *primitive {
            Primitive::Instance(index) => {
                let Instance { group, placement } = &self.instances[index as usize];
                Some(placement.bounds(&self.groups[*group as usize].bounds))
            }
            Primitive::Sphere { centre, radius, instance, .. } if instance != NONE => {
                Some(Sphere::new(centre, radius).bounds())
            }
            Primitive::Shape { object, instance } if instance != NONE => {
                let placement = &self.instances[instance as usize].placement;
                Some(placement.bounds(&self.object_bounds(ObjectId(object))))
            }
            _ => None,
        })
    }

    /// A shape, in world space unless it is part of a group.
    pub fn shape(&self, object: ObjectId) -> &Shape {
        &self.shapes[object.0 as usize]
    }

    /// The vertices of a triangle [length], or `None` if the object is not a mesh or has no such triangle.
    pub fn triangle(&self, object: ObjectId, prim: u32) -> Option<[Vec3; 3]> {
        match self.shape(object) {
            Shape::Mesh(mesh) if (prim as usize) < mesh.indices.len() => Some(mesh.triangle(prim)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
