//! A mixture as a piece of a scene.

use std::{fmt::Write, path::Path};

use anyhow::bail;
use tyndall_formats::{film::save, write::Language};
use tyndall_optics::{medium::Medium, mixture::Mixture};

use super::{options::MixOptions, short};

/// Whether a name is one that media can have.
pub(crate) fn check(path: &Path) -> anyhow::Result<()> {
    match Language::of(path) {
        Some(_) => Ok(()),
        None => bail!("{}: media are written as .pbrt or .xml", path.display()),
    }
}

/// Writes it, with spectra per millimetre.
pub(crate) fn write(path: &Path, options: &MixOptions, mixture: &Mixture) -> anyhow::Result<()> {
    let medium = Medium::of(mixture);
    let text = match Language::of(path) {
        Some(Language::Pbrt) => pbrt(options, &medium),
        _ => mitsuba(options, &medium),
    };
    Ok(save::replace(path, text.as_bytes())?)
}

/// What it is, in lines.
fn comment(options: &MixOptions) -> [String; 3] {
    let parameters = options.recipe.parameters.iter().zip(&options.values);
    let numbers: Vec<_> = parameters.map(|(p, value)| format!("{} {}", p.name, short(*value))).collect();
    [
        format!("{}: {}. By tyndall mix.", options.recipe.about, numbers.join(", ")),
        format!("Source: {}.", options.recipe.source),
        "Per mm. One phase function for all wavelengths: sigma_s is such that (1-g) sigma_s is as computed.".into(),
    ]
}

fn pbrt(options: &MixOptions, medium: &Medium) -> String {
    let name = options.recipe.name;
    let mut out: String = comment(options).map(|line| format!("# {line}\n")).concat();
    out += "# Option \"string unit\" \"mm\" goes with it, or \"float scale\" 1000 in a scene of metres.\n";
    let _ = writeln!(out, "MakeNamedMedium \"{name}\" \"string type\" \"homogeneous\"");
    for (word, values) in [("sigma_a", &medium.sigma_a), ("sigma_s", &medium.sigma_s)] {
        let pairs: Vec<_> = medium.lambda.iter().zip(values).map(|(l, v)| format!("{l} {}", short(*v))).collect();
        let _ = writeln!(out, "  \"spectrum {word}\" [ {} ]", pairs.join("  "));
    }
    let _ = writeln!(out, "  \"float g\" {}", short(medium.g));
    out
}

fn mitsuba(options: &MixOptions, medium: &Medium) -> String {
    let name = options.recipe.name;
    let mut out = String::from("<scene version=\"3.0.0\">\n");
    for line in comment(options) {
        let _ = writeln!(out, "  <!-- {line} -->");
    }
    let _ = writeln!(out, "  <medium type=\"homogeneous\" id=\"{name}\">");
    let sums: Vec<f64> = medium.sigma_a.iter().zip(&medium.sigma_s).map(|(a, s)| a + s).collect();
    let albedo = medium.sigma_s.iter().zip(&sums).map(|(s, t)| if *t > 0.0 { s / t } else { 0.0 });
    for (word, values) in [("sigma_t", sums.clone()), ("albedo", albedo.collect())] {
        // An albedo near 1 wants its distance from 1.
        let pairs: Vec<_> = medium.lambda.iter().zip(&values).map(|(l, v)| format!("{l}:{v:.10}")).collect();
        let _ = writeln!(out, "    <spectrum name=\"{word}\" value=\"{}\"/>", pairs.join(", "));
    }
    if !medium.phase.is_empty() {
        let values: Vec<_> = medium.phase.iter().map(|v| short(*v)).collect();
        let values = values.join(" ");
        let _ = writeln!(out, "    <phase type=\"tabphase\"><string name=\"values\" value=\"{values}\"/></phase>");
    }
    out + "  </medium>\n</scene>\n"
}
