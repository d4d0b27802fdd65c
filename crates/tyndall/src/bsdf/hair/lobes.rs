//! What the lobes of a fibre are made of: how far along it, how far round it, and how much.
//!
//! Angles: θ is the inclination from the plane across the fibre, φ the azimuth round it, γ the angle between the direction
//! and the normal, both across the fibre: `h = sin γ`. Lobe p leaves after p passes through the fibre.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use super::bessel::{scaled_i0, scaled_i0_single};
use crate::{bsdf::fresnel, math::fast, spectrum::Lanes};

/// How wide the lobes are, and how far tilted: all that does not depend on where light comes from and goes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Widths {
    /// Longitudinal variance of R \[1\]; TT has a quarter, the others four times as much.
    variance: f32,
    /// One over that.
    inverse: f32,
    /// `1/(2 v sinh(1/v)) e^(1/v)` of R, TT, TRT: see [`longitudinal`].
    along: [f32; 3],
    /// Scale of the logistic lobes [rad].
    scale: f32,
    /// Their share within ±π \[1\].
    within: f32,
    /// `1/s` over that: `N = e/(1 + e)² / s`, `e = exp(−|φ|/s)`, over the share that is within ±π.
    round: f32,
    /// Sine and cosine of the tilt of the scales.
    tilt: [f64; 2],
}

impl Widths {
    /// From the longitudinal variance of R \[1\], the azimuthal scale [rad] and the tilt of the scales [rad].
    pub(super) fn new(variance: f32, scale: f32, alpha: f64) -> Self {
        let (v, s) = (f64::from(variance), f64::from(scale));
        let (wide, within) = (fast_exp(-0.5 / v), share_within(s));
        let [sin, cos] = sin_cos(alpha);
        let sin = sin.clamp(-1.0, 1.0);
        let along = |v: f64, e: f64| (1.0 / (v * (1.0 - e))) as f32;
        Self {
            variance,
            inverse: 1.0 / variance,
            along: [along(v, wide.powi(4)), along(0.25 * v, wide.powi(16)), along(4.0 * v, wide)],
            scale,
            within: within as f32,
            round: (1.0 / (s * within)) as f32,
            // To the digits that make lobes lose nothing.
            tilt: [sin, (1.0 - sin * sin).sqrt().copysign(cos)],
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

    /// `M_p N_p` of all lobes [1/sr], side by side: `away` is how far the azimuth is from that of each lobe of a smooth fibre [rad].
    #[inline]
    pub(super) fn densities(&self, theta_o: [f64; 2], [sin_i, cos_i]: [f64; 2], away: [f64; 3]) -> [f64; 4] {
        let inverse = f64::from(self.inverse);
        let inverse = [inverse, 4.0 * inverse, 0.25 * inverse, 0.25 * inverse];
        let (mut exponents, mut growths) = ([0.0; 8], [0.0; 4]);
        for p in 0..4 {
            let [sin_o, cos_o] = self.tilted(p, theta_o);
            let cos = cos_i * cos_o;
            growths[p] = cos * inverse[p];
            exponents[p] = ((cos - sin_i * sin_o - 1.0) * inverse[p]) as f32;
        }
        let steep = 1.0 / self.scale;
        for p in 0..3 {
            exponents[4 + p] = -(within_half_a_turn(away[p]).abs() as f32) * steep;
        }
        let mut e = [0.0; 8];
        for i in 0..8 {
            e[i] = fast::exp(exponents[i]);
        }
        let [along_r, along_tt, along_trt] = self.along;
        let logistic = |e: f32| e * self.round / ((1.0 + e) * (1.0 + e));
        let factors = [
            e[0] * along_r * logistic(e[4]),
            e[1] * along_tt * logistic(e[5]),
            e[2] * along_trt * logistic(e[6]),
            e[3] * along_trt * (0.5 * FRAC_1_PI) as f32,
        ];
        std::array::from_fn(|p| f64::from(factors[p]) * scaled_i0_single(growths[p]))
    }

    /// Draws from the logistic lobe about `centre`: `u` in [0, 1).
    pub(super) fn sample_azimuthal(&self, centre: f64, u: f64) -> f64 {
        let (scale, share) = (f64::from(self.scale), f64::from(self.within));
        let at = 0.5 * (1.0 - share) + u * share;
        centre - (scale * f64::from(fast::ln((1.0 / at - 1.0) as f32))).clamp(-PI, PI)
    }
}

/// An angle less the turns that it has too many [rad].
#[inline]
fn within_half_a_turn(angle: f64) -> f64 {
    let turns = angle * (1.0 / TAU);
    angle - TAU * f64::from((turns + 0.5f64.copysign(turns)) as i32)
}

/// What of the logistic density is within ±π: `tanh(π/2s)`.
fn share_within(s: f64) -> f64 {
    let e = fast_exp(-PI / s);
    (1.0 - e) / (1.0 + e)
}

/// Sine and cosine of an angle [rad], to the digits of single precision.
#[inline]
pub(super) fn sin_cos(angle: f64) -> [f64; 2] {
    let (sin, cos) = fast::sin_cos_turn((angle / TAU).rem_euclid(1.0) as f32);
    [sin.into(), cos.into()]
}

/// The exponential, to the digits of single precision.
#[inline]
fn fast_exp(x: f64) -> f64 {
    fast::exp(x as f32).into()
}

/// Longitudinal scattering `M(θ_i, θ_o)` of variance `v` [1/rad of sin θ]: `∫ M cos θ_i dθ_i = 1`, exactly.
///
/// `exp(−sin θ_i sin θ_o / v) I₀(cos θ_i cos θ_o / v) / (2 v sinh(1/v))` (d'Eon et al. 2011, eq. 7), each factor without its growth:
/// `2 v sinh(1/v) = e^(1/v) · v (1 − e^(−2/v))`. In double precision: the twin of what the lobes have in single precision.
pub fn longitudinal(v: f64, theta_i: [f64; 2], theta_o: [f64; 2]) -> f64 {
    let ([sin_i, cos_i], [sin_o, cos_o]) = (theta_i, theta_o);
    let (cos, inverse) = (cos_i * cos_o, 1.0 / v);
    ((cos - sin_i * sin_o - 1.0) * inverse).exp() * scaled_i0(cos * inverse) / (v * -(-2.0 * inverse).exp_m1())
}

/// Draws `sin θ_i` from [`longitudinal`] (d'Eon 2013): `u` in (0, 1], `turn` in [0, 1).
pub(super) fn sample_longitudinal(v: f64, [sin_o, cos_o]: [f64; 2], u: f64, turn: f64) -> f64 {
    let cos = 1.0 + v * f64::from(fast::ln((u + (1.0 - u) * fast_exp(-2.0 / v)) as f32));
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (_, cos_turn) = fast::sin_cos_turn(turn as f32);
    -cos * sin_o + sin * f64::from(cos_turn) * cos_o
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
        let cos_gamma_o = (1.0 - h * h).max(0.0).sqrt();
        // Bravais: across the fibre light sees the index √(η² − sin² θ)/cos θ.
        let sin_gamma_t = (h * cos_o / (eta * eta - sin_o * sin_o).sqrt()).clamp(-1.0, 1.0);
        let cos_theta_t = (1.0 - (sin_o / eta).powi(2)).sqrt();
        let cos_gamma_t = (1.0 - sin_gamma_t * sin_gamma_t).sqrt();
        let cos = cos_o * cos_gamma_o;
        Self {
            fresnel: f64::from(fresnel::dielectric(cos as f32, eta as f32).reflectance),
            gamma: [fast::atan2(h, cos_gamma_o), fast::atan2(sin_gamma_t, cos_gamma_t)],
            way: 2.0 * cos_gamma_t / cos_theta_t,
        }
    }
}

/// What of the light takes each lobe \[1\]: R, TT, TRT, and all that comes after. They sum to 1 without absorption.
///
/// `A₀ = F`, `A₁ = (1 − F)² T`, `A_p = A_(p−1) F T`, the last the sum of the rest of the series; `T = exp(−σ_a·way)`.
pub(super) fn shares(entry: &Entry, sigma_a: Lanes) -> [Lanes; 4] {
    let f = entry.fresnel as f32;
    let t = sigma_a.map(|sigma| fast::exp(-sigma * entry.way as f32));
    let tt = t * ((1.0 - f) * (1.0 - f));
    let trt = tt * t * f;
    let rest = Lanes::new(std::array::from_fn(|i| {
        let tf = t.lane(i) * f;
        if tf < 1.0 { trt.lane(i) * tf / (1.0 - tf) } else { 0.0 }
    }));
    [Lanes::splat(f), tt, trt, rest]
}
