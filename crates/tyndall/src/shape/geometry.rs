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
mod tests {
    use super::*;
    use crate::math::Transform;
    use crate::shape::{Basis, GeometryBuilder, Knot, Style};

    fn wave(i: u32) -> f32 {
        (i as f32 * 12.9898).sin() * 43.5453 % 1.0
    }

    fn wave_3(i: u32) -> Vec3 {
        Vec3::new(wave(i), wave(i + 1), wave(i + 2))
    }

    /// Strands of every kind, strewn over a cube of side 2 and bent to and fro.
    fn strands() -> Vec<Curves> {
        let kinds = [
            (Style::Round, Basis::CubicBSpline),
            (Style::Round, Basis::Linear),
            (Style::Round, Basis::CubicBezier),
            (Style::Flat, Basis::CatmullRom),
            (Style::Ribbon, Basis::CubicBSpline),
        ];
        let strand = |(kind, (style, basis)): (u32, (Style, Basis)), i: u32| {
            let seed = 1000 * kind + 50 * i;
            let knot =
                |k| Knot { p: wave_3(seed) + 0.3 * wave_3(seed + 3 * k), radius: 0.004 + 0.003 * wave(seed + k) };
            let mut curves = Curves::new(style);
            curves.push(basis, &(1..8).map(knot).collect::<Vec<_>>());
            if style == Style::Ribbon {
                curves.orient(&(0..=curves.len() as u32).map(|k| wave_3(seed + k)).collect::<Vec<_>>());
            }
            curves
        };
        (0..).zip(kinds).flat_map(|kind| (0..20).map(move |i| strand(kind, i))).collect()
    }

    fn ray(i: u32) -> Ray {
        Ray::new(wave_3(7 * i), wave_3(7 * i + 3).normalize())
    }

    /// Bundles leave out only pieces that the exact test of each piece would have refused: distances have the same bits, and
    /// where no two pieces are met at once it is the same piece. In space of any size, from near and far, with directions of any
    /// length, with and without an end; half of the rays graze a strand, 0.1 % of its radius below the surface.
    #[test]
    fn a_ray_finds_of_a_thousand_strands_what_it_finds_of_each_piece_alone() {
        let mut hits = [0; 3];
        for (case, scale) in [1e-6, 1.0, 1e6].into_iter().enumerate() {
            let place = Transform::new(glam::DMat4::from_scale(glam::DVec3::splat(scale))).unwrap();
            let mut builder = GeometryBuilder::new();
            for curves in strands() {
                builder.add_curves(curves, &place).unwrap();
            }
            let geometry = builder.build().unwrap();
            let pieces: Vec<_> = (0..)
                .zip(&*geometry.shapes)
                .filter_map(|(object, shape)| match shape {
                    Shape::Curves(curves) => Some(curves.pieces().map(move |(piece, _)| (object, curves, piece))),
                    _ => None,
                })
                .flatten()
                .collect();
            for i in 0..3000 {
                let Ray { mut origin, dir, .. } = ray(i);
                let (_, curves, piece) = &pieces[(37 * i) as usize % pieces.len()];
                if let Some([a, .., b]) = curves.beziers().nth(piece.segment as usize).filter(|_| i % 2 == 0) {
                    let middle = a.lerp(b, 0.5) / scale;
                    let side = (b - a).truncate().cross(dir.as_dvec3()).normalize();
                    origin = (middle.truncate() + side * (0.999 * middle.w)).as_vec3() - dir * 0.7;
                }
                let far = if i % 5 == 0 { 300.0 } else { 0.0 };
                let longer = (6.0 * wave(i)).exp();
                let ray = Ray::new((origin - dir * far) * scale as f32, dir * longer);
                let t_max =
                    if i % 3 == 0 { f32::INFINITY } else { (far + 1.5 * wave(i + 1).abs()) * scale as f32 / longer };
                let alone = pieces.iter().filter_map(|(object, curves, piece)| {
                    let (t, uv) = curves.intersect(piece, &Line::of(&ray), t_max)?;
                    Some(Hit { t, object: ObjectId(*object), prim: piece.segment, uv, instance: NONE })
                });
                let alone: Vec<_> = alone.collect();
                let nearest = alone.iter().map(|hit| hit.t).min_by(f32::total_cmp);
                let first: Vec<_> = alone.into_iter().filter(|hit| Some(hit.t) == nearest).collect();
                let found = geometry.intersect(&ray, t_max);
                assert!(found.is_none() == first.is_empty(), "{ray:?}: {found:?}, alone {first:?}");
                assert!(found.is_none_or(|found| first.contains(&found)), "{ray:?}: {found:?}, alone {first:?}");
                assert_eq!(geometry.occluded(&ray, t_max), !first.is_empty());
                hits[case] += usize::from(found.is_some());
            }
        }
        assert!(hits.iter().all(|&hits| hits > 300), "{hits:?}");
    }

    /// No fused operations and no approximate ones: SSE2, SSE4.2, AVX2 and AVX-512 agree bit by bit, whichever of
    /// them the machine has.
    #[test]
    fn every_instruction_set_gives_the_same_hits() {
        let mut mesh = Mesh::default();
        for i in 0..3000 {
            let at = Vec3::new(wave(9 * i / 3), wave(9 * (i / 3) + 1), wave(9 * (i / 3) + 2));
            mesh.positions.push(at + 0.2 * Vec3::new(wave(9 * i + 3), wave(9 * i + 4), wave(9 * i + 5)));
        }
        mesh.indices = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut builder = GeometryBuilder::new();
        builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
        for curves in strands() {
            builder.add_curves(curves, &Transform::IDENTITY).unwrap();
        }
        let best = builder.build().unwrap();
        let lesser = [
            Level::baseline(),
            Level::new().as_sse4_2().map_or(Level::baseline(), Simd::level),
            Level::new().as_avx2().map_or(Level::baseline(), Simd::level),
        ];
        let mut hits = 0;
        for level in lesser {
            let geometry = Geometry { level, ..best.clone() };
            for i in 0..10_000 {
                let (ray, origin) = (ray(i), ray(i).origin);
                let (a, b) = (best.intersect(&ray, 1.5), geometry.intersect(&ray, 1.5));
                assert_eq!(a, b);
                assert_eq!(best.clearance(origin, 1.0).to_bits(), geometry.clearance(origin, 1.0).to_bits());
                hits += u32::from(a.is_some());
            }
        }
        assert!(hits > 10_000, "{hits}");
    }
}
