//! The form: a veiled head that looks down and aside, on a plinth. Lengths in millimetres, y up, the figure faces +z.
//!
//! The head has axes of its own, with its origin between the ears, and two equal halves. The veil is a sheet between two
//! offsets of one surface, carved open in front, with a rolled hem.

use glam::DVec3;

use super::nets::Planes;
use super::solids::{block, carve, ellipsoid, join, meet, rod, seam, string, turned};

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Where the head is [mm].
const HEAD: DVec3 = v(0.0, 112.0, 3.0);

/// Distance to the whole [mm].
pub(crate) fn distance(p: DVec3) -> f64 {
    let pose = turned(DVec3::Y, -14.0) * turned(DVec3::X, 7.0) * turned(DVec3::Z, 5.0);
    let head = head(pose.inverse() * (p - HEAD));
    let neck = rod(p, [v(0.0, 98.0, -6.0), v(0.0, 50.0, -6.0)], [11.5, 13.0]);
    let shoulders = ellipsoid(p, v(0.0, 30.0, -3.0), v(43.0, 25.0, 22.0));
    let body = join(join(head, neck, 7.0), shoulders, 16.0);
    let all = join(body, veil(p), 9.0);
    let plinth = block(p, v(0.0, 10.0, -3.0), v(48.0, 10.0, 32.0), 1.5);
    join(meet(all, 18.0 - p.y, 0.5), plinth, 1.0)
}

/// A sheet that falls from the crown over the shoulders in folds, open in front; solid where it has reached them.
fn veil(p: DVec3) -> f64 {
    let hood = ellipsoid(p, v(0.0, 109.0, -3.0), v(37.5, 41.0, 36.0));
    let skirt = ellipsoid(p, v(0.0, 30.0, -5.0), v(45.0, 66.0, 29.0));
    let around = p.x.atan2(-p.z - 6.0);
    let fall = ((146.0 - p.y) / 100.0).clamp(0.0, 1.0);
    let folds = fall * (1.6 * (10.0 * around + 0.025 * p.y).cos() + 1.6 * (5.0 * around + 0.8).cos());
    let form = join(hood, skirt, 22.0) + folds;
    let opening = ellipsoid(p, v(-2.0, 92.0, 44.0), v(30.0, 58.0, 55.0));
    let solid = (70.0 - p.y).max(0.8 * (p.y - 115.0)).max(0.0);
    let sheet = carve(form - 1.9, form + 1.9 + solid, 0.5);
    join(carve(sheet, opening, 1.5), seam(form, opening, 2.5), 2.0)
}

/// The head in its own axes: what is at x > 0 is at x < 0 too.
fn head(p: DVec3) -> f64 {
    // |x|, but with a round valley where the halves meet.
    let p = v((p.x * p.x + 0.25).sqrt(), p.y, p.z);
    let skull = ellipsoid(p, v(0.0, 9.0, -5.0), v(21.0, 25.0, 26.0));
    let face = ellipsoid(p, v(0.0, -8.0, 3.0), v(17.0, 29.0, 19.0));
    let mut d = join(skull, face, 10.0);
    d = join(d, rod(p, [v(11.5, -12.0, -1.0), v(3.0, -32.0, 11.0)], [5.0, 4.5]), 8.0);
    d = join(d, ellipsoid(p, v(9.5, -8.0, 12.5), v(6.5, 7.0, 6.0)), 6.0);
    d = join(d, ellipsoid(p, v(0.0, -33.0, 14.5), v(4.6, 4.2, 5.5)), 6.0);
    // Sockets, lids, and the line where they meet.
    d = carve(d, ellipsoid(p, v(8.5, 2.5, 24.5), v(6.8, 4.6, 6.0)), 4.0);
    d = join(d, ellipsoid(p, v(8.3, 1.6, 14.2), v(5.8, 3.7, 5.2)), 0.8);
    d = carve(
        d,
        string(p, &[v(2.6, 0.6, 20.0), v(6.0, -0.9, 20.2), v(10.0, -0.8, 19.4), v(14.0, 1.0, 16.5)], 0.6),
        1.2,
    );
    // Brows run into the nose.
    d = join(d, string(p, &[v(2.0, 4.5, 21.5), v(4.5, 8.0, 21.3), v(9.0, 9.6, 19.9), v(15.5, 6.5, 14.5)], 1.4), 3.0);
    d = join(d, rod(p, [v(0.0, 6.0, 21.0), v(0.0, -10.5, 27.2)], [1.9, 2.7]), 2.5);
    d = join(d, ellipsoid(p, v(2.9, -11.2, 23.6), v(2.3, 2.2, 3.0)), 1.8);
    // Mouth.
    d = carve(d, string(p, &[v(0.0, -14.5, 23.4), v(0.0, -16.6, 23.2)], 0.6), 1.5);
    d = join(d, string(p, &[v(1.2, -18.2, 21.6), v(3.0, -18.3, 21.0), v(6.2, -19.5, 18.4)], 1.25), 1.0);
    d = join(d, string(p, &[v(0.0, -21.6, 21.0), v(2.6, -21.4, 20.4), v(5.4, -20.3, 18.4)], 1.7), 1.0);
    d = carve(d, string(p, &[v(0.0, -19.9, 22.8), v(3.0, -20.0, 21.8), v(7.0, -20.3, 18.8)], 0.4), 0.5);
    // Hair, parted in the middle: strands run along the hairline.
    let behind = (v(0.0, 25.0, 11.0) - p).dot(v(-0.55, -0.42, 0.72).normalize());
    let hair = ellipsoid(p, v(0.0, 9.0, -6.0), v(23.4, 28.0, 28.0)) + 0.5 * (1.15 * behind).cos();
    join(d, meet(hair, -behind, 2.0), 1.0)
}

/// Planes of the grid: close together about the face, and nowhere so far apart that the veil fits between two.
pub(crate) fn planes() -> Planes {
    let axis = |low: f64, high: f64, fine: [f64; 2], steps: [f64; 2]| {
        let mut planes = vec![low];
        let mut at = low;
        while at < high {
            let away = (fine[0] - at).max(at - fine[1]).max(0.0);
            at += (steps[0] + away * 0.25).min(steps[1]);
            planes.push(at);
        }
        planes
    };
    [
        axis(-56.0, 56.0, [-11.0, 14.0], [1.1, 2.6]),
        axis(-4.0, 162.0, [88.0, 118.0], [1.1, 3.6]),
        axis(-46.0, 46.0, [19.0, 31.0], [1.1, 2.6]),
    ]
}
