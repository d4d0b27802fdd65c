//! A smooth ball of index n in a wide beam, by geometric optics: what it scatters, and where, as an integral over the rays
//! of the beam.
//!
//! A ray at the angle `θ_i` of incidence (`sin θ_i` is its distance from the axis, over the radius) is reflected with `F`; what
//! enters goes along chords of `2 cos θ_t` radii, of each of which `e = exp(−2 σ_a cos θ_t)` arrives, and is refracted out
//! with `1 − F` or reflected on. After `p` chords it leaves with the power `w_p`, turned by the angle `D_p`:
//!
//! ```text
//! w_0 = F                       D_0 = π − 2θ_i
//! w_p = (1 − F)² F^(p−1) e^p    D_p = 2(θ_i − θ_t) + (p − 1)(π − 2θ_t)
//! ```
//!
//! `F` is that of unpolarised light at every reflection, as the renderer's. Source: van de Hulst 1957, chapter 12.

use std::f64::consts::PI;

use tyndall::bsdf::fresnel;

use super::SEGMENTS;
use crate::world::Substance;

/// Rays across the beam.
const RAYS: u32 = 20_000;
/// Chords after which what is left is too little to matter.
const MOST: i32 = 4_000;
/// The power that is too little to matter \[1\].
const LITTLE: f64 = 1e-12;

/// What geometric optics says of a grain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact {
    /// The part of the light that leaves \[1\].
    pub albedo: f64,
    /// Its mean cosine \[1\].
    pub mean_cosine: f64,
    /// The parts that leave after 0, 1, 2, 3 chords \[1\].
    pub by_segments: [f64; SEGMENTS],
}

/// Of a ball of radius 1 [length] that does not scatter inside; `None` if it does.
pub fn exact(substance: &Substance) -> Option<Exact> {
    if substance.sigma_s > 0.0 {
        return None;
    }
    let (mut albedo, mut cosine, mut by_segments) = (0.0, 0.0, [0.0; SEGMENTS]);
    for i in 0..RAYS {
        // Midpoints of the cosine μ of incidence: a ring of the beam has the area 2μ dμ.
        let mu = (f64::from(i) + 0.5) / f64::from(RAYS);
        let area = 2.0 * mu / f64::from(RAYS);
        for (p, (power, turn)) in chords(substance, mu).enumerate() {
            albedo += area * power;
            cosine += area * power * turn.cos();
            if let Some(part) = by_segments.get_mut(p) {
                *part += area * power;
            }
        }
    }
    Some(Exact { albedo, mean_cosine: cosine / albedo, by_segments })
}

/// `w_p` and `D_p` of a ray, until nothing is left.
fn chords(substance: &Substance, mu: f64) -> impl Iterator<Item = (f64, f64)> {
    let n = substance.n;
    let reflected = if n == 1.0 { 0.0 } else { f64::from(fresnel::dielectric(mu as f32, n as f32).reflectance) };
    let incident = mu.acos();
    let refracted = (incident.sin() / n).min(1.0).asin();
    let arrives = (-2.0 * substance.sigma_a * refracted.cos()).exp();
    let inside = move |p: i32| {
        let power = (1.0 - reflected).powi(2) * reflected.powi(p - 1) * arrives.powi(p);
        (power, 2.0 * (incident - refracted) + f64::from(p - 1) * (PI - 2.0 * refracted))
    };
    std::iter::once((reflected, PI - 2.0 * incident))
        .chain((1..MOST).map(inside).take_while(|(power, _)| *power > LITTLE))
}
