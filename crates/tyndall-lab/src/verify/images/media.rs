//! Media, through the image renderer.

use std::f64::consts::PI;

use super::stage::{Stage, direction};
use super::{Can, Made, by_each, falling, mean, volpath};
use crate::run::Estimate;
use crate::verify::balls::BALLS;
use crate::verify::experiment::{Check, Effort, Experiment};
use crate::verify::half_spaces::BRDF;
use crate::verify::late;
use crate::verify::layers::SLABS;
use crate::verify::table::{Row, rows};
use crate::world::Substance;
use tyndall::math::Vec3;

/// From how far bodies are looked at.
const EYE: f32 = 5.0;

/// In a furnace nothing can be seen: not what only scatters, not what glows as hot, behind a boundary or not.
pub(crate) fn furnace(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let cases = [
        ("scatters", 0.0, 1.0, 0.0, 1.0),
        ("scatters forward", 0.0, 0.6, 0.3, 1.0),
        ("scatters backward", 0.0, 0.3, -0.2, 1.0),
        ("scatters behind glass", 0.0, 0.5, 0.5, 1.5),
        ("glows", 1.0, 0.5, 0.3, 1.0),
        ("glows behind glass", 0.5, 0.5, 0.0, 1.3),
    ];
    let experiment = |(number, (what, sigma_a, sigma_s, g, n)): (usize, (&str, f64, f64, f64, f64))| {
        let substance = Substance { sigma_a, sigma_s, g, n };
        effort.experiment(family, number, |share| {
            let mut stage = Stage::seen(Vec3::new(0.0, 0.3, EYE), Vec3::new(0.0, 0.3, 0.0));
            // Behind a boundary a furnace holds n² of the radiance outside (Clausius).
            stage.ball(1.0, &substance, if sigma_a > 0.0 { n * n } else { 0.0 })?;
            stage.sky(1.0);
            let can = if sigma_a > 0.0 { Can::AllMedia } else { Can::Media };
            Ok(falling(by_each(share, can, stage.scene()?, &format!("a ball that {what}"), [1.0, 0.0])))
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}

/// A slab that only absorbs passes exp(−τ), and one that glows adds 1 − exp(−τ).
pub(crate) fn beer(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let cases = [(0.2, 1.0), (0.7, 1.0), (1.5, 1.0), (1.0, 0.5)];
    let experiment = |(number, (tau, mu)): (usize, (f64, f64))| {
        let dark = Substance { sigma_a: tau, ..Substance::VACUUM };
        let passes = (-tau / mu).exp();
        effort.experiment(family, number, |share| {
            let seen = |glow: f64| {
                let mut stage = Stage::seen(direction(mu, 1.0) * EYE, Vec3::ZERO);
                stage.slab(1.0, &dark, glow)?;
                stage.sky(if glow > 0.0 { 0.0 } else { 1.0 });
                stage.scene()
            };
            let name = |what: &str| format!("{what}, tau {tau}, mu {mu}");
            let mut checks = falling(by_each(share, Can::Media, seen(0.0)?, &name("absorbs"), [passes, 0.0]));
            checks.extend(by_each(share, Can::AllMedia, seen(1.0)?, &name("glows"), [1.0 - passes, 0.0]));
            Ok(checks)
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}

/// Lit by half a sky and seen along its normal a slab shows, by reciprocity, what it does to collimated light.
pub(crate) fn slabs(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let (table, effort) = (rows(SLABS), effort.finer(2.0));
    let thin = |row: &&Row| row.number("tau") <= 5.0 && row.number("albedo") > 0.0;
    let experiment = |(number, row): (usize, &Row)| {
        let [albedo, tau, g, n] = ["albedo", "tau", "g", "n"].map(|column| row.number(column));
        let substance = Substance { n, ..Substance::of_albedo(albedo, g) };
        let can = if tau <= 1.0 && g.abs() <= 0.5 && n == 1.0 { Can::Media } else { Can::AllMedia };
        effort.experiment(family, number, |share| {
            let lit = |above: f32, below: f32| {
                let mut stage = Stage::seen(Vec3::Z * EYE, Vec3::ZERO);
                stage.slab(tau, &substance, 0.0)?;
                stage.half_sky(above, below);
                stage.scene()
            };
            let name = |quantity: &str| format!("{quantity}, albedo {albedo}, tau {tau}, g {g}, n {n}");
            let expected = |column: &str| [row.number(column), 5e-7];
            let mut checks = by_each(share, can, lit(1.0, 0.0)?, &name("R"), expected("R_coll"));
            checks.extend(falling(by_each(share, can, lit(0.0, 1.0)?, &name("T"), expected("T_coll"))));
            Ok(checks)
        })
    };
    // Every fourth says as much as all.
    table.iter().filter(thin).step_by(4).enumerate().step_by(effort.every).map(experiment).collect()
}

/// `L = E ϖ/4π · 1/(μ + μ₀) · (1 − exp(−τ(1/μ + 1/μ₀)))` where `E` is the flux through the surface.
pub(crate) fn single(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    // Of the light that is sent in this is a small part: what would be enough for the whole must not end it.
    let effort = Effort { error: 0.0, ..effort.times(4) };
    let cases = [(0.3, 0.8, 0.48), (1.0, 0.8, 0.48), (3.0, 0.3, 0.9), (1.0, 1.0, 0.2)];
    let experiment = |(number, (tau, mu0, mu)): (usize, (f64, f64, f64))| {
        let albedo = 0.7;
        let expected = albedo / (4.0 * PI) / (mu + mu0) * (1.0 - (-tau * (1.0 / mu + 1.0 / mu0)).exp());
        effort.experiment(family, number, |share| {
            let mut stage = Stage::seen(direction(mu, 2.0) * EYE, Vec3::ZERO);
            stage.slab(tau, &Substance::of_albedo(albedo, 0.0), 0.0)?;
            stage.sun(direction(mu0, 0.0), 1.0 / mu0);
            let scene = share.scene(stage.scene()?);
            let name = format!("once scattered, tau {tau}, mu0 {mu0}, mu {mu}, volpath");
            Ok(vec![Check::new(name, expected, 0.0, mean(&scene, &volpath(Some(1)), share))])
        })
    };
    cases.into_iter().enumerate().map(experiment).collect()
}

/// Of the largest tables every ninth row is taken, of which all integrators render every fourth; a part takes fewer rows, and
/// those that all render.
fn coarse(effort: Effort) -> usize {
    if effort.every > 1 { 3 * effort.every } else { 9 }
}

/// Columns of rays with which a mean over azimuths is taken.
const AZIMUTHS: u32 = super::SIDE;

/// The radiance that leaves slabs, by direction, of a flux of 1 through the surface.
pub(crate) fn radiance(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let table = rows(include_str!("../../../data/slab_angular_disort.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let [albedo, tau, g, mu0, mu] = ["albedo", "tau", "g", "mu0", "mu_o"].map(|column| row.number(column));
        let substance = Substance::of_albedo(albedo, g);
        let azimuth = row.word("phi_deg");
        // Tables of hundreds of rows would take the others as long as all else together.
        let can = match number % 4 {
            0 if tau <= 2.0 && g.abs() <= 0.75 => Can::PointsInMedia,
            0 => Can::AllMedia,
            _ => Can::Everything,
        };
        effort.experiment(family, number, |share| {
            let seen = |side: f64| {
                let target = if side > 0.0 { Vec3::ZERO } else { Vec3::Z * -tau as f32 };
                let eye = |phi: f64| target + direction(side * mu, phi) * EYE;
                let mut stage = match azimuth.parse::<f64>() {
                    Ok(degrees) => Stage::seen(eye(degrees.to_radians()), target),
                    Err(_) => Stage::seen_by_many(
                        (0..AZIMUTHS).map(|i| [eye(PI * (f64::from(i) + 0.5) / f64::from(AZIMUTHS)), target]),
                    ),
                };
                stage.slab(tau, &substance, 0.0)?;
                stage.sun(-direction(-mu0, 0.0), 1.0 / mu0);
                stage.scene()
            };
            let name = |quantity: &str| {
                format!(
                    "{quantity}, {}, albedo {albedo}, tau {tau}, g {g}, mu0 {mu0}, mu {mu}, phi {azimuth}",
                    row.word("case")
                )
            };
            // One point of the table is known to 3·10⁻⁵, the others better.
            let expected = |column: &str| [row.number(column), if row.number("absdiff") < 2e-6 { 2e-6 } else { 3e-5 }];
            let mut checks = by_each(share, can, seen(1.0)?, &name("L_R"), expected("L_R"));
            checks.extend(falling(by_each(share, can, seen(-1.0)?, &name("L_T"), expected("L_T"))));
            // Behind a peaked phase function the light of a path is hardly anything, or much.
            Ok(checks.into_iter().map(Check::binned).collect())
        })
    };
    // Along the normal azimuth means nothing, but these rows of the table differ by it, by up to 4 %.
    let contradicts_itself = |row: &&Row| row.number("mu_o") == 1.0 && row.word("phi_deg") != "mean";
    let sound = table.iter().filter(|row| !contradicts_itself(row));
    sound.enumerate().step_by(coarse(effort)).map(experiment).collect()
}

/// The BRDF of the half-space that scatters alike in all directions.
pub(crate) fn brdf(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    // A radiance is a small part of the light that is sent in.
    let effort = effort.finer(4.0);
    let table = rows(BRDF);
    let experiment = |(number, row): (usize, &Row)| {
        let [albedo, mu_i, mu_o] = ["albedo", "mu_i", "mu_o"].map(|column| row.number(column));
        effort.experiment(family, number, |share| {
            let scene = || {
                let mut stage = Stage::seen(direction(mu_o, 1.0) * EYE, Vec3::ZERO);
                stage.slab(f64::INFINITY, &Substance::of_albedo(albedo, 0.0), 0.0)?;
                stage.sun(direction(mu_i, 0.0), 1.0 / mu_i);
                stage.scene()
            };
            let name = |column: &str| format!("{column}, albedo {albedo}, mu_i {mu_i}, mu_o {mu_o}");
            let spoiled = share.scene(scene()?);
            let up_to = |orders: u32| mean(&spoiled, &volpath(Some(orders)), share.again(orders));
            let mut checks = if albedo == 1.0 {
                vec![Check::new(name("f, volpath"), row.number("f"), late::ACCURACY, extrapolated(up_to))]
            } else {
                by_each(share, Can::AllMedia, scene()?, &name("f"), [row.number("f"), 1e-9])
            };
            let (first, both) = (row.number("f1"), row.number("f1") + row.number("f2"));
            checks.push(Check::new(name("f1"), first, 1e-9, up_to(1)));
            checks.push(Check::new(name("f1 + f2"), both, 1e-9, up_to(2)));
            Ok(checks)
        })
    };
    table.iter().enumerate().step_by(coarse(effort)).map(experiment).collect()
}

/// What all orders give, of what those up to N, 4 N and 16 N do: see [`late`].
fn extrapolated(up_to: impl Fn(u32) -> Estimate) -> Estimate {
    let parts = [(16.0, 1024), (-10.0, 256), (1.0, 64)].map(|(factor, orders)| up_to(orders).scaled(factor / 7.0));
    let mean = parts.iter().map(|part| part.mean).sum();
    Estimate { mean, standard_error: parts.iter().map(|part| part.standard_error.powi(2)).sum::<f64>().sqrt() }
}

/// Before a uniform sky a ball shows 1 − A of it on the mean over its disk, A being what it absorbs; the image is a square.
pub(crate) fn balls(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let table = rows(BALLS);
    // Where next to nothing is absorbed, next to no sample would say so.
    let small = |row: &&Row| row.number("R") <= 5.0 && row.number("c") > 0.0 && row.number("A_abs") > 0.02;
    let experiment = |(number, row): (usize, &Row)| {
        let (radius, albedo) = (row.number("R"), row.number("c"));
        let can = if radius <= 0.5 { Can::Media } else { Can::AllMedia };
        effort.experiment(family, number, |share| {
            let mut stage = Stage::from_above(radius as f32);
            stage.ball(radius as f32, &Substance::of_albedo(albedo, 0.0), 0.0)?;
            stage.sky(1.0);
            let expected = 1.0 - PI / 4.0 * row.number("A_abs");
            let name = format!("mean over a square, radius {radius}, albedo {albedo}");
            Ok(falling(by_each(share, can, stage.scene()?, &name, [expected, 1e-9])))
        })
    };
    table.iter().filter(small).enumerate().step_by(effort.every).map(experiment).collect()
}
