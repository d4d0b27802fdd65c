//! Volumes, version 0.75: directions are drawn from the phase function and the BRDF.
//!
//! ```text
//! rayRadianceEst, selectDistance: as in version 0
//!
//! scatteredRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = phaseFunctionSample()
//!         return σ_s/σ_t · phaseFn(x, ω, ω′) · rayRadianceEst(x, ω′) / (pdf · survivalProbability)
//!     else
//!         return 0
//!
//! reflectedRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = brdfSample(x, n(x))
//!         return brdf(x, ω, ω′) · rayRadianceEst(x, ω′) / (pdf · survivalProbability)
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose: as in version 0 (the sign of ω, the direction handed on, the end of the medium), and
//! phaseFunctionSample needs ω, from which directions are deflected; brdfSample as in surface version 0.75.

use super::primitives::{Point, Radiance, SURVIVAL_PROBABILITY, World};
use crate::math::Vec3;

pub(super) fn ray_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some(y) = world.trace_ray(x, omega) else { return Radiance::LOST };
    let s = select_distance(world, &y);
    if s < y.distance {
        let x_prime = world.collision(x, s, omega, &y);
        return scattered_radiance_est(world, &x_prime, omega);
    }
    if y.is_open() {
        return world.emitted_radiance(&y, -omega) + ray_radiance_est(world, &y, omega);
    }
    world.emitted_radiance(&y, -omega) + reflected_radiance_est(world, &y, -omega)
}

fn select_distance(world: &mut World, y: &Point) -> f32 {
    let xi = world.random_positive();
    -xi.ln() / world.sigma_t(y)
}

fn scattered_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        let albedo = x.albedo(world);
        let Some((omega_prime, pdf)) = world.phase_function_sample(x, omega) else { return Radiance::ZERO };
        albedo * world.phase_fn(x, omega, omega_prime) * ray_radiance_est(world, x, omega_prime)
            / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

fn reflected_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
        brdf * ray_radiance_est(world, x, omega_prime) / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

// What it buys over version 0.5: in an isotropic medium nothing. The more the phase function is peaked, the more: with
// g = 0.9 a uniform direction weighs 190 in the peak and 0.03 behind, at every collision anew; phaseFn/pdf is 1.
