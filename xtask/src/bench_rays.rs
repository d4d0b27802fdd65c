//! `cargo xtask bench rays`: our rays beside Embree's, on one thread.
//!
//! A bumpy ball of 101,568 triangles and 131,072 rays of each kind, seeded, 11 times over. The two engines take turns
//! of 256 rays; what is printed is the median rate and the median ratio of neighbouring turns, so that a busy machine
//! disturbs both alike. Embree is run with its robust flag. It is looked for in `target/venv` (`python3 -m venv
//! target/venv && target/venv/bin/pip install embreex`); without it, only our rates are printed.
//!
//! Then the same over a ball with 20,000 hairs, against Embree's round B-splines.

use std::{
    hint::black_box,
    path::{Path, PathBuf},
    process::Command,
    time::Instant,
};

use anyhow::{Result, ensure};
use glam::{DMat4, DVec3};
use tyndall::{
    math::{Ray, Transform, Vec3},
    shape::{Basis, Curves, Geometry, GeometryBuilder, Knot, Mesh, Sphere, Style},
};

use self::meshes::{Random, at_seam, displaced_sphere};
use crate::embree;

#[allow(dead_code, reason = "shared with the tests of the library, which need more kinds")]
#[path = "../../crates/tyndall/tests/geometry/meshes.rs"]
mod meshes;

const RAYS: usize = 131_072;
const ROUNDS: usize = 11;
/// Rays in a row by one engine before it is the other's turn: less than a slice of a busy machine's time.
const TURN: usize = 256;

struct Case {
    name: &'static str,
    rays: Vec<(Ray, f32)>,
}

/// Runs the comparison. A debug build starts itself anew as a release build.
pub(crate) fn run() -> Result<()> {
    if cfg!(debug_assertions) {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let status = Command::new(cargo)
            .args(["run", "--release", "--quiet", "--package", "xtask", "--", "bench", "rays"])
            .status()?;
        ensure!(status.success(), "the release build failed");
        return Ok(());
    }
    let mesh = displaced_sphere(92, 0.05);
    let start = Instant::now();
    let mut builder = GeometryBuilder::new();
    builder.add_mesh(mesh.clone(), &Transform::IDENTITY, false)?;
    let ours = builder.build()?;
    println!("{} triangles, built in {:.3} s", mesh.indices.len(), start.elapsed().as_secs_f64());
    let library = find_embree();
    let theirs = library.as_deref().map(|path| embree::Scene::new(path, &mesh)).transpose()?;
    if theirs.is_none() {
        println!("no Embree in target/venv: only our rays");
    }
    println!("{:<22} {:>10} {:>10} {:>7}", "[Mrays/s]", "tyndall", "Embree", "ratio");
    for case in cases(&mesh) {
        compare(&case, &ours, theirs.as_ref());
    }
    strands(library.as_deref())?;
    spheres()?;
    clearance(&ours);
    leaks(&mesh, &ours, theirs.as_ref());
    Ok(())
}

fn find_embree() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
    let python = std::fs::read_dir(root.join("target/venv/lib")).ok()?.next()?.ok()?.path();
    let libraries = std::fs::read_dir(python.join("site-packages/embreex.libs")).ok()?;
    libraries.flatten().map(|e| e.path()).find(|p| p.to_string_lossy().contains("libembree4"))
}

fn cases(mesh: &Mesh) -> Vec<Case> {
    let random = &mut Random(1);
    let mut case = |name, ray: &mut dyn FnMut(&mut Random) -> (Ray, f32)| Case {
        name,
        rays: (0..RAYS).map(|_| ray(random)).collect(),
    };
    let flight = |random: &mut Random, mean: f32| -mean * (1.0 - random.unit()).ln();
    vec![
        case("inside, unbounded", &mut |r| (Ray::new(r.in_ball() * 0.9, r.dir()), f32::INFINITY)),
        case("outside, incoherent", &mut |r| {
            let origin = r.dir() * 3.0;
            (Ray::new(origin, (r.in_ball() * 1.2 - origin).normalize()), f32::INFINITY)
        }),
        case("short flights", &mut |r| (Ray::new(r.in_ball() * 0.9, r.dir()), flight(r, 0.05))),
        case("just under the skin", &mut |r| {
            let [a, b, c] = mesh.triangle(r.below(mesh.indices.len()) as u32);
            (Ray::new((a + b + c) / 3.0 * 0.999, r.dir()), flight(r, 0.05))
        }),
    ]
}

/// Time per ray [s], and how many rays hit.
fn time(rays: &[(Ray, f32)], intersect: impl Fn(&Ray, f32) -> Option<f32>) -> (f64, usize) {
    let start = Instant::now();
    let hits = rays.iter().filter(|(ray, t_max)| black_box(intersect(ray, *t_max)).is_some()).count();
    (start.elapsed().as_secs_f64() / rays.len() as f64, hits)
}

fn compare(case: &Case, ours: &Geometry, theirs: Option<&embree::Scene>) {
    let (mut a, mut b, mut ratios, mut hits) = (Vec::new(), Vec::new(), Vec::new(), (0, 0));
    for rays in (0..ROUNDS).flat_map(|_| case.rays.chunks(TURN)) {
        let (seconds, found) = time(rays, |ray, t_max| ours.intersect(ray, t_max).map(|hit| hit.t));
        a.push(seconds);
        hits.0 += found;
        if let Some(theirs) = theirs {
            let (other, found) = time(rays, |ray, t_max| theirs.intersect(ray, t_max));
            b.push(other);
            ratios.push(other / seconds);
            hits.1 += found;
        }
    }
    let rate = |seconds: &[f64]| 1e-6 / median(seconds);
    if theirs.is_some() {
        let (ours, theirs, ratio) = (rate(&a), rate(&b), median(&ratios));
        let (our_hits, their_hits) = (hits.0 / ROUNDS, hits.1 / ROUNDS);
        println!("{:<22} {ours:>10.2} {theirs:>10.2} {ratio:>7.2}   hits {our_hits} {their_hits}", case.name);
    } else {
        println!("{:<22} {:>10.2}   hits {}", case.name, rate(&a), hits.0 / ROUNDS);
    }
}

/// Strands that stand on a ball of radius 1 and bend, seen from outside and met by light that is among them.
fn strands(library: Option<&Path>) -> Result<()> {
    const POINTS: usize = 8;
    let random = &mut Random(5);
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    let mut curves = Curves::new(Style::Round);
    for _ in 0..20_000 {
        let (mut p, mut dir) = (random.dir(), random.dir() * 0.5);
        dir += p;
        let knots: Vec<Knot> = (0..POINTS)
            .map(|i| {
                dir = (dir + random.in_ball() * 0.4).normalize();
                p += dir * 0.08;
                Knot { p, radius: 0.002 * (1.0 - 0.7 * i as f32 / POINTS as f32) }
            })
            .collect();
        segments.extend((0..POINTS - 3).map(|i| (points.len() + i) as u32));
        points.extend(knots.iter().map(|knot| knot.p.extend(knot.radius).to_array()));
        curves.push(Basis::CubicBSpline, &knots);
    }
    let start = Instant::now();
    let mut builder = GeometryBuilder::new();
    builder.add_curves(curves, &Transform::IDENTITY)?;
    let ours = builder.build()?;
    println!("{} segments of hair, built in {:.3} s", segments.len(), start.elapsed().as_secs_f64());
    let theirs = library.map(|path| embree::Scene::of_strands(path, &points, &segments)).transpose()?;
    let mut case = |name, ray: &mut dyn FnMut(&mut Random) -> Ray| Case {
        name,
        rays: (0..RAYS).map(|_| (ray(random), f32::INFINITY)).collect(),
    };
    let cases = [
        case("hair, from outside", &mut |r| {
            let origin = r.dir() * 4.0;
            Ray::new(origin, (r.in_ball() * 1.4 - origin).normalize())
        }),
        case("hair, from within", &mut |r| Ray::new(r.dir() * (1.05 + 0.25 * r.unit()), r.dir())),
    ];
    for case in &cases {
        compare(case, &ours, theirs.as_ref());
    }
    Ok(())
}

/// Many small balls: direct, and as instances of one.
fn spheres() -> Result<()> {
    for (count, instanced) in [(2_000, false), (200_000, false), (200_000, true)] {
        let random = &mut Random(4);
        let radius = 0.7 / f64::from(count).cbrt();
        let mut builder = GeometryBuilder::new();
        let group = instanced.then(|| builder.begin_group());
        if instanced {
            builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &Transform::IDENTITY, false)?;
            builder.end_group();
        }
        for _ in 0..count {
            let centre = random.in_ball();
            match group {
                None => {
                    builder.add_sphere(Sphere::new(centre, radius as f32), &Transform::IDENTITY, false)?;
                }
                Some(group) => {
                    let matrix = DMat4::from_translation(centre.as_dvec3()) * DMat4::from_scale(DVec3::splat(radius));
                    builder.add_instance(group, &Transform::new(matrix).unwrap_or_default())?;
                }
            }
        }
        let geometry = builder.build()?;
        let rays: Vec<Ray> = (0..RAYS).map(|_| Ray::new(random.in_ball(), random.dir())).collect();
        let mut seconds = Vec::new();
        for rays in rays.chunks(TURN) {
            let start = Instant::now();
            black_box(rays.iter().filter(|ray| geometry.intersect(ray, f32::INFINITY).is_some()).count());
            seconds.push(start.elapsed().as_secs_f64() / TURN as f64);
        }
        let name = if instanced { "spheres, instanced" } else { "spheres" };
        println!("{name:<22} {:>10.2}   {count}", 1e-6 / median(&seconds));
    }
    Ok(())
}

fn clearance(ours: &Geometry) {
    let random = &mut Random(2);
    for (name, within) in [("clearance, anywhere", 0.0), ("clearance, at skin", 0.95)] {
        let mut points = Vec::new();
        while points.len() < RAYS {
            let p = random.in_ball();
            if p.length() >= within {
                points.push(p);
            }
        }
        for cap in [0.02, 0.1] {
            let mut seconds = Vec::new();
            for _ in 0..5 {
                let start = Instant::now();
                black_box(points.iter().map(|&p| ours.clearance(p, cap)).sum::<f32>());
                seconds.push(start.elapsed().as_secs_f64());
            }
            println!("{name:<22} {:>10.2}   cap {cap}", points.len() as f64 / median(&seconds) * 1e-6);
        }
    }
}

fn leaks(mesh: &Mesh, ours: &Geometry, theirs: Option<&embree::Scene>) {
    for (name, edge) in [("vertices", false), ("edges", true)] {
        let random = &mut Random(3);
        let (mut our_leaks, mut their_leaks) = (0, 0);
        for _ in 0..RAYS {
            let origin: Vec3 = random.in_ball() * 0.8;
            let ray = at_seam(mesh, origin, edge, random);
            our_leaks += usize::from(ours.intersect(&ray, f32::INFINITY).is_none());
            their_leaks += theirs.map_or(0, |e| usize::from(e.intersect(&ray, f32::INFINITY).is_none()));
        }
        println!("leaks at {name:<13} {our_leaks:>10} {their_leaks:>10}");
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
