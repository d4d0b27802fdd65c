//! The half-space that scatters alike in all directions: Chandrasekhar's H function, albedos, scattering orders.
//!
//! Light at the cosine μ to the normal finds the albedo `R(μ) = 1 − √(1 − ϖ) H(μ)` (Chandrasekhar 1960, § 33), so
//! `H(μ) = (1 − R(μ))/√(1 − ϖ)`; and moments `α_k = ∫ H μᵏ dμ` are `(1 − R_k)/((k + 1) √(1 − ϖ))`, `R_k` for light whose
//! power per cosine goes as `μᵏ`.

use super::experiment::{Check, Effort, Experiment};
use super::late::{self, returns_late};
use super::table::{Row, rows};
use crate::run::Estimate;
use crate::slab::{Incidence, Setup};
use crate::world::{SetupError, Substance};

/// Accuracy of the tables.
const TABLE: f64 = 1e-9;

pub(super) const BRDF: &str = include_str!("../../data/chandrasekhar_brdf.csv");

pub(super) fn half_space(albedo: f64, incidence: Incidence) -> Setup {
    Setup::one(Substance::of_albedo(albedo, 0.0), f64::INFINITY, incidence)
}

pub(super) fn albedos(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/chandrasekhar_albedo.csv"));
    let experiment = |(number, row): (usize, &Row)| {
        let albedo = row.number("albedo");
        let mu0 = row.word("mu0");
        let incidence = if mu0 == "diffuse" { Incidence::Diffuse } else { Incidence::Beam(row.number("mu0")) };
        let mut setup = half_space(albedo, incidence);
        setup.bins.orders = 3;
        let effort = if albedo > 0.99 { effort.long() } else { effort }.finer(2.0);
        effort.experiment(family, number, |share| {
            let check = |column: &str, accuracy, measured| {
                Check::new(format!("{column}, albedo {albedo}, mu0 {mu0}"), row.number(column), accuracy, measured)
                    .binned()
            };
            if returns_late(albedo, f64::INFINITY) {
                let m = late::measure(share, &setup)?;
                let [first, second] = m.by_order;
                return Ok(vec![
                    check("R", late::ACCURACY, m.reflectance),
                    check("R1", TABLE, first),
                    check("R2", TABLE, second),
                ]);
            }
            let m = share.slab(&setup)?;
            Ok(vec![
                check("R", TABLE, m.reflectance),
                check("R1", TABLE, m.reflectance_by_order[1]),
                check("R2", TABLE, m.reflectance_by_order[2]),
            ])
        })
    };
    table.iter().enumerate().step_by(effort.every).map(experiment).collect()
}

/// What an albedo of the half-space says of H: `(1 − R)/(factor √(1 − ϖ))`.
pub(super) fn of_h(albedo: f64, factor: f64, reflectance: Estimate) -> Estimate {
    let by = 1.0 / (factor * (1.0 - albedo).sqrt());
    Estimate { mean: 1.0 - reflectance.mean, ..reflectance }.scaled(by)
}

pub(super) fn h_function(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/chandrasekhar_H.csv"));
    let albedos = ["0.1", "0.5", "0.8", "0.9", "0.99"];
    let mut experiments = Vec::new();
    for (i, row) in table.iter().enumerate().filter(|(_, row)| row.number("mu") > 0.0) {
        let mu = row.number("mu");
        for (j, albedo) in albedos.into_iter().enumerate() {
            let number = albedos.len() * i + j;
            if !number.is_multiple_of(effort.every) {
                continue;
            }
            let value: f64 = albedo.parse().unwrap_or(f64::NAN);
            let setup = half_space(value, Incidence::Beam(mu));
            experiments.push(effort.experiment(family, number, |share| {
                let m = share.slab(&setup)?;
                let (name, expected) = (format!("H({mu}), albedo {albedo}"), row.number(&format!("H_a{albedo}")));
                Ok(vec![Check::new(name, expected, TABLE, of_h(value, 1.0, m.reflectance))])
            })?);
        }
    }
    Ok(experiments)
}

pub(super) fn h_moments(family: &'static str, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
    let table = rows(include_str!("../../data/chandrasekhar_H_moments.csv"));
    let (effort, mut experiments) = (effort.finer(2.0), Vec::new());
    // At albedo 1 the albedo of the half-space, which is 1, says nothing of H.
    for (i, row) in table.iter().enumerate().filter(|(_, row)| row.number("albedo") < 1.0) {
        let albedo = row.number("albedo");
        for k in 0..3 {
            let power = f64::from(k);
            let setup = half_space(albedo, Incidence::Power(power));
            experiments.push(effort.experiment(family, 3 * i + k as usize, |share| {
                let m = share.slab(&setup)?;
                let (name, expected) = (format!("∫ H μ^{k} dμ, albedo {albedo}"), row.number(&format!("alpha{k}")));
                Ok(vec![Check::new(name, expected, TABLE, of_h(albedo, power + 1.0, m.reflectance))])
            })?);
        }
    }
    Ok(experiments)
}
