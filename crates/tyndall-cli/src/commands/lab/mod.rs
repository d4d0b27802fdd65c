//! `tyndall lab INSTRUMENT`.

mod beam;
mod furnace;
mod gonio;
pub(crate) mod options;
mod picture;
mod polar;
pub(crate) mod report;

use std::{
    io::Read,
    path::Path,
    process::ExitCode,
    time::{Duration, Instant},
};

use anyhow::{Context, ensure};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use tyndall_formats::film::save;
use tyndall_lab::{
    ball, mci, point,
    run::{Estimate, Sums, Verdict},
    slab::{self, Bins, Edges, Incidence, Measured, Setup},
    walk,
    world::Substance,
};

use crate::{interrupt, outputs::write_text, threads::pool};
use options::{Instrument, Measurement, MediumOptions, PointOptions, SlabOptions, SphereOptions, WalkOptions};
use report::{Bin, Curve, Figure, Report};

/// Photons where nothing else ends an experiment.
const PHOTONS: u64 = 1_000_000;
/// The largest input file [bytes].
const LARGEST_FILE: u64 = 1 << 24;

/// Measures, and tells.
pub(crate) fn run(instrument: &Instrument) -> anyhow::Result<ExitCode> {
    interrupt::listen()?;
    let measurement = match instrument {
        Instrument::Slab(o) => &o.measurement,
        Instrument::Beam(o) => &o.measurement,
        Instrument::Furnace(o) => &o.measurement,
        Instrument::Gonio(o) => &o.measurement,
        Instrument::Point(o) => &o.measurement,
        Instrument::Sphere(o) => &o.measurement,
        Instrument::Walk(o) => &o.measurement,
    };
    measurement.check_files()?;
    let done = |report: Report| Ok((vec![report], ExitCode::SUCCESS));
    let (reports, exit) = pool(measurement.threads)?.install(|| match instrument {
        Instrument::Slab(options) => Ok((slabs(options)?, ExitCode::SUCCESS)),
        Instrument::Beam(options) => done(beam::run(options)?),
        Instrument::Furnace(options) => furnace::run(options).map(|(report, exit)| (vec![report], exit)),
        Instrument::Gonio(options) => done(gonio::run(options)?),
        Instrument::Point(options) => done(point(options)?),
        Instrument::Sphere(options) => done(sphere(options)?),
        Instrument::Walk(options) => done(random_walk(options)?),
    })?;
    tell(&reports, measurement)?;
    Ok(if interrupt::requested() { ExitCode::from(interrupt::EXIT) } else { exit })
}

/// Table, files and plots; a run of several writes to numbered files.
fn tell(reports: &[Report], measurement: &Measurement) -> anyhow::Result<()> {
    let to_stdout = |file: &Option<std::path::PathBuf>| file.as_deref() == Some(Path::new("-"));
    if !to_stdout(&measurement.json) && !to_stdout(&measurement.csv) {
        let tables: Vec<String> = reports.iter().map(Report::table).collect();
        write_text("-".as_ref(), tables.join("\n").trim_end())?;
    }
    if let Some(to) = &measurement.json {
        let text = match reports {
            [report] => serde_json::to_string_pretty(report),
            reports => serde_json::to_string_pretty(reports),
        };
        write_text(to, &text?)?;
    }
    for (i, report) in reports.iter().enumerate() {
        let numbered = |path: &Path| match (reports.len(), path.file_stem(), path.extension()) {
            (2.., Some(stem), Some(ending)) if path != Path::new("-") => {
                path.with_file_name(format!("{}-{}.{}", stem.display(), i + 1, ending.display()))
            }
            _ => path.to_owned(),
        };
        if let Some(to) = &measurement.csv {
            write_text(&numbered(to), report.csv().trim_end())?;
        }
        if let Some(to) = &measurement.plot {
            report.plot(&numbered(to))?;
        }
    }
    Ok(())
}

impl Measurement {
    /// Whether the files could be written: better known before the experiment than after it.
    fn check_files(&self) -> anyhow::Result<()> {
        for file in [&self.json, &self.csv, &self.plot].into_iter().flatten().filter(|file| **file != Path::new("-")) {
            save::check(file)?;
        }
        match &self.plot {
            Some(file) => report::check_plot(file),
            None => Ok(()),
        }
    }

    /// Photons at most, if the experiment itself says nothing.
    fn most_photons(&self, own: Option<u64>) -> u64 {
        let unlimited = self.time.is_some() || self.error.is_some();
        self.photons.or(own).unwrap_or(if unlimited { u64::MAX >> 8 } else { PHOTONS })
    }

    /// Shows how far an experiment is, and ends it when it is time, good enough, or Ctrl-C was pressed.
    fn look(&self, photons: u64) -> anyhow::Result<impl FnMut(&Sums) -> Verdict + use<>> {
        self.look_at_one_of(1, photons)
    }

    /// The same for one of several experiments, which share the time.
    fn look_at_one_of(&self, count: u32, photons: u64) -> anyhow::Result<impl FnMut(&Sums) -> Verdict + use<>> {
        let template = "{bar:30} {pos} of {len} photons, {elapsed} so far, {msg} left";
        let bar = ProgressBar::new(photons).with_style(ProgressStyle::with_template(template)?);
        let (start, limit, error) = (Instant::now(), self.time.map(|time| time / count), self.error);
        Ok(move |sums: &Sums| {
            let first = sums.estimate(0).standard_error;
            let far = progress(sums, photons, start.elapsed(), limit, error.map(|error| (first, error)));
            bar.set_position(sums.photons());
            let left = start.elapsed().mul_f64((1.0 / far.max(1e-6) - 1.0).clamp(0.0, 1e6));
            bar.set_message(HumanDuration(left).to_string());
            if far >= 1.0 || interrupt::requested() {
                bar.finish_and_clear();
                return Verdict::Enough;
            }
            Verdict::GoOn
        })
    }
}

/// The part of an experiment that is done: of its photons, its time, or the samples that its error needs.
fn progress(sums: &Sums, photons: u64, elapsed: Duration, limit: Option<Duration>, error: Option<(f64, f64)>) -> f64 {
    let by_photons = sums.photons() as f64 / photons as f64;
    let by_time = limit.map_or(0.0, |limit| elapsed.as_secs_f64() / limit.as_secs_f64());
    // Errors fall with the square root of the photons; from few batches they are not known.
    let by_error = error.filter(|_| sums.batches >= 64).map_or(0.0, |(now, wanted)| (wanted / now).powi(2));
    by_photons.max(by_time).max(by_error)
}

fn figure(name: impl Into<String>, unit: &'static str, estimate: Estimate) -> Figure {
    Figure { name: name.into(), unit, estimate, exact: None }
}

fn slabs(options: &SlabOptions) -> anyhow::Result<Vec<Report>> {
    let Some(file) = &options.file else {
        let title = match options.layer.len() {
            1 => "a layer".to_owned(),
            count => format!("{count} layers"),
        };
        return Ok(vec![slab(title, &setup(options), None, &options.measurement)?]);
    };
    // Devices and pipes do not tell their size: no more is read than an input file can have.
    let cannot_read = || format!("cannot read {}", file.display());
    let mut bytes = Vec::new();
    let mut source = std::fs::File::open(file).with_context(cannot_read)?.take(LARGEST_FILE + 1);
    source.read_to_end(&mut bytes).with_context(cannot_read)?;
    ensure!(bytes.len() as u64 <= LARGEST_FILE, "{} is too long for an input file of MCML", file.display());
    let text = std::str::from_utf8(&bytes).with_context(|| format!("{} is not text", file.display()))?;
    let runs = mci::read(text).with_context(|| format!("{} is no input file of MCML 1.2", file.display()))?;
    let report = |run: mci::Run| slab(run.output.clone(), &run.setup, Some(run.photons), &options.measurement);
    runs.into_iter().map(report).collect()
}

fn setup(options: &SlabOptions) -> Setup {
    let edges =
        |bins: Option<(usize, f64)>| bins.map_or(Edges::default(), |(count, width)| Edges::uniform(count, width));
    Setup {
        layers: options.layer.clone(),
        n_above: options.n_above,
        n_below: options.n_below,
        incidence: if options.diffuse { Incidence::Diffuse } else { Incidence::Beam(options.angle.to_radians().cos()) },
        bins: Bins {
            angles: options.angles,
            radii: edges(options.radii),
            depths: edges(options.depths),
            orders: options.orders,
            lengths: edges(options.lengths),
        },
    }
}

fn slab(title: String, setup: &Setup, own: Option<u64>, measurement: &Measurement) -> anyhow::Result<Report> {
    let photons = measurement.most_photons(own);
    let m = slab::measure(setup, photons, measurement.seed, measurement.look(photons)?)?;
    let mut figures = vec![
        figure("reflectance", "", m.reflectance),
        figure("specular reflectance", "", m.specular),
        figure("diffuse reflectance", "", m.diffuse),
        figure("transmittance", "", m.transmittance),
        figure("unscattered transmittance", "", m.unscattered),
        figure("diffuse transmittance", "", m.diffuse_transmittance),
    ];
    let exact = Estimate { mean: m.first_surface, standard_error: 0.0 };
    figures.push(figure("first surface alone", "", exact));
    let collisions = Estimate { mean: m.collisions as f64 / m.photons as f64, standard_error: 0.0 };
    figures.push(figure("collisions", "a photon, counted", collisions));
    figures.extend(m.absorbed.iter().enumerate().map(|(i, a)| figure(format!("absorbed in layer {}", i + 1), "", *a)));
    Ok(Report { title, photons: m.photons, figures, curves: curves(setup, &m), verdict: None, polar: None })
}

fn curves(setup: &Setup, m: &Measured) -> Vec<Curve> {
    let bins = &setup.bins;
    let degrees = Edges::uniform(bins.angles, 90.0 / bins.angles.max(1) as f64);
    let orders = Edges::uniform(bins.orders, 1.0);
    let all = [
        ("reflectance by angle", "1/sr", "exit angle", "°", &degrees, &m.reflectance_by_angle),
        ("transmittance by angle", "1/sr", "exit angle", "°", &degrees, &m.transmittance_by_angle),
        ("reflectance by radius", "1/length²", "radius", "length", &bins.radii, &m.reflectance_by_radius),
        ("transmittance by radius", "1/length²", "radius", "length", &bins.radii, &m.transmittance_by_radius),
        ("fluence", "", "depth", "length", &bins.depths, &m.fluence),
        ("reflectance by order", "", "scattering order", "", &orders, &m.reflectance_by_order),
        ("transmittance by order", "", "scattering order", "", &orders, &m.transmittance_by_order),
        ("reflectance by length", "1/length", "length of the way", "length", &bins.lengths, &m.reflectance_by_length),
        (
            "transmittance by length",
            "1/length",
            "length of the way",
            "length",
            &bins.lengths,
            &m.transmittance_by_length,
        ),
    ];
    let curve = |(name, unit, of, of_unit, edges, estimates): (&str, _, _, _, &Edges, &Vec<Estimate>)| Curve {
        name: name.to_owned(),
        unit,
        of,
        of_unit,
        bins: (0..edges.count()).map(|i| bin(edges.bin(i), estimates[i])).collect(),
        models: Vec::new(),
    };
    all.into_iter().map(curve).filter(|curve| !curve.bins.is_empty()).collect()
}

fn bin([start, end]: [f64; 2], estimate: Estimate) -> Bin {
    Bin { start, end, estimate }
}

/// A medium whose mean free path is the unit of length.
fn substance(medium: &MediumOptions) -> anyhow::Result<Substance> {
    let substance = Substance::of_albedo(medium.albedo, medium.g);
    substance.check()?;
    Ok(substance)
}

fn point(options: &PointOptions) -> anyhow::Result<Report> {
    let measurement = &options.measurement;
    let photons = measurement.most_photons(None);
    let Edges(radii) = Edges::uniform(options.radii.0, options.radii.1);
    let medium = substance(&options.medium)?;
    let m = point::fluence(&medium, &radii, photons, measurement.seed, measurement.look(photons)?)?;
    Ok(Report {
        title: format!("a point source in a medium of albedo {}", medium.albedo()),
        photons: m.photons,
        figures: vec![figure("∫ 4πr²φ dr", "mfp", m.m0), figure("∫ 4πr⁴φ dr", "mfp³", m.m2)],
        curves: vec![Curve {
            name: "4πr²φ".into(),
            models: Vec::new(),
            unit: "",
            of: "distance",
            of_unit: "mfp",
            bins: m.shells.iter().map(|shell| bin([shell.inner, shell.outer], shell.fluence)).collect(),
        }],
        verdict: None,
        polar: None,
    })
}

fn sphere(options: &SphereOptions) -> anyhow::Result<Report> {
    let measurement = &options.measurement;
    let photons = measurement.most_photons(None);
    let ball = Substance { n: options.n, ..substance(&options.medium)? };
    let source = if options.inside { ball::Source::Volume } else { ball::Source::Beam };
    let m = ball::balance(&ball, options.radius, source, photons, measurement.seed, measurement.look(photons)?)?;
    let orders = Edges::uniform(m.by_order.len(), 1.0);
    Ok(Report {
        title: format!("a ball of radius {} mean free paths and albedo {}", options.radius, ball.albedo()),
        photons: m.photons,
        figures: vec![
            figure("absorbed", "", m.absorbed),
            figure("leaves", "", m.escaped),
            figure("leaves unscattered", "", m.unscattered),
        ],
        curves: vec![Curve {
            name: "leaves by order".into(),
            models: Vec::new(),
            unit: "",
            of: "scattering order",
            of_unit: "",
            bins: m.by_order.iter().enumerate().map(|(i, e)| bin(orders.bin(i), *e)).collect(),
        }],
        verdict: None,
        polar: None,
    })
}

fn random_walk(options: &WalkOptions) -> anyhow::Result<Report> {
    let measurement = &options.measurement;
    let photons = measurement.most_photons(None);
    let m = walk::moments(options.g, &options.flights, photons, measurement.seed, measurement.look(photons)?)?;
    let figures = m.iter().flat_map(|m| {
        let named = |what: &str| format!("{what} after {} flights", m.flights);
        [figure(named("⟨z⟩"), "mfp", m.z), figure(named("⟨r²⟩"), "mfp²", m.r2), figure(named("⟨z²⟩"), "mfp²", m.z2)]
    });
    let figures = figures.collect();
    Ok(Report {
        title: format!("a random walk, g = {}", options.g),
        photons: m[0].photons,
        figures,
        curves: Vec::new(),
        verdict: None,
        polar: None,
    })
}
