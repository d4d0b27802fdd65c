//! Form factors of emitters, and that densities are those of the samples.

use super::*;

fn light(shape: EmitterShape) -> AreaLight {
    AreaLight {
        shape,
        radiance: Spectrum::constant(1.0),
        luminance: 1.0,
        two_sided: false,
        opacity: 1.0,
        pattern: None,
    }
}

/// Irradiance of a uniform emitter on a plane that faces it, over π: the form factor from a point.
fn irradiance_over_pi(light: &AreaLight, n: u32) -> f64 {
    let from = Reference { p: Vec3::ZERO, normal: Some(Vec3::Z) };
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
            if let Some(s) = light.sample(&from, u, &Wavelengths::Rgb) {
                sum += f64::from(s.li.lane(0) * s.dir.z.max(0.0) / s.pdf) / std::f64::consts::PI;
            }
        }
    }
    sum / f64::from(n * n)
}

/// `surface_ground_truths.csv`: unit square on the axis at height 1; sphere of r = 0.5 at d = 2: (r/d)²;
/// a disk of radius R at height h: R²/(R² + h²); a ring is the difference of two.
#[test]
fn uniform_emitters_give_the_irradiance_of_their_form_factors() {
    let down = -Vec3::Z;
    let square = EmitterShape::Parallelogram { a: Vec3::new(-0.5, -0.5, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: down };
    let halves = [
        EmitterShape::Triangle { a: Vec3::new(-0.5, -0.5, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: down },
        EmitterShape::Triangle { a: Vec3::new(0.5, 0.5, 1.0), e1: -Vec3::Y, e2: -Vec3::X, ng: down },
    ];
    let sphere = EmitterShape::Sphere { centre: 2.0 * Vec3::Z, radius: 0.5, inward: false };
    let ring = EmitterShape::Disk { centre: 2.0 * Vec3::Z, ng: down, radius: 1.0, inner: 0.5 };
    let check = |name: &str, value: f64, expected: f64| {
        assert!((value / expected - 1.0).abs() < 2e-4, "{name}: {value}, expected {expected}");
    };
    check("square", irradiance_over_pi(&light(square), 200), 0.239_456_470_460_774);
    let both = halves.iter().map(|t| irradiance_over_pi(&light(*t), 400)).sum();
    check("triangles", both, 0.239_456_470_460_774);
    check("sphere", irradiance_over_pi(&light(sphere), 200), 0.0625);
    check("ring", irradiance_over_pi(&light(ring), 400), 1.0 / 5.0 - 0.25 / 4.25);
}

#[test]
fn the_density_of_a_sample_is_the_density_of_its_point() {
    let shapes = [
        EmitterShape::Parallelogram { a: Vec3::new(-0.5, 0.2, 1.0), e1: Vec3::Y, e2: Vec3::X, ng: -Vec3::Z },
        EmitterShape::Sphere { centre: Vec3::new(1.0, 1.0, 2.0), radius: 0.5, inward: false },
        EmitterShape::Disk { centre: Vec3::new(0.3, 0.0, 2.0), ng: -Vec3::Z, radius: 1.0, inner: 0.0 },
    ];
    let from = Reference { p: Vec3::ZERO, normal: None };
    for shape in shapes {
        let light = light(shape);
        for i in 0..100 {
            let u = Vec2::new((i as f32 * 0.618) % 1.0, (i as f32 * 0.414) % 1.0);
            let s = light.sample(&from, u, &Wavelengths::Rgb).unwrap();
            let Target::Surface { p, ng, .. } = s.target else { panic!() };
            let pdf = light.pdf(&from, p, ng);
            assert!((pdf / s.pdf - 1.0).abs() < 1e-3, "{shape:?}: {pdf} {}", s.pdf);
        }
    }
}

#[test]
fn nothing_shines_behind_a_one_sided_emitter() {
    let disk = light(EmitterShape::Disk { centre: Vec3::Z, ng: Vec3::Z, radius: 1.0, inner: 0.0 });
    let from = Reference { p: Vec3::ZERO, normal: None };
    assert!(disk.sample(&from, Vec2::new(0.3, 0.4), &Wavelengths::Rgb).is_none());
    assert_eq!(disk.importance(from.p), 0.0);
}
