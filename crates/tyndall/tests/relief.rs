//! Bump and normal maps: what they do to light in closed form, and what they must leave alone.

mod common;

use std::sync::Arc;

use common::{World, assert_mean, diffuse, glass, measure, medium};
use testkit::Stream;
use tyndall::{
    bsdf::{Bsdf, Sides},
    feature::{Facing, Feature, FirstHit, Space},
    integrator::{Analog, Integrator, VolPath},
    light::{Distant, Light},
    material::{Material, Metal, Roughness},
    math::{Ray, Transform, Vec2, Vec3},
    path::Vertex,
    relief::{Map, Relief, Rule},
    sampling::{Sampler, SamplerKind},
    scene::{MaterialId, Scene},
    shape::Mesh,
    spectrum::{Lanes, Spectrum, Wavelengths},
    texture::{Grey, ImageTexture, Interpolation, Mapping2, Picture, Texture, Wrap},
};

const MITSUBA: Rule = Rule::Mitsuba { flips: true, shadows: true, mirrored: false };
const PLAIN: Rule = Rule::Mitsuba { flips: false, shadows: false, mirrored: false };

fn picture(width: u32, pixels: Vec<[f32; 3]>) -> Texture {
    Texture::Image(ImageTexture {
        picture: Arc::new(Picture { width, height: pixels.len() as u32 / width, pixels }),
        mapping: Mapping2::UV,
        wrap: Wrap::Repeat,
        interpolation: Interpolation::Bilinear,
        scale: 1.0,
        invert: false,
        grey: Grey::Mean,
        least: f32::MIN,
        most: f32::MAX,
    })
}

/// The same normal everywhere, in the shading frame.
fn leaning(n: [f32; 3]) -> Map {
    Map::Normals(picture(1, vec![n.map(|v| 0.5 * (v + 1.0))]))
}

/// Bumps, 4 by 4 over the parameters.
fn bumps(scale: f32) -> Map {
    let heights = [0.0, 0.7, 0.2, 1.0, 0.4, 0.1, 0.9, 0.3, 0.6, 0.8, 0.0, 0.5, 0.2, 1.0, 0.4, 0.7];
    Map::Heights { texture: picture(4, heights.map(|h| [h; 3]).to_vec()), scale }
}

fn embossed(world: &mut World, material: Material, map: Map, rule: Rule) -> Material {
    Material::Embossed { of: world.part(material), relief: Box::new(Relief { map, rule }) }
}

/// A square at y = 0 that faces +y, with u along +x and v along −z.
fn plate(world: &mut World, material: Material) {
    world.object(material, None);
    let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z) * 50.0;
    let mesh = Mesh {
        positions: vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        ..Mesh::default()
    };
    world.builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
}

fn integrators() -> [(&'static str, Box<dyn Integrator>); 2] {
    [("volpath", Box::new(VolPath::default())), ("analog", Box::new(Analog))]
}

/// ρ = 0.6 leaning by n′ = (0.6, 0.8) towards light of irradiance π from l = (1/2, √3/2): `L = ρ n′·l G`, with
/// n′·l = 0.3 + 0.4√3 and, in Mitsuba, α² = (0.6/0.8)²/8, `G = 2/(1 + √(1 + α²/3))`. From low behind the lean, the normal
/// faces away from the viewer: in Mitsuba it is turned to n′ = (−0.6, 0.8); in pbrt the viewer sees its other side, which is
/// dark.
#[test]
fn a_leaning_surface_is_lit_by_its_own_cosine() {
    let root = 3f64.sqrt();
    let shadowing = 2.0 / (1.0 + (1.0 + 0.5625f64 / 8.0 / 3.0).sqrt());
    let low = Vec3::new(-5.0, 1.0, 0.0);
    let high = Vec3::new(0.0, 5.0, 0.0);
    let cases = [
        (MITSUBA, high, (0.3 + 0.4 * root) * shadowing),
        (PLAIN, high, 0.3 + 0.4 * root),
        (Rule::Pbrt, high, 0.3 + 0.4 * root),
        (MITSUBA, low, (0.4 * root - 0.3) * shadowing),
        (PLAIN, low, 0.0),
        (Rule::Pbrt, low, 0.0),
    ];
    for (rule, eye, expected) in cases {
        let mut world = World::seen(eye, Vec3::ZERO);
        let material = embossed(&mut world, diffuse(0.6), leaning([0.6, 0.0, 0.8]), rule);
        plate(&mut world, material);
        let towards = Vec3::new(0.5, 0.75f32.sqrt(), 0.0);
        let irradiance = Spectrum::unbounded_rgb([std::f32::consts::PI; 3]);
        world.lights.push(Light::Distant(Distant { towards, irradiance, luminance: 1.0 }));
        let scene = world.scene();
        for (name, integrator) in integrators() {
            // The naive twin follows one channel at a time.
            let found = measure(&scene, &*integrator, 16).mean.iter().sum::<f64>() / 3.0;
            assert!(
                (found - 0.6 * expected).abs() < 1e-5,
                "{name} {rule:?} {eye}: {found}, expected {}",
                0.6 * expected
            );
        }
    }
}

/// A normal map that says (0, 0, 1), and heights that are the same everywhere, turn the normal by no more than rounding.
#[test]
fn a_flat_relief_is_none() {
    let level = || Map::Heights { texture: picture(1, vec![[0.25; 3]]), scale: 2.0 };
    for rule in [MITSUBA, PLAIN, Rule::Pbrt] {
        for map in [leaning([0.0, 0.0, 1.0]), level()] {
            let (scene, id) = ball(diffuse(0.5), map, rule);
            let mut stream = Stream::new(4);
            for _ in 0..1000 {
                let at = Vec3::new(stream.next_f32(), stream.next_f32(), stream.next_f32()) - 0.5;
                let ray = Ray::new(at, at.normalize());
                let hit = scene.geometry.intersect(&ray, 100.0).unwrap();
                let hit = scene.geometry.interaction(&ray, &hit);
                let bsdf = Bsdf::diffuse(Lanes::ONE);
                let [even, found] =
                    [None, Some(id)].map(|relief| match Vertex::met(&scene, hit, bsdf, ray.dir, relief) {
                        Vertex::Surface { frame, shadowing, .. } => (frame, shadowing),
                        Vertex::Medium { .. } => panic!(),
                    });
                let apart = (even.0.n - found.0.n).length() + (even.0.s - found.0.s).length();
                assert!(apart < 1e-5, "{rule:?}: {even:?} {found:?}");
                assert!(found.1.is_none_or(|alpha2| alpha2 < 1e-10), "{rule:?}: {found:?}");
            }
        }
    }
}

/// A relief leans along the parameters of the surface, on a mirror as on chalk.
#[test]
fn a_mirror_leans_as_chalk_does() {
    for rule in [MITSUBA, PLAIN, Rule::Pbrt] {
        for map in [leaning([0.5, -0.3, 0.7]), bumps(0.5)] {
            let (scene, id) = ball(diffuse(0.5), map, rule);
            let mut stream = Stream::new(5);
            for _ in 0..1000 {
                let at = Vec3::new(stream.next_f32(), stream.next_f32(), stream.next_f32()) - 0.5;
                let ray = Ray::new(at.normalize() * 3.0, -at.normalize());
                let hit = scene.geometry.interaction(&ray, &scene.geometry.intersect(&ray, 100.0).unwrap());
                let mirror = Bsdf::conductor_of_reflectance(Lanes::splat(0.5), 0.0, 0.0);
                let [chalk, mirror] = [Bsdf::diffuse(Lanes::ONE), mirror].map(|bsdf| {
                    let Vertex::Surface { frame, .. } = Vertex::met(&scene, hit, bsdf, ray.dir, Some(id)) else {
                        panic!()
                    };
                    frame
                });
                assert_eq!(chalk, mirror, "{rule:?}");
            }
        }
    }
}

/// The layer of shading normals has those of the relief, that of true normals has not.
#[test]
fn the_layer_of_shading_normals_shows_the_relief() {
    let mut world = World::seen(Vec3::Y * 5.0, Vec3::ZERO);
    let material = embossed(&mut world, diffuse(0.6), leaning([0.6, 0.0, 0.8]), MITSUBA);
    plate(&mut world, material);
    world.sky(1.0);
    let scene = world.scene();
    let first = FirstHit::of(&scene, (0, 0), [0.4, 0.4, 0.5, 0.5]);
    let mut sampler = Sampler::new(SamplerKind::Independent, (0, 0), 0, 1);
    for (feature, expected) in [
        (Feature::ShadingNormal(Space::World, Facing::Outward), Vec3::new(0.6, 0.8, 0.0)),
        (Feature::GeometricNormal(Space::World, Facing::Outward), Vec3::Y),
    ] {
        let [x, y, z, weight] = first.sample(feature, &Wavelengths::Rgb, &mut sampler);
        assert!((Vec3::new(x, y, z) / weight - expected).length() < 1e-5, "{feature:?}: {x} {y} {z}");
    }
}

/// Glass of the index of its surroundings lets light straight on, however uneven: a ball of σ_a = 1 takes exp(−2), and no
/// path comes out on the wrong side. Of index 1.4 and with scattering, the two integrators agree, under a sky that is
/// not the same above and below.
#[test]
fn a_relief_leaves_the_sides_of_a_surface_alone() {
    for rule in [PLAIN, MITSUBA, Rule::Pbrt] {
        for (name, integrator) in integrators() {
            // Shadowing takes its part of what goes straight on too.
            if rule != MITSUBA {
                let mut world = World::seen(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
                let skin = embossed(&mut world, glass(1.0, 0.0), bumps(0.3), rule);
                world.sphere(Vec3::ZERO, 1.0, skin, Some(medium([1.0; 3], [0.0; 3], 0.0)));
                world.sky(1.0);
                assert_mean(name, &world.measure(&*integrator, 100_000), [(-2f64).exp(); 3], 0.02);
            }
        }
        let ball = || {
            let mut world = World::seen(Vec3::new(0.0, 0.4, 5.0), Vec3::new(0.1, 0.3, 0.0));
            let skin = embossed(&mut world, glass(1.4, 0.0), bumps(0.3), rule);
            world.sphere(Vec3::ZERO, 1.0, skin, Some(medium([0.1; 3], [2.0; 3], 0.3)));
            world.half_sky(1.0, 0.2);
            world
        };
        let [a, b] = [ball().measure(&VolPath::default(), 60_000), ball().measure(&Analog, 120_000)];
        let z = (a.mean[0] - b.mean[0]) / a.standard_error[0].hypot(b.standard_error[0]);
        assert!(z.abs() < 4.5, "{rule:?}: {a:?} {b:?}, z = {z}");
    }
}

/// A ball of an embossed material, and the id of that.
fn ball(material: Material, map: Map, rule: Rule) -> (Scene, MaterialId) {
    let mut world = World::seen(Vec3::Z * 5.0, Vec3::ZERO);
    let material = embossed(&mut world, material, map, rule);
    world.sphere(Vec3::ZERO, 1.0, material, None);
    let id = MaterialId(world.materials.len() as u32 - 1);
    world.sky(1.0);
    (world.scene(), id)
}

/// The weight of a direction drawn is `f |cos| / pdf` as light sampling evaluates them, the shadowing of the relief
/// included; and at a boundary no direction crosses the true surface where the BSDF reflects.
#[test]
fn weights_are_values_over_densities_on_a_relief() {
    let metal = Material::Conductor {
        metal: Metal::Mirror,
        alpha: Roughness::constant([0.4, 0.2]),
        tint: 1.0.into(),
        sides: Sides::Both,
    };
    let mut drawn = 0;
    for material in [diffuse(0.8), metal, glass(1.5, 0.4)] {
        for rule in [MITSUBA, PLAIN, Rule::Pbrt, Rule::Mitsuba { flips: true, shadows: true, mirrored: true }] {
            for map in [bumps(0.5), leaning([0.5, -0.3, 0.7])] {
                let (scene, id) = ball(material.clone(), map, rule);
                let mut stream = Stream::new(3);
                let mut random = move || stream.next_f32();
                for i in 0..4000 {
                    let turn = std::f32::consts::TAU * random();
                    let at = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
                    // From outside, and from inside.
                    let origin = if i % 2 == 0 { Vec3::new(turn.cos(), 0.3, turn.sin()) * 3.0 } else { at };
                    let ray = Ray::new(origin, if i % 2 == 0 { at - origin } else { at + Vec3::Y }.normalize());
                    let Some(hit) = scene.geometry.intersect(&ray, 100.0) else { continue };
                    let hit = scene.geometry.interaction(&ray, &hit);
                    let (even, relief) = scene.meet(&hit, ray.dir, || 0.5);
                    assert_eq!(relief, Some(id));
                    let bsdf = even.bsdf(&(&hit).into(), &Wavelengths::Rgb, 0);
                    let vertex = Vertex::met(&scene, hit, bsdf, ray.dir, relief);
                    let Some(scattered) = vertex.sample([random(), random(), random()]) else { continue };
                    let (value, pdf) = vertex.eval(scattered.ray.dir);
                    let (found, expected) = (value.lane(0) / pdf, scattered.weight.lane(0));
                    // A direction of the world is rounded, which moves a grazing one against the relief.
                    let Vertex::Surface { frame, .. } = &vertex else { panic!("on a surface") };
                    let rounding = 4.0 * f32::EPSILON / frame.n.dot(scattered.ray.dir).abs();
                    assert!((found - expected).abs() <= (2e-3 + rounding) * expected, "{rule:?}: {found} {expected}");
                    assert!((scattered.pdf / pdf - 1.0).abs() < 2e-3, "{rule:?}: {pdf} {}", scattered.pdf);
                    let crosses = ray.dir.dot(hit.ng) * scattered.ray.dir.dot(hit.ng) > 0.0;
                    if even.index().is_some() {
                        assert_eq!(crosses, scattered.crossed, "{rule:?}");
                    }
                    drawn += 1;
                }
            }
        }
    }
    assert!(drawn > 20_000, "{drawn}");
}
