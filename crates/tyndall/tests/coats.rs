//! Coats: their walks against photons that fly between layers one by one, and against closed forms.
//!
//! The density of a coat's sampler is not known, so it is not in the table of `models.rs`: here what is sampled, what is
//! evaluated and what photons do are compared as powers in parts of the hemisphere.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use testkit::quadrature::direction;
use testkit::{Family, Mean, Stream, z_test};
use tyndall::bsdf::{Base, Bsdf, BsdfSample, Coated, Plastic, ScatterKind, fresnel, internal_reflectance};
use tyndall::math::{Vec2, Vec3};
use tyndall::phase::{Phase, deflect};
use tyndall::spectrum::Lanes;

/// Varnish without absorption on a base of `reflectance`.
fn varnish(reflectance: Lanes) -> Coated {
    Coated {
        eta: 1.5,
        alpha_x: 0.0,
        alpha_y: 0.0,
        thickness: 0.0,
        albedo: Lanes::ZERO,
        g: 0.0,
        base: Base::Diffuse(reflectance),
        max_depth: 1000,
        walks: 1,
        seed: 0,
    }
}

fn gold(alpha: f32) -> Base {
    let (eta, k) = (Lanes::rgb(0.14, 0.37, 1.44), Lanes::rgb(3.98, 2.39, 1.60));
    Base::Metal { eta: eta / 1.5, k: k / 1.5, alpha_x: alpha, alpha_y: alpha }
}

fn coats() -> Vec<(&'static str, Coated)> {
    let clear = varnish(Lanes::rgb(0.8, 0.5, 0.2));
    let cloudy = Coated { thickness: 0.7, albedo: Lanes::rgb(0.9, 0.5, 0.0), g: 0.6, ..clear };
    let rough = |alpha_x, alpha_y| move |coat: Coated| Coated { alpha_x, alpha_y, ..coat };
    let on = |base| move |coat: Coated| Coated { base, ..coat };
    vec![
        ("smooth on paint", Coated { max_depth: 10, thickness: 0.01, ..clear }),
        ("rough 0.3 on paint", rough(0.3, 0.3)(clear)),
        ("rough 0.6 and 0.2 on paint, three scatterings", Coated { max_depth: 3, ..rough(0.6, 0.2)(clear) }),
        ("rough 0.5 on paint, of a lower index", Coated { eta: 0.7, ..rough(0.5, 0.5)(clear) }),
        ("cloudy on paint", cloudy),
        ("cloudy and rough on paint, two walks", Coated { walks: 2, ..rough(0.4, 0.4)(cloudy) }),
        ("cloudy and rough on paint, two scatterings", Coated { max_depth: 2, g: -0.5, ..rough(0.4, 0.4)(cloudy) }),
        ("smooth on rough gold", Coated { thickness: 0.1, ..on(gold(0.3))(clear) }),
        ("rough 0.4 on smooth gold", on(gold(0.0))(rough(0.4, 0.4)(clear))),
        ("rough 0.4 on rough gold", on(gold(0.3))(rough(0.4, 0.4)(clear))),
        ("cloudy on smooth gold", on(gold(0.0))(cloudy)),
        ("cloudy and rough on smooth gold", on(gold(0.0))(rough(0.4, 0.4)(cloudy))),
        ("cloudy and rough on rough gold", on(gold(0.2))(rough(0.4, 0.3)(cloudy))),
    ]
}

fn from(cos: f32, phi: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

fn directions() -> [Vec3; 3] {
    [from(0.9, 0.5), from(0.3, 2.0), from(-0.6, 1.0)]
}

/// A direction with the density `|cos θ|/π` on the side of `wo`.
fn cosine_direction(wo: Vec3, stream: &mut Stream) -> Vec3 {
    let w = direction([stream.next_f64().sqrt(), TAU * stream.next_f64()]).map(|x| x as f32);
    Vec3::new(w[0], w[1], w[2].copysign(wo.z))
}

fn sample(model: &Coated, wo: Vec3, stream: &mut Stream) -> Option<BsdfSample> {
    let bsdf = Bsdf::Coated(*model).seeded(|| (stream.next_f64() * 4_294_967_296.0) as u32);
    bsdf.sample(wo, stream.next_f32(), Vec2::new(stream.next_f32(), stream.next_f32()))
}

fn eval(model: &Coated, wo: Vec3, wi: Vec3, stream: &mut Stream) -> Lanes {
    Bsdf::Coated(*model).seeded(|| (stream.next_f64() * 4_294_967_296.0) as u32).eval(wo, wi)
}

/// The naive twin: a photon that flies from layer to layer and from particle to particle until it is absorbed or out.
/// `None` when it is absorbed, in lane 0; else its direction, and whether only mirrors and smooth interfaces turned it.
fn photon(model: &Coated, wo: Vec3, stream: &mut Stream) -> Option<(Vec3, bool)> {
    let top = Bsdf::dielectric(model.eta, model.alpha_x, model.alpha_y);
    let base = match model.base {
        Base::Diffuse(reflectance) => Bsdf::diffuse(reflectance),
        Base::Metal { eta, k, alpha_x, alpha_y } => Bsdf::conductor(eta, k, alpha_x, alpha_y),
    };
    let phase = Phase::henyey_greenstein(model.g).unwrap();
    let flip = 1f32.copysign(wo.z);
    // A photon comes in along −wo from above; by reciprocity it leaves where light from there would have to come from.
    let (mut height, mut dir, mut specular) = (f64::INFINITY, Vec3::new(-wo.x, -wo.y, -wo.z.abs()), true);
    let mut scatterings = 0;
    loop {
        let u: [f32; 3] = std::array::from_fn(|_| stream.next_f32());
        let wall = if dir.z > 0.0 { f64::from(model.thickness) } else { 0.0 };
        let flown = -(1.0 - stream.next_f64()).ln() * f64::from(dir.z);
        let meets_particle = height.is_finite() && flown.abs() < (wall - height).abs();
        if meets_particle {
            if stream.next_f32() >= model.albedo.lane(0) {
                return None;
            }
            height += flown;
            dir = deflect(dir, phase.sample(u[0]), u[1]);
            specular = false;
        } else {
            let at_top = height.is_infinite() || dir.z > 0.0;
            let s = if at_top { &top } else { &base }.sample(-dir, u[0], Vec2::new(u[1], u[2]))?;
            if stream.next_f32() >= s.weight.lane(0) * s.eta * s.eta {
                return None;
            }
            specular &= s.specular;
            dir = s.wi;
            let outside = height.is_infinite();
            let crosses = s.kind == ScatterKind::Transmission;
            if at_top && outside != crosses {
                return Some((Vec3::new(dir.x, dir.y, dir.z * flip), specular));
            }
            height = if at_top { f64::from(model.thickness) } else { 0.0 };
            if at_top && outside {
                continue;
            }
        }
        scatterings += 1;
        if scatterings > model.max_depth {
            return None;
        }
    }
}

const ROWS: usize = 4;
const COLUMNS: usize = 6;

/// The part of the hemisphere that a direction is in, of equal projected solid angle.
fn part(w: Vec3) -> usize {
    let index = |at: f64, n: usize| ((at * n as f64) as usize).min(n - 1);
    let column = index(f64::from(w.y).atan2(f64::from(w.x)) / TAU + 0.5, COLUMNS);
    index(f64::from(w.z * w.z), ROWS) * COLUMNS + column
}

/// Means of what falls in each part.
fn powers(n: usize, mut draw: impl FnMut() -> Option<(Vec3, f64)>) -> Vec<Mean> {
    let mut hits = vec![Vec::new(); ROWS * COLUMNS];
    for _ in 0..n {
        if let Some((w, value)) = draw() {
            hits[part(w)].push(value);
        }
    }
    hits.into_iter()
        .map(|mut values| {
            values.resize(n, 0.0);
            values.into_iter().collect()
        })
        .collect()
}

/// What photons do, what is sampled and what is evaluated are one: the power that is scattered into each part of the
/// hemisphere, lane 0.
#[test]
fn photons_samples_and_values_send_the_same_power_everywhere() {
    const N: usize = 60_000;
    let mut family = Family::new("coats", 0.01);
    for (name, model) in coats() {
        for wo in directions() {
            let [mut a, mut b, mut c] = [1, 2, 3].map(Stream::new);
            let photons = powers(N, || photon(&model, wo, &mut a).filter(|p| !p.1).map(|p| (p.0, 1.0)));
            let sampled = powers(N, || {
                let s = sample(&model, wo, &mut b).filter(|s| !s.specular)?;
                Some((s.wi, f64::from(s.weight.lane(0))))
            });
            let valued = powers(N, || {
                let wi = cosine_direction(wo, &mut c);
                Some((wi, f64::from(eval(&model, wo, wi, &mut c).lane(0)) * PI / f64::from(wi.z.abs())))
            });
            for i in 0..ROWS * COLUMNS {
                family.check(&format!("{name} from {wo}, part {i}, samples"), photons[i].agrees_with(&sampled[i]));
                family.check(&format!("{name} from {wo}, part {i}, values"), photons[i].agrees_with(&valued[i]));
            }
        }
    }
    family.finish();
}

/// The Dirac lobes: photons that only mirrors turned, and samples that are specular.
#[test]
fn photons_and_samples_send_the_same_power_into_dirac_lobes() {
    let mut family = Family::new("coats' mirrors", 0.01);
    for (name, model) in coats() {
        for wo in directions() {
            let [mut a, mut b] = [4, 5].map(Stream::new);
            let photons: Mean =
                (0..60_000).map(|_| f64::from(u8::from(photon(&model, wo, &mut a).is_some_and(|p| p.1)))).collect();
            let samples: Mean = (0..60_000)
                .map(|_| sample(&model, wo, &mut b).filter(|s| s.specular).map_or(0.0, |s| f64::from(s.weight.lane(0))))
                .collect();
            family.check(&format!("{name} from {wo}"), photons.agrees_with(&samples));
        }
    }
    family.finish();
}

/// A smooth clear coat over Lambert's law has the closed form of [`Plastic`]: with all bounces, and cut after five hits of
/// the base, when `(ρR)⁵` of the series is missing.
#[test]
fn a_smooth_clear_coat_over_paint_is_plastic() {
    let (rho, internal) = (Lanes::rgb(0.9, 0.5, 0.2), internal_reflectance(1.5));
    let plastic = Plastic::new(1.5, internal, rho, true);
    let mut family = Family::new("plastic", 0.01);
    for (max_depth, hits) in [(1000, i32::MAX), (10, 5), (9, 5), (8, 4), (1, 1)] {
        let model = Coated { max_depth, ..varnish(rho) };
        for (wo, wi) in [(from(0.9, 0.5), from(0.4, 2.0)), (from(-0.3, 0.5), from(-0.8, 4.0))] {
            for lane in 0..3 {
                let mut stream = Stream::new(6);
                let kept = 1.0 - f64::from(rho.lane(lane) * internal).powi(hits);
                let exact = f64::from(plastic.eval(wo, wi).lane(lane)) * kept;
                let values = (0..20_000).map(|_| f64::from(eval(&model, wo, wi, &mut stream).lane(lane)));
                family.check(&format!("{max_depth} scatterings, {wo} {wi}, lane {lane}"), z_test(values, exact));
            }
        }
    }
    family.finish();
}

/// One hit of the base under an absorbing coat: `f = T(o) T(i)/η² · exp(−τ/cos o' − τ/cos i') ρ/π`.
#[test]
fn a_coat_absorbs_along_the_refracted_ways() {
    let model = Coated { thickness: 0.5, max_depth: 2, ..varnish(Lanes::splat(0.6)) };
    let (wo, wi) = (from(0.8, 1.0), from(0.3, 3.0));
    let way = |w: Vec3| {
        let f = fresnel::dielectric(w.z, 1.5);
        f64::from(1.0 - f.reflectance) * f64::exp(-0.5 / f64::from(f.cos_t))
    };
    let exact = way(wo) * way(wi) / 2.25 * 0.6 * FRAC_1_PI * f64::from(wi.z);
    let value = f64::from(eval(&model, wo, wi, &mut Stream::new(7)).lane(0));
    assert!((value / exact - 1.0).abs() < 1e-5, "{value}, not {exact}");
}

/// A coat of the index of its surroundings is not there, whatever its roughness.
#[test]
fn a_matched_clear_coat_leaves_the_bare_base() {
    let matched = |base| Coated { eta: 1.0, alpha_x: 0.3, alpha_y: 0.3, base, ..varnish(Lanes::ONE) };
    let (wo, wi, mut stream) = (from(0.8, 1.0), from(0.6, 3.5), Stream::new(8));
    for base in [Base::Diffuse(Lanes::rgb(0.8, 0.5, 0.2)), gold(0.3)] {
        let bare = match base {
            Base::Diffuse(reflectance) => Bsdf::diffuse(reflectance),
            Base::Metal { eta, k, alpha_x, alpha_y } => Bsdf::conductor(eta, k, alpha_x, alpha_y),
        };
        let (value, exact) = (eval(&matched(base), wo, wi, &mut stream), bare.eval(wo, wi));
        assert!((value - exact).map(f32::abs).max_lane() < 1e-5 * exact.max_lane(), "{value:?}, not {exact:?}");
    }
}

/// A polished metal under a smooth clear coat is a mirror: `R = F + (1 − F)² C a² Σ (F C a²)^k`, five terms of it.
#[test]
fn a_polished_metal_under_a_smooth_coat_is_a_mirror() {
    let model = Coated { thickness: 0.2, max_depth: 10, base: gold(0.0), ..varnish(Lanes::ONE) };
    let Base::Metal { eta, k, .. } = model.base else { panic!() };
    assert!(Bsdf::Coated(model).is_specular());
    let mut family = Family::new("lacquered mirrors", 0.01);
    for wo in [from(0.9, 0.5), from(0.3, 2.0)] {
        let f = fresnel::dielectric(wo.z, 1.5);
        let r = f64::from(f.reflectance);
        for lane in 0..3 {
            let metal = f64::from(fresnel::conductor(f.cos_t, eta, k).lane(lane));
            let back = metal * f64::exp(-0.4 / f64::from(f.cos_t));
            let exact = r + (1.0 - r).powi(2) * back * (0..5).map(|k| (r * back).powi(k)).sum::<f64>();
            let mut stream = Stream::new(9);
            let mut weight = || {
                let s = sample(&model, wo, &mut stream)?;
                assert!(s.specular && (s.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-6, "{s:?}");
                Some(f64::from(s.weight.lane(lane)))
            };
            let weights = (0..100_000).map(|_| weight().unwrap_or(0.0));
            family.check(&format!("{wo}, lane {lane}"), z_test(weights, exact));
        }
    }
    family.finish();
}

/// In a white furnace a smooth clear coat over a white base loses nothing, and no coat gains: no sample weighs more than 1.
#[test]
fn a_clear_coat_on_white_loses_nothing_and_no_coat_gains() {
    let mut family = Family::new("white coats", 0.01);
    for eta in [1.1, 1.5, 2.0] {
        let model = Coated { eta, max_depth: u16::MAX, ..varnish(Lanes::ONE) };
        for wo in directions() {
            let mut stream = Stream::new(10);
            let weights =
                (0..100_000).map(|_| sample(&model, wo, &mut stream).map_or(0.0, |s| f64::from(s.weight.lane(0))));
            family.check(&format!("eta {eta} from {wo}"), z_test(weights, 1.0));
        }
    }
    family.finish();
    for (name, model) in coats() {
        let mut stream = Stream::new(11);
        for _ in 0..20_000 {
            let wo = from(2.0 * stream.next_f32() - 1.0, stream.next_f32() * 6.0);
            if let Some(s) = sample(&model, wo, &mut stream) {
                assert!(s.weight.max_lane() <= 1.0 + 1e-5, "{name} from {wo}: {s:?}");
            }
        }
    }
}

/// `f(o, i) = f(i, o)` in the mean.
#[test]
fn exchanging_the_directions_changes_nothing() {
    let mut family = Family::new("reciprocity of coats", 0.01);
    for (name, model) in coats() {
        for (a, b) in [(from(0.9, 0.5), from(0.3, 2.0)), (from(0.7, 0.0), from(0.6, 3.0))] {
            let mut stream = Stream::new(12);
            let mut mean = |o: Vec3, i: Vec3| -> Mean {
                (0..40_000).map(|_| f64::from(eval(&model, o, i, &mut stream).lane(0) / i.z)).collect()
            };
            let (there, back) = (mean(a, b), mean(b, a));
            family.check(&format!("{name}, {a} and {b}"), there.agrees_with(&back));
        }
    }
    family.finish();
}

/// Light from a cone around the mirrored direction, found by drawing from the cone and by walks, each weighed by the
/// balance heuristic with `pdf`: as much as walks find alone, though `pdf` is only like their density.
#[test]
fn the_two_ways_to_find_a_light_share_it_without_loss() {
    const COS_CONE: f32 = 0.8;
    let mut family = Family::new("coats and lights", 0.01);
    for (name, model) in coats() {
        for wo in directions() {
            let axis = Vec3::new(-wo.x, -wo.y, wo.z);
            let cone_pdf = 1.0 / (TAU as f32 * (1.0 - COS_CONE));
            let part = |p: f32| p / (p + cone_pdf);
            let [mut a, mut b, mut c] = [13, 14, 15].map(Stream::new);
            let in_cone = |s: &BsdfSample| !s.specular && s.wi.dot(axis) > COS_CONE;
            let walks = |stream: &mut Stream, share: &dyn Fn(&BsdfSample) -> f32| -> f64 {
                let s = sample(&model, wo, stream).filter(in_cone);
                s.map_or(0.0, |s| f64::from(s.weight.lane(0) * share(&s)))
            };
            let alone: Mean = (0..60_000).map(|_| walks(&mut a, &|_| 1.0)).collect();
            let light = |stream: &mut Stream| {
                let cos = 1.0 - stream.next_f32() * (1.0 - COS_CONE);
                let wi = deflect(axis, cos, stream.next_f32());
                let share = 1.0 - part(Bsdf::Coated(model).pdf(wo, wi));
                f64::from(eval(&model, wo, wi, stream).lane(0) * share / cone_pdf)
            };
            let both: Mean = (0..60_000).map(|_| walks(&mut b, &|s| part(s.pdf)) + light(&mut c)).collect();
            family.check(&format!("{name} from {wo}"), alone.agrees_with(&both));
        }
    }
    family.finish();
}

/// Only like the density of the walks, but near it: it integrates to no more than 1.2, since what enters a rough top is
/// taken to be what enters a smooth one, and to no less than a fifth even where most light is in Dirac lobes. Nothing but
/// the noise depends on it.
#[test]
fn the_density_integrates_to_about_one() {
    for (name, model) in coats() {
        for wo in directions() {
            let mut stream = Stream::new(16);
            let total: Mean = (0..100_000)
                .map(|_| {
                    let wi = cosine_direction(wo, &mut stream);
                    f64::from(Bsdf::Coated(model).pdf(wo, wi)) * PI / f64::from(wi.z.abs())
                })
                .collect();
            let most = 1.2 + 4.0 * total.standard_error();
            assert!(total.mean < most && total.mean > 0.2, "{name} from {wo}: {total}");
        }
    }
}

/// One seed, one value; degenerate directions and the ends of the unit interval give nothing that is infinite or negative.
#[test]
fn values_depend_on_the_seed_alone_and_are_finite_for_degenerate_directions() {
    let mut hostile = vec![Vec3::ZERO, Vec3::X, Vec3::Z, -Vec3::Z, Vec3::splat(1e-20), from(0.5, 1.0), from(-0.5, 1.0)];
    for z in [1e-3, 1e-6, 1e-12, 1e-38, 1e-45, -0.0f32] {
        hostile.extend([Vec3::new(1.0, 0.0, z), Vec3::new(-0.6, 0.8, z), Vec3::new(0.0, -1.0, -z)]);
    }
    let last = 1.0 - f32::EPSILON / 2.0;
    for (name, model) in coats() {
        let bsdf = Bsdf::Coated(model);
        let (a, b) = (from(0.5, 1.0), from(0.6, 4.0));
        assert_eq!(bsdf.eval(a, b), bsdf.eval(a, b));
        let differs = |other: Bsdf| other.eval(a, b) != bsdf.eval(a, b);
        assert!((1..20).any(|seed| differs(bsdf.seeded(|| seed))) || model.max_depth < 4, "{name}");
        for &wo in &hostile {
            for &wi in &hostile {
                let (value, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
                assert!(value.is_finite() && value.min_lane() >= 0.0, "{name}, {wo} {wi}: {value:?}");
                assert!(pdf.is_finite() && pdf >= 0.0, "{name}, {wo} {wi}: {pdf}");
            }
            for u_lobe in [0.0, 0.5, last] {
                for (x, y) in [(0.0, 0.0), (0.0, last), (last, 0.0), (last, last), (0.5, 0.5)] {
                    if let Some(s) = bsdf.sample(wo, u_lobe, Vec2::new(x, y)) {
                        let fine = s.wi.is_finite() && s.weight.is_finite() && s.pdf.is_finite();
                        assert!(fine && s.pdf > 0.0 && s.weight.min_lane() >= 0.0, "{name} from {wo}: {s:?}");
                    }
                }
            }
        }
    }
}
