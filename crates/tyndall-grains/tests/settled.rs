//! Grains that have come to rest under gravity.

use tyndall_grains::{
    GrainError,
    form::Form,
    pack::Recipe,
    settle::{MOST, Settled, settle},
};

fn recipe(container: &str, radii: &str) -> Recipe {
    let (container, radii) = (container.parse().unwrap(), radii.parse().unwrap());
    Recipe { container, form: Form::Ball, radii, count: 5000, seed: 5 }
}

fn settled(recipe: &Recipe, friction: f64) -> Settled {
    settle(recipe, friction, |_| true).unwrap()
}

/// Random close packing is 0.64, random loose packing 0.55 (Song, Wang and Makse 2008). The bulk of some 200 grains, of which
/// those at its rim are cut, has that to 0.015.
#[test]
fn balls_without_friction_pack_closely_and_with_friction_loosely() {
    let bulk = |friction| {
        let settled = settled(&recipe("box:16:16:16", "1"), friction);
        assert!(settled.unrest < 0.005 && settled.removed == 0, "{} {}", settled.unrest, settled.removed);
        settled.pack.bulk(1).unwrap()
    };
    let (slippery, rough) = (bulk(0.0), bulk(1.0));
    assert!((slippery.fraction - 0.64).abs() < 0.015 + 3.0 * slippery.error, "{slippery:?}");
    assert!((0.55..0.60).contains(&rough.fraction), "{rough:?}");
    // l = 4 r (1 − φ) / (3 φ)
    let expected = 4.0 * (1.0 - rough.fraction) / (3.0 * rough.fraction);
    assert!((rough.free_path / expected - 1.0).abs() < 1e-12, "{rough:?}");
}

/// What has settled lies in its container, overlaps nowhere, has the sizes that were asked for, and is more at the bottom.
#[test]
fn settled_grains_overlap_nowhere_and_lie_at_the_bottom() {
    for (container, radii) in [("cylinder:5:10", "uniform:0.5:1"), ("sphere:6", "0.9")] {
        let recipe = Recipe { count: 60, ..recipe(container, radii) };
        let pack = settled(&recipe, 0.3).pack;
        assert_eq!(pack.grains.len(), 60, "{container}");
        for (i, a) in pack.grains.iter().enumerate() {
            assert!(recipe.container.holds(a.centre, a.radius), "{container}: {a:?}");
            assert!((recipe.radii.smallest()..=recipe.radii.largest()).contains(&a.radius));
            for b in &pack.grains[..i] {
                assert!(a.centre.distance(b.centre) >= a.radius + b.radius, "{container}: {a:?} {b:?}");
            }
        }
        let mean = pack.grains.iter().map(|grain| grain.centre.z).sum::<f64>() / 60.0;
        assert!(mean < -0.2 * recipe.container.half().z, "{container}: {mean}");
    }
}

#[test]
fn the_same_seed_settles_the_same_grains_and_ctrl_c_keeps_what_has_settled() {
    let recipe = Recipe { count: 80, ..recipe("box:8:8:12", "1") };
    let whole = settled(&recipe, 0.3).pack.grains;
    assert_eq!(whole, settled(&recipe, 0.3).pack.grains);
    // Ended when half of the time has passed: some lie, some still fall and are taken out.
    let part = settle(&recipe, 0.3, |progress| progress.done < 0.2).unwrap();
    assert!(part.removed > 0 && !part.pack.grains.is_empty(), "{} {}", part.removed, part.pack.grains.len());
}

#[test]
fn what_cannot_settle_is_an_error() {
    let refused = |recipe: &Recipe, friction| settle(recipe, friction, |_| true).unwrap_err();
    let good = recipe("box:8:8:8", "1");
    assert_eq!(refused(&Recipe { count: MOST + 1, ..good.clone() }, 0.3), GrainError::Settling(MOST + 1));
    assert_eq!(refused(&Recipe { count: 0, ..good.clone() }, 0.3), GrainError::Count(0));
    assert!(matches!(refused(&good, f64::NAN), GrainError::Friction(_)));
    assert!(matches!(refused(&good, -0.1), GrainError::Friction(_)));
    assert!(matches!(refused(&recipe("box:8:8:8", "uniform:0.05:1"), 0.3), GrainError::Varied { .. }));
    assert!(matches!(refused(&recipe("box:8:8:8", "5"), 0.3), GrainError::TooLarge { .. }));
    assert!(matches!(refused(&recipe("box:8:8:8", "0.003"), 0.3), GrainError::TooSmall { .. }));
}
