//! Measured materials: tables whose BRDF is known in closed form, and tables without a form that must be drawn from.

use std::f64::consts::{PI, TAU};

use testkit::quadrature::direction;
use testkit::{Family, Grid, Stream, chi_square, z_test};
use tyndall::bsdf::measured::{Block, Channels, GridError, Measured, Parts, Tables, TablesError};
use tyndall::bsdf::{Bsdf, Sides};
use tyndall::math::{Vec2, Vec3};
use tyndall::spectrum::{ColorMode, Lanes, Wavelengths};

const SIZE: usize = 8;

fn block(shape: &[usize], mut value: impl FnMut(&[usize]) -> f64) -> Block {
    let count = shape.iter().product();
    let values = (0..count).map(|flat| {
        let mut rest = flat;
        let mut at = vec![0; shape.len()];
        for (index, n) in at.iter_mut().zip(shape).rev() {
            (*index, rest) = (rest % n, rest / n);
        }
        value(&at) as f32
    });
    Block { shape: shape.to_vec(), values: values.collect() }
}

/// Of a grid of [`SIZE`], the coordinates of its last two indices.
fn place(at: &[usize]) -> [f64; 2] {
    let n = at.len();
    [at[n - 1], at[n - 2]].map(|i| i as f64 / (SIZE - 1) as f64)
}

/// Tables of an isotropic material without warps, whose value is linear in everything: `1 + x + 2y + 3θ` times the
/// channel's number, from 1.
fn plain() -> Parts {
    let theta = vec![0.0, 0.8, 1.5];
    let views = [1, 3, SIZE, SIZE];
    let angles = theta.clone();
    Parts {
        theta,
        phi: vec![0.0],
        normals: block(&[SIZE, SIZE], |_| 1.0),
        area: block(&[SIZE, SIZE], |_| 1.0),
        visible: block(&views, |_| 1.0),
        luminance: block(&views, |_| 1.0),
        spectra: block(&[1, 3, 3, SIZE, SIZE], |at| {
            let [x, y] = place(at);
            (1.0 + x + 2.0 * y + 3.0 * f64::from(angles[at[1]])) * (at[2] + 1) as f64
        }),
        channels: Channels::Rgb,
        jacobian: true,
    }
}

/// Tables that vary with everything; over all azimuths, or a part of them.
fn rough(phi: &[f32]) -> Parts {
    let views = [phi.len(), 3, SIZE, SIZE];
    let wave = |at: &[usize], a: f64| {
        let [x, y] = place(at);
        let view = at[..at.len() - 2].iter().enumerate().map(|(i, n)| (i + 1) as f64 * *n as f64).sum::<f64>();
        1.2 + (a * x + view).sin() * (2.0 * a * y - view).cos()
    };
    Parts {
        phi: phi.to_vec(),
        normals: block(&[SIZE, SIZE], |at| wave(at, 2.0)),
        // The same from all around, if the material is isotropic.
        area: block(&[SIZE, SIZE], |at| {
            1.0 + place(at)[0] + if phi.len() > 2 { (TAU * place(at)[1]).sin() } else { 0.0 }
        }),
        visible: block(&views, |at| wave(at, 1.5)),
        luminance: block(&views, |at| wave(at, 2.5)),
        spectra: block(&[phi.len(), 3, 3, SIZE, SIZE], |at| 0.2 * wave(at, 3.0)),
        ..plain()
    }
}

fn all() -> Vec<(&'static str, Tables)> {
    let tables = |parts| Tables::new(parts, ColorMode::Rgb).unwrap();
    let (half, whole) = (PI as f32 / 2.0, PI as f32);
    vec![
        ("plain", tables(plain())),
        ("isotropic", tables(rough(&[0.0]))),
        ("anisotropic", tables(rough(&[-whole, -1.0, 1.0, whole]))),
        ("of two equal halves", tables(rough(&[-whole, -2.0, -1.0, 0.0]))),
        ("of four equal quarters", tables(rough(&[-whole, -2.5, -half]))),
    ]
}

fn from(cos: f32, phi: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

/// `f cos θi = (1 + x + 2y + 3θo)/4` with `x = √(2θm/π)` and `y = (φm − φo + π)/2π`; θo beyond the tables is at their end.
#[test]
fn tables_without_warps_are_looked_up_in_closed_form() {
    let tables = Tables::new(plain(), ColorMode::Rgb).unwrap();
    let bsdf = Bsdf::Measured(Measured::new(&tables, &Wavelengths::Rgb));
    let mut stream = Stream::new(1);
    for _ in 0..2000 {
        let (wo, wi) =
            (from(stream.next_f32(), 6.0 * stream.next_f32()), from(stream.next_f32(), 6.0 * stream.next_f32()));
        let m = (wo + wi).normalize();
        let angle = |w: Vec3| (f64::from(w.z).acos(), f64::from(w.y).atan2(f64::from(w.x)));
        let ((theta_o, phi_o), (theta_m, phi_m)) = (angle(wo), angle(m));
        let y = ((phi_m - phi_o + PI) / TAU).rem_euclid(1.0);
        let exact = (1.0 + (2.0 * theta_m / PI).sqrt() + 2.0 * y + 3.0 * theta_o.min(1.5)) / 4.0;
        for (side, lane) in [(1.0, 0), (-1.0, 1), (1.0, 2)] {
            let turned = |w: Vec3| Vec3::new(w.x, w.y, side * w.z);
            let value = f64::from(bsdf.eval(turned(wo), turned(wi)).lane(lane)) / f64::from(lane as u8 + 1);
            assert!((value / exact - 1.0).abs() < 2e-3, "{wo} {wi}: {value}, not {exact}");
        }
        assert!(bsdf.on(Sides::Outside).eval(-wo, -wi).is_zero() && bsdf.eval(wo, -wi).is_zero());
    }
}

/// The sphere in cells, fine since the density has a peak where the facet is the pole; the horizon is an edge.
const SPHERE: Grid = Grid { nx: 40, ny: 48, ..Grid::SPHERE };

fn cells(f: impl Fn(Vec3) -> f32) -> Vec<f64> {
    SPHERE.integrate(|p| f64::from(f(Vec3::from_array(direction(p).map(|x| x as f32)))))
}

fn cell_of(w: Vec3) -> usize {
    let index = |at: f64, n: usize| ((at * n as f64) as usize).min(n - 1);
    let row = index((f64::from(w.z) + 1.0) * 0.5, SPHERE.nx);
    row * SPHERE.ny + index(f64::from(w.y).atan2(f64::from(w.x)) / TAU + 0.5, SPHERE.ny)
}

/// Directions follow the density, weights are values over densities, and their mean is the integral of the value.
#[test]
fn directions_are_drawn_from_their_density() {
    let mut family = Family::new("measured", 0.01);
    for (name, tables) in all() {
        let bsdf = Bsdf::Measured(Measured::new(&tables, &Wavelengths::Rgb));
        for wo in [from(0.4, 2.0), from(-0.8, -1.0)] {
            let name = format!("{name} from {wo}");
            let mut expected = cells(|wi| bsdf.pdf(wo, wi));
            let total: f64 = expected.iter().sum();
            assert!(total < 1.0 + 2e-3, "{name}: the density integrates to {total}");
            expected.push((1.0 - total).max(0.0));
            let (mut observed, mut stream) = (vec![0u64; expected.len()], Stream::new(2));
            let mut weights = Vec::new();
            for _ in 0..100_000 {
                let u = Vec2::new(stream.next_f32(), stream.next_f32());
                let drawn = bsdf.sample(wo, 0.5, u);
                observed[drawn.map_or(expected.len() - 1, |s| cell_of(s.wi))] += 1;
                weights.push(drawn.map_or(0.0, |s| f64::from(s.weight.lane(0))));
                let Some(s) = drawn else { continue };
                let (value, pdf) = (bsdf.eval(wo, s.wi), bsdf.pdf(wo, s.wi));
                // Where a table has an edge rounding puts the two on either side of it: so the bound on most.
                assert!(s.wi.z * wo.z > 0.0 && value.is_finite() && pdf > 0.0, "{name}: {s:?}");
                // At the pole the azimuth of the facet, which is another in these tables, cannot be told from directions.
                if (wo + s.wi).normalize().z.abs() > 1.0 - 1e-4 {
                    continue;
                }
                assert!((s.pdf / pdf - 1.0).abs() < 0.02, "{name}: {s:?} but pdf {pdf}");
                assert!((s.weight * pdf - value).map(f32::abs).max_lane() < 0.02 * value.max_lane(), "{name}: {s:?}");
            }
            family.check(&name, chi_square(&observed, &expected));
            let exact = cells(|wi| bsdf.eval(wo, wi).lane(0)).iter().sum();
            family.check(&format!("{name}, weights"), z_test(weights, exact));
        }
    }
    family.finish();
}

/// A material that is the same in so many parts of the azimuths is the same when both directions are turned or mirrored.
#[test]
fn symmetric_materials_are_symmetric() {
    let (a, b) = (from(0.8, 0.4), from(0.6, 2.0));
    let turned = |w: Vec3, x: f32, y: f32| Vec3::new(x * w.x, y * w.y, w.z);
    for (name, tables) in all() {
        let bsdf = Bsdf::Measured(Measured::new(&tables, &Wavelengths::Rgb));
        let value = |x, y| bsdf.eval(turned(a, x, y), turned(b, x, y)).lane(0);
        let alike = |x, y| (value(x, y) / value(1.0, 1.0) - 1.0).abs() < 1e-3;
        match name {
            "of two equal halves" => assert!(alike(-1.0, -1.0) && !alike(-1.0, 1.0), "{name}"),
            "of four equal quarters" => assert!(alike(-1.0, -1.0) && alike(-1.0, 1.0) && alike(1.0, -1.0), "{name}"),
            "anisotropic" => assert!(!alike(-1.0, -1.0) && !alike(-1.0, 1.0), "{name}"),
            _ => assert!(alike(-1.0, -1.0), "{name}"),
        }
    }
}

/// A grey spectrum is grey in RGB and in one value, and each wavelength has its own number in spectral mode.
#[test]
fn spectra_become_the_colours_of_the_render() {
    let lambda: Vec<f32> = (0..48).map(|i| 360.0 + 10.0 * i as f32).collect();
    let flat = |value: fn(f32) -> f64| {
        let wavelengths = lambda.clone();
        let spectra = block(&[1, 3, lambda.len(), SIZE, SIZE], |at| value(wavelengths[at[2]]));
        Parts { spectra, channels: Channels::Wavelengths(lambda.clone()), ..plain() }
    };
    let eval = |parts, mode, wavelengths: &Wavelengths| {
        let tables = Tables::new(parts, mode).unwrap();
        Bsdf::Measured(Measured::new(&tables, wavelengths)).eval(from(0.8, 0.0), from(0.7, 2.0)) * 4.0
    };
    for (mode, wavelengths) in [(ColorMode::Rgb, Wavelengths::Rgb), (ColorMode::Mono, Wavelengths::Mono)] {
        let grey = eval(flat(|_| 0.5), mode, &wavelengths);
        assert!((grey - Lanes::splat(0.5)).map(f32::abs).max_lane() < 1e-3, "{mode:?}: {grey:?}");
    }
    let at = Wavelengths::Spectral { lambda: [400.0, 455.0, 620.0, 700.0], pdf: [1.0; 4] };
    let ramp = eval(flat(|l| f64::from(l) / 1000.0), ColorMode::Spectral, &at);
    assert!((ramp - Lanes::new([0.4, 0.455, 0.62, 0.7])).map(f32::abs).max_lane() < 1e-5, "{ramp:?}");
    assert_eq!(Tables::new(plain(), ColorMode::Spectral).err(), Some(TablesError::NoSpectra));
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    let fault = |change: fn(&mut Parts)| {
        let mut parts = plain();
        change(&mut parts);
        Tables::new(parts, ColorMode::Rgb).err()
    };
    assert_eq!(fault(|_| ()), None);
    assert_eq!(fault(|p| p.theta[1] = 0.0), Some(GridError::Parameters.into()));
    assert_eq!(fault(|p| p.theta = Vec::new()), Some(GridError::Shape.into()));
    assert_eq!(fault(|p| p.normals.values[3] = f32::NAN), Some(GridError::Value.into()));
    assert_eq!(fault(|p| p.visible.values[3] = -1.0), Some(GridError::Value.into()));
    assert_eq!(fault(|p| p.luminance.values.fill(0.0)), Some(GridError::Empty.into()));
    assert_eq!(fault(|p| p.spectra.shape = vec![1, 3, 0, 8, 8]), Some(GridError::Shape.into()));
    let endless = Block { shape: vec![0, 1, 3, usize::MAX, usize::MAX], values: Vec::new() };
    let parts = Parts { spectra: endless, ..plain() };
    assert_eq!(Tables::new(parts, ColorMode::Rgb).err(), Some(GridError::Shape.into()));
    assert_eq!(fault(|p| p.visible.shape = vec![usize::MAX; 4]), Some(GridError::Shape.into()));
    assert_eq!(fault(|p| p.phi = vec![0.0, 0.1, 0.2]), Some(TablesError::Azimuths));
}

/// Degenerate directions and the ends of the unit interval.
#[test]
fn nothing_is_infinite_or_negative() {
    let mut hostile = vec![Vec3::ZERO, Vec3::X, Vec3::Z, -Vec3::Z, Vec3::splat(1e-20), from(0.5, 1.0)];
    for z in [1e-3, 1e-6, 1e-38, 1e-45, -0.0f32] {
        hostile.extend([Vec3::new(1.0, 0.0, z), Vec3::new(-0.6, 0.8, z)]);
    }
    for (name, tables) in all() {
        let bsdf = Bsdf::Measured(Measured::new(&tables, &Wavelengths::Rgb));
        for &wo in &hostile {
            for &wi in &hostile {
                let (value, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
                assert!(value.is_finite() && value.min_lane() >= 0.0, "{name}, {wo} {wi}: {value:?}");
                assert!(pdf.is_finite() && pdf >= 0.0, "{name}, {wo} {wi}: {pdf}");
            }
            for (x, y) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1e-7)] {
                if let Some(s) = bsdf.sample(wo, 0.5, Vec2::new(x, y)) {
                    assert!(s.wi.is_finite() && s.weight.is_finite() && s.pdf > 0.0, "{name} from {wo}: {s:?}");
                }
            }
        }
    }
}
