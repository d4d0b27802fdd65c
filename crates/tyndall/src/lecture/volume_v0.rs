//! Volumes, version 0: the volume rendering equation, each integral replaced by one random distance or direction.
//!
//! ```text
//! rayRadianceEst(x, ω):
//!     y = traceRay(x, ω)
//!     s = selectDistance(x, ω)
//!     if s < |y − x| then
//!         x′ = x − sω
//!         return scatteredRadianceEst(x′, ω′)
//!     else
//!         return emittedRadiance(y, −ω) + reflectedRadianceEst(y, −ω)
//!
//! selectDistance(x, ω):
//!     ξ = random()
//!     return −log(ξ) / σ_t
//!
//! scatteredRadianceEst(x, ω):
//!     ω′ = uniformRandomSA()
//!     return 4π · σ_s/σ_t · phaseFn(x, ω, ω′) · rayRadianceEst(x, ω′)
//!
//! reflectedRadianceEst(x, ω):
//!     ω′ = uniformRandomPSA(n(x))
//!     return π · brdf(x, ω, ω′) · rayRadianceEst(x, ω′)
//! ```
//!
//! Where the slide is loose:
//! - The collision is at `x + sω`: its own traceRay goes along `+ω`.
//! - scatteredRadianceEst is handed ω, the direction of travel into the collision: ω′ does not exist yet.
//! - The distance has the density `σ_t exp(−σ_t s)`. Its exponential cancels the attenuation, which is why none is seen,
//!   and its `σ_t` is what σ_s is divided by.
//! - The medium ends somewhere: at a surface without a material a new distance is selected in the medium behind it, which
//!   is as good as the rest of the old one, for a free flight has no memory.
//! - It never ends; a random direction never meets a Dirac: as in surface version 0.

use std::f32::consts::PI;

use super::primitives::{Point, Radiance, World};
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
    let albedo = x.albedo(world);
    if albedo == 0.0 {
        return Radiance::ZERO;
    }
    let omega_prime = world.uniform_random_sa();
    4.0 * PI * albedo * world.phase_fn(x, omega, omega_prime) * ray_radiance_est(world, x, omega_prime)
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

// What it buys: it is right, and all that follows must agree with it. It walks on until it leaves the medium, which in a
// dense one takes thousands of collisions.
