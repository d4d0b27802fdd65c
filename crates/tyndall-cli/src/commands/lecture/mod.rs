//! `tyndall lecture`: what each step of the lecture buys.
//!
//! One scene of surfaces and one with a volume are rendered by the four versions of their estimator, once with the same
//! number of samples and once in the same time, and by `volpath` as a reference. All in grey: the estimators carry one
//! colour at a time, and noise of colour would hide what they are compared for. What comes out: the images, a contact
//! sheet, a plot of error against time, and a table.

mod measure;
mod plot;
mod sheet;
mod table;

use std::{path::Path, process::ExitCode};

use anyhow::Context;
use tyndall::spectrum::ColorMode;
use tyndall_formats::film::{Curve, Image, Tone, exr, png, save};

use crate::{
    args::{IntegratorName, LectureOptions, SceneOptions},
    interrupt,
    load::load,
};

use measure::{Bench, Reference, Run};

/// How all images are shown.
const TONE: Tone = Tone { exposure: 0.0, curve: Curve::Filmic };

/// A scene and the estimators that it shows.
struct Topic {
    name: &'static str,
    /// The scene; compiled in, so that the lecture can be held anywhere.
    scene: &'static str,
    versions: [(&'static str, IntegratorName); 4],
}

const TOPICS: [Topic; 2] = [
    Topic {
        name: "surface",
        scene: include_str!("../../../../../scenes/lecture/surface.pbrt"),
        versions: [
            ("version 0", IntegratorName::LectureSurface0),
            ("version 0.5", IntegratorName::LectureSurface05),
            ("version 0.75", IntegratorName::LectureSurface075),
            ("version 1.0", IntegratorName::LectureSurface10),
        ],
    },
    Topic {
        name: "volume",
        scene: include_str!("../../../../../scenes/lecture/volume.pbrt"),
        versions: [
            ("version 0", IntegratorName::LectureVolume0),
            ("version 0.5", IntegratorName::LectureVolume05),
            ("version 0.75", IntegratorName::LectureVolume075),
            ("version 1.0", IntegratorName::LectureVolume10),
        ],
    },
];

/// What was measured on one scene.
pub(crate) struct Chapter {
    name: &'static str,
    reference: Reference,
    versions: Vec<Version>,
}

/// One estimator.
pub(crate) struct Version {
    label: &'static str,
    equal_samples: Run,
    equal_time: Run,
}

/// Renders everything and writes it.
pub(crate) fn run(options: &LectureOptions) -> anyhow::Result<ExitCode> {
    interrupt::listen()?;
    std::fs::create_dir_all(&options.out)
        .with_context(|| format!("cannot make the directory {}", options.out.display()))?;
    let mut chapters = Vec::new();
    for topic in &TOPICS {
        let Some(chapter) = chapter(topic, options)? else {
            eprintln!("stopped by Ctrl-C: {} holds what is done", options.out.display());
            return Ok(ExitCode::from(interrupt::EXIT));
        };
        chapters.push(chapter);
    }
    conclude(&chapters, options)?;
    Ok(ExitCode::SUCCESS)
}

/// One scene by all its estimators. `None` if somebody pressed Ctrl-C.
fn chapter(topic: &Topic, options: &LectureOptions) -> anyhow::Result<Option<Chapter>> {
    let path = options.out.join(format!("{}.pbrt", topic.name));
    save::replace(&path, topic.scene.as_bytes())?;
    let input = SceneOptions { scene: path, ..SceneOptions::default() };
    let loaded = load(&input, options.resolution, Some(ColorMode::Mono), None)?;
    let bench = Bench::new(&loaded, topic.name, options)?;

    let reference = bench.reference();
    write(&options.out, &format!("{}-reference", topic.name), &reference.image)?;
    let mut equal_samples = Vec::new();
    for (label, integrator) in topic.versions {
        if interrupt::requested() {
            return Ok(None);
        }
        let run = bench.samples(label, integrator, options.spp, &reference);
        write(&options.out, &file_stem(topic.name, label, "equal-samples"), &run.image)?;
        equal_samples.push(run);
    }
    let slowest = equal_samples.iter().map(|run| run.seconds).fold(0.0, f64::max);
    let mut versions = Vec::new();
    for ((label, integrator), equal_samples) in topic.versions.into_iter().zip(equal_samples) {
        let equal_time = bench.time(label, integrator, slowest, &reference);
        if interrupt::requested() {
            return Ok(None);
        }
        write(&options.out, &file_stem(topic.name, label, "equal-time"), &equal_time.image)?;
        versions.push(Version { label, equal_samples, equal_time });
    }
    Ok(Some(Chapter { name: topic.name, reference, versions }))
}

/// Writes what compares the estimators, and says where it all is.
fn conclude(chapters: &[Chapter], options: &LectureOptions) -> anyhow::Result<()> {
    let out = |name: &str| options.out.join(name);
    sheet::write(&out("contact-sheet.png"), chapters)?;
    plot::write(&out("error-against-time"), chapters)?;
    let markdown = table::markdown(chapters);
    save::replace(&out("table.md"), markdown.as_bytes())?;
    let json = serde_json::to_string_pretty(&table::rows(chapters))?;
    save::replace(&out("table.json"), json.as_bytes())?;
    if !options.quiet {
        crate::outputs::write_text("-".as_ref(), &table::terminal(chapters))?;
        eprintln!("images, contact-sheet.png, error-against-time.svg and table.md are in {}", options.out.display());
    }
    Ok(())
}

fn write(out: &Path, stem: &str, image: &Image) -> anyhow::Result<()> {
    exr::write(&out.join(format!("{stem}.exr")), image)?;
    Ok(png::write(&out.join(format!("{stem}.png")), image, TONE)?)
}

/// `surface-version-0.5-equal-time`.
fn file_stem(topic: &str, label: &str, what: &str) -> String {
    format!("{topic}-{}-{what}", label.replace(' ', "-"))
}
