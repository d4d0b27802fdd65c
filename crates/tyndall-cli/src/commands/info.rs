//! `tyndall info SCENE`.

use std::{fmt::Write, io::IsTerminal, process::ExitCode};

use tyndall::{light::Light, math::Vec3};
use tyndall_formats::{
    desc::{LengthUnit, SceneDesc},
    error::Diagnostics,
    inspect,
    missing::Missing,
};

use crate::{
    args::InfoOptions,
    load::{Loaded, load_without},
    outputs::write_text,
};

/// Loads a scene and tells what is in it.
pub(crate) fn run(options: &InfoOptions) -> anyhow::Result<ExitCode> {
    let loaded = load_without(Missing::All, &options.input, None, None, None)?;
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = describe(&mut out, &loaded);
    write_text("-".as_ref(), out.trim_end())?;
    let warnings = Diagnostics::new(inspect::warnings(&loaded.desc, &loaded.scene), loaded.sources);
    if !warnings.errors.is_empty() {
        eprintln!("\n{}", warnings.render(std::io::stderr().is_terminal()));
    }
    Ok(ExitCode::SUCCESS)
}

fn describe(out: &mut String, loaded: &Loaded) -> std::fmt::Result {
    let Loaded { scene, desc, hash, load_seconds, build_seconds, .. } = loaded;
    let unit = unit(desc);
    writeln!(out, "hash       {hash}")?;
    writeln!(out, "image      {}x{}, {} spp", scene.camera.width, scene.camera.height, desc.sampler.spp.value)?;
    geometry(out, loaded)?;
    let bounds = scene.geometry.bounds();
    let extent = (bounds.max - bounds.min).max_element();
    writeln!(out, "bounds     {} to {} [{unit}]", point(bounds.min, extent), point(bounds.max, extent))?;
    writeln!(out, "materials  {}", scene.materials.len())?;
    lights(out, loaded)?;
    media(out, loaded, unit)?;
    if !desc.ignored.is_empty() {
        writeln!(out, "ignored    {} words that change nothing here:", desc.ignored.len())?;
        let mut reasons: Vec<&str> = desc.ignored.iter().map(|word| word.reason).collect();
        reasons.sort_unstable();
        reasons.dedup();
        reasons.iter().try_for_each(|reason| writeln!(out, "           {reason}"))?;
    }
    writeln!(out, "start      {:.1} ms to read, {:.1} ms to build", 1e3 * load_seconds, 1e3 * build_seconds)
}

fn geometry(out: &mut String, loaded: &Loaded) -> std::fmt::Result {
    let census = loaded.scene.geometry.census();
    let counts = [
        (census.triangles, "triangles"),
        (census.spheres, "spheres"),
        (census.disks, "disks"),
        (census.cylinders, "cylinders"),
        (census.patches, "patches"),
        (census.curves, "segments of strands"),
        (census.instances, "instances"),
    ];
    let present: Vec<String> = counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    let parts = if present.is_empty() { String::new() } else { format!(": {}", present.join(", ")) };
    writeln!(out, "objects    {}{parts}", loaded.scene.objects.len())?;
    writeln!(out, "memory     {:.1} MB of shapes and their trees", census.bytes as f64 / 1e6)
}

fn lights(out: &mut String, loaded: &Loaded) -> std::fmt::Result {
    let lights = &loaded.scene.lights.lights;
    let areas = lights.iter().filter(|light| matches!(light, Light::Area(_))).count();
    let environments = lights.iter().filter(|light| light.is_environment()).count();
    let others = lights.len() - areas - environments;
    writeln!(out, "lights     {areas} on surfaces, {environments} environments, {others} points and beams")
}

/// Coefficients as colours, and the lengths that tell what they look like.
fn media(out: &mut String, loaded: &Loaded, unit: &str) -> std::fmt::Result {
    writeln!(out, "media      {}", loaded.scene.media.len())?;
    for (medium, desc) in loaded.scene.media.iter().zip(&loaded.desc.media) {
        let (sigma_a, sigma_s, g) = (medium.sigma_a.rgb(), medium.sigma_s.rgb(), medium.phase.mean_cosine());
        let each = |f: &dyn Fn(usize) -> f32| [f(0), f(1), f(2)].map(|v| format!("{v:.4}")).join(" ");
        writeln!(out, "  {}", desc.name.as_deref().unwrap_or("(without a name)"))?;
        writeln!(out, "    sigma_a                  {} [1/{unit}]", each(&|c| sigma_a[c]))?;
        writeln!(out, "    sigma_s                  {} [1/{unit}]", each(&|c| sigma_s[c]))?;
        writeln!(out, "    albedo                   {}", each(&|c| sigma_s[c] / (sigma_a[c] + sigma_s[c])))?;
        writeln!(out, "    mean cosine g            {g:.4}")?;
        writeln!(out, "    mean free path           {} [{unit}]", each(&|c| 1.0 / (sigma_a[c] + sigma_s[c])))?;
        let transport = |c: usize| 1.0 / (sigma_a[c] + (1.0 - g) * sigma_s[c]);
        writeln!(out, "    transport mean free path {} [{unit}]", each(&transport))?;
    }
    Ok(())
}

fn unit(desc: &SceneDesc) -> &'static str {
    let wanted = desc.options.unit.value;
    LengthUnit::ALL.into_iter().find(|(_, unit)| *unit == wanted).map_or("unit", |(word, _)| word)
}

/// With four digits of the scene's extent: what is below is rounding.
fn point(p: Vec3, extent: f32) -> String {
    let digits = if extent > 0.0 { (4.0 - extent.log10().floor()).clamp(0.0, 20.0) as usize } else { 4 };
    let number = |v: f32| format!("{:.digits$}", if v.abs() < 1e-5 * extent { 0.0 } else { v });
    format!("({}, {}, {})", number(p.x), number(p.y), number(p.z))
}
