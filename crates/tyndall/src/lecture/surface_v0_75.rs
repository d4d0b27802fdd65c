//! Surfaces, version 0.75: directions are drawn from the BRDF.
//!
//! ```text
//! rayRadianceEst(x, ω):
//!     y = traceRay(x, ω)
//!     return emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! reflectedRadianceEst(x, ω):
//!     if random() < survivalProbability:
//!         ω′, pdf = brdfSample(x, n(x))
//!         return brdf(x, ω, ω′) · rayRadianceEst(x, ω′) / (pdf · survivalProbability)
//!     else
//!         return 0
//! ```
//!
//! Where the slide is loose: brdfSample needs ω too, and hands the value of the BRDF back, since a Dirac has none that
//! could be asked for.

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
        let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
        brdf * ray_radiance_est(world, x, omega_prime) / (pdf * SURVIVAL_PROBABILITY)
    } else {
        Radiance::ZERO
    }
}

// What it buys over version 0.5: on diffuse surfaces nothing, for brdf/pdf is π · brdf there too. On glossy ones the
// weight is at most 1, where a uniform direction misses the highlight nearly always and else weighs up to 1/(4α²).
