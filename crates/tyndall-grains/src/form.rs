//! What shape grains have: `ball`, `ellipsoid:A:B:C` (proportions of its axes), or a closed mesh. A grain of radius `r` has the
//! volume of a ball of that radius, whatever its shape, so that packing fractions depend on radii alone.
//!
//! Whether two grains overlap is asked of their support functions (Gilbert, Johnson and Keerthi 1988), exactly for ellipsoids,
//! and of its convex hull for a mesh: hollows of a mesh stay empty.

use std::{f64::consts::TAU, sync::Arc};

use glam::{DQuat, DVec3};
use rapier3d::parry::{
    math::{Pose, Rotation, Vector},
    query::details::intersection_test_support_map_support_map,
    shape::{ConvexPolyhedron, SupportMap},
};
use tyndall::sampling::Rng;

use crate::{GrainError, container::quadratic, lengths, pack::Grain, solid::Solid, uniform};

/// The most that the longest axis of an ellipsoid may be of the shortest.
const LONGEST: f64 = 10.0;

/// Vertices of the polyhedron around an ellipsoid.
const VERTICES: u32 = 200;

/// A shape.
#[derive(Debug, Clone)]
pub enum Form {
    /// A ball.
    Ball,
    /// Half axes of the grain of radius 1; their product is 1.
    Ellipsoid(DVec3),
    /// A mesh.
    Mesh(Arc<Mesh>),
}

/// A mesh as a grain.
#[derive(Debug)]
pub struct Mesh {
    solid: Solid,
    /// By what it is multiplied, from its centred unit size, for a grain of radius 1.
    scale: f64,
    /// For a grain of radius 1.
    hull: ConvexPolyhedron,
}

impl Form {
    /// `ball` or `ellipsoid:A:B:C`.
    ///
    /// # Errors
    /// It is neither, or too long.
    pub fn parse(text: &str) -> Result<Self, GrainError> {
        let wanted =
            "a grain: ball, ellipsoid:A:B:C (the longest axis at most 10 times the shortest), or the file of a mesh";
        let syntax = || GrainError::Syntax { text: text.to_owned(), wanted };
        if text == "ball" {
            return Ok(Self::Ball);
        }
        let numbers = text.strip_prefix("ellipsoid:").ok_or_else(syntax)?;
        match *lengths(text, numbers, "axes of a grain", wanted)? {
            [a, b, c] if a.max(b).max(c) <= LONGEST * a.min(b).min(c) => {
                let axes = DVec3::new(a, b, c) / a;
                Ok(Self::Ellipsoid(axes / axes.element_product().cbrt()))
            }
            _ => Err(syntax()),
        }
    }

    /// The shape of a mesh.
    ///
    /// # Errors
    /// It has no convex hull of any thickness.
    pub fn mesh(solid: Solid) -> Result<Self, GrainError> {
        let scale = (2.0 / 3.0 * TAU / solid.volume()).cbrt() * solid.unit;
        let points: Vec<Vector> = solid.points.iter().map(|&point| single(scale * point)).collect();
        let hull = ConvexPolyhedron::from_convex_hull(&points)
            .ok_or_else(|| GrainError::Mesh("is too flat for a grain".to_owned()))?;
        Ok(Self::Mesh(Arc::new(Mesh { solid, scale, hull })))
    }

    /// Surface of a grain of radius 1.
    pub fn surface(&self) -> f64 {
        match self {
            Self::Ball => 2.0 * TAU,
            Self::Ellipsoid(axes) => ellipsoid_surface(*axes),
            Self::Mesh(mesh) => mesh.solid.surface() * (mesh.scale / mesh.solid.unit).powi(2),
        }
    }

    /// Radius of the ball around the centre of a grain of radius 1 that holds all of it.
    pub(crate) fn reach(&self) -> f64 {
        match self {
            Self::Ball => 1.0,
            Self::Ellipsoid(axes) => axes.max_element(),
            Self::Mesh(mesh) => mesh.scale * mesh.solid.points.iter().map(|p| p.length()).fold(0.0, f64::max),
        }
    }

    /// Vertices and triangles of a grain of radius 1 that is a mesh.
    pub fn triangles(&self) -> Option<(Vec<DVec3>, &[[u32; 3]])> {
        let Self::Mesh(mesh) = self else { return None };
        Some((mesh.solid.points.iter().map(|&point| mesh.scale * point).collect(), &mesh.solid.triangles))
    }

    /// A turn of a grain: of a ball none is seen.
    pub(crate) fn turn(&self, rng: &mut Rng) -> DQuat {
        if matches!(self, Self::Ball) {
            return DQuat::IDENTITY;
        }
        // Shoemake 1992.
        let (u, a, b) = (uniform(rng), TAU * uniform(rng), TAU * uniform(rng));
        let (s, t) = ((1.0 - u).sqrt(), u.sqrt());
        DQuat::from_xyzw(s * a.sin(), s * a.cos(), t * b.sin(), t * b.cos())
    }

    /// Points of a grain whose convex hull is the grain, or nearly: what must lie in a container.
    pub(crate) fn points(&self, grain: &Grain) -> Vec<DVec3> {
        let local: Vec<DVec3> = match self {
            Self::Ball => Vec::new(),
            Self::Ellipsoid(axes) => lattice().map(|point| *axes * point).collect(),
            Self::Mesh(mesh) => {
                mesh.hull.points().iter().map(|p| DVec3::from_array(p.to_array().map(f64::from))).collect()
            }
        };
        local.into_iter().map(|point| grain.centre + grain.turn * (grain.radius * point)).collect()
    }

    /// Whether two grains overlap.
    pub(crate) fn overlap(&self, a: &Grain, b: &Grain) -> bool {
        let between = b.centre - a.centre;
        let (radii, reach) = (a.radius + b.radius, self.reach());
        if matches!(self, Self::Ball) || between.length() >= reach * radii {
            return between.length() < radii;
        }
        let back = a.turn.inverse();
        let turn = (back * b.turn).to_array().map(|x| x as f32);
        let pose = Pose::from_parts(single(back * between / a.radius), Rotation::from_array(turn));
        let support = |radius: f64| Support { form: self, radius: radius as f32 };
        intersection_test_support_map_support_map(&pose, &support(1.0), &support(b.radius / a.radius))
    }

    /// Where a line passes the surface of a grain, in order.
    pub(crate) fn passages(&self, grain: &Grain, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let (o, d) = match self {
            Self::Ball => (origin - grain.centre, direction),
            _ => (grain.turn.inverse() * (origin - grain.centre), grain.turn.inverse() * direction),
        };
        let axes = match self {
            Self::Ball => DVec3::ONE,
            Self::Ellipsoid(axes) => *axes,
            Self::Mesh(mesh) => {
                let grown = mesh.scale / mesh.solid.unit * grain.radius;
                return mesh.solid.passages(o / grown, d).into_iter().map(|t| t * grown).collect();
            }
        };
        let (o, d) = (o / axes, d / axes);
        let met = quadratic(d.length_squared(), o.dot(d), o.length_squared() - grain.radius * grain.radius);
        met.map_or_else(Vec::new, |(near, far)| vec![near, far])
    }

    /// A convex polyhedron around a grain of radius 1, for the rigid bodies: `None` of a ball.
    pub(crate) fn polyhedron(&self) -> Option<ConvexPolyhedron> {
        match self {
            Self::Ball => None,
            Self::Ellipsoid(axes) => {
                let ball: Vec<Vector> = lattice().map(single).collect();
                let ball = ConvexPolyhedron::from_convex_hull(&ball)?;
                // So much larger that its nearest face touches the ellipsoid.
                let distances = ball.faces().iter().map(|face| {
                    let vertex = ball.vertices_adj_to_face()[face.first_vertex_or_edge as usize];
                    face.normal.dot(ball.points()[vertex as usize])
                });
                let inner = distances.fold(1.0, f32::min);
                ball.scaled(single(*axes / f64::from(inner)))
            }
            Self::Mesh(mesh) => Some(mesh.hull.clone()),
        }
    }
}

/// A grain without its place.
struct Support<'a> {
    form: &'a Form,
    radius: f32,
}

impl SupportMap for Support<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let point = match self.form {
            Form::Ball => direction.normalize_or_zero(),
            Form::Ellipsoid(axes) => {
                let axes = single(*axes);
                axes * (axes * direction).normalize_or_zero()
            }
            Form::Mesh(mesh) => mesh.hull.local_support_point(direction),
        };
        self.radius * point
    }
}

/// Points spread over the unit sphere (Fibonacci's lattice).
fn lattice() -> impl Iterator<Item = DVec3> {
    let golden = TAU * (0.5 * (5f64.sqrt() - 1.0));
    (0..VERTICES).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(VERTICES);
        let (rim, turn) = ((1.0 - z * z).sqrt(), golden * f64::from(i));
        DVec3::new(rim * turn.cos(), rim * turn.sin(), z)
    })
}

/// Of half axes: the integral of the area that a piece of the unit sphere becomes, by the midpoint rule in `z` and turn.
fn ellipsoid_surface(axes: DVec3) -> f64 {
    const STEPS: u32 = 512;
    let inverse = 1.0 / axes;
    let step = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    let row = |i: u32| {
        let z = 2.0 * step(i) - 1.0;
        let rim = (1.0 - z * z).sqrt();
        let around = (0..STEPS).map(|j| {
            let (sin, cos) = (TAU * step(j)).sin_cos();
            (inverse * DVec3::new(rim * cos, rim * sin, z)).length()
        });
        around.sum::<f64>()
    };
    2.0 * TAU * axes.element_product() * (0..STEPS).map(row).sum::<f64>() / f64::from(STEPS * STEPS)
}

/// In the single precision of the geometry library.
pub(crate) fn single(v: DVec3) -> Vector {
    Vector::from_array(v.as_vec3().to_array())
}
