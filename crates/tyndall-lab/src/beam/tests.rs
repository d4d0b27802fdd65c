//! The beam against MCML, Chandrasekhar, conservation and symmetry.

use super::*;
use crate::verify::table::rows;

fn all(_: &Sums) -> Verdict {
    Verdict::GoOn
}

fn setup(body: Body, substance: Substance) -> Setup {
    Setup { body, substance, spot: 0.0, aim: DVec2::ZERO, radii: Edges::default(), view: None }
}

const MARBLE: Substance = Substance { sigma_a: 0.0041, sigma_s: 2.62, g: 0.0, n: 1.5 };
/// Chandrasekhar's H of albedo 0.9 at μ = 0.9 and 1.
const H_09: f64 = 1.800_787_358_06;
const H_1: f64 = 1.850_098_516_77;

const STRONG: Substance = Substance { sigma_a: 0.3, sigma_s: 2.0, g: 0.5, n: 1.4 };

/// The sum of z² of a few bins is χ²-distributed; of 20 bins it exceeds 45.3 once in a thousand times.
fn assert_agree(name: &str, z: &[f64]) {
    let sum: f64 = z.iter().map(|z| z * z).sum();
    let bound = z.len() as f64 + 3.7 * (2.0 * z.len() as f64).sqrt() + 3.0;
    assert!(sum < bound, "{name}: Σz² = {sum} of {}: {z:?}", z.len());
}

/// R(r) of half-spaces as MCML measures it, with an index and without, isotropic and forward.
#[test]
fn light_leaves_at_the_radii_of_mcml() {
    let media = rows(include_str!("../../data/mcml_totals_vs_adding.csv"));
    let table = rows(include_str!("../../data/mcml_R_of_r.csv"));
    for case in ["giov_n1.5", "iso_a0.9_n1.0", "vdh_slab"] {
        let medium = media.iter().find(|row| row.word("case") == case).unwrap();
        let [n, sigma_a, sigma_s, g, d] = ["n", "mu_a", "mu_s", "g", "thickness"].map(|column| medium.number(column));
        let rings: Vec<_> = table.iter().filter(|row| row.word("case") == case).collect();
        let body = if d > 1e7 { Body::HalfSpace } else { Body::Slab(d) };
        let mut setup = setup(body, Substance { sigma_a, sigma_s, g, n });
        setup.radii = Edges(crate::verify::table::edges(&rings));
        let m = measure(&setup, 200_000, 5, all).unwrap();
        let of = |ring: &&crate::verify::table::Row| {
            let edges = ["r_lo", "r_hi"].map(|column| ring.number(column));
            let bin = setup.radii.find(f64::midpoint(edges[0], edges[1])).unwrap();
            assert_eq!(setup.radii.bin(bin), edges);
            let measured = m.by_radius[bin];
            // A bin that few batches have reached does not know its error.
            let known = measured.mean > 4.0 * measured.standard_error;
            known.then(|| (measured.mean - ring.number("R")) / measured.standard_error.hypot(ring.number("se")))
        };
        let z: Vec<f64> = rings.iter().filter_map(of).collect();
        assert!(z.len() > 12);
        assert_agree(case, &z);
        let diffuse = medium.number("Rd_exact");
        assert!(((m.returned.mean - diffuse) / m.returned.standard_error).abs() < 4.0, "{case}: {:?}", m.returned);
    }
}

/// What is sent in comes back, leaves elsewhere, passes or stays, whatever the body is.
#[test]
fn no_light_is_lost_in_any_body() {
    let ball = {
        // A ball as a mesh: an octahedron does.
        let p = [Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y, Vec3::Z, -Vec3::Z];
        let side = |i: u32| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]];
        Mesh { positions: p.to_vec(), indices: (0..4).flat_map(side).collect(), ..Mesh::default() }
    };
    for body in
        [Body::HalfSpace, Body::Slab(0.7), Body::Ball(1.0), Body::Box(DVec3::new(1.0, 2.0, 0.5)), Body::Mesh(ball)]
    {
        let mut setup = setup(body, STRONG);
        (setup.spot, setup.aim) = (0.2, DVec2::new(0.11, 0.23));
        let m = measure(&setup, 40_000, 3, all).unwrap();
        let parts = [m.returned, m.elsewhere, m.unscattered, m.absorbed];
        let sum: f64 = parts.iter().map(|e| e.mean).sum();
        let error: f64 = parts.iter().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt();
        assert!((sum - 1.0).abs() < 4.0 * error, "{:?}: {sum} ± {error}", setup.body);
        assert!(m.returned.mean > 0.05 && m.absorbed.mean > 0.05);
    }
}

/// A box that is large beside the mean free path returns what a half-space does, and a pane of its width what a slab does.
#[test]
fn a_large_box_is_a_half_space() {
    let whole = measure(&setup(Body::HalfSpace, STRONG), 60_000, 1, all).unwrap();
    let large = measure(&setup(Body::Box(DVec3::splat(60.0)), STRONG), 60_000, 2, all).unwrap();
    let z = (whole.returned.mean - large.returned.mean)
        / whole.returned.standard_error.hypot(large.returned.standard_error);
    assert!(z.abs() < 4.0, "{:?} {:?}", whole.returned, large.returned);
}

/// `∫ max(0, n·ω) dω` over the cone, by summation.
#[test]
fn the_projected_cone_is_its_integral() {
    for (cosine, angle) in [(1.0, 0.3), (0.9, 0.5), (0.2, 0.6), (0.01, 0.3), (0.5, 1.4)] {
        let sine = (1.0f64 - cosine * cosine).sqrt();
        let (polar, around) = (2000, 2000);
        let mut sum = 0.0;
        for i in 0..polar {
            let theta: f64 = angle * (f64::from(i) + 0.5) / f64::from(polar);
            for j in 0..around {
                let phi = TAU * (f64::from(j) + 0.5) / f64::from(around);
                let above = cosine * theta.cos() + sine * theta.sin() * phi.cos();
                sum += above.max(0.0) * theta.sin();
            }
        }
        sum *= angle / f64::from(polar) * TAU / f64::from(around);
        let found = projected_cone(cosine, angle);
        assert!((found - sum).abs() < 1e-5 * sum, "{cosine} {angle}: {found} for {sum}");
    }
}

/// In the middle of a wide beam on a half-space that scatters isotropically the radiance is Chandrasekhar's,
/// `E a/(4π) H(1) H(μ)/(1 + μ)`, here for albedo 0.9 (H from his integral equation, to twelve digits); beyond six
/// diffusion lengths the edge of the beam is out of sight.
#[test]
fn the_picture_shows_the_radiance_of_a_half_space() {
    let mut setup = setup(Body::HalfSpace, Substance::of_albedo(0.9, 0.0));
    setup.spot = 26.0;
    let view = View { pixels: 4, width: 4.0, acceptance: 0.451, tilt: 0.0, azimuth: 0.0 };
    setup.view = Some(view);
    let m = measure(&setup, 1_000_000, 3, all).unwrap();
    // The cone reaches to μ = 0.9: over it H is a straight line to 10⁻⁴.
    let h = |mu: f64| H_09 + (H_1 - H_09) * (mu - 0.9) / 0.1;
    let (mut expected, mut weight) = (0.0, 0.0);
    for i in 0..1000 {
        let mu = 0.9 + 0.1 * (f64::from(i) + 0.5) / 1000.0;
        expected += 0.9 / (4.0 * PI) * H_1 * h(mu) / (1.0 + mu) * mu;
        weight += mu;
    }
    expected /= weight * PI * 13.0 * 13.0;
    let mean = m.picture.iter().map(|e| e.mean).sum::<f64>() / 16.0;
    let error = m.picture.iter().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt() / 16.0;
    assert!(((mean - expected) / error).abs() < 4.0, "{mean} ± {error} for {expected}");
    assert!(error < 0.03 * expected, "{error}");
}

/// The beam runs along the axis of the ball, so what is seen at one tilt does not depend on the azimuth.
#[test]
fn a_ball_is_seen_alike_from_around_the_beam() {
    let substance = Substance { sigma_a: 0.2, sigma_s: 3.0, g: 0.0, n: 1.3 };
    let mut setup = setup(Body::Ball(1.0), substance);
    let view = |tilt: f64, azimuth: f64| View { pixels: 32, width: 4.2, acceptance: 0.3, tilt, azimuth };
    let mut sees = |tilt: f64, azimuth: f64| {
        setup.view = Some(view(tilt, azimuth));
        let m = measure(&setup, 200_000, (100.0 * azimuth) as u64, all).unwrap();
        let sum: f64 = m.picture.iter().map(|e| e.mean).sum();
        let error: f64 = m.picture.iter().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt();
        (sum, error)
    };
    let (a, b) = (sees(0.9, 0.0), sees(0.9, 2.0));
    assert!(a.0 > 0.0 && ((a.0 - b.0) / a.1.hypot(b.1)).abs() < 4.0, "{a:?} {b:?}");
}

#[test]
fn an_experiment_that_cannot_be_is_refused() {
    let good = Setup {
        view: Some(View { pixels: 8, width: 1.0, acceptance: 0.3, tilt: 0.0, azimuth: 0.0 }),
        ..setup(Body::HalfSpace, MARBLE)
    };
    let refused = |change: &dyn Fn(&mut Setup)| {
        let mut setup = good.clone();
        change(&mut setup);
        measure(&setup, 500, 0, all).unwrap_err().to_string()
    };
    assert!(refused(&|s| s.body = Body::Slab(f64::NAN)).contains("thickness"));
    assert!(refused(&|s| s.body = Body::Ball(-1.0)).contains("radius"));
    assert!(refused(&|s| s.body = Body::Box(DVec3::new(1.0, 0.0, 1.0))).contains("edge of the box"));
    assert!(refused(&|s| (s.body, s.aim) = (Body::Ball(1.0), DVec2::X)).contains("less than the radius"));
    assert!(refused(&|s| (s.body, s.aim) = (Body::Box(DVec3::ONE), DVec2::X)).contains("within the box"));
    assert!(refused(&|s| s.substance.sigma_s = f64::NAN).contains("scattering coefficient"));
    assert!(refused(&|s| s.spot = -1.0).contains("diameter"));
    assert!(refused(&|s| s.view.as_mut().unwrap().pixels = 0).contains("pixels"));
    assert!(refused(&|s| s.view.as_mut().unwrap().acceptance = 2.0).contains("acceptance"));
    let open = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], indices: vec![[0, 1, 2]], ..Mesh::default() };
    assert!(refused(&|s| s.body = Body::Mesh(open.clone())).contains("not closed"));
}
