//! Packs, and the free paths in them.

use tyndall_grains::{GrainError, container::Container, pack::Pack, radii::Radii};

fn pack(container: &str, radii: &str, count: u64) -> Pack {
    Pack::fill(container.parse().unwrap(), radii.parse().unwrap(), count, 7, |_| true).unwrap()
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

/// The row of `granular_packing_free_path.csv` at a packing fraction of 0.2: 16/3 radii.
#[test]
fn a_fifth_of_equal_balls_leaves_free_paths_of_five_and_a_third_radii() {
    let container: Container = "box:20:20:20".parse().unwrap();
    let count = 382; // φ = 0.2 · 8000 / (4π/3) = 381.97 balls of radius 1
    let pack = Pack::fill(container, Radii::Mono(1.0), count, 1, |_| true).unwrap();
    assert!((pack.fraction() - 0.2).abs() < 2e-5);
    assert!((pack.free_path_by_formula() / 5.33333333 - 1.0).abs() < 2e-4, "{}", pack.free_path_by_formula());
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
    let fill = |radius, count| Pack::fill(Container::Sphere(1.0), Radii::Mono(radius), count, 0, |_| true).unwrap_err();
    assert!(matches!(fill(2.0, 5), GrainError::TooLarge { .. }));
    assert!(matches!(fill(1e-30, 5), GrainError::TooSmall { .. }));
    assert_eq!(fill(0.1, 0), GrainError::Count(0));
    assert_eq!(fill(0.1, u64::MAX), GrainError::Count(u64::MAX));
}
