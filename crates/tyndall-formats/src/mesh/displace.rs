//! Displacement of a mesh along its normals, after it has been cut finely enough (pbrt-v4's `plymesh` with
//! `displacement`).
//!
//! Triangles are halved across their longest edge until every edge is shorter than a bound; neighbours share their
//! middles, so no crack opens. Then each vertex moves along its normal by the height there. The normals are those of the
//! file, or the means of the faces' unit normals; afterwards they are such means in any case.

use std::collections::HashMap;

use tyndall::math::{Vec2, Vec3};

use super::TriangleMesh;

/// The most vertices that a mesh may be cut into.
const MAX_VERTICES: usize = if cfg!(test) { 1 << 14 } else { 1 << 24 };

/// The mesh with edges below `longest` by the measure `length` [length], each vertex moved along its normal by
/// `height(position, uv)` [length].
///
/// # Errors
/// No texture coordinates, or more than 2²⁴ vertices.
pub fn displace(
    mut mesh: TriangleMesh,
    length: impl Fn(Vec3, Vec3) -> f64,
    longest: f64,
    height: impl Fn(Vec3, Vec2) -> f32,
) -> Result<TriangleMesh, String> {
    let Some(uvs) = mesh.uvs.take() else {
        return Err("has no texture coordinates, by which it could be displaced".into());
    };
    let normals = match mesh.normals.take() {
        Some(normals) => normals,
        None => mean_normals(&mesh.positions, &mesh.indices),
    };
    let mut fine = Fine { positions: mesh.positions, normals, uvs, middles: HashMap::new() };
    let mut indices = Vec::new();
    for triangle in mesh.indices {
        fine.cut(triangle, &length, longest, &mut indices)?;
    }
    let Fine { mut positions, normals, uvs, .. } = fine;
    for ((p, n), uv) in positions.iter_mut().zip(normals).zip(&uvs) {
        *p += n * height(*p, *uv);
    }
    let normals = Some(mean_normals(&positions, &indices));
    TriangleMesh { positions, indices, normals, uvs: Some(uvs), ..TriangleMesh::default() }.checked()
}

/// Vertices in the making.
struct Fine {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    /// By the ends of an edge, the lesser first.
    middles: HashMap<(u32, u32), u32>,
}

impl Fine {
    fn cut(
        &mut self,
        triangle: [u32; 3],
        length: &impl Fn(Vec3, Vec3) -> f64,
        longest: f64,
        out: &mut Vec<[u32; 3]>,
    ) -> Result<(), String> {
        let mut rest = vec![triangle];
        while let Some([a, b, c]) = rest.pop() {
            let at = |v: u32| self.positions[v as usize];
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| length(at(p), at(q)));
            if ![ab, bc, ca].iter().any(|edge| *edge >= longest) {
                out.push([a, b, c]);
                continue;
            }
            // From the longest edge on.
            let [a, b, c] = match (ab > bc, ab > ca, bc > ca) {
                (true, true, _) => [a, b, c],
                (false, _, true) => [b, c, a],
                _ => [c, a, b],
            };
            match self.middle(a, b)? {
                Some(middle) => rest.extend([[middle, b, c], [a, middle, c]]),
                None => out.push([a, b, c]),
            }
        }
        Ok(())
    }

    /// The vertex in the middle of an edge; `None` if single precision knows no number in between.
    fn middle(&mut self, a: u32, b: u32) -> Result<Option<u32>, String> {
        let edge = (a.min(b), a.max(b));
        if let Some(&middle) = self.middles.get(&edge) {
            return Ok(Some(middle));
        }
        if self.positions.len() >= MAX_VERTICES {
            return Err(format!("is cut into more than {MAX_VERTICES} vertices: \"edgelength\" is too small"));
        }
        let [i, j] = [edge.0 as usize, edge.1 as usize];
        let middle = self.positions[i].midpoint(self.positions[j]);
        if middle == self.positions[i] || middle == self.positions[j] || !middle.is_finite() {
            return Ok(None);
        }
        let vertex = self.positions.len() as u32;
        self.positions.push(middle);
        let normal = self.normals[i] + self.normals[j];
        self.normals.push(normal.try_normalize().unwrap_or(normal));
        self.uvs.push(self.uvs[i].midpoint(self.uvs[j]));
        self.middles.insert(edge, vertex);
        Ok(Some(vertex))
    }
}

/// At each vertex the mean of the unit normals of its faces, as a unit vector; zero where there is none.
fn mean_normals(positions: &[Vec3], indices: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in indices {
        let [a, b, c] = triangle.map(|v| positions[v as usize].as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        for &v in triangle {
            normals[v as usize] += normal;
        }
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles that make the unit square.
    fn square() -> TriangleMesh {
        TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            normals: None,
            uvs: Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]),
            ..TriangleMesh::default()
        }
    }

    /// Edges of √2, 1, 1 below 0.3: each halving across the hypotenuse divides lengths by √2, and the fifth leaves 1/4 of
    /// the hypotenuse √2: 2·2⁵ triangles. The height is 0.1 u: the surface is the plane z = 0.1 x.
    #[test]
    fn a_square_becomes_the_surface_of_its_heights() {
        let mesh = displace(square(), |a, b| f64::from(a.distance(b)), 0.3, |_, uv| 0.1 * uv.x).unwrap();
        assert_eq!(mesh.indices.len(), 64);
        let edges = |f: &[u32; 3]| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])];
        for (a, b) in mesh.indices.iter().flat_map(edges) {
            let [a, b] = [a, b].map(|v| mesh.positions[v as usize].truncate());
            assert!(a.distance(b) < 0.3, "{a} {b}");
        }
        let normal = Vec3::new(-0.1, 0.0, 1.0).normalize();
        for (p, n) in mesh.positions.iter().zip(mesh.normals.unwrap()) {
            assert!((p.z - 0.1 * p.x).abs() < 1e-6 && (n - normal).length() < 1e-5, "{p} {n}");
        }
    }

    /// No vertex lies on an edge that others have: every inner edge has two triangles, as many as a disk of them has:
    /// V − E + F = 1.
    #[test]
    fn no_crack_opens_between_neighbours() {
        let mut uneven = square();
        uneven.positions[2] = Vec3::new(3.0, 1.3, 0.0);
        let mesh = displace(uneven, |a, b| f64::from(a.distance(b)), 0.2, |p, _| p.x.sin()).unwrap();
        let edge = |a: u32, b: u32| (a.min(b), a.max(b));
        let edges: std::collections::HashSet<_> =
            mesh.indices.iter().flat_map(|f| [edge(f[0], f[1]), edge(f[1], f[2]), edge(f[2], f[0])]).collect();
        assert_eq!(mesh.positions.len() + mesh.indices.len(), edges.len() + 1);
    }

    /// With normals of the file, which here lean every way, a vertex goes along its own, and one in the middle of an edge along the
    /// unit normal between those of the ends: everywhere as far as the height.
    #[test]
    fn vertices_move_along_the_normals_of_the_file_by_the_height() {
        let lean = [[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [-0.6, 0.0, 0.8], [0.0, -0.6, 0.8]].map(Vec3::from_array);
        let moved = |height: f32| {
            let leaning = TriangleMesh { normals: Some(lean.to_vec()), ..square() };
            displace(leaning, |a, b| f64::from(a.distance(b)), 0.3, |_, _| height).unwrap()
        };
        let [from, to] = [0.0, 0.25].map(|height| moved(height).positions);
        for (p, q) in from.iter().zip(&to) {
            assert!((p.distance(*q) - 0.25).abs() < 1e-6, "{p} {q}");
        }
        for (v, normal) in lean.iter().enumerate() {
            assert!((to[v] - from[v] - normal * 0.25).length() < 1e-6, "{v}: {} {}", from[v], to[v]);
        }
    }

    /// Without normals a vertex has the mean of its faces' unit normals, however large these are: at the edge of a small face and
    /// a large one, at right angles, it moves along the bisector.
    #[test]
    fn faces_count_alike_for_the_direction_of_a_vertex() {
        let bent = TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y * 9.0, Vec3::Z * -0.1],
            indices: vec![[0, 1, 2], [0, 3, 1]],
            uvs: Some(vec![Vec2::ZERO; 4]),
            ..TriangleMesh::default()
        };
        let mesh = displace(bent, |_, _| 0.0, 1.0, |_, _| 0.5).unwrap();
        let bisector = Vec3::new(0.0, -1.0, 1.0).normalize();
        assert!((mesh.positions[0] - bisector * 0.5).length() < 1e-6, "{}", mesh.positions[0]);
    }

    #[test]
    fn what_cannot_be_cut_is_an_error() {
        let length = |a: Vec3, b: Vec3| f64::from(a.distance(b));
        assert!(displace(TriangleMesh { uvs: None, ..square() }, length, 0.3, |_, _| 0.0).is_err());
        assert!(displace(square(), length, 1e-9, |_, _| 0.0).is_err());
        assert!(displace(square(), length, 0.3, |_, _| f32::NAN).is_err());
    }
}
