//! Rates: how the light of successive orders dies out in a body, and how the fluence around a source falls off.
//!
//! Both are ratios of what is counted in two bins. With the expected ratio ρ, `x = n₂ − ρ n₁` has the mean 0, is linear in
//! what the photons do, and so has a standard error that batches tell; the ratio is then `ρ + x/n₁`.
//!
//! **Orders.** In a body from which light escapes the number of n-th collisions goes as `(c/c_crit)ⁿ` once the fundamental
//! mode is alone, `c_crit` being the albedo, above 1, at which the body would be critical (Case and Zweifel 1967). Photons
//! start with the density `1 − β (r/a)²`, which is near the fundamental mode; the orders from which on others are below
//! 5·10⁻⁵ of it were found by diagonalising the kernel on a grid.
//!
//! **Distance.** Far from a point source `φ ∝ exp(−r/ν₀)/r`, with `c ν₀ artanh(1/ν₀) = 1`.

use glam::DVec3;
use tyndall::math::{Ray, Vec3};
use tyndall::sampling::rng::Rng;

use super::experiment::{Check, Effort, Experiment, Share};
use super::table::{Row, rows};
use crate::photon::{Collision, Detector, shoot};
use crate::point::{any_direction, source_stream};
use crate::run::Estimate;
use crate::world::{SetupError, Substance, World};

/// What other modes, or light that has not yet forgotten the source, may add to a rate \[1\].
const OTHERS: f64 = 1e-4;

/// Counts collisions in two bins.
struct Recorder<B> {
    bin: B,
    ratio: f64,
    last: u32,
    totals: [f64; 2],
}

impl<B: Fn(&Collision) -> Option<usize>> Detector for Recorder<B> {
    fn collide(&mut self, c: &Collision) {
        match (self.bin)(c) {
            Some(0) => {
                self.totals[0] += c.weight;
                self.totals[1] -= self.ratio * c.weight;
            }
            Some(_) => self.totals[1] += c.weight,
            None => {}
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals.to_vec()
    }

    fn is_done(&self, order: u32) -> bool {
        order > self.last
    }
}

/// A body of size a (half the thickness, or the radius) in mean free paths.
#[derive(Clone, Copy, PartialEq)]
enum Body {
    Slab,
    Ball,
}

impl Body {
    /// β of the source.
    fn shape_of_source(self) -> f64 {
        if self == Self::Slab { 0.5 } else { 0.7 }
    }

    /// The order from which on the fundamental mode is alone.
    fn first_order(self, a: f64) -> u32 {
        let order = if self == Self::Slab { 2.5 + 4.7 * a } else { 3.5 + 3.7 * a + 0.22 * a * a };
        order.ceil() as u32
    }

    fn scene(self, a: f64) -> Result<tyndall::scene::Scene, SetupError> {
        let (inside, mut world) = (Substance::of_albedo(1.0, 0.0), World::default());
        match self {
            Self::Slab => {
                world.plane(a, 1e6, &Substance::VACUUM, &inside)?;
                world.plane(-a, 1e6, &inside, &Substance::VACUUM)?;
            }
            Self::Ball => world.sphere(a, &inside, &Substance::VACUUM)?,
        }
        world.build(&inside, DVec3::ZERO)
    }

    /// A photon of the source.
    fn ray(self, a: f64, photon: u64, seed: u64) -> Ray {
        let rng = &mut source_stream(photon, !seed);
        let part = loop {
            let part = if self == Self::Slab { rng.next_1d() } else { rng.next_1d().cbrt() };
            if f64::from(rng.next_1d()) < 1.0 - self.shape_of_source() * f64::from(part * part) {
                break part;
            }
        };
        let place = match self {
            Self::Slab => Vec3::Z * part.copysign(rng.next_1d() - 0.5),
            Self::Ball => part * uniform(rng),
        };
        Ray::new(place * a as f32, any_direction(photon, seed))
    }
}

/// A direction that is as likely as any other.
fn uniform(rng: &mut Rng) -> Vec3 {
    tyndall::sampling::warp::uniform_sphere(glam::Vec2::new(rng.next_1d(), rng.next_1d()))
}

pub(super) fn criticality(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/criticality_isotropic.csv"));
    let mut experiments = Vec::new();
    for (i, row) in table.iter().enumerate() {
        for (j, (body, what)) in [(Body::Slab, "slab"), (Body::Ball, "sphere")].into_iter().enumerate() {
            let a = row.number("a_mfp");
            // Of the smallest ball so few photons reach the fundamental mode that they would say nothing.
            if !(2 * i + j).is_multiple_of(effort.every) || (body == Body::Ball && a < 0.5) {
                continue;
            }
            let expected = row.number(&format!("c_crit_{what}"));
            // Small bodies lose their photons at once: the more of them there must be.
            let effort = if a < 1.5 { effort.times(10) } else { effort };
            experiments.push(effort.experiment(family, 2 * i + j, |share| {
                let measured = critical_albedo(share, body, a, expected)?;
                let name = format!("critical albedo, {what}, a {a}");
                Ok(vec![Check::new(name, expected, OTHERS / 2.0 * expected, measured).falling().binned()])
            })?);
        }
    }
    Ok(experiments)
}

fn critical_albedo(share: Share, body: Body, a: f64, expected: f64) -> Result<Estimate, SetupError> {
    let scene = share.scene(body.scene(a)?);
    let n = body.first_order(a);
    // So many orders on a fifth is left.
    let more = (5f64.ln() / expected.ln()).round().max(2.0);
    let (last, ratio) = (n + more as u32, expected.powf(-more));
    let bin = |c: &Collision| [n, last].iter().position(|order| *order == c.order);
    let recorder = || Recorder { bin, ratio, last, totals: [0.0; 2] };
    let ray = |photon| body.ray(a, photon, share.seed);
    let sums = shoot(&scene, share.photons, share.seed, ray, recorder, |_| crate::run::Verdict::GoOn);
    // c_crit = ratio^(−1/more).
    let by_ratio = -expected / (more * ratio);
    let Estimate { mean, standard_error } = deviation(&sums).scaled(by_ratio);
    Ok(Estimate { mean: expected + mean, standard_error })
}

/// By how much the ratio of two bins is not the expected one.
fn deviation(sums: &crate::run::Sums) -> Estimate {
    sums.estimate(1).scaled(1.0 / sums.estimate(0).mean)
}

/// Where the fluence is asymptotic to 10⁻⁴, from albedo 0.9 on [mean free paths].
const FAR: f64 = 10.0;

pub(super) fn decay(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/nu0_roots.csv"));
    // Where more is absorbed the light is gone before it is asymptotic.
    let experiment = |(number, row): (usize, &Row)| {
        let (albedo, nu0) = (row.number("c"), row.number("nu0"));
        effort.long().experiment(family, number, |share| {
            let measured = relaxation_length(share, albedo, nu0)?;
            Ok(vec![Check::new(format!("ν0, albedo {albedo}"), nu0, OTHERS * nu0, measured).binned()])
        })
    };
    table.iter().enumerate().filter(|(_, row)| row.number("c") >= 0.9).map(experiment).collect()
}

fn relaxation_length(share: Share, albedo: f64, nu0: f64) -> Result<Estimate, SetupError> {
    let substance = Substance::of_albedo(albedo, 0.0);
    let scene = share.scene(crate::point::scene(&substance)?);
    let edges = [FAR, FAR + nu0, FAR + 2.0 * nu0];
    // ∫ r exp(−r/ν) dr over a shell, and the ratio of the outer to the inner.
    let primitive = |r: f64, nu: f64| -nu * (r + nu) * (-r / nu).exp();
    let shell = |i: usize, nu: f64| primitive(edges[i + 1], nu) - primitive(edges[i], nu);
    let ratio = |nu: f64| shell(1, nu) / shell(0, nu);
    let bin = |c: &Collision| {
        let r = c.p.as_dvec3().length();
        (0..2).find(|i| (edges[*i]..edges[i + 1]).contains(&r))
    };
    let recorder = || Recorder { bin, ratio: ratio(nu0), last: u32::MAX, totals: [0.0; 2] };
    let ray = |photon| Ray::new(Vec3::ZERO, any_direction(photon, share.seed));
    let sums = shoot(&scene, share.photons, share.seed, ray, recorder, |_| crate::run::Verdict::GoOn);
    let step = 1e-4 * nu0;
    let by_ratio = 2.0 * step / (ratio(nu0 + step) - ratio(nu0 - step));
    let Estimate { mean, standard_error } = deviation(&sums).scaled(by_ratio);
    Ok(Estimate { mean: nu0 + mean, standard_error })
}
