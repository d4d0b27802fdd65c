//! Error times time of 10,000 emissive triangles beside that of ten, in one room.
//!
//! Two questions. *Divided*: ten lamps, each as one triangle and as 1,024: the picture is the same, so all that the finer
//! lamps cost is the choice among them. *Scattered*: ten triangles anywhere in the room, and 10,000 of a thousandth of the
//! light each: the pictures differ, so the error is relative to their mean.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;

use super::judge;
use crate::peers::directory;
use crate::peers::runs::{Runs, Side, Turn};
use crate::peers::tyndall::Tyndall;

const SPP: u32 = 16;
const TARGET: f64 = 2.0;
/// Triangles a side of a divided lamp.
const FINENESS: u32 = 32;

type Point = [f64; 3];

/// A lamp: corners and radiance.
struct Lamp {
    corners: [Point; 3],
    radiance: f64,
}

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, turns: u32) -> Result<()> {
    let few = lamps(10, 0.3, 40.0);
    let divided: Vec<Lamp> = few.iter().flat_map(divide).collect();
    let pairs = [("divided", few, divided), ("scattered", lamps(10, 0.1, 360.0), lamps(10_000, 0.01, 36.0))];
    for (name, ten, many) in pairs {
        let scenes = [write(&format!("{name}_10"), &ten)?, write(&format!("{name}_10000"), &many)?];
        let mut runs: [Vec<Runs>; 2] = [Vec::new(), Vec::new()];
        for turn in Turn::all(turns, 2) {
            for (scene, runs) in scenes.iter().zip(&mut runs) {
                runs.push(tyndall.render(scene, SPP, turn, &scene.with_extension(""), &[])?);
            }
        }
        let [ten, many] = [Side::of(&runs[0], SPP), Side::of(&runs[1], SPP)];
        for (count, side) in [("10", &ten), ("10,000", &many)] {
            let seconds = side.cpu_seconds.iter().sum::<f64>() / side.cpu_seconds.len() as f64;
            let error = side.mse / (side.mean * side.mean);
            println!("{name}, {count}: relative MSE {error:.3e}, {seconds:.2} CPU s, mean {:.4}", side.mean);
        }
        let ratio = ten.efficiency_over(&many) * (ten.mean / many.mean).powi(2);
        judge(&format!("{name}: error × time of 10,000 over 10"), ratio, "×", ratio <= TARGET, "≤ 2×");
    }
    Ok(())
}

/// Lamps anywhere in the upper part of the room, turned anyhow, of equal power, from a fixed stream of numbers.
fn lamps(count: u32, size: f64, radiance: f64) -> Vec<Lamp> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    let mut lamp = |_| {
        let at = [1.6 * next() - 0.8, 1.6 * next() - 0.8, 1.2 + 0.6 * next()];
        let mut offset = || [next() - 0.5, next() - 0.5, next() - 0.5].map(|v| 2.0 * size * v);
        let [b, c] = [offset(), offset()].map(|d| [at[0] + d[0], at[1] + d[1], at[2] + d[2]]);
        Lamp { corners: [at, b, c], radiance }
    };
    (0..count).map(&mut lamp).collect()
}

/// The same lamp in `FINENESS²` parts.
fn divide(lamp: &Lamp) -> Vec<Lamp> {
    let [a, b, c] = lamp.corners;
    let at = |i: u32, j: u32| {
        let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(FINENESS));
        std::array::from_fn(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
    };
    let mut parts = Vec::new();
    for i in 0..FINENESS {
        for j in 0..FINENESS - i {
            parts.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 1 < FINENESS {
                parts.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    parts.into_iter().map(|corners| Lamp { corners, radiance: lamp.radiance }).collect()
}

/// The room with its lamps as a pbrt scene, one mesh, the lamps shining to both sides.
fn write(name: &str, lamps: &[Lamp]) -> Result<PathBuf> {
    let mut points = String::new();
    for corner in lamps.iter().flat_map(|lamp| lamp.corners) {
        let _ = write!(points, "{} {} {}  ", corner[0] as f32, corner[1] as f32, corner[2] as f32);
    }
    let indices = (0..3 * lamps.len()).map(|i| i.to_string()).collect::<Vec<_>>().join(" ");
    let radiance = lamps[0].radiance;
    let text = format!(
        r#"LookAt 0 -0.95 1  0 0 0.9  0 0 1
Camera "perspective" "float fov" 75
Film "rgb" "integer xresolution" 96 "integer yresolution" 96
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0  -1 -1 2  1 -1 2  1 1 2  -1 1 2 ]
  "integer indices" [ 0 1 2 0 2 3  4 6 5 4 7 6  0 5 1 0 4 5  1 6 2 1 5 6  2 7 3 2 6 7  3 4 0 3 7 4 ]
Shape "sphere" "float radius" 0.4
AreaLightSource "diffuse" "rgb L" [ {radiance} {radiance} {radiance} ] "bool twosided" true
Shape "trianglemesh" "integer indices" [ {indices}] "point3 P" [ {points}]
"#
    );
    let scene = directory("lights")?.join(name).with_extension("pbrt");
    std::fs::write(&scene, text)?;
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area([a, b, c]: [Point; 3]) -> f64 {
        let [e, f] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
        0.5 * n.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn a_divided_lamp_has_the_area_of_the_lamp() {
        let lamp = &lamps(3, 0.3, 1.0)[2];
        let parts = divide(lamp);
        assert_eq!(parts.len(), 1024);
        let sum: f64 = parts.iter().map(|part| area(part.corners)).sum();
        assert!((sum / area(lamp.corners) - 1.0).abs() < 1e-12);
    }
}
