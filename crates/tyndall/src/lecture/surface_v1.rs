//! Surfaces, version 1.0: luminaires are sampled, and direct and indirect light are estimated apart.
//!
//! ```text
//! rayRadianceEst(x, ω):
//!     y = traceRay(x, ω)
//!     return emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! directRadianceEst(x, ω):
//!     ω′, pdf = luminaireSamplePSA(x, n(x))
//!     y = traceRay(x, ω′)
//!     return brdf(x, ω, ω′) · emittedRadiance(y, −ω′) / pdf
//!
//! reflectedRadianceEst(x, ω):
//!     return directRadianceEst(x, ω) + indirectRadianceEst(x, ω)
//!
//! indirectRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = brdfSample(x, n(x))
//!         y = traceRay(x, ω′)
//!         return brdf(x, ω, ω′) · reflectedRadianceEst(y, −ω′) / (pdf · survivalProbability)
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose:
//! - The indirect part goes straight to reflectedRadianceEst(y): what y emits has been counted by luminaire sampling at x.
//!   A Dirac at x cannot use luminaire sampling, so there what y emits counts, and the walk goes on as from the eye.
//! - With several luminaires, the pdf is that of the point y that was sampled, and y counts only if it is visible; the
//!   slide would take whatever luminaire the ray meets first, and then need the density of all of them.

use super::primitives::{Point, Radiance, SURVIVAL_PROBABILITY, World};
use crate::math::Vec3;

pub(super) fn ray_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some(y) = world.trace_ray(x, omega) else { return Radiance::LOST };
    if y.is_open() {
        return world.emitted_radiance(&y, -omega) + ray_radiance_est(world, &y, omega);
    }
    world.emitted_radiance(&y, -omega) + reflected_radiance_est(world, &y, -omega)
}

fn direct_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some((omega_prime, y, pdf)) = world.luminaire_sample_psa(x, omega) else { return Radiance::ZERO };
    world.brdf(x, omega, omega_prime) * world.visibility(x, omega_prime, &y) * y.emitted_radiance / pdf
}

fn reflected_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    direct_radiance_est(world, x, omega) + indirect_radiance_est(world, x, omega)
}

fn indirect_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if world.random() < SURVIVAL_PROBABILITY {
        let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
        if x.is_dirac() {
            return brdf * ray_radiance_est(world, x, omega_prime) / (pdf * SURVIVAL_PROBABILITY);
        }
        let Some(y) = world.trace_ray_past_openings(x, omega_prime) else { return Radiance::LOST };
        brdf * reflected_radiance_est(world, &y, -omega_prime) / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

// What it buys over version 0.75: light is looked for where it comes from. A luminaire that fills a hundredth of the
// hemisphere is found at every vertex instead of at every hundredth, and one without extent is found at all.
