//! Surfaces, version 0.5: roulette decides whether a walk goes on.
//!
//! ```text
//! rayRadianceEst(x, ω):
//!     y = traceRay(x, ω)
//!     return emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! reflectedRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′ = uniformRandomPSA(n(x))
//!         return π · brdf(x, ω, ω′) · rayRadianceEst(x, ω′) / survivalProbability
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose: a random direction never meets a Dirac, so that one is sampled.

use super::primitives::{Point, Radiance, SURVIVAL_PROBABILITY, World};
use crate::math::Vec3;

pub(super) fn ray_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some(y) = world.trace_ray(x, omega) else { return Radiance::LOST };
    if y.is_open() {
        return world.emitted_radiance(&y, -omega) + ray_radiance_est(world, &y, omega);
    }
    world.emitted_radiance(&y, -omega) + reflected_radiance_est(world, &y, -omega)
}

fn reflected_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        if x.is_dirac() {
            return dirac_reflected_est(world, x, omega) / SURVIVAL_PROBABILITY;
        }
        let omega_prime = world.uniform_random_psa(x, omega);
        let brdf = world.brdf(x, omega, omega_prime);
        if brdf == 0.0 {
            return Radiance::ZERO;
        }
        x.projected_solid_angle() * brdf * ray_radiance_est(world, x, omega_prime) / SURVIVAL_PROBABILITY
    } else {
        Radiance::ZERO
    }
}

fn dirac_reflected_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
    brdf * ray_radiance_est(world, x, omega_prime) / pdf
}

// What it buys over version 0: it ends, after 1/(1 − survivalProbability) vertices on average, and is still right: what
// survives stands for what does not. Samples are cheaper and noisier.
