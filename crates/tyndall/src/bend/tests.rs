//! The search for the bend of a way against closed forms, and the spread of ways against their neighbours.

use super::*;

/// Indices on the side of `x` over those beyond: water, glass and diamond seen from inside, no step, and glass from outside.
const INDICES: [f32; 5] = [1.33, 1.5, 2.4, 1.0, 1.0 / 1.5];

fn point(p: Vec3) -> Goal {
    Goal::Point { p, ng: Vec3::Y }
}

/// The root of an increasing function between `low` and `high`.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// In the plane of incidence Snell's law is one equation for the place `r` on the face: `η r/√(r² + h²) = (w − r)/√((w − r)² + H²)`.
#[test]
fn behind_a_flat_face_the_way_obeys_snells_law() {
    let mut random = testkit::Stream::new(1);
    let mut lost = 0;
    for eta in INDICES {
        for depth in [1e-4, 0.03, 1.0, 50.0] {
            let x = Vec3::new(0.3, -0.2, 0.1);
            let [normal, turn] = [0, 1].map(|_| Vec3::from_array([0; 3].map(|_| random.next_f64() as f32 - 0.5)));
            let normal = normal.as_dvec3().normalize();
            let along = turn.as_dvec3().reject_from_normalized(normal).normalize();
            let foot = x.as_dvec3() + normal * depth;
            let wall = Wall::plane(foot + along * 7.0, normal * 3.0, x.as_dvec3()).unwrap();
            for (wide, high) in [(0.0, 3.0), (2.0, 3.0), (9.0, 0.5), (0.1, 1e-3), (200.0, 20.0)] {
                let y = (foot + along * wide + normal * high).as_vec3();
                // As rounded: where it really is.
                let from_foot = y.as_dvec3() - foot;
                let (wide, high) = (from_foot.dot(along), from_foot.dot(normal));
                let sines = |r: f64| f64::from(eta) * r / r.hypot(depth) - (wide - r) / (wide - r).hypot(high);
                let r = root(wide.min(0.0) - 1e-9, wide.max(0.0) + 1e-9, sines);
                let expected = ((foot + along * r) - x.as_dvec3()).normalize();
                let found = wall.bend(x, eta, &point(y), f32::INFINITY);
                let Some(found) = found else {
                    assert!(eta <= 1.0, "η = {eta}, depth {depth}, to ({wide}, {high}): not found");
                    lost += 1;
                    continue;
                };
                let off = (found.dir.as_dvec3() - expected).length();
                assert!(off < 1e-5, "η = {eta}, depth {depth}, to ({wide}, {high}): {off:e}");
            }
        }
    }
    assert!(lost <= 4, "{lost} of the 40 ways without a denser inside");
}

/// Of parallel light the sine is divided by the index, wherever `x` is.
#[test]
fn parallel_light_bends_by_the_sine() {
    let x = Vec3::new(1.0, 2.0, 3.0);
    let wall = Wall::plane(DVec3::new(0.0, 5.0, 0.0), DVec3::NEG_Y, x.as_dvec3()).unwrap();
    for eta in INDICES {
        for sine in [0.0f32, 0.2, 0.6, 0.99] {
            let dir = Vec3::new(sine * 0.6, (1.0 - sine * sine).sqrt(), sine * 0.8);
            let found = wall.bend(x, eta, &Goal::Infinity(dir), f32::INFINITY);
            let Some(found) = found else {
                assert!(sine / eta > 1.0, "{eta} {sine}: there is a way");
                continue;
            };
            assert!((Vec3::new(found.dir.x, 0.0, found.dir.z) * eta - Vec3::new(dir.x, 0.0, dir.z)).length() < 1e-6);
        }
    }
}

/// Near the wall of a ball the way lies in the plane of incidence, and is found by bisecting the angle at the centre.
#[test]
fn behind_the_wall_of_a_ball_the_way_obeys_snells_law() {
    let (centre, radius) = (DVec3::new(1.0, -2.0, 0.5), 3.0);
    for eta in [1.0, 1.33, 1.5, 2.4] {
        for depth in [1e-3, 0.1, 0.7] {
            for (beside, height) in [(0.0, 1.0), (0.5, 2.0), (-3.0, 4.0), (1.0, 300.0)] {
                // The plane z = z of the centre, `x` under the top of the ball.
                let x = (centre + DVec3::Y * (radius - depth)).as_vec3();
                let y = (centre + DVec3::new(beside, radius + height, 0.0)).as_vec3();
                let sines = |angle: f64| {
                    let n = DVec3::new(angle.sin(), angle.cos(), 0.0);
                    let (s, tangent) = (centre + n * radius, DVec3::new(n.y, -n.x, 0.0));
                    let d = (s - x.as_dvec3()).normalize();
                    let u = (y.as_dvec3() - s).normalize();
                    f64::from(eta) * d.dot(tangent) - u.dot(tangent)
                };
                let end = f64::atan2(beside, radius + height);
                let angle = root(end.min(0.0) - 1e-9, end.max(0.0) + 1e-9, sines);
                let s = centre + DVec3::new(angle.sin(), angle.cos(), 0.0) * radius;
                let expected = (s - x.as_dvec3()).normalize();
                let wall = Wall::ball(centre, radius, x.as_dvec3()).unwrap();
                let found = wall
                    .bend(x, eta, &point(y), f32::INFINITY)
                    .unwrap_or_else(|| panic!("{eta} {depth} {beside} {height}"));
                let off = (found.dir.as_dvec3() - expected).length();
                assert!(off < 1e-5, "η = {eta}, depth {depth}, to ({beside}, {height}): {off:e}");
            }
        }
    }
}

/// Planes and balls around a place, and goals near and infinitely far away.
fn cases() -> Vec<(Wall, Vec3, Goal)> {
    let x = Vec3::new(0.1, 0.2, -0.3);
    let walls = [
        Wall::plane(DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.2, 1.0, 0.1), x.as_dvec3()),
        Wall::ball(DVec3::new(0.0, -0.5, 0.0), 1.1, x.as_dvec3()),
        Wall::ball(DVec3::new(0.1, -20.0, 0.0), 20.3, x.as_dvec3()),
    ];
    let goals = [
        point(Vec3::new(0.0, 2.0, 0.0)),
        point(Vec3::new(2.0, 1.5, -1.0)),
        point(Vec3::new(-30.0, 20.0, 10.0)),
        Goal::Infinity(Vec3::new(0.1, 1.0, 0.2).normalize()),
        Goal::Infinity(Vec3::new(-1.0, 0.6, 0.3).normalize()),
    ];
    walls.into_iter().flatten().flat_map(|wall| goals.map(|goal| (wall, x, goal))).collect()
}

/// What the Hessian says of `dω/dA` is what becomes of the direction when the goal moves by a little, across its light.
#[test]
fn the_spread_is_that_of_neighbouring_ways() {
    for (wall, x, goal) in cases() {
        for eta in INDICES {
            let Some(found) = wall.bend(x, eta, &goal, f32::INFINITY) else { continue };
            let (e1, e2) = found.onward.any_orthonormal_pair();
            let (step, moved): (f32, Box<dyn Fn(Vec3) -> Goal>) = match goal {
                Goal::Point { p, .. } => (0.01 * p.distance(x), Box::new(move |by| point(p + by))),
                Goal::Infinity(dir) => (0.01, Box::new(move |by| Goal::Infinity((dir + by).normalize()))),
            };
            // Differences over two steps: their error is of fourth order, and of rounding 10⁻⁵.
            let derivative = |e: Vec3| {
                let at = |k: f32| wall.bend(x, eta, &moved(e * (k * step)), f32::INFINITY).unwrap().dir.as_dvec3();
                (at(-2.0) - at(2.0) + 8.0 * (at(1.0) - at(-1.0))) / (12.0 * f64::from(step))
            };
            let expected = derivative(e1).cross(derivative(e2)).length();
            let spread = f64::from(found.spread);
            assert!((spread / expected - 1.0).abs() < 1e-3, "{wall:?} {goal:?} {eta}: {spread} for {expected}");
        }
    }
}

/// Without a step of the index nothing bends: the way is straight, and a lamp looks as wide as it is.
#[test]
fn without_a_step_of_the_index_light_goes_straight() {
    for (wall, x, goal) in cases() {
        let Some(found) = wall.bend(x, 1.0, &goal, f32::INFINITY) else { panic!("{wall:?} {goal:?}") };
        let expected = match goal {
            Goal::Point { p, .. } => 1.0 / p.distance_squared(x),
            Goal::Infinity(_) => 1.0,
        };
        assert!((found.dir - goal.straight(x)).length() < 1e-6, "{found:?}");
        assert!((found.spread / expected - 1.0).abs() < 1e-5, "{found:?} for {expected}");
    }
}

/// The same way in a world of another size.
#[test]
fn the_way_does_not_depend_on_the_size_of_the_world() {
    for scale in [1e-6, 1e6f32] {
        let far = f64::from(scale);
        for (wall, x, goal) in cases() {
            let scaled = Wall { point: wall.point * far, normal: wall.normal, curvature: wall.curvature / far };
            let (goal_there, area) = match goal {
                Goal::Point { p, ng } => (Goal::Point { p: p * scale, ng }, scale * scale),
                Goal::Infinity(_) => (goal, 1.0),
            };
            let (here, there) =
                (wall.bend(x, 1.5, &goal, f32::INFINITY), scaled.bend(x * scale, 1.5, &goal_there, f32::INFINITY));
            let (Some(here), Some(there)) = (here, there) else { panic!("{here:?} {there:?}") };
            assert!((here.dir - there.dir).length() < 1e-5 && (there.spread * area / here.spread - 1.0).abs() < 1e-4);
        }
    }
}
