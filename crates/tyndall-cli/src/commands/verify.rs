//! `tyndall verify`.

use std::{fmt::Write, process::ExitCode, time::Instant};

use indicatif::{ProgressBar, ProgressStyle};
use tyndall_lab::verify::{Check, Effort, Experiment, Judgement, ORACLES, Oracle, judge};

use crate::{args::VerifyOptions, outputs::write_text, threads::pool};

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
    let experiments = pool(options.threads)?.install(|| measure(&oracles, options))?;
    let judgement = judge(&experiments);
    let checks: Vec<&Check> = experiments.iter().flat_map(|experiment| &experiment.checks).collect();
    let reproduced = judgement.p >= options.alpha;
    if options.json.as_deref() != Some("-".as_ref()) {
        write_text("-".as_ref(), told(&checks, &judgement, options).trim_end())?;
    }
    if let Some(to) = &options.json {
        let figures: Vec<_> =
            checks.iter().map(|c| serde_json::json!({ "figure": c, "z": c.z(), "p": c.p() })).collect();
        let report = serde_json::json!({ "reproduced": reproduced, "judgement": judgement, "figures": figures });
        write_text(to, &serde_json::to_string_pretty(&report)?)?;
    }
    Ok(if reproduced { ExitCode::SUCCESS } else { ExitCode::from(NOT_REPRODUCED) })
}

fn list(oracles: &[&Oracle]) -> String {
    let lines = oracles.iter().map(|o| format!("{:<14} {}\n{:<14} {}\n", o.name, o.about, "", o.source));
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
        progress.println(format!(
            "{:<14} {:>4} figures, {:.1} s",
            oracle.name,
            measured.iter().map(|experiment| experiment.checks.len()).sum::<usize>(),
            start.elapsed().as_secs_f64()
        ));
        experiments.extend(measured);
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(experiments)
}

/// The figures that are far off, a line for each table, the verdict.
fn told(checks: &[&Check], judgement: &Judgement, options: &VerifyOptions) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = tell(&mut out, checks, judgement, options);
    out
}

fn tell(out: &mut String, checks: &[&Check], judgement: &Judgement, options: &VerifyOptions) -> std::fmt::Result {
    let shown: Vec<_> = checks.iter().filter(|c| options.all || c.z().abs() > SHOWN || c.z().is_nan()).collect();
    if !shown.is_empty() {
        writeln!(out, "{:<14} {:>12} {:>12} {:>10} {:>6}", "table", "expected", "measured", "± s.e.", "z")?;
        for c in shown {
            let (mean, error) = (c.measured.mean, c.measured.standard_error);
            writeln!(
                out,
                "{:<14} {:>12.6} {mean:>12.6} {error:>10.6} {:>6.2}  {}",
                c.family,
                c.expected,
                c.z(),
                c.name
            )?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "{:<14} {:>11} {:>8} {:>9} {:>7} {:>8} {:>7} {:>8}",
        "table", "experiments", "figures", "max |z|", "shift", "p", "χ²", "p"
    )?;
    for f in &judgement.families {
        writeln!(
            out,
            "{:<14} {:>11} {:>8} {:>9.2} {:>+7.2} {:>8.4} {:>7.1} {:>8.4}",
            f.family, f.experiments, f.figures, f.greatest, f.shift, f.p_shift, f.chi_square, f.p_chi_square
        )?;
    }
    let verdict = if judgement.p >= options.alpha { "reproduced" } else { "NOT reproduced" };
    writeln!(
        out,
        "\n{} figures {verdict}: p = {:.4} for the worst of all tests together (greatest |z|: p = {:.4})",
        judgement.figures, judgement.p, judgement.p_greatest
    )
}
