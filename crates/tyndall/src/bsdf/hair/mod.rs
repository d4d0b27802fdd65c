//! A fibre of hair or fur, seen from near.
//!
//! `S(ω_o, ω_i) = Σ_p M_p(θ_o, θ_i) A_p(ω_o) N_p(φ)` [1/sr] is the value times the cosine (Chiang, Bitterli, Tappan and Burley
//! 2016, "A Practical and Controllable Hair and Fur Model", after Marschner et al. 2003 and d'Eon et al. 2011): R, TT, TRT, and
//! one lobe for all the rest, which is the same all round. `M` and `N` integrate to 1, and the `A` sum to 1 where nothing is
//! absorbed, so a white fibre loses nothing. See [`lobes`] for the factors.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `h` | offset of the ray from the axis, over the radius | −1 to 1 |
//! | `eta` | index of the fibre over that outside | > 1, hair 1.55 |
//! | `sigma_a` | absorption per radius of the fibre | ≥ 0 |
//! | `beta_m`, `beta_n` | roughness along the fibre and round it | 0 to 1, held above 0.01 |
//! | `alpha` | tilt of the scales of the cuticle, towards the root | hair 2° |
//!
//! The local frame has the fibre along x. Only `h` says where on the fibre the light comes in: a ribbon that faces the ray and
//! a tube are lit alike. The model is that of one place `h` and is not the same with the directions exchanged; its mean over
//! `h` is, without tilt.

mod bessel;
pub mod lobes;

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{BsdfSample, ScatterKind};
use crate::{
    math::{Vec2, Vec3, fast},
    spectrum::Lanes,
};
use lobes::{Entry, Widths, exit_azimuth, sample_longitudinal, shares, sin_cos};

/// The lowest roughness: below it lobes are sharper than single precision can tell directions apart.
const SMOOTHEST: f32 = 0.01;

/// A fibre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hair {
    /// Offset of the ray from the axis over the radius, −1 to 1 \[1\]: positive on the side of ω_o × x.
    pub h: f32,
    /// Index of the fibre over that outside \[1\], above 1.
    pub eta: f32,
    /// Absorption [1/radius].
    pub sigma_a: Lanes,
    widths: Widths,
}

/// The part of [`Hair::lobes`] for one pair of directions.
#[derive(Debug, Clone, Copy)]
pub struct Lobes {
    /// `M_p N_p` [1/sr]: the density with which lobe p is drawn.
    pub density: [f64; 4],
    /// `A_p`: what takes that lobe \[1\].
    pub share: [Lanes; 4],
}

impl Lobes {
    /// `S` of one lobe [1/sr]: 0 is R, 1 TT, 2 TRT, 3 the rest.
    pub fn value(&self, p: usize) -> Lanes {
        self.share[p] * self.density[p] as f32
    }

    /// `S` [1/sr].
    fn sum(&self) -> Lanes {
        self.value(0) + self.value(1) + self.value(2) + self.value(3)
    }

    /// The density of a direction where lobes are drawn with these odds [1/sr].
    fn pdf(&self, odds: &[f64; 4]) -> f32 {
        (0..4).map(|p| odds[p] * self.density[p]).sum::<f64>() as f32
    }
}

impl Hair {
    /// A fibre met at `h`, with roughness in [0, 1] and scales tilted by `alpha` [rad].
    pub fn new(h: f32, eta: f32, sigma_a: Lanes, [beta_m, beta_n]: [f32; 2], alpha: f32) -> Self {
        let [m, n] = [beta_m, beta_n].map(|b| f64::from(b.clamp(SMOOTHEST, 1.0)));
        // Chiang et al. 2016, eq. 7 and 8: roughness that looks even.
        let deviation = 0.726 * m + 0.812 * m * m + 3.7 * m.powi(20);
        let scale = (PI / 8.0).sqrt() * (0.265 * n + 1.194 * n * n + 5.372 * n.powi(22));
        let h = h.clamp(-1.0, 1.0);
        Self { h, eta, sigma_a, widths: Widths::new((deviation * deviation) as f32, scale as f32, alpha.into()) }
    }

    /// The absorption [1/radius] that makes a bundle of fibres look of this colour, in [0, 1] (Chiang et al. 2016, eq. 9).
    pub fn sigma_a_of_reflectance(reflectance: Lanes, beta_n: f32) -> Lanes {
        let b = beta_n.clamp(SMOOTHEST, 1.0);
        let fit = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
        // Black would absorb without end.
        reflectance.map(|r| (r.clamp(1e-4, 1.0).ln() / fit).powi(2))
    }

    fn entry(&self, theta_o: [f64; 2]) -> Entry {
        Entry::new(f64::from(self.eta), f64::from(self.h), theta_o)
    }

    /// The lobes, each by itself.
    pub fn lobes(&self, wo: Vec3, wi: Vec3) -> Lobes {
        let theta_o = inclination(wo);
        let entry = self.entry(theta_o);
        Lobes { density: self.densities(&entry, wo, wi), share: shares(&entry, self.sigma_a) }
    }

    fn densities(&self, entry: &Entry, wo: Vec3, wi: Vec3) -> [f64; 4] {
        let phi = turn(wo, wi);
        let [gamma_o, gamma_t] = entry.gamma;
        let away = [0, 1, 2].map(|p| phi - exit_azimuth(p, gamma_o, gamma_t));
        self.widths.densities(inclination(wo), inclination(wi), away)
    }

    pub(super) fn eval_and_pdf(&self, wo: Vec3, wi: Vec3) -> (Lanes, f32) {
        let lobes = self.lobes(wo, wi);
        (lobes.sum(), lobes.pdf(&odds(&lobes.share)))
    }

    pub(super) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let theta_o = inclination(wo);
        let entry = self.entry(theta_o);
        let share = shares(&entry, self.sigma_a);
        let odds = odds(&share);
        let (mut p, mut rest) = (0, f64::from(u_lobe));
        while p < 3 && rest >= odds[p] {
            rest -= odds[p];
            p += 1;
        }
        // What is left of the number is as random as before.
        let again = if odds[p] > 0.0 { (rest / odds[p]).clamp(0.0, 1.0 - f64::EPSILON) } else { 0.0 };

        let tilted = self.widths.tilted(p, theta_o);
        let sin_i = sample_longitudinal(self.widths.variance(p), tilted, 1.0 - f64::from(u.x), f64::from(u.y));
        let cos_i = (1.0 - sin_i * sin_i).max(0.0).sqrt();
        let round = if p == 3 {
            2.0 * PI * again
        } else {
            let [gamma_o, gamma_t] = entry.gamma;
            self.widths.sample_azimuthal(exit_azimuth(p, gamma_o, gamma_t), again)
        };
        let [sin, cos] = sin_cos(round);
        let around = DVec2::new(wo.y.into(), wo.z.into()).normalize_or(DVec2::X);
        let around = around.rotate(DVec2::new(cos, sin)) * cos_i;
        let wi = DVec3::new(sin_i, around.x, around.y).normalize().as_vec3();

        let lobes = Lobes { density: self.densities(&entry, wo, wi), share };
        let (value, pdf) = (lobes.sum(), lobes.pdf(&odds));
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let kind = if wo.z * wi.z > 0.0 { ScatterKind::Reflection } else { ScatterKind::Transmission };
        Some(BsdfSample { wi, weight: value / pdf, pdf, kind, specular: false, eta: 1.0 })
    }
}

/// `[sin θ, cos θ]`, each to its own precision.
fn inclination(w: Vec3) -> [f64; 2] {
    let w = w.as_dvec3().normalize_or_zero();
    [w.x, (w.y * w.y + w.z * w.z).sqrt()]
}

/// By how much the azimuth of one direction is beyond that of another [rad].
fn turn(from: Vec3, to: Vec3) -> f64 {
    let [from, to] = [from, to].map(|w| DVec2::new(w.y.into(), w.z.into()));
    fast::atan2(from.perp_dot(to), from.dot(to))
}

/// How often each lobe is drawn \[1\]: by the mean of its lanes.
fn odds(share: &[Lanes; 4]) -> [f64; 4] {
    let mean = share.map(|lanes| f64::from(lanes.mean()));
    let sum: f64 = mean.iter().sum();
    mean.map(|m| m / sum)
}
