//! Makes the files of `scenes/milk`: the three surfaces of a glass of milk, and the light of a window.
//!
//! ```text
//! cargo run -p tyndall-formats --example make_milk -- scenes/milk
//! ```
//!
//! The surfaces are lathed about the y axis, lengths in millimetres. Each parts two substances, and its normals point
//! out of what `dielectric` calls the inside: glass | air, milk | glass, milk | air. They meet in one circle, whose
//! vertices all three share bit for bit, so nothing leaks where the milk ends at the wall. The surface of the milk
//! climbs the wall by capillarity, `y = y₀ + h · exp(−(R − r)/a)`, with `a` = 2.2 mm, the capillary length of milk.
//!
//! The light is an equal-area octahedral map (Clarberg 2008), as pbrt-v4 reads it.

use std::{f64::consts::PI, fs::File, io::BufWriter, path::Path};

use exr::prelude::{SpecificChannels, WritableImage, f16};
use glam::{DVec2, DVec3, Vec3};
use tyndall_formats::mesh::{TriangleMesh, write_ply};

/// Points around the axis.
const AROUND: usize = 128;
/// Steps of a rounded corner.
const STEPS: usize = 8;
/// Where milk, glass and air meet: radius and height [mm].
const CONTACT: DVec2 = DVec2::new(31.15, 83.0);
/// How far the milk climbs, and how fast it falls off from the wall [mm].
const MENISCUS: [f64; 2] = [1.5, 2.2];
/// Edge of the light map [pixels].
const SIDE: usize = 256;

/// A point of a profile (radius, height) [mm] and its normal.
type ProfilePoint = (DVec2, DVec2);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dir = std::env::args().nth(1).ok_or("name the directory to write to")?;
    let dir = Path::new(&dir);
    let corner = |r: f64, y: f64, rounding: f64| (DVec2::new(r, y), rounding);
    let contact = (CONTACT, 0.0);
    // From the axis along the bottom, up the wall, over the rim, down to the milk.
    let glass =
        [corner(0.0, 0.2, 0.0), corner(29.0, 0.2, 3.0), corner(34.0, 105.0, 0.89), corner(32.2, 105.0, 0.89), contact];
    let wall = [corner(0.0, 8.0, 0.0), corner(27.57, 8.0, 7.0), contact];
    for (name, profile) in [("glass", rounded(&glass)), ("wall", rounded(&wall)), ("surface", meniscus())] {
        write_ply(&lathe(&profile), &mut BufWriter::new(File::create(dir.join(name).with_extension("ply"))?))?;
    }
    let pixel = |at: exr::math::Vec2<usize>| {
        let [r, g, b] = radiance(direction(at.x(), at.y())).map(|v| f16::from_f32(v as f32));
        (r, g, b)
    };
    exr::prelude::Image::from_encoded_channels(
        (SIDE, SIDE),
        exr::prelude::Encoding::SMALL_LOSSLESS,
        SpecificChannels::rgb(pixel),
    )
    .write()
    .to_file(dir.join("window.exr"))?;
    Ok(())
}

/// A polygon whose corners are rounded by arcs, each point with its exact normal, to the right of the way.
fn rounded(corners: &[(DVec2, f64)]) -> Vec<ProfilePoint> {
    let right = |way: DVec2| DVec2::new(way.y, -way.x);
    let last = corners.len() - 1;
    let way = |from: DVec2, to: DVec2| (to - from).normalize();
    let mut profile = vec![(corners[0].0, right(way(corners[0].0, corners[1].0)))];
    for neighbours in corners.windows(3) {
        let &[(from, _), (corner, radius), (to, _)] = neighbours else { continue };
        let (before, after) = (right(way(from, corner)), right(way(corner, to)));
        let turn = before.angle_to(after);
        let start = corner - way(from, corner) * radius * (turn.abs() / 2.0).tan();
        let centre = start - before * radius * turn.signum();
        for step in 0..=STEPS {
            let normal = DVec2::from_angle(turn * step as f64 / STEPS as f64).rotate(before);
            profile.push((centre + normal * radius * turn.signum(), normal));
        }
    }
    profile.push((corners[last].0, right(way(corners[last - 1].0, corners[last].0))));
    profile
}

/// The milk's free surface, from the wall to the axis.
fn meniscus() -> Vec<ProfilePoint> {
    let [height, length] = MENISCUS;
    let point = |depth: f64| {
        let climb = height * (-depth / length).exp();
        let normal = DVec2::new(-climb / length, 1.0).normalize();
        (CONTACT + DVec2::new(-depth, climb - height), normal)
    };
    let mut profile: Vec<_> = [0.0, 0.25, 0.5, 0.8, 1.2, 1.7, 2.3, 3.0, 4.0, 5.5, 8.0, 12.0, 20.0].map(point).into();
    profile.push((DVec2::new(0.0, CONTACT.y - height), DVec2::Y));
    profile
}

/// The surface that a profile sweeps about the y axis; vertices run anticlockwise seen from where the normals point.
fn lathe(profile: &[ProfilePoint]) -> TriangleMesh {
    let around = |p: DVec2, j: usize| {
        let angle = 2.0 * PI * j as f64 / AROUND as f64;
        DVec3::new(p.x * angle.cos(), p.y, p.x * angle.sin()).as_vec3()
    };
    let each = |f: fn(&ProfilePoint) -> DVec2| -> Vec<Vec3> {
        profile.iter().flat_map(|p| (0..AROUND).map(move |j| around(f(p), j))).collect()
    };
    let mut indices = Vec::new();
    for i in 0..profile.len() - 1 {
        for j in 0..AROUND {
            let [a, c] = [j, (j + 1) % AROUND].map(|j| (i * AROUND + j) as u32);
            let [b, d] = [a, c].map(|v| v + AROUND as u32);
            if profile[i].0.x > 0.0 {
                indices.push([a, b, c]);
            }
            if profile[i + 1].0.x > 0.0 {
                indices.push([b, d, c]);
            }
        }
    }
    TriangleMesh { positions: each(|p| p.0), indices, normals: Some(each(|p| p.1)), ..TriangleMesh::default() }
}

/// The direction in the world (y up) of the middle of a pixel; the map's own space has z up.
fn direction(column: usize, row: usize) -> DVec3 {
    let [u, v] = [column, row].map(|i| 2.0 * (i as f64 + 0.5) / SIDE as f64 - 1.0);
    let height = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - height.abs();
    let phi = if r == 0.0 { PI / 4.0 } else { ((v.abs() - u.abs()) / r + 1.0) * PI / 4.0 };
    let z = (1.0 - r * r).copysign(height);
    let flat = r * (2.0 - r * r).sqrt();
    let (x, y) = ((phi.cos() * flat).copysign(u), (phi.sin() * flat).copysign(v));
    DVec3::new(x, z, -y)
}

/// A pale room with daylight from one side: linear-sRGB radiance out of a direction. Soft, because light in milk finds
/// its way out by chance: the brighter and smaller a light is, the longer the picture takes.
fn radiance(d: DVec3) -> [f64; 3] {
    let mix = |a: DVec3, b: DVec3, t: f64| a + (b - a) * t;
    let ramp = |from: f64, to: f64, x: f64| {
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    // Cool walls that get lighter upwards, over a warm floor.
    let walls = mix(DVec3::new(0.17, 0.20, 0.24), DVec3::new(0.36, 0.42, 0.50), ramp(-0.1, 0.9, d.y));
    let room = mix(DVec3::new(0.10, 0.08, 0.06), walls, ramp(-0.6, -0.25, d.y));
    // Curtains that glow, and the gap between them: azimuth and elevation from its middle [degrees].
    let (sin, cos) = WINDOW[0].to_radians().sin_cos();
    let towards = DVec3::new(sin * 0.85, 0.52, -cos * 0.85).normalize();
    let curtains = DVec3::new(1.55, 1.42, 1.22) * ramp(0.3, 1.0, d.dot(towards));
    let azimuth = (d.x * cos + d.z * sin).atan2(d.x * sin - d.z * cos).to_degrees();
    let pane = |x: f64, half: f64| ramp(half, half - 3.0, x.abs()) * ramp(0.6, 1.8, x.abs());
    let gap = DVec3::new(3.0, 2.8, 2.5) * pane(azimuth, 16.0) * pane(d.y.asin().to_degrees() - WINDOW[1], 27.0);
    (room + curtains + gap).to_array()
}

/// Azimuth of the window's middle, from −z towards +x, and its elevation [degrees].
const WINDOW: [f64; 2] = [80.0, 34.0];
