//! Random walks.

use super::experiment::{Check, Effort, Experiment};
use super::table::{Row, grouped, rows};
use crate::run::Verdict;
use crate::walk;
use crate::world::SetupError;

pub(super) fn moments(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/random_walk_moments_hg.csv"));
    let experiment = |(number, (g, rows)): (usize, (&str, Vec<&Row>))| {
        let flights: Vec<u32> = rows.iter().map(|row| row.number("n") as u32).collect();
        effort.long().experiment(family, number, |share| {
            let scene = share.scene(walk::scene(rows[0].number("g"))?);
            let measured = walk::moments_in(&scene, &flights, share.photons, share.seed, |_| Verdict::GoOn);
            let checks = rows.iter().zip(measured).flat_map(|(row, m)| {
                [("z_mean", m.z), ("r2_mean", m.r2), ("z2_mean", m.z2)].map(|(column, measured)| {
                    let name = format!("{}, g {g}, {} flights", column.trim_end_matches("_mean"), m.flights);
                    // The table prints ten digits.
                    Check::new(name, row.number(column), 1e-10 * row.number(column).abs(), measured).falling()
                })
            });
            Ok(checks.collect())
        })
    };
    grouped(&table, |row| row.word("g")).into_iter().enumerate().map(experiment).collect()
}
