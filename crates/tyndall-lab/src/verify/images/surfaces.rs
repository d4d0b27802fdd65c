//! Surfaces, through the image renderer.

use super::stage::{Stage, WIDE, diffuse, direction, glass};
use super::{Can, Made, Named, by_each, falling, integrators, mean, volpath};
use crate::verify::experiment::{Check, Effort, Experiment};
use crate::verify::surfaces::GROUND_TRUTHS;
use crate::verify::table::{Row, rows};
use crate::world::Substance;
use tyndall::math::Vec3;
use tyndall::scene::Scene;

/// A place in a sphere around the origin, and another.
const INSIDE: [Vec3; 2] = [Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 1.0, 0.5)];

/// The number that follows a word of the parameters.
fn after(parameters: &str, word: &str) -> f64 {
    let rest = parameters.split(word).nth(1).unwrap_or("");
    let number = rest.split(|c: char| !(c.is_ascii_digit() || c == '.')).next().unwrap_or("");
    number.trim_end_matches('.').parse().unwrap_or(f64::NAN)
}

/// A body whose light builds up to a closed form.
fn enclosure(row: &Row) -> Option<(Can, Made<Scene>)> {
    let parameters = row.word("parameters");
    let [eye, target] = INSIDE;
    match row.word("quantity") {
        "closed_enclosure_radiance" => {
            let rho = after(parameters, "rho=");
            // Weights of the lecture's roulette have no finite variance from ρ² = 0.9 on.
            let can = if rho * rho < 0.9 { Can::ClosedSurfaces } else { Can::AllMedia };
            let mut stage = Stage::seen(eye, target);
            let made = stage.shining_ball(Vec3::ZERO, 1.0, diffuse(rho), true);
            Some((can, made.and_then(|()| stage.scene())))
        }
        "sphere_point_light_center" if parameters.starts_with("unit sphere") => {
            let mut stage = Stage::seen(eye, target);
            let made = stage.solid_ball(Vec3::ZERO, 1.0, diffuse(after(parameters, "rho=")));
            stage.point_light();
            Some((Can::PointsOnSurfaces, made.and_then(|()| stage.scene())))
        }
        "infinite_parallel_plates" => {
            let upper = parameters.starts_with("emitter");
            let mut stage = Stage::seen(Vec3::ZERO, Vec3::new(0.3, 0.1, if upper { 1.0 } else { -1.0 }));
            let made = stage.lamp(1.0, WIDE, diffuse(0.5)).and_then(|()| stage.floor(-1.0, WIDE, diffuse(0.8)));
            Some((Can::WideLamps, made.and_then(|()| stage.scene())))
        }
        _ => None,
    }
}

pub(crate) fn enclosures(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let table = rows(GROUND_TRUTHS);
    let mut experiments = Vec::new();
    for (number, row) in table.iter().enumerate() {
        if enclosure(row).is_none() {
            continue;
        }
        let what = format!("{} ({})", row.word("quantity"), row.word("parameters"));
        experiments.push(effort.experiment(family, number, |share| match enclosure(row) {
            Some((can, scene)) => Ok(by_each(share, can, scene?, &what, [row.number("value"), 1e-12])),
            None => Ok(Vec::new()),
        })?);
    }
    Ok(experiments)
}

/// Reflectance of a floor.
const FLOOR: f64 = 0.8;

/// Puts a luminaire over a floor.
type Lamp = fn(&mut Stage) -> Made<()>;

/// A floor shines with ρE/π, and a luminaire of radiance 1 that fills the part F of what a place sees makes E = πF.
pub(crate) fn floors(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let table = rows(GROUND_TRUTHS);
    let printed = |quantity: &str, start: &str| {
        let row = table.iter().find(|r| r.word("quantity") == quantity && r.word("parameters").starts_with(start));
        row.map_or(f64::NAN, |row| row.number("value"))
    };
    let polygon = "irradiance_over_piL_polygon";
    let cases: [(&str, f64, Lamp); 4] = [
        ("a ball", printed("irradiance_over_piL_sphere_light", "radius r"), |stage| {
            stage.shining_ball(Vec3::Z * 2.0, 0.5, diffuse(0.0), false)
        }),
        ("a square", printed(polygon, "unit square"), |stage| stage.panel(Vec3::new(-0.5, -0.5, 1.0), [1.0; 2])),
        ("a rectangle", printed(polygon, "Cornell"), |stage| stage.panel(Vec3::new(-0.05, -0.1, 2.0), [0.5, 0.4])),
        // Of a place under its middle: r²/(r² + h²).
        ("a disk", 0.36 / (0.36 + 1.0), |stage| stage.lamp(1.0, 0.6, diffuse(0.0))),
    ];
    let experiment = |(number, (what, part, lamp)): (usize, (&str, f64, Lamp))| {
        effort.experiment(family, number, |share| {
            let mut stage = Stage::seen(Vec3::new(0.0, 2.0, 0.5), Vec3::ZERO);
            stage.floor(0.0, 50.0, diffuse(FLOOR))?;
            lamp(&mut stage)?;
            let what = format!("a floor under {what}");
            Ok(by_each(share, Can::Surfaces, stage.scene()?, &what, [FLOOR * part, 1e-12]))
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}

/// Fresnel's reflectance of unpolarised light that falls on glass at a cosine.
fn fresnel(cosine: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - cosine * cosine) / (n * n)).sqrt();
    let s = (cosine - n * inside) / (cosine + n * inside);
    let p = (n * cosine - inside) / (n * cosine + inside);
    f64::midpoint(s * s, p * p)
}

/// A pane, both faces of which reflect F, reflects 2F/(1 + F) and passes the rest.
pub(crate) fn panes(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let cases = [(1.0, 1.5), (0.5, 1.5), (0.2, 1.5), (0.1, 1.33), (0.4, 2.0), (0.3, 1.33)];
    let experiment = |(number, (cosine, n)): (usize, (f64, f64))| {
        let f = fresnel(cosine, n);
        effort.experiment(family, number, |share| {
            let lit = |above: f32, below: f32| {
                let mut stage = Stage::seen(direction(cosine, 0.0) * 5.0, Vec3::ZERO);
                stage.slab(1.0, &Substance { n, ..Substance::VACUUM }, 0.0)?;
                stage.half_sky(above, below);
                stage.scene()
            };
            let name = |what: &str| format!("a pane {what}, mu {cosine}, n {n}");
            let reflected = 2.0 * f / (1.0 + f);
            let mut checks = by_each(share, Can::Surfaces, lit(1.0, 0.0)?, &name("reflects"), [reflected, 0.0]);
            let passes = [1.0 - reflected, 0.0];
            checks.extend(falling(by_each(share, Can::Surfaces, lit(0.0, 1.0)?, &name("passes"), passes)));
            Ok(checks)
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}

/// A room with a lamp, a ball of glass and a diffuse one: caustics, several bounces.
fn room() -> Made<Scene> {
    let mut stage = Stage::seen(Vec3::new(0.5, -4.0, 1.5), Vec3::new(0.1, 0.3, -1.0));
    stage.floor(-1.0, 4.0, diffuse(0.7))?;
    stage.solid_ball(Vec3::new(1.1, 0.0, -0.4), 0.6, diffuse(0.5))?;
    stage.solid_ball(Vec3::new(-0.6, 0.2, -0.3), 0.6, glass(1.5))?;
    stage.lamp(2.0, 1.0, diffuse(0.2))?;
    stage.sky(0.1);
    stage.scene()
}

/// A ball of fog over a floor, under a lamp.
fn fog() -> Made<Scene> {
    let mut stage = Stage::seen(Vec3::new(0.1, -4.0, 0.5), Vec3::new(0.0, 0.0, 0.1));
    stage.ball(1.0, &Substance { sigma_a: 0.2, sigma_s: 1.0, g: 0.3, n: 1.0 }, 0.0)?;
    stage.floor(-1.5, 4.0, diffuse(0.5))?;
    stage.lamp(3.0, 1.5, diffuse(0.0))?;
    stage.scene()
}

/// Makes a world.
type Make = fn() -> Made<Scene>;

/// No closed form: all must agree with the workhorse.
pub(crate) fn agreement(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let cases: [(&str, Can, Make); 2] = [("a room", Can::Surfaces, room), ("fog", Can::Media, fog)];
    let experiment = |(number, (what, can, make)): (usize, (&str, Can, Make))| {
        effort.experiment(family, number, |share| {
            let scene = share.scene(make()?);
            let workhorse = mean(&scene, &volpath(None), share.again(u32::MAX));
            let difference = |with: &Named| {
                let own = mean(&scene, with, share);
                let measured = crate::run::Estimate {
                    mean: 1.0 + own.mean - workhorse.mean,
                    standard_error: own.standard_error.hypot(workhorse.standard_error),
                };
                Check::new(format!("{what}, 1 + {} − volpath", with.name), 1.0, 0.0, measured)
            };
            Ok(integrators(can).iter().map(difference).collect())
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}
