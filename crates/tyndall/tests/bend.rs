//! Light samples through walls that bend light: the light that paths find by running into lamps, and furnaces.

mod common;

use common::{World, diffuse, grey, medium};
use tyndall::{
    camera::{CameraModel, Perspective},
    film::Layer,
    integrator::{Deep, Integrator, VolPath},
    light::{AreaLight, EmitterShape},
    lpe::{Names, named},
    material::{Index, Material, Roughness},
    math::{Transform, Vec3},
    medium::{MediumId, MediumInterface},
    render::{Rendering, Settings, render},
    sampling::SamplerKind,
    scene::{Lit, Scene},
    shape::{Mesh, Sphere},
    spectrum::ColorMode,
};

/// Glass at which light samples bend; or the same, but for six parts in a hundred million of its light, at which they do not.
fn wall(eta: f32, bends: bool) -> Material {
    Material::Dielectric {
        eta: Index::Constant(eta),
        alpha: Roughness::constant([0.0; 2]),
        reflection_tint: 1.0.into(),
        transmission_tint: if bends { 1.0 } else { 1f32.next_down() }.into(),
    }
}

fn view(world: &mut World) {
    world.camera.view.model = CameraModel::Perspective(Perspective::pinhole([-0.4, 0.4, -0.3, 0.3]));
    (world.camera.width, world.camera.height) = (24, 18);
}

/// A ball and a cube of coloured media side by side on a floor, the ball in thin fog, under a sky with a brighter half, a
/// disk and a small ball that shine.
fn still_life(color: ColorMode, bends: bool) -> Scene {
    let mut world = World::seen(Vec3::new(0.0, 1.0, 6.0), Vec3::new(0.0, 0.5, 0.0));
    world.color = color;
    view(&mut world);
    let fog = MediumId(0);
    world.cuboid(Vec3::new(-2.0, 0.0, -1.0), Vec3::new(-0.2, 2.0, 1.0), Material::Null, {
        Some(medium([0.02; 3], [0.1, 0.05, 0.2], 0.3))
    });
    world.media.push(medium([0.01, 0.05, 0.2], [10.0, 12.0, 14.0], 0.8));
    world.object(wall(1.3, bends), Some(MediumInterface { inside: Some(MediumId(1)), outside: Some(fog) }));
    world.builder.add_sphere(Sphere::new(Vec3::new(-1.1, 0.6, 0.0), 0.5), &Transform::IDENTITY, false).unwrap();
    let (low, high) = (Vec3::new(0.4, 0.05, -0.4), Vec3::new(1.2, 0.85, 0.4));
    world.cuboid(low, high, wall(1.5, bends), Some(medium([0.02, 0.0, 0.1], [3.0, 6.0, 12.0], 0.0)));
    world.cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, -0.01, 9.0), diffuse(0.5), None);
    world.shining_disk(2.5, 0.4, diffuse(0.0), 20.0);
    world.shining_sphere(Vec3::new(0.5, 0.5, 1.6), 0.12, diffuse(0.2), 20.0, false);
    world.half_sky(0.3, 0.1);
    world.scene()
}

fn picture(scene: &Scene, integrator: &dyn Integrator, spp: u32, seed: u64) -> Rendering {
    let settings = Settings { spp, seed, sampler: SamplerKind::Independent, ..Settings::default() };
    let rendering = render(scene, integrator, &settings, &());
    assert_eq!((rendering.tally.bad_samples, rendering.tally.leaks), (0, 0));
    rendering
}

/// Mean and standard error of all pixels of a channel.
fn mean(rendering: &Rendering, channel: usize) -> (f64, f64) {
    let n = rendering.film.pixels.len() as f64;
    let errors = rendering.film.pixels.iter().map(|p| f64::from(p.standard_error()[channel]).powi(2));
    let sum: f64 = rendering.film.pixels.iter().map(|p| f64::from(p.mean()[channel])).sum();
    (sum / n, errors.sum::<f64>().sqrt() / n)
}

/// |z| of both in all channels below 4.5 (a chance of 7e-6), with the error of the second at most `precision`.
#[track_caller]
fn assert_agree(what: &str, a: &Rendering, b: &Rendering, precision: f64) {
    for c in 0..3 {
        let ((a, ea), (b, eb)) = (mean(a, c), mean(b, c));
        let z = (a - b) / ea.hypot(eb);
        assert!(z.abs() < 4.5, "{what}, channel {c}: {a:.6} ± {ea:.6}, {b:.6} ± {eb:.6}: z = {z:.1}");
        assert!(eb < precision * b, "{what}, channel {c}: {eb:.6} of {b:.6}");
    }
}

#[test]
fn bent_light_samples_find_the_light_that_paths_find() {
    for color in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
        let [bent, straight] = [true, false].map(|bends| still_life(color, bends));
        assert_eq!([bent.lit(Some(MediumId(1))), straight.lit(Some(MediumId(1)))], [Lit::Bent, Lit::Never]);
        let [new, old] =
            [(&bent, 1), (&straight, 2)].map(|(scene, seed)| picture(scene, &VolPath::default(), 500, seed));
        assert_agree(&format!("{color:?}"), &new, &old, 0.008);
        let traced = VolPath { deep: Deep::Traced, ..VolPath::default() };
        assert_agree(&format!("{color:?}, traced"), &picture(&bent, &traced, 150, 3), &old, 0.008);
    }
}

/// A path counts a wall that its light sample bends at, so a limit on the depth cuts both ways to find a lamp alike. Of a thin ball:
/// in, one collision, and out are three.
#[test]
fn a_limit_on_the_depth_cuts_bent_light_samples_too() {
    for max_depth in [2, 3, 4] {
        let [new, old] = [(true, 100), (false, 1000)].map(|(bends, spp)| {
            let mut world = World::seen(Vec3::new(0.0, 2.0, 5.0), Vec3::ZERO);
            view(&mut world);
            world.sphere(Vec3::ZERO, 1.0, wall(1.3, bends), Some(medium([0.0; 3], [1.0, 1.5, 2.0], 0.5)));
            world.shining_disk(3.0, 3.0, diffuse(0.0), 1.0);
            let limited = VolPath { max_depth: Some(max_depth), ..VolPath::default() };
            picture(&world.scene(), &limited, spp, u64::from(bends))
        });
        // Of two, little is left: what the ball mirrors.
        assert_agree(&format!("{max_depth}"), &new, &old, if max_depth == 2 { 0.2 } else { 0.03 });
    }
}

/// Six walls around everything that shine inwards with radiance 1.
fn shining_room(world: &mut World, half: f32) {
    for ng in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
        let e1 = 2.0 * half * Vec3::new(ng.y.abs(), ng.z.abs(), ng.x.abs());
        let e2 = ng.cross(e1);
        let a = -half * ng - 0.5 * (e1 + e2);
        let mesh = Mesh {
            positions: vec![a, a + e1, a + e1 + e2, a + e2],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let shape = EmitterShape::Parallelogram { a, e1, e2, ng };
        let light =
            AreaLight { shape, radiance: grey(1.0), luminance: 1.0, two_sided: false, opacity: 1.0, pattern: None };
        world.shining_mesh(mesh, diffuse(0.0), light);
    }
}

/// A body that only scatters cannot be seen in front of the same light from everywhere, whether that is a room that shines or a
/// sky with a picture.
#[test]
fn bodies_vanish_in_a_furnace_whose_light_is_sampled_through_their_walls() {
    for is_ball in [true, false] {
        for is_sky in [true, false] {
            for (deep, spp) in [(Deep::Together, 250), (Deep::Traced, 60)] {
                let mut world = World::seen(Vec3::new(1.5, 1.0, 5.0), Vec3::ZERO);
                view(&mut world);
                if is_ball {
                    world.sphere(Vec3::ZERO, 1.0, wall(1.3, true), Some(medium([0.0; 3], [6.0, 8.0, 10.0], 0.8)));
                } else {
                    let corner = Vec3::new(0.8, 0.9, 1.0);
                    world.cuboid(-corner, corner, wall(1.5, true), Some(medium([0.0; 3], [4.0, 3.0, 2.0], 0.0)));
                }
                if is_sky {
                    world.half_sky(1.0, 1.0);
                } else {
                    shining_room(&mut world, 20.0);
                }
                let scene = world.scene();
                assert_eq!(scene.lit(Some(MediumId(0))), Lit::Bent);
                let seen = picture(&scene, &VolPath { deep, ..VolPath::default() }, spp, 5);
                for c in 0..3 {
                    let (mean, error) = mean(&seen, c);
                    let what = format!("ball {is_ball}, sky {is_sky}, {deep:?}, channel {c}: {mean:.5} ± {error:.5}");
                    assert!((mean - 1.0).abs() < 4.5 * error && error < 0.005, "{what}");
                }
            }
        }
    }
}

/// A bent light sample belongs to the layers that its path would belong to: by how often it was scattered, the wall included, and by
/// what it met last.
#[test]
fn bent_light_samples_are_taken_apart_as_paths_are() {
    let layers = |bends, spp| {
        let mut scene = still_life(ColorMode::Rgb, bends);
        scene.take_apart(&named::list("depths:4,through=C.*VTL").unwrap(), &Names::default()).unwrap();
        let rendering = picture(&scene, &VolPath::default(), spp, 11);
        let (n, count) = (rendering.film.pixels.len() as f64, rendering.film.pixels[0].count);
        let of = |layer: &Layer| {
            let errors = layer.cells.iter().map(|cell| f64::from(cell.standard_error(count)[1]).powi(2));
            let sum: f64 = layer.cells.iter().map(|cell| cell.sum[1]).sum();
            (sum / count as f64 / n, errors.sum::<f64>().sqrt() / n)
        };
        rendering.film.layers.iter().map(of).collect::<Vec<_>>()
    };
    for (number, (new, old)) in layers(true, 300).into_iter().zip(layers(false, 600)).enumerate() {
        let z = (new.0 - old.0) / new.1.hypot(old.1).max(1e-9);
        assert!(z.abs() < 4.5, "layer {number}: {new:?} and {old:?}, z = {z:.1}");
    }
    let through = layers(true, 300)[6];
    assert!(through.0 > 20.0 * through.1, "light that a wall lets out last: {through:?}");
}

/// Where a light sample would have to bend twice, or has nothing to look for, none is made.
#[test]
fn light_samples_bend_only_where_they_can_find_a_light() {
    let ball = |build: &dyn Fn(&mut World)| {
        let mut world = World::seen(Vec3::new(0.0, 2.0, 5.0), Vec3::ZERO);
        world.sphere(Vec3::ZERO, 1.0, wall(1.3, true), Some(medium([0.0; 3], [20.0; 3], 0.5)));
        build(&mut world);
        world.scene().lit(Some(MediumId(0)))
    };
    let lamp = |world: &mut World| world.shining_disk(4.0, 0.5, diffuse(0.0), 1.0);
    assert_eq!(ball(&lamp), Lit::Bent);
    assert_eq!(ball(&|world| world.half_sky(1.0, 0.0)), Lit::Bent);
    assert_eq!(ball(&|world| world.sky(1.0)), Lit::Never, "paths find an even sky as well");
    let in_glass = |world: &mut World| {
        lamp(world);
        world.sphere(Vec3::ZERO, 1.1, wall(1.5, true), None);
    };
    assert_eq!(ball(&in_glass), Lit::Never, "a shell of glass around the ball");
    let with_priority = |world: &mut World| {
        lamp(world);
        world.with_priority(0, 2);
    };
    assert_ne!(ball(&with_priority), Lit::Bent, "a body that others may overlap");
    assert_eq!(ball(&|world| world.shining_disk(0.5, 0.1, diffuse(0.0), 1.0)), Lit::Straight, "a lamp within");
}

/// Sum of the squared errors of all pixels, over that of the squared means.
fn noise(rendering: &Rendering) -> f64 {
    let pixels = rendering.film.pixels.iter();
    let [errors, means] = pixels.fold([0.0; 2], |[errors, means], p| {
        [errors + f64::from(p.standard_error()[1]).powi(2), means + f64::from(p.mean()[1]).powi(2)]
    });
    errors / means
}

/// What it is for: a lamp of 2 square degrees over a ball of milk, with a tenth of the variance.
#[test]
fn bent_light_samples_take_the_noise_of_a_small_lamp_away() {
    let [new, old] = [true, false].map(|bends| {
        let mut world = World::seen(Vec3::new(0.0, 2.0, 5.0), Vec3::ZERO);
        view(&mut world);
        world.sphere(Vec3::ZERO, 1.0, wall(1.3, bends), Some(medium([0.0; 3], [20.0; 3], 0.5)));
        world.shining_disk(4.0, 0.08, diffuse(0.0), 1000.0);
        noise(&picture(&world.scene(), &VolPath::default(), 200, 7))
    });
    assert!(new < 0.1 * old, "{new:.2e} and {old:.2e}");
}
