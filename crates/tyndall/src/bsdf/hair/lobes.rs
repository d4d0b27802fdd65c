//! What the lobes of a fibre are made of: how far along it, how far round it, and how much.
//!
//! Angles: θ is the inclination from the plane across the fibre, φ the azimuth round it, γ the angle between the direction
//! and the normal, both across the fibre: `h = sin γ`. Lobe p leaves after p passes through the fibre.

use std::f64::consts::{PI, TAU};

use super::bessel::scaled_i0;
use crate::{bsdf::fresnel, spectrum::Lanes};

/// How wide the lobes are, and how far tilted: all that does not depend on where light comes from and goes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Widths {
    /// Longitudinal variance of R \[1\]; TT has a quarter, the others four times as much.
    variance: f32,
    /// `1/(2 v sinh(1/v)) e^(1/v)` of R, TT, TRT: see [`longitudinal`].
    along: [f32; 3],
    /// Scale of the logistic lobes [rad].
    scale: f32,
    /// `1/s` over their share within ±π: see [`Self::azimuthal`].
    round: f32,
    /// Sine and cosine of the tilt of the scales.
    tilt: [f64; 2],
}

impl Widths {
    /// From the longitudinal variance of R \[1\], the azimuthal scale [rad] and the tilt of the scales [rad].
    pub(super) fn new(variance: f32, scale: f32, alpha: f64) -> Self {
        let (v, s) = (f64::from(variance), f64::from(scale));
        let wide = (-0.5 / v).exp();
        let along = |v: f64, e: f64| (1.0 / (v * (1.0 - e))) as f32;
        Self {
            variance,
            along: [along(v, wide.powi(4)), along(0.25 * v, wide.powi(16)), along(4.0 * v, wide)],
            scale,
            round: (1.0 / (s * share_within(s))) as f32,
            tilt: alpha.sin_cos().into(),
        }
    }

    /// Of lobe p.
    pub(super) fn variance(&self, p: usize) -> f64 {
        f64::from(self.variance) * [1.0, 0.25, 4.0, 4.0][p]
    }

    /// The inclination that lobe p sees: scales tilt R by −2α, TT by α, TRT by 4α.
    pub(super) fn tilted(&self, p: usize, [sin, cos]: [f64; 2]) -> [f64; 2] {
        let twice = |[s, c]: [f64; 2]| [2.0 * s * c, c * c - s * s];
        let [s, c] = match p {
            0 => twice([-self.tilt[0], self.tilt[1]]),
            1 => self.tilt,
            2 => twice(twice(self.tilt)),
            _ => [0.0, 1.0],
        };
        // Beyond the axis it is the other side, from where light goes just as far round.
        [sin * c + cos * s, (cos * c - sin * s).abs()]
    }

    /// `M` of lobe p, which sees `theta_o` tilted.
    pub(super) fn longitudinal(&self, p: usize, theta_i: [f64; 2], theta_o: [f64; 2]) -> f64 {
        falls_off(self.variance(p), theta_i, self.tilted(p, theta_o)) * f64::from(self.along[p.min(2)])
    }

    /// `N` of a lobe whose smooth azimuth is `away` from that of the light [rad].
    pub(super) fn azimuthal(&self, away: f64) -> f64 {
        let turns = away * (1.0 / TAU);
        let x = away - TAU * f64::from((turns + 0.5f64.copysign(turns)) as i32);
        let e = (-x.abs() / f64::from(self.scale)).exp();
        e * f64::from(self.round) / ((1.0 + e) * (1.0 + e))
    }

    /// Draws from [`Self::azimuthal`] about `centre`: `u` in [0, 1).
    pub(super) fn sample_azimuthal(&self, centre: f64, u: f64) -> f64 {
        let scale = f64::from(self.scale);
        let share = share_within(scale);
        let at = 0.5 * (1.0 - share) + u * share;
        centre - (scale * (1.0 / at - 1.0).ln()).clamp(-PI, PI)
    }
}

/// What of the logistic density is within ±π: `tanh(π/2s)`.
fn share_within(s: f64) -> f64 {
    let e = (-PI / s).exp();
    (1.0 - e) / (1.0 + e)
}

/// Longitudinal scattering `M(θ_i, θ_o)` of variance `v` [1/rad of sin θ]: `∫ M cos θ_i dθ_i = 1`, exactly.
///
/// `exp(−sin θ_i sin θ_o / v) I₀(cos θ_i cos θ_o / v) / (2 v sinh(1/v))` (d'Eon et al. 2011, eq. 7), each factor without its growth:
/// `2 v sinh(1/v) = e^(1/v) · v (1 − e^(−2/v))`.
pub fn longitudinal(v: f64, theta_i: [f64; 2], theta_o: [f64; 2]) -> f64 {
    falls_off(v, theta_i, theta_o) / (v * -(-2.0 / v).exp_m1())
}

/// `exp(−(sin θ_i sin θ_o + 1)/v) I₀(cos θ_i cos θ_o / v)`, which never overflows.
fn falls_off(v: f64, [sin_i, cos_i]: [f64; 2], [sin_o, cos_o]: [f64; 2]) -> f64 {
    let (cos, inverse) = (cos_i * cos_o, 1.0 / v);
    ((cos - sin_i * sin_o - 1.0) * inverse).exp() * scaled_i0(cos * inverse)
}

/// Draws `sin θ_i` from [`longitudinal`] (d'Eon 2013): `u` in (0, 1], `turn` in [0, 1).
pub(super) fn sample_longitudinal(v: f64, [sin_o, cos_o]: [f64; 2], u: f64, turn: f64) -> f64 {
    let cos = 1.0 + v * (u + (1.0 - u) * (-2.0 / v).exp()).ln();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    -cos * sin_o + sin * (TAU * turn).cos() * cos_o
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
