//! `tyndall verify`.

mod page;
mod plots;

use std::{fmt::Write, process::ExitCode, time::Instant};

use indicatif::{ProgressBar, ProgressStyle};
use tyndall_formats::film::save;
use tyndall_lab::verify::{Check, Effort, Experiment, FamilyJudgement, Judgement, ORACLES, Oracle, judge};

use crate::{args::VerifyOptions, outputs::write_text, threads::pool};
use page::Page;

/// Exit status where figures are not reproduced.
const NOT_REPRODUCED: u8 = 1;
/// Figures farther off than this many standard errors are shown.
const SHOWN: f64 = 3.0;

/// Measures the tables, tells what came of them, judges.
pub(crate) fn run(options: &VerifyOptions) -> anyhow::Result<ExitCode> {
    let oracles: Vec<&Oracle> = ORACLES.iter().filter(|oracle| oracle.name.contains(&options.filter)).collect();
    let names = || ORACLES.iter().map(|oracle| oracle.name).collect::<Vec<_>>().join(", ");
    anyhow::ensure!(!oracles.is_empty(), "no table is called \"{}\"; there are {}", options.filter, names());
    if options.list {
        write_text("-".as_ref(), list(&oracles).trim_end())?;
        return Ok(ExitCode::SUCCESS);
    }
    // What cannot be written had better be known before half an hour is spent.
    if let Some(to) = options.json.as_deref().filter(|to| *to != "-") {
        save::check(to)?;
    }
    let page = options.report.as_deref().map(Page::prepare).transpose()?;
    let start = Instant::now();
    let experiments = pool(options.threads)?.install(|| measure(&oracles, options))?;
    let judgement = judge(&experiments);
    let reproduced = judgement.p >= options.alpha;
    if options.json.as_deref() != Some("-".as_ref()) {
        write_text("-".as_ref(), told(&experiments, &judgement, options).trim_end())?;
    }
    if let Some(to) = &options.json {
        let figures: Vec<_> = figures(&experiments)
            .map(|(family, c)| serde_json::json!({ "family": family, "figure": c, "z": c.z(), "p": c.p() }))
            .collect();
        let report = serde_json::json!({ "reproduced": reproduced, "judgement": judgement, "figures": figures });
        write_text(to, &serde_json::to_string_pretty(&report)?)?;
    }
    if let Some(page) = page {
        page.write(&experiments, &judgement, options, start.elapsed())?;
    }
    Ok(if reproduced { ExitCode::SUCCESS } else { ExitCode::from(NOT_REPRODUCED) })
}

/// All figures, each with its table.
fn figures(experiments: &[Experiment]) -> impl Iterator<Item = (&'static str, &Check)> {
    experiments.iter().flat_map(|e| e.checks.iter().map(|check| (e.family, check)))
}

fn list(oracles: &[&Oracle]) -> String {
    let lines = oracles.iter().map(|o| format!("{:<16} {}\n{:<16} {}\n", o.name, o.about, "", o.source));
    lines.collect()
}

fn measure(oracles: &[&Oracle], options: &VerifyOptions) -> anyhow::Result<Vec<Experiment>> {
    let effort = Effort { seed: options.seed, ..if options.full { Effort::FULL } else { Effort::QUICK } };
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} tables, {elapsed}  {msg}")?;
    let progress = ProgressBar::new(oracles.len() as u64).with_style(style);
    let mut experiments = Vec::new();
    for oracle in oracles {
        let start = Instant::now();
        progress.set_message(oracle.name);
        progress.tick();
        let measured = oracle.measure(effort)?;
        let figures = measured.iter().map(|experiment| experiment.checks.len()).sum::<usize>();
        let line = format!("{:<16} {figures:>4} figures, {:.1} s", oracle.name, start.elapsed().as_secs_f64());
        if progress.is_hidden() {
            eprintln!("{line}");
        } else {
            progress.println(line);
        }
        experiments.extend(measured);
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(experiments)
}

/// The figures that are far off, a line for each table, the verdict.
fn told(experiments: &[Experiment], judgement: &Judgement, options: &VerifyOptions) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = tell(&mut out, experiments, judgement, options);
    out
}

fn tell(
    out: &mut String,
    experiments: &[Experiment],
    judgement: &Judgement,
    options: &VerifyOptions,
) -> std::fmt::Result {
    let is_shown = |c: &Check| options.all || c.z().abs() > SHOWN || c.z().is_nan();
    let shown: Vec<_> = figures(experiments).filter(|(_, c)| is_shown(c)).collect();
    if !shown.is_empty() {
        writeln!(out, "{:<16} {:>12} {:>12} {:>10} {:>6}", "table", "expected", "measured", "± s.e.", "z")?;
        for (family, c) in shown {
            let (expected, mean, error, z) = (c.expected, c.measured.mean, c.measured.standard_error, c.z());
            writeln!(out, "{family:<16} {expected:>12.6} {mean:>12.6} {error:>10.6} {z:>6.2}  {}", c.name)?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "{:<16} {:>11} {:>8} {:>5} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}",
        "table", "experiments", "figures", "rare", "max |z|", "shift", "p", "χ² p", "tilt", "p", "χ² p"
    )?;
    for f in &judgement.families {
        writeln!(out, "{}", line(f))?;
    }
    let verdict = if judgement.p >= options.alpha { "reproduced" } else { "NOT reproduced" };
    writeln!(
        out,
        "\n{} figures {verdict}: p = {:.4} for the worst of all tests together (greatest |z|: p = {:.4})",
        judgement.figures, judgement.p, judgement.p_greatest
    )
}

fn line(f: &FamilyJudgement) -> String {
    let shift = format!("{:>+7.2} {:>7.4} {:>7.4}", f.shift.sum, f.shift.p_sum, f.shift.p_chi_square);
    let tilt = f.tilt.map_or(String::new(), |t| format!("{:>+7.2} {:>7.4} {:>7.4}", t.sum, t.p_sum, t.p_chi_square));
    format!("{:<16} {:>11} {:>8} {:>5} {:>8.2} {shift} {tilt}", f.family, f.experiments, f.figures, f.rare, f.greatest)
}
