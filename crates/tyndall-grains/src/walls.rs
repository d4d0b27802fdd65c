//! The walls of a container as triangles that face inwards, for the rigid bodies. Round walls are inscribed, so that what lies
//! within them lies in the container; they are nowhere further from it than a fiftieth of the largest grain's radius.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::container::Container;

/// How far walls may be from the container [largest radii].
const SAG: f64 = 0.02;

/// Vertices and triangles.
pub(crate) fn walls(container: &Container, largest: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let sides = |radius: f64| ((PI / (2.0 * SAG * largest / radius).sqrt()).ceil() as u32).clamp(16, 512);
    match *container {
        Container::Box(half) => {
            // As turned profiles: a square.
            let (points, triangles) = turned(&[(1.0, -1.0), (1.0, 1.0)], 4, PI / 4.0);
            let stretch = DVec3::new(half.x * 2f64.sqrt(), half.y * 2f64.sqrt(), half.z);
            (points.into_iter().map(|point| point * stretch).collect(), triangles)
        }
        Container::Cylinder(radius, half) => turned(&[(radius, -half), (radius, half)], sides(radius), 0.0),
        Container::Sphere(radius) => {
            let rings = sides(radius) / 2;
            let ring = |i: u32| {
                let polar = PI * (f64::from(i) / f64::from(rings));
                (radius * polar.sin(), -radius * polar.cos())
            };
            let profile: Vec<_> = (1..rings).map(ring).collect();
            let (mut points, triangles) = turned(&profile, 2 * rings, 0.0);
            // The middles of the end faces become the poles.
            let [low, high] = [points.len() - 2, points.len() - 1];
            (points[low].z, points[high].z) = (-radius, radius);
            (points, triangles)
        }
        Container::Mesh(ref solid) => {
            let points = solid.points.iter().map(|&point| point * solid.unit).collect();
            (points, solid.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect())
        }
    }
}

/// A profile of radii and heights, upwards, turned around z in so many steps, with end faces around points on the axis, which are
/// the last two.
fn turned(profile: &[(f64, f64)], sides: u32, start: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut points = Vec::new();
    for &(radius, height) in profile {
        points.extend((0..sides).map(|i| {
            let (sin, cos) = (start + TAU * f64::from(i) / f64::from(sides)).sin_cos();
            DVec3::new(radius * cos, radius * sin, height)
        }));
    }
    let (first, last) = (profile[0].1, profile[profile.len() - 1].1);
    let low = points.len() as u32;
    points.extend([DVec3::new(0.0, 0.0, first), DVec3::new(0.0, 0.0, last)]);
    let mut triangles = Vec::new();
    for i in 0..sides {
        let next = (i + 1) % sides;
        for ring in (0..low - sides).step_by(sides as usize) {
            let [a, b, c, d] = [ring + i, ring + next, ring + sides + next, ring + sides + i];
            triangles.extend([[a, c, b], [a, d, c]]);
        }
        let top = low - sides;
        triangles.extend([[low, i, next], [low + 1, top + next, top + i]]);
    }
    (points, triangles)
}
