//! The fibre of hair, against tables that were made by others (`tests/data/hair_*.csv`; their heads say how), and in the white
//! furnace.

use super::*;
use testkit::quadrature::gauss_legendre_rule;
use tyndall::bsdf::hair::{Hair, lobes::longitudinal};

/// The rows of the table of samplers.
pub(super) fn rows() -> Vec<(&'static str, Bsdf<'static>)> {
    let brown = Lanes::rgb(0.54, 0.91, 1.78);
    let hair = |h, sigma_a, beta, alpha: f32| Bsdf::Hair(Hair::new(h, 1.55, sigma_a, beta, alpha.to_radians()));
    vec![
        ("white hair", hair(0.3, Lanes::ZERO, [0.3, 0.3], 2.0)),
        ("brown hair, at its edge", hair(-0.95, brown, [0.25, 0.4], 3.0)),
        ("black fur, rough", hair(0.0, brown * 6.0, [0.9, 0.8], 0.0)),
    ]
}

/// The rows of a table, by column.
fn table(text: &'static str) -> impl Iterator<Item = Vec<f64>> {
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
}

/// The direction of an inclination and an azimuth around the fibre.
fn fibre_direction(theta: f64, phi: f64) -> Vec3 {
    Vec3::new(theta.sin() as f32, (theta.cos() * phi.cos()) as f32, (theta.cos() * phi.sin()) as f32)
}

/// The table has ten digits.
#[test]
fn longitudinal_scattering_is_what_deon_writes() {
    let mut count = 0;
    for row in table(include_str!("../data/hair_Mp_deon.csv")) {
        let [v, theta_o, theta_i, expected, _] = row[..] else { panic!("{row:?}") };
        let found = longitudinal(v, theta_i.sin_cos().into(), theta_o.sin_cos().into());
        assert!((found / expected - 1.0).abs() < 2e-9, "{row:?}: {found}");
        count += 1;
    }
    assert!(count > 50);
}

/// To the rounding of a direction in single precision: 6e-8 of a sine, divided by the least variance of 0.005, twice.
#[test]
fn every_lobe_of_a_fibre_is_what_its_formulas_give_in_double_precision() {
    let mut count = 0;
    for row in table(include_str!("../data/hair_chiang_mitsuba.csv")) {
        let [theta_o, theta_i, phi, h, beta_m, beta_n, alpha, sigma_a, _, _, r, tt, trt, rest, _] = row[..] else {
            panic!("{row:?}")
        };
        let roughness = [beta_m as f32, beta_n as f32];
        let hair = Hair::new(h as f32, 1.55, Lanes::splat(sigma_a as f32), roughness, alpha.to_radians() as f32);
        let lobes = hair.lobes(fibre_direction(theta_o, 0.4), fibre_direction(theta_i, 0.4 + phi));
        for (p, expected) in [r, tt, trt, rest].into_iter().enumerate() {
            let found = f64::from(lobes.value(p).lane(0));
            // Far out on a lobe the exponents are large.
            let rounding = 5e-5 + 2e-5 * -(expected / 10.0).min(1.0).ln();
            assert!((found - expected).abs() < rounding * expected + 1e-37, "lobe {p} of {row:?}: {found}");
        }
        count += 1;
    }
    assert!(count > 50);
}

/// The mean over the width of a fibre, by Gauss's rule in γ, of what is scattered into all directions.
#[test]
fn a_fibre_scatters_as_much_as_one_that_is_smooth() {
    let rule = gauss_legendre_rule(200);
    let mut count = 0;
    for row in table(include_str!("../data/hair_fibre_albedo.csv")) {
        let [theta, sigma_a, total, parts @ ..] = &row[..] else { panic!("{row:?}") };
        let wo = fibre_direction(theta.to_radians(), 0.0);
        let mut found = [0.0; 4];
        for [x, weight] in &rule {
            let gamma = 0.25 * TAU * x;
            let hair = Hair::new(gamma.sin() as f32, 1.55, Lanes::splat(*sigma_a as f32), [0.3, 0.3], 0.03);
            let share = hair.lobes(wo, wo).share;
            for p in 0..4 {
                found[p] += 0.125 * TAU * weight * gamma.cos() * f64::from(share[p].lane(0));
            }
        }
        for (found, expected) in found.iter().zip(parts) {
            assert!((found - expected).abs() < 2e-6, "{row:?}: {found}, not {expected}");
        }
        let sum: f64 = found.iter().sum();
        assert!((sum - total).abs() < 2e-6, "{row:?}: {sum}");
        count += 1;
    }
    assert!(count > 20);
}

/// All that a white fibre is given it gives back, at every roughness, tilt and place: `∫ S dω = 1`. By Gauss's rule in sin θ
/// and the trapezium rule round the fibre; lobes are at least 0.02 wide.
#[test]
fn a_white_fibre_loses_nothing() {
    let rule = gauss_legendre_rule(400);
    for (beta_m, beta_n, alpha, h) in [
        (0.1, 0.2, 2.0, 0.3),
        (0.3, 0.3, -3.0, -0.99),
        (1.0, 1.0, 5.0, 0.0),
        (0.15, 0.9, 0.0, 0.8),
        (0.6, 0.15, 2.0, 1.0),
    ] {
        for theta_o in [0.0, -0.7, 1.3] {
            let hair = Hair::new(h, 1.55, Lanes::ZERO, [beta_m, beta_n], f32::to_radians(alpha));
            let wo = fibre_direction(theta_o, 0.0);
            let mut sum = 0.0;
            for [x, weight] in &rule {
                for k in 0..300 {
                    let wi = fibre_direction(x.asin(), TAU * f64::from(k) / 300.0);
                    sum += weight * TAU / 300.0 * f64::from(Bsdf::Hair(hair).eval(wo, wi).lane(0));
                }
            }
            assert!((sum - 1.0).abs() < 1e-4, "{hair:?} from {theta_o}: {sum}");
        }
    }
}

/// A fibre that is nearly smooth reflects like a cylinder: `ω_o` mirrored at the normal that the offset says.
#[test]
fn the_first_lobe_is_the_mirror_image_at_the_surface_of_the_fibre() {
    let hair = Hair::new(0.6, 1.55, Lanes::splat(1e3), [0.05, 0.05], 0.0);
    // The offset is positive on the side of wo × x: with wo = z that is +y, so the normal there is (0, 0.6, 0.8).
    let (wo, normal) = (Vec3::Z, Vec3::new(0.0, 0.6, 0.8));
    let mirrored = normal * (2.0 * normal.dot(wo)) - wo;
    let best = (0..3600).map(|k| fibre_direction(0.0, TAU * f64::from(k) / 3600.0));
    let value = |wi: &Vec3| hair.lobes(wo, *wi).value(0).lane(0);
    let best = best.max_by(|a, b| value(a).total_cmp(&value(b))).unwrap();
    assert!(best.dot(mirrored) > (0.002f32).cos(), "{best} {mirrored}");
}
