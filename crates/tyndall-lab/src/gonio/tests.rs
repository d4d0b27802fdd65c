//! The goniometer against closed forms, geometric optics and discrete ordinates.

use tyndall::{
    bsdf::Sides,
    material::{Index, Material, Metal, Roughness},
    scene::{MaterialId, Scene},
    texture::Texture,
};

use super::*;
use crate::slab::{Incidence, Setup};
use crate::verify::table::rows;
use crate::world::World;

const MAP: Map = Map { rows: 16, columns: 32 };

fn all(_: &Sums) -> Verdict {
    Verdict::GoOn
}

/// A scene that holds nothing but a material.
fn scene(material: Material) -> Scene {
    let mut scene = World::default().build(&Substance::VACUUM, glam::DVec3::ZERO).unwrap();
    scene.materials = vec![material].into();
    scene
}

fn surface(material: Material, cosine: f64) -> Specimen {
    Specimen::Surface(Box::new(Surface::new(scene(material), MaterialId(0), cosine).unwrap()))
}

fn glass(alpha: f32) -> Material {
    Material::Dielectric {
        eta: Index::Constant(1.5),
        alpha: Roughness::constant([alpha; 2]),
        reflection_tint: 1.0.into(),
        transmission_tint: 1.0.into(),
    }
}

fn z(found: Estimate, expected: f64) -> f64 {
    (found.mean - expected) / found.standard_error.max(1e-7)
}

/// Lambert's law: albedo ρ, power per solid angle ρ cos/π, and light from angle θ is turned by −⟨cos⟩ cos θ = −(2/3) cos θ.
#[test]
fn lamberts_law_is_measured() {
    let material = Material::Diffuse { reflectance: Texture::from(0.6), sides: Sides::Both };
    let m = measure(&surface(material, 0.8), MAP, 200_000, 1, all).unwrap();
    assert!(z(m.albedo, 0.6).abs() < 4.0 && z(m.upper, 0.6).abs() < 4.0 && m.lower.mean == 0.0);
    assert!(z(m.mean_cosine, -0.8 * 2.0 / 3.0).abs() < 4.0, "{:?}", m.mean_cosine);
    for row in 0..8 {
        let [high, low] = MAP.cosines(row);
        let expected = 0.6 / std::f64::consts::PI * f64::midpoint(high, low);
        let pixels = &m.map[0][row as usize * 32..][..32];
        let mean = pixels.iter().map(|e| e.mean).sum::<f64>() / 32.0;
        let error = pixels.iter().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt() / 32.0;
        assert!(((mean - expected) / error).abs() < 4.0, "{row}: {mean} ± {error} for {expected}");
    }
    let agreement = m.agreement.unwrap();
    assert!(agreement.p > 1e-3 && agreement.tests > 200, "{} {}", agreement.p, agreement.tests);
}

/// Sampling and evaluation are one model: metals and ground glass, from both sides, in power.
#[test]
fn sampling_and_evaluation_agree() {
    let metal = Material::Conductor {
        metal: Metal::Reflectance(0.7.into()),
        alpha: Roughness::constant([0.3, 0.6]),
        tint: 1.0.into(),
        sides: Sides::Both,
    };
    for (name, material, cosine) in [("metal", metal, 0.6), ("glass", glass(0.4), 0.7), ("glass", glass(0.4), -0.9)] {
        let m = measure(&surface(material, cosine), MAP, 200_000, 2, all).unwrap();
        let agreement = m.agreement.unwrap();
        assert!(agreement.p > 1e-3, "{name} {cosine}: p = {}, max |z| = {}", agreement.p, agreement.max_z);
        let difference = m.albedo.mean - agreement.evaluated.mean;
        let error = m.albedo.standard_error.hypot(agreement.evaluated.standard_error);
        assert!((difference / error).abs() < 4.0, "{name} {cosine}: {:?} {:?}", m.albedo, agreement.evaluated);
        if name == "glass" {
            assert!(m.upper.mean > 0.02 && m.lower.mean > 0.02 && m.albedo.mean <= 1.0, "{:?}", m.albedo);
        }
    }
}

/// Of smooth glass nothing is in the map: both its directions are Dirac. All of the power leaves, 4 % of it upwards.
#[test]
fn smooth_glass_is_specular() {
    let m = measure(&surface(glass(0.0), 1.0), MAP, 50_000, 2, all).unwrap();
    assert!((m.albedo.mean - 1.0).abs() < 1e-5 && m.specular == m.albedo, "{:?}", m.albedo);
    assert!(z(m.upper, 0.04).abs() < 4.0, "{:?}", m.upper);
    assert!(m.map[0].iter().all(|e| e.mean == 0.0));
}

/// A phase function has albedo 1 and its own mean cosine, and is the same sampled and evaluated.
#[test]
fn a_phase_function_has_its_mean_cosine() {
    for g in [-0.4f32, 0.0, 0.7] {
        let phase = Phase::henyey_greenstein(g).unwrap();
        let m = measure(&Specimen::Phase(phase), MAP, 200_000, 3, all).unwrap();
        assert!((m.albedo.mean - 1.0).abs() < 1e-12);
        assert!(z(m.mean_cosine, f64::from(g)).abs() < 4.0, "{g}: {:?}", m.mean_cosine);
        assert!(m.agreement.unwrap().p > 1e-3);
    }
}

/// An evaluation that is 3 % too large, or of a mean cosine 3 % too large, is found out.
#[test]
fn a_density_that_is_wrong_is_found() {
    struct Wrong(f32, f32);
    impl Scatterer for Wrong {
        type Met<'s> = Self;
        fn meet(&self, _rng: &mut Rng) -> Self {
            Self(self.0, self.1)
        }
    }
    impl Scattering for Wrong {
        fn travel(&self) -> Vec3 {
            Vec3::Z
        }
        fn sample(&self, rng: &mut Rng) -> Option<(Vec3, [f64; 3], bool)> {
            let phase = Phase::henyey_greenstein(0.5).unwrap();
            Scattering::sample(&&phase, rng)
        }
        fn eval(&self, dir: Vec3) -> [f64; 3] {
            let phase = Phase::henyey_greenstein(self.1).unwrap();
            Scattering::eval(&&phase, dir).map(|v| v * f64::from(self.0))
        }
    }
    let layout = Layout { map: MAP, channels: 1, evaluated: true };
    let p = |wrong: &Wrong| {
        let sums = run(layout.quantities(), 2_000_000, |number| sample(wrong, &layout, number, 1), all);
        layout.read(&sums).agreement.unwrap().p
    };
    assert!(p(&Wrong(1.0, 0.5)) > 1e-3);
    assert!(p(&Wrong(1.03, 0.5)) < 1e-6);
    assert!(p(&Wrong(1.0, 0.515)) < 1e-6);
}

/// One grain of glass, by geometric optics: the table of other hands, the integral here, and the walk through the ball.
#[test]
fn a_grain_scatters_as_geometric_optics_has_it() {
    for row in rows(include_str!("../../data/granular_glass_sphere_grain.csv")) {
        let [n, sigma_a] = ["n", "sigma_a"].map(|column| row.number(column));
        let grain = Substance { sigma_a, sigma_s: 0.0, g: 0.0, n };
        let exact = exact_grain(&grain).unwrap();
        let figures =
            [exact.albedo, exact.mean_cosine, exact.by_segments[0], exact.by_segments[1], exact.by_segments[3]];
        for (column, found) in ["albedo_scalar", "g_scalar", "R", "T", "TRRT_scalar"].into_iter().zip(figures) {
            assert!(
                (found - row.number(column)).abs() < 5e-6,
                "{column} of {grain:?}: {found}, {}",
                row.number(column)
            );
        }
        if [0.1, 0.5].contains(&sigma_a) && [1.2, 1.5, 2.0].contains(&n) {
            let m = measure(&Specimen::Grain(grain), MAP, 100_000, 7, all).unwrap();
            let mut found = vec![(m.albedo, exact.albedo), (m.mean_cosine, exact.mean_cosine)];
            found.extend(m.by_segments.into_iter().zip(exact.by_segments));
            for (found, expected) in found {
                assert!(z(found, expected).abs() < 4.2, "{grain:?}: {found:?} for {expected}");
            }
        }
    }
    assert_eq!(exact_grain(&Substance::of_albedo(0.5, 0.0)), None);
}

/// A cube that light meets straight on one of its faces is a plate: of what enters, `e = exp(−σ_a d)` arrives at the other face,
/// and each face reflects `F = ((n − 1) / (n + 1))²`, so that `w_0 = F` and `w_p = (1 − F)² F^(p−1) e^p`, to and fro.
#[test]
fn a_cube_that_is_lit_straight_on_a_face_is_a_plate() {
    let (n, sigma_a, edge) = (1.5f64, 0.3, 2.0);
    let corner = |i: u32| Vec3::from_array([0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 1.0 } else { -1.0 }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let mesh = Mesh { positions: (0..8).map(corner).collect(), indices, ..Mesh::default() };
    let glass = Substance { sigma_a, sigma_s: 0.0, g: 0.0, n };
    let m = measure(&Specimen::Body(Box::new(mesh.clone()), glass), MAP, 100_000, 5, all).unwrap();
    let (f, e) = (((n - 1.0) / (n + 1.0)).powi(2), (-sigma_a * edge).exp());
    let w = |p: i32| if p == 0 { f } else { (1.0 - f).powi(2) * f.powi(p - 1) * e.powi(p) };
    for (p, found) in m.by_segments.into_iter().enumerate() {
        assert!(z(found, w(p as i32)).abs() < 4.0, "{p}: {found:?} for {}", w(p as i32));
    }
    let (back, on) = ((0..40).step_by(2).map(w).sum::<f64>(), (1..40).step_by(2).map(w).sum::<f64>());
    assert!(z(m.albedo, back + on).abs() < 4.0 && z(m.upper, on).abs() < 4.0, "{:?} {:?}", m.albedo, m.upper);
    assert!(z(m.mean_cosine, (on - back) / (on + back)).abs() < 4.0, "{:?}", m.mean_cosine);
    let open = Mesh { indices: mesh.indices[..10].to_vec(), ..mesh };
    assert!(measure(&Specimen::Body(Box::new(open), glass), MAP, 10, 0, all).is_err());
}

/// Rows of the map are the angles of a slab: radiance times cosine, as discrete ordinates have it.
#[test]
fn a_slab_shines_as_discrete_ordinates_have_it() {
    // 50 rows: each cosine of the table is in the middle of one, over which radiance hardly bends.
    let map = Map { rows: 50, columns: 4 };
    let table = rows(include_str!("../../data/slab_angular_disort.csv"));
    let mut squares = (0.0, 0);
    for case in ["vdH", "hg"] {
        for mu0 in [1.0, 0.5] {
            let chosen = |row: &&crate::verify::table::Row| {
                row.word("case") == case
                    && row.number("mu0") == mu0
                    && row.word("phi_deg") == "mean"
                    && row.number("g") < 0.8
                    && row.number("tau") <= 4.0
            };
            let chosen: Vec<_> = table.iter().filter(chosen).collect();
            let Some(first) = chosen.first() else { continue };
            let medium = Substance::of_albedo(first.number("albedo"), first.number("g"));
            let setup = Setup::one(medium, first.number("tau"), Incidence::Beam(mu0));
            let m = measure(&Specimen::Slab(setup), map, 200_000, 11, all).unwrap();
            for row in chosen
                .iter()
                .filter(|row| row.number("tau") == first.number("tau") && row.number("g") == first.number("g"))
            {
                let mu = row.number("mu_o");
                if !(0.25..0.95).contains(&mu) {
                    continue; // near grazing and straight on it bends
                }
                for (dir, column) in [(mu, "L_R"), (-mu, "L_T")] {
                    let at = map.pixel(Vec3::new(-1.0, 0.0, dir as f32)) / 4;
                    let [high, low] = map.cosines(at as u32);
                    let pixels = &m.map[0][4 * at..4 * at + 4];
                    let mean = pixels.iter().map(|e| e.mean).sum::<f64>() / 4.0;
                    let error = pixels.iter().map(|e| e.standard_error.powi(2)).sum::<f64>().sqrt() / 4.0;
                    // What falls on the slab per area is 1, so that what falls on it per beam is too.
                    let expected = row.number(column) * mu;
                    if (f64::midpoint(high, low).abs() - mu).abs() < 1e-9 {
                        squares = (squares.0 + ((mean - expected) / error).powi(2), squares.1 + 1);
                        assert!(
                            ((mean - expected) / error).abs() < 4.5,
                            "{case} {mu0} {column} {mu}: {mean} ± {error} for {expected}"
                        );
                    }
                }
            }
        }
    }
    assert!(squares.1 > 20 && squares.0 < f64::from(squares.1) * 2.0, "{squares:?}");
}

#[test]
fn an_experiment_that_cannot_be_is_refused() {
    let refused = |specimen: &Specimen, map: Map| measure(specimen, map, 500, 0, all).unwrap_err().to_string();
    let phase = Specimen::Phase(Phase::henyey_greenstein(0.5).unwrap());
    assert!(refused(&phase, Map { rows: 1, columns: 8 }).contains("rows and columns"));
    assert!(refused(&phase, Map { rows: 8, columns: 100_000 }).contains("rows and columns"));
    assert!(
        refused(&Specimen::Grain(Substance { n: f64::NAN, ..Substance::VACUUM }), MAP).contains("refractive index")
    );
    let wrong = |id, cosine| Surface::new(scene(glass(0.1)), MaterialId(id), cosine).unwrap_err().to_string();
    assert!(wrong(1, 0.5).contains("no such material"));
    assert!(wrong(0, 0.0).contains("incidence") && wrong(0, f64::NAN).contains("incidence"));
}
