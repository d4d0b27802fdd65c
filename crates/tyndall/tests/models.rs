//! Every phase function and every BSDF in one table, and what must be true of all of them: the sampler draws from the
//! density, weights are values over densities, exchange of the directions, conservation of energy, no NaN.

use std::f64::consts::TAU;

use testkit::quadrature::{adaptive_rectangle, direction, gauss_legendre};
use testkit::{Family, Grid, Outcome, Stream, chi_square, close, z_test};
use tyndall::bsdf::microfacet::{Distribution, Microfacets, Shadowing, roughness_to_alpha};
use tyndall::bsdf::{
    Bsdf, BsdfSample, Plastic, RoughCoat, RoughConductor, RoughDielectric, RoughPlastic, ScatterKind, Sides,
    internal_reflectance,
};
use tyndall::math::{Vec2, Vec3};
use tyndall::phase::{Isotropic, Phase, Rayleigh, deflect};
use tyndall::spectrum::Lanes;

#[path = "models/fresnel.rs"]
mod fresnel;
#[path = "models/hair.rs"]
mod hair;
#[path = "models/mixed.rs"]
mod mixed;
/// Every model with its parameters in common and extreme settings.
fn bsdfs() -> Vec<(&'static str, Bsdf<'static>)> {
    let ochre = Lanes::rgb(0.8, 0.5, 0.2);
    let (gold_eta, gold_k) = (Lanes::rgb(0.14, 0.37, 1.44), Lanes::rgb(3.98, 2.39, 1.60));
    let mut all = mixed::rows();
    all.extend(hair::rows());
    all.extend([
        ("diffuse", Bsdf::diffuse(ochre)),
        ("diffuse on the outside", Bsdf::diffuse(ochre).on(Sides::Outside)),
        ("mirror", Bsdf::conductor(Lanes::ZERO, Lanes::ONE, 0.0, 0.0)),
        ("gold", Bsdf::conductor(gold_eta, gold_k, 0.0, 0.0)),
        ("gold, rough 0.05", Bsdf::conductor(gold_eta, gold_k, 0.05, 0.05)),
        ("gold, rough 0.3 and 0.1", Bsdf::conductor(gold_eta, gold_k, 0.3, 0.1)),
        ("mirror, rough 1", Bsdf::conductor(Lanes::ZERO, Lanes::ONE, 1.0, 1.0)),
        ("metal of reflectance, rough 0.2, on the outside", metal_on_the_outside()),
        ("glass", Bsdf::dielectric(1.5, 0.0, 0.0)),
        ("bubble", Bsdf::dielectric(1.0 / 1.33, 0.0, 0.0)),
        ("matched", Bsdf::dielectric(1.0, 0.3, 0.3)),
        ("glass, tinted", Bsdf::dielectric(1.5, 0.0, 0.0).tinted(ochre, Lanes::rgb(0.1, 0.6, 1.0))),
        ("glass, rough 0.05", Bsdf::dielectric(1.5, 0.05, 0.05)),
        ("glass, rough 0.4", Bsdf::dielectric(1.5, 0.4, 0.4)),
        ("glass, rough 0.4 and 0.1", Bsdf::dielectric(1.5, 0.4, 0.1)),
        ("bubble, rough 0.3", Bsdf::dielectric(1.0 / 1.33, 0.3, 0.3)),
        ("diamond, rough 1", Bsdf::dielectric(2.4, 1.0, 1.0)),
        ("glass, rough 0.2, tinted", Bsdf::dielectric(1.5, 0.2, 0.2).tinted(ochre, Lanes::rgb(0.1, 0.6, 1.0))),
        ("glass, rough 0.2, reflecting nothing", Bsdf::dielectric(1.5, 0.2, 0.2).tinted(Lanes::ZERO, Lanes::ONE)),
        (
            "gold, rough 0.1, Beckmann",
            Bsdf::conductor(gold_eta, gold_k, 0.1, 0.1).distributed(Distribution::Beckmann, Shadowing::Correlated),
        ),
        ("mirror, rough 1 and 0.3, Beckmann", beckmann_mirror()),
        (
            "glass, rough 0.1, Beckmann",
            Bsdf::dielectric(1.5, 0.1, 0.1).distributed(Distribution::Beckmann, Shadowing::Correlated),
        ),
        (
            "glass, rough 0.4 and 0.2, Beckmann",
            Bsdf::dielectric(1.5, 0.4, 0.2).distributed(Distribution::Beckmann, Shadowing::Correlated),
        ),
        (
            "diamond, rough 1, Beckmann",
            Bsdf::dielectric(2.4, 1.0, 1.0).distributed(Distribution::Beckmann, Shadowing::Correlated),
        ),
        ("gold, rough 0.6, separable", separable(Bsdf::conductor(gold_eta, gold_k, 0.6, 0.6))),
        ("glass, rough 0.5 and 0.2, separable", separable(Bsdf::dielectric(1.5, 0.5, 0.2))),
        ("pane", Bsdf::thin_dielectric(Lanes::splat(1.5))),
        ("pane of air, tinted", Bsdf::thin_dielectric(Lanes::splat(0.75)).tinted(ochre, Lanes::rgb(0.1, 0.6, 1.0))),
        ("pane reflecting nothing", Bsdf::thin_dielectric(Lanes::splat(1.5)).tinted(Lanes::ZERO, Lanes::ONE)),
        ("lampshade", Bsdf::diffuse_transmission(ochre, Lanes::rgb(0.2, 0.15, 0.1))),
        ("leaf, tinted", Bsdf::diffuse_transmission(ochre, Lanes::rgb(0.1, 0.6, 0.3))),
        ("paper that only transmits", Bsdf::diffuse_transmission(Lanes::ZERO, ochre)),
        ("soot", Bsdf::diffuse_transmission(Lanes::ZERO, Lanes::ZERO)),
        ("plastic", Bsdf::Plastic(Plastic::new(1.49, internal_reflectance(1.49), ochre, false))),
        ("dark varnish, on the outside", varnish().on(Sides::Outside)),
        ("plastic, tinted", varnish().tinted(ochre, Lanes::ONE)),
        ("null", Bsdf::Null),
    ]);
    all
}

fn varnish() -> Bsdf<'static> {
    Bsdf::Plastic(Plastic::new(1.7, internal_reflectance(1.7), Lanes::rgb(0.9, 0.3, 0.1), true))
}

fn beckmann_mirror() -> Bsdf<'static> {
    Bsdf::conductor(Lanes::ZERO, Lanes::ONE, 1.0, 0.3).distributed(Distribution::Beckmann, Shadowing::Correlated)
}

/// With Mitsuba's shadowing: Beckmann's law for glass, that of Trowbridge and Reitz for metal.
fn separable(bsdf: Bsdf<'static>) -> Bsdf<'static> {
    let beckmann = matches!(bsdf, Bsdf::RoughDielectric(_));
    let law = if beckmann { Distribution::Beckmann } else { Distribution::TrowbridgeReitz };
    bsdf.distributed(law, Shadowing::Separable)
}

fn metal_on_the_outside() -> Bsdf<'static> {
    Bsdf::conductor_of_reflectance(Lanes::rgb(0.9, 0.5, 0.1), 0.2, 0.2).on(Sides::Outside)
}

/// From the normal to grazing, oblique to the tangents, on both sides.
fn directions() -> Vec<Vec3> {
    let from = |cos: f32, phi: f32| {
        let sin = (1.0 - cos * cos).sqrt();
        Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    };
    vec![
        from(1.0, 0.0),
        from(0.7, 0.5),
        from(0.3, 2.0),
        from(0.02, 4.0),
        from(-1.0, 0.0),
        from(-0.6, 1.0),
        from(-0.1, 3.0),
    ]
}

fn phases() -> Vec<(String, Phase)> {
    let mut all =
        vec![("isotropic".to_owned(), Phase::Isotropic(Isotropic)), ("Rayleigh".to_owned(), Phase::Rayleigh(Rayleigh))];
    for g in [-0.95, -0.5, -1e-4, 1e-4, 0.3, 0.8, 0.99] {
        all.push((format!("Henyey-Greenstein {g}"), Phase::henyey_greenstein(g).unwrap()));
    }
    // Tables whose cosines are ends of the cells that are counted, so that quadrature is exact.
    let peaked: Vec<_> = (0..51).map(|i| (0.16 * f64::from(i)).exp() * f64::from(i % 7 + 1)).collect();
    let holey: Vec<_> = (0..26).map(|i| f64::from(i % 5 / 4 * i + i / 25 * 1000)).collect();
    for (name, values) in [("ramp", &[3.0, 0.0][..]), ("peaked", &peaked), ("holey", &holey)] {
        all.push((format!("{name} table"), Phase::tabulated(values).unwrap()));
    }
    let hg = |g| Phase::henyey_greenstein(g).unwrap();
    let haze = Phase::blend(&hg(0.8), &hg(-0.5), 0.3).unwrap();
    let dust = Phase::blend(&haze, &Phase::tabulated(&peaked).unwrap(), 0.01).unwrap();
    all.extend([("blend of two".to_owned(), haze), ("blend of three".to_owned(), dust)]);
    all
}

/// The sphere as cos θ × φ, finer than testkit's own for the sharper lobes; the horizon is an edge.
const SPHERE: Grid = Grid { nx: 40, ny: 64, ..Grid::SPHERE };

fn cell_of(w: Vec3) -> usize {
    let index = |at: f64, n: usize| ((at * n as f64) as usize).min(n - 1);
    let row = index((f64::from(w.z) + 1.0) * 0.5, SPHERE.nx);
    row * SPHERE.ny + index(f64::from(w.y).atan2(f64::from(w.x)) / TAU + 0.5, SPHERE.ny)
}

/// `∫ f dω` over each cell of [`SPHERE`].
fn cell_integrals(f: impl Fn(Vec3) -> f32) -> Vec<f64> {
    SPHERE.integrate(|p| f64::from(f(Vec3::from_array(direction(p).map(|x| x as f32)))))
}

fn uniform_direction(stream: &mut Stream) -> Vec3 {
    let at = [2.0 * stream.next_f64() - 1.0, TAU * stream.next_f64()];
    Vec3::from_array(direction(at).map(|x| x as f32))
}

fn sample(bsdf: &Bsdf, wo: Vec3, stream: &mut Stream) -> Option<BsdfSample> {
    bsdf.sample(wo, stream.next_f32(), Vec2::new(stream.next_f32(), stream.next_f32()))
}

/// Every model with a density, from every direction.
fn rough_cases() -> impl Iterator<Item = (String, Bsdf<'static>, Vec3)> {
    bsdfs()
        .into_iter()
        .filter(|(_, bsdf)| !bsdf.is_specular())
        .flat_map(|(name, bsdf)| directions().into_iter().map(move |wo| (format!("{name} from {wo}"), bsdf, wo)))
}

/// A sample of the lobes that have a density.
fn sample_density(bsdf: &Bsdf, wo: Vec3, stream: &mut Stream) -> Option<BsdfSample> {
    sample(bsdf, wo, stream).filter(|s| !s.specular)
}

/// The histogram of the directions drawn must be that of the density. The cell of the samples that failed expects what
/// the density leaves to 1, so a density that is too great or too small everywhere is caught as well.
#[test]
fn every_bsdf_sampler_draws_from_its_density() {
    let mut family = Family::new("BSDF samplers", 0.01);
    for (name, bsdf, wo) in rough_cases() {
        let mut expected = cell_integrals(|wi| bsdf.pdf(wo, wi));
        let total: f64 = expected.iter().sum();
        assert!(total < 1.0 + 1e-4, "{name}: the density integrates to {total}");
        expected.push((1.0 - total).max(0.0));
        let (mut observed, mut stream) = (vec![0u64; expected.len()], Stream::new(1));
        for _ in 0..200_000 {
            let drawn = sample_density(&bsdf, wo, &mut stream);
            observed[drawn.map_or(expected.len() - 1, |s| cell_of(s.wi))] += 1;
        }
        family.check(&name, verdict(&observed, &expected));
    }
    family.finish();
}

/// χ²; but where the side is black, every sample must fail.
fn verdict(observed: &[u64], expected: &[f64]) -> Outcome {
    if expected.last() == Some(&1.0) {
        let failed = *observed.last().unwrap_or(&0) as f64;
        return close(failed, observed.iter().sum::<u64>() as f64, 0.0);
    }
    chi_square(observed, expected)
}

/// Diffuse reflection cannot fail where the side answers.
#[test]
fn the_density_of_diffuse_reflection_integrates_to_one() {
    let bsdf = Bsdf::diffuse(Lanes::ONE);
    for wo in directions() {
        let total: f64 = cell_integrals(|wi| bsdf.pdf(wo, wi)).iter().sum();
        assert!((total - 1.0).abs() < 1e-6, "{total}");
    }
}

/// `∫ D(m) m_z dm = 1` and `∫ D_o(m) dm = 1` over the hemisphere, exactly: facets cover the surface once, and what is
/// seen of them from any direction covers its projection once. Normals crowd around the pole: `m_z = 1 − t³`.
#[test]
fn microfacets_and_the_visible_ones_among_them_integrate_to_one() {
    let hemisphere = |f: &dyn Fn(Vec3) -> f32| -> f64 {
        let g = |[t, phi]: [f64; 2]| {
            let t3 = t * t * t;
            let sin = (t3 * (2.0 - t3)).sqrt();
            let m = Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, (1.0 - t3) as f32);
            f64::from(f(m)) * 3.0 * t * t
        };
        let cell = |i: usize, n: usize, to: f64| [to * i as f64 / n as f64, to * (i + 1) as f64 / n as f64];
        (0..160 * 64).map(|i| adaptive_rectangle(cell(i / 64, 160, 1.0), cell(i % 64, 64, TAU), 1e-8, 6, &g)).sum()
    };
    for distribution in [Distribution::TrowbridgeReitz, Distribution::Beckmann] {
        for (alpha_x, alpha_y) in [(0.05, 0.05), (0.3, 0.1), (1.0, 1.0)] {
            let d = Microfacets { alpha_x, alpha_y, distribution, shadowing: Shadowing::Separable };
            let projected = hemisphere(&|m| d.density(m) * m.z);
            assert!((projected - 1.0).abs() < 2e-5, "{d:?}: {projected}");
            for wo in directions().into_iter().filter(|wo| wo.z > 0.0) {
                let visible = hemisphere(&|m| d.visible_density(wo, m));
                assert!((visible - 1.0).abs() < 2e-5, "{d:?} from {wo}: {visible}");
            }
        }
    }
}

/// `weight·pdf = eval` lane by lane, `pdf` is the same from both methods, and a Dirac lobe is invisible to both.
#[test]
fn every_weight_is_the_value_over_the_density() {
    for (name, bsdf) in bsdfs() {
        let mut stream = Stream::new(2);
        for wo in directions() {
            for _ in 0..20_000 {
                let Some(s) = sample(&bsdf, wo, &mut stream) else { continue };
                let (value, pdf) = (bsdf.eval(wo, s.wi), bsdf.pdf(wo, s.wi));
                assert!((s.wi.length() - 1.0).abs() < 2e-6, "{name} from {wo}: {s:?}");
                assert_eq!(s.kind == ScatterKind::Reflection, wo.z * s.wi.z > 0.0, "{name} from {wo}: {s:?}");
                assert!(s.specular == bsdf.is_specular() || matches!(bsdf, Bsdf::Plastic(_)));
                assert!(bsdf.transmits() || s.kind == ScatterKind::Reflection);
                if s.specular && !bsdf.is_specular() {
                    assert!(s.pdf > 0.0 && s.pdf <= 1.0, "{name} from {wo}: {s:?}");
                } else if s.specular {
                    assert!(value.is_zero() && pdf == 0.0 && s.pdf > 0.0 && s.pdf <= 1.0, "{name} from {wo}: {s:?}");
                } else {
                    assert!((s.pdf / pdf - 1.0).abs() < 2e-3, "{name} from {wo}: {s:?} but pdf {pdf}");
                    let rest = (s.weight * pdf - value).map(f32::abs).max_lane();
                    assert!(rest <= 2e-3 * value.max_lane(), "{name} from {wo}: {s:?} but value {value:?}, pdf {pdf}");
                }
            }
        }
    }
}

/// Radiance over the squared index is what is exchanged: `f(o, i)/η_o² = f(i, o)/η_i²`. Where a microfacet is met at
/// grazing incidence, the rounding of the directions is divided by that small cosine, and an exponential magnifies it by
/// its exponent.
#[test]
fn exchanging_the_directions_changes_nothing_but_the_squared_index() {
    for (name, bsdf) in bsdfs() {
        let eta = match bsdf {
            Bsdf::RoughDielectric(model) => model.interface.eta,
            Bsdf::Principled(model) => model.fixed.eta,
            _ => 1.0,
        };
        let index = |w: Vec3| if w.z > 0.0 { 1.0 } else { eta };
        let mut stream = Stream::new(3);
        for _ in 0..20_000 {
            let (a, b) = (uniform_direction(&mut stream), uniform_direction(&mut stream));
            if mixed::is_not_exchanged(&bsdf, a, b) {
                continue;
            }
            let there = bsdf.eval(a, b) / (b.z.abs() * index(a) * index(a));
            let back = bsdf.eval(b, a) / (a.z.abs() * index(b) * index(b));
            let m = (a * index(a) + b * index(b)).normalize();
            let facing = m.dot(a).abs().min(m.dot(b).abs());
            let rounding = 2e-5 + (4.0 + 8.0 * exponent(&bsdf, m)) * f32::EPSILON / facing;
            let rest = (there - back).map(f32::abs).max_lane();
            assert!(rest <= rounding * there.max_lane(), "{name}, {a} and {b}: {there:?} and {back:?}");
        }
    }
}

/// The exponent of Beckmann's density, if it is that.
fn exponent(bsdf: &Bsdf, m: Vec3) -> f32 {
    match bsdf {
        Bsdf::RoughConductor(RoughConductor { microfacets: d, .. })
        | Bsdf::RoughDielectric(RoughDielectric { microfacets: d, .. })
        | Bsdf::RoughPlastic(RoughPlastic { coat: RoughCoat { microfacets: d, .. }, .. })
            if d.distribution == Distribution::Beckmann =>
        {
            ((m.x / d.alpha_x).powi(2) + (m.y / d.alpha_y).powi(2)) / (m.z * m.z)
        }
        _ => 0.0,
    }
}

/// The power that is scattered, `Σ p·weight·η²`, is all of the power at every angle from both sides, total reflection
/// included.
#[test]
fn a_smooth_dielectric_loses_nothing() {
    for eta in [1.5, 1.33, 1.0, 1.0 / 1.5, 2.4, 1.000_1] {
        let bsdf = Bsdf::dielectric(eta, 0.0, 0.0);
        for i in 1..=1000 {
            for side in [1.0, -1.0] {
                let cos = i as f32 / 1000.0;
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, side * cos);
                let power = |s: BsdfSample| f64::from(s.pdf * s.weight.lane(0) * s.eta * s.eta);
                let first = bsdf.sample(wo, 0.0, Vec2::ZERO).unwrap();
                let last = bsdf.sample(wo, 1.0 - f32::EPSILON, Vec2::ZERO).unwrap();
                let total = if first.kind == last.kind { power(first) } else { power(first) + power(last) };
                assert!((total - 1.0).abs() < 3e-7, "eta {eta}, {wo}: {total}");
            }
        }
    }
}

/// The sheet is two smooth faces with light bouncing between them: with `R` the share that the first face reflects and
/// `r` that which the second and then the first reflect from inside, `R' = R + T(r)t + T(r³)t + …`, summed here bounce by
/// bounce from the faces' own samples until the rest is below the rounding of single precision. All of the power leaves.
#[test]
fn a_pane_reflects_what_bounces_between_its_two_faces_and_loses_nothing() {
    let reflects = |face: &Bsdf, wo: Vec3| {
        let s = face.sample(wo, 0.0, Vec2::ZERO).unwrap();
        if s.kind == ScatterKind::Reflection { f64::from(s.pdf) } else { 0.0 }
    };
    for eta in [1.5, 1.33, 2.4, 1.0, 0.75] {
        let (face, pane) = (Bsdf::dielectric(eta, 0.0, 0.0), Bsdf::thin_dielectric(Lanes::splat(eta)));
        for i in 1..=200 {
            for side in [1.0, -1.0] {
                let cos = i as f32 / 200.0;
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let first = reflects(&face, wo);
                let (mut back, mut through) = (first, 0.0);
                let entered = face.sample(wo, 1.0 - f32::EPSILON, Vec2::ZERO).unwrap();
                if entered.kind == ScatterKind::Transmission {
                    // Inside, looking back at either face along the refracted ray: both see the same cosine.
                    let r = reflects(&face, entered.wi);
                    let mut inside = 1.0 - first;
                    while inside > 1e-9 {
                        through += inside * (1.0 - r);
                        back += inside * r * (1.0 - r);
                        inside *= r * r;
                    }
                }
                let wo = Vec3::new(wo.x, 0.0, side * cos);
                let mirror = pane.sample(wo, 0.0, Vec2::ZERO).unwrap();
                let straight = pane.sample(wo, 1.0 - f32::EPSILON, Vec2::ZERO).unwrap();
                let power =
                    |s: BsdfSample, kind| if s.kind == kind { f64::from(s.pdf * s.weight.lane(0)) } else { 0.0 };
                let found = [power(mirror, ScatterKind::Reflection), power(straight, ScatterKind::Transmission)];
                assert!((found[0] - back).abs() < 2e-5, "eta {eta}, {wo}: {found:?}, not {back}");
                assert!((found[1] - through).abs() < 2e-5, "eta {eta}, {wo}: {found:?}, not {through}");
                assert!((found[0] + found[1] - 1.0).abs() < 3e-7, "eta {eta}, {wo}: {found:?}");
                assert!(
                    straight.kind == ScatterKind::Reflection || straight.wi == -wo,
                    "eta {eta}, {wo}: {straight:?}"
                );
            }
        }
    }
}

/// Each lane has its own index, and in each what is not reflected passes: `R' + T' = 1`, though the lobes are chosen by
/// one lane only.
#[test]
fn a_pane_of_many_indices_loses_nothing_in_any_lane() {
    let pane = Bsdf::thin_dielectric(Lanes::rgb(1.4, 1.5, 2.4));
    for i in 1..=200 {
        let cos = i as f32 / 200.0;
        let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let lobes = [0.0, 1.0 - f32::EPSILON].map(|u_lobe| pane.sample(wo, u_lobe, Vec2::ZERO).unwrap());
        assert!(lobes[0].kind != lobes[1].kind, "{wo}: {lobes:?}");
        for lane in 0..3 {
            let power: f32 = lobes.iter().map(|s| s.pdf * s.weight.lane(lane)).sum();
            assert!((power - 1.0).abs() < 8.0 * f32::EPSILON, "{wo}, lane {lane}: {power}");
        }
    }
}

/// Under a uniform sky on both sides a sheet shows `ρ + τ`: the mean weight of its samples.
#[test]
fn a_leaf_scatters_its_reflectance_and_its_transmittance() {
    let (r, t) = (Lanes::rgb(0.8, 0.5, 0.2), Lanes::rgb(0.1, 0.2, 0.7));
    let (leaf, mut stream) = (Bsdf::diffuse_transmission(r, t), Stream::new(10));
    let mut family = Family::new("leaf", 0.01);
    for lane in 0..3 {
        for kind in [ScatterKind::Reflection, ScatterKind::Transmission] {
            let mut weight = || {
                let s = sample(&leaf, Vec3::new(0.6, 0.0, -0.8), &mut stream).unwrap();
                if s.kind == kind { f64::from(s.weight.lane(lane)) } else { 0.0 }
            };
            let exact = if kind == ScatterKind::Reflection { r.lane(lane) } else { t.lane(lane) };
            family.check(&format!("lane {lane}, {kind:?}"), z_test((0..100_000).map(|_| weight()), f64::from(exact)));
        }
    }
    family.finish();
}

/// One facet, hit once, gives away what it got; masking can only take. So no sample weighs more than 1 in power.
#[test]
fn no_lossless_model_creates_energy() {
    for (name, bsdf) in bsdfs().into_iter().filter(|(_, bsdf)| !mixed::overlap(bsdf)) {
        let mut stream = Stream::new(4);
        for _ in 0..50_000 {
            let wo = uniform_direction(&mut stream);
            if let Some(s) = sample(&bsdf, wo, &mut stream) {
                let power = s.weight.max_lane() * s.eta * s.eta;
                let bound = if name.ends_with("tinted") { 2.0 } else { 1.0 };
                assert!(power <= bound + 1e-5, "{name} from {wo}: {s:?}");
            }
        }
    }
}

/// What `sample` returns on average is the integral of `eval`: `E[weight] = ∫ f cos θ dω`.
#[test]
fn the_mean_weight_is_the_integral_of_the_value() {
    let mut family = Family::new("BSDF weights", 0.01);
    for (name, bsdf, wo) in rough_cases() {
        let exact: f64 = cell_integrals(|wi| bsdf.eval(wo, wi).lane(0)).iter().sum();
        let mut stream = Stream::new(5);
        let mut weight = || sample_density(&bsdf, wo, &mut stream).map_or(0.0, |s| f64::from(s.weight.lane(0)));
        family.check(&name, z_test((0..100_000).map(|_| weight()), exact));
    }
    family.finish();
}

/// A nearly smooth surface at normal incidence loses almost nothing to masking: as α → 0 the weight tends to the smooth
/// one, with a loss of order α².
#[test]
fn a_rough_interface_tends_to_the_smooth_one() {
    let mut stream = Stream::new(6);
    for _ in 0..10_000 {
        let drawn = sample(&Bsdf::dielectric(1.5, 0.01, 0.01), Vec3::Z, &mut stream);
        let power = drawn.map_or(0.0, |s| s.weight.lane(0) * s.eta * s.eta);
        assert!(power > 0.9, "{power}");
    }
    assert!(matches!(Bsdf::dielectric(1.5, 9e-4, 9e-4), Bsdf::Dielectric(_)));
    assert!(matches!(Bsdf::dielectric(1.0, 0.5, 0.5), Bsdf::Dielectric(_)));
    assert!(matches!(Bsdf::conductor(Lanes::ONE, Lanes::ONE, 0.0, 9e-4), Bsdf::Conductor(_)));
    assert_eq!(roughness_to_alpha(0.25), 0.5);
}

/// A white base under a clear coat that keeps its colour loses nothing: with `ρ = ρ' = 1` the coat and what comes back
/// through it make 1 in a furnace of diffuse light, `R_ext + (1 − R_ext)² / (η² (1 − R)) = 1`, and so from every direction:
/// `F(o) + (1 − F(o)) (1 − R_ext) / (η² (1 − R)) = 1`.
#[test]
fn a_white_base_under_a_clear_coat_loses_nothing() {
    let mut family = Family::new("white plastic", 0.01);
    for eta in [1.1f32, 1.49, 2.0] {
        let bsdf = Bsdf::Plastic(Plastic::new(eta, internal_reflectance(eta), Lanes::ONE, true));
        for wo in directions() {
            let mut stream = Stream::new(11);
            let mut weight = || sample(&bsdf, wo, &mut stream).map_or(0.0, |s| f64::from(s.weight.lane(0)));
            family.check(&format!("eta {eta} from {wo}"), z_test((0..100_000).map(|_| weight()), 1.0));
        }
    }
    family.finish();
}

/// Directions in and near the surface, degenerate ones, and the ends of the unit interval: everything stays finite and
/// no less than zero.
#[test]
fn nothing_is_infinite_or_negative_at_grazing_angles_or_for_degenerate_directions() {
    let mut hostile = vec![Vec3::ZERO, Vec3::X, -Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::splat(1e-20), Vec3::splat(-1e-30)];
    for z in [1e-3, 1e-6, 1e-12, 1e-38, 1e-45, -0.0f32] {
        hostile.extend([Vec3::new(1.0, 0.0, z), Vec3::new(-0.6, 0.8, z), Vec3::new(0.0, -1.0, -z)]);
    }
    let last = 1.0 - f32::EPSILON / 2.0;
    for (name, bsdf) in bsdfs() {
        for &wo in &hostile {
            for &wi in &hostile {
                let (value, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
                assert!(value.is_finite() && value.min_lane() >= 0.0, "{name}, {wo} {wi}: {value:?}");
                assert!(pdf.is_finite() && pdf >= 0.0, "{name}, {wo} {wi}: {pdf}");
            }
            for u_lobe in [0.0, 0.5, last] {
                for (x, y) in [(0.0, 0.0), (0.0, last), (last, 0.0), (last, last), (0.5, 0.5), (0.25, 1e-7)] {
                    if let Some(s) = bsdf.sample(wo, u_lobe, Vec2::new(x, y)) {
                        let fine = s.wi.is_finite() && s.weight.is_finite() && s.pdf.is_finite();
                        assert!(fine && s.pdf > 0.0 && s.weight.min_lane() >= 0.0, "{name} from {wo}: {s:?}");
                    }
                }
            }
        }
    }
}

/// Without a step of the index, and without a surface, light goes straight on, bit for bit.
#[test]
fn matched_indices_are_invisible() {
    let mut stream = Stream::new(7);
    for _ in 0..10_000 {
        let (wo, u) = (uniform_direction(&mut stream), stream.next_f32());
        for bsdf in [Bsdf::Null, Bsdf::dielectric(1.0, 0.0, 0.0), Bsdf::dielectric(1.0, 0.5, 0.5)] {
            let s = bsdf.sample(wo, u, Vec2::splat(0.3)).unwrap();
            assert_eq!((s.wi, s.weight, s.eta, s.pdf), (-wo, Lanes::ONE, 1.0, 1.0));
        }
    }
}

#[test]
fn a_one_sided_model_is_black_inside() {
    for (name, bsdf) in bsdfs().into_iter().filter(|(name, _)| name.ends_with("outside")) {
        let (wo, wi) = (Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.0, 0.6, -0.8));
        assert!(bsdf.eval(wo, wi).is_zero() && bsdf.pdf(wo, wi) == 0.0, "{name}");
        assert!(bsdf.sample(wo, 0.5, Vec2::splat(0.5)).is_none(), "{name}");
        assert!(!bsdf.eval(-wo, -wi).is_zero() && bsdf.on(Sides::Both).eval(wo, wi) == bsdf.eval(-wo, -wi), "{name}");
    }
}

/// `∫ p dω = 1` and `∫ p cos θ dω = g`, and the histogram of the cosines is that of the density.
#[test]
fn every_phase_function_is_normalised_and_drawn_from_its_density() {
    const CELLS: usize = 50;
    let mut family = Family::new("phase functions", 0.01);
    for (name, phase) in phases() {
        // Between the two nearest cosines of single precision: rounding to one of them moves a sharp peak.
        let density = |c: f64| {
            let near = c as f32;
            let below = if f64::from(near) > c { near.next_down() } else { near };
            let above = below.next_up().min(1.0);
            let t = (c - f64::from(below)) / f64::from(above - below).max(f64::MIN_POSITIVE);
            TAU * (f64::from(phase.eval(below)) * (1.0 - t) + f64::from(phase.eval(above)) * t)
        };
        let edge = |i: usize| 2.0 * i as f64 / CELLS as f64 - 1.0;
        let integrals = |moment: i32| -> Vec<f64> {
            (0..CELLS).map(|i| gauss_legendre(128, edge(i), edge(i + 1), |c| density(c) * c.powi(moment))).collect()
        };
        let expected = integrals(0);
        family.check(&format!("{name}, norm"), close(expected.iter().sum(), 1.0, 2e-6));
        let g = f64::from(phase.mean_cosine());
        family.check(&format!("{name}, mean cosine"), close(integrals(1).iter().sum(), g, 2e-6));

        let (mut observed, mut stream) = (vec![0u64; CELLS], Stream::new(8));
        for _ in 0..500_000 {
            let c = phase.sample(stream.next_f32());
            assert!((-1.0..=1.0).contains(&c), "{name}: {c}");
            observed[(((f64::from(c) + 1.0) * 0.5 * CELLS as f64) as usize).min(CELLS - 1)] += 1;
        }
        family.check(&name, chi_square(&observed, &expected));
    }
    family.finish();
}

/// Single scattering of a beam along any direction: the deflected directions follow the phase function on the sphere,
/// azimuth included.
#[test]
fn deflected_directions_follow_the_phase_function() {
    let phase = Phase::henyey_greenstein(0.5).unwrap();
    let mut family = Family::new("deflection", 0.01);
    for dir in [Vec3::Z, Vec3::new(0.36, -0.48, -0.8)] {
        let expected = cell_integrals(|w| phase.eval(w.dot(dir)));
        let (mut observed, mut stream) = (vec![0u64; expected.len()], Stream::new(9));
        for _ in 0..500_000 {
            observed[cell_of(deflect(dir, phase.sample(stream.next_f32()), stream.next_f32()))] += 1;
        }
        family.check(&format!("{dir}"), chi_square(&observed, &expected));
    }
    family.finish();
}
