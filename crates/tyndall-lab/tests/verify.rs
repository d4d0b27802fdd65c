//! The tables of `verify`: reproduced, and not reproduced where something is wrong.

use tyndall_lab::run::Estimate;
use tyndall_lab::verify::{Check, Effort, Experiment, ORACLES, judge};

/// A few experiments of each table.
const EFFORT: Effort = Effort { photons: 8_000, every: 16, error: 0.0, seed: 1 };

#[test]
fn a_part_of_every_table_is_reproduced() {
    let measured = ORACLES.iter().flat_map(|oracle| oracle.measure(EFFORT).unwrap());
    let experiments: Vec<Experiment> = measured.collect();
    let judgement = judge(&experiments);
    assert_eq!(judgement.families.len(), ORACLES.len(), "every table has figures");
    assert!(judgement.figures > 100, "{judgement:#?}");
    assert!(judgement.p > 0.001, "{judgement:#?}");
}

/// Figures of a family, each one standard error off in the same direction: none of them is remarkable, together they are.
#[test]
fn many_small_deviations_in_one_direction_are_found() {
    let check = |i: usize| Check {
        family: "slabs",
        name: format!("figure {i}"),
        expected: 1.0,
        uncertainty: 0.0,
        measured: Estimate { mean: 1.01, standard_error: 0.01 },
    };
    let experiments: Vec<Experiment> =
        (0..40).map(|i| Experiment { family: "slabs", checks: vec![check(i)], shift: 1.0 }).collect();
    let judgement = judge(&experiments);
    assert!(judgement.p_greatest > 0.5, "{judgement:#?}");
    assert!(judgement.p < 1e-6, "{judgement:#?}");
}

#[test]
fn nothing_measured_is_nothing_shown() {
    assert_eq!(judge(&[]).p, 0.0);
}
