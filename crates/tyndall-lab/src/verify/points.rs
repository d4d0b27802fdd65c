//! Point sources in an infinite medium.

use super::experiment::{Check, Effort, Experiment, Share};
use super::table::{Row, edges, grouped, rows};
use crate::point::{self, Fluence};
use crate::run::Verdict;
use crate::world::{SetupError, Substance};

fn around(share: Share, substance: &Substance, radii: &[f64]) -> Result<Fluence, SetupError> {
    let scene = share.scene(point::scene(substance)?);
    Ok(point::fluence_in(&scene, substance, radii, share.photons, share.seed, |_| Verdict::GoOn))
}

pub(super) fn fluence(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/point_source_hg_deon_mc.csv"));
    let groups = grouped(&table, |row| [row.word("c"), row.word("g")]);
    let experiment = |(number, ([c, g], shells)): (usize, ([&str; 2], Vec<&Row>))| {
        let substance = Substance::of_albedo(shells[0].number("c"), shells[0].number("g"));
        let radii = edges(&shells);
        effort.experiment(family, number, |share| {
            let m = around(share, &substance, &radii)?;
            let check = |row: &&Row| {
                let bin @ [inner, outer] = [row.number("r_lo"), row.number("r_hi")];
                let shell = m.shells.iter().find(|shell| [shell.inner, shell.outer] == bin)?;
                let exact = row.number("exact");
                let known = if exact.is_nan() { [row.number("mc"), row.number("se")] } else { [exact, 1e-7] };
                let name = format!("4πr²φ, albedo {c}, g {g}, r {inner} to {outer}");
                Some(Check::new(name, known[0], known[1], shell.fluence).binned())
            };
            Ok(shells.iter().filter_map(check).collect())
        })
    };
    groups.into_iter().enumerate().map(experiment).collect()
}

pub(super) fn moments(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/point_source_moments.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let albedo = row.number("c");
        let substance = Substance::of_albedo(albedo, 0.0);
        effort.experiment(family, number, |share| {
            let m = around(share, &substance, &[0.0, 1.0])?;
            let check = |column: &str, measured| {
                // The table prints nine digits.
                let expected = row.number(column);
                Check::new(
                    format!("{}, albedo {albedo}", column.trim_end_matches("_exact")),
                    expected,
                    1e-9 * expected,
                    measured,
                )
                .binned()
            };
            Ok(vec![check("M0_exact", m.m0), check("M2_exact", m.m2), check("M4_exact", m.m4)])
        })
    };
    table.iter().enumerate().map(experiment).collect()
}
