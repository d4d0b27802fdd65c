//! Slabs and half-spaces.

use super::table::{Row, edges, grouped, rows};
use super::{Check, Effort, Experiment, Share};
use crate::run::Estimate;
use crate::slab::{Edges, Incidence, Measured, Setup, measure};
use crate::world::{SetupError, Substance};

/// Accuracy of the tables of totals.
const TABLE: f64 = 5e-7;

/// The experiment on one layer.
fn run(setup: &Setup, share: Share) -> Result<Measured, SetupError> {
    // The first quantities are what leaves.
    measure(setup, share.photons, share.seed, share.look(0..6))
}

pub(super) fn slabs(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/slab_RT_iadpython_grid.csv"));
    let mut experiments = Vec::new();
    for (number, row) in table.iter().enumerate().step_by(effort.every) {
        let [albedo, tau, g, n] = ["albedo", "tau", "g", "n"].map(|column| row.number(column));
        if returns_late(albedo, tau) {
            continue;
        }
        let substance = Substance { n, ..Substance::of_albedo(albedo, g) };
        for (incidence, what) in [(Incidence::Beam(1.0), "coll"), (Incidence::Diffuse, "diff")] {
            let setup = Setup::one(substance, tau, incidence);
            let number = 2 * number + usize::from(what == "diff");
            experiments.push(effort.experiment(family, number, |share| {
                let m = run(&setup, share)?;
                let mut figures = vec![("R", m.reflectance)];
                figures.extend((what == "coll").then_some(("Ru", m.specular)));
                figures.extend(tau.is_finite().then_some(("T", m.transmittance)));
                let check = |(quantity, measured)| Check {
                    family,
                    name: format!("{quantity}_{what}, albedo {albedo}, tau {tau}, g {g}, n {n}"),
                    expected: row.number(&format!("{quantity}_{what}")),
                    uncertainty: TABLE,
                    measured,
                };
                Ok(figures.into_iter().map(check).collect())
            })?);
        }
    }
    Ok(experiments)
}

/// From a half-space that absorbs nothing every photon returns, but after a time without mean: no experiment that ends
/// measures that it is all of them.
fn returns_late(albedo: f64, tau: f64) -> bool {
    albedo == 1.0 && tau.is_infinite()
}

pub(super) fn half_spaces(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/chandrasekhar_albedo.csv"));
    let mut experiments = Vec::new();
    for (number, row) in table.iter().enumerate().step_by(effort.every) {
        let albedo = row.number("albedo");
        let mu0 = row.word("mu0");
        let incidence = if mu0 == "diffuse" { Incidence::Diffuse } else { Incidence::Beam(row.number("mu0")) };
        if returns_late(albedo, f64::INFINITY) {
            continue;
        }
        let mut setup = Setup::one(Substance::of_albedo(albedo, 0.0), f64::INFINITY, incidence);
        setup.bins.orders = 3;
        experiments.push(effort.experiment(family, number, |share| {
            let m = run(&setup, share)?;
            let figures = [("R", m.reflectance), ("R1", m.reflectance_by_order[1]), ("R2", m.reflectance_by_order[2])];
            let check = |(column, measured)| Check {
                family,
                name: format!("{column}, albedo {albedo}, mu0 {mu0}"),
                expected: row.number(column),
                uncertainty: 1e-9,
                measured,
            };
            Ok(figures.into_iter().map(check).collect())
        })?);
    }
    Ok(experiments)
}

/// The case of a row of MCML's.
fn mcml(row: &Row) -> Setup {
    let [n, sigma_a, sigma_s, g, thickness] = ["n", "mu_a", "mu_s", "g", "thickness"].map(|column| row.number(column));
    // Its half-spaces are slabs of 10⁸.
    let thickness = if thickness >= 1e7 { f64::INFINITY } else { thickness };
    Setup::one(Substance { sigma_a, sigma_s, g, n }, thickness, Incidence::Beam(1.0))
}

const MCML_TOTALS: &str = include_str!("../../data/mcml_totals_vs_adding.csv");

pub(super) fn mcml_totals(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(MCML_TOTALS);
    let experiment = |(number, row): (usize, &Row)| {
        let setup = mcml(row);
        let case = row.word("case");
        effort.experiment(family, number, |share| {
            let m = run(&setup, share)?;
            let diffuse = Estimate { mean: m.reflectance.mean - m.first_surface, ..m.reflectance };
            let mut figures = vec![("Rd", "Rd_exact", diffuse)];
            if setup.layers[0].thickness.is_finite() {
                figures.push(("T", "Tt_exact", m.transmittance));
            }
            let check = |(quantity, column, measured)| Check {
                family,
                name: format!("{quantity}, {case}"),
                expected: row.number(column),
                uncertainty: TABLE,
                measured,
            };
            Ok(figures.into_iter().map(check).collect())
        })
    };
    table.iter().enumerate().map(experiment).collect()
}

pub(super) fn by_angle(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let totals = rows(MCML_TOTALS);
    let table = rows(include_str!("../../data/mcml_angular_vdh.csv"));
    let mut setup = mcml(&totals[0]);
    setup.bins.angles = table.len();
    let experiment = effort.experiment(family, 0, |share| {
        // 60 bins share the photons of one experiment: it gets those of many.
        let m = run(&setup, Share { photons: 20 * share.photons, ..share })?;
        let mut checks = Vec::new();
        for (i, row) in table.iter().enumerate() {
            let alpha = row.word("alpha_mid_deg");
            let mut add = |quantity: &str, column: &str, measured| {
                let (name, expected) = (format!("{quantity} at {alpha}°"), row.number(column));
                checks.push(Check { family, name, expected, uncertainty: TABLE, measured });
            };
            add("Rd", "Rd_exact", m.reflectance_by_angle[i]);
            // The first bin of the transmittance has the unscattered beam, and is a total of the table before.
            if i > 0 {
                add("Td", "Tt_exact_diffuse", m.transmittance_by_angle[i]);
            }
        }
        Ok(checks)
    })?;
    Ok(vec![experiment])
}

pub(super) fn by_radius(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let totals = rows(MCML_TOTALS);
    let table = rows(include_str!("../../data/mcml_R_of_r.csv"));
    let mut experiments = Vec::new();
    for (number, (case, rings)) in grouped(&table, |row| row.word("case")).into_iter().enumerate() {
        let Some(total) = totals.iter().find(|row| row.word("case") == case) else { continue };
        let mut setup = mcml(total);
        setup.bins.radii = Edges(edges(&rings));
        experiments.push(effort.experiment(family, number, |share| {
            let m = run(&setup, share)?;
            let check = |ring: &&Row| {
                let bin @ [inner, outer] = ["r_lo", "r_hi"].map(|column| ring.number(column));
                let found = setup.bins.radii.find(f64::midpoint(inner, outer))?;
                (setup.bins.radii.bin(found) == bin).then(|| Check {
                    family,
                    name: format!("R(r), {case}, r {inner} to {outer}"),
                    expected: ring.number("R"),
                    uncertainty: ring.number("se"),
                    measured: m.reflectance_by_radius[found],
                })
            };
            Ok(rings.iter().filter_map(check).collect())
        })?);
    }
    Ok(experiments)
}
