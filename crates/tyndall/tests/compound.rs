//! Materials that are made of others: mixtures, holes, two faces. Worlds whose radiance is known in closed form.

mod common;

use common::{World, assert_mean, diffuse, glass, measure, medium};
use std::f64::consts::FRAC_1_PI;

use tyndall::{
    integrator::{Analog, Integrator, VolPath},
    light::{AreaLight, Distant, EmitterShape, Light},
    material::Material,
    math::Vec3,
    medium::Homogeneous,
    render::{Settings, render},
    sampling::SamplerKind,
    spectrum::Spectrum,
};

fn integrators() -> [(&'static str, Box<dyn Integrator>); 2] {
    [("volpath", Box::new(VolPath::default())), ("analog", Box::new(Analog))]
}

/// From above, straight down on the slab's face y = 0, or on what stands above it.
fn from_above() -> World {
    World::seen(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO)
}

fn plate(world: &mut World, material: Material) {
    world.cuboid(Vec3::new(-50.0, -0.5, -50.0), Vec3::new(50.0, 0.0, 50.0), material, None);
}

/// A convex body under a uniform sky sends back the part ρ of what falls on it; of two mixed the mean (1 − w)·ρ₁ + w·ρ₂:
/// 0.75·0.8 + 0.25·0.2 = 0.65. Mixed again, half with a black one: 0.325.
#[test]
fn a_mixture_reflects_the_mean_of_its_parts() {
    for (name, integrator) in integrators() {
        let mut world = from_above();
        let mix = world.mix(diffuse(0.8), diffuse(0.2), 0.25);
        plate(&mut world, mix);
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 60_000), [0.65; 3], 0.02);

        let mut world = from_above();
        let mix = world.mix(diffuse(0.8), diffuse(0.2), 0.25);
        let nested = world.mix(mix, diffuse(0.0), 0.5);
        plate(&mut world, nested);
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 60_000), [0.325; 3], 0.02);
    }
}

/// In a furnace nothing can be seen: a white body with holes, half of it glass, before a sky of radiance 1.
#[test]
fn a_white_body_with_holes_in_a_furnace_vanishes() {
    for (name, integrator) in integrators() {
        let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
        let body = world.mix(diffuse(1.0), glass(1.5, 0.3), 0.0);
        let pierced = world.mix(Material::Hole, body, 0.6);
        world.sphere(Vec3::ZERO, 1.0, pierced, None);
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 60_000), [1.0; 3], 0.01);
    }
}

/// A black plate of opacity 0.3 before the sky shows 0.7 of it, twice in a row (front and back of a closed body) 0.49. A
/// floor of reflectance 0.5 below it, lit from the zenith with irradiance π, has radiance 0.5 · 0.49; seen past the plate,
/// from below it.
#[test]
fn what_is_open_in_part_dims_the_view_and_the_shadow() {
    for (name, integrator) in integrators() {
        let mut world = from_above();
        let pierced = world.mix(Material::Hole, diffuse(0.0), 0.3);
        plate(&mut world, pierced);
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 100_000), [0.49; 3], 0.01);

        let mut world = World::seen(Vec3::new(0.0, -2.0, 3.0), Vec3::new(0.0, -4.0, 0.0));
        let pierced = world.mix(Material::Null, diffuse(0.0), 0.3);
        plate(&mut world, pierced);
        world.cuboid(Vec3::new(-50.0, -5.0, -50.0), Vec3::new(50.0, -4.0, 50.0), diffuse(0.5), None);
        let irradiance = Spectrum::unbounded_rgb([std::f32::consts::PI; 3]);
        world.lights.push(Light::Distant(Distant { towards: Vec3::Y, irradiance, luminance: 1.0 }));
        assert_mean(name, &world.measure(&*integrator, 30_000), [0.245; 3], 0.01);
    }
}

/// Through a hole light stays in its medium, across a boundary it enters the one inside: a ball of σ_a = 1 and radius 1
/// takes exp(−2) along its axis, seen past its open material, and nothing, seen past its holes. Of half boundary, half black:
/// front and back each let half through.
#[test]
fn a_hole_leads_into_no_medium_and_a_boundary_does() {
    for (name, integrator) in integrators() {
        let cases = [
            (Material::Hole, 1.0, 0.0),
            (Material::Null, (-2f64).exp(), 0.0),
            (Material::Null, 0.25 * (-2f64).exp(), 0.5),
        ];
        for (open, expected, black) in cases {
            let mut world = World::seen(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
            let skin = world.mix(open, diffuse(0.0), black);
            world.sphere(Vec3::ZERO, 1.0, skin, Some(medium([1.0; 3], [0.0; 3], 0.0)));
            world.sky(1.0);
            assert_mean(name, &world.measure(&*integrator, 200_000), [expected; 3], 0.03);
        }
    }
}

/// The face towards the normal and the other one: ρ = 0.7 from outside; from inside, a ball of ρ = 0.4 around a light in
/// its middle that nothing else sees: L = E ρ/π (1 + ρ + ρ² …) at distance 1, E = I/r² = 1.
#[test]
fn each_face_has_its_own_material() {
    for (name, integrator) in integrators() {
        let faces = |world: &mut World| {
            let (outside, inside) = (world.part(diffuse(0.7)), world.part(diffuse(0.4)));
            Material::TwoFaced { outside, inside }
        };
        let mut world = from_above();
        let two = faces(&mut world);
        plate(&mut world, two);
        world.sky(1.0);
        assert_mean(name, &world.measure(&*integrator, 40_000), [0.7; 3], 0.01);

        let mut world = World::seen(Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.3, 0.0, -1.0));
        let two = faces(&mut world);
        world.sphere(Vec3::ZERO, 1.0, two, None);
        let intensity = Spectrum::unbounded_rgb([1.0; 3]);
        world.lights.push(Light::Point(tyndall::light::PointLight { position: Vec3::ZERO, intensity, luminance: 1.0 }));
        // The point light makes E = 1 everywhere; what the wall sends on makes a uniform E' = ρ (E + E').
        let expected = 0.4 / (1.0 - 0.4) * FRAC_1_PI;
        assert_mean(name, &world.measure(&*integrator, 100_000), [expected; 3], 0.01);
    }
}

/// A light of opacity a shines with a of its radiance, met or sampled; one that is not there at all (pbrt's `alpha` 0) shines
/// on others with all of it and is not seen. A disk of radius R at height h over a floor: E = π L R²/(R² + h²) = π/2 for
/// R = h = 1, L = 1, so the floor of ρ = 0.5 under it has radiance 0.25.
#[test]
fn a_light_with_holes_shines_with_what_is_left_and_one_that_is_not_there_with_all() {
    for (name, integrator) in integrators() {
        for (opacity, expected) in [(1.0, 0.25), (0.4, 0.1), (0.0, 0.25)] {
            let mut world = World::seen(Vec3::new(0.9, 0.1, 0.9), Vec3::ZERO);
            world.cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 0.0, 9.0), diffuse(0.5), None);
            let pierced = world.mix(Material::Hole, diffuse(0.0), opacity);
            world.shining_disk(1.0, 1.0, pierced, 1.0);
            let Some(Light::Area(light)) = world.lights.last_mut() else { panic!() };
            light.opacity = opacity;
            assert_mean(&format!("{name}, {opacity}"), &world.measure(&*integrator, 200_000), [expected; 3], 0.02);
        }
    }
    let light = AreaLight {
        shape: EmitterShape::Disk { centre: Vec3::ZERO, ng: Vec3::Y, radius: 1.0, inner: 0.0 },
        radiance: Spectrum::constant(1.0),
        luminance: 1.0,
        two_sided: false,
        opacity: 0.0,
        pattern: None,
    };
    let from = tyndall::light::Reference { p: Vec3::Y, normal: None };
    assert!(light.sample(&from, tyndall::math::Vec2::splat(0.3), &tyndall::spectrum::Wavelengths::Rgb).unwrap().dirac);
}

/// Two layers of a glowing absorber, σ_a = 1 and 1 thick, with a mere boundary between them, are one of thickness 2:
/// L = 1 − exp(−2), also where the numbers of a path are stratified and a boundary must not see the same one twice.
#[test]
fn a_boundary_between_equal_media_changes_nothing_for_stratified_numbers() {
    let mut world = from_above();
    let glowing = || {
        let emission = Some(Spectrum::illuminant_rgb([1.0; 3]));
        Homogeneous { emission, ..medium([1.0; 3], [0.0; 3], 0.0) }
    };
    for y in [-1.0, -2.0] {
        let (min, max) = (Vec3::new(-50.0, y, -50.0), Vec3::new(50.0, y + 1.0, 50.0));
        world.cuboid(min, max, Material::Null, Some(glowing()));
    }
    let scene = world.scene();
    let expected = 1.0 - (-2f64).exp();
    assert_mean("independent", &measure(&scene, &VolPath::default(), 100_000), [expected; 3], 0.01);
    let settings = Settings { spp: 1 << 16, seed: 1, sampler: SamplerKind::Sobol, ..Settings::default() };
    let rendering = render(&scene, &VolPath::default(), &settings, &());
    let pixel = rendering.film.pixel(0, 0).unwrap();
    let mean = pixel.sum[0] / pixel.count as f64;
    // A binomial of this many independent samples has the standard error √(p(1−p)/n) = 1.3e-3; Sobol's is less.
    assert!((mean - expected).abs() < 4.0 * 1.34e-3, "{mean}, not {expected}");
}
