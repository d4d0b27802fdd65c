//! Solids as signed distances, and how they are joined and carved: negative inside, [mm].
//!
//! Distances are exact for capsules of one radius and for blocks, and close to exact near the surface of the others, which
//! is all that an isosurface needs. `join`, `meet` and `carve` blend over a width `k` [mm] with a parabola, so that the
//! surface keeps its tangents there (Quilez, "smooth minimum").

use glam::{DVec2, DVec3};

/// A ball stretched to three radii.
pub(crate) fn ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    let q = (p - centre) / radii;
    let steepness = (q / radii).length();
    if steepness == 0.0 { -radii.min_element() } else { q.length() * (q.length() - 1.0) / steepness }
}

/// A rod with round ends, whose radius goes from `radii[0]` at `a` to `radii[1]` at `b`.
pub(crate) fn rod(p: DVec3, [a, b]: [DVec3; 2], radii: [f64; 2]) -> f64 {
    let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (p - a.lerp(b, along)).length() - (radii[0] + (radii[1] - radii[0]) * along)
}

/// Rods of one radius from point to point.
pub(crate) fn string(p: DVec3, points: &[DVec3], radius: f64) -> f64 {
    points.windows(2).map(|w| rod(p, [w[0], w[1]], [radius; 2])).fold(f64::INFINITY, f64::min)
}

/// A block with rounded edges; `half` reaches from its middle to its faces.
pub(crate) fn block(p: DVec3, centre: DVec3, half: DVec3, rounding: f64) -> f64 {
    let q = (p - centre).abs() - half + rounding;
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - rounding
}

/// Both.
pub(crate) fn join(a: f64, b: f64, k: f64) -> f64 {
    let overlap = (k - (a - b).abs()).max(0.0);
    a.min(b) - overlap * overlap / (4.0 * k)
}

/// What lies in both.
pub(crate) fn meet(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, -b, k)
}

/// The first without the second.
pub(crate) fn carve(a: f64, b: f64, k: f64) -> f64 {
    meet(a, -b, k)
}

/// Turned about an axis by an angle [degrees].
pub(crate) fn turned(axis: DVec3, degrees: f64) -> glam::DQuat {
    glam::DQuat::from_axis_angle(axis, degrees.to_radians())
}

/// Tube around where two surfaces cross, given the distances to them.
pub(crate) fn seam(a: f64, b: f64, radius: f64) -> f64 {
    DVec2::new(a, b).length() - radius
}
