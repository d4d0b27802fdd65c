//! Surfaces, version 0: the rendering equation, each integral replaced by one random direction.
//!
//! ```text
//! rayRadianceEst(x, ω):
//!     y = traceRay(x, ω)
//!     return emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! reflectedRadianceEst(x, ω):
//!     ω′ = uniformRandomPSA(n(x))
//!     return π · brdf(x, ω, ω′) · rayRadianceEst(x, ω′)
//! ```
//!
//! Where the slide is loose:
//! - It never ends. Here it ends where the ray escapes or meets black, which is `brdf = 0`; in a closed scene where
//!   nothing is black it is cut at [`super::MAX_DEPTH`].
//! - A random direction never meets a Dirac, so that one is sampled.

use super::primitives::{Point, Radiance, World};
use crate::math::Vec3;

pub(super) fn ray_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some(y) = world.trace_ray(x, omega) else { return Radiance::LOST };
    if y.is_open() {
        return world.emitted_radiance(&y, -omega) + ray_radiance_est(world, &y, omega);
    }
    world.emitted_radiance(&y, -omega) + reflected_radiance_est(world, &y, -omega)
}

fn reflected_radiance_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    if x.is_dirac() {
        return dirac_reflected_est(world, x, omega);
    }
    let omega_prime = world.uniform_random_psa(x, omega);
    let brdf = world.brdf(x, omega, omega_prime);
    if brdf == 0.0 {
        return Radiance::ZERO;
    }
    x.projected_solid_angle() * brdf * ray_radiance_est(world, x, omega_prime)
}

fn dirac_reflected_est(world: &mut World, x: &Point, omega: Vec3) -> Radiance {
    let Some((omega_prime, brdf, pdf)) = world.brdf_sample(x, omega) else { return Radiance::ZERO };
    brdf * ray_radiance_est(world, x, omega_prime) / pdf
}

// What it buys: it is right, and all that follows must agree with it. It pays for every vertex of every walk, however
// little the walk still carries.
