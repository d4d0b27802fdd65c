//! The choice among many lights, over random scenes: probabilities are those of the draws, and no light that shines
//! somewhere is passed over there.

use testkit::{Family, Stream, chi_square};
use tyndall::light::{
    AreaLight, Beam, ConstantEnvironment, Distant, EmitterShape, Even, Falloff, Goniometric, Light, LightId,
    LightTable, PointLight, Portal, Projector, Reference, Revolved, SkyImage, Slide, SpotLight, Target,
};
use tyndall::math::{Ray, Transform, Vec2, Vec3};
use tyndall::sampling::warp;
use tyndall::shape::{Cylinder, Disk, Geometry, GeometryBuilder, Patch, Shape, ShapeError, Sphere, SpherePart, Turn};
use tyndall::spectrum::{Spectrum, Wavelengths};

fn next_2d(stream: &mut Stream) -> Vec2 {
    Vec2::new(stream.next_f32(), stream.next_f32())
}

fn next_3d(stream: &mut Stream) -> Vec3 {
    Vec3::new(stream.next_f32(), stream.next_f32(), stream.next_f32())
}

fn next_direction(stream: &mut Stream) -> Vec3 {
    warp::uniform_sphere(next_2d(stream))
}

fn point(position: Vec3, luminance: f32) -> Light {
    Light::Point(PointLight { position, intensity: Spectrum::constant(luminance), luminance })
}

fn area(shape: EmitterShape, luminance: f32, two_sided: bool) -> Light {
    Light::Area(AreaLight {
        shape,
        radiance: Spectrum::constant(luminance),
        luminance,
        two_sided,
        opacity: 1.0,
        pattern: None,
    })
}

fn triangle(a: Vec3, e1: Vec3, e2: Vec3) -> EmitterShape {
    EmitterShape::Triangle { a, e1, e2, ng: e1.cross(e2).normalize_or_zero() }
}

/// A space at `at` with +z along `axis`.
fn placed(at: Vec3, axis: Vec3) -> Transform {
    let turn = glam::DQuat::from_rotation_arc(glam::DVec3::Z, axis.as_dvec3().normalize());
    Transform::new(glam::DMat4::from_rotation_translation(turn, at.as_dvec3())).unwrap()
}

/// A light of any kind near `at`.
fn any_light(stream: &mut Stream, at: Vec3) -> Light {
    let luminance = 0.01 + stream.next_f32().powi(8) * 100.0;
    let (d, e) = (next_direction(stream), next_direction(stream));
    match (stream.next_f32() * 12.0) as u32 {
        0 => point(at, luminance),
        1 => Light::Spot(SpotLight {
            position: at,
            axis: d,
            intensity: Spectrum::constant(luminance),
            luminance,
            cos_inner: 0.9,
            cos_outer: -0.2 + stream.next_f32(),
            falloff: Falloff::LinearAngle,
            slide: None,
        }),
        8 => Light::Beam(Beam {
            shape: triangle(at, d * 0.3, e * 0.4),
            exitance: Spectrum::constant(luminance),
            luminance,
        }),
        9 => Light::Goniometric(Box::new(Goniometric {
            to_world: placed(at, d),
            intensity: Spectrum::constant(luminance),
            luminance,
            side: 2,
            shares: vec![0.0, 0.3, 1.0, 0.0],
        })),
        10 => Light::Projector(Box::new(Projector {
            position: at,
            slide: Slide { to_world: placed(at, d), half: Vec2::new(0.7, 0.4), texture: 1.0.into() },
            intensity: Spectrum::constant(luminance),
            even: if e.x > 0.0 { Even::Intensity } else { Even::Irradiance },
            luminance,
        })),
        11 => {
            let corners = [Vec3::ZERO, d * 0.1, e * 0.05, d.cross(e) * 0.1 + (d + e) * 0.05].map(|c| at + c);
            area(EmitterShape::Patch(Patch::new(corners)), luminance, e.x > 0.0)
        }
        2 => area(EmitterShape::Sphere { centre: at, radius: 0.01, inward: e.x > 0.0 }, luminance, false),
        3 => area(EmitterShape::Disk { centre: at, ng: d, radius: 0.03, inner: 0.01 }, luminance, e.x > 0.0),
        4 => {
            let sphere = Sphere::new(at, 0.02).cut(SpherePart::new(0.02, [0.0, 0.01], Turn::degrees(90.0)));
            area(EmitterShape::Revolved(Revolved::sphere(&sphere)), luminance, e.x > 0.0)
        }
        _ => area(triangle(at, d * 0.1, e * 0.05), luminance, e.x > 0.0),
    }
}

/// Scenes of many lights, from orderly to degenerate.
fn scenes() -> Vec<(&'static str, Vec<Light>)> {
    let mut stream = Stream::new(7);
    let s = &mut stream;
    let scattered = (0..200)
        .map(|_| {
            let at = next_3d(s);
            any_light(s, at)
        })
        .collect::<Vec<_>>();
    let mut with_skies = scattered.clone();
    with_skies.push(Light::Constant(ConstantEnvironment { radiance: Spectrum::constant(0.3), luminance: 0.3 }));
    let sun = |towards| Light::Distant(Distant { towards, irradiance: Spectrum::constant(2.0), luminance: 2.0 });
    with_skies.extend([sun(Vec3::Z), sun(Vec3::X)]);
    let window = [Vec3::ZERO, Vec3::Y, Vec3::new(1.0, 1.0, 0.0), Vec3::X];
    let sky = SkyImage::new(1, 1, &[[0.4; 3]], 1.0).unwrap();
    with_skies.push(Light::Portal(Box::new(Portal::new(window, &Transform::IDENTITY, &sky).unwrap())));
    let ceiling = (0..300).map(|_| {
        let at = Vec3::new(s.next_f32(), s.next_f32(), 1.0);
        area(triangle(at, Vec3::Y * 0.02, Vec3::X * 0.02), 1.0, false)
    });
    let ceiling = ceiling.collect();
    let line = (0..40).map(|i| point(Vec3::X * i as f32, 1.0 + i as f32)).collect();
    let heap = (0..40).map(|i| point(Vec3::ONE, 1.0 + i as f32)).collect();
    let needles = (0..40).map(|i| area(triangle(Vec3::Y * i as f32, Vec3::X, Vec3::X), 1.0, false)).collect();
    let suns = (0..40).map(|i| sun(Vec3::new(i as f32, 1.0, 2.0).normalize())).collect();
    let few = (0..9)
        .map(|_| {
            let at = next_3d(s);
            any_light(s, at)
        })
        .collect();
    vec![
        ("scattered", scattered),
        ("with skies", with_skies),
        ("ceiling", ceiling),
        ("line", line),
        ("heap", heap),
        ("needles", needles),
        ("suns", suns),
        ("few", few),
    ]
}

/// Places among the lights, far away, on a light; on surfaces and in media.
fn references(stream: &mut Stream) -> Vec<Reference> {
    let mut all = vec![
        Reference { p: Vec3::ONE, normal: None },
        Reference { p: Vec3::ONE, normal: Some(Vec3::Z) },
        Reference { p: Vec3::new(1e6, -1e6, 3.0), normal: None },
        Reference { p: Vec3::new(0.5, 0.5, 1.0), normal: Some(-Vec3::Z) },
    ];
    for _ in 0..6 {
        let p = next_3d(stream) * 1.5 - 0.25;
        all.push(Reference { p, normal: None });
        all.push(Reference { p, normal: Some(next_direction(stream)) });
    }
    all
}

/// The histogram of the lights drawn is that of the probabilities; what they leave to 1 is how often none is drawn.
#[test]
fn lights_are_drawn_as_often_as_their_probabilities_say() {
    let mut family = Family::new("choice of lights", 0.01);
    let mut stream = Stream::new(8);
    for (name, lights) in scenes() {
        let count = lights.len();
        let table = LightTable::new(lights);
        for from in references(&mut stream) {
            let mut expected: Vec<f64> =
                (0..count).map(|i| f64::from(table.probability(&from, LightId(i as u32)))).collect();
            let total: f64 = expected.iter().sum();
            assert!(total < 1.0 + 1e-5, "{name} from {from:?}: probabilities sum to {total}");
            expected.push((1.0 - total).max(0.0));
            let mut observed = vec![0u64; count + 1];
            for _ in 0..20_000 {
                match table.choose(&from, stream.next_f32()) {
                    Some((id, probability)) => {
                        let p = table.probability(&from, id);
                        assert!((probability / p - 1.0).abs() < 1e-5, "{name} from {from:?}: {probability}, {p}");
                        observed[id.0 as usize] += 1;
                    }
                    None => observed[count] += 1,
                }
            }
            let name = format!("{name} from {from:?}");
            // Where one outcome has all but a few of the draws there is no second cell for χ²: their number is Poisson.
            let (sure, most) = expected.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            let rest = (1.0 - most) * 20_000.0;
            if rest > 20.0 {
                family.check(&name, chi_square(&observed, &expected));
            } else {
                assert!((20_000 - observed[sure]) as f64 <= rest + 6.0 * rest.sqrt() + 6.0, "{name}: {observed:?}");
            }
        }
    }
    family.finish();
}

/// Next event estimation needs every light that could reach the point.
#[test]
fn every_light_that_shines_at_a_point_has_a_chance_there() {
    let mut stream = Stream::new(9);
    let mut seen = 0;
    for (name, lights) in scenes() {
        let table = LightTable::new(lights.clone());
        for _ in 0..300 {
            for from in references(&mut stream) {
                let index = ((stream.next_f32() * lights.len() as f32) as usize).min(lights.len() - 1);
                let Some(s) = lights[index].sample(&from, next_2d(&mut stream), &Wavelengths::Rgb) else { continue };
                if from.normal.is_none_or(|n| n.dot(s.dir) > 0.0) {
                    let p = table.probability(&from, LightId(index as u32));
                    assert!(p > 0.0 && p <= 1.0, "{name}: light {index} from {from:?} shines, and has {p}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 10_000, "{seen}");
}

/// Cylinders and parts of disks and spheres, round and squeezed, shining out and in, with what emits there.
fn revolved() -> Vec<(&'static str, Geometry, EmitterShape)> {
    let columns = |x: [f32; 3], y: [f32; 3], z: [f32; 3]| {
        let column = |c: [f32; 3]| glam::DVec3::from_array(c.map(f64::from)).extend(0.0);
        let at = glam::DVec4::new(0.1, 0.2, 1.5, 1.0);
        Transform::new(glam::DMat4::from_cols(column(x), column(y), column(z), at)).unwrap()
    };
    let turned = columns([0.0, 0.7, 0.0], [0.0, 0.0, 0.7], [0.7, 0.0, 0.0]);
    let mirrored = columns([0.0, 0.7, 0.0], [0.0, 0.0, 0.7], [-0.7, 0.0, 0.0]);
    let squeezed = columns([0.5, 0.1, 0.0], [-0.2, 0.8, 0.1], [0.0, 0.3, -0.4]);
    let part = Turn::degrees(230.0);
    let mut all = Vec::new();
    let mut add = |name, shape: &dyn Fn(&mut GeometryBuilder) -> Result<tyndall::shape::ObjectId, ShapeError>| {
        let mut builder = GeometryBuilder::new();
        let object = shape(&mut builder).unwrap();
        let geometry = builder.build().unwrap();
        let emitter = match geometry.shape(object) {
            Shape::Cylinder(cylinder) => Revolved::cylinder(cylinder),
            Shape::Disk(disk) => Revolved::disk(disk),
            Shape::Sphere(sphere) => Revolved::sphere(sphere),
            _ => panic!(),
        };
        all.push((name, geometry, EmitterShape::Revolved(emitter)));
    };
    for (turn, which) in [(turned, "turned"), (mirrored, "mirrored"), (squeezed, "squeezed")] {
        for inward in [false, true] {
            add(which, &|b| b.add_cylinder(Cylinder::new(0.5, [-0.6, 0.7], part), &turn, inward));
            add(which, &|b| b.add_disk(Disk::new(0.1, 0.9, 0.3).cut(part), &turn, inward));
            let piece = SpherePart::new(0.8, [-0.3, 0.6], part);
            add(which, &|b| b.add_sphere(Sphere::new(Vec3::ZERO, 0.8).cut(piece), &turn, inward));
            add(which, &|b| b.add_sphere(Sphere::new(Vec3::ZERO, 0.8), &turn, inward));
        }
    }
    all
}

/// The irradiance on a plane by directions that the light gives, where nothing is in between, and by all directions of
/// the sky with what their rays meet. Both are jittered grids of 800² cells: the rim of the light, across some 400 of
/// them of 10 000, errs by √400/2 cells, 0.1 % (and five standard errors are allowed). The density that a ray's hit is
/// given is that of the sample.
#[test]
fn light_sampling_and_rays_find_the_same_surfaces_of_revolution() {
    const N: u32 = 800;
    let stream = &mut Stream::new(10);
    let from = Reference { p: Vec3::new(0.2, -0.1, -0.3), normal: Some(Vec3::Z) };
    for (name, geometry, shape) in revolved() {
        let Light::Area(light) = area(shape, 1.0, false) else { panic!() };
        let (mut by_light, mut by_sky) = (0.0, 0.0);
        for i in 0..N * N {
            let u = (Vec2::new((i % N) as f32, (i / N) as f32) + next_2d(stream)) / N as f32;
            if let Some(s) = light.sample(&from, u, &Wavelengths::Rgb) {
                let Target::Surface { p, ng, .. } = s.target else { panic!() };
                let pdf = light.pdf(&from, p, ng);
                assert!((pdf / s.pdf - 1.0).abs() < 2e-3, "{name} {shape:?}: {pdf} {}", s.pdf);
                let distance = (p - from.p).length() * (1.0 - 1e-4);
                if !geometry.occluded(&Ray::new(from.p, s.dir), distance) {
                    by_light += f64::from(s.li.lane(0) * s.dir.z.max(0.0) / s.pdf);
                }
            }
            let ray = Ray::new(from.p, warp::cosine_hemisphere(u));
            if let Some(hit) = geometry.intersect(&ray, f32::INFINITY) {
                let at = geometry.interaction(&ray, &hit);
                by_sky += f64::from(light.le(at.ng, -ray.dir, || (&at).into(), &Wavelengths::Rgb).lane(0));
            }
        }
        let (by_light, by_sky) = (by_light / f64::from(N * N), by_sky * std::f64::consts::PI / f64::from(N * N));
        assert!((by_light - by_sky).abs() < 5e-3 * by_sky.max(0.1), "{name} {shape:?}: {by_light} {by_sky}");
    }
}
