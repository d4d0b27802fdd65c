//! What light meets: shapes, the tree over them, and the questions that transport asks.
//!
//! [`GeometryBuilder`] takes shapes in the order of the scene's objects and gives a [`Geometry`], which answers:
//! where does this ray hit ([`Geometry::intersect`]), is anything in between ([`Geometry::occluded`]), what is the
//! surface like there ([`Geometry::interaction`]), and how far is the nearest surface at least
//! ([`Geometry::clearance`]).
//!
//! Which triangle a ray hits is decided without error, so a closed mesh has no leaks (see `bvh`). Where it hits is
//! computed in double precision and rounded once, with a bound on what rounding did ([`Interaction::error`]); rays
//! leave a surface from outside that bound ([`Interaction::spawn`]). No length is ever compared with a constant, so a
//! scene can be of any size.

mod between;
mod builder;
mod bvh;
mod census;
mod clearance;
mod curve;
mod cylinder;
mod derivatives;
mod disk;
mod distances;
mod geometry;
mod hollow;
mod instance;
mod interaction;
mod mesh;
mod part;
mod passage;
mod patch;
mod room;
mod seams;
mod sphere;
mod touching;
mod uv;

pub use builder::{GeometryBuilder, GroupId, ShapeError};
pub use census::Census;
pub use curve::{Basis, Curves, Knot, Style};
pub use cylinder::Cylinder;
pub use derivatives::Derivatives;
pub use disk::{Disk, DiskMapping};
pub use distances::Distances;
pub use geometry::{Geometry, Hit, ObjectId, Shape};
pub use hollow::{Hollow, Hollows};
pub use interaction::{Interaction, offset_point};
pub use mesh::Mesh;
pub use part::{SpherePart, Turn};
pub use passage::Passed;
pub use patch::Patch;
pub use room::{Ball, Block, Room};
pub use seams::Seams;
pub use sphere::Sphere;
pub use touching::{Touching, TouchingBalls};
pub use uv::Uv;
