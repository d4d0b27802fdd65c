//! A body within a closed triangle mesh: what is filled, or a grain of any shape.
//!
//! Its triangles are counter-clockwise seen from outside; each edge belongs to two of them, once in either direction. Vertices
//! at one place count as one. The body keeps its mesh centred and of size 1 (the largest half edge of its box), in single
//! precision where the geometry library asks for it: distances are good to 10⁻⁶ of the size.

use std::collections::HashMap;

use glam::DVec3;
use rapier3d::parry::{
    bounding_volume::Aabb,
    math::Vector,
    partitioning::{Bvh, BvhBuildStrategy},
    query::{PointQuery, Ray},
    shape::{TriMesh, TriMeshFlags},
};

use crate::{GrainError, form::single};

/// A closed mesh.
#[derive(Debug, Clone)]
pub struct Solid {
    /// The middle of the box around it, where its file has it \[length\].
    pub centre: DVec3,
    /// Half the edges of that box \[length\].
    pub half: DVec3,
    /// The largest of them: what one unit of the mesh inside is \[length\].
    pub(crate) unit: f64,
    pub(crate) points: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// For rays: boxes a little larger than the triangles.
    tree: Bvh,
    /// For distances.
    mesh: TriMesh,
}

impl Solid {
    /// The body of a mesh.
    ///
    /// # Errors
    /// It is open, inside out, empty, or holds what is no number.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, GrainError> {
        let wrong = |what: &str| Err(GrainError::Mesh(what.to_owned()));
        if !points.iter().all(|point| point.is_finite()) {
            return wrong("has a vertex that is no number");
        }
        if triangles.iter().flatten().any(|&index| index as usize >= points.len()) {
            return wrong("has a triangle without its vertex");
        }
        let (points, triangles) = weld(points, triangles);
        if !closed(&triangles) {
            return wrong("is not closed: each edge must belong to two triangles, once in either direction");
        }
        let (low, high) = points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| (low.min(point), high.max(point)));
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let unit = half.max_element();
        if !crate::LENGTHS.contains(&unit) || !centre.is_finite() {
            return wrong("has no size");
        }
        let points: Vec<DVec3> = points.iter().map(|&point| (point - centre) / unit).collect();
        if volume(&points, &triangles) <= 1e-6 {
            return wrong("has no volume, or its normals point inwards");
        }
        let rounded: Vec<Vector> = points.iter().copied().map(single).collect();
        let boxes = triangles.iter().map(|t| Aabb::from_points(t.map(|i| rounded[i as usize])));
        let boxes = boxes.map(|b| Aabb::new(b.mins - Vector::splat(1e-5), b.maxs + Vector::splat(1e-5)));
        let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
        let mesh = TriMesh::with_flags(rounded, triangles.clone(), TriMeshFlags::ORIENTED)
            .map_err(|error| GrainError::Mesh(format!("bounds no body: {error}")))?;
        Ok(Self { centre, half, unit, points, triangles, tree, mesh })
    }

    /// Volume \[length³\].
    pub fn volume(&self) -> f64 {
        volume(&self.points, &self.triangles) * self.unit.powi(3)
    }

    /// Surface \[length²\].
    pub fn surface(&self) -> f64 {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.points[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangles.iter().map(area).sum::<f64>() * self.unit * self.unit
    }

    /// Whether a ball lies wholly inside; lengths from the centre.
    pub(crate) fn holds(&self, centre: DVec3, ball: f64) -> bool {
        let place = single(centre / self.unit);
        let (nearest, _) = self.mesh.project_local_point_and_get_feature(place);
        nearest.is_inside && f64::from(nearest.point.distance(place)) * self.unit >= ball
    }

    /// Where the line `origin + t direction` passes the surface, in order; lengths from the centre. An odd number of passages,
    /// by rounding at an edge, is none.
    pub(crate) fn passages(&self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let o = origin / self.unit;
        // From the point nearest to the centre, where single precision is best.
        let near = o - o.dot(direction) * direction;
        let ray = Ray::new(single(near - 4.0 * direction), single(direction));
        let met = self.tree.leaves(|node| node.cast_ray(&ray, f32::MAX) < f32::MAX);
        let mut passages: Vec<f64> = met
            .filter_map(|leaf| passage(o, direction, self.triangles[leaf as usize].map(|i| self.points[i as usize])))
            .map(|t| t * self.unit)
            .collect();
        if passages.len() % 2 == 1 {
            passages.clear();
        }
        passages.sort_by(f64::total_cmp);
        passages
    }
}

/// Vertices at one place become one; triangles that lose an edge by that vanish.
fn weld(points: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut known, mut kept) = (HashMap::new(), Vec::new());
    let ids: Vec<u32> = points
        .iter()
        .map(|&point| {
            // Zero is written in one way.
            *known.entry((point + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
                kept.push(point);
                kept.len() as u32 - 1
            })
        })
        .collect();
    let triangles = triangles.iter().map(|t| t.map(|i| ids[i as usize]));
    (kept, triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect())
}

fn closed(triangles: &[[u32; 3]]) -> bool {
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((*from, *to)).or_default() += 1;
        }
    }
    !edges.is_empty() && edges.iter().all(|(&(a, b), &count)| count == 1 && edges.contains_key(&(b, a)))
}

/// By the divergence theorem: tetrahedra from the origin.
fn volume(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let tetrahedron = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| points[i as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(tetrahedron).sum()
}

/// Möller and Trumbore 1997.
fn passage(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac, ao) = (b - a, c - a, origin - a);
    let (p, q) = (direction.cross(ac), ao.cross(ab));
    let determinant = ab.dot(p);
    let (u, v) = (ao.dot(p) / determinant, direction.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) / determinant)
}
