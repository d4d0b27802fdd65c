//! Models whose lobes overlap, each drawn direction weighed by all of them: rough plastic and Burley's.

use super::*;
use tyndall::bsdf::{Burley, Principled, PrincipledFixed, PrincipledThin, ThinRates};

/// The rows of the table.
pub(super) fn rows() -> Vec<(&'static str, Bsdf<'static>)> {
    let ochre = Lanes::rgb(0.8, 0.5, 0.2);
    let solid = Principled { burley: DUSTY, metallic: 0.0, clearcoat: 0.0, clearcoat_gloss: 0.0, fixed: &SOLID };
    let glass = Burley { spec_trans: 1.0, sheen: 0.0, ..DUSTY };
    let all = Burley { spec_trans: 0.4, spec_tint: 0.6, anisotropic: 0.5, flatness: 0.3, ..DUSTY };
    let thin = PrincipledThin { burley: DUSTY, eta: 1.5, diff_trans: 0.3, rates: &RATES };
    vec![
        ("rough plastic", rough_plastic(0.1, Distribution::Beckmann, ochre, false)),
        ("dark rough varnish, on the outside", {
            rough_plastic(0.4, Distribution::TrowbridgeReitz, ochre, true).on(Sides::Outside)
        }),
        ("rough plastic, tinted", {
            rough_plastic(0.2, Distribution::TrowbridgeReitz, ochre, false).tinted(ochre, Lanes::ONE)
        }),
        ("principled dust", Bsdf::Principled(solid)),
        ("principled cloth, one side", {
            let burley = Burley { roughness: 0.9, flatness: 1.0, sheen: 1.0, sheen_tint: 1.0, ..DUSTY };
            Bsdf::Principled(Principled { burley, fixed: &ONE_SIDE, ..solid })
        }),
        ("principled metal", {
            let burley = Burley { roughness: 0.4, anisotropic: 0.8, ..DUSTY };
            Bsdf::Principled(Principled { burley, metallic: 1.0, clearcoat: 1.0, ..solid })
        }),
        ("principled glass", Bsdf::Principled(Principled { burley: glass, ..solid })),
        ("principled bubble", {
            let burley = Burley { spec_trans: 0.7, ..DUSTY };
            Bsdf::Principled(Principled { burley, metallic: 0.2, fixed: &BUBBLE, ..solid })
        }),
        ("principled, all of it", {
            let (metallic, clearcoat, clearcoat_gloss) = (0.3, 0.8, 0.1);
            Bsdf::Principled(Principled { burley: all, metallic, clearcoat, clearcoat_gloss, ..solid })
        }),
        ("principled leaf", Bsdf::PrincipledThin(thin)),
        ("principled pane", Bsdf::PrincipledThin(PrincipledThin { burley: glass, ..thin })),
        ("principled paper, all of it", Bsdf::PrincipledThin(PrincipledThin { burley: all, eta: 1.2, ..thin })),
    ]
}

const DUSTY: Burley = Burley {
    colour: [0.8, 0.5, 0.2, 0.5],
    luminance: 0.542,
    roughness: 0.6,
    anisotropic: 0.0,
    spec_trans: 0.0,
    spec_tint: 0.0,
    sheen: 0.5,
    sheen_tint: 0.3,
    flatness: 0.0,
};

const SOLID: PrincipledFixed =
    PrincipledFixed { eta: 1.5, diffuse_rate: 1.0, specular_rate: 1.0, clearcoat_rate: 1.0, sides: Sides::Both };
const ONE_SIDE: PrincipledFixed = PrincipledFixed { diffuse_rate: 2.0, sides: Sides::Outside, ..SOLID };
const BUBBLE: PrincipledFixed = PrincipledFixed { eta: 0.75, ..SOLID };
const RATES: ThinRates = ThinRates {
    diffuse_reflectance: 1.0,
    diffuse_transmittance: 0.5,
    specular_reflectance: 1.0,
    specular_transmittance: 2.0,
};

fn rough_plastic(alpha: f32, distribution: Distribution, rho: Lanes, nonlinear: bool) -> Bsdf<'static> {
    let microfacets = Microfacets { alpha_x: alpha, alpha_y: alpha, distribution, shadowing: Shadowing::Separable };
    let coat = Box::leak(Box::new(RoughCoat::new(1.49, microfacets)));
    Bsdf::RoughPlastic(RoughPlastic::new(coat, rho, nonlinear))
}

/// Whether what a lobe draws is weighed by others too, so that single samples may weigh more than 1.
pub(super) fn overlap(bsdf: &Bsdf) -> bool {
    matches!(bsdf, Bsdf::RoughPlastic(_) | Bsdf::Principled(_) | Bsdf::PrincipledThin(_) | Bsdf::Hair(_))
}

/// White under a coat of little roughness, in a furnace: all comes back but what the definition of `R` takes of what passes
/// the coat, `F + (1 − F) (1 − R₀)/(1 − R)` where `R₀` is the integral, and half a percent that facets of α = 0.01 shadow.
#[test]
fn a_white_base_under_a_rough_coat_loses_what_its_definition_says() {
    for distribution in [Distribution::TrowbridgeReitz, Distribution::Beckmann] {
        let bsdf = rough_plastic(0.01, distribution, Lanes::ONE, true);
        let Bsdf::RoughPlastic(RoughPlastic { coat, .. }) = bsdf else { panic!() };
        let inside = f64::from((1.0 - internal_reflectance(1.49)) / (1.0 - coat.internal));
        assert!((0.97..0.985).contains(&inside), "{inside}");
        for wo in directions().into_iter().filter(|wo| wo.z.abs() > 0.5) {
            let f = f64::from(tyndall::bsdf::fresnel::dielectric(wo.z.abs(), 1.49).reflectance);
            let expected = f + (1.0 - f) * inside;
            let mut stream = Stream::new(13);
            let weight = |_| sample(&bsdf, wo, &mut stream).map_or(0.0, |s| f64::from(s.weight.lane(0)));
            let albedo = (0..200_000).map(weight).sum::<f64>() / 200_000.0;
            assert!((-0.005..0.002).contains(&(albedo - expected)), "{distribution:?} from {wo}: {albedo}, {expected}");
        }
    }
}

/// With nothing but white glass, Burley's solid is a rough dielectric of `α = r²`, from both sides.
#[test]
fn principled_glass_is_a_rough_dielectric() {
    for eta in [1.5, 0.75] {
        let fixed = Box::leak(Box::new(PrincipledFixed { eta, ..SOLID }));
        let burley = Burley { colour: [1.0; 4], spec_trans: 1.0, sheen: 0.0, ..DUSTY };
        let solid = Principled { burley, metallic: 0.0, clearcoat: 0.0, clearcoat_gloss: 0.0, fixed };
        let (solid, alpha) = (Bsdf::Principled(solid), 0.6 * 0.6);
        let glass =
            Bsdf::dielectric(eta, alpha, alpha).distributed(Distribution::TrowbridgeReitz, Shadowing::Separable);
        let mut stream = Stream::new(12);
        for _ in 0..20_000 {
            let (wo, wi) = (uniform_direction(&mut stream), uniform_direction(&mut stream));
            for [a, b] in
                [[solid.eval(wo, wi).lane(0), glass.eval(wo, wi).lane(0)], [solid.pdf(wo, wi), glass.pdf(wo, wi)]]
            {
                assert!((a - b).abs() <= 1e-4 * b, "eta {eta}, {wo} {wi}: {a}, not {b}");
            }
        }
    }
}

/// By hand, at normal incidence and normal exitance: all `S` are 0, so the base is `c/π`, the sheen nothing, the coat
/// `clearcoat/4 · 0.04 D₁(z)` and the highlight `F D(z)/4` with `D(z) = 1/(π α²)` and `F = ((η − 1)/(η + 1))²`, for metal `c`,
/// tinted `F c/Y`.
#[test]
fn principled_at_normal_incidence_is_what_burley_writes() {
    let burley = Burley { roughness: 0.5, spec_tint: 0.25, ..DUSTY };
    let solid = Principled { burley, metallic: 0.3, clearcoat: 0.8, clearcoat_gloss: 0.5, fixed: &SOLID };
    let (c, f) = (0.8f64, 0.04f64);
    let a2 = (0.1f64 - 0.0495).powi(2);
    let coat = 0.2 * 0.04 * (a2 - 1.0) / (std::f64::consts::PI * a2.ln() * a2);
    let facet = 0.7 * (0.75 * f + 0.25 * f * c / 0.542) + 0.3 * c;
    let expected = 0.7 * c / std::f64::consts::PI + coat + facet * 16.0 / (4.0 * std::f64::consts::PI);
    let found = f64::from(Bsdf::Principled(solid).eval(Vec3::Z, Vec3::Z).lane(0));
    assert!((found / expected - 1.0).abs() < 1e-5, "{found}, not {expected}");
}

/// Exchange holds but where a steep facet would send clear light through a thin sheet to a place before it, and at one place
/// of a fibre, which light leaves at another.
pub(super) fn is_not_exchanged(bsdf: &Bsdf, a: Vec3, b: Vec3) -> bool {
    matches!(bsdf, Bsdf::Hair(_))
        || matches!(bsdf, Bsdf::PrincipledThin(sheet) if sheet.burley.spec_trans > 0.0) && a.z * b.z < 0.0
}
