//! Triangle meshes.

use glam::DVec3;

use super::{ShapeError, interaction::Point};
use crate::math::{Transform, Vec2, Vec3};

/// Triangles over shared vertices.
///
/// Seen from outside, the vertices of a triangle run anticlockwise (or clockwise if `reversed`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertices [length].
    pub positions: Vec<Vec3>,
    /// Three vertices a triangle.
    pub indices: Vec<[u32; 3]>,
    /// One normal a vertex, or none at all: then the mesh is faceted.
    pub normals: Vec<Vec3>,
    /// One pair a vertex, or none at all: then every triangle has (0,0), (1,0), (1,1).
    pub uvs: Vec<Vec2>,
    /// Whether the geometric normals are turned round. The builder sets it anew.
    pub reversed: bool,
}

impl Mesh {
    /// The vertices of a triangle [length].
    #[inline]
    pub fn triangle(&self, prim: u32) -> [Vec3; 3] {
        let [a, b, c] = self.indices[prim as usize];
        [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
    }

    /// The parameters of the corners of a triangle.
    #[inline]
    pub fn corner_uvs(&self, prim: u32) -> [Vec2; 3] {
        if self.uvs.is_empty() {
            return [Vec2::ZERO, Vec2::X, Vec2::ONE];
        }
        self.indices[prim as usize].map(|i| self.uvs[i as usize])
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        let vertices = self.positions.len();
        if let Some(triangle) = self.indices.iter().position(|t| t.iter().any(|&i| i as usize >= vertices)) {
            return Err(ShapeError::IndexOutOfRange { triangle, vertices });
        }
        for (what, count) in [("normals", self.normals.len()), ("uvs", self.uvs.len())] {
            if count != 0 && count != vertices {
                return Err(ShapeError::AttributeCount { what, count, vertices });
            }
        }
        if !self.positions.iter().all(|p| p.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        Ok(())
    }

    /// The mesh in world space. A mirroring turns the winding round, and `reversed` turns it once more.
    pub(super) fn placed(mut self, transform: &Transform, reversed: bool) -> Self {
        if *transform != Transform::IDENTITY {
            let to_world = transform.matrix.as_dmat4();
            for p in &mut self.positions {
                *p = to_world.transform_point3(p.as_dvec3()).as_vec3();
            }
            for n in &mut self.normals {
                *n = transform.normal(*n);
            }
        }
        self.reversed = reversed != transform.mirrors();
        self
    }

    /// The point with weights `(1 − b₁ − b₂, b₁, b₂)`.
    pub(super) fn point(&self, prim: u32, weights: Vec2) -> Point {
        let corners = self.indices[prim as usize].map(|i| i as usize);
        let [p0, p1, p2] = corners.map(|i| self.positions[i].as_dvec3());
        let (e1, e2) = (p1 - p0, p2 - p0);
        let (b1, b2) = (f64::from(weights.x), f64::from(weights.y));
        let ng = if self.reversed { e2.cross(e1) } else { e1.cross(e2) };
        let ns = if self.normals.is_empty() {
            ng
        } else {
            let [n0, n1, n2] = corners.map(|i| self.normals[i].as_dvec3());
            n0 * (1.0 - b1 - b2) + n1 * b1 + n2 * b2
        };
        let [uv0, uv1, uv2] = self.corner_uvs(prim);
        // Double precision leaves 2⁻⁵² of the longest edge, times the aspect of the triangle when the distance to its
        // plane is asked for: this is good up to an aspect of 2¹⁸.
        let longest = e1.abs().max_element().max(e2.abs().max_element());
        Point {
            p: p0 + e1 * b1 + e2 * b2,
            error: longest * (-32f64).exp2(),
            ng,
            ns,
            uv: (uv0 * (1.0 - weights.x - weights.y) + uv1 * weights.x + uv2 * weights.y).into(),
            dpdu: derivative_by_u([e1, e2], uv1 - uv0, uv2 - uv0).unwrap_or_else(|| ng.any_orthogonal_vector()),
        }
    }
}

/// Solves `e = dp/du·Δu + dp/dv·Δv` for `dp/du`.
fn derivative_by_u([e1, e2]: [DVec3; 2], d1: Vec2, d2: Vec2) -> Option<DVec3> {
    let (d1, d2) = (d1.as_dvec2(), d2.as_dvec2());
    let det = d1.x * d2.y - d1.y * d2.x;
    let dpdu = (e1 * d2.y - e2 * d1.y) / det;
    (det != 0.0 && dpdu.is_finite()).then_some(dpdu)
}
