//! Volumes, version 1.0: luminaires are sampled, and direct and indirect light are estimated apart.
//!
//! ```text
//! rayRadianceEst(x, ω, e = 1):
//!     y = traceRay(x, ω)
//!     s = selectDistance(x, ω)
//!     if s < |y − x| then
//!         x′ = x − sω
//!         return scatteredRadianceEst(x′, ω′)
//!     else
//!         return e · emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! directReflectedEst(x, ω):
//!     ω′, pdf = luminaireSamplePSA(x, n(x))
//!     y = traceRay(x, ω′)
//!     return brdf(x, ω, ω′) · attenuation(x, y) · emittedRadiance(y, −ω′) / pdf
//!
//! directScatteredEst(x, ω):
//!     ω′, pdf = luminaireSampleSA(x)
//!     y = traceRay(x, ω′)
//!     return phaseFn(x, ω, ω′) · attenuation(x, y) · emittedRadiance(y, −ω′) / pdf
//!
//! scatteredRadianceEst(x, ω):
//!     return directScatteredEst(x, ω) + indirectScatteredEst(x, ω)
//!
//! reflectedRadianceEst(x, ω):
//!     return directReflectedEst(x, ω) + indirectReflectedEst(x, ω)
//!
//! indirectReflectedEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = brdfSample(x, n(x))
//!         return brdf(x, ω, ω′) · rayRadianceEst(x, ω′, 0) / (pdf · survivalProbability)
//!     else
//!         return 0
//!
//! indirectScatteredEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = phaseFunctionSample()
//!         return σ_s/σ_t · phaseFn(x, ω, ω′) · rayRadianceEst(x, ω′, 0) / (pdf · survivalProbability)
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose:
//! - directScatteredEst lacks the `σ_s/σ_t` that its indirect twin has. It must be there: without it a medium that only
//!   absorbs would glow.
//! - `e` says whether emission counts: 1 from the eye, 0 after luminaire sampling has counted it, and 1 again after a
//!   Dirac, where luminaires cannot be sampled. A surface without a material hands `e` on.
//! - The sign of ω, the direction handed on and the end of the medium as in version 0; several luminaires as in surface
//!   version 1.0.

use super::primitives::{Point, Radiance, SURVIVAL_PROBABILITY, World};
use crate::math::Vec3;

pub(super) fn ray_radiance_est(world: &mut World, x: &Point, omega: Vec3, e: f32) -> Radiance {
    let Some(y) = world.trace_ray(x, omega) else { return Radiance::LOST };
    let s = select_distance(world, &y);
    if s < y.distance {
        let x_prime = world.collision(x, s, omega, &y);
        return scattered_radiance_est(world, &x_prime, omega);
    }
    if y.is_open() {
        return e * world.emitted_radiance(&y, -omega) + ray_radiance_est(world, &y, omega, e);
    }
    e * world.emitted_radiance(&y, -omega) + reflected_radiance_est(world, &y, -omega)
}

fn select_distance(world: &mut World, y: &Point) -> f32 {
    let xi = world.random_positive();
    -xi.ln() / world.sigma_t(y)
}

fn direct_reflected_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some((omega_prime, y, pdf)) = world.luminaire_sample_psa(x, omega) else { return Radiance::ZERO };
    world.brdf(x, omega, omega_prime) * world.attenuation(x, omega_prime, &y) * y.emitted_radiance / pdf
}

fn direct_scattered_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some((omega_prime, y, pdf)) = world.luminaire_sample_sa(x, omega) else { return Radiance::ZERO };
    x.albedo(world) * world.phase_fn(x, omega, omega_prime) * world.attenuation(x, omega_prime, &y) * y.emitted_radiance
        / pdf
}

fn scattered_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    direct_scattered_est(world, x, omega) + indirect_scattered_est(world, x, omega)
}

fn reflected_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    direct_reflected_est(world, x, omega) + indirect_reflected_est(world, x, omega)
}

fn indirect_reflected_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
        let e = if x.is_dirac() { 1.0 } else { 0.0 };
        brdf * ray_radiance_est(world, x, omega_prime, e) / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

fn indirect_scattered_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        let albedo = x.albedo(world);
        let Some((omega_prime, pdf)) = world.phase_function_sample(x, omega) else { return Radiance::ZERO };
        albedo * world.phase_fn(x, omega, omega_prime) * ray_radiance_est(world, x, omega_prime, 0.0)
            / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

// What it buys over version 0.75: a small luminaire, or the sun, is found at every collision. What is left to be bought:
// both ways to find light together (multiple importance sampling), a roulette that knows what the walk carries, and no
// ray at all for a flight that ends long before the next surface: the way to `volpath`.
