//! What is filled: `box:X:Y:Z` (edges), `sphere:R`, `cylinder:R:H` (radius, height; upright). Its centre is the origin, and z
//! points upwards.

use std::{f64::consts::PI, str::FromStr};

use glam::DVec3;

use crate::{GrainError, lengths};

/// What is filled with grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Container {
    /// Half edges.
    Box(DVec3),
    /// Radius.
    Sphere(f64),
    /// Radius, half height.
    Cylinder(f64, f64),
}

impl FromStr for Container {
    type Err = GrainError;

    fn from_str(text: &str) -> Result<Self, GrainError> {
        let wanted = "a container: box:X:Y:Z, sphere:R or cylinder:R:H";
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
        }
    }

    /// Volume.
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Box(half) => 8.0 * half.x * half.y * half.z,
            Self::Sphere(radius) => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Cylinder(radius, half) => 2.0 * PI * radius * radius * half,
        }
    }

    /// Whether a ball lies wholly inside.
    pub fn holds(&self, centre: DVec3, ball: f64) -> bool {
        match *self {
            Self::Box(half) => centre.abs().cmple(half - ball).all(),
            Self::Sphere(radius) => centre.length() + ball <= radius,
            Self::Cylinder(radius, half) => {
                centre.truncate().length() + ball <= radius && centre.z.abs() + ball <= half
            }
        }
    }

    /// Where the line `origin + t direction` enters and leaves it.
    pub fn chord(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let chord = match *self {
            Self::Box(half) => slabs(origin, direction, half),
            Self::Sphere(radius) => quadratic(1.0, origin.dot(direction), origin.length_squared() - radius * radius)?,
            Self::Cylinder(radius, half) => {
                let (o, d) = (origin.truncate(), direction.truncate());
                let tall = DVec3::new(f64::INFINITY, f64::INFINITY, half);
                let (bottom, top) = slabs(origin, direction, tall);
                let (near, far) = quadratic(d.length_squared(), o.dot(d), o.length_squared() - radius * radius)?;
                (near.max(bottom), far.min(top))
            }
        };
        (chord.0 < chord.1).then_some(chord)
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
