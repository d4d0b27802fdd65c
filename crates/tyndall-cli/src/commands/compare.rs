//! `tyndall compare A B`.

use std::{fmt::Write, path::Path, process::ExitCode};

use anyhow::{bail, ensure};
use serde::Serialize;
use tyndall_formats::film::{Image, exr, png};

use crate::{
    args::CompareOptions,
    false_color,
    outputs::write_text,
    statistics::{MeanColor, Measures, Test, mean_color, measures, z_test},
};

/// Exit status of `--check` when the images differ.
const DIFFERENT: u8 = 1;

/// Everything that was found out.
#[derive(Debug, Serialize)]
struct Comparison {
    a: MeanColor,
    b: MeanColor,
    measures: Measures,
    test: Option<Test>,
    verdict: Verdict,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Verdict {
    /// Noise explains the difference.
    Agree,
    /// Noise does not explain it.
    Differ,
    /// Equal in every pixel.
    Identical,
    /// Without standard errors nobody can tell.
    Untested,
}

/// Compares, reports, and with `--check` judges.
pub(crate) fn run(options: &CompareOptions) -> anyhow::Result<ExitCode> {
    let (a, b) = (exr::read(&options.a)?, exr::read(&options.b)?);
    require_same_crop(options, &a, &b)?;
    if !options.reference {
        require_errors(options, &a, &b)?;
    }
    let comparison = compare(&a, &b, options);
    match &options.json {
        Some(to) if to == Path::new("-") => write_text(to, &serde_json::to_string_pretty(&comparison)?)?,
        Some(to) => {
            write_text(to, &serde_json::to_string_pretty(&comparison)?)?;
            write_text("-".as_ref(), &report(&comparison, options))?;
        }
        None => write_text("-".as_ref(), &report(&comparison, options))?,
    }
    if let Some(path) = &options.diff {
        write_difference(path, &a, &b)?;
    }
    if options.check && comparison.verdict == Verdict::Untested {
        bail!("there are no standard errors to check against: render with at least 2 samples a pixel");
    }
    let failed = options.check && comparison.verdict == Verdict::Differ;
    Ok(if failed { ExitCode::from(DIFFERENT) } else { ExitCode::SUCCESS })
}

fn compare(a: &Image, b: &Image, options: &CompareOptions) -> Comparison {
    let test = z_test(a, b, options.tiles);
    let verdict = match &test {
        _ if a.mean == b.mean => Verdict::Identical,
        Some(test) if test.p < options.significance => Verdict::Differ,
        Some(_) => Verdict::Agree,
        None => Verdict::Untested,
    };
    Comparison { a: mean_color(a), b: mean_color(b), measures: measures(a, b), test, verdict }
}

fn require_same_crop(options: &CompareOptions, a: &Image, b: &Image) -> anyhow::Result<()> {
    let size = |image: &Image| {
        let c = image.crop;
        format!("{}x{}, pixels {},{} to {},{}", image.width, image.height, c.min.0, c.min.1, c.max.0, c.max.1)
    };
    ensure!(
        (a.width, a.height, a.crop) == (b.width, b.height, b.crop),
        "the images are not of the same size and crop:\n  {}: {}\n  {}: {}",
        options.a.display(),
        size(a),
        options.b.display(),
        size(b),
    );
    Ok(())
}

fn require_errors(options: &CompareOptions, a: &Image, b: &Image) -> anyhow::Result<()> {
    for (path, image, other) in [(&options.a, a, b), (&options.b, b, a)] {
        ensure!(
            image.standard_error.is_some() || other.standard_error.is_none(),
            "{} tells no standard error (channels stderr.R, stderr.G, stderr.B); if it is to be taken as exact, say \
             --reference",
            path.display(),
        );
    }
    Ok(())
}

fn write_difference(path: &Path, a: &Image, b: &Image) -> anyhow::Result<()> {
    let (pixels, scale) = false_color::difference(a, b);
    let texts = [("tyndall.difference_in_full_color", scale.to_string())];
    png::write_rgb8(path, [a.crop.width(), a.crop.height()], &pixels, &texts)?;
    eprintln!("difference image: {} (blue −{scale:.3e} · white 0 · red +{scale:.3e}, luminance)", path.display());
    Ok(())
}

/// The comparison in words.
fn report(comparison: &Comparison, options: &CompareOptions) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = describe(&mut out, comparison, options);
    out.trim_end().to_owned()
}

fn describe(out: &mut String, comparison: &Comparison, options: &CompareOptions) -> std::fmt::Result {
    let Comparison { a, b, measures: m, test, verdict } = comparison;
    writeln!(out, "A  {}\n   mean {}", options.a.display(), with_errors(a))?;
    writeln!(out, "B  {}\n   mean {}", options.b.display(), with_errors(b))?;
    write!(out, "MSE     {:.4e}", m.mse)?;
    match m.mse_from_noise {
        Some(noise) if noise > 0.0 && noise.is_finite() => {
            writeln!(out, "   {:.2} × what the standard errors explain", m.mse / noise)?;
        }
        _ => writeln!(out)?,
    }
    writeln!(out, "MAE     {:.4e}\nrelMSE  {:.4e}\nPSNR    {:.2} dB", m.mae, m.relative_mse, m.psnr)?;
    let (x, y) = m.max_difference_pixel;
    writeln!(out, "max |Δ| {:.4e}   at pixel {x},{y}", m.max_difference)?;
    if let Some(t) = test {
        let (x, y) = t.max_z_pixel;
        let edge = options.tiles;
        writeln!(out, "z-test over {edge}×{edge} tiles, {} tests:", t.tests)?;
        writeln!(out, "  max |z| {:.2} in the tile at {x},{y}   p = {:.3e}", t.max_z, t.p_max_z)?;
        let [r, g, b] = t.chi_square_per_degree;
        writeln!(out, "  χ²/dof  {r:.3} {g:.3} {b:.3} (R, G, B)   p = {:.3e}", t.p_chi_square)?;
    }
    writeln!(out, "{}", verdict_in_words(*verdict, test.as_ref(), options.significance))
}

fn verdict_in_words(verdict: Verdict, test: Option<&Test>, significance: f64) -> String {
    let p = test.map_or(1.0, |t| t.p);
    match verdict {
        Verdict::Identical => "The images are identical.".into(),
        Verdict::Agree => format!("The images agree: noise explains their difference (p = {p:.3e})."),
        Verdict::Differ => {
            format!("The images DIFFER: noise does not explain it (p = {p:.3e}, below {significance}).")
        }
        Verdict::Untested => "Whether noise explains the difference cannot be told without standard errors.".into(),
    }
}

fn with_errors(mean: &MeanColor) -> String {
    let channel = |c: usize| match mean.standard_error {
        Some(se) => format!("{:.6} ± {:.6}", mean.rgb[c], se[c]),
        None => format!("{:.6}", mean.rgb[c]),
    };
    format!("R {}   G {}   B {}", channel(0), channel(1), channel(2))
}
