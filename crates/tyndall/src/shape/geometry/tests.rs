//! Bundles of strands against single pieces, and instruction sets against each other.

use super::*;
use crate::math::Transform;
use crate::shape::{Basis, GeometryBuilder, Knot, Style};

fn wave(i: u32) -> f32 {
    (i as f32 * 12.9898).sin() * 43.5453 % 1.0
}

fn wave_3(i: u32) -> Vec3 {
    Vec3::new(wave(i), wave(i + 1), wave(i + 2))
}

/// Strands of every kind, strewn over a cube of side 2 and bent to and fro.
fn strands() -> Vec<Curves> {
    let kinds = [
        (Style::Round, Basis::CubicBSpline),
        (Style::Round, Basis::Linear),
        (Style::Round, Basis::CubicBezier),
        (Style::Flat, Basis::CatmullRom),
        (Style::Ribbon, Basis::CubicBSpline),
    ];
    let strand = |(kind, (style, basis)): (u32, (Style, Basis)), i: u32| {
        let seed = 1000 * kind + 50 * i;
        let knot = |k| Knot { p: wave_3(seed) + 0.3 * wave_3(seed + 3 * k), radius: 0.004 + 0.003 * wave(seed + k) };
        let mut curves = Curves::new(style);
        curves.push(basis, &(1..8).map(knot).collect::<Vec<_>>());
        if style == Style::Ribbon {
            curves.orient(&(0..=curves.len() as u32).map(|k| wave_3(seed + k)).collect::<Vec<_>>());
        }
        curves
    };
    (0..).zip(kinds).flat_map(|kind| (0..20).map(move |i| strand(kind, i))).collect()
}

fn ray(i: u32) -> Ray {
    Ray::new(wave_3(7 * i), wave_3(7 * i + 3).normalize())
}

/// Bundles leave out only pieces that the exact test of each piece would have refused: distances have the same bits, and
/// where no two pieces are met at once it is the same piece. In space of any size, from near and far, with directions of any
/// length, with and without an end; half of the rays graze a strand, 0.1 % of its radius below the surface.
#[test]
fn a_ray_finds_of_a_thousand_strands_what_it_finds_of_each_piece_alone() {
    let mut hits = [0; 3];
    for (case, scale) in [1e-6, 1.0, 1e6].into_iter().enumerate() {
        let place = Transform::new(glam::DMat4::from_scale(glam::DVec3::splat(scale))).unwrap();
        let mut builder = GeometryBuilder::new();
        for curves in strands() {
            builder.add_curves(curves, &place).unwrap();
        }
        let geometry = builder.build().unwrap();
        let pieces: Vec<_> = (0..)
            .zip(&*geometry.shapes)
            .filter_map(|(object, shape)| match shape {
                Shape::Curves(curves) => Some(curves.pieces().map(move |(piece, _)| (object, curves, piece))),
                _ => None,
            })
            .flatten()
            .collect();
        for i in 0..3000 {
            let Ray { mut origin, dir, .. } = ray(i);
            let (_, curves, piece) = &pieces[(37 * i) as usize % pieces.len()];
            if let Some([a, .., b]) = curves.beziers().nth(piece.segment as usize).filter(|_| i % 2 == 0) {
                let middle = a.lerp(b, 0.5) / scale;
                let side = (b - a).truncate().cross(dir.as_dvec3()).normalize();
                origin = (middle.truncate() + side * (0.999 * middle.w)).as_vec3() - dir * 0.7;
            }
            let far = if i % 5 == 0 { 300.0 } else { 0.0 };
            let longer = (6.0 * wave(i)).exp();
            let ray = Ray::new((origin - dir * far) * scale as f32, dir * longer);
            let t_max =
                if i % 3 == 0 { f32::INFINITY } else { (far + 1.5 * wave(i + 1).abs()) * scale as f32 / longer };
            let alone = pieces.iter().filter_map(|(object, curves, piece)| {
                let (t, uv) = curves.intersect(piece, &Line::of(&ray), t_max)?;
                Some(Hit { t, object: ObjectId(*object), prim: piece.segment, uv, instance: NONE })
            });
            let alone: Vec<_> = alone.collect();
            let nearest = alone.iter().map(|hit| hit.t).min_by(f32::total_cmp);
            let first: Vec<_> = alone.into_iter().filter(|hit| Some(hit.t) == nearest).collect();
            let found = geometry.intersect(&ray, t_max);
            assert!(found.is_none() == first.is_empty(), "{ray:?}: {found:?}, alone {first:?}");
            assert!(found.is_none_or(|found| first.contains(&found)), "{ray:?}: {found:?}, alone {first:?}");
            assert_eq!(geometry.occluded(&ray, t_max), !first.is_empty());
            hits[case] += usize::from(found.is_some());
        }
    }
    assert!(hits.iter().all(|&hits| hits > 300), "{hits:?}");
}

/// No fused operations and no approximate ones: SSE2, SSE4.2, AVX2 and AVX-512 agree bit by bit, whichever of
/// them the machine has.
#[test]
fn every_instruction_set_gives_the_same_hits() {
    let mut mesh = Mesh::default();
    for i in 0..3000 {
        let at = Vec3::new(wave(9 * i / 3), wave(9 * (i / 3) + 1), wave(9 * (i / 3) + 2));
        mesh.positions.push(at + 0.2 * Vec3::new(wave(9 * i + 3), wave(9 * i + 4), wave(9 * i + 5)));
    }
    mesh.indices = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut builder = GeometryBuilder::new();
    builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
    for curves in strands() {
        builder.add_curves(curves, &Transform::IDENTITY).unwrap();
    }
    let best = builder.build().unwrap();
    let lesser = [
        Level::baseline(),
        Level::new().as_sse4_2().map_or(Level::baseline(), Simd::level),
        Level::new().as_avx2().map_or(Level::baseline(), Simd::level),
    ];
    let mut hits = 0;
    for level in lesser {
        let geometry = Geometry { level, ..best.clone() };
        for i in 0..10_000 {
            let (ray, origin) = (ray(i), ray(i).origin);
            let (a, b) = (best.intersect(&ray, 1.5), geometry.intersect(&ray, 1.5));
            assert_eq!(a, b);
            assert_eq!(best.clearance(origin, 1.0).to_bits(), geometry.clearance(origin, 1.0).to_bits());
            hits += u32::from(a.is_some());
        }
    }
    assert!(hits > 10_000, "{hits}");
}
