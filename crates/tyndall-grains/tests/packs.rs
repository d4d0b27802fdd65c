//! Packs, and the free paths in them.

use tyndall_grains::{
    GrainError,
    container::Container,
    form::Form,
    pack::{Pack, Recipe},
    radii::Radii,
};

fn recipe(container: &str, radii: &str, count: u64) -> Recipe {
    let (container, radii) = (container.parse().unwrap(), radii.parse().unwrap());
    Recipe { container, form: Form::Ball, radii, count, seed: 7 }
}

fn pack(container: &str, radii: &str, count: u64) -> Pack {
    Pack::fill(&recipe(container, radii, count), |_| true).unwrap()
}

#[test]
fn grains_lie_in_their_container_and_overlap_nowhere() {
    for container in ["box:20:18:16", "sphere:10", "cylinder:9:16"] {
        let pack = pack(container, "lognormal:0.7:0.3", 250);
        assert_eq!(pack.grains.len(), 250);
        for (i, a) in pack.grains.iter().enumerate() {
            assert!(pack.container.holds(a.centre, a.radius), "{container}: {a:?}");
            for b in &pack.grains[..i] {
                assert!(a.centre.distance(b.centre) >= a.radius + b.radius, "{container}: {a:?} {b:?}");
            }
        }
    }
}

/// Stereology is exact: rays and formula differ by chance alone.
#[test]
fn rays_go_as_far_between_grains_as_stereology_says() {
    for container in ["box:20:18:16", "sphere:10", "cylinder:9:16"] {
        for radii in ["0.9", "uniform:0.4:1.2"] {
            let pack = pack(container, radii, 300);
            let rays = pack.free_path_by_rays(40_000, 3).unwrap();
            let off = (rays.mean - pack.free_path_by_formula()) / rays.error;
            assert!(off.abs() < 4.0, "{container} {radii}: {rays:?}, {off} standard errors off");
            assert!(rays.error < 0.01 * rays.mean, "{rays:?}");
        }
    }
}

/// The rows of `granular_packing_free_path.csv` that random sequential addition reaches: balls of radius 1 in a box of volume
/// 13824, as many as make the packing fraction.
#[test]
fn free_paths_between_equal_balls_are_those_of_the_table() {
    let table = include_str!("../data/granular_packing_free_path.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let rows = rows.map(|row| row.split(',').map(|number| number.parse().unwrap()).collect::<Vec<f64>>());
    let mut checked = 0;
    for row in rows.filter(|row| row[0] <= 0.3) {
        let count = (row[0] * 13824.0 / (4.0 / 3.0 * std::f64::consts::PI)).round();
        let pack = pack("box:24:24:24", "1", count as u64);
        assert_eq!(pack.grains.len() as f64, count);
        // The count is rounded: l ∝ (1 − φ) / φ.
        let phi = pack.fraction();
        let expected = row[1] * (1.0 - phi) / phi * row[0] / (1.0 - row[0]);
        let rays = pack.free_path_by_rays(20_000, 3).unwrap();
        assert!((pack.free_path_by_formula() / expected - 1.0).abs() < 1e-7, "{row:?}");
        assert!(((rays.mean - expected) / rays.error).abs() < 4.0, "{row:?}: {rays:?} for {expected}");
        checked += 1;
    }
    assert_eq!(checked, 5);
}

#[test]
fn the_same_seed_packs_the_same_grains() {
    assert_eq!(pack("sphere:10", "uniform:0.5:1", 200).grains, pack("sphere:10", "uniform:0.5:1", 200).grains);
}

#[test]
fn what_cannot_be_packed_is_an_error() {
    for text in
        ["box:1:1", "box:1:1:x", "ball:3", "sphere:0", "sphere:NaN", "cylinder:1:-2", "sphere:inf", "sphere:1e200", ""]
    {
        assert!(text.parse::<Container>().is_err(), "{text}");
    }
    for text in ["0", "NaN", "uniform:2:1", "lognormal:1:5", "-1", "uniform:1", ""] {
        assert!(text.parse::<Radii>().is_err(), "{text}");
    }
    let fill = |radius, count| {
        let recipe = Recipe { radii: Radii::Mono(radius), ..recipe("sphere:1", "1", count) };
        Pack::fill(&recipe, |_| true).unwrap_err()
    };
    assert!(matches!(fill(2.0, 5), GrainError::TooLarge { .. }));
    assert!(matches!(fill(1e-30, 5), GrainError::TooSmall { .. }));
    assert_eq!(fill(0.1, 0), GrainError::Count(0));
    assert_eq!(fill(0.1, u64::MAX), GrainError::Count(u64::MAX));
}
