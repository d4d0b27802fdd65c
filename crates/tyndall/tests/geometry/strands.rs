//! Strands: what a ray meets is on the tube, nothing is missed, and nothing is met twice.

use glam::DVec3;
use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Basis, Curves, Geometry, GeometryBuilder, Hit, Knot, Style};

use super::meshes::Random;

/// A B-spline that wanders, as thick at its tip as half its root.
pub(super) fn strand(style: Style, points: usize, radius: f32, random: &mut Random) -> Curves {
    let (mut p, mut dir) = (random.in_ball(), random.dir());
    let taper = |i: usize| radius * (1.0 - 0.5 * i as f32 / points as f32);
    let knots: Vec<_> = (0..points)
        .map(|i| {
            dir = (dir + random.in_ball()).normalize();
            p += dir * 0.4;
            Knot { p, radius: taper(i) }
        })
        .collect();
    let mut curves = Curves::new(style);
    curves.push(Basis::CubicBSpline, &knots);
    curves
}

fn of(curves: Curves, transform: &Transform) -> Geometry {
    let mut builder = GeometryBuilder::new();
    builder.add_curves(curves, transform).unwrap();
    builder.build().unwrap()
}

/// Place and radius, and their derivatives, of a Bézier curve.
pub(super) fn at(bezier: &[glam::DVec4; 4], w: f64) -> (glam::DVec4, glam::DVec4) {
    let [a, b, c, d] = *bezier;
    let v = 1.0 - w;
    let p = a * v.powi(3) + b * (3.0 * w * v * v) + c * (3.0 * w * w * v) + d * w.powi(3);
    (p, ((b - a) * (v * v) + (c - b) * (2.0 * v * w) + (d - c) * (w * w)) * 3.0)
}

/// How deep a point is in the tubes around these curves, over the radius: 1 on the axis, 0 on the surface, below 0 outside.
/// The feet of its perpendiculars are found by looking everywhere for a change of sign.
fn depth(curves: &[[glam::DVec4; 4]], p: DVec3) -> f64 {
    const STEPS: u32 = 200;
    let mut deepest = f64::NEG_INFINITY;
    for bezier in curves {
        let along = |w: f64| {
            let (c, d) = at(bezier, w);
            (p - c.truncate()).dot(d.truncate())
        };
        let mut before = along(0.0);
        for i in 1..=STEPS {
            let after = along(f64::from(i) / f64::from(STEPS));
            if before >= 0.0 && after <= 0.0 {
                let (mut low, mut high) = (f64::from(i - 1) / f64::from(STEPS), f64::from(i) / f64::from(STEPS));
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if along(middle) >= 0.0 { low = middle } else { high = middle }
                }
                let c = at(bezier, low).0;
                deepest = deepest.max(1.0 - (p - c.truncate()).length() / c.w);
            }
            before = after;
        }
    }
    deepest
}

/// Whether a tube is bent to less than twice its radius: near there it passes through itself.
fn folds(bezier: &[glam::DVec4; 4]) -> bool {
    let [a, b, c, d] = *bezier;
    (0..=50).any(|i| {
        let w = f64::from(i) / 50.0;
        let (p, v) = at(bezier, w);
        let bend = (a - b - b + c).lerp(b - c - c + d, w) * 6.0;
        let v = v.truncate();
        p.w * v.cross(bend.truncate()).length() > 0.5 * v.length().powi(3)
    })
}

/// A hit is on the surface to the rounding of t, and a ray that comes from outside is outside until there: of 400 places on
/// the way, none is deeper than a thousandth of the radius.
#[test]
fn a_ray_meets_a_tube_where_it_comes_in_and_never_passes_through() {
    let random = &mut Random(41);
    let (mut hits, mut misses) = (0, 0);
    for round in 0..100 {
        let curves = strand(Style::Round, 4 + round % 3, [0.005, 0.03, 0.1][round % 3], random);
        let beziers: Vec<_> = curves.beziers().collect();
        if beziers.iter().any(folds) {
            continue;
        }
        let geometry = of(curves, &Transform::IDENTITY);
        for _ in 0..16 {
            let bezier = beziers[(random.unit() * beziers.len() as f32) as usize];
            let (target, _) = at(&bezier, f64::from(random.unit()));
            let origin = target.truncate().as_vec3() + random.dir() * (1.0 + random.unit());
            let aim = target.truncate().as_vec3() + random.in_ball() * (1.5 * target.w as f32);
            let ray = Ray::new(origin, (aim - origin).normalize());
            if depth(&beziers, origin.as_dvec3()) > -1.0 {
                continue;
            }
            // The ends are open.
            let ends = [at(&beziers[0], 0.0), at(&beziers[beziers.len() - 1], 1.0)];
            let through = ends.iter().any(|(c, v)| {
                let (origin, dir) = (origin.as_dvec3(), ray.dir.as_dvec3());
                let t = (c.truncate() - origin).dot(v.truncate()) / dir.dot(v.truncate());
                (origin + dir * t - c.truncate()).length() < 1.01 * c.w
            });
            if through {
                continue;
            }
            let hit = geometry.intersect(&ray, f32::INFINITY);
            let end = hit.map_or(4.0, |hit| f64::from(hit.t));
            let (origin, dir) = (origin.as_dvec3(), ray.dir.as_dvec3());
            for i in 0..400 {
                let t = end * (f64::from(i) + 0.5) / 400.0;
                let found = depth(&beziers, origin + dir * t);
                assert!(found < 1e-3, "{ray:?} is {found} deep at {t}: {hit:?}");
            }
            let Some(hit) = hit else {
                misses += 1;
                continue;
            };
            hits += 1;
            let interaction = geometry.interaction(&ray, &hit);
            let found = depth(&beziers, interaction.p.as_dvec3());
            // Rounding of the point by 6e-8 of its size, over the radius; at the ends there is no perpendicular.
            assert!(found.abs() < 1e-6 / 0.0025 || found == f64::NEG_INFINITY, "{found} deep at {interaction:?}");
            assert!(interaction.ng.dot(ray.dir) <= 1e-6, "{interaction:?}");
        }
    }
    assert!(hits > 100 && misses > 20, "{hits} {misses}");
}

/// A strand of straight pieces that wanders, thicker and thinner from point to point.
pub(super) fn crooked(points: usize, radius: f32, random: &mut Random) -> Vec<Knot> {
    let (mut p, mut dir) = (random.in_ball(), random.dir());
    (0..points)
        .map(|_| {
            dir = (dir + random.in_ball() * 1.5).normalize();
            p += dir * 0.3;
            Knot { p, radius: radius * (0.4 + random.unit()) }
        })
        .collect()
}

/// How deep a point is in the deepest of the balls between two knots [length]: `r(w) − |p − c(w)|` is concave, so its greatest
/// value is found by thirds.
fn depth_in_balls(knots: &[Knot], p: DVec3) -> f64 {
    let deepest = |pair: &[Knot]| {
        let [a, b] = [pair[0], pair[1]].map(|k| k.p.as_dvec3().extend(k.radius.into()));
        let depth = |w: f64| {
            let ball = a.lerp(b, w);
            ball.w - (p - ball.truncate()).length()
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..45 {
            let [left, right] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if depth(left) < depth(right) { low = left } else { high = right }
        }
        depth(low).max(depth(0.0)).max(depth(1.0))
    };
    knots.windows(2).map(deepest).fold(f64::NEG_INFINITY, f64::max)
}

/// A ball moves along the strand and grows and shrinks. Rays at its surface, a third of them at joints and ends, the radius up to
/// more than half of a piece: outside until they hit, which is on the surface. Against the normal it gets deeper by the way.
#[test]
fn a_strand_of_straight_pieces_is_where_a_ball_goes_that_moves_along_it() {
    let random = &mut Random(46);
    let (mut hits, mut misses, mut caps) = (0, 0, 0);
    for round in 0..60 {
        let knots = crooked(2 + round % 4, [0.003, 0.03, 0.2][round % 3], random);
        let mut curves = Curves::new(Style::Round);
        curves.push(Basis::Linear, &knots);
        let geometry = of(curves, &Transform::IDENTITY);
        let least: f64 = knots.iter().map(|k| k.radius).fold(1.0, f32::min).into();
        for _ in 0..12 {
            let i = (random.unit() * (knots.len() - 1) as f32) as usize;
            let w = (random.unit() * 3.0 - 1.0).clamp(0.0, 1.0);
            let (target, radius) = (knots[i].p.lerp(knots[i + 1].p, w), knots[i].radius.max(knots[i + 1].radius));
            let origin = target + random.dir() * (1.0 + random.unit());
            if depth_in_balls(&knots, origin.as_dvec3()) > 0.0 {
                continue;
            }
            let aim = target + random.in_ball() * (1.3 * radius);
            let ray = Ray::new(origin, (aim - origin).normalize());
            let hit = geometry.intersect(&ray, f32::INFINITY);
            let end = hit.map_or(4.0, |hit| f64::from(hit.t));
            for k in 0..150 {
                let t = end * (f64::from(k) + 0.5) / 150.0;
                let found = depth_in_balls(&knots, origin.as_dvec3() + ray.dir.as_dvec3() * t);
                assert!(found < 1e-3 * least, "{ray:?} is {found} deep at {t}: {hit:?} {knots:?}");
            }
            let Some(hit) = hit else {
                misses += 1;
                continue;
            };
            hits += 1;
            let interaction = geometry.interaction(&ray, &hit);
            caps += u32::from(interaction.ng.dot(interaction.dpdu).abs() > 0.7 * interaction.dpdu.length());
            let (p, up) = (interaction.p.as_dvec3(), interaction.ng.as_dvec3());
            // Rounding of a point by 6e-8 of its size, on each axis.
            let found = depth_in_balls(&knots, p);
            assert!(found.abs() < 4e-7, "{found} deep at {interaction:?}");
            let below = depth_in_balls(&knots, p - up * (0.1 * least));
            assert!(below > 0.0999 * least - 4e-7, "{below} of {least} deep below {interaction:?}");
            assert!(interaction.ng.dot(ray.dir) <= 1e-6, "{interaction:?}");
        }
    }
    assert!(hits > 200 && misses > 40 && caps > 10, "{hits} {misses} {caps}");
}

/// The pieces of a straight strand fill one cone: what goes on through it meets neither balls nor pieces that lie within.
#[test]
fn light_in_a_straight_strand_of_many_pieces_meets_nothing() {
    let random = &mut Random(47);
    for tip in [0.1, 0.04] {
        let knot = |i: usize| Knot { p: Vec3::X * (0.1 * i as f32), radius: 0.1 + (tip - 0.1) * i as f32 / 8.0 };
        let mut curves = Curves::new(Style::Round);
        curves.push(Basis::Linear, &(0..=8).map(knot).collect::<Vec<_>>());
        let geometry = of(curves, &Transform::IDENTITY);
        let mut hits = 0;
        for _ in 0..500 {
            let origin = Vec3::X * 0.4 + random.dir() * 2.0;
            let aim = Vec3::X * (0.8 * random.unit()) + random.in_ball() * 0.05;
            let ray = Ray::new(origin, (aim - origin).normalize());
            let Some(hit) = geometry.intersect(&ray, f32::INFINITY) else { continue };
            hits += 1;
            let interaction = geometry.interaction(&ray, &hit);
            let again = geometry.intersect(&interaction.spawn(ray.dir), f32::INFINITY);
            assert_eq!(again, None, "{interaction:?}");
        }
        assert!(hits > 400, "{hits}");
    }
}

/// Rays at the axis from all around, also where segments meet.
#[test]
fn no_ray_slips_between_the_segments_of_a_strand() {
    let random = &mut Random(42);
    for style in [Style::Round, Style::Flat] {
        for _ in 0..30 {
            let curves = strand(style, 8, 0.01, random);
            let beziers: Vec<_> = curves.beziers().collect();
            if beziers.iter().any(folds) {
                continue;
            }
            let geometry = of(curves, &Transform::IDENTITY);
            for bezier in beziers.iter().skip(1) {
                for _ in 0..20 {
                    let (c, tangent) = at(bezier, 0.0);
                    let across = random.dir().as_dvec3().reject_from(tangent.truncate()).normalize();
                    let near = (random.unit() - 0.5) * 1e-6;
                    let target = c.truncate() + tangent.truncate() * f64::from(near);
                    let ray = Ray::new((target + across).as_vec3(), -across.as_vec3());
                    let hit = geometry.intersect(&ray, f32::INFINITY);
                    assert!(hit.is_some_and(|hit| hit.t < 1.0 + 1e-3), "{style:?}: {ray:?} {hit:?}");
                }
            }
        }
    }
}

/// A straight strand seen from beside: `v = (1 + h)/2` where h is the offset over the radius, on the side of `ω_o × ∂p/∂u`.
#[test]
fn v_is_the_offset_of_the_ray_across_the_strand() {
    for style in [Style::Flat, Style::Round] {
        let mut curves = Curves::new(style);
        let knot = |x: f32| Knot { p: Vec3::X * x, radius: 0.1 };
        curves.push(Basis::Linear, &[knot(0.0), knot(1.0), knot(2.0)]);
        let geometry = of(curves, &Transform::IDENTITY);
        for h in [-0.9, -0.3, 0.0, 0.5, 0.99] {
            // ω_o = z, ∂p/∂u = x: the positive side is +y.
            let ray = Ray::new(Vec3::new(1.5, 0.1 * h, 3.0), -Vec3::Z);
            let hit = geometry.intersect(&ray, f32::INFINITY).unwrap();
            let found = geometry.interaction(&ray, &hit);
            assert!(
                (found.uv.get().x - 0.75).abs() < 1e-6 && (found.uv.get().y - 0.5 - 0.5 * h).abs() < 1e-5,
                "{style:?} {found:?}"
            );
            assert!((found.dpdu - Vec3::X * 2.0).length() < 1e-5, "{found:?}");
            assert_eq!(geometry.intersect(&Ray::new(Vec3::new(1.0, 0.1001, 3.0), -Vec3::Z), 9.0), None);
        }
    }
}

/// What leaves a straight strand, outwards or through it, does not meet it again, at any size.
#[test]
fn what_leaves_a_strand_does_not_meet_it_again() {
    let random = &mut Random(43);
    for scale in [1e-6, 1.0, 1e6] {
        for style in [Style::Flat, Style::Round] {
            for _ in 0..50 {
                let (from, to) = (random.in_ball() * scale, random.in_ball() * scale);
                let mut curves = Curves::new(style);
                curves.push(Basis::Linear, &[from, to].map(|p| Knot { p, radius: 0.01 * scale }));
                let geometry = of(curves, &Transform::IDENTITY);
                let target = from.lerp(to, random.unit());
                let origin = target + random.dir() * 3.0 * scale;
                let ray = Ray::new(origin, (target - origin).normalize());
                let Some(hit) = geometry.intersect(&ray, f32::INFINITY) else { continue };
                let interaction = geometry.interaction(&ray, &hit);
                for _ in 0..20 {
                    let again = geometry.intersect(&interaction.spawn(random.dir()), f32::INFINITY);
                    assert_eq!(again, None, "{style:?} {interaction:?}");
                }
            }
        }
    }
}

/// Scaled by a million, or a millionth, the same rays meet the same places.
#[test]
fn strands_of_another_size_are_met_alike() {
    let one = |scale: f32| -> Vec<Option<(u32, f32)>> {
        let random = &mut Random(44);
        (0..200)
            .map(|_| {
                let curves = strand(Style::Round, 6, 0.05, random);
                let place = Transform::new(glam::DMat4::from_scale(DVec3::splat(scale.into()))).unwrap();
                let ray = Ray::new(random.dir() * 3.0 * scale, Vec3::ZERO);
                let geometry = of(curves, &place);
                let aim = geometry.bounds().centre() + random.in_ball() * 0.3 * scale;
                let ray = Ray::new(ray.origin, (aim - ray.origin).normalize());
                let found: Option<Hit> = geometry.intersect(&ray, f32::INFINITY);
                found.map(|hit| (hit.prim, hit.t / scale))
            })
            .collect()
    };
    let usual = one(1.0);
    assert!(usual.iter().flatten().count() > 20);
    for scale in [(-20f32).exp2(), 20f32.exp2()] {
        for (a, b) in usual.iter().zip(one(scale)) {
            match (a, b) {
                (None, None) => {}
                (Some(a), Some(b)) => assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-5, "{a:?} {b:?}"),
                _ => panic!("{a:?} {b:?}"),
            }
        }
    }
}

/// The bound is no more than the distance to the nearest of many points of the tube, and no less than that without the radius,
/// the bulge and the radius again.
#[test]
fn the_clearance_of_a_strand_is_near_the_distance_to_it() {
    let random = &mut Random(45);
    for _ in 0..100 {
        let curves = strand(Style::Round, 6, 0.02, random);
        let beziers: Vec<_> = curves.beziers().collect();
        let geometry = of(curves, &Transform::IDENTITY);
        for _ in 0..10 {
            let p = random.in_ball() * 2.0;
            let to_axis = |w: u32, bezier| {
                let c = at(bezier, f64::from(w) / 500.0).0;
                (c.truncate() - p.as_dvec3()).length() - c.w
            };
            let distance = beziers.iter().flat_map(|b| (0..=500).map(move |w| to_axis(w, b))).fold(9.0, f64::min);
            let clearance = f64::from(geometry.clearance(p, f32::INFINITY));
            assert!(clearance <= distance.max(0.0), "{p}: {clearance} {distance}");
            // A chord is nearer than its curve by the bulge, at most.
            let bulge = |[a, b, c, d]: &[glam::DVec4; 4]| {
                let bends = [*a - *b - *b + *c, *b - *c - *c + *d].map(|bend| bend.truncate().length());
                0.75 * bends[0].max(bends[1])
            };
            let slack = 2.0 * beziers.iter().map(bulge).fold(0.0, f64::max) + 0.02;
            assert!(clearance > distance - slack, "{p}: {clearance} {distance} {slack}");
        }
    }
}

/// What cannot be a strand is told, not met.
#[test]
fn strands_without_width_or_place_are_refused() {
    let add = |p: Vec3, radius: f32, transform: &Transform| {
        let mut curves = Curves::new(Style::Round);
        curves.push(Basis::Linear, &[Knot { p: Vec3::ZERO, radius }, Knot { p, radius }]);
        GeometryBuilder::new().add_curves(curves, transform).map_err(|e| e.to_string()).err()
    };
    let uneven = Transform::new(glam::DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0))).unwrap();
    for (found, expected) in [
        (add(Vec3::X, 0.0, &Transform::IDENTITY), "must be positive"),
        (add(Vec3::X, -1.0, &Transform::IDENTITY), "must be positive"),
        (add(Vec3::NAN, 1.0, &Transform::IDENTITY), "not finite"),
        (add(Vec3::X, f32::INFINITY, &Transform::IDENTITY), "not finite"),
        (add(Vec3::X, 1.0, &uneven), "stretched unevenly"),
    ] {
        assert!(found.as_ref().is_some_and(|found| found.contains(expected)), "{found:?}, not {expected}");
    }
}
