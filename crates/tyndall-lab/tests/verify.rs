//! The tables of `verify`: reproduced, and not reproduced where something is wrong.

use tyndall_lab::run::Estimate;
use tyndall_lab::verify::{Check, Defect, Effort, Experiment, Fault, Judgement, ORACLES, Oracle, judge};

/// A few experiments of each table.
const EFFORT: Effort = Effort { photons: 8_000, every: 16, ..Effort::QUICK };

#[test]
fn a_part_of_every_table_is_reproduced() {
    let measured = ORACLES.iter().flat_map(|oracle| oracle.measure(EFFORT).unwrap());
    let experiments: Vec<Experiment> = measured.collect();
    let judgement = judge(&experiments);
    assert_eq!(judgement.families.len(), ORACLES.len(), "every table has figures");
    assert!(judgement.figures > 100, "{judgement:#?}");
    assert!(judgement.p > 0.001, "{judgement:#?}");
}

fn figure(i: usize, mean: f64, falls: bool) -> Check {
    let measured = Estimate { mean, standard_error: 0.01 };
    Check { falls, ..Check::new(format!("figure {i}"), 1.0, 0.0, measured) }
}

/// Figures of a family, each one standard error off in the same direction: none of them is remarkable, together they are.
#[test]
fn many_small_deviations_in_one_direction_are_found() {
    let experiment = |i: usize| Experiment {
        family: "slabs",
        checks: vec![figure(i, 1.01, false)],
        rare: 0,
        shift: 1.0,
        tilt: None,
    };
    let judgement = judge(&(0..40).map(experiment).collect::<Vec<_>>());
    assert!(judgement.p_greatest > 0.5, "{judgement:#?}");
    assert!(judgement.p < 1e-6, "{judgement:#?}");
}

/// Half of them one standard error up, the other half down, as a scattering coefficient makes reflectances and
/// transmittances: they cancel in the sum, and not in the difference.
#[test]
fn deviations_that_cancel_are_found_by_their_difference() {
    let checks = |i: usize| vec![figure(i, 1.01, false), figure(i, 0.99, true)];
    let experiment = |i: usize| Experiment { family: "slabs", checks: checks(i), rare: 0, shift: 0.0, tilt: Some(1.4) };
    let judgement = judge(&(0..40).map(experiment).collect::<Vec<_>>());
    assert_eq!(judgement.families[0].shift.sum, 0.0);
    assert!(judgement.p < 1e-6, "{judgement:#?}");
}

#[test]
fn nothing_measured_is_nothing_shown() {
    assert_eq!(judge(&[]).p, 0.0);
}

/// What a table says when something is wrong.
fn judged(oracle: &Oracle, fault: Fault, size: f32, effort: Effort) -> Judgement {
    judge(&oracle.measure(Effort { defect: Some(Defect { fault, size }), ..effort }).unwrap())
}

/// The chance of a false alarm that each table has if all together have 1 %.
fn level() -> f64 {
    0.01 / ORACLES.len() as f64
}

/// Every defect that a table claims to see it sees: here a tenth of a coefficient, with the photons of a quick look.
#[test]
fn a_defect_of_a_tenth_is_caught_by_a_quick_look() {
    let pairs = [
        ("slabs", Fault::Scattering),
        ("h-function", Fault::PhaseNormalisation),
        ("walks", Fault::MeanCosine),
        ("balls", Fault::Absorption),
        ("fresnel", Fault::Index),
        ("grains", Fault::Fresnel),
        ("image-enclosure", Fault::Reflectance),
        ("image-radiance", Fault::Scattering),
        ("image-fibre", Fault::Absorption),
        ("image-fibre", Fault::Index),
    ];
    for (name, fault) in pairs {
        let oracle = ORACLES.iter().find(|oracle| oracle.name == name).unwrap();
        let judgement = judged(oracle, fault, 0.1, Effort { photons: 16_000, every: 8, ..Effort::QUICK });
        assert!(judgement.p < level(), "{name} does not see {fault:?}: {judgement:#?}");
    }
}

mod slow {
    use super::*;

    /// Half a percent of every fault that a table claims to see is caught with no more than what `--full` spends; less is
    /// tried first.
    fn catches_half_a_percent(name: &str) {
        let oracle = ORACLES.iter().find(|oracle| oracle.name == name).unwrap();
        let efforts = [
            Effort { photons: 50_000, every: 4, ..Effort::FULL },
            Effort { photons: 200_000, every: 2, ..Effort::FULL },
            Effort::FULL,
        ];
        let overlooked =
            |fault: &&Fault| efforts.iter().all(|effort| judged(oracle, **fault, 0.005, *effort).p >= level());
        let overlooked: Vec<_> = oracle.sees.iter().filter(overlooked).collect();
        assert!(overlooked.is_empty(), "{name} overlooks {overlooked:?}");
    }

    /// A test for each table.
    macro_rules! half_a_percent_is_caught {
        ($($test:ident: $name:literal,)*) => {
            $(#[test]
            fn $test() {
                catches_half_a_percent($name);
            })*

            #[test]
            fn no_table_is_forgotten() {
                let tested = [$($name),*];
                let blind = |oracle: &&Oracle| !oracle.sees.is_empty() && !tested.contains(&oracle.name);
                assert_eq!(ORACLES.iter().filter(blind).map(|oracle| oracle.name).collect::<Vec<_>>(), [""; 0]);
            }
        };
    }

    half_a_percent_is_caught! {
        by_slabs: "slabs",
        by_half_spaces: "half-space",
        by_the_h_function: "h-function",
        by_moments_of_h: "h-moments",
        by_printed_numbers: "printed",
        by_totals_of_mcml: "mcml-totals",
        by_angles_of_mcml: "mcml-angle",
        by_radii_of_mcml: "mcml-radius",
        by_point_sources: "points",
        by_moments_of_point_sources: "point-moments",
        by_decay_of_point_sources: "point-decay",
        by_walks: "walks",
        by_balls: "balls",
        by_criticality: "criticality",
        by_mean_ways: "mean-ways",
        by_fresnel: "fresnel",
        by_grains: "grains",
        by_furnaces: "image-furnace",
        by_beer_and_lambert: "image-beer",
        by_images_of_slabs: "image-slabs",
        by_once_scattered_light: "image-single",
        by_radiance: "image-radiance",
        by_brdf: "image-brdf",
        by_images_of_balls: "image-balls",
        by_enclosures: "image-enclosure",
        by_floors: "image-floor",
        by_panes: "image-pane",
        by_fibres: "image-fibre",
    }
}
