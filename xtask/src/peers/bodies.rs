//! What scenes of the peers hold and no one wants in a repository: balls of many triangles that stand for a body, and hair.

use std::f64::consts::PI;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Result, ensure};
use testkit::Stream;

use crate::shell::root;

/// Scenes of the peers whose body is a mesh instead: the scene, what stands for its body there, and the names of the new ones
/// with a rough and a smooth body.
const BODIES: [[&str; 4]; 2] = [
    [
        "b_marble_cube_matched",
        r#"<shape type="cube"><transform name="to_world"><scale value="20"/></transform>"#,
        "b4_marble_mesh",
        "b5_marble_smooth_mesh",
    ],
    [
        "c_milk_sphere",
        r#"<shape type="sphere"><float name="radius" value="20"/>"#,
        "c2_milk_mesh",
        "c3_milk_smooth_mesh",
    ],
];
/// How the names of scenes end that are made here.
pub(crate) const MESHED: &str = "_mesh";

/// Files of the bodies, of 100,000 triangles each.
const ROUGH: &str = "body.ply";
const SMOOTH: &str = "smooth_body.ply";
/// Meridians of both.
const MERIDIANS: u32 = 318;

/// A body from a file.
fn body(file: &str) -> String {
    format!(
        r#"<shape type="ply"><string name="filename" value="{file}"/><boolean name="face_normals" value="true"/>
  <transform name="to_world"><scale value="20"/></transform>"#
    )
}

/// The scene with hair, and the file of its strands.
pub(crate) const HAIR: &str = "e_hair";
const STRANDS: &str = "strands.txt";

/// Writes the scenes of [`BODIES`] and of [`HAIR`] with what they hold into `target/bench`.
pub(crate) fn write_bodies() -> Result<()> {
    let directory = root().join("target/bench");
    std::fs::create_dir_all(&directory)?;
    write_ball(&directory.join(ROUGH), MERIDIANS)?;
    write_uneven_ball(&directory.join(SMOOTH), MERIDIANS, lumps)?;
    write_lock(&directory.join(STRANDS), 2000)?;
    std::fs::copy(root().join("xtask/scenes").join(format!("{HAIR}.xml")), super::scene_file(HAIR))?;
    for [scene, replaced, rough, smooth] in BODIES {
        let text = std::fs::read_to_string(super::scene_file(scene))?;
        ensure!(text.contains(replaced), "{scene} has another body");
        for (meshed, file) in [(rough, ROUGH), (smooth, SMOOTH)] {
            std::fs::write(directory.join(format!("{meshed}.xml")), text.replace(replaced, &body(file)))?;
        }
    }
    Ok(())
}

/// Writes a lock of hair that hangs down, unless it is there: `x y z radius` a line, an empty line after each strand.
fn write_lock(path: &Path, strands: u32) -> Result<()> {
    const POINTS: u32 = 14;
    if path.exists() {
        return Ok(());
    }
    let mut out = BufWriter::new(File::create(path)?);
    let mut stream = Stream::new(0);
    let mut between = |low: f64, high: f64| low + (high - low) * stream.next_f64();
    for _ in 0..strands {
        let (away, turn) = (6.0 * between(0.0, 1.0).sqrt(), between(0.0, 2.0 * PI));
        let mut at = [away * turn.cos(), away * turn.sin()];
        for point in 0..POINTS {
            let down = f64::from(point) / f64::from(POINTS - 1);
            writeln!(out, "{:.5} {:.5} {:.5} {:.5}", at[0], 30.0 - 60.0 * down, at[1], 0.04 - 0.028 * down)?;
            at = at.map(|x| x + between(-0.4, 0.4));
        }
        writeln!(out)?;
    }
    Ok(out.flush()?)
}

/// Bumps of a twentieth of the radius, and on them others as small as the triangles are: as rough as a mesh can be.
fn bumps(u: f64, v: f64) -> f64 {
    1.0 + 0.05 * (40.0 * u).sin() * (37.0 * v).sin() + 0.01 * (300.0 * u).sin() * (280.0 * v).sin()
}

/// Lumps and hollows, as a potato has them.
fn lumps(u: f64, v: f64) -> f64 {
    let large = (3.0 * u).sin() * v.sin().powi(3) * (2.0 * v).cos();
    let small = (9.0 * u + 1.0).sin() * v.sin().powi(9) * (8.0 * v).sin();
    1.0 + 0.15 * large + 0.04 * small
}

/// Writes a rough ball.
pub(crate) fn write_ball(path: &Path, n: u32) -> Result<u32> {
    write_uneven_ball(path, n, bumps)
}

/// Writes a ball with so many meridians whose radius depends on longitude and colatitude [rad], unless it is there; returns the
/// number of its triangles.
fn write_uneven_ball(path: &Path, n: u32, radius: impl Fn(f64, f64) -> f64) -> Result<u32> {
    let rings = n / 2 - 1;
    let triangles = 2 * n * rings;
    if path.exists() {
        return Ok(triangles);
    }
    let mut out = BufWriter::new(File::create(path)?);
    let vertices = n * rings + 2;
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}")?;
    writeln!(out, "property float x\nproperty float y\nproperty float z\nelement face {triangles}")?;
    writeln!(out, "property list uchar int vertex_indices\nend_header")?;
    let mut point = |p: [f64; 3]| p.iter().try_for_each(|c| out.write_all(&(*c as f32).to_le_bytes()));
    point([0.0, 0.0, 1.0])?;
    for (ring, meridian) in (1..=rings).flat_map(|ring| (0..n).map(move |meridian| (ring, meridian))) {
        let (u, v) = (f64::from(meridian) / f64::from(n), f64::from(ring) / f64::from(rings + 1));
        let (u, v) = (2.0 * PI * u, PI * v);
        let r = radius(u, v);
        point([r * v.sin() * u.cos(), r * v.sin() * u.sin(), r * v.cos()])?;
    }
    point([0.0, 0.0, -1.0])?;
    let at = |ring: u32, meridian: u32| 1 + (ring - 1) * n + meridian % n;
    let mut face = |corners: [u32; 3]| {
        out.write_all(&[3])?;
        corners.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes()))
    };
    for m in 0..n {
        face([0, at(1, m), at(1, m + 1)])?;
        face([vertices - 1, at(rings, m + 1), at(rings, m)])?;
        for ring in 1..rings {
            face([at(ring, m), at(ring + 1, m), at(ring + 1, m + 1)])?;
            face([at(ring, m), at(ring + 1, m + 1), at(ring, m + 1)])?;
        }
    }
    out.flush()?;
    Ok(triangles)
}
