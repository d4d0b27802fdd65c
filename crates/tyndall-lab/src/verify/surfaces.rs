//! What boundaries reflect of diffuse light, how long light stays in bodies, and how a ball of glass scatters.

use super::experiment::{Check, Effort, Experiment};
use super::table::{Row, rows};
use crate::ball::{self, Source};
use crate::slab::{Edges, Incidence, Setup};
use crate::world::{SetupError, Substance};

pub(super) const GROUND_TRUTHS: &str = include_str!("../../data/surface_ground_truths.csv");

/// Averages of Fresnel's reflectance: of a half-space that absorbs all that enters, seen from outside, or from inside.
pub(super) fn fresnel(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(GROUND_TRUTHS);
    let mut experiments = Vec::new();
    for (number, row) in table.iter().enumerate() {
        let (quantity, parameters) = (row.word("quantity"), row.word("parameters"));
        let (power, from_inside) = match quantity {
            "fresnel_diffuse_external" => (1.0, false),
            "fresnel_diffuse_internal" | "fresnel_moment_C1_internal" => (1.0, true),
            "fresnel_moment_C2_internal" => (2.0, true),
            _ => continue,
        };
        let n: f64 = index(parameters);
        let dark = |n| Substance { sigma_a: 1.0, n, ..Substance::VACUUM };
        let mut setup = Setup::one(dark(if from_inside { 1.0 } else { n }), f64::INFINITY, Incidence::Power(power));
        if from_inside {
            setup.n_above = n;
        }
        experiments.push(effort.experiment(family, number, |share| {
            let m = share.slab(&setup)?;
            Ok(vec![Check::new(format!("{quantity}, n {n}"), row.number("value"), 1e-12, m.reflectance)])
        })?);
    }
    Ok(experiments)
}

/// The index of parameters that begin with `n=`.
fn index(parameters: &str) -> f64 {
    let number = parameters.trim_start_matches("n=").split_whitespace().next();
    number.and_then(|n| n.parse().ok()).unwrap_or(f64::NAN)
}

/// The mean way of diffuse light through a body that absorbs nothing is `4V/S`, however it scatters (Blanco and Fournier
/// 2003), and n² times that behind a boundary of index n.
pub(super) fn mean_ways(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(GROUND_TRUTHS);
    let chord = |what: &str| {
        let row = table
            .iter()
            .find(|row| row.word("quantity") == "mean_chord_4V_S" && row.word("parameters").starts_with(what));
        row.map_or(f64::NAN, |row| row.number("value"))
    };
    let (sphere, slab) = (chord("sphere R=1"), chord("slab"));
    let cases =
        [(0.5, 0.0, 1.0), (3.0, 0.8, 1.0), (10.0, 0.0, 1.0), (4.0, -0.5, 1.0), (2.0, 0.0, 1.5), (8.0, 0.7, 1.33)];
    let mut experiments = Vec::new();
    for (number, (sigma_s, g, n)) in cases.into_iter().enumerate() {
        let substance = Substance { sigma_a: 0.0, sigma_s, g, n };
        let mut setup = Setup::one(substance, 1.0, Incidence::Diffuse);
        setup.bins.depths = Edges::uniform(1, 1.0);
        experiments.push(effort.experiment(family, number, |share| {
            let scene = share.scene(ball::scene(&substance, 1.0, Source::Beam)?);
            let in_ball =
                ball::balance_in(&scene, &substance, 1.0, Source::Beam, share.photons, share.seed, share.look(3..4));
            let in_slab = share.slab(&setup)?;
            let name = |body: &str| format!("mean way in a {body}, sigma_s {sigma_s}, g {g}, n {n}");
            Ok(vec![
                Check::new(name("ball"), n * n * sphere, 0.0, in_ball.way),
                Check::new(name("slab"), n * n * slab, 0.0, in_slab.fluence[0]),
            ])
        })?);
    }
    Ok(experiments)
}

/// A smooth ball of glass in a beam: what is not absorbed, and where it goes.
pub(super) fn grains(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/granular_glass_sphere_grain.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let [n, sigma_a] = ["n", "sigma_a"].map(|column| row.number(column));
        let glass = Substance { sigma_a, n, ..Substance::VACUUM };
        effort.experiment(family, number, |share| {
            let scene = share.scene(ball::scene(&glass, 1.0, Source::Beam)?);
            let m = ball::balance_in(&scene, &glass, 1.0, Source::Beam, share.photons, share.seed, share.look(1..3));
            let (albedo, g) = (row.number("albedo_scalar"), row.number("g_scalar"));
            let name = |quantity: &str| format!("{quantity}, grain of n {n}, sigma_a {sigma_a}");
            Ok(vec![
                Check::new(name("albedo"), albedo, 1e-6, m.escaped),
                Check::new(name("albedo times g"), albedo * g, 2e-6, m.forward).falling(),
            ])
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}
