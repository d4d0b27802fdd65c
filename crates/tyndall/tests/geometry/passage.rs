//! One search for all open surfaces on a way finds what a search for each triangle finds.

use tyndall::math::{Ray, Transform, Vec3};
use tyndall::shape::{Geometry, GeometryBuilder, Hit, Mesh, Passed};

use super::{affine, agreement::soup, meshes::Random};

/// One after the other in the world; the last one by an instance.
fn placed(meshes: &[Mesh]) -> Geometry {
    let mut builder = GeometryBuilder::new();
    let (last, others) = meshes.split_last().unwrap();
    for mesh in others {
        builder.add_mesh(mesh.clone(), &Transform::IDENTITY, false).unwrap();
    }
    let group = builder.begin_group();
    builder.add_mesh(last.clone(), &Transform::IDENTITY, false).unwrap();
    builder.end_group();
    builder.add_instance(group, &affine([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.1, 0.2, 0.3])).unwrap();
    builder.build().unwrap()
}

/// The same with one triangle only.
fn with_one(meshes: &[Mesh], object: usize, prim: usize) -> Geometry {
    let only = |(i, mesh): (usize, &Mesh)| {
        let far = Mesh { positions: vec![Vec3::splat(1e6), Vec3::splat(2e6), Vec3::X * 1e6], ..Mesh::default() };
        if i == object {
            Mesh { indices: vec![mesh.indices[prim]], ..mesh.clone() }
        } else {
            Mesh { indices: vec![[0, 1, 2]], ..far }
        }
    };
    placed(&meshes.iter().enumerate().map(only).collect::<Vec<_>>())
}

#[test]
fn open_surfaces_on_a_way_are_those_that_each_triangle_says() {
    let random = &mut Random(5);
    // What blocks is the second.
    let (meshes, open) = ([soup(5, 3.0, random), soup(2, 2.0, random), soup(4, 3.0, random)], [true, false, true]);
    let all = placed(&meshes);
    let each: Vec<_> = meshes
        .iter()
        .enumerate()
        .flat_map(|(object, mesh)| (0..mesh.indices.len()).map(move |prim| (object, prim)))
        .map(|(object, prim)| (object, prim as u32, with_one(&meshes, object, prim)))
        .collect();
    let (mut free, mut blocked, mut several) = (0, 0, 0);
    for _ in 0..40_000 {
        let ray = Ray::new(random.in_ball(), random.dir());
        let t_max = if random.unit() < 0.5 { 1e4 } else { 3.0 * random.unit() };
        let hits =
            each.iter().filter_map(|(object, prim, one)| one.intersect(&ray, t_max).map(|hit| (hit.t, *object, *prim)));
        let (mut through, walls): (Vec<_>, Vec<_>) = hits.partition(|(_, object, _)| open[*object]);
        through.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let wall = walls.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let name = |hit: Hit| (hit.t, hit.object.0 as usize, hit.prim);

        let mut passed = Passed::default();
        assert_eq!(all.occluded_but(&ray, t_max, &open, &mut passed), wall.is_some());
        if wall.is_none() {
            assert_eq!(passed.in_order().unwrap().map(name).collect::<Vec<_>>(), through);
            free += 1;
        }
        several += u32::from(through.len() > 1);

        let mut passed = Passed::default();
        let found = all.intersect_but(&ray, t_max, &open, &mut passed).map(name);
        assert_eq!(found, wall);
        let before = |hit: &(f32, usize, u32)| wall.is_none_or(|wall| hit.0 < wall.0);
        let passed: Vec<_> = passed.in_order().unwrap().map(name).filter(before).collect();
        through.retain(before);
        assert_eq!(passed, through);
        blocked += u32::from(wall.is_some() && !passed.is_empty());
    }
    assert!(free > 1000 && blocked > 300 && several > 300, "{free} {blocked} {several}");
}

#[test]
fn more_open_surfaces_than_can_be_noted_are_told_of() {
    let sheet = |z: f32| {
        let positions = vec![Vec3::new(-9.0, -9.0, z), Vec3::new(9.0, -9.0, z), Vec3::new(0.0, 9.0, z)];
        Mesh { positions, indices: vec![[0, 1, 2]], ..Mesh::default() }
    };
    for (sheets, fit) in [(8, true), (9, true), (1024, true), (1025, false)] {
        let meshes: Vec<_> = (0..sheets).map(|i| sheet(i as f32)).collect();
        let mut builder = GeometryBuilder::new();
        for mesh in meshes {
            builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
        }
        let geometry = builder.build().unwrap();
        let mut passed = Passed::default();
        assert!(!geometry.occluded_but(&Ray::new(-Vec3::Z, Vec3::Z), 1e4, &vec![true; sheets], &mut passed));
        assert_eq!(passed.in_order().map(Iterator::count), fit.then_some(sheets));
    }
}
