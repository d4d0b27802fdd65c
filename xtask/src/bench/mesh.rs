//! A mesh of ten million triangles, read, built and asked whether it is closed, by `tyndall info`.
//!
//! A bumpy ball in circles of latitude, as binary PLY; it bounds a medium, so that its edges are looked at too. The file
//! (190 MB) is kept in `target/bench` and is in the system's cache when it is read.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use super::judge;
use crate::peers::statistics::median;
use crate::peers::tyndall::Tyndall;
use crate::shell::root;

/// Meridians; there are half as many steps from pole to pole.
const MERIDIANS: u32 = 3164;
const TARGET_SECONDS: f64 = 15.0;
const TARGET_GIBIBYTES: f64 = 4.0;

const SCENE: &str = "\
WorldBegin
LightSource \"infinite\"
MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"
MediumInterface \"fog\" \"\"
Material \"interface\"
Shape \"plymesh\" \"string filename\" \"mesh.ply\"
";

/// Measures and prints.
pub(super) fn run(tyndall: &Tyndall, times: u32) -> Result<()> {
    let directory = root().join("target/bench");
    let triangles = write_ball(&directory.join("mesh.ply"), MERIDIANS)?;
    let scene = directory.join("mesh.pbrt");
    std::fs::write(&scene, SCENE)?;
    let (mut seconds, mut gibibytes) = (Vec::new(), Vec::new());
    for _ in 0..times {
        let begun = Instant::now();
        let peak = peak_memory(Command::new(&tyndall.binary).arg("info").arg(&scene).stdout(Stdio::null()))?;
        seconds.push(begun.elapsed().as_secs_f64());
        gibibytes.push(peak / f64::from(1 << 30));
    }
    let (time, memory) = (median(&seconds), median(&gibibytes));
    judge(&format!("{triangles} triangles, median of {times}"), time, "s", time < TARGET_SECONDS, "< 15 s");
    judge("the most memory at once", memory, "GiB", memory < TARGET_GIBIBYTES, "< 4 GiB");
    Ok(())
}

/// Runs a program; its peak of resident memory [bytes], as Linux tells it while the program is there.
fn peak_memory(command: &mut Command) -> Result<f64> {
    let mut child = command.spawn().context("cannot start the program")?;
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0.0;
    let code = loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
        peak = kibibytes.map_or(peak, |kibibytes| 1024.0 * kibibytes);
        if let Some(code) = child.try_wait()? {
            break code;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    ensure!(code.success(), "the program failed: {code}");
    Ok(peak)
}

/// Scenes of the peers whose body is a mesh instead, their names ending in [`MESHED`]: the scene, what stands for its body
/// there, and the name of the new one.
const BODIES: [[&str; 3]; 2] = [
    [
        "b_marble_cube_matched",
        r#"<shape type="cube"><transform name="to_world"><scale value="20"/></transform>"#,
        "b4_marble_mesh",
    ],
    ["c_milk_sphere", r#"<shape type="sphere"><float name="radius" value="20"/>"#, "c2_milk_mesh"],
];
/// How the names of scenes end that are made here.
pub(crate) const MESHED: &str = "_mesh";

/// The same body as 100,000 triangles.
const BODY: &str = r#"<shape type="ply"><string name="filename" value="body.ply"/><boolean name="face_normals" value="true"/>
  <transform name="to_world"><scale value="20"/></transform>"#;

/// Writes the scenes of [`BODIES`] and their body into `target/bench`.
pub(crate) fn write_bodies() -> Result<()> {
    let directory = root().join("target/bench");
    std::fs::create_dir_all(&directory)?;
    write_ball(&directory.join("body.ply"), 318)?;
    for [scene, body, meshed] in BODIES {
        let text = std::fs::read_to_string(crate::peers::scene_file(scene))?;
        ensure!(text.contains(body), "{scene} has another body");
        std::fs::write(directory.join(format!("{meshed}.xml")), text.replace(body, BODY))?;
    }
    Ok(())
}

/// Writes a ball, unless it is there; returns the number of its triangles.
fn write_ball(path: &Path, n: u32) -> Result<u32> {
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
        let (u, v) = (2.0 * std::f64::consts::PI * u, std::f64::consts::PI * v);
        let r = 1.0 + 0.05 * (40.0 * u).sin() * (37.0 * v).sin() + 0.01 * (300.0 * u).sin() * (280.0 * v).sin();
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
