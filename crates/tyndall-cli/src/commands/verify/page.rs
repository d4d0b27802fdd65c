//! `--report DIR`: a page of Markdown with tables and plots, and all figures as CSV.

use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::{Context, ensure};
use tyndall_formats::film::save;
use tyndall_lab::verify::{Check, Experiment, FamilyJudgement, Judgement, ORACLES, Oracle};

use super::{figures, plots};
use crate::args::VerifyOptions;

/// Every file of a report says this, so that one is known again, and nothing else is overwritten.
const MARK: &str = "written by tyndall verify";
/// The page, the figures, and the plot of all of them; those of tables are named after them.
const PAGE: &str = "verify.md";
const FIGURES: &str = "verify.csv";
const ALL: &str = "verify.svg";
/// Figures of a table that are shown: those that are off most.
const SHOWN: usize = 5;

/// A directory that a report can be written to.
pub(super) struct Page {
    directory: PathBuf,
}

impl Page {
    /// Finds out whether the report can be written.
    pub(super) fn prepare(directory: &Path) -> anyhow::Result<Self> {
        fs::create_dir_all(directory).with_context(|| format!("cannot make the directory {}", directory.display()))?;
        let page = Self { directory: directory.to_owned() };
        let plots = ORACLES.iter().map(|oracle| plot_of(oracle.name));
        for name in [PAGE, FIGURES, ALL].into_iter().map(str::to_owned).chain(plots) {
            let file = page.directory.join(name);
            save::check(&file)?;
            if file.exists() {
                let own = fs::read(&file).is_ok_and(|bytes| holds(&bytes, MARK.as_bytes()));
                ensure!(own, "{} is there already, and no part of a report: it is not overwritten", file.display());
            }
        }
        Ok(page)
    }

    /// Writes page, plots and figures, each whole or not at all.
    pub(super) fn write(
        &self,
        experiments: &[Experiment],
        judgement: &Judgement,
        options: &VerifyOptions,
        took: Duration,
    ) -> anyhow::Result<()> {
        let all: Vec<f64> = figures(experiments).map(|(_, check)| check.z()).collect();
        self.put(ALL, &marked_svg(&plots::histogram(&all)?))?;
        for family in &judgement.families {
            let checks = of(experiments, family.family);
            self.put(&plot_of(family.family), &marked_svg(&plots::deviations(&checks)?))?;
        }
        self.put(FIGURES, &csv(experiments))?;
        self.put(PAGE, &markdown(experiments, judgement, options, took))
    }

    fn put(&self, name: &str, text: &str) -> anyhow::Result<()> {
        Ok(save::replace(&self.directory.join(name), text.as_bytes())?)
    }
}

fn plot_of(family: &str) -> String {
    format!("verify-{family}.svg")
}

fn marked_svg(svg: &str) -> String {
    format!("{}\n<!-- {MARK} -->\n", svg.trim_end())
}

fn holds(bytes: &[u8], mark: &[u8]) -> bool {
    bytes.windows(mark.len()).any(|window| window == mark)
}

fn of<'a>(experiments: &'a [Experiment], family: &str) -> Vec<&'a Check> {
    figures(experiments).filter(|(name, _)| *name == family).map(|(_, check)| check).collect()
}

fn csv(experiments: &[Experiment]) -> String {
    let mut out = format!("# {MARK}\ntable,figure,expected,uncertainty,measured,standard_error,z\n");
    for (family, c) in figures(experiments) {
        let (mean, error) = (c.measured.mean, c.measured.standard_error);
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{family},\"{}\",{},{},{mean},{error},{}", c.name, c.expected, c.uncertainty, c.z());
    }
    out
}

fn markdown(experiments: &[Experiment], judgement: &Judgement, options: &VerifyOptions, took: Duration) -> String {
    let mut out =
        format!("<!-- {MARK} -->\n# The report of `tyndall verify{}`\n\n", if options.full { " --full" } else { "" });
    let verdict = if judgement.p >= options.alpha { "reproduced" } else { "**not** reproduced" };
    let _ = write!(
        out,
        "{} figures of {} tables are {verdict}: p = {:.3} for the worst of all tests together, corrected for their number \
         (a program that is right is called wrong with the chance {}). The greatest |z| has p = {:.3}. Seed {}, {:.0} s.\n\n\
         ![All deviations in standard errors, and the normal law]({ALL})\n\n\
         All figures: [{FIGURES}]({FIGURES}). What the columns mean: [Why you can trust it](../trust.md).\n\n",
        judgement.figures,
        judgement.families.len(),
        judgement.p,
        options.alpha,
        judgement.p_greatest,
        options.seed,
        took.as_secs_f64(),
    );
    out.push_str("| table | experiments | figures | max \\|z\\| | shift | p | χ² p | tilt | p | χ² p |\n");
    out.push_str("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for f in &judgement.families {
        out.push_str(&row(f));
    }
    for family in &judgement.families {
        if let Some(oracle) = ORACLES.iter().find(|oracle| oracle.name == family.family) {
            out.push_str(&section(oracle, &of(experiments, oracle.name)));
        }
    }
    out
}

fn row(f: &FamilyJudgement) -> String {
    let tilt = f.tilt.map_or("| | ".to_owned(), |t| format!("{:+.2} | {:.3} | {:.3}", t.sum, t.p_sum, t.p_chi_square));
    format!(
        "| [{0}](#{0}) | {1} | {2} | {3:.2} | {4:+.2} | {5:.3} | {6:.3} | {tilt} |\n",
        f.family, f.experiments, f.figures, f.greatest, f.shift.sum, f.shift.p_sum, f.shift.p_chi_square
    )
}

/// A table of its own: what it is, its plot, the figures that are off most.
fn section(oracle: &Oracle, checks: &[&Check]) -> String {
    let mut worst = checks.to_vec();
    worst.sort_by(|a, b| b.z().abs().total_cmp(&a.z().abs()));
    let mut out = format!(
        "\n## {0}\n\n{1}. Source: {2}.\n\n![Deviations of {0} in standard errors]({3})\n\n\
         | figure | expected | measured | ± s.e. | z |\n|---|--:|--:|--:|--:|\n",
        oracle.name,
        capitalised(oracle.about),
        oracle.source,
        plot_of(oracle.name)
    );
    for c in worst.into_iter().take(SHOWN) {
        let (mean, error) = (c.measured.mean, c.measured.standard_error);
        let _ = writeln!(out, "| {} | {:.6} | {mean:.6} | {error:.6} | {:+.2} |", c.name, c.expected, c.z());
    }
    out
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
