//! The tests tested: when nothing is wrong their p-values are uniform in [0, 1], so a false alarm is as rare as promised.

use testkit::{Family, Stream, ks_test, line_test, z_test};

/// p-values of `test` for 1,000 seeds.
fn p_values(test: impl Fn(&mut Stream) -> f64) -> Vec<f64> {
    (0..1_000).map(|seed| test(&mut Stream::new(seed))).collect()
}

#[test]
fn p_values_are_uniform_when_nothing_is_wrong() {
    let mut family = Family::new("calibration", 0.01);
    let mut z = p_values(|s| z_test((0..2_000).map(|_| s.next_f64().sqrt()), 2.0 / 3.0).p);
    family.check("z test", ks_test(&mut z, |p| p));
    let mut ks = p_values(|s| {
        let mut samples: Vec<f64> = (0..2_000).map(|_| s.next_f64().sqrt()).collect();
        ks_test(&mut samples, |x| x * x).p
    });
    family.check("Kolmogorov-Smirnov", ks_test(&mut ks, |p| p));
    let mut chi_square = p_values(|s| line_test([0.0, 1.0], 40, 2_000, || s.next_f64().sqrt(), |x| 2.0 * x).p);
    family.check("chi-square", ks_test(&mut chi_square, |p| p));
    family.finish();
}
