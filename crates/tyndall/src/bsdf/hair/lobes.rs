//! What the lobes of a fibre are made of: how far along it, how far round it, and how much.
//!
//! Angles: θ is the inclination from the plane across the fibre, φ the azimuth round it, γ the angle between the direction
//! and the normal, both across the fibre: `h = sin γ`. Lobe p leaves after p passes through the fibre.

use std::f64::consts::{PI, TAU};

use super::bessel::ln_i0;
use crate::{bsdf::fresnel, spectrum::Lanes};

/// Longitudinal scattering `M(θ_i, θ_o)` of variance `v` [1/rad of sin θ]: `∫ M cos θ_i dθ_i = 1`, exactly.
///
/// `exp(−sin θ_i sin θ_o / v) I₀(cos θ_i cos θ_o / v) / (2 v sinh(1/v))` (d'Eon et al. 2011, eq. 7), as one exponential, which
/// never overflows: `ln(2 v sinh(1/v)) = 1/v + ln(v (1 − e^(−2/v)))`.
pub fn longitudinal(v: f64, [sin_i, cos_i]: [f64; 2], [sin_o, cos_o]: [f64; 2]) -> f64 {
    let exponent = ln_i0(cos_i * cos_o / v) - (sin_i * sin_o + 1.0) / v;
    exponent.exp() / (v * -(-2.0 / v).exp_m1())
}

/// Draws `sin θ_i` from [`longitudinal`] (d'Eon 2013): `u` in (0, 1], `turn` in [0, 1).
pub(super) fn sample_longitudinal(v: f64, [sin_o, cos_o]: [f64; 2], u: f64, turn: f64) -> f64 {
    let cos = 1.0 + v * (u + (1.0 - u) * (-2.0 / v).exp()).ln();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    -cos * sin_o + sin * (TAU * turn).cos() * cos_o
}

/// Azimuthal scattering: the logistic density of scale `s` around the azimuth of a smooth fibre, cut off at ±π [1/rad].
pub fn azimuthal(s: f64, phi: f64, centre: f64) -> f64 {
    let x = (phi - centre + PI).rem_euclid(TAU) - PI;
    let e = (-x.abs() / s).exp();
    e / (s * (1.0 + e) * (1.0 + e)) / share_within(s)
}

/// Draws from [`azimuthal`]: `u` in [0, 1).
pub(super) fn sample_azimuthal(s: f64, centre: f64, u: f64) -> f64 {
    let share = share_within(s);
    let at = 0.5 * (1.0 - share) + u * share;
    centre - (s * (1.0 / at - 1.0).ln()).clamp(-PI, PI)
}

/// What of the logistic density is within ±π.
fn share_within(s: f64) -> f64 {
    (PI / (2.0 * s)).tanh()
}

/// The azimuth by which lobe `p` of a smooth fibre leaves [rad].
pub fn exit_azimuth(p: usize, gamma_o: f64, gamma_t: f64) -> f64 {
    let p = p as f64;
    2.0 * p * gamma_t - 2.0 * gamma_o + p * PI
}

/// The geometry of light that comes to the fibre from one direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// Fresnel reflectance at the surface \[1\].
    pub(super) fresnel: f64,
    /// Angle between the normal and the direction before and after refraction, across the fibre [rad].
    pub(super) gamma: [f64; 2],
    /// The way through the fibre in radii.
    pub(super) way: f64,
}

impl Entry {
    pub(super) fn new(eta: f64, h: f64, [sin_o, cos_o]: [f64; 2]) -> Self {
        let gamma_o = h.asin();
        // Bravais: across the fibre light sees the index √(η² − sin² θ)/cos θ.
        let sin_gamma_t = (h * cos_o / (eta * eta - sin_o * sin_o).sqrt()).clamp(-1.0, 1.0);
        let cos_theta_t = (1.0 - (sin_o / eta).powi(2)).sqrt();
        let cos_gamma_t = (1.0 - sin_gamma_t * sin_gamma_t).sqrt();
        let cos = cos_o * (1.0 - h * h).max(0.0).sqrt();
        Self {
            fresnel: f64::from(fresnel::dielectric(cos as f32, eta as f32).reflectance),
            gamma: [gamma_o, sin_gamma_t.asin()],
            way: 2.0 * cos_gamma_t / cos_theta_t,
        }
    }
}

/// What of the light takes each lobe \[1\]: R, TT, TRT, and all that comes after. They sum to 1 without absorption.
///
/// `A₀ = F`, `A₁ = (1 − F)² T`, `A_p = A_(p−1) F T`, the last the sum of the rest of the series; `T = exp(−σ_a·way)`.
pub(super) fn shares(entry: &Entry, sigma_a: Lanes) -> [Lanes; 4] {
    let f = entry.fresnel as f32;
    let t = sigma_a.map(|sigma| (-sigma * entry.way as f32).exp());
    let tt = t * ((1.0 - f) * (1.0 - f));
    let trt = tt * t * f;
    let rest = Lanes::new(std::array::from_fn(|i| {
        let tf = t.lane(i) * f;
        if tf < 1.0 { trt.lane(i) * tf / (1.0 - tf) } else { 0.0 }
    }));
    [Lanes::splat(f), tt, trt, rest]
}
