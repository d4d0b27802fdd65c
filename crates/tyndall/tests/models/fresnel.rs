//! Fresnel's equations against closed forms.

use testkit::quadrature::adaptive_simpson;
use tyndall::bsdf::fresnel::{conductor, dielectric};
use tyndall::spectrum::Lanes;

/// ((n − 1)/(n + 1))², from both sides.
#[test]
fn at_normal_incidence_glass_reflects_four_percent() {
    for n in [1.33f32, 1.5, 2.4] {
        let exact = ((n - 1.0) / (n + 1.0)).powi(2);
        assert!((dielectric(1.0, n).reflectance - exact).abs() < 1e-7);
        assert!((dielectric(1.0, 1.0 / n).reflectance - exact).abs() < 1e-7);
    }
    assert!((dielectric(1.0, 1.5).reflectance - 0.04).abs() < 1e-7);
}

/// At tan θ = n the parallel polarisation is not reflected, and the other with ((n² − 1)/(n² + 1))²; half of the light
/// has it.
#[test]
fn at_brewsters_angle_only_one_polarisation_is_reflected() {
    let n = 1.5f32;
    let brewster = 1.0 / (1.0 + n * n).sqrt();
    let s = (n * n - 1.0) / (n * n + 1.0);
    assert!((dielectric(brewster, n).reflectance - 0.5 * s * s).abs() < 1e-7);
}

/// Beyond sin θ = 1/n all is reflected; just inside of it not all, and the reflectance is continuous.
#[test]
fn beyond_the_critical_angle_all_light_is_reflected() {
    let n = 1.5f32;
    let critical = (1.0 - 1.0 / (n * n)).sqrt();
    for cos in [0.0, 0.1, critical - 1e-5] {
        let inside = dielectric(cos, 1.0 / n);
        assert_eq!((inside.reflectance, inside.cos_t), (1.0, 0.0));
    }
    let just_inside = dielectric(critical + 1e-5, 1.0 / n);
    assert!(just_inside.reflectance < 1.0 && just_inside.reflectance > 0.95 && just_inside.cos_t > 0.0);
}

/// Light that is turned round at the far side of the refraction meets the same reflectance. From the dense side the
/// cosine decides less and less towards the critical angle: its rounding by ε moves the cosine outside by `nε/cos` and
/// the reflectance, whose slope is at most 4 there, with it.
#[test]
fn an_interface_reflects_alike_from_both_sides_of_a_ray() {
    for i in 1..=1000 {
        let cos = i as f32 / 1000.0;
        let there = dielectric(cos, 1.5);
        let back = dielectric(there.cos_t, 1.0 / 1.5);
        let rounding = 4.0 * 1.5 * f32::EPSILON / cos;
        assert!((there.reflectance - back.reflectance).abs() < rounding, "{i}: {there:?} {back:?}");
    }
}

#[test]
fn without_a_step_of_the_index_nothing_is_reflected_at_any_angle() {
    for cos in [1e-18f32, 1e-6, 0.3, 1.0] {
        let through = dielectric(cos, 1.0);
        assert_eq!((through.reflectance, through.cos_t), (0.0, cos));
    }
}

/// `(m + 1) ∫ F μᵐ dμ` over a hemisphere of radiance, split at the critical angle where F has a corner.
fn moment(eta: f64, m: i32) -> f64 {
    let f = |mu: f64| f64::from(m + 1) * f64::from(dielectric(mu as f32, eta as f32).reflectance) * mu.powi(m);
    let critical = (1.0 - eta * eta).max(0.0).sqrt();
    adaptive_simpson(0.0, critical, 1e-7, f) + adaptive_simpson(critical, 1.0, 1e-7, f)
}

/// Rows `fresnel_diffuse_external`, `fresnel_diffuse_internal`, `fresnel_moment_C1_internal` and `_C2_internal` of
/// `refs/surface_ground_truths.csv`: exact quadrature, and `1 − (1 − R_ext)/n²` for the inside.
#[test]
fn diffuse_light_is_reflected_as_the_tables_say() {
    for (n, external, internal) in [
        (1.3, 0.0611318251579658, 0.444456701276903),
        (1.33, 0.0659308492994054, 0.471949148792699),
        (1.5, 0.0917779593423512, 0.596345759707712),
        (1.55, 0.0990658309285133, 0.625001386442669),
    ] {
        assert!((moment(n, 1) - external).abs() < 5e-7, "n = {n}: {}", moment(n, 1));
        assert!((moment(1.0 / n, 1) - internal).abs() < 5e-7, "n = {n}: {}", moment(1.0 / n, 1));
        assert!((1.0 - (1.0 - external) / (n * n) - internal).abs() < 1e-12);
    }
    for (n, second) in [(1.3, 0.300266959367914), (1.5, 0.464430522079691)] {
        assert!((moment(1.0 / n, 2) - second).abs() < 5e-7, "n = {n}: {}", moment(1.0 / n, 2));
    }
}

/// The textbook amplitudes with complex arithmetic in double precision.
fn complex_amplitudes(cos: f64, eta: f64, k: f64) -> f64 {
    type Complex = (f64, f64);
    let mul = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let norm = |a: Complex| a.0 * a.0 + a.1 * a.1;
    let n = (eta, k);
    let n2 = mul(n, n);
    // w = √(n² − sin²), the root in the first quadrant.
    let square = (n2.0 - (1.0 - cos * cos), n2.1);
    let radius = norm(square).sqrt();
    let re = (0.5 * (radius + square.0)).max(0.0).sqrt();
    let im = (0.5 * (radius - square.0)).max(0.0).sqrt();
    let s = norm((cos - re, -im)) / norm((cos + re, im));
    let p = norm((n2.0 * cos - re, n2.1 * cos - im)) / norm((n2.0 * cos + re, n2.1 * cos + im));
    0.5 * (s + p)
}

#[test]
fn metals_reflect_as_the_complex_amplitudes_say() {
    for (eta, k) in
        [(0.2f32, 3.0f32), (1.44, 1.6), (2.0, 0.0), (1.0, 200.0), (1.0, 0.01), (0.05, 8.0), (0.0, 1.0), (50.0, 50.0)]
    {
        for i in 0..=1000 {
            let cos = i as f32 / 1000.0;
            let exact = complex_amplitudes(f64::from(cos), f64::from(eta), f64::from(k));
            let f = conductor(cos, Lanes::splat(eta), Lanes::splat(k)).lane(0);
            assert!((f64::from(f) - exact).abs() < 2e-6, "{eta} + {k}i at {cos}: {f} for {exact}");
            assert!((0.0..=1.000_001).contains(&f));
        }
    }
}

/// Without absorption a metal is a dielectric.
#[test]
fn a_metal_without_extinction_is_a_dielectric() {
    for eta in [0.7f32, 1.5] {
        for i in 1..=100 {
            let cos = i as f32 / 100.0;
            let metal = conductor(cos, Lanes::splat(eta), Lanes::ZERO).lane(2);
            assert!((metal - dielectric(cos, eta).reflectance).abs() < 1e-6, "{eta} at {cos}: {metal}");
        }
    }
}

#[test]
fn a_metal_of_given_reflectance_has_it_at_normal_incidence() {
    use tyndall::bsdf::Bsdf;
    use tyndall::math::{Vec2, Vec3};
    let wanted = Lanes::new([0.0, 0.3, 0.9, 0.999]);
    let sample = Bsdf::conductor_of_reflectance(wanted, 0.0, 0.0).sample(Vec3::Z, 0.5, Vec2::ZERO).unwrap();
    assert!((sample.weight - wanted).map(f32::abs).max_lane() < 1e-6, "{sample:?}");
}
