//! `tyndall materials`: everything that has a name, with its colour.
//!
//! The colour of a medium is what its half-space under a smooth surface returns of white light that gets in from everywhere
//! (`tyndall_optics::half_space`), from reduced scattering, as if it went in all directions alike. The colour of a metal is
//! what it reflects at right angles, `((n − 1)² + k²)/((n + 1)² + k²)`.

use std::{
    fmt::Write,
    fs,
    io::{IsTerminal, stdout},
    process::ExitCode,
};

use anyhow::{Context, anyhow};
use tyndall::spectrum::{Role, Sampled};
use tyndall_formats::film::{save, tone::Tone};
use tyndall_optics::{
    half_space::HalfSpace,
    measured::{self, Source},
    medium::wavelengths,
    recipe::RECIPES,
    spectra,
};

use crate::{args::MaterialsOptions, outputs::say};

/// A material with its colour, linear sRGB.
struct Material {
    name: String,
    rgb: [f32; 3],
    about: String,
}

/// Half-spaces by their index of refraction, which are a tenth of a second each.
#[derive(Default)]
struct HalfSpaces(Vec<(f64, HalfSpace)>);

impl HalfSpaces {
    /// What comes back out for these coefficients, if anything can be said.
    fn share(&mut self, eta: f64, sigma_a: f64, reduced: f64) -> f64 {
        if sigma_a + reduced <= 0.0 {
            return 0.0;
        }
        let known = self.0.iter().position(|(n, _)| *n == eta);
        let at = known.unwrap_or_else(|| {
            self.0.push((eta, HalfSpace::new(0.0, eta)));
            self.0.len() - 1
        });
        self.0[at].1.reflectance(reduced / (sigma_a + reduced))
    }
}

/// Prints the list, or writes its page.
pub(crate) fn run(options: &MaterialsOptions) -> anyhow::Result<ExitCode> {
    let mut half_spaces = HalfSpaces::default();
    let groups = [
        ("Recipes, for tyndall mix and as types of media", recipes(&mut half_spaces)?),
        ("Measured media of Jensen et al. 2001, as presets", presets(&mut half_spaces, Source::Jensen2001)),
        (
            "Measured media of Narasimhan et al. 2006, as presets; they can be diluted",
            presets(&mut half_spaces, Source::Narasimhan2006),
        ),
        ("Metals and other conductors, as \"metal-NAME-eta\" and \"metal-NAME-k\"", metals()?),
    ];
    match &options.page {
        Some(directory) => {
            fs::create_dir_all(directory).with_context(|| directory.display().to_string())?;
            let path = directory.join("index.html");
            save::replace(&path, page(&groups).as_bytes())?;
            say(&path.display().to_string())?;
        }
        None => say(list(&groups, stdout().is_terminal()).trim_end_matches('\n'))?,
    }
    Ok(ExitCode::SUCCESS)
}

fn recipes(half_spaces: &mut HalfSpaces) -> anyhow::Result<Vec<Material>> {
    let of = |recipe: &tyndall_optics::recipe::Recipe| {
        let mixture = recipe.mix(&recipe.defaults()).map_err(|told| anyhow!(told))?;
        let (lambda, values): (Vec<f32>, Vec<f32>) = wavelengths()
            .map(|wavelength| {
                let bulk = mixture.at(wavelength);
                let share = half_spaces.share(recipe.eta, bulk.sigma_a, bulk.sigma_s * (1.0 - bulk.g));
                ((wavelength * 1e9) as f32, share as f32)
            })
            .unzip();
        let rgb = Sampled::new(&lambda, &values, Role::Reflectance)?.rgb;
        Ok(Material { name: recipe.name.into(), rgb, about: format!("{} ({})", recipe.about, recipe.source) })
    };
    RECIPES.iter().map(of).collect()
}

fn presets(half_spaces: &mut HalfSpaces, source: Source) -> Vec<Material> {
    let of = |m: &measured::Measured| {
        let share = |c: usize| half_spaces.share(m.eta.into(), m.sigma_a[c].into(), m.sigma_s_reduced[c].into());
        let rgb = [0, 1, 2].map(share).map(|share| share as f32);
        let [a, s] = [m.sigma_a, m.sigma_s_reduced].map(|rgb| rgb.map(|v| v.to_string()).join(" "));
        Material { name: m.name.into(), rgb, about: format!("σ_a {a}, σ_s′ {s} per mm, n {}", m.eta) }
    };
    measured::all().iter().filter(|m| m.source == source).map(of).collect()
}

fn metals() -> anyhow::Result<Vec<Material>> {
    let of = |name: &str| {
        let table = |part: &str| {
            let table = spectra::named(&format!("metal-{name}-{part}"));
            let table = table.ok_or_else(|| anyhow!("there is no table of {name}"))?;
            Ok::<_, anyhow::Error>(Sampled::new(&table.lambda, &table.values, Role::Illuminant)?)
        };
        let [eta, k] = [table("eta")?, table("k")?];
        let (lambda, values): (Vec<f32>, Vec<f32>) = (360..=830)
            .map(|nanometres| {
                let l = nanometres as f32;
                let [n, k] = [eta.at(l), k.at(l)];
                (l, ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k))
            })
            .unzip();
        let rgb = Sampled::new(&lambda, &values, Role::Reflectance)?.rgb;
        let share = rgb.map(|v| format!("{v:.3}")).join(" ");
        Ok(Material { name: name.into(), rgb, about: format!("reflects {share} at right angles") })
    };
    spectra::metals().map(of).collect()
}

impl Material {
    fn bytes(&self) -> [u8; 3] {
        Tone::default().apply(self.rgb)
    }
}

fn list(groups: &[(&str, Vec<Material>)], colored: bool) -> String {
    let mut out = String::new();
    for (title, materials) in groups {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{title}");
        for material in materials {
            let [r, g, b] = material.bytes();
            let swatch = if colored { format!("\x1b[48;2;{r};{g};{b}m      \x1b[0m ") } else { String::new() };
            let _ = writeln!(out, "  {swatch}#{r:02x}{g:02x}{b:02x}  {:<28} {}", material.name, material.about);
        }
        out.push('\n');
    }
    out
}

fn page(groups: &[(&str, Vec<Material>)]) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let mut out = String::from(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Materials of tyndall</title>\n\
         <style>body{font:15px sans-serif;margin:2em;max-width:70em}td{padding:.2em .8em}.s{width:6em;height:2.2em;\
         border:1px solid #888}</style>\n<h1>Materials</h1>\n\
         <p>Media: what a half-space of them under a smooth surface returns of white light that gets in. Metals: what they\n\
         reflect at right angles.</p>\n",
    );
    for (title, materials) in groups {
        let _ = writeln!(out, "<h2>{}</h2>\n<table>", escaped(title));
        for material in materials {
            let [r, g, b] = material.bytes();
            let (name, about) = (escaped(&material.name), escaped(&material.about));
            let _ = writeln!(
                out,
                "<tr><td><div class=\"s\" style=\"background:rgb({r},{g},{b})\"></div><td>{name}<td>{about}"
            );
        }
        out += "</table>\n";
    }
    out
}
