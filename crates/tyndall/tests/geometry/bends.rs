//! Sharp bends: a ray that a ball on its way along the strand would stop is stopped.

use glam::{DVec3, DVec4};
use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Basis, Curves, GeometryBuilder, Knot, Style};

use super::{meshes::Random, strands::at};

/// How far a point is from the nearest ball that goes along the curves, `share` as large as the tube, and the ball's place: the
/// number of its curve and the parameter. From the least of many places by thirds.
fn to_balls(curves: &[[DVec4; 4]], share: f64, p: DVec3) -> (f64, f64) {
    const STEPS: u32 = 64;
    let distance = |bezier: &[DVec4; 4], w: f64| {
        let ball = at(bezier, w).0;
        (ball.truncate() - p).length() - share * ball.w
    };
    let mut nearest = (f64::INFINITY, 0.0);
    for (i, bezier) in (0u32..).zip(curves) {
        let best = (0..=STEPS).map(|k| f64::from(k) / f64::from(STEPS));
        let Some(best) = best.min_by(|a, b| distance(bezier, *a).total_cmp(&distance(bezier, *b))) else { continue };
        let step = 1.0 / f64::from(STEPS);
        let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
        for _ in 0..40 {
            let [left, right] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if distance(bezier, left) < distance(bezier, right) { high = right } else { low = left }
        }
        let w = [low, 0.0, 1.0].into_iter().min_by(|a, b| distance(bezier, *a).total_cmp(&distance(bezier, *b)));
        let w = w.unwrap_or(low);
        let found = distance(bezier, w);
        if found < nearest.0 {
            nearest = (found, f64::from(i) + w);
        }
    }
    nearest
}

/// Where a ray comes to the balls: it may always go on as far as the nearest is. Also the ball's place.
fn enter_balls(curves: &[[DVec4; 4]], share: f64, ray: &Ray, end: f64) -> Option<(f64, f64)> {
    let (origin, dir, mut t) = (ray.origin.as_dvec3(), ray.dir.as_dvec3(), 0.0);
    while t < end {
        let (distance, place) = to_balls(curves, share, origin + dir * t);
        if distance < 1e-6 {
            return Some((t, place));
        }
        t += distance;
    }
    None
}

/// Points with steps of even length that turn by up to `bend`.
fn bent(points: usize, bend: f32, [radius, taper]: [f32; 2], random: &mut Random) -> Vec<Knot> {
    let (mut p, mut dir) = (Vec3::ZERO, random.dir());
    (0..points)
        .map(|i| {
            let axis = dir.cross(random.dir()).normalize();
            let angle = bend * (0.3 + 0.7 * random.unit());
            dir = (dir * angle.cos() + axis.cross(dir) * angle.sin()).normalize();
            p += dir * 0.3;
            Knot { p, radius: radius * (1.0 - taper * i as f32 / points as f32) }
        })
        .collect()
}

/// Bends of up to 150°, half of the rays at the joints of segments. Whatever a ball stops that is 2 % smaller than the tube is
/// stopped, no further on than a ten-thousandth; nothing is met where a ball that is 2 % larger has not been. Balls at the open
/// ends do not count. Where the radius does not change, circles and balls are one surface. Three points in one place make a B-spline turn on the spot.
#[test]
fn what_a_ball_on_its_way_along_a_bent_strand_stops_is_stopped() {
    let random = &mut Random(61);
    let cases = [
        (Basis::Linear, 4, 1),
        (Basis::QuadraticBezier, 7, 1),
        (Basis::CubicBezier, 7, 1),
        (Basis::QuadraticBSpline, 5, 1),
        (Basis::CubicBSpline, 6, 1),
        (Basis::CubicBSpline, 4, 3),
        (Basis::CatmullRom, 6, 1),
    ];
    for (basis, points, times) in cases {
        let (mut stopped, mut passed) = (0, 0);
        for strand in 0..24 {
            let (radius, taper) = ([0.003, 0.02, 0.06][strand % 3], [0.0, 0.3][strand / 3 % 2]);
            let knots = bent(points, 150f32.to_radians(), [radius, taper], random);
            let knots: Vec<_> = knots.into_iter().flat_map(|knot| std::iter::repeat_n(knot, times)).collect();
            let mut curves = Curves::new(Style::Round);
            curves.push(basis, &knots);
            let beziers: Vec<_> = curves.beziers().collect();
            let mut builder = GeometryBuilder::new();
            builder.add_curves(curves, &Transform::IDENTITY).unwrap();
            let geometry = builder.build().unwrap();
            for i in 0..16 {
                let at_joint = (1 + random.below(beziers.len() - 1)) as f32;
                let place = if i % 2 == 0 { at_joint } else { random.unit() * beziers.len() as f32 };
                let target = at(&beziers[place as usize], f64::from(place.fract())).0;
                let origin = target.truncate().as_vec3() + random.dir() * 1.5;
                let aim = target.truncate().as_vec3() + random.in_ball() * (1.4 * target.w as f32);
                let ray = Ray::new(origin, (aim - origin).normalize());
                let [inner, outer] = [0.98, 1.02].map(|share| enter_balls(&beziers, share, &ray, 4.0));
                let is_end = |place: f64| place < 0.01 || place > beziers.len() as f64 - 0.01;
                if basis != Basis::Linear && [inner, outer].into_iter().flatten().any(|(_, place)| is_end(place)) {
                    continue;
                }
                let hit = geometry.intersect(&ray, f32::INFINITY);
                let t = hit.map_or(f64::INFINITY, |hit| f64::from(hit.t));
                if let Some((end, place)) = inner {
                    assert!(t < end + 1e-4, "{basis:?}: {ray:?} is past {place} at {end}, stopped at {t}: {knots:?}");
                    stopped += 1;
                }
                let Some(hit) = hit else {
                    passed += 1;
                    continue;
                };
                let start = outer.map_or(f64::INFINITY, |(start, _)| start);
                assert!(t > start - 1e-4, "{basis:?}: {ray:?} is stopped at {t}, before {start}: {knots:?}");
                let interaction = geometry.interaction(&ray, &hit);
                if taper == 0.0 {
                    // To the rounding of a point: 6e-8 of its size, on each axis.
                    let (off, _) = to_balls(&beziers, 1.0, interaction.p.as_dvec3());
                    assert!(off.abs() < 1e-6, "{basis:?}: {off} off the surface at {interaction:?}");
                }
                assert!(interaction.ng.dot(ray.dir) <= 1e-6, "{interaction:?}");
            }
        }
        assert!(stopped > 150 && passed > 10, "{basis:?}: {stopped} {passed}");
    }
}
