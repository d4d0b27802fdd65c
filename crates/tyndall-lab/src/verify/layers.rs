//! Slabs and half-spaces.

use super::experiment::{Check, Effort, Experiment, Share};
use super::late::{self, returns_late};
use super::table::{Row, edges, grouped, rows};
use crate::run::Estimate;
use crate::slab::{Edges, Incidence, Setup};
use crate::world::{SetupError, Substance};

/// Accuracy of the tables of totals.
const TABLE: f64 = 5e-7;

pub(super) const SLABS: &str = include_str!("../../data/slab_RT_iadpython_grid.csv");

pub(super) fn slabs(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(SLABS);
    let mut experiments = Vec::new();
    for (number, row) in table.iter().enumerate().step_by(effort.every) {
        let [albedo, tau, g, n] = ["albedo", "tau", "g", "n"].map(|column| row.number(column));
        let substance = Substance { n, ..Substance::of_albedo(albedo, g) };
        for (incidence, what) in [(Incidence::Beam(1.0), "coll"), (Incidence::Diffuse, "diff")] {
            let setup = Setup::one(substance, tau, incidence);
            let number = 2 * number + usize::from(what == "diff");
            let effort = if tau > 10.0 && albedo > 0.99 { effort.long() } else { effort };
            let name = |quantity: &str| format!("{quantity}_{what}, albedo {albedo}, tau {tau}, g {g}, n {n}");
            let expected = |quantity: &str| row.number(&format!("{quantity}_{what}"));
            experiments.push(effort.experiment(family, number, |share| {
                if returns_late(albedo, tau) {
                    let m = late::measure(share, &setup)?;
                    return Ok(vec![Check::new(name("R"), expected("R"), late::ACCURACY, m.reflectance)]);
                }
                let m = share.slab(&setup)?;
                let check =
                    |quantity: &str, measured| Check::new(name(quantity), expected(quantity), TABLE, measured).binned();
                let mut checks = vec![check("R", m.reflectance)];
                checks.extend((what == "coll").then(|| check("Ru", m.specular)));
                checks.extend(tau.is_finite().then(|| check("T", m.transmittance).falling()));
                Ok(checks)
            })?);
        }
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
    // Half a percent of a coefficient moves a total by some 10⁻⁴ of what is sent in: more photons than elsewhere.
    let effort = effort.long().times(4).finer(4.0);
    let experiment = |(number, row): (usize, &Row)| {
        let setup = mcml(row);
        let case = row.word("case");
        effort.experiment(family, number, |share| {
            let m = share.slab(&setup)?;
            let diffuse = Estimate { mean: m.reflectance.mean - m.first_surface, ..m.reflectance };
            let check = |quantity: &str, column: &str, measured| {
                Check::new(format!("{quantity}, {case}"), row.number(column), TABLE, measured).binned()
            };
            let mut checks = vec![check("Rd", "Rd_exact", diffuse)];
            if setup.layers[0].thickness.is_finite() {
                checks.push(check("T", "Tt_exact", m.transmittance).falling());
            }
            Ok(checks)
        })
    };
    table.iter().enumerate().map(experiment).collect()
}

pub(super) fn by_angle(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let totals = rows(MCML_TOTALS);
    let table = rows(include_str!("../../data/mcml_angular_vdh.csv"));
    let mut setup = mcml(&totals[0]);
    setup.bins.angles = table.len();
    // 60 bins share the photons of one experiment: it gets those of many, whatever the totals say.
    let effort = Effort { error: 0.0, ..effort.times(40) };
    let experiment = effort.experiment(family, 0, |share| {
        let m = share.slab(&setup)?;
        let mut checks = Vec::new();
        for (i, row) in table.iter().enumerate() {
            let alpha = row.word("alpha_mid_deg");
            // At grazing angles the table's quadrature and MCML's photons differ by 6 %: MCML's own figures stand there.
            let is_grazing = i + 1 == table.len();
            let check = |quantity: &str, [exact, mcml, error]: [&str; 3], measured| {
                let (column, uncertainty) = if is_grazing { (mcml, row.number(error)) } else { (exact, TABLE) };
                Check::new(format!("{quantity} at {alpha}°"), row.number(column), uncertainty, measured).binned()
            };
            checks.push(check("Rd", ["Rd_exact", "Rd", "se"], m.reflectance_by_angle[i]));
            // The first bin of the transmittance has the unscattered beam, and is a total of the table before.
            if i > 0 {
                let columns = ["Tt_exact_diffuse", "Tt", "Tt_se"];
                checks.push(check("Td", columns, m.transmittance_by_angle[i]).falling());
            }
        }
        Ok(checks)
    })?;
    Ok(vec![experiment])
}

pub(super) fn by_radius(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let totals = rows(MCML_TOTALS);
    let table = rows(include_str!("../../data/mcml_R_of_r.csv"));
    // Rings share the photons of an experiment: the totals must not end it.
    let effort = Effort { error: 0.0, ..effort };
    let mut experiments = Vec::new();
    for (number, (case, rings)) in grouped(&table, |row| row.word("case")).into_iter().enumerate() {
        let Some(total) = totals.iter().find(|row| row.word("case") == case) else { continue };
        let mut setup = mcml(total);
        setup.bins.radii = Edges(edges(&rings));
        let middle = half_returns_within(&rings);
        experiments.push(effort.experiment(family, number, |share: Share| {
            let m = share.slab(&setup)?;
            let check = |ring: &&Row| {
                let bin @ [inner, outer] = ["r_lo", "r_hi"].map(|column| ring.number(column));
                let found = setup.bins.radii.find(f64::midpoint(inner, outer))?;
                let name = format!("R(r), {case}, r {inner} to {outer}");
                (setup.bins.radii.bin(found) == bin).then(|| {
                    let check = Check::new(name, ring.number("R"), ring.number("se"), m.reflectance_by_radius[found]);
                    // More scattering brings light back nearer to where it went in.
                    Check { falls: inner >= middle, ..check.sampled().binned() }
                })
            };
            Ok(rings.iter().filter_map(check).collect())
        })?);
    }
    Ok(experiments)
}

/// The inner radius of the ring within which half of the light of a table has returned.
fn half_returns_within(rings: &[&Row]) -> f64 {
    let light = |ring: &&Row| ring.number("R") * (ring.number("r_hi").powi(2) - ring.number("r_lo").powi(2));
    let all: f64 = rings.iter().map(light).sum();
    let mut within = 0.0;
    let reaches_half = |ring: &&&Row| {
        within += light(ring);
        within >= all / 2.0
    };
    rings.iter().find(reaches_half).map_or(f64::INFINITY, |ring| ring.number("r_lo"))
}
