//! Rays, surfaces and distances.

mod agreement;
mod bends;
mod clearance;
mod hollow;
mod leaks;
mod meshes;
mod passage;
mod round;
mod scale;
mod spawn;
mod strands;

use tyndall::math::{Transform, Vec3};
use tyndall::shape::{Geometry, GeometryBuilder, Mesh, Sphere};

fn of_mesh(mesh: Mesh) -> Geometry {
    let mut builder = GeometryBuilder::new();
    builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
    builder.build().unwrap()
}

fn of_sphere(centre: Vec3, radius: f32) -> Geometry {
    let mut builder = GeometryBuilder::new();
    builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, false).unwrap();
    builder.build().unwrap()
}

/// A transform from three columns and a translation.
fn affine(columns: [[f64; 3]; 3], translation: [f64; 3]) -> Transform {
    let [a, b, c] = columns.map(|[x, y, z]| glam::DVec4::new(x, y, z, 0.0));
    let d = glam::DVec4::new(translation[0], translation[1], translation[2], 1.0);
    Transform::new(glam::DMat4::from_cols(a, b, c, d)).unwrap()
}
