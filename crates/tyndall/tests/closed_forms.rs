//! Ring 3: worlds whose radiance is known in closed form, through every general integrator.

mod common;

use common::{World, assert_mean, diffuse, glass, medium};
use std::f64::consts::FRAC_1_PI;

use tyndall::{
    integrator::{Analog, Integrator, VolPath},
    light::{Distant, Light, PointLight},
    material::Material,
    math::Vec3,
    medium::Homogeneous,
    phase::Phase,
    spectrum::{ColorMode, Spectrum},
};

fn integrators() -> [(&'static str, Box<dyn Integrator>); 2] {
    [("volpath", Box::new(VolPath::default())), ("analog", Box::new(Analog))]
}

/// A medium that only scatters cannot be told from empty space under a uniform sky: radiance 1 along every path, for any
/// phase function, and for coefficients that differ between channels.
#[test]
fn a_scattering_ball_under_a_uniform_sky_vanishes() {
    for (name, integrator) in integrators() {
        for g in [0.0, 0.8, -0.5] {
            let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
            world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(medium([0.0; 3], [1.0, 3.0, 9.0], g)));
            world.sky(1.0);
            assert_mean(&format!("{name}, g = {g}"), &world.measure(&*integrator, 40_000), [1.0; 3], 0.01);
        }
    }
}

/// The same behind a refracting skin, smooth or rough: glass neither makes nor takes light. The rough one loses what a
/// second bounce between its microfacets would carry, so only the smooth one is exactly 1.
#[test]
fn a_scattering_ball_of_glass_under_a_uniform_sky_vanishes() {
    for (name, integrator) in integrators() {
        let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
        world.sphere(Vec3::ZERO, 1.0, glass(1.5, 0.0), Some(medium([0.0; 3], [0.5, 2.0, 4.0], 0.5)));
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 40_000), [1.0; 3], 0.01);
    }
}

/// In spectral mode too.
#[test]
fn a_scattering_ball_vanishes_at_hero_wavelengths() {
    for (name, integrator) in integrators() {
        let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
        world.color = ColorMode::Spectral;
        world.sphere(Vec3::ZERO, 1.0, glass(1.3, 0.0), Some(medium([0.0; 3], [0.5, 2.0, 4.0], 0.5)));
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 80_000), [1.0; 3], 0.02);
    }
}

/// Beer and Lambert: an absorber of thickness d before a uniform sky passes exp(−σ_a d), channel by channel.
#[test]
fn an_absorber_darkens_the_sky_exponentially() {
    for (name, integrator) in integrators() {
        let sigma = [0.2, 0.7, 1.5];
        let mut world = World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO);
        world.slab(1.0, Material::Null, medium(sigma, [0.0; 3], 0.0));
        world.sky(1.0);
        let expected = sigma.map(|s| f64::from(-s).exp());
        assert_mean(name, &world.measure(&*integrator, 60_000), expected, 0.02);
    }
}

/// Kirchhoff: a slab that absorbs and emits L_e per unit of absorption shines with ∫ σ_a L_e exp(−σ_a s) ds over its
/// thickness d, L = L_e (1 − exp(−σ_a d)), channel by channel; also one channel that neither absorbs nor emits.
#[test]
fn an_absorber_that_emits_shines_with_what_it_takes_away() {
    for (name, integrator) in integrators() {
        let sigma = [0.0, 0.7, 2.5];
        let le = [3.0, 2.0, 1.0];
        let mut world = World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO);
        let emission = Some(Spectrum::illuminant_rgb(le));
        world.slab(1.0, Material::Null, Homogeneous { emission, ..medium(sigma, [0.0; 3], 0.0) });
        let expected: [f64; 3] = std::array::from_fn(|c| f64::from(le[c]) * (1.0 - f64::from(-sigma[c]).exp()));
        assert_mean(name, &world.measure(&*integrator, 200_000), expected, 0.02);
    }
}

/// In a furnace nothing can be seen: a ball that scatters, absorbs and emits L_e = 1, before a sky of radiance 1, keeps the
/// radiance 1 along every path, for every albedo and phase function. Behind a skin of index n the furnace holds n² of it, as
/// light that enters is compressed (Clausius), and so must the medium emit.
#[test]
fn a_glowing_ball_in_a_furnace_as_hot_as_it_vanishes() {
    for (name, integrator) in integrators() {
        for (skin, n, g) in [(Material::Null, 1.0f32, 0.0), (Material::Null, 1.0, 0.7), (glass(1.5, 0.0), 1.5, 0.3)] {
            let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
            let emission = Some(Spectrum::illuminant_rgb([n * n; 3]));
            let glowing = Homogeneous { emission, ..medium([0.3, 1.0, 4.0], [2.0, 0.5, 4.0], g) };
            world.sphere(Vec3::ZERO, 1.0, skin, Some(glowing));
            world.sky(1.0);
            assert_mean(&format!("{name}, n = {n}, g = {g}"), &world.measure(&*integrator, 60_000), [1.0; 3], 0.01);
        }
    }
}

/// Inside a closed diffuse body that shines with L_e everywhere, L = L_e + ρL, so L = L_e / (1 − ρ)
/// (`surface_ground_truths.csv`, closed_enclosure_radiance).
#[test]
fn light_in_a_closed_body_builds_up_to_le_over_one_minus_rho() {
    for (name, integrator) in integrators() {
        for (rho, expected) in [(0.2, 1.25), (0.5, 2.0), (0.8, 5.0), (0.95, 20.0)] {
            let mut world = World::seen(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 1.0, 0.5));
            world.shining_sphere(Vec3::ZERO, 1.0, diffuse(rho), 1.0, true);
            assert_mean(&format!("{name}, rho = {rho}"), &world.measure(&*integrator, 60_000), [expected; 3], 0.02);
        }
    }
}

/// A point light of intensity I at the centre of a unit sphere of reflectance ρ: E = I on the wall directly, and the wall
/// shines with L = ρ I / (π (1 − ρ)) (`surface_ground_truths.csv`, sphere_point_light_center).
#[test]
fn a_point_light_in_a_diffuse_sphere_gives_rho_i_over_pi_one_minus_rho() {
    for (name, integrator) in integrators() {
        for (rho, expected) in [(0.5, FRAC_1_PI), (0.9, 9.0 * FRAC_1_PI)] {
            let mut world = World::seen(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 1.0, 0.5));
            world.sphere(Vec3::ZERO, 1.0, diffuse(rho), None);
            let intensity = Spectrum::constant(1.0);
            world.lights.push(Light::Point(PointLight { position: Vec3::ZERO, intensity, luminance: 1.0 }));
            assert_mean(&format!("{name}, rho = {rho}"), &world.measure(&*integrator, 60_000), [expected; 3], 0.02);
        }
    }
}

/// Two infinite plates, one shining with L_e and reflecting ρ₁, the other reflecting ρ₂: L₁ = L_e / (1 − ρ₁ρ₂),
/// L₂ = ρ₂ L₁ (`surface_ground_truths.csv`, infinite_parallel_plates). Here the plates are 10⁴ times wider than their gap.
#[test]
fn facing_plates_multiply_their_light() {
    for (name, integrator) in integrators() {
        for (target, expected) in [(1.0, 1.66666666666667), (-1.0, 1.33333333333333)] {
            let mut world = World::seen(Vec3::ZERO, Vec3::new(0.3, target, 0.1));
            let wide = 1e4;
            world.shining_disk(1.0, wide, diffuse(0.5), 1.0);
            world.cuboid(Vec3::new(-wide, -2.0, -wide), Vec3::new(wide, -1.0, wide), diffuse(0.8), None);
            assert_mean(&format!("{name}, {target}"), &world.measure(&*integrator, 60_000), [expected; 3], 0.02);
        }
    }
}

/// Single scattering in a slab under a distant light of irradiance E (on a plane that faces it), seen from above:
/// L = E · ϖ/4π · μ₀/(μ + μ₀) · (1 − exp(−τ(1/μ + 1/μ₀))) with an isotropic phase function (Chandrasekhar 1960, § 17).
#[test]
fn once_scattered_light_of_a_slab_follows_chandrasekhar() {
    let tau = [0.3f64, 1.0, 3.0];
    let albedo = 0.7;
    let sun = Vec3::new(0.6, 0.8, 0.0);
    let view = Vec3::new(-0.36, 0.48, 0.8);
    let (mu0, mu) = (f64::from(sun.y), f64::from(view.y));
    let mut world = World::seen(view * 5.0, Vec3::ZERO);
    world.slab(
        1.0,
        Material::Null,
        medium(tau.map(|t| (t * (1.0 - albedo)) as f32), tau.map(|t| (t * albedo) as f32), 0.0),
    );
    let irradiance = Spectrum::constant(1.0);
    world.lights.push(Light::Distant(Distant { towards: sun, irradiance, luminance: 1.0 }));
    // mu0 in the numerator belongs to the flux through the surface; E is given facing the sun, and the collision rate
    // along the view ray is E exp(-t/mu0): L = E w/4pi * mu0/(mu+mu0) * (...).
    let expected = tau.map(|t| {
        albedo / (4.0 * std::f64::consts::PI) * mu0 / (mu + mu0) * (1.0 - (-t * (1.0 / mu + 1.0 / mu0)).exp())
    });
    let single = VolPath { max_depth: Some(1), ..VolPath::default() };
    assert_mean("volpath", &world.measure(&single, 200_000), expected, 0.01);
}

/// Slabs lit from one side by a uniform sky and seen along the normal: by reciprocity the radiance is the reflectance or
/// transmittance for collimated normal incidence, unscattered and specular parts included
/// (`slab_RT_iadpython_grid.csv`, columns `R_coll`, `T_coll`; accuracy 5·10⁻⁷). The three channels hold three albedos.
#[test]
fn slabs_reflect_and_transmit_as_adding_doubling_says() {
    for case in slab_cases() {
        for (above, below, expected) in [(1.0, 0.0, case.reflectance), (0.0, 1.0, case.transmittance)] {
            let mut world = World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO);
            let skin = if case.n == 1.0 { Material::Null } else { glass(case.n, 0.0) };
            let scattering = case.albedo.map(|a| a * case.tau);
            let absorption = case.albedo.map(|a| (1.0 - a) * case.tau);
            world.slab(1.0, skin, medium(absorption, scattering, case.g));
            world.half_sky(above, below);
            let name = format!(
                "tau {} g {} n {} from {}",
                case.tau,
                case.g,
                case.n,
                if above > 0.0 { "above" } else { "below" }
            );
            let precision = if expected.iter().any(|e| *e < 0.02) { 0.1 } else { 0.02 };
            assert_mean(&name, &world.measure(&VolPath::default(), 60_000), expected, precision);
        }
    }
}

/// A phase function as a table is the phase function: slabs of Henyey and Greenstein's, tabulated at 20,001 cosines (whose
/// linear interpolation has the same mean cosine to 10⁻⁵), and the same blended of two other tables.
#[test]
fn slabs_of_tabulated_scatterers_reflect_as_those_of_the_formula() {
    let table = |p: &dyn Fn(f32) -> f32| {
        Phase::tabulated(&(0..=20_000).map(|i| f64::from(p(i as f32 / 1e4 - 1.0))).collect::<Vec<_>>()).unwrap()
    };
    for case in slab_cases().into_iter().filter(|case| case.g.abs() >= 0.5) {
        let hg = Phase::henyey_greenstein(case.g).unwrap();
        // p (1 ± 0.9 c) with the norms 1 ± 0.9 g, each with half its norm.
        let halves = [1.0, -1.0].map(|sign| table(&|c| hg.eval(c) * (1.0 + sign * 0.9 * c)));
        let blend = Phase::blend(&halves[0], &halves[1], 0.5 * (1.0 - 0.9 * case.g)).unwrap();
        for (name, phase) in [("table", table(&|c| hg.eval(c))), ("blend", blend)] {
            let mut world = World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO);
            let skin = if case.n == 1.0 { Material::Null } else { glass(case.n, 0.0) };
            let scattering = case.albedo.map(|a| a * case.tau);
            let absorption = case.albedo.map(|a| (1.0 - a) * case.tau);
            world.slab(1.0, skin, Homogeneous { phase, ..medium(absorption, scattering, 0.0) });
            world.half_sky(1.0, 0.0);
            let name = format!("{name}, tau {} g {} n {}", case.tau, case.g, case.n);
            let precision = if case.reflectance.iter().any(|e| *e < 0.02) { 0.1 } else { 0.02 };
            assert_mean(&name, &world.measure(&VolPath::default(), 60_000), case.reflectance, precision);
        }
    }
}

struct SlabCase {
    tau: f32,
    g: f32,
    n: f32,
    albedo: [f32; 3],
    reflectance: [f64; 3],
    transmittance: [f64; 3],
}

/// Rows of the table that share τ, g and n, three albedos at a time.
fn slab_cases() -> Vec<SlabCase> {
    let table = include_str!("data/slab_RT_iadpython_grid.csv");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| !line.starts_with('#') && !line.starts_with("albedo"))
        .map(|line| line.split(',').collect())
        .collect();
    let number = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
    let wanted = [
        ("1", "0", "1"),
        ("1", "0.9", "1"),
        ("5", "0", "1.5"),
        ("1", "-0.5", "1"),
        ("5", "0.5", "1.33"),
        ("20", "0.8", "1.4"),
    ];
    let mut cases = Vec::new();
    for (tau, g, n) in wanted {
        let matching: Vec<_> = rows.iter().filter(|r| r[1] == tau && r[2] == g && r[3] == n && r[0] != "0").collect();
        if let [a, b, c, ..] = matching[..] {
            let column = |i: usize| [number(a, i), number(b, i), number(c, i)];
            cases.push(SlabCase {
                tau: tau.parse().unwrap(),
                g: g.parse().unwrap(),
                n: n.parse().unwrap(),
                albedo: column(0).map(|v| v as f32),
                reflectance: column(4),
                transmittance: column(5),
            });
        }
    }
    assert!(cases.len() >= 4, "the table lacks rows");
    cases
}
