//! Hair, through the image renderer.

use super::stage::Stage;
use super::{Can, Made, by_each, falling};
use crate::verify::experiment::{Effort, Experiment};
use crate::verify::table::{Row, rows};

const ALBEDOS: &str = include_str!("../../../data/hair_fibre_albedo.csv");

/// Before a uniform sky a fibre shows its albedo, on the mean over its width: by reciprocity, what it would scatter of light that
/// comes from where the camera is.
pub(crate) fn albedos(family: &'static str, effort: Effort) -> Made<Vec<Experiment>> {
    let mut table = rows(ALBEDOS);
    // Every second or eighth row shall be of another angle and another absorption.
    table.sort_by(|a, b| a.number("sigma_a").total_cmp(&b.number("sigma_a")));
    let experiment = |(number, row): (usize, &Row)| {
        let [degrees, sigma_a] = ["theta_deg", "sigma_a"].map(|column| row.number(column));
        effort.experiment(family, number, |share| {
            let mut stage = Stage::along_a_fibre(degrees.to_radians(), sigma_a)?;
            stage.sky(1.0);
            let name = format!("a fibre seen at {degrees}°, sigma_a {sigma_a}");
            let expected = [row.number("albedo"), 1e-9];
            Ok(falling(by_each(share, Can::AllMedia, stage.scene()?, &name, expected)))
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}
