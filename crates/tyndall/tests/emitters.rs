//! The table of lights that are sampled by direction: each is normalised (quadrature), follows its density (χ²), and gives the
//! light that it should, in the workhorse and in its naive twin.

mod common;

use std::sync::Arc;

use common::{World, assert_mean, diffuse, grey};
use testkit::{Family, Grid, Stream, close, quadrature};
use tyndall::{
    integrator::{Analog, VolPath},
    light::{
        AreaLight, Coordinates, EmitterShape, EnvironmentMap, Light, Pattern, Portal, Projection, Reference, SkyImage,
        Target,
    },
    math::{Ray, Transform, Vec2, Vec3},
    sampling::windowed2d::{Window, Windowed2d},
    shape::{GeometryBuilder, Patch},
    spectrum::{Lanes, Wavelengths},
    texture::{Mapping2, Texture, Weight, pattern::Checkerboard},
};

/// Directions of each χ² test.
const N: usize = 200_000;

fn next_2d(stream: &mut Stream) -> Vec2 {
    Vec2::new(stream.next_f32(), stream.next_f32())
}

fn area(shape: EmitterShape, two_sided: bool) -> AreaLight {
    AreaLight { shape, radiance: grey(1.0), luminance: 1.0, two_sided, opacity: 1.0, pattern: None }
}

/// A saddle, a patch with a fold near one corner, and one that comes to a point.
fn patches() -> [Patch; 3] {
    let saddle = [Vec3::new(-1.0, -1.0, 0.5), Vec3::new(1.0, -1.0, -0.5), Vec3::new(-1.0, 1.0, -0.5), Vec3::ONE * 0.7];
    let uneven = [Vec3::ZERO, Vec3::new(3.0, 0.2, 0.0), Vec3::new(0.1, 0.3, 0.0), Vec3::new(2.5, 2.0, 0.8)];
    let pointed = [Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::new(0.5, 1.0, 0.6)];
    [saddle, uneven, pointed].map(Patch::new)
}

/// Over the parameters of a patch a density p of directions is `p |N·ω| / d²`: it is normalised, and points are drawn by
/// it. From above, from below, from the side.
#[test]
fn curved_patches_follow_their_density() {
    let mut family = Family::new("patches", 0.01);
    for (number, patch) in patches().into_iter().enumerate() {
        let mut builder = GeometryBuilder::new();
        builder.add_patch(patch, &Transform::IDENTITY, false).unwrap();
        let geometry = builder.build().unwrap();
        let light = area(EmitterShape::Patch(patch), true);
        for p in [Vec3::new(0.4, 0.3, 2.0), Vec3::new(0.2, -0.4, -1.5), Vec3::new(3.5, 1.5, 1.0)] {
            let from = Reference { p, normal: None };
            let name = format!("patch {number} from {p}");
            let [p00, p10, p01, p11] = patch.corners.map(Vec3::as_dvec3);
            let density = |[u, v]: [f64; 2]| {
                let at = p00.lerp(p10, u).lerp(p01.lerp(p11, u), v);
                let n = (p10 - p00).lerp(p11 - p01, v).cross((p01 - p00).lerp(p11 - p10, u));
                let way = at - p.as_dvec3();
                let pdf = f64::from(light.pdf(&from, at.as_vec3(), n.normalize_or_zero().as_vec3()));
                pdf * n.dot(way).abs() / way.length().powi(3)
            };
            let strip = |v: f64| quadrature::gauss_legendre(24, 0.0, 1.0, |u| density([u, v]));
            let total = quadrature::gauss_legendre(24, 0.0, 1.0, strip);
            family.check(&format!("{name}: normalised"), close(total, 1.0, 2e-4));
            let mut stream = Stream::new(21);
            let place = || {
                let sample = light.sample(&from, next_2d(&mut stream), &Wavelengths::Rgb)?;
                let Target::Surface { p, ng, .. } = sample.target else { return None };
                let ray = Ray::new(p + ng * 1e-3, -ng);
                let hit = geometry.intersect(&ray, f32::INFINITY)?;
                Some(geometry.interaction(&ray, &hit).uv.get().as_dvec2().to_array())
            };
            family.check(&format!("{name}: chi-square"), Grid::SQUARE.test(N, place, density));
        }
    }
    family.finish();
}

/// The density that comes with a point is that which is asked for at it, and at the point that a ray there meets.
#[test]
fn a_point_of_a_patch_has_the_density_that_it_was_drawn_with() {
    let mut stream = Stream::new(22);
    for patch in patches() {
        let light = area(EmitterShape::Patch(patch), true);
        let from = Reference { p: Vec3::new(0.4, 0.3, 2.0), normal: None };
        for _ in 0..1000 {
            let s = light.sample(&from, next_2d(&mut stream), &Wavelengths::Rgb).unwrap();
            let Target::Surface { p, ng, .. } = s.target else { panic!() };
            let pdf = light.pdf(&from, p, ng);
            assert!((pdf / s.pdf - 1.0).abs() < 1e-4, "{pdf} {}", s.pdf);
        }
    }
}

/// A sky of 8 × 8 different pixels.
fn sky() -> SkyImage {
    let pixels: Vec<[f32; 3]> = (0..64).map(|i| [0.2 + (i * 29 % 13) as f32; 3]).collect();
    SkyImage::new(8, 8, &pixels, 1.0).unwrap()
}

fn even_sky(radiance: f32) -> SkyImage {
    SkyImage::new(1, 1, &[[radiance; 3]], 1.0).unwrap()
}

/// A square window of side 1 at height 1, through which one looks up.
fn window(sky: &SkyImage) -> Portal {
    let corner = |x: f32, z: f32| Vec3::new(x, 1.0, z);
    let corners = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    Portal::new(corners, &Transform::IDENTITY, sky).unwrap()
}

/// Over the window's plane a density p of directions is `p cos θ / d²`: it is normalised, and directions pass the window by
/// it. Every direction drawn shows the sky; from outside there is nothing to be seen.
#[test]
fn light_through_a_portal_follows_its_density() {
    let mut family = Family::new("portals", 0.01);
    for (name, sky) in [("even", even_sky(2.0)), ("uneven", sky())] {
        let portal = window(&sky);
        for p in [Vec3::ZERO, Vec3::new(2.0, 0.5, -1.0), Vec3::new(0.3, 0.9, 0.2)] {
            let density = |[x, z]: [f64; 2]| {
                let way = glam::DVec3::new(x, 1.0, z) - p.as_dvec3();
                let dir = way.normalize();
                f64::from(portal.pdf(p, dir.as_vec3())) * dir.y / way.length_squared()
            };
            let grid = Grid { x: [-0.5, 0.5], y: [-0.5, 0.5], ..Grid::SQUARE };
            let total: f64 = grid.integrate(density).iter().sum();
            family.check(&format!("{name} from {p}: normalised"), close(total, 1.0, 2e-3));
            let (mut stream, mut rims) = (Stream::new(23), 0);
            let sample = || {
                let sample = portal.sample(p, next_2d(&mut stream), &Wavelengths::Rgb)?;
                let le = portal.le(p, sample.dir, &Wavelengths::Rgb);
                let densities = portal.pdf(p, sample.dir) / sample.pdf;
                rims += u32::from(le != sample.li || (densities - 1.0).abs() > 1e-3);
                let through = p + sample.dir * ((1.0 - p.y) / sample.dir.y);
                Some([f64::from(through.x), f64::from(through.z)])
            };
            family.check(&format!("{name} from {p}: chi-square"), grid.test(N, sample, density));
            // Rounding may carry a direction over the rim of the window or of a pixel.
            assert!(rims <= 20, "{rims} of {N} directions show another radiance");
        }
        let outside = Vec3::new(0.1, 1.5, 0.0);
        assert!(portal.sample(outside, Vec2::splat(0.5), &Wavelengths::Rgb).is_none());
        assert_eq!(portal.le(outside, Vec3::new(0.0, -1.0, 0.0), &Wavelengths::Rgb), Lanes::ZERO);
        assert_eq!(portal.le(outside, Vec3::Y, &Wavelengths::Rgb), Lanes::ZERO);
    }
    family.finish();
}

/// A sky that is turned is the same sky through a portal as all around: that of `L = 1 + n · ω` for its pixels' middles, to
/// within what is linear between pixels there and constant here, half a pixel of 2/32 or so.
#[test]
fn a_sky_behind_a_portal_is_turned_as_a_sky_without_one() {
    let turn = glam::DMat4::from_euler(glam::EulerRot::XYZ, 0.4, -0.9, 1.3);
    let to_world = Transform::new(turn).unwrap();
    let side = 32;
    let middle = |i: u32| Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32;
    let value = |i: u32| 1.0 + Projection::EqualArea.direction(middle(i)).dot(Vec3::new(0.5, 0.3, -0.7));
    let pixels: Vec<[f32; 3]> = (0..side * side).map(|i| [value(i); 3]).collect();
    let whole = EnvironmentMap::new(to_world, Projection::EqualArea, side, side, &pixels, 1.0).unwrap();
    let corner = |x: f32, z: f32| Vec3::new(x, 1.0, z);
    let corners = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    let portal = Portal::new(corners, &to_world, &SkyImage::new(side, side, &pixels, 1.0).unwrap()).unwrap();
    for i in 0..100 {
        let through = Vec3::new((i % 10) as f32 * 0.1 - 0.45, 1.0, (i / 10) as f32 * 0.1 - 0.45);
        let [seen, expected] =
            [portal.le(Vec3::ZERO, through, &Wavelengths::Rgb), whole.le(through, &Wavelengths::Rgb)];
        assert!((seen.lane(0) - expected.lane(0)).abs() < 0.12, "{through}: {seen:?} {expected:?}");
    }
}

/// Pixels of 0 among them, windows with rims within pixels, and a window that is one pixel's part.
#[test]
fn windows_of_an_image_follow_their_density() {
    let mut family = Family::new("windows", 0.01);
    let values: Vec<f32> = (0..35).map(|i| (i * 11 % 7) as f32).collect();
    let image = Windowed2d::new(values, 7).unwrap();
    let windows = [
        ([0.0, 0.0], [1.0, 1.0]),
        ([0.13, 0.31], [0.87, 0.64]),
        ([0.45, 0.05], [0.55, 0.95]),
        ([0.3, 0.25], [0.4, 0.35]),
    ];
    for (min, max) in windows {
        let window = Window { min: Vec2::from_array(min), max: Vec2::from_array(max) };
        let grid = Grid {
            x: [f64::from(min[0]), f64::from(max[0])],
            y: [f64::from(min[1]), f64::from(max[1])],
            ..Grid::SQUARE
        };
        let density = |p: [f64; 2]| f64::from(image.pdf(Vec2::new(p[0] as f32, p[1] as f32), &window));
        let total: f64 = grid.integrate(density).iter().sum();
        family.check(&format!("{min:?}: normalised"), close(total, 1.0, 1e-3));
        let mut stream = Stream::new(24);
        let sample = || image.sample(next_2d(&mut stream), &window).map(|(uv, _)| uv.as_dvec2().to_array());
        family.check(&format!("{min:?}: chi-square"), grid.test(N, sample, density));
    }
    family.finish();
}

/// An even sky through a square window of side 1, straight above at height 1: `ρ L F`, F = 0.239 456 470 460 774 the form
/// factor of the square (`surface_ground_truths.csv`); from the window's outer side nothing.
#[test]
fn an_even_sky_behind_a_portal_is_a_shining_square() {
    let form_factor = 0.239_456_470_460_774;
    for (naive, spp) in [(false, 20_000), (true, 400_000)] {
        let mut world = World::seen(Vec3::new(0.5, 0.5, 0.0), Vec3::ZERO);
        world.cuboid(Vec3::new(-5.0, -1.0, -5.0), Vec3::new(5.0, 0.0, 5.0), diffuse(0.5), None);
        world.lights.push(Light::Portal(Box::new(window(&even_sky(3.0)))));
        let measured = if naive { world.measure(&Analog, spp) } else { world.measure(&VolPath::default(), spp) };
        assert_mean("under the window", &measured, [0.5 * 3.0 * form_factor; 3], 0.01);
    }
}

/// A square of side 1 facing down at height 1, under a pattern.
fn patterned(world: &mut World, texture: Texture, opacity: Texture) {
    let shape = EmitterShape::Parallelogram { a: Vec3::new(-0.5, 1.0, -0.5), e1: Vec3::X, e2: Vec3::Z, ng: -Vec3::Y };
    let coordinates = Coordinates::Flat([Vec2::ZERO, Vec2::X, Vec2::Y]);
    let pattern = Some(Box::new(Pattern { texture, opacity: opacity.clone(), coordinates, part: None }));
    let hole = world.part(tyndall::material::Material::Hole);
    let black = world.part(diffuse(0.0));
    let material = tyndall::material::Material::Mix { of: [hole, black], amount: opacity };
    let positions = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| Vec3::new(x, 1.0, z));
    let mesh = tyndall::shape::Mesh {
        positions: positions.to_vec(),
        indices: vec![[0, 1, 2], [2, 3, 0]],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        ..tyndall::shape::Mesh::default()
    };
    let light = AreaLight { pattern, ..area(shape, false) };
    world.shining_mesh(mesh, material, light);
}

/// The board `u < ½: a, else b`: two fields of half a unit.
fn halves(a: f32, b: f32) -> Texture {
    let mapping = Mapping2::Uv(glam::Affine2::from_scale(Vec2::new(2.0, 0.5)));
    let by = Arc::new(Weight::Checkerboard(Checkerboard::Plane(mapping)));
    Texture::Mix { of: Arc::new([a.into(), b.into()]), by }
}

/// Half of the square shines twice as bright, or all of it is there by half, or half of it is: straight below it is always
/// the light of the whole, by half where half is missing.
#[test]
fn patterns_give_the_light_of_their_mean_below_their_middle() {
    let whole = 0.239_456_470_460_774;
    let cases: [(&str, Texture, Texture, f64); 4] = [
        ("plain", 1.0.into(), 1.0.into(), 1.0),
        ("half bright", halves(2.0, 0.0), 1.0.into(), 1.0),
        ("half there", 1.0.into(), halves(0.0, 1.0), 0.5),
        ("thin", 2.0.into(), halves(0.25, 0.25), 0.5),
    ];
    for (name, texture, opacity, expected) in cases {
        for (naive, spp) in [(false, 20_000), (true, 700_000)] {
            let mut world = World::seen(Vec3::new(0.9, 0.5, 0.0), Vec3::ZERO);
            world.cuboid(Vec3::new(-5.0, -1.0, -5.0), Vec3::new(5.0, 0.0, 5.0), diffuse(0.5), None);
            patterned(&mut world, texture.clone(), opacity.clone());
            let measured = if naive { world.measure(&Analog, spp) } else { world.measure(&VolPath::default(), spp) };
            assert_mean(&format!("{name}, naive {naive}"), &measured, [0.5 * expected * whole; 3], 0.015);
        }
    }
}

/// A sphere's own texture coordinates are seen by light samples as by rays: under a board of 1 and 0 over longitude each
/// sample's radiance is that of the surface there.
#[test]
fn light_samples_see_the_texture_where_rays_see_it() {
    let mut builder = GeometryBuilder::new();
    let turned = glam::DMat4::from_translation(glam::DVec3::new(0.3, -0.2, 2.0)) * glam::DMat4::from_rotation_x(0.7);
    let sphere = tyndall::shape::Sphere::new(Vec3::ZERO, 0.8);
    let id = builder.add_sphere(sphere, &Transform::new(turned).unwrap(), false).unwrap();
    let geometry = builder.build().unwrap();
    let whole = geometry.shape(id).clone();
    let tyndall::shape::Shape::Sphere(placed) = &whole else { panic!() };
    let (centre, radius) = placed.round().unwrap();
    let board = Mapping2::Uv(glam::Affine2::from_scale(Vec2::new(10.0, 7.0)));
    let by = Arc::new(Weight::Checkerboard(Checkerboard::Plane(board)));
    let texture = Texture::Mix { of: Arc::new([0.5.into(), 2.0.into()]), by };
    let pattern = Pattern { texture, opacity: 1.0.into(), coordinates: Coordinates::Of(Box::new(whole)), part: None };
    let light = AreaLight {
        pattern: Some(Box::new(pattern)),
        ..area(EmitterShape::Sphere { centre, radius, inward: false }, false)
    };
    let (mut stream, mut seen) = (Stream::new(25), [0; 2]);
    for _ in 0..2000 {
        let from = Reference { p: Vec3::new(stream.next_f32(), 0.1, -1.0), normal: None };
        let Some(s) = light.sample(&from, next_2d(&mut stream), &Wavelengths::Rgb) else { continue };
        let ray = Ray::new(from.p, s.dir);
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY) else { continue };
        let hit = geometry.interaction(&ray, &hit);
        let le = light.le(hit.ng, -s.dir, || (&hit).into(), &Wavelengths::Rgb);
        seen[usize::from(le == s.li)] += 1;
    }
    // A sample on a line between two fields may be on the other side of it.
    assert!(seen[1] > 1900 && seen[0] <= 4, "{seen:?}");
}
