//! The sampler-test table of `sampling`: every warp is normalised (quadrature) and follows its density (χ²).

use std::f64::consts::{PI, TAU};

use testkit::{Family, Grid, Stream, close, line_test, quadrature, sphere_test};
use tyndall::film::{Kernel, Lobed};
use tyndall::math::{Vec2, Vec3};
use tyndall::sampling::discrete::Discrete;
use tyndall::sampling::piecewise2d::Piecewise2d;
use tyndall::sampling::spherical_rectangle::SphericalRectangle;
use tyndall::sampling::spherical_triangle::SphericalTriangle;
use tyndall::sampling::warp;

/// Samples of each χ² test.
const N: usize = 300_000;

fn next_2d(stream: &mut Stream) -> Vec2 {
    Vec2::new(stream.next_f32(), stream.next_f32())
}

/// A sampler of directions against its density [1/sr].
fn check_sphere(family: &mut Family, name: &str, sample: impl Fn(Vec2) -> Vec3, pdf: impl Fn(f64) -> f64) {
    let mut stream = Stream::new(1);
    let total = quadrature::hemisphere(16, |d| pdf(d[2]) + pdf(-d[2]));
    family.check(&format!("{name}: normalised"), close(total, 1.0, 1e-6));
    let directions = || Some(sample(next_2d(&mut stream)).as_dvec3().to_array());
    family.check(&format!("{name}: chi-square"), sphere_test(N, directions, |d| pdf(d[2])));
}

#[test]
fn directions_follow_their_densities() {
    let mut family = Family::new("directions", 0.01);
    check_sphere(&mut family, "uniform sphere", warp::uniform_sphere, |_| f64::from(warp::uniform_sphere_pdf()));
    check_sphere(&mut family, "uniform hemisphere", warp::uniform_hemisphere, |z| {
        f64::from(warp::uniform_hemisphere_pdf(z as f32))
    });
    check_sphere(&mut family, "cosine hemisphere", warp::cosine_hemisphere, |z| {
        f64::from(warp::cosine_hemisphere_pdf(z as f32))
    });
    family.finish();
}

/// Cones in the coordinates (cos θ, φ) of their own cap, from a lamp's to nearly the sphere.
#[test]
fn cones_are_uniform() {
    let mut family = Family::new("cones", 0.01);
    for cos_max in [0.99f32, 0.5, -0.9] {
        let mut stream = Stream::new(2);
        let pdf = f64::from(warp::uniform_cone_pdf(cos_max));
        let solid_angle = TAU * (1.0 - f64::from(cos_max));
        family.check(&format!("{cos_max}: normalised"), close(pdf * solid_angle, 1.0, 1e-6));
        let grid = Grid { x: [f64::from(cos_max), 1.0], ..Grid::SPHERE };
        let cap = || {
            let d = warp::uniform_cone(next_2d(&mut stream), cos_max).as_dvec3();
            Some([d.z, d.y.atan2(d.x)])
        };
        family.check(&format!("{cos_max}: chi-square"), grid.test(N, cap, |_| pdf));
    }
    family.finish();
}

/// A sphere of radius 1 at distance 10⁴, in the coordinates (sin² θ/sin² θ_max, φ): uniform there, but for a term of
/// order sin² θ_max = 10⁻⁸.
#[test]
fn a_narrow_cone_is_uniform_too() {
    let mut family = Family::new("narrow cone", 0.01);
    let cone = warp::Cone::of_sphere(1.0, 1e4).unwrap();
    family.check("normalised", close(f64::from(cone.pdf()) * PI * 1e-8, 1.0, 1e-6));
    let grid = Grid { x: [0.0, 1.0], ..Grid::SPHERE };
    let mut stream = Stream::new(3);
    let cap = || {
        let d = cone.sample(next_2d(&mut stream)).as_dvec3();
        Some([(d.x * d.x + d.y * d.y) * 1e8, d.y.atan2(d.x)])
    };
    family.check("chi-square", grid.test(N, cap, |_| 1.0 / TAU));
    family.finish();
}

/// In the coordinates (r², φ) a uniform disk has the constant density pdf/2: r dr dφ = d(r²) dφ/2.
#[test]
fn the_disk_is_uniform() {
    let mut family = Family::new("disk", 0.01);
    let pdf = f64::from(warp::concentric_disk_pdf());
    family.check("normalised", close(pdf * PI, 1.0, 1e-6));
    let mut stream = Stream::new(4);
    let polar = || {
        let p = warp::concentric_disk(next_2d(&mut stream)).as_dvec2();
        Some([p.length_squared(), p.y.atan2(p.x)])
    };
    let grid = Grid { x: [0.0, 1.0], ..Grid::SPHERE };
    family.check("chi-square", grid.test(N, polar, |_| 0.5 * pdf));
    family.finish();
}

/// From barycentric coordinates to a square: q = b₁ + b₂, t = b₂/q; db₁ db₂ = q dq dt.
fn triangle_square(b: [f32; 3]) -> [f64; 2] {
    let [_, b1, b2] = b.map(f64::from);
    [b1 + b2, if b1 + b2 > 0.0 { b2 / (b1 + b2) } else { 0.0 }]
}

/// Uniform by area: the density of (b₁, b₂) is 2.
#[test]
fn points_of_a_triangle_are_uniform() {
    let mut family = Family::new("triangle", 0.01);
    let mut stream = Stream::new(5);
    let points = || Some(triangle_square(warp::triangle(next_2d(&mut stream))));
    family.check("chi-square", Grid::SQUARE.test(N, points, |[q, _]| 2.0 * q));
    family.finish();
}

/// |cos θ|/r² of the point `p` of a surface with normal `n`: what turns areas into solid angles.
fn solid_angle_per_area(p: Vec3, n: Vec3) -> f64 {
    let (p, n) = (p.as_dvec3(), n.as_dvec3().normalize());
    p.dot(n).abs() / p.length().powi(3)
}

/// The density over the edges' fractions is |ex||ey| |cos θ|/(r² Ω), and its integral is 1 only if Ω is right.
#[test]
fn rectangles_are_uniform_in_solid_angle() {
    let mut family = Family::new("spherical rectangles", 0.01);
    let turned = Vec3::new(0.6, 0.0, 0.8);
    let cases = [
        ("facing", Vec3::new(-1.0, -1.0, 1.0), 2.0 * Vec3::X, 2.0 * Vec3::Y),
        ("oblique", Vec3::new(0.3, -2.0, 0.7), 1.5 * turned, 3.0 * Vec3::Y),
        ("near", Vec3::new(-1.0, -1.0, 0.05), 3.0 * Vec3::X, 2.0 * Vec3::Y),
        ("behind, mirrored", Vec3::new(1.0, 2.0, -0.5), -2.0 * Vec3::X, -1.0 * Vec3::Y),
        ("grazing", Vec3::new(0.5, -1.0, 0.01), 4.0 * Vec3::X, 2.0 * Vec3::Y),
        ("grazing at 1e-4", Vec3::new(0.5, -1.0, 1e-4), 4.0 * Vec3::X, 2.0 * Vec3::Y),
        ("far", Vec3::new(300.0, 100.0, 1000.0), Vec3::X, Vec3::Y),
        ("tiny, 1e-8 sr", Vec3::new(0.0, 0.0, 1.0), 1e-4 * Vec3::X, 1e-4 * Vec3::Y),
        ("all around", Vec3::new(-1.0, -1.0, 0.01), 2.0 * Vec3::X, 3.0 * Vec3::Y),
        ("large, oblique, long", Vec3::new(-50.0, 0.2, 0.1), 100.0 * Vec3::X, 0.3 * Vec3::Y),
    ];
    for (name, corner, ex, ey) in cases {
        let from = Vec3::new(0.25, -0.5, 2.0);
        let r = SphericalRectangle::new(corner + from, ex, ey, from).unwrap();
        // The frame that single precision has made of it.
        let corner = corner + from - from;
        let density = |[u, v]: [f64; 2]| {
            let p = corner + u as f32 * ex + v as f32 * ey;
            let area = f64::from(ex.length()) * f64::from(ey.length());
            area * solid_angle_per_area(p, ex.cross(ey)) * f64::from(r.pdf())
        };
        let total: f64 = Grid::SQUARE.integrate(density).iter().sum();
        family.check(&format!("{name}: normalised"), close(total, 1.0, 1e-4));
        let mut stream = Stream::new(6);
        let points = || Some(r.sample(next_2d(&mut stream)).as_dvec2().to_array());
        family.check(&format!("{name}: chi-square"), Grid::SQUARE.test(N, points, density));
    }
    family.finish();
}

/// As for rectangles; twice the area over (b₁, b₂), times q in the square's coordinates.
#[test]
fn triangles_are_uniform_in_solid_angle() {
    let mut family = Family::new("spherical triangles", 0.01);
    let cases = [
        ("octant", Vec3::X, Vec3::Y, Vec3::Z),
        ("clockwise", Vec3::Y, Vec3::X, Vec3::Z),
        ("facing", Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(0.0, 1.0, 1.0)),
        ("near", Vec3::new(-1.0, -1.0, 0.1), Vec3::new(1.0, -1.0, 0.1), Vec3::new(0.0, 1.0, 0.2)),
        ("grazing", Vec3::new(0.5, 0.0, 0.01), Vec3::new(3.0, 0.0, 0.01), Vec3::new(1.0, 2.0, 0.01)),
        ("thin", Vec3::new(-1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 0.01, 1.0)),
        ("all around", Vec3::new(-1.0, -1.0, 0.01), Vec3::new(1.0, -1.0, 0.01), Vec3::new(0.0, 1.0, 0.01)),
        ("far", Vec3::new(0.0, 0.0, 1000.0), Vec3::new(1.0, 0.0, 1000.0), Vec3::new(0.0, 1.0, 1001.0)),
        ("tiny, 5e-9 sr", Vec3::new(0.0, 0.0, 1.0), Vec3::new(1e-4, 0.0, 1.0), Vec3::new(0.0, 1e-4, 1.0)),
    ];
    for (name, p0, p1, p2) in cases {
        let t = SphericalTriangle::new(p0, p1, p2, Vec3::ZERO).unwrap();
        let n = (p1 - p0).cross(p2 - p0);
        let density = |[q, s]: [f64; 2]| {
            let (b1, b2) = (q * (1.0 - s), q * s);
            let p = p0 + b1 as f32 * (p1 - p0) + b2 as f32 * (p2 - p0);
            q * f64::from(n.length()) * solid_angle_per_area(p, n) * f64::from(t.pdf())
        };
        let total: f64 = Grid::SQUARE.integrate(density).iter().sum();
        family.check(&format!("{name}: normalised"), close(total, 1.0, 1e-4));
        let mut stream = Stream::new(7);
        let points = || Some(triangle_square(t.sample(next_2d(&mut stream)).1));
        family.check(&format!("{name}: chi-square"), Grid::SQUARE.test(N, points, density));
    }
    family.finish();
}

/// A rectangle is two triangles: two formulas for one solid angle, over ten decades of size and of height above its plane.
#[test]
fn the_solid_angle_of_a_rectangle_is_that_of_its_two_triangles() {
    let mut stream = Stream::new(10);
    let mut decade = |from: f32, to: f32| 10f32.powf(from + (to - from) * stream.next_f32());
    let mut compared = 0;
    for _ in 0..100_000 {
        // Corners and edges that single precision holds both without rounding.
        let low = Vec3::new(-decade(-4.0, 3.0), -decade(-4.0, 3.0), decade(-6.0, 4.0));
        let high = low + Vec3::new(decade(-4.0, 3.0), decade(-4.0, 3.0), 0.0);
        let edges = high - low;
        if edges.as_dvec3() != high.as_dvec3() - low.as_dvec3() {
            continue;
        }
        let (corner, ex, ey) = (low, edges.x * Vec3::X, edges.y * Vec3::Y);
        let Some(r) = SphericalRectangle::new(corner, ex, ey, Vec3::ZERO) else { continue };
        let lower = SphericalTriangle::new(corner, corner + ex, corner + ex + ey, Vec3::ZERO);
        let upper = SphericalTriangle::new(corner, corner + ex + ey, corner + ey, Vec3::ZERO);
        let (Some(lower), Some(upper)) = (lower, upper) else { continue };
        let ratio = (lower.solid_angle + upper.solid_angle) / r.solid_angle;
        assert!((ratio - 1.0).abs() < 1e-5, "{corner} {ex} {ey}: {ratio}");
        compared += 1;
    }
    assert!(compared > 10_000, "{compared}");
}

/// The index and what is left of u, together uniform on [0, n): entry i has density pmf(i), remainder uniform.
#[test]
fn a_discrete_choice_follows_its_weights_and_leaves_a_uniform_number() {
    let mut family = Family::new("discrete", 0.01);
    let weights = [3.0, 0.0, 0.5, 1e-3, 7.0, 2.0, 0.0];
    let d = Discrete::new(&weights).unwrap();
    let total: f64 = (0..d.len()).map(|i| f64::from(d.pmf(i))).sum();
    family.check("normalised", close(total, 1.0, 1e-6));
    let mut stream = Stream::new(8);
    let place = || {
        let (i, p, rest) = d.sample(stream.next_f32());
        assert_eq!(p, d.pmf(i));
        i as f64 + f64::from(rest)
    };
    let density = |x: f64| f64::from(weights[x as usize] / 12.501);
    family.check("chi-square", line_test([0.0, 7.0], 7 * 16, N, place, density));
    family.finish();
}

#[test]
fn points_of_an_image_follow_its_values() {
    let mut family = Family::new("piecewise 2-D", 0.01);
    // 12 × 8 pixels, so that the 24 × 24 cells of the grid lie within pixels; one row and some pixels are black.
    let values: Vec<f32> = (0..96)
        .map(|i| if i / 12 == 3 || i % 7 == 0 { 0.0 } else { (i * i % 31) as f32 + if i == 50 { 300.0 } else { 0.1 } })
        .collect();
    let image = Piecewise2d::new(&values, 12).unwrap();
    let density = |p: [f64; 2]| f64::from(image.pdf(Vec2::new(p[0] as f32, p[1] as f32)));
    let total: f64 = Grid::SQUARE.integrate(density).iter().sum();
    family.check("normalised", close(total, 1.0, 1e-6));
    let mean = values.iter().sum::<f32>() / 96.0;
    family.check("value over mean", close(density([2.5 / 12.0, 4.5 / 8.0]), f64::from(values[50] / mean), 1e-4));
    let mut stream = Stream::new(9);
    let points = || {
        let (uv, pdf) = image.sample(next_2d(&mut stream));
        assert_eq!(pdf, image.pdf(uv));
        Some(uv.as_dvec2().to_array())
    };
    family.check("chi-square", Grid::SQUARE.test(N, points, density));
    family.finish();
}

/// Offsets of a Lanczos window of three lobes follow |f|, and each weighs f/|f| times the same number, up to the cells of
/// its table: along both axes, ∫|f|/∫f.
#[test]
fn offsets_of_a_lobed_filter_follow_its_absolute_value() {
    let mut family = Family::new("Lanczos", 0.01);
    let filter = Lobed::new(Kernel::Sinc { tau: 3.0 }, [3.0; 2]).unwrap();
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
    let f = |x: f64| sinc(x) * sinc(x / 3.0);
    let sum = |g: &dyn Fn(f64) -> f64| (0..60_000).map(|i| g((f64::from(i) + 0.5) * 1e-4 - 3.0) * 1e-4).sum::<f64>();
    let (integral, absolute) = (sum(&f), sum(&|x| f(x).abs()));
    let mut stream = Stream::new(11);
    let mut weights = Vec::new();
    let place = || {
        let ([x, y], weight) = filter.sample([stream.next_f32(), stream.next_f32()]);
        let sign = (f(f64::from(x)) * f(f64::from(y))).signum();
        weights.push(f64::from(weight) * sign);
        f64::from(x)
    };
    family.check("chi-square", line_test([-3.0, 3.0], 96, N, place, |x| f(x).abs() / absolute));
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    family.check("weight", close(mean, (absolute / integral).powi(2), 1e-3));
    let near = weights.iter().filter(|w| (**w / mean - 1.0).abs() < 0.1).count();
    family.check("weights are alike", close(near as f64 / weights.len() as f64, 1.0, 0.02));
    family.finish();
}
