//! Loop subdivision: smooth surfaces from coarse triangles (Loop 1987, "Smooth subdivision surfaces based on triangles").
//!
//! Each level makes four triangles of one. With `n` neighbours, of mean `p̄`, an old vertex `v` moves, and each edge gets
//! a new one:
//!
//! | | inside | on an open edge |
//! |---|---|---|
//! | old | `(1 − nβ) v + nβ p̄`, β = 3/(8n), or 3/16 if n = 3 | `3/4 v` and 1/8 of the next vertex on either side |
//! | new | 3/8 of the ends of the edge and 1/8 of the corners across | the middle of the edge |
//!
//! At last vertices are moved to the limit of all levels, by the same rules with γ = 1/(n + 3/(8β)) in place of β, and 1/5
//! for 1/8. Normals are the cross products of the tangents there (Pharr, Jakob and Humphreys 2017, § 3.8.2, of which
//! this follows pbrt-v4 in taking the tangents from the vertices of the limit): against the winding, as in pbrt.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::DVec3;
use tyndall::math::Vec3;

use super::TriangleMesh;

/// No face.
const NONE: u32 = u32::MAX;
/// The most triangles that subdivision may make.
const MAX_TRIANGLES: usize = 1 << 24;

/// The limit surface of a mesh after so many levels; or what is wrong with it.
///
/// # Errors
/// A face that names a corner twice, or more than 2²⁴ triangles.
pub fn subdivide(positions: &[Vec3], faces: &[[u32; 3]], levels: u32) -> Result<TriangleMesh, String> {
    if let Some(face) = faces.iter().position(|[a, b, c]| a == b || b == c || c == a) {
        return Err(format!("face {face} names one of its corners twice"));
    }
    if faces
        .len()
        .checked_shl(2 * levels.min(31))
        .is_none_or(|n| n >> (2 * levels.min(31)) != faces.len() || n > MAX_TRIANGLES)
    {
        return Err(format!("{levels} levels make more than {MAX_TRIANGLES} triangles of {}", faces.len()));
    }
    let mut level = Level::new(positions, faces);
    for _ in 0..levels {
        level = level.refined();
    }
    level.positions = level.limit();
    Ok(TriangleMesh {
        normals: Some(level.normals()),
        positions: level.positions.iter().map(|p| p.as_vec3()).collect(),
        indices: level.faces,
        ..TriangleMesh::default()
    })
}

/// A mesh that knows its neighbours.
struct Level {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// By face and edge (from corner k to k + 1): the face on the other side.
    across: Vec<[u32; 3]>,
    /// By vertex: a face that has it.
    start: Vec<u32>,
    /// By vertex: whether it is on an open edge.
    open: Vec<bool>,
}

const fn next(k: usize) -> usize {
    (k + 1) % 3
}

const fn last(k: usize) -> usize {
    (k + 2) % 3
}

impl Level {
    /// The vertices that faces use, with the neighbours of the faces. An edge of more than two faces joins the first two
    /// that run along it in opposite ways.
    fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let mut place = vec![NONE; positions.len()];
        let mut used = Vec::new();
        let faces: Vec<[u32; 3]> = faces
            .iter()
            .map(|face| {
                face.map(|v| {
                    if place[v as usize] == NONE {
                        place[v as usize] = used.len() as u32;
                        used.push(positions[v as usize].as_dvec3());
                    }
                    place[v as usize]
                })
            })
            .collect();
        let mut edges = HashMap::new();
        let mut start = vec![NONE; used.len()];
        for (i, face) in faces.iter().enumerate() {
            for k in 0..3 {
                edges.entry((face[k], face[next(k)])).or_insert(i as u32);
                start[face[k] as usize] = i as u32;
            }
        }
        let neighbour = |i: usize, k: usize| {
            let (from, to) = (faces[i][k], faces[i][next(k)]);
            let is_first = edges.get(&(from, to)) == Some(&(i as u32));
            edges.get(&(to, from)).copied().filter(|_| is_first).unwrap_or(NONE)
        };
        let across = (0..faces.len()).map(|i| [0, 1, 2].map(|k| neighbour(i, k))).collect();
        let mut level = Self { open: vec![false; used.len()], positions: used, faces, across, start };
        level.open = (0..level.start.len() as u32).map(|v| level.is_open(v)).collect();
        level
    }

    /// Which corner of a face a vertex is.
    fn corner(&self, face: u32, vertex: u32) -> usize {
        self.faces[face as usize].iter().position(|&v| v == vertex).unwrap_or(0)
    }

    /// The face beyond the edge that leaves a vertex, turning clockwise about it.
    fn clockwise(&self, face: u32, vertex: u32) -> u32 {
        self.across[face as usize][self.corner(face, vertex)]
    }

    /// The face beyond the edge that comes to a vertex, turning anticlockwise.
    fn anticlockwise(&self, face: u32, vertex: u32) -> u32 {
        self.across[face as usize][last(self.corner(face, vertex))]
    }

    fn is_open(&self, vertex: u32) -> bool {
        let start = self.start[vertex as usize];
        let mut face = start;
        loop {
            face = self.clockwise(face, vertex);
            if face == NONE || face == start {
                return face == NONE;
            }
        }
    }

    /// The vertices around one: clockwise inside; on an open edge anticlockwise, from edge to edge.
    fn ring(&self, vertex: u32, ring: &mut Vec<DVec3>) {
        ring.clear();
        let at = |face: u32, k: usize| self.positions[self.faces[face as usize][k] as usize];
        let start = self.start[vertex as usize];
        let mut face = start;
        if !self.open[vertex as usize] {
            loop {
                ring.push(at(face, next(self.corner(face, vertex))));
                face = self.clockwise(face, vertex);
                if face == start {
                    return;
                }
            }
        }
        while self.clockwise(face, vertex) != NONE {
            face = self.clockwise(face, vertex);
        }
        ring.push(at(face, next(self.corner(face, vertex))));
        while face != NONE {
            ring.push(at(face, last(self.corner(face, vertex))));
            face = self.anticlockwise(face, vertex);
        }
    }

    /// Every vertex between itself and its neighbours: `inside(n)` of each of them, or `open` of the next on the edge.
    fn smoothed(&self, inside: impl Fn(f64) -> f64, open: f64) -> Vec<DVec3> {
        let mut ring = Vec::new();
        let smooth = |(v, &p): (usize, &DVec3)| {
            self.ring(v as u32, &mut ring);
            if self.open[v] {
                return p * (1.0 - 2.0 * open) + (ring[0] + ring[ring.len() - 1]) * open;
            }
            let (n, weight) = (ring.len() as f64, inside(ring.len() as f64));
            p * (1.0 - n * weight) + ring.iter().sum::<DVec3>() * weight
        };
        self.positions.iter().enumerate().map(smooth).collect()
    }

    fn limit(&self) -> Vec<DVec3> {
        self.smoothed(|n| 1.0 / (n + 3.0 / (8.0 * beta(n))), 0.2)
    }

    /// The next level. Of face `i`, child `4i + k` has corner `k` as its first corner, `4i + 3` is the middle one.
    fn refined(&self) -> Self {
        let mut positions = self.smoothed(beta, 0.125);
        let mut start: Vec<u32> = (0..positions.len() as u32)
            .map(|v| 4 * self.start[v as usize] + self.corner(self.start[v as usize], v) as u32)
            .collect();
        let mut open = self.open.clone();
        let mut middles = vec![[NONE; 3]; self.faces.len()];
        for (i, face) in self.faces.iter().enumerate() {
            for k in 0..3 {
                if middles[i][k] != NONE {
                    continue;
                }
                let beyond = self.across[i][k];
                let vertex = positions.len() as u32;
                let at = |v: u32| self.positions[v as usize];
                let (a, b) = (at(face[k]), at(face[next(k)]));
                middles[i][k] = vertex;
                positions.push(if beyond == NONE {
                    (a + b) * 0.5
                } else {
                    let edge = self.corner(beyond, face[next(k)]);
                    middles[beyond as usize][edge] = vertex;
                    (a + b) * 0.375 + (at(face[last(k)]) + at(self.faces[beyond as usize][last(edge)])) * 0.125
                });
                start.push(4 * i as u32 + 3);
                open.push(beyond == NONE);
            }
        }
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        let mut across = Vec::with_capacity(4 * self.faces.len());
        for (i, face) in self.faces.iter().enumerate() {
            let middle = middles[i];
            let child = |k: usize| 4 * i as u32 + k as u32;
            // The child at `face[k]` of the face beyond edge `e`.
            let beyond = |e: usize, k: usize| match self.across[i][e] {
                NONE => NONE,
                other => 4 * other + self.corner(other, face[k]) as u32,
            };
            for k in 0..3 {
                faces.push([face[k], middle[k], middle[last(k)]]);
                across.push([beyond(k, k), child(3), beyond(last(k), k)]);
            }
            faces.push(middle);
            across.push([child(1), child(2), child(0)]);
        }
        Self { positions, faces, across, start, open }
    }

    fn normals(&self) -> Vec<Vec3> {
        let mut ring = Vec::new();
        let mut normal = |v: usize| {
            self.ring(v as u32, &mut ring);
            let [s, t] = if self.open[v] { tangents_at_edge(self.positions[v], &ring) } else { tangents_inside(&ring) };
            s.cross(t).as_vec3()
        };
        (0..self.positions.len()).map(&mut normal).collect()
    }
}

fn beta(n: f64) -> f64 {
    if n == 3.0 { 3.0 / 16.0 } else { 3.0 / (8.0 * n) }
}

fn tangents_inside(ring: &[DVec3]) -> [DVec3; 2] {
    let step = 2.0 * PI / ring.len() as f64;
    ring.iter().enumerate().fold([DVec3::ZERO; 2], |[s, t], (j, &p)| {
        let (sin, cos) = (step * j as f64).sin_cos();
        [s + p * cos, t + p * sin]
    })
}

/// Along the edge, and across it.
fn tangents_at_edge(v: DVec3, ring: &[DVec3]) -> [DVec3; 2] {
    let n = ring.len();
    let along = ring[n - 1] - ring[0];
    let across = match n {
        2 => ring[0] + ring[1] - v * 2.0,
        3 => ring[1] - v,
        4 => (ring[1] + ring[2]) * 2.0 - ring[0] - ring[3] - v * 2.0,
        _ => {
            let theta = PI / (n - 1) as f64;
            let ends = (ring[0] + ring[n - 1]) * theta.sin();
            let factor = 2.0 * theta.cos() - 2.0;
            let middle = (1..n - 1).map(|k| ring[k] * (factor * (k as f64 * theta).sin())).sum::<DVec3>();
            -(ends + middle)
        }
    };
    [along, across]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An octahedron: every vertex has four neighbours.
    fn octahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let positions = vec![Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        let faces = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        (positions, faces)
    }

    /// The neighbours of a vertex of the octahedron cancel, so its limit is at 1 − nγ = 1 − 4/(4 + 4) = 1/2, whatever the
    /// levels; its normal is radial (inward: against the winding).
    #[test]
    fn the_limit_does_not_depend_on_the_levels() {
        let (positions, faces) = octahedron();
        for levels in 0..5 {
            let mesh = subdivide(&positions, &faces, levels).unwrap();
            assert_eq!(mesh.indices.len(), 8 << (2 * levels));
            // Euler: V − E + F = 2 with 3F = 2E.
            assert_eq!(mesh.positions.len(), 2 + mesh.indices.len() / 2);
            for (p, n) in mesh.positions.iter().zip(mesh.normals.as_ref().unwrap()).take(6) {
                assert!(
                    (p.length() - 0.5).abs() < 1e-6 && (n.normalize() + p * 2.0).length() < 1e-6,
                    "{levels}: {p} {n}"
                );
            }
        }
    }

    /// Edges stay edges: every edge of a closed surface is met once from either side, at every level.
    #[test]
    fn a_closed_surface_stays_closed() {
        let (positions, faces) = octahedron();
        let mesh = subdivide(&positions, &faces, 3).unwrap();
        let edge = |f: &[u32; 3], k: usize| (f[k], f[next(k)]);
        let edges: std::collections::HashSet<_> =
            mesh.indices.iter().flat_map(|f| [0, 1, 2].map(|k| edge(f, k))).collect();
        assert_eq!(edges.len(), 3 * mesh.indices.len());
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))));
    }

    /// A regular flat grid stays flat, with its open edge a straight line: linear functions are reproduced. The corners of
    /// the square are cut: they are drawn in by 2/5 of the way to the middle of their neighbours (weight 1/5 each).
    #[test]
    fn a_flat_patch_stays_flat_and_its_edge_stays_straight() {
        const N: u32 = 4;
        let positions: Vec<_> =
            (0..=N * (N + 2)).map(|i| Vec3::new((i % (N + 1)) as f32, (i / (N + 1)) as f32, 2.0)).collect();
        let cells = (0..N * N).map(|i| i / N * (N + 1) + i % N);
        let faces: Vec<_> = cells.flat_map(|i| [[i, i + 1, i + N + 2], [i, i + N + 2, i + N + 1]]).collect();
        let mesh = subdivide(&positions, &faces, 2).unwrap();
        for (p, n) in mesh.positions.iter().zip(mesh.normals.as_ref().unwrap()) {
            assert!((p.z - 2.0).abs() < 1e-6 && (n.normalize() + Vec3::Z).length() < 1e-5, "{p} {n}");
        }
        let near = |x: f32, y: f32| mesh.positions.iter().any(|p| (*p - Vec3::new(x, y, 2.0)).length() < 1e-5);
        assert!(near(2.0, 0.0) && near(2.0, 2.0) && near(0.0, 2.25), "inner vertices stay");
        let corner = subdivide(&positions, &faces, 0).unwrap().positions[0];
        assert!((corner - Vec3::new(0.2, 0.2, 2.0)).length() < 1e-6, "{corner}");
    }

    /// What no manifold is, and what would fill the memory, is an error or a surface, and no panic.
    #[test]
    fn what_is_no_surface_is_no_panic() {
        let (positions, mut faces) = octahedron();
        assert!(subdivide(&positions, &faces, 40).is_err());
        assert!(subdivide(&positions, &[[0, 0, 1]], 1).is_err());
        faces.extend([[0, 2, 4], [2, 0, 4], [0, 1, 5], [5, 1, 0]]);
        for levels in 0..4 {
            let mesh = subdivide(&positions, &faces, levels).unwrap();
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
        }
    }

    proptest::proptest! {
        /// Any faces over a few vertices.
        #[test]
        fn any_faces_are_subdivided_or_refused(faces: Vec<[u8; 3]>, levels in 0u32..3) {
            let positions: Vec<_> = (0..7).map(|i| Vec3::new(i as f32, (i * i) as f32, 1.0)).collect();
            let faces: Vec<_> = faces.iter().map(|f| f.map(|v| u32::from(v % 7))).collect();
            if let Ok(mesh) = subdivide(&positions, &faces, levels) {
                proptest::prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            }
        }
    }
}
