//! Light taken apart: layers add up to the image, do not change it, and are what closed forms say.

mod common;

use common::{World, diffuse, glass, grey, medium};
use tyndall::{
    bsdf::Sides,
    camera::{CameraModel, Orthographic, Perspective},
    film::{Average, Film, Layer},
    integrator::{Analog, Deep, Integrator, VolPath},
    light::{Distant, Light},
    lpe::{Names, named},
    material::Material,
    math::Vec3,
    medium::Homogeneous,
    render::{Settings, render},
    sampling::SamplerKind,
    scene::Scene,
    spectrum::{ColorMode, Spectrum},
};

const PARTITIONS: [&str; 5] = [
    "emission,direct,indirect",
    "unscattered,single,multiple",
    "orders:3",
    "depths:3",
    "emission,direct_surface,direct_volume,indirect_surface,indirect_volume",
];

fn taken_apart(mut scene: Scene, list: &str) -> Scene {
    scene.take_apart(&named::list(list).unwrap(), &Names::default()).unwrap();
    scene
}

/// A ball of cloudy glass that glows, painted under a polish, and a box of mist, on a floor under a lamp and a sky.
fn still_life(color: ColorMode) -> World {
    let mut world = World::seen(Vec3::new(0.0, 2.0, 6.0), Vec3::new(0.0, 0.3, 0.0));
    world.color = color;
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.4, 0.4, -0.4, 0.4]));
    (world.camera.width, world.camera.height) = (12, 12);
    world.camera.exposure = 1.7;
    let glowing = Homogeneous { emission: Some(grey(0.3)), ..medium([0.3, 0.2, 0.1], [8.0, 9.0, 11.0], 0.4) };
    world.sphere(Vec3::new(-1.0, 0.0, 0.0), 0.9, glass(1.4, 0.0), Some(glowing));
    let mist = medium([0.1, 0.0, 0.0], [1.0, 2.0, 3.0], 0.0);
    world.cuboid(Vec3::new(0.3, -0.9, -0.8), Vec3::new(1.9, 0.7, 0.8), Material::Null, Some(mist));
    let polished = Material::Plastic {
        eta: 1.5,
        internal: tyndall::bsdf::internal_reflectance(1.5),
        reflectance: 0.5.into(),
        nonlinear: false,
        tint: 1.0.into(),
        sides: Sides::Both,
    };
    world.cuboid(Vec3::new(-9.0, -1.2, -9.0), Vec3::new(9.0, -1.0, 9.0), polished, None);
    world.shining_disk(3.0, 0.7, diffuse(0.0), 4.0);
    world.sky(0.4);
    world
}

fn picture(scene: &Scene, deep: Deep, spp: u32) -> Film {
    let settings = Settings { spp, seed: 3, ..Settings::default() };
    let rendering = render(scene, &VolPath { deep, ..VolPath::default() }, &settings, &());
    assert_eq!(rendering.tally.bad_samples, 0);
    rendering.film
}

#[test]
fn light_has_the_same_bits_with_and_without_layers_of_it() {
    for color in [ColorMode::Rgb, ColorMode::Spectral] {
        let whole = still_life(color).scene();
        let apart = taken_apart(still_life(color).scene(), "orders:8,direct,indirect,volume");
        for deep in [Deep::Traced, Deep::Alone, Deep::Together] {
            assert_eq!(picture(&apart, deep, 8).pixels, picture(&whole, deep, 8).pixels, "{color:?} {deep:?}");
        }
        assert_eq!(picture(&apart, Deep::Alone, 8), picture(&apart, Deep::Together, 8));
    }
}

/// In the sums nothing is lost: 144 pixels of a few dozen samples, to 2⁻⁴⁰ of what is added. In the file a mean is
/// rounded to single precision; where no part is negative, as in rgb mode, the sum is off by one unit in the last place at
/// most. Each layer has light somewhere.
#[test]
fn layers_of_a_partition_add_up_to_the_image() {
    for (color, partition) in PARTITIONS.iter().flat_map(|p| [(ColorMode::Rgb, p), (ColorMode::Spectral, p)]) {
        let film = picture(&taken_apart(still_life(color).scene(), partition), Deep::Together, 20);
        for layer in &film.layers {
            assert!(layer.cells.iter().any(|cell| cell.sum[1] > 0.0), "{:?}", layer.kind.channels);
        }
        for (i, pixel) in film.pixels.iter().enumerate() {
            for c in 0..3 {
                let parts = film.layers.iter().map(|layer| layer.cells[i].sum[c]);
                let (sum, size) = parts.fold((0.0, 0.0), |(sum, size), v| (sum + v, size + f64::abs(v)));
                assert!((sum - pixel.sum[c]).abs() <= size * 2f64.powi(-40), "{partition} {color:?}");
                if color == ColorMode::Rgb {
                    let mean = |layer: &Layer| f64::from(layer.cells[i].value(Average::Samples, pixel.count)[c]);
                    let sum = film.layers.iter().map(mean).sum::<f64>() as f32;
                    let apart = sum.to_bits().abs_diff(pixel.mean()[c].to_bits());
                    assert!(apart <= 1, "{partition}: {sum} and {}", pixel.mean()[c]);
                }
            }
        }
    }
}

/// What each layer of the one pixel is: mean and standard error of its green.
fn measured(scene: &Scene, spp: u32) -> Vec<(f64, f64)> {
    let settings = Settings { spp, seed: 5, sampler: SamplerKind::Independent, ..Settings::default() };
    let film = render(scene, &VolPath::default(), &settings, &()).film;
    let count = film.pixels[0].count;
    let of = |layer: &Layer| {
        let cell = &layer.cells[0];
        (cell.sum[1] / count as f64, f64::from(cell.standard_error(count)[1]))
    };
    film.layers.iter().map(of).collect()
}

/// What a path finds before and at its first scattering is what one finds that ends there: by a limit on the depth. (The
/// mean over the picture; pixels are independent.)
#[test]
fn emission_and_direct_light_are_what_a_depth_limit_leaves() {
    let settings = |seed| Settings { spp: 400, seed, sampler: SamplerKind::Independent, ..Settings::default() };
    let mean = |cells: Vec<(f64, f64)>| {
        let n = f64::from(settings(0).spp);
        let pixels = cells.len() as f64;
        let mean = cells.iter().map(|(sum, _)| sum / n).sum::<f64>() / pixels;
        let variance = cells.iter().map(|(sum, squares)| (squares / n - (sum / n).powi(2)) / (n - 1.0)).sum::<f64>();
        (mean, variance / pixels.powi(2))
    };
    let scene = taken_apart(still_life(ColorMode::Rgb).scene(), "emission,x=C.?[LOB]");
    let film = render(&scene, &VolPath::default(), &settings(5), &()).film;
    for (depth, layer) in (0..).zip(&film.layers) {
        let (a, va) = mean(layer.cells.iter().map(|cell| (cell.sum[1], cell.sum_of_squares[1])).collect());
        let limited = VolPath { max_depth: Some(depth), ..VolPath::default() };
        let film = render(&still_life(ColorMode::Rgb).scene(), &limited, &settings(6 + u64::from(depth)), &()).film;
        let (b, vb) = mean(film.pixels.iter().map(|pixel| (pixel.sum[1], pixel.sum_of_squares[1])).collect());
        let z = (a - b) / (va + vb).sqrt();
        assert!(z.abs() < 4.0 && b > 0.0 && vb.sqrt() < 0.02 * b, "depth {depth}: {a} and {b}, z = {z}");
    }
}

/// Down into an isotropic half-space of albedo ϖ under a sky of radiance 1, once scattered light has the radiance
/// `ϖ/2 ∫ exp(−τ) E₂(τ) dτ = ϖ/2 (1 − ln 2)`, and nothing is seen through it. All of what is scattered once is direct.
#[test]
fn once_scattered_light_under_a_sky_has_its_closed_form() {
    let mut world = World::seen(Vec3::Y, Vec3::ZERO);
    world.slab(200.0, Material::Null, medium([0.2; 3], [0.8; 3], 0.0));
    world.sky(1.0);
    let scene = taken_apart(world.scene(), "single,direct,unscattered");
    let [single, direct, through] = measured(&scene, 400_000)[..] else { panic!() };
    let expected = 0.4 * (1.0 - 2f64.ln());
    assert!((single.0 - expected).abs() < 4.5 * single.1 && single.1 < 4e-3 * expected, "{single:?} {expected}");
    assert_eq!((direct, through.0), (single, 0.0));
}

/// An integrator that does not know what its paths went through must not claim that a layer is dark.
#[test]
fn who_cannot_take_light_apart_records_no_layers_of_it() {
    let scene = taken_apart(still_life(ColorMode::Rgb).scene(), "direct");
    let film = render(&scene, &Analog, &Settings { spp: 1, ..Settings::default() }, &()).film;
    assert!(Analog.apart().is_none() && film.layers.is_empty());
}

/// Names and kinds of scattering, where each is the only way that light can come: through glass, off the paint beneath a
/// polish, off the polish, out of a medium with a name and out of one without.
#[test]
fn expressions_select_light_by_kind_of_scattering_and_by_name() {
    let mut scene = still_life(ColorMode::Rgb).scene();
    let names = |list: &[&str]| list.iter().map(|name| vec![(*name).to_owned()]).collect();
    let names = Names {
        objects: names(&["ball", "box", "floor", "lamp"]),
        media: names(&["glowing", "mist"]),
        lights: names(&["lamp", "sky"]),
    };
    let list = "all,ball=C'ball'.*[LOB],milk=C.*V'glowing'.*[LOB],mist=C.*V'mist'.*[LOB],clear=C[^V'glowing' V'mist']*[LOB],\
                both=C.*(V'glowing'.*V'mist'|V'mist'.*V'glowing').*[LOB],glass=C<.S'ball'>.*[LOB],sharp=CS.*[LOB],\
                diffuse=CD.*[LOB],floor=C'floor'.*[LOB],polish=C<RS'floor'>.*[LOB],paint=C<RD'floor'>.*[LOB],\
                glossy=C.*G.*[LOB],lamp=C.*L'lamp',background=C.*B,glow=C.*O'glowing',glows=C.*O";
    scene.take_apart(&named::list(list).unwrap(), &names).unwrap();
    let film = picture(&scene, Deep::Together, 20);
    for i in 0..film.pixels.len() {
        let of = |name: &str| {
            let layer = film.layers.iter().find(|layer| layer.kind.channels[0] == format!("{name}.R"));
            layer.unwrap().cells[i].sum[1]
        };
        let alike = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * of("all"), "{a} {b}");
        // What has been in neither medium, in one and not the other, in both.
        alike(of("clear") + of("milk") + of("mist") - of("both"), of("all"));
        // Nothing but the ball and the polish is sharp, nothing but the paint diffuse (of what scatters first), nothing glossy.
        alike(of("glass"), of("ball"));
        alike(of("sharp"), of("ball") + of("polish"));
        alike(of("diffuse"), of("paint"));
        alike(of("floor"), of("paint") + of("polish"));
        alike(of("glossy"), 0.0);
        alike(of("lamp") + of("background") + of("glows"), of("all"));
        alike(of("glow"), of("glows"));
    }
    assert!(film.layers.iter().all(|l| l.kind.channels[0] == "glossy.R" || l.cells.iter().any(|c| c.sum[1] > 0.0)));
}

/// Rows of numbers, after lines that begin with `#` and the names of the columns.
fn rows(table: &str) -> Vec<Vec<f64>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(|v| v.parse().unwrap_or(f64::NAN)).collect()).collect()
}

/// Light on a half-space that scatters alike in all directions, by the number of collisions: Chandrasekhar's table has the
/// first, the second, and all but the first. The half-space is a slab of 200 mean free paths, which lets e⁻²⁰⁰ through
/// unscattered and of what is scattered, at these albedos, less than 1e-19.
#[test]
fn single_double_and_multiple_scattering_are_those_of_a_half_space() {
    let table = rows(include_str!("../../tyndall-lab/data/chandrasekhar_brdf.csv"));
    let mut checked = 0;
    for row in &table {
        let [albedo, mu_i, mu_o, _, f1, f2, multiple] = row[..] else { panic!("{row:?}") };
        if ![0.5, 0.9].contains(&albedo) || ![0.3, 0.7].contains(&mu_i) || ![0.7, 1.0].contains(&mu_o) {
            continue;
        }
        let towards = |mu: f64| Vec3::new((1.0 - mu * mu).sqrt() as f32, mu as f32, 0.0);
        let mut world = World::seen(5.0 * towards(mu_o), Vec3::ZERO);
        world.slab(200.0, Material::Null, medium([1.0 - albedo as f32; 3], [albedo as f32; 3], 0.0));
        // 1/μ of light on a plane that faces it: f itself comes back.
        let sun = (1.0 / mu_i) as f32;
        world.lights.push(Light::Distant(Distant {
            towards: towards(mu_i),
            irradiance: Spectrum::illuminant_rgb([sun; 3]),
            luminance: sun,
        }));
        let found = measured(&taken_apart(world.scene(), "orders:2,direct,indirect"), 20_000);
        let expected = [0.0, f1, f2, multiple - f2, f1, multiple];
        for ((mean, error), expected) in found.into_iter().zip(expected) {
            assert!((mean - expected).abs() <= 4.5 * error + 1e-6 * expected, "{row:?}: {mean} ± {error}, {expected}");
            assert!(error <= 0.04 * expected, "{row:?}: too blunt, {error} of {expected}");
        }
        checked += 1;
    }
    assert!(checked >= 4, "{checked}");
}

/// A ball in a uniform sky, seen over a square that it just fills: of the disk, `1 − A(c)` of the sky is left for the albedo
/// `c`, and nothing changes beside it. Each order is a power of the albedo, so a render with one albedo tells, order by order,
/// what any other would leave: `Σ (c′/c)ⁿ Lₙ`.
#[test]
fn orders_of_one_ball_tell_what_balls_of_other_albedos_absorb() {
    const ORDERS: usize = 40;
    let disk = std::f64::consts::FRAC_PI_4;
    let table = rows(include_str!("../../tyndall-lab/data/sphere_escape_absorption.csv"));
    for radius in [1.0, 2.0] {
        let mut world = World::seen(Vec3::new(0.0, 0.0, 50.0), Vec3::ZERO);
        let r = radius as f32;
        world.camera.view.model = CameraModel::Orthographic(Orthographic { window: [-r, r, -r, r] });
        world.sphere(Vec3::ZERO, r, Material::Null, Some(medium([0.1; 3], [0.9; 3], 0.0)));
        world.sky(1.0);
        let found = measured(&taken_apart(world.scene(), &format!("orders:{ORDERS}")), 60_000);
        let mut checked = 0;
        for row in table.iter().filter(|row| row[0] == radius && row[1] <= 0.9) {
            let (ratio, absorbed) = (row[1] / 0.9, row[4]);
            let weighed = |pick: fn(&(f64, f64)) -> f64| -> f64 {
                found[..=ORDERS].iter().enumerate().map(|(n, layer)| ratio.powi(n as i32) * pick(layer)).sum()
            };
            // Of higher orders something between nothing and all.
            let rest = found[ORDERS + 1].0 * ratio.powi(ORDERS as i32 + 1);
            let (mean, error) = (weighed(|l| l.0) + rest / 2.0, weighed(|l| l.1));
            let expected = 1.0 - disk * absorbed;
            assert!(
                (mean - expected).abs() <= 4.5 * error + rest / 2.0,
                "radius {radius}, albedo {}: {mean} ± {error}, expected {expected}",
                row[1]
            );
            assert!(error + rest < 0.01, "too blunt: {error} {rest}");
            checked += 1;
        }
        assert!(checked >= 2, "radius {radius}: {checked} rows");
    }
}
