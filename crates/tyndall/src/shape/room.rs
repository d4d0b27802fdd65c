//! Convex places in which flights are free: what begins and ends in one meets nothing on the way, if no surface cuts it.
//!
//! A [`Ball`] is found around any point by its clearance. A [`Block`] is what a body with six flat faces has inside: it ends only
//! where the body does, and nothing is to be looked for.

use glam::DVec3;

use super::Mesh;
use crate::math::{Bounds, Vec3, rounding::gamma};

/// A ball or a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Room {
    /// A ball.
    Ball(Ball),
    /// A block.
    Block(Block),
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre [length].
    pub centre: Vec3,
    /// Its radius, 0 for none [length].
    pub radius: f32,
}

/// What is between three pairs of parallel planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Its centre [length].
    pub centre: Vec3,
    /// The normals of the planes, which need not be at right angles \[1\].
    pub axes: [Vec3; 3],
    /// How far they are from the centre [length].
    pub half: [f32; 3],
}

impl Room {
    /// None.
    pub const NONE: Self = Self::Ball(Ball::NONE);

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        match self {
            Self::Ball(ball) => ball.depth(p),
            Self::Block(block) => block.depth(p),
        }
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        match self {
            Self::Ball(ball) => ball.reach(p, dir),
            Self::Block(block) => block.reach(p, dir),
        }
    }

    /// If it is a block.
    pub fn block(&self) -> Option<Block> {
        if let Self::Block(block) = self { Some(*block) } else { None }
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Ball(Ball { centre, radius }) => Bounds { min: *centre - *radius, max: *centre + *radius },
            Self::Block(block) => Bounds::of(block.corners()),
        }
    }
}

impl Ball {
    /// None.
    pub const NONE: Self = Self { centre: Vec3::ZERO, radius: 0.0 };

    /// Within so large a clearance of `centre`: smaller by what rounding can do to a point within it.
    #[inline]
    pub fn within(centre: Vec3, clearance: f32) -> Self {
        Self { centre, radius: (clearance - margin(centre, clearance)).max(0.0) }
    }

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        let from = p - self.centre;
        self.radius - (from.x * from.x + from.y * from.y + from.z * from.z).sqrt()
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        let from = p - self.centre;
        let (along, beyond) = (from.dot(dir), self.radius * self.radius - from.length_squared());
        if beyond > 0.0 { (along * along + beyond).sqrt() - along } else { 0.0 }
    }
}

/// Corners of a block.
const CORNERS: usize = 8;
/// Triangles of its surface.
const FACES: usize = 12;

impl Block {
    /// What a closed mesh encloses, if that is a block whose corners are all the vertices that it has: smaller by what rounding can
    /// do to a point within.
    pub fn inside(mesh: &Mesh) -> Option<Self> {
        if mesh.indices.len() != FACES {
            return None;
        }
        let faces: Vec<_> = (0..FACES as u32).map(|prim| mesh.triangle(prim)).collect();
        let axes = axes(&faces)?;
        let bounds = Bounds::of(faces.iter().flatten().copied());
        let centre = bounds.centre();
        let height = |axis: Vec3, p: Vec3| axis.dot(p - centre);
        // On which side of the centre a corner is, and how near the nearest of the planes through each face's corners.
        let is_above = |p: Vec3| axes.map(|axis| height(axis, p) > 0.0);
        let half = axes.map(|axis| {
            let corners = faces.iter().flatten().map(|p| height(axis, *p).abs());
            corners.fold(f32::INFINITY, f32::min)
        });
        let is_face = |face: &[Vec3; 3]| {
            let [a, b, c] = face.map(is_above);
            (0..3).any(|axis| a[axis] == b[axis] && b[axis] == c[axis])
        };
        let name = |p: &Vec3| (is_above(*p), (*p + Vec3::ZERO).to_array().map(f32::to_bits)); // of -0 as well as of 0
        let mut corners: Vec<_> = faces.iter().flatten().map(name).collect();
        corners.sort_unstable();
        corners.dedup();
        let is_whole = corners.len() == CORNERS && corners.windows(2).all(|two| two[0].0 != two[1].0);
        let margin = margin(centre, bounds.extent().length());
        let block = Self { centre, axes, half: half.map(|half| half - margin) };
        (is_whole && faces.iter().all(is_face) && block.half.iter().all(|half| *half > 0.0)).then_some(block)
    }

    /// How far it is from `p` to its surface at least, not above 0 outside [length].
    #[inline(always)]
    pub fn depth(&self, p: Vec3) -> f32 {
        let from = p - self.centre;
        let depth = |axis: Vec3, half: f32| half - (axis.x * from.x + axis.y * from.y + axis.z * from.z).abs();
        let ([a, b, c], [u, v, w]) = (self.axes, self.half);
        depth(a, u).min(depth(b, v)).min(depth(c, w))
    }

    /// How far it is from `p` along `dir` to its surface; 0 outside [length].
    #[inline]
    pub fn reach(&self, p: Vec3, dir: Vec3) -> f32 {
        let from = p - self.centre;
        let mut reach = f32::INFINITY;
        for (axis, half) in self.axes.iter().zip(self.half) {
            let (height, along) = (axis.dot(from), axis.dot(dir));
            if height.abs() >= half {
                return 0.0;
            }
            if along != 0.0 {
                reach = reach.min((half - height * along.signum()) / along.abs());
            }
        }
        reach
    }

    fn corners(&self) -> impl Iterator<Item = Vec3> {
        // Where three planes meet: by the reciprocal basis of their normals.
        let [a, b, c] = self.axes;
        let volume = a.dot(b.cross(c));
        let edges = [b.cross(c), c.cross(a), a.cross(b)].map(|edge| edge / volume);
        (0..CORNERS).map(move |corner| {
            let side = |i: usize| if corner >> i & 1 == 0 { -self.half[i] } else { self.half[i] };
            self.centre + edges[0] * side(0) + edges[1] * side(1) + edges[2] * side(2)
        })
    }
}

/// The three directions, and no more, that the normals of faces have.
fn axes(faces: &[[Vec3; 3]]) -> Option<[Vec3; 3]> {
    const PARALLEL: f64 = 1.0 - 1e-6;
    let mut axes = Vec::new();
    for face in faces {
        let [a, b, c] = face.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).try_normalize()?;
        if axes.iter().all(|axis: &DVec3| axis.dot(normal).abs() < PARALLEL) {
            axes.push(normal);
        }
    }
    let [a, b, c] = axes[..] else { return None };
    Some([a, b, c].map(DVec3::as_vec3))
}

/// What rounding can do to a point that is so far from `centre` [length].
#[inline]
fn margin(centre: Vec3, away: f32) -> f32 {
    gamma(16) * (centre.abs().max_element() + away)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Transform;
    use crate::shape::GeometryBuilder;
    use glam::{DAffine3, DMat3, Quat};
    use testkit::Stream;

    /// The cube from −1 to 1, each vertex once or anew for each of its three faces, placed in the world.
    fn cuboid(placed: &Transform, shared: bool) -> Mesh {
        let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0;
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        let mesh = if shared {
            Mesh { positions: (0..8).map(corner).collect(), indices: triangles.collect(), ..Mesh::default() }
        } else {
            let positions = triangles.flatten().map(corner).collect();
            Mesh { positions, indices: (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), ..Mesh::default() }
        };
        mesh.placed(placed, false)
    }

    fn uniform(stream: &mut Stream, low: f64, high: f64) -> f64 {
        low + (high - low) * stream.next_f64()
    }

    /// Turned, sheared, stretched up to a thousandfold and far from the origin.
    fn placement(stream: &mut Stream) -> Transform {
        let mut draw = |low, high| uniform(stream, low, high);
        let turn = Quat::from_euler(glam::EulerRot::XYZ, draw(0.0, 6.0) as f32, draw(0.0, 6.0) as f32, 1.0);
        let scale = DVec3::new(1.0, draw(0.1, 10.0), draw(0.1, 10.0)) * 10f64.powf(draw(-1.5, 1.5));
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(draw(-0.5, 0.5), 1.0, 0.0), DVec3::Z);
        let matrix = DMat3::from_quat(turn.as_dquat().normalize()) * shear * DMat3::from_diagonal(scale);
        let to = DVec3::new(draw(-5.0, 5.0), draw(-5.0, 5.0), draw(-5.0, 5.0));
        Transform::new(DAffine3 { matrix3: matrix, translation: to }.into()).unwrap()
    }

    /// Against the distance to the surface itself and its place in double precision: never more, and less by rounding alone.
    #[test]
    fn a_block_reaches_as_far_as_the_surface_around_it() {
        let mut stream = Stream::new(1);
        for round in 0..40 {
            let placed = placement(&mut stream);
            let mesh = cuboid(&placed, round % 2 == 0);
            let block = Block::inside(&mesh).unwrap();
            let to_local = placed.matrix.as_dmat4().inverse();
            let mut builder = GeometryBuilder::new();
            builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
            let geometry = builder.build().unwrap();
            let size = geometry.bounds().extent().length() + geometry.bounds().max.abs().max_element();
            for _ in 0..200 {
                let mut draw = || uniform(&mut stream, -1.0, 1.0) as f32;
                let p = placed.point(Vec3::new(draw(), draw(), draw()));
                let dir = Vec3::new(draw(), draw(), draw()).normalize();
                let local = to_local.transform_point3(p.as_dvec3());
                let planes = [0, 1, 2].map(|i| (1.0 - local[i].abs()) / to_local.row(i).truncate().length());
                let distance = planes.into_iter().fold(f64::INFINITY, f64::min) as f32;
                let depth = block.depth(p);
                assert!((distance - 2e-6 * size..distance).contains(&depth), "{depth} {distance} {size}");
                let reach = block.reach(p, dir);
                let end = to_local.transform_point3(p.as_dvec3() + dir.as_dvec3() * f64::from(reach));
                assert!(end.abs().max_element() < 1.0, "{end}");
                assert!(block.depth(p + dir * reach) < 1e-6 * size, "{reach}");
            }
            assert!(block.depth(block.centre + size) < 0.0 && block.reach(block.centre + size, Vec3::X) == 0.0);
            let bounds = Room::Block(block).bounds();
            assert!(geometry.bounds().contains(bounds.min) && geometry.bounds().contains(bounds.max));
            assert!((bounds.extent() - geometry.bounds().extent()).abs().max_element() < 1e-4 * size);
        }
    }

    #[test]
    fn what_is_no_block_is_none() {
        let whole = cuboid(&Transform::IDENTITY, true);
        let dented = |corner: usize, to: Vec3| {
            let mut mesh = whole.clone();
            mesh.positions[corner] = to;
            Block::inside(&mesh)
        };
        assert!(Block::inside(&whole).is_some());
        assert_eq!(dented(7, Vec3::splat(0.9)), None);
        assert_eq!(dented(7, Vec3::new(1.0, 1.0, -1.0)), None);
        assert_eq!(dented(7, Vec3::splat(f32::MAX)), None);
        assert_eq!(Block::inside(&Mesh { indices: whole.indices[..11].to_vec(), ..whole.clone() }), None);
        let flat = Mesh {
            positions: whole.positions.iter().map(|p| *p * Vec3::new(1.0, 1.0, 0.0)).collect(),
            ..whole.clone()
        };
        assert_eq!(Block::inside(&flat), None);
        // A block within rounding of nothing has no room.
        let far = whole.positions.iter().map(|p| *p * 1e-3 + Vec3::splat(1e5)).collect();
        assert_eq!(Block::inside(&Mesh { positions: far, ..whole }), None);
    }
}
