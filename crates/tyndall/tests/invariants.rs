//! The invariants of DESIGN: what must not be seen in an image, and what must be seen in every one of them.

mod common;

use common::{World, assert_mean, diffuse, glass, medium};
use tyndall::{
    camera::{CameraModel, Perspective},
    film::{Crop, Filter},
    integrator::{Analog, Counted, Deep, Integrator, VolPath},
    light::{Light, PointLight},
    material::{Index, Material, Roughness},
    math::Vec3,
    medium::MediumId,
    render::{Allocation, Rendering, Settings, render},
    sampling::SamplerKind,
    scene::Scene,
    spectrum::{ColorMode, Spectrum, glass::Glass},
};

/// Coloured fog in glass, a rough glass ball, a lamp and a sky, in units of `scale`.
fn still_life(scale: f32, color: ColorMode) -> Scene {
    let mut world = World::seen(Vec3::new(0.0, 1.0, 4.0) * scale, Vec3::new(0.0, 0.5, 0.0) * scale);
    world.color = color;
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.5, 0.5, -0.4, 0.4]));
    (world.camera.width, world.camera.height) = (40, 33);
    world.camera.filter = Filter::Gaussian { radius: [1.5, 1.5], sigma: 0.5 };
    let per = |v: f32| v / scale;
    let fog = medium([0.05, 0.1, 0.2].map(per), [2.0, 3.0, 4.0].map(per), 0.6);
    world.sphere(Vec3::new(-0.8, 0.5, 0.0) * scale, 0.5 * scale, glass(1.4, 0.0), Some(fog));
    world.sphere(Vec3::new(0.6, 0.4, 0.3) * scale, 0.4 * scale, glass(1.5, 0.3), None);
    let haze = medium([0.0; 3], [0.5; 3].map(per), 0.0);
    world.cuboid(Vec3::new(-0.2, 0.1, -1.0) * scale, Vec3::new(0.3, 1.0, -0.5) * scale, Material::Null, Some(haze));
    world.cuboid(Vec3::new(-9.0, -1.0, -9.0) * scale, Vec3::new(9.0, 0.0, 9.0) * scale, diffuse(0.5), None);
    world.shining_disk(3.0 * scale, 0.7 * scale, diffuse(0.0), 10.0);
    world.sky(0.3);
    world.scene()
}

fn picture(scene: &Scene, integrator: &dyn Integrator, settings: &Settings, threads: usize) -> Rendering {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| render(scene, integrator, settings, &()))
}

#[test]
fn one_thread_and_many_give_the_same_bits() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        let scene = still_life(1.0, color);
        let settings = Settings { spp: 5, seed: 3, ..Settings::default() };
        let one = picture(&scene, &VolPath::default(), &settings, 1);
        let many = picture(&scene, &VolPath::default(), &settings, 7);
        assert_eq!(one.film, many.film, "{color:?}");
        assert_eq!(one.tally, many.tally, "{color:?}");
        assert_eq!((one.tally.bad_samples, one.tally.leaks), (0, 0));
    }
}

#[test]
fn one_thread_and_many_share_samples_out_alike() {
    let scene = still_life(1.0, ColorMode::Rgb);
    let settings = Settings { spp: 20, allocation: Allocation::ByError, ..Settings::default() };
    let one = picture(&scene, &VolPath::default(), &settings, 1);
    assert_eq!(one, picture(&scene, &VolPath::default(), &settings, 7));
    let counts: Vec<u64> = one.film.pixels.iter().map(|pixel| pixel.count).collect();
    assert!(counts.iter().max() > counts.iter().min().map(|least| 2 * least).as_ref(), "all have as many");
    let mean = counts.iter().sum::<u64>() as f64 / counts.len() as f64;
    assert!(mean <= 20.0 && mean > 19.0, "{mean}");
}

#[test]
fn a_crop_of_the_image_is_the_image_of_the_crop() {
    let scene = still_life(1.0, ColorMode::Rgb);
    let settings = Settings { spp: 3, seed: 3, ..Settings::default() };
    let crop = Crop { min: (5, 7), max: (29, 31) };
    let whole = picture(&scene, &VolPath::default(), &settings, 2);
    let part = picture(&scene, &VolPath::default(), &Settings { crop: Some(crop), ..settings }, 2);
    for y in crop.min.1..crop.max.1 {
        for x in crop.min.0..crop.max.0 {
            assert_eq!(whole.film.pixel(x, y), part.film.pixel(x, y), "({x}, {y})");
        }
    }
}

/// Samples 0..6 are samples 0..4 and 4..6; sums of doubles are merged, so equal to rounding of the last bit of a sum.
#[test]
fn a_render_in_two_parts_merges_into_one() {
    let scene = still_life(1.0, ColorMode::Rgb);
    let part = |first_sample, spp| {
        let settings = Settings { spp, first_sample, seed: 3, ..Settings::default() };
        picture(&scene, &VolPath::default(), &settings, 2).film
    };
    let mut merged = part(0, 4);
    merged.merge(&part(4, 2)).unwrap();
    for (a, b) in merged.pixels.iter().zip(&part(0, 6).pixels) {
        assert_eq!(a.count, b.count);
        for c in 0..3 {
            assert!((a.sum[c] - b.sum[c]).abs() <= 1e-14 * b.sum[c].abs(), "{} {}", a.sum[c], b.sum[c]);
        }
    }
}

/// Lengths times 10⁻⁶ or 10⁶, coefficients divided by as much: the same image. A power of two would give the same bits;
/// a power of ten rounds differently, so single samples may part ways, but almost all pixels agree closely.
#[test]
fn a_scene_of_another_size_gives_the_same_image() {
    let settings = Settings { spp: 4, seed: 3, ..Settings::default() };
    let reference = picture(&still_life(1.0, ColorMode::Rgb), &VolPath::default(), &settings, 2).film;
    for scale in [(-20f32).exp2(), 20f32.exp2()] {
        let other = picture(&still_life(scale, ColorMode::Rgb), &VolPath::default(), &settings, 2).film;
        let parted = reference.pixels.iter().zip(&other.pixels).filter(|(a, b)| a.mean() != b.mean()).count();
        assert_eq!(parted, 0, "scale {scale:e}");
    }
    for scale in [1e-6, 1e6] {
        let other = picture(&still_life(scale, ColorMode::Rgb), &VolPath::default(), &settings, 2);
        assert_eq!(other.tally.leaks + other.tally.bad_samples, 0, "scale {scale:e}");
        let close = |(a, b): &(&tyndall::film::Pixel, &tyndall::film::Pixel)| {
            (0..3).all(|c| (a.mean()[c] - b.mean()[c]).abs() < 1e-3 * (a.mean()[c] + 0.01))
        };
        let share = reference.pixels.iter().zip(&other.film.pixels).filter(close).count() as f64
            / reference.pixels.len() as f64;
        assert!(share > 0.95, "scale {scale:e}: only {share} of the pixels agree");
    }
}

/// The clever estimator agrees with its naive twin over the whole picture, in every colour mode: the mean over all
/// pixels, from their standard errors.
#[test]
fn volpath_agrees_with_its_naive_twin() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        let scene = still_life(1.0, color);
        let mean = |integrator: &dyn Integrator, spp| {
            let settings = Settings { spp, seed: 5, sampler: SamplerKind::Independent, ..Settings::default() };
            let film = picture(&scene, integrator, &settings, 2).film;
            let n = film.pixels.len() as f64;
            let mean: [f64; 3] =
                std::array::from_fn(|c| film.pixels.iter().map(|p| f64::from(p.mean()[c])).sum::<f64>() / n);
            let variance: [f64; 3] = std::array::from_fn(|c| {
                film.pixels.iter().map(|p| f64::from(p.standard_error()[c]).powi(2)).sum::<f64>() / (n * n)
            });
            (mean, variance)
        };
        let (clever, v1) = mean(&VolPath::default(), 64);
        let (naive, v2) = mean(&Analog, 1000);
        for c in 0..3 {
            let z = (clever[c] - naive[c]) / (v1[c] + v2[c]).sqrt();
            assert!(z.abs() < 4.0, "{color:?}, channel {c}: {} and {} (z = {z:.1})", clever[c], naive[c]);
            assert!((v1[c] + v2[c]).sqrt() < 0.015 * naive[c], "too blunt: {} of {}", (v1[c] + v2[c]).sqrt(), naive[c]);
        }
    }
}

/// Glass that disperses sends each wavelength its own way, and still neither makes nor takes light; nor does what it holds,
/// which scatters each wavelength by another coefficient.
#[test]
fn a_ball_of_flint_glass_under_a_uniform_sky_vanishes() {
    let coloured = || Some(medium([0.0; 3], [1.0, 3.0, 8.0], 0.3));
    let traced = VolPath { deep: Deep::Traced, ..VolPath::default() };
    let cases: [(&dyn Integrator, _); 5] = [
        (&VolPath::default(), None),
        (&Analog, None),
        (&VolPath::default(), coloured()),
        (&traced, coloured()),
        (&Analog, coloured()),
    ];
    for (integrator, inside) in cases {
        let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
        world.color = ColorMode::Spectral;
        let flint = Material::Dielectric {
            eta: Index::Glass(*Glass::named("SF11").unwrap()),
            alpha: Roughness::constant([0.0; 2]),
            reflection_tint: 1.0.into(),
            transmission_tint: 1.0.into(),
        };
        world.sphere(Vec3::ZERO, 1.0, flint, inside);
        world.sky(1.0);
        assert_mean("flint", &world.measure(integrator, 200_000), [1.0; 3], 0.01);
    }
}

/// A camera in the middle of an absorbing ball of radius 1 under a uniform sky sees exp(−σ_a); in a scattering one of
/// albedo 1 it sees 1.
#[test]
fn a_camera_inside_a_medium_sees_through_it() {
    for integrator in [&VolPath::default() as &dyn Integrator, &Analog] {
        let inside = |sigma_a: [f32; 3], sigma_s: [f32; 3]| {
            let mut world = World::seen(Vec3::ZERO, Vec3::X);
            world.camera.medium = Some(MediumId(0));
            world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(medium(sigma_a, sigma_s, 0.0)));
            world.sky(1.0);
            world.measure(integrator, 60_000)
        };
        let sigma = [0.3, 1.0, 2.0];
        assert_mean("absorbing", &inside(sigma, [0.0; 3]), sigma.map(|s| f64::from(-s).exp()), 0.02);
        assert_mean("scattering", &inside([0.0; 3], sigma), [1.0; 3], 0.02);
    }
}

/// A point light outside a fog is sampled through the fog's open boundary, with its transmittance and without a coin:
/// light scattered once on the axis between lamp and camera, ∫ σ_s/4π · I/(D − t)² · e^{−σ_t(a+b)} dt over the fog, where
/// the ray enters the slab 0 < t < 1 at its face and the lamp stands at D = 3 straight behind (g = 0, forward scattering
/// by angle 0; the light passes 1 − t in the fog after t).
#[test]
fn a_lamp_behind_fog_is_seen_once_scattered_as_the_integral_says() {
    let (sigma_t, albedo, lamp) = ([0.5, 1.0, 2.0], 0.8, 3.0);
    let mut world = World::seen(Vec3::new(0.0, 1.0, 0.0), Vec3::ZERO);
    world.slab(1.0, Material::Null, medium(sigma_t.map(|s| s * (1.0 - albedo)), sigma_t.map(|s| s * albedo), 0.0));
    let intensity = Spectrum::constant(1.0);
    let position = Vec3::new(0.0, -lamp, 0.0);
    world.lights.push(Light::Point(PointLight { position, intensity, luminance: 1.0 }));
    let expected = sigma_t.map(|s| {
        let (s, lamp) = (f64::from(s), f64::from(lamp));
        // ∫₀¹ dt/(D − t)² = 1/(D−1) − 1/D, and the attenuation is e^{−σ_t} wherever light scatters.
        0.8 * s / (4.0 * std::f64::consts::PI) * (1.0 / (lamp - 1.0) - 1.0 / lamp) * (-s).exp()
    });
    let single = VolPath { max_depth: Some(1), ..VolPath::default() };
    assert_mean("lamp", &world.measure(&single, 100_000), expected, 0.01);
}

/// A limit that the user asks for takes energy, and the tally says how much: in an enclosure with ρ = ½ and L_e = 1, cut
/// after n scatterings, the image is L_e(1 − ρ^{n+1})/(1 − ρ), and each cut path still carried ρⁿ.
#[test]
fn energy_lost_to_a_depth_limit_is_tallied() {
    let mut world = World::seen(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 1.0, 0.5));
    world.shining_sphere(Vec3::ZERO, 1.0, diffuse(0.5), 1.0, true);
    let scene = world.scene();
    let limited = VolPath { max_depth: Some(3), roulette: 0.0, ..VolPath::default() };
    let settings = Settings { spp: 20_000, sampler: SamplerKind::Independent, ..Settings::default() };
    let rendering = render(&scene, &limited, &settings, &());
    let mean = f64::from(rendering.film.pixel(0, 0).unwrap().mean()[0]);
    assert!((mean - (1.0 - 0.5f64.powi(4)) / 0.5).abs() < 0.02, "{mean}");
    assert_eq!(rendering.tally.truncated_paths, 20_000);
    let carried = rendering.tally.truncated_throughput / 20_000.0;
    assert!((carried - 0.125).abs() < 1e-6, "{carried}");
}

/// A sky of radiance 1 behind two panes of `r = 0.04`, `R = 2r/(1 + r)` and `T = 1 − R`: a path that may scatter once does
/// not get through both, and one that may scatter twice brings T². Where only turns count, one that may not turn at all
/// does, and one that may turn twice brings what goes to and fro between them as well: T² (1 + R²).
#[test]
fn panes_that_are_passed_straight_count_for_a_limit_or_not() {
    let r = 0.08 / 1.04;
    let t2 = (1.0 - r) * (1.0 - r);
    for (counted, max_depth, expected) in [
        (Counted::Scatterings, 1, 0.0),
        (Counted::Scatterings, 2, t2),
        (Counted::Turns, 0, t2),
        (Counted::Turns, 2, t2 * (1.0 + r * r)),
    ] {
        let mut world = World::seen(Vec3::new(0.0, 9.0, 0.0), Vec3::ZERO);
        let tint = || 1.0.into();
        let (reflection_tint, transmission_tint) = (tint(), tint());
        let pane = Material::ThinDielectric { eta: Index::Constant(1.5), reflection_tint, transmission_tint };
        world.cuboid(Vec3::new(-50.0, 0.0, -50.0), Vec3::new(50.0, 1.0, 50.0), pane, None);
        world.half_sky(0.0, 1.0);
        let limited = VolPath { max_depth: Some(max_depth), counted, roulette: 0.0, ..VolPath::default() };
        let m = world.measure(&limited, 400_000);
        let name = format!("{counted:?} up to {max_depth}");
        if expected == 0.0 {
            assert_eq!(m.mean, [0.0; 3], "{name}");
        } else {
            assert_mean(&name, &m, [expected; 3], 2e-3);
        }
    }
}

/// Roulette that is capped below the albedo has infinite variance in media of albedo 1: weights grow as (1/0.95)ⁿ. Ours
/// never lifts a weight beyond its threshold, so the fourth moment stays of the order of the square of the second.
#[test]
fn roulette_keeps_the_variance_finite_at_albedo_one() {
    let mut world = World::seen(Vec3::new(0.0, 0.3, 5.0), Vec3::new(0.0, 0.3, 0.0));
    world.sphere(Vec3::ZERO, 1.0, Material::Null, Some(medium([0.0; 3], [20.0; 3], 0.0)));
    world.sky(1.0);
    let scene = world.scene();
    let samples: Vec<f64> = (0..4_000)
        .map(|index| {
            let settings =
                Settings { spp: 1, first_sample: index, sampler: SamplerKind::Independent, ..Settings::default() };
            f64::from(render(&scene, &VolPath::default(), &settings, &()).film.pixel(0, 0).unwrap().mean()[0])
        })
        .collect();
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let moment = |k: i32| samples.iter().map(|s| (s - mean).powi(k)).sum::<f64>() / n;
    let kurtosis = moment(4) / moment(2).powi(2);
    assert!((mean - 1.0).abs() < 4.0 * (moment(2) / n).sqrt(), "{mean}");
    assert!(kurtosis < 30.0, "kurtosis {kurtosis}");
}

/// A ball of few facets with the normals of a sphere, of smooth glass and full of fog: shading normals that disagree with
/// the facets neither take light nor let a path out of the medium unseen.
#[test]
fn a_faceted_ball_of_glass_with_smooth_normals_vanishes() {
    for integrator in [&VolPath::default() as &dyn Integrator, &Analog] {
        let mut world = World::seen(Vec3::new(0.3, 0.5, 5.0), Vec3::new(0.3, 0.5, 0.0));
        world.faceted_ball(1.0, 12, glass(1.33, 0.0), medium([0.0; 3], [3.0, 4.0, 5.0], 0.0));
        world.sky(1.0);
        let scene = world.scene();
        let settings = Settings { spp: 60_000, sampler: SamplerKind::Independent, ..Settings::default() };
        let rendering = render(&scene, integrator, &settings, &());
        assert_eq!(rendering.tally.leaks, 0, "{} collisions", rendering.tally.collisions);
        assert_mean("faceted ball", &common::measure(&scene, integrator, 60_000), [1.0; 3], 0.01);
    }
}
