//! Scattering balls.

use super::experiment::{Check, Effort, Experiment};
use super::table::{Row, rows};
use crate::ball::{self, Source};
use crate::world::{SetupError, Substance};

pub(super) const BALLS: &str = include_str!("../../data/sphere_escape_absorption.csv");

pub(super) fn balance(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let (table, effort) = (rows(BALLS), effort.finer(2.0));
    let experiment = |(number, row): (usize, &Row)| {
        let [radius, albedo] = [row.number("R"), row.number("c")];
        let substance = Substance::of_albedo(albedo, 0.0);
        effort.experiment(family, number, |share| {
            let balance = |source, seed| {
                let scene = share.scene(ball::scene(&substance, radius, source)?);
                Ok::<_, SetupError>(ball::balance_in(
                    &scene,
                    &substance,
                    radius,
                    source,
                    share.photons,
                    seed,
                    share.look(0..2),
                ))
            };
            let from_inside = balance(Source::Volume, share.seed)?;
            let in_a_beam = balance(Source::Beam, !share.seed)?;
            let check = |column: &str, measured| {
                let name = format!("{column}, radius {radius}, albedo {albedo}");
                Check::new(name, row.number(column), 1e-9, measured).binned()
            };
            Ok(vec![
                check("P_esc", from_inside.escaped).falling(),
                check("P_esc_first", from_inside.unscattered).falling(),
                check("A_abs", in_a_beam.absorbed),
                check("T0", in_a_beam.unscattered).falling(),
            ])
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}
