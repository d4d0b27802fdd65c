//! Grains and the medium that stands for them: light is kept, bits are, and paths go on where they should.

mod common;

use common::{World, assert_mean, diffuse, glass, grey, measure, medium};
use tyndall::{
    granular::Granular,
    integrator::{Deep, VolPath},
    material::Material,
    math::Vec3,
    medium::Homogeneous,
    render::{Rendering, Settings, render},
    scene::Scene,
};

fn mark(world: &mut World, granular: Granular) {
    world.objects.last_mut().unwrap().granular = Some(granular);
}

/// 64 balls on a lattice; the middle is between them.
fn grains(world: &mut World, material: &Material, inside: Option<&Homogeneous>) {
    for i in 0..64 {
        let place = Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32) - 1.5;
        world.sphere(place, 0.45, material.clone(), inside.cloned());
        mark(world, Granular::Grain);
    }
}

/// What stands for them.
fn proxy(world: &mut World, medium: &Homogeneous) {
    world.cuboid(Vec3::splat(-2.0), Vec3::splat(2.0), Material::Null, Some(medium.clone()));
    mark(world, Granular::Proxy);
}

fn heap(eye: Vec3, material: &Material) -> World {
    let mut world = World::seen(eye, Vec3::new(0.3, 0.2, 0.1));
    grains(&mut world, material, None);
    world
}

fn clear() -> Homogeneous {
    medium([0.0; 3], [2.0, 3.0, 5.0], 0.5)
}

fn after(grains: u32) -> VolPath {
    VolPath { explicit_grains: Some(grains), ..VolPath::default() }
}

fn picture(scene: &Scene, integrator: &VolPath) -> Rendering {
    render(scene, integrator, &Settings { spp: 400, seed: 2, ..Settings::default() }, &())
}

/// Everything is 1 in a furnace. The last grain of a path is where light is sampled in one geometry and met in another, if
/// anything is wrong there.
#[test]
fn in_a_furnace_no_light_is_lost_between_grains_and_proxy() {
    let outside = Vec3::new(5.0, 7.0, 9.0);
    for (name, material) in [("glass", glass(1.5, 0.0)), ("white", diffuse(1.0))] {
        let mut world = heap(outside, &material);
        proxy(&mut world, &clear());
        world.sky(1.0);
        let scene = world.scene();
        for count in [0, 1, 3] {
            let found = measure(&scene, &after(count), 40_000);
            assert_mean(&format!("{name} after {count}"), &found, [1.0; 3], 0.01);
        }
    }
}

/// Of a sky that is dark below: a grain that hides it from the next one hides nothing from what is in the proxy. One white
/// grain far from the others, over an empty proxy, is lit by all of the sky above it.
#[test]
fn after_the_last_explicit_grain_no_grain_hides_the_sky() {
    let mut world = World::seen(Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO);
    for place in [Vec3::ZERO, Vec3::new(0.0, 2.0, 2.0)] {
        world.sphere(place, 0.9, diffuse(0.5), None);
        mark(&mut world, Granular::Grain);
    }
    proxy(&mut world, &medium([1e-9; 3], [0.0; 3], 0.0));
    world.half_sky(1.0, 0.0);
    let scene = world.scene();
    // A vertical face sees half of its hemisphere's cosine above the horizon: 0.5 · 0.5.
    assert_mean("after one", &measure(&scene, &after(1), 40_000), [0.25; 3], 0.01);
    let explicit = measure(&scene, &VolPath::default(), 40_000);
    assert!(explicit.mean[0] < 0.245, "{explicit:?}: the grain above hides some of it, and gives back half");
}

/// Without explicit grains the medium is all there is, for a camera in the middle of it too.
#[test]
fn without_explicit_grains_there_is_the_medium_and_nothing_else() {
    for eye in [Vec3::new(5.0, 7.0, 9.0), Vec3::splat(0.01)] {
        let mut world = heap(eye, &glass(1.5, 0.0));
        proxy(&mut world, &clear());
        world.half_sky(1.0, 0.2);
        let mut alone = World::seen(eye, Vec3::new(0.3, 0.2, 0.1));
        alone.cuboid(Vec3::splat(-2.0), Vec3::splat(2.0), Material::Null, Some(clear()));
        alone.half_sky(1.0, 0.2);
        let found = picture(&world.scene(), &after(0));
        assert_eq!(found.film, picture(&alone.scene(), &VolPath::default()).film);
        assert!(found.tally.collisions > 0);
    }
}

/// A proxy that no path goes on in has not touched a bit of the picture.
#[test]
fn explicit_grains_without_end_have_the_bits_of_a_scene_without_a_proxy() {
    let lit = |with_proxy: bool| {
        let mut world = heap(Vec3::new(5.0, 7.0, 9.0), &glass(1.5, 0.0));
        if with_proxy {
            proxy(&mut world, &clear());
        }
        world.half_sky(1.0, 0.2);
        world.scene()
    };
    let (with, without) = (lit(true), lit(false));
    let expected = picture(&without, &VolPath::default());
    for settings in [VolPath::default(), after(u32::MAX)] {
        let found = picture(&with, &settings);
        assert_eq!(found.film, expected.film);
        assert_eq!(found.tally.rays, expected.tally.rays);
    }
    assert_ne!(picture(&with, &after(2)).film, expected.film);
}

#[test]
fn many_paths_among_grains_have_the_bits_of_one_after_the_other() {
    let mut world = heap(Vec3::new(5.0, 7.0, 9.0), &diffuse(0.9));
    proxy(&mut world, &clear());
    world.half_sky(1.0, 0.2);
    let scene = world.scene();
    let [alone, together] = [Deep::Alone, Deep::Together].map(|deep| picture(&scene, &VolPath { deep, ..after(1) }));
    assert_eq!(alone.film, together.film);
    assert!(alone.tally.collisions > 0);
}

/// A ball that absorbs, of index 1, around an empty one of half its radius: straight through both light keeps exp(−1), and is
/// then in a medium that shines with 1. If the core were a grain by itself, only half of the way would absorb.
#[test]
fn a_grain_in_a_grain_is_part_of_it() {
    let mut world = World::seen(Vec3::Z * 9.0, Vec3::ZERO);
    world.sphere(Vec3::ZERO, 1.0, glass(1.0, 0.0), Some(medium([1.0; 3], [0.0; 3], 0.0)));
    mark(&mut world, Granular::Grain);
    world.sphere(Vec3::ZERO, 0.5, glass(1.0, 0.0), None);
    let shell = world.objects[0].interface.unwrap();
    world.objects[1].interface = Some(tyndall::medium::MediumInterface { inside: None, outside: shell.inside });
    mark(&mut world, Granular::Grain);
    proxy(&mut world, &Homogeneous { emission: Some(grey(1.0)), ..medium([1e4; 3], [0.0; 3], 0.0) });
    let found = measure(&world.scene(), &after(1), 10_000);
    assert_mean("through both", &found, [(-1f64).exp(); 3], 0.02);
}
