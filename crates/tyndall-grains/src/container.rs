//! What is filled: `box:X:Y:Z` (edges), `sphere:R`, `cylinder:R:H` (radius, height; upright), or a closed mesh. Its centre (of a
//! mesh that of the box around it) is the origin, and z points upwards.

use std::{f64::consts::PI, str::FromStr, sync::Arc};

use glam::DVec3;

use crate::{GrainError, lengths, solid::Solid};

/// What is filled with grains.
#[derive(Debug, Clone)]
pub enum Container {
    /// Half edges.
    Box(DVec3),
    /// Radius.
    Sphere(f64),
    /// Radius, half height.
    Cylinder(f64, f64),
    /// A mesh.
    Mesh(Arc<Solid>),
}

impl FromStr for Container {
    type Err = GrainError;

    fn from_str(text: &str) -> Result<Self, GrainError> {
        let wanted = "a container: box:X:Y:Z, sphere:R, cylinder:R:H or the file of a mesh";
        let (name, numbers) = text.split_once(':').unwrap_or((text, ""));
        match (name, lengths(text, numbers, "lengths of a container", wanted)?.as_slice()) {
            ("box", &[x, y, z]) => Ok(Self::Box(0.5 * DVec3::new(x, y, z))),
            ("sphere", &[radius]) => Ok(Self::Sphere(radius)),
            ("cylinder", &[radius, height]) => Ok(Self::Cylinder(radius, 0.5 * height)),
            _ => Err(GrainError::Syntax { text: text.to_owned(), wanted }),
        }
    }
}

impl Container {
    /// Half the edges of the box around it.
    pub fn half(&self) -> DVec3 {
        match *self {
            Self::Box(half) => half,
            Self::Sphere(radius) => DVec3::splat(radius),
            Self::Cylinder(radius, half) => DVec3::new(radius, radius, half),
            Self::Mesh(ref solid) => solid.half,
        }
    }

    /// Where the file of a mesh has the centre.
    pub fn centre(&self) -> DVec3 {
        if let Self::Mesh(solid) = self { solid.centre } else { DVec3::ZERO }
    }

    /// Volume.
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Mesh(ref solid) => solid.volume(),
            Self::Box(half) => 8.0 * half.x * half.y * half.z,
            Self::Sphere(radius) => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Cylinder(radius, half) => 2.0 * PI * radius * radius * half,
        }
    }

    /// Whether a ball lies wholly inside.
    pub fn holds(&self, centre: DVec3, ball: f64) -> bool {
        match *self {
            Self::Mesh(ref solid) => solid.holds(centre, ball),
            Self::Box(half) => centre.abs().cmple(half - ball).all(),
            Self::Sphere(radius) => centre.length() + ball <= radius,
            Self::Cylinder(radius, half) => {
                centre.truncate().length() + ball <= radius && centre.z.abs() + ball <= half
            }
        }
    }

    /// The spans of the line `origin + t direction` within it.
    pub fn spans(&self, origin: DVec3, direction: DVec3) -> Vec<(f64, f64)> {
        let span = match *self {
            Self::Mesh(ref solid) => {
                return solid.passages(origin, direction).chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
            }
            Self::Box(half) => Some(slabs(origin, direction, half)),
            Self::Sphere(radius) => quadratic(1.0, origin.dot(direction), origin.length_squared() - radius * radius),
            Self::Cylinder(radius, half) => {
                let (o, d) = (origin.truncate(), direction.truncate());
                let (bottom, top) = slabs(origin, direction, DVec3::new(f64::INFINITY, f64::INFINITY, half));
                quadratic(d.length_squared(), o.dot(d), o.length_squared() - radius * radius)
                    .map(|(near, far)| (near.max(bottom), far.min(top)))
            }
        };
        span.into_iter().filter(|(near, far)| near < far).collect()
    }
}

fn slabs(origin: DVec3, direction: DVec3, half: DVec3) -> (f64, f64) {
    let (a, b) = ((-half - origin) / direction, (half - origin) / direction);
    (a.min(b).max_element(), a.max(b).min_element())
}

/// Where `a t² + 2 b t + c` is zero.
pub(crate) fn quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let discriminant = b * b - a * c;
    (discriminant > 0.0).then(|| ((-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a))
}
