//! Numbers as they are printed.

use super::experiment::{Check, Effort, Experiment};
use super::half_spaces::{half_space, of_h};
use super::table::{Row, rows};
use crate::slab::{Incidence, Setup};
use crate::world::{SetupError, Substance};

pub(super) fn printed(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/published.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let [albedo, tau, g, n, mu0] = ["albedo", "tau", "g", "n", "mu0"].map(|column| row.number(column));
        let quantity = row.word("quantity");
        let substance = Substance { n, ..Substance::of_albedo(albedo, g) };
        let setup = if quantity == "H" {
            half_space(albedo, Incidence::Beam(mu0))
        } else {
            Setup::one(substance, tau, Incidence::Beam(mu0))
        };
        effort.experiment(family, number, |share| {
            let m = share.slab(&setup)?;
            let measured = match quantity {
                "H" => of_h(albedo, 1.0, m.reflectance),
                "T" => m.transmittance,
                _ => m.reflectance,
            };
            let name =
                format!("{quantity}, albedo {albedo}, tau {tau}, g {g}, n {n}, mu0 {mu0} ({})", row.word("source"));
            let check = Check::new(name, row.number("value"), row.number("rounding"), measured);
            Ok(vec![if quantity == "R" { check } else { check.falling() }])
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}
