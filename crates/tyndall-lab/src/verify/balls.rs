//! Scattering balls.

use super::table::{Row, rows};
use super::{Check, Effort, Experiment};
use crate::ball::{self, Source};
use crate::world::{SetupError, Substance};

pub(super) fn balance(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/sphere_escape_absorption.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let [radius, albedo] = [row.number("R"), row.number("c")];
        let substance = Substance::of_albedo(albedo, 0.0);
        effort.experiment(family, number, |share| {
            let look = || share.look(0..3);
            let from_inside = ball::balance(&substance, radius, Source::Volume, share.photons, share.seed, look())?;
            let in_a_beam = ball::balance(&substance, radius, Source::Beam, share.photons, !share.seed, look())?;
            let figures = [
                ("P_esc", from_inside.escaped),
                ("P_esc_first", from_inside.unscattered),
                ("A_abs", in_a_beam.absorbed),
                ("T0", in_a_beam.unscattered),
            ];
            let check = |(column, measured): (&str, _)| Check {
                family,
                name: format!("{column}, radius {radius}, albedo {albedo}"),
                expected: row.number(column),
                uncertainty: 1e-9,
                measured,
            };
            Ok(figures.into_iter().map(check).collect())
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}
