//! Bent pieces of strands against their parts.

use super::*;

fn wave(i: u32) -> f64 {
    (f64::from(i) * 12.9898).sin() * 43_758.545_3 % 1.0
}

fn wave_3(i: u32) -> DVec3 {
    DVec3::new(wave(i), wave(i + 1), wave(i + 2))
}

/// A tube of radius about 1 that bulges at most as much as a cone may.
fn bent(i: u32) -> Bezier {
    let length = 2.0 + 60.0 * wave(i).abs();
    let bulge = STRAIGHT * wave(i + 1).abs().sqrt() / 0.75;
    let side = [DVec3::Y, DVec3::new(0.0, wave(i + 2), wave(i + 3)).normalize()];
    let bend = [1.0, wave(i + 4)];
    let knot =
        |k: usize, off: DVec3| (DVec3::X * (length * k as f64 / 3.0) + off).extend(1.0 - 0.1 * wave(i + 5) * k as f64);
    let [b, c] = [0, 1].map(|k| side[k] * (bulge * bend[k]));
    // Second differences of the control points: those of b and c.
    let inner = [(b * 2.0 + c) / -3.0, (b + c * 2.0) / -3.0];
    Bezier([knot(0, DVec3::ZERO), knot(1, inner[0]), knot(2, inner[1]), knot(3, DVec3::ZERO)])
}

/// A piece that counts as a cone is met where its 64 parts are, also by rays along it that graze its hollow side: of those
/// one in ten thousand is not.
#[test]
fn a_bent_piece_is_entered_where_its_parts_are() {
    const RAYS: u32 = 100_000;
    let (mut met, mut lost) = (0, 0);
    for i in 0..RAYS {
        let bezier = bent(31 * i);
        assert!(bezier.is_cone([0.0, 1.0]));
        // Through two places near the surface, or near that.
        let [a, b] = [17, 41].map(|k| {
            let p = bezier.at(wave(i * 97 + k).abs()).p;
            let off = (DVec3::Y + 0.7 * wave_3(i * 89 + k)).normalize();
            p.truncate() + off * (p.w * (0.9 + 0.2 * wave(i * 83 + k).abs()))
        });
        let dir = ((b - a).normalize() + wave_3(i * 79) * wave(i * 73).powi(2)).normalize();
        let line = Line::of(&Ray::new((a - dir * 100.0).as_vec3(), dir.as_vec3()));
        let seen = line.see(&bezier);
        let enter = |part| seen.enter_cone(part).map(|[distance, _]| distance);
        let whole = enter([0.0, 1.0]);
        let part = |k: u32| [f64::from(k) / 64.0, f64::from(k + 1) / 64.0];
        let parts = (0..64).filter_map(|k| enter(part(k))).min_by(f64::total_cmp);
        lost += u32::from(whole.is_some() != parts.is_some());
        if let (Some(whole), Some(parts)) = (whole, parts) {
            met += 1;
            lost += u32::from((whole - parts).abs() > 1e-5);
        }
    }
    assert!(met > RAYS / 2, "{met}");
    assert!(lost <= RAYS / 10_000, "{lost} of {met}");
}
