//! Roulette that bounds the weight keeps the variance finite; roulette that bounds the probability does not.
//!
//! Independent runs with N = 1, 2, 4, … samples a pixel, of tyndall and of Mitsuba with its roulette and without it, in
//! two scattering cubes whose boundaries do not reflect: under a uniform sky without absorption, where every pixel must
//! be 1, and under a lamp with albedo 0.99844. Plain Monte Carlo has `MSE · N` = variance of one sample, the same for
//! every N, if there is a variance; where there is none, `MSE · N` climbs with N, and the mean is short of light.
//! The book's page `docs/src/roulette.md` derives it.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Result;
use serde::Serialize;

use super::plot::{Curve, Panel as Axes, Plot};
use super::publish;
use crate::peers::image::Image;
use crate::peers::mitsuba::Mitsuba;
use crate::peers::report::figure;
use crate::peers::runs::{Runs, Turn};
use crate::peers::settings::{Duel, Variant};
use crate::peers::tyndall::Tyndall;
use crate::peers::{directory, scene_file};

/// Independent runs for each N.
const RUNS: u32 = 8;

/// A scene and, where it is known, the value of every pixel.
#[derive(Debug, Clone, Copy, Serialize)]
struct Cube {
    scene: &'static str,
    title: &'static str,
    truth: Option<f64>,
}

const CUBES: [Cube; 2] = [
    Cube { scene: "b2_furnace_matched", title: "white cube under a uniform sky (truth: 1)", truth: Some(1.0) },
    Cube { scene: "b3_grey_matched", title: "grey cube, albedo 0.99844, under a lamp", truth: None },
];

/// Who renders, and with which roulette.
#[derive(Debug, Clone, Copy, Serialize)]
struct Side {
    name: &'static str,
    /// Mitsuba's parameters; none for tyndall
    mitsuba: Option<&'static str>,
}

/// The pictures are small: each pixel is an experiment of its own, and there are enough of them.
const SIDES: [Side; 3] = [
    Side { name: "tyndall", mitsuba: None },
    Side { name: "Mitsuba, default roulette", mitsuba: Some("integrator=volpathmis rr_depth=5 res=32") },
    Side { name: "Mitsuba, roulette off", mitsuba: Some("integrator=volpathmis rr_depth=1000000 res=32") },
];

/// What the runs with one N say. Errors are standard errors over the runs.
#[derive(Debug, Clone, Serialize)]
struct Level {
    /// N, samples a pixel in each run
    spp: u32,
    /// Mean squared error over pixels and channels times N, and its standard error
    mse_n: (f64, f64),
    /// Mean of the picture and its standard error
    mean: (f64, f64),
    /// CPU seconds of all runs [s]
    cpu_seconds: f64,
}

/// One line of the plot.
#[derive(Debug, Clone, Serialize)]
struct Course {
    side: Side,
    levels: Vec<Level>,
}

/// One panel of the plot.
#[derive(Debug, Clone, Serialize)]
struct Panel {
    cube: Cube,
    courses: Vec<Course>,
}

/// Measures with about `seconds` CPU seconds a side and scene, prints the table, writes `target/bench/roulette.*`.
pub(super) fn run(tyndall: &Tyndall, seconds: f64) -> Result<()> {
    let mitsuba = Mitsuba::install()?;
    let mut panels = Vec::new();
    for cube in CUBES {
        let courses = SIDES.map(|side| course(cube, side, seconds, &mitsuba, tyndall));
        panels.push(Panel { cube, courses: courses.into_iter().collect::<Result<_>>()? });
    }
    publish("roulette", &panels.iter().map(table).collect::<String>(), &panels, &plot(&panels))
}

/// Doubles N as long as the next runs fit into the time.
fn course(cube: Cube, side: Side, seconds: f64, mitsuba: &Mitsuba, tyndall: &Tyndall) -> Result<Course> {
    let directory = directory(&format!("roulette/{} {}", cube.scene, side.name.replace(',', "")))?;
    let mut levels: Vec<Level> = Vec::new();
    let mut spent = 0.0;
    for doubling in 0..16 {
        let turn = Turn { index: doubling, runs: RUNS };
        let runs = render(cube, side, 1 << doubling, turn, &directory, mitsuba, tyndall)?;
        spent += runs.cpu_seconds;
        let level = Level::of(1 << doubling, &runs, cube.truth);
        eprintln!("{}, {}: N = {}, {:.1} CPU s", cube.scene, side.name, level.spp, level.cpu_seconds);
        levels.push(level);
        if spent + 2.0 * runs.cpu_seconds > seconds {
            break;
        }
    }
    Ok(Course { side, levels })
}

fn render(
    cube: Cube,
    side: Side,
    spp: u32,
    turn: Turn,
    directory: &Path,
    mitsuba: &Mitsuba,
    tyndall: &Tyndall,
) -> Result<Runs> {
    if let Some(parameters) = side.mitsuba {
        let duel = Duel {
            scene: cube.scene,
            variant: Variant::Scalar,
            parameters: parameters.to_owned(),
            mitsuba_spp: spp,
            tyndall_spp: spp,
            arguments: &[],
        };
        mitsuba.render(&duel, turn, directory, false)
    } else {
        // Stratified samples converge faster than 1/N: independent ones let roulette alone be seen.
        let extra = ["--sampler", "independent", "-D", "res=32"];
        tyndall.render(&scene_file(cube.scene), spp, turn, &directory.join("run"), &extra)
    }
}

impl Level {
    /// The error of a run is its distance from the truth; where that is unknown, from the mean of the K runs, which is
    /// nearer to each of them than the truth by (K − 1)/K of the square.
    fn of(spp: u32, runs: &Runs, truth: Option<f64>) -> Self {
        let images = &runs.images;
        let count = images.len() as f64;
        let values =
            |image: &Image| image.pixels.as_flattened().iter().map(|&value| f64::from(value)).collect::<Vec<_>>();
        let images: Vec<Vec<f64>> = images.iter().map(values).collect();
        let (reference, correction) = match truth {
            Some(truth) => (vec![truth; images[0].len()], 1.0),
            None => (
                (0..images[0].len()).map(|i| mean(images.iter().map(|image| image[i]))).collect(),
                count / (count - 1.0),
            ),
        };
        let mse = |image: &Vec<f64>| mean(image.iter().zip(&reference).map(|(value, truth)| (value - truth).powi(2)));
        let mse_n = images.iter().map(|image| correction * f64::from(spp) * mse(image));
        let means = images.iter().map(|image| mean(image.iter().copied()));
        Self {
            spp,
            mse_n: with_standard_error(&mse_n.collect::<Vec<_>>()),
            mean: with_standard_error(&means.collect::<Vec<_>>()),
            cpu_seconds: runs.cpu_seconds,
        }
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Mean and its standard error, from the spread.
fn with_standard_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let middle = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - middle).powi(2)).sum::<f64>();
    (middle, (squares / (count - 1.0) / count).sqrt())
}

/// A level line is a finite variance, a climbing one is none.
fn plot(panels: &[Panel]) -> Plot<'_> {
    let points = |course: &Course| course.levels.iter().map(|l| [f64::from(l.spp), l.mse_n.0, l.mse_n.1]).collect();
    let curve = |course: &Course| Curve { name: course.side.name, points: points(course) };
    let axes = |panel: &Panel| Axes { title: panel.cube.title, curves: panel.courses.iter().map(curve).collect() };
    Plot { across: "samples a pixel, N", up: "MSE · N", panels: panels.iter().map(axes).collect() }
}

/// N downwards, sides across.
fn table(panel: &Panel) -> String {
    let mut text = format!("\n{}: MSE · N, and the mean of the picture\n\n| N |", panel.cube.title);
    for course in &panel.courses {
        let _ = write!(text, " {} | mean |", course.side.name);
    }
    let _ = write!(text, "\n|--:|{}\n", "--:|--:|".repeat(panel.courses.len()));
    let longest = panel.courses.iter().map(|course| course.levels.len()).max().unwrap_or(0);
    for row in 0..longest {
        let _ = write!(text, "| {} |", 1 << row);
        for course in &panel.courses {
            let cells = course.levels.get(row).map_or("   |   |".to_owned(), |level| {
                let ((mse_n, mse_n_error), (mean, mean_error)) = (level.mse_n, level.mean);
                format!(" {} ± {} | {mean:.4} ± {mean_error:.4} |", figure(mse_n), figure(mse_n_error))
            });
            text += &cells;
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use testkit::Stream;

    use super::*;

    /// Runs whose pixels are means of `spp` uniform numbers on [0, 2): mean 1, variance 4/12 for one sample.
    fn runs(spp: u32) -> Runs {
        let mut random = Stream::new(u64::from(spp));
        let mut value = || (0..spp).map(|_| 2.0 * random.next_f64()).sum::<f64>() / f64::from(spp);
        let mut image =
            || Image { width: 32, height: 32, pixels: (0..1024).map(|_| [(); 3].map(|()| value() as f32)).collect() };
        Runs { images: (0..8).map(|_| image()).collect(), cpu_seconds: 1.0 }
    }

    /// The variance of 3·1024·8 numbers is known to about √(2/24,576) = 0.9 %, the mean to √(1/3/N/24,576).
    #[test]
    fn mse_times_n_is_the_variance_of_one_sample_with_or_without_the_truth() {
        for (spp, truth) in [(1, Some(1.0)), (4, Some(1.0)), (1, None), (4, None)] {
            let level = Level::of(spp, &runs(spp), truth);
            assert!((level.mse_n.0 - 1.0 / 3.0).abs() < 0.013, "{level:?}");
            assert!((level.mean.0 - 1.0).abs() < 0.015 && level.mean.1 < 0.01, "{level:?}");
        }
    }

    #[test]
    fn the_table_has_a_row_for_each_n_and_gaps_where_a_side_ran_out_of_time() {
        let level = Level { spp: 1, mse_n: (0.5, 0.125), mean: (1.0, 0.01), cpu_seconds: 1.0 };
        let course = |levels: usize| Course { side: SIDES[0], levels: vec![level.clone(); levels] };
        let text = table(&Panel { cube: CUBES[0], courses: vec![course(1), course(2)] });
        assert!(text.ends_with("| 2 |   |   | 0.500 ± 0.125 | 1.0000 ± 0.0100 |\n"), "{text}");
    }
}
