//! The table of cameras: each samples its film and lens as its page says, and sees a uniform world as it should.

mod common;

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use common::{World, assert_mean, diffuse};
use testkit::{Family, Grid, Stream, close, sphere_test};
use tyndall::{
    camera::{
        Batch, CameraModel, Distant, Element, IrradianceMeter, LensSystem, Orthographic, Perspective, RadianceMeter,
        Realistic, Spherical, SphericalMapping, Stop, Surface, Target, ThinLens, View,
    },
    integrator::VolPath,
    light::EmitterShape,
    math::{Transform, Vec2, Vec3},
};

const N: usize = 200_000;

fn next_2d(stream: &mut Stream) -> Vec2 {
    Vec2::new(stream.next_f32(), stream.next_f32())
}

fn meter(pieces: Vec<EmitterShape>) -> IrradianceMeter {
    IrradianceMeter { surface: Surface::new(pieces).unwrap() }
}

fn view(model: CameraModel) -> View {
    View { to_world: Transform::IDENTITY, model, near: 0.0 }
}

/// A place of the image, uniform, sees a direction: of the equal-area map uniform over the sphere, of latitude and
/// longitude with density 1/(2π² sin θ), θ from +y.
#[test]
fn spherical_cameras_see_each_direction_by_its_solid_angle() {
    let mut family = Family::new("spherical", 0.01);
    for mapping in [SphericalMapping::EqualArea, SphericalMapping::Equirectangular] {
        let camera = view(CameraModel::Spherical(Spherical { mapping }));
        let mut stream = Stream::new(1);
        let directions = || {
            let d = camera.ray(next_2d(&mut stream), Vec2::ZERO).ray.dir.as_dvec3();
            Some([d.z, d.x, d.y]) // +y is the pole
        };
        let density = |d: [f64; 3]| match mapping {
            SphericalMapping::EqualArea => 1.0 / (4.0 * PI),
            SphericalMapping::Equirectangular => 1.0 / (2.0 * PI * PI * (1.0 - d[2] * d[2]).max(1e-12).sqrt()),
        };
        family.check(&format!("{mapping:?}: chi-square"), sphere_test(N, directions, density));
    }
    family.finish();
}

/// At distance d a thin lens focused at f spreads a point of the image uniformly over a disk of radius R·|d − f|/f.
#[test]
fn a_thin_lens_blurs_to_its_circle_of_confusion() {
    let mut family = Family::new("thin lens", 0.01);
    let (radius, focus) = (0.5, 4.0);
    let lens = Some(ThinLens { radius, focus });
    let camera = view(CameraModel::Perspective(Perspective { window: [-1.0, 1.0, -0.8, 0.8], lens }));
    let place = Vec2::new(0.8, 0.3);
    let centre = Vec3::new(0.6, 0.32, 1.0);
    for distance in [1.0f32, 3.0, 7.0, 400.0] {
        let mut stream = Stream::new(2);
        let blur = radius * (distance - focus).abs() / focus;
        let polar = || {
            let ray = camera.ray(place, next_2d(&mut stream)).ray;
            let p = ray.at((distance - ray.origin.z) / ray.dir.z) - centre * distance;
            Some([f64::from(p.truncate().length_squared() / (blur * blur)), f64::from(p.y.atan2(p.x))])
        };
        let grid = Grid { x: [0.0, 1.0], ..Grid::SPHERE };
        family.check(&format!("at {distance}"), grid.test(N, polar, |_| 1.0 / TAU));
    }
    family.finish();
    let sharp = camera.ray(place, Vec2::new(0.9, 0.2)).ray;
    let p = sharp.at((focus - sharp.origin.z) / sharp.dir.z);
    assert!((p - centre * focus).length() < 1e-5);
}

/// The points of a meter are uniform in its area, and its directions follow the cosine.
#[test]
fn an_irradiance_meter_is_uniform_in_area_and_follows_the_cosine() {
    let mut family = Family::new("irradiance meter", 0.01);
    // Two triangles of areas 1 and 3 in the plane y = 0, side by side in x, that measure upwards.
    let triangle = |x: f32, width: f32| EmitterShape::Triangle {
        a: Vec3::new(x, 0.0, 0.0),
        e1: Vec3::Z * 2.0,
        e2: Vec3::X * width,
        ng: Vec3::Y,
    };
    let meter = meter(vec![triangle(0.0, 1.0), triangle(1.0, 3.0)]);
    let camera = view(CameraModel::IrradianceMeter(meter));
    let mut stream = Stream::new(3);
    let directions = || {
        let sample = camera.ray(next_2d(&mut stream), next_2d(&mut stream));
        let d = sample.ray.dir.as_dvec3();
        Some([d.z, d.x, d.y])
    };
    family.check("directions", sphere_test(N, directions, |d| d[2].max(0.0) * FRAC_1_PI));
    let mut stream = Stream::new(4);
    let left = (0..N).filter(|_| camera.ray(next_2d(&mut stream), next_2d(&mut stream)).ray.origin.x < 1.0).count();
    family.check("places", close(left as f64 / N as f64, 0.25, 0.02));
    family.finish();
}

/// Rays of a distant camera are parallel and start outside of the scene; over its disk, and over a surface seen askew, they
/// are uniform in area.
#[test]
fn a_distant_camera_sees_its_target_evenly() {
    let mut family = Family::new("distant", 0.01);
    let look = glam::DMat4::from_quat(glam::DQuat::from_rotation_arc(
        glam::DVec3::Z,
        glam::DVec3::new(0.3, -0.8, 0.5).normalize(),
    ));
    let (centre, radius) = (Vec3::new(1.0, 2.0, 3.0), 2.0);
    let seen = |target| View {
        to_world: Transform::new(look).unwrap(),
        model: CameraModel::Distant(Distant { centre, radius, target }),
        near: 0.0,
    };
    let camera = seen(Target::Disk);
    let mut stream = Stream::new(5);
    let polar = || {
        let ray = camera.ray(Vec2::splat(0.5), next_2d(&mut stream)).ray;
        let aside = look.inverse().transform_vector3((ray.origin - centre).as_dvec3());
        assert!((aside.z + f64::from(radius)).abs() < 1e-5, "it starts at the sphere's near side");
        let r = aside.truncate() / f64::from(radius);
        Some([r.length_squared(), r.y.atan2(r.x)])
    };
    family.check("disk", Grid { x: [0.0, 1.0], ..Grid::SPHERE }.test(N, polar, |_| 1.0 / TAU));
    let square = EmitterShape::Parallelogram { a: Vec3::ZERO, e1: Vec3::X, e2: Vec3::Y, ng: Vec3::Z };
    let camera = seen(Target::Surface(Surface::new(vec![square]).unwrap()));
    let mut stream = Stream::new(6);
    let places = || {
        let sample = camera.ray(Vec2::splat(0.5), next_2d(&mut stream));
        assert!((sample.weight - 1.0).abs() < 1e-5);
        let on_square = sample.ray.at(-sample.ray.origin.z / sample.ray.dir.z);
        Some([f64::from(on_square.x), f64::from(on_square.y)])
    };
    family.check("surface", Grid::SQUARE.test(N, places, |_| 1.0));
    family.finish();
    let point = seen(Target::Point(Vec3::X)).ray(Vec2::splat(0.5), Vec2::ZERO).ray;
    assert!((point.at(2.0 * radius) - Vec3::X).length() < 1e-6);
}

/// The area of a meter's curved patch weighs each point alike: over the saddle z = xy the mean of x² is
/// `∫ x² √(1 + x² + y²) / ∫ √(1 + x² + y²)`.
#[test]
fn points_of_a_curved_meter_weigh_by_their_area() {
    let saddle = tyndall::shape::Patch::new([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE]);
    let camera = view(CameraModel::IrradianceMeter(meter(vec![EmitterShape::Patch(saddle)])));
    let element = |x: f64, y: f64| (1.0 + x * x + y * y).sqrt();
    let over = |f: &dyn Fn(f64, f64) -> f64| {
        testkit::quadrature::gauss_legendre(30, 0.0, 1.0, |y| {
            testkit::quadrature::gauss_legendre(30, 0.0, 1.0, |x| f(x, y) * element(x, y))
        })
    };
    let expected = over(&|x, _| x * x) / over(&|_, _| 1.0);
    let mut stream = Stream::new(7);
    let (mut sum, mut squares, mut weights) = (0.0, 0.0, 0.0);
    for _ in 0..N {
        let sample = camera.ray(next_2d(&mut stream), next_2d(&mut stream));
        let (weight, x) = (f64::from(sample.weight) / PI, f64::from(sample.ray.origin.x));
        sum += weight * x * x;
        squares += (weight * x * x).powi(2);
        weights += weight;
    }
    let n = N as f64;
    let error = ((squares / n - (sum / n).powi(2)) / n).sqrt();
    assert!((sum / n - expected).abs() < 4.0 * error, "{} ± {error}, expected {expected}", sum / n);
    assert!((weights / n - 1.0).abs() < 2e-3, "{}", weights / n);
}

/// Radiance 1 from everywhere: cameras of radiance see 1, meters of irradiance π; a lens in front of a film sees the
/// irradiance of its pupil, by its own test beside it, and here the same through the whole renderer.
#[test]
fn every_camera_sees_a_uniform_world_as_its_page_says() {
    let window = [-0.7, 0.7, -0.7, 0.7];
    let stop = Element { curvature: 0.0, thickness: 2.0, eta: 0.0, aperture: 1.0 };
    let lens = LensSystem { elements: vec![stop], stop: Stop::Circular };
    let sphere = EmitterShape::Sphere { centre: Vec3::ZERO, radius: 1.0, inward: false };
    let on_axis = PI / 5.0; // π a²/(a² + z²) for a film that is almost a point
    let cameras = [
        (CameraModel::Perspective(Perspective { window, lens: Some(ThinLens { radius: 0.3, focus: 2.0 }) }), 1.0),
        (CameraModel::Orthographic(Orthographic { window }), 1.0),
        (CameraModel::Spherical(Spherical { mapping: SphericalMapping::EqualArea }), 1.0),
        (CameraModel::RadianceMeter(RadianceMeter), 1.0),
        (CameraModel::Distant(Distant { centre: Vec3::ZERO, radius: 2.0, target: Target::Disk }), 1.0),
        (CameraModel::IrradianceMeter(meter(vec![sphere])), PI),
        (CameraModel::Realistic(Box::new(Realistic::new(lens, 0.002, 1.0).unwrap())), on_axis),
    ];
    for (model, expected) in cameras {
        let mut world = World::seen(Vec3::new(0.2, 0.1, 3.0), Vec3::ZERO);
        let name = format!("{model:?}");
        world.camera.view.model = model;
        world.sphere(Vec3::ZERO, 1.0, diffuse(1.0), None);
        world.sky(1.0);
        let measured = world.measure(&VolPath::default(), 40_000);
        assert_mean(&name[..20], &measured, [expected; 3], 0.01);
    }
}

/// The lower half of the world shines: what falls on a level plate from below is π, from above 0.
#[test]
fn a_meter_measures_on_the_side_of_its_normal() {
    for (ng, expected) in [(Vec3::Y, 0.25), (-Vec3::Y, 2.0)] {
        let mut world = World::seen(Vec3::Y, Vec3::ZERO);
        let plate = EmitterShape::Disk { centre: Vec3::Y * 5.0, ng, radius: 0.3, inner: 0.1 };
        world.camera.view.model = CameraModel::IrradianceMeter(meter(vec![plate]));
        world.half_sky(0.25, 2.0);
        assert_mean("plate", &world.measure(&VolPath::default(), 10_000), [expected * PI; 3], 0.01);
    }
}

/// Three meters in a batch: the thirds of the image are theirs.
#[test]
fn a_batch_shows_its_views_side_by_side() {
    let at = |x: f32| View {
        to_world: Transform::new(glam::DMat4::from_translation(glam::DVec3::new(f64::from(x), 0.0, 0.0))).unwrap(),
        model: CameraModel::RadianceMeter(RadianceMeter),
        near: 0.0,
    };
    let batch = view(CameraModel::Batch(Batch { views: vec![at(1.0), at(2.0), at(3.0)] }));
    let seen = [0.0, 0.3, 0.34, 0.6, 0.7, 1.0].map(|x| batch.ray(Vec2::new(x, 0.5), Vec2::ZERO).ray.origin.x);
    assert_eq!(seen, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
}
