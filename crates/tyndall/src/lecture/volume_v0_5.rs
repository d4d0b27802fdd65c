//! Volumes, version 0.5: roulette decides whether a walk goes on.
//!
//! ```text
//! rayRadianceEst, selectDistance: as in version 0
//!
//! scatteredRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′ = uniformRandomSA()
//!         return 4π · σ_s/σ_t · phaseFn(x, ω, ω′) · rayRadianceEst(x, ω′) / survivalProbability
//!     else
//!         return 0
//!
//! reflectedRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′ = uniformRandomPSA(n(x))
//!         return π · brdf(x, ω, ω′) · rayRadianceEst(x, ω′) / survivalProbability
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose: as in version 0 (the sign of ω, the direction handed on, the end of the medium, the Dirac).

use std::f32::consts::PI;

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
        if albedo == 0.0 {
            return Radiance::ZERO;
        }
        let omega_prime = world.uniform_random_sa();
        4.0 * PI * albedo * world.phase_fn(x, omega, omega_prime) * ray_radiance_est(world, x, omega_prime)
            / SURVIVAL_PROBABILITY
    } else {
        Radiance::ZERO
    }
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

// What it buys over version 0: it ends, after 1/(1 − survivalProbability) vertices on average. The price: in a dense
// medium that absorbs little, the few walks that come out weigh 1/survivalProbability to the power of their collisions,
// and the variance has no bound.
