//! A mesh of ten million triangles, read, built and asked whether it is closed, by `tyndall info`.
//!
//! A bumpy ball in circles of latitude, as binary PLY; it bounds a medium, so that its edges are looked at too. The file
//! (190 MB) is kept in `target/bench` and is in the system's cache when it is read.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use super::judge;
use crate::peers::bodies::write_ball;
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
