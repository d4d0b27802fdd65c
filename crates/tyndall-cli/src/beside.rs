//! What a proxy of grains does to a picture, and what it saves: of every 32 paths that go on in one, another goes the same way
//! among explicit grains to its end, beside the render and with its random numbers.
//!
//! Both are one path up to the last explicit grain, so that of the noise only that of the rest remains in their difference
//! `d`. Over all such pairs, with `e` what the explicit path found,
//!
//! ```text
//! R = Σd / Σe,    s.e. = √(Σ (d − R e)²) / Σe
//! ```
//!
//! is the relative difference of the mean of the picture, to first order with its standard error, by colour. (Where paths are
//! stratified over a pixel the error is an upper bound.) Time is that of the processor, of either kind of path alone.

use std::{
    fmt::Write,
    sync::{Mutex, PoisonError},
    time::Duration,
};

use cpu_time::ThreadTime;
use serde::Serialize;
use tyndall::{
    integrator::{CameraSample, Integrator, Parts, TakesApart},
    lpe::Automaton,
    scene::Scene,
    spectrum::{Lanes, film_rgb},
    tally::Tally,
};

/// One path in so many is followed explicitly too.
const EVERY: u32 = 32;

/// Two estimators side by side; the first makes the picture.
#[derive(Debug)]
pub(crate) struct Beside {
    proxied: Box<dyn Integrator>,
    explicit: Box<dyn Integrator>,
    explicit_grains: u32,
    sums: Mutex<Sums>,
}

/// Over pairs, by colour.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// How many, and paths in all.
    pairs: u64,
    paths: u64,
    /// Pairs one of which found no radiance (NaN, infinite): they are in none of the sums.
    faults: u64,
    d: [f64; 3],
    e: [f64; 3],
    dd: [f64; 3],
    de: [f64; 3],
    ee: [f64; 3],
    /// For all paths with proxies, and for all explicit ones.
    time: [Duration; 2],
}

/// How far a picture with proxies is from that without.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Difference {
    /// Grains before the proxy.
    pub(crate) explicit_grains: u32,
    /// Pairs of paths.
    pub(crate) pairs: u64,
    /// Of these so many were left out, which found no radiance.
    pub(crate) faults: u64,
    /// (Proxied − explicit) / explicit, of the mean of the picture, in linear red, green, blue \[1\].
    pub(crate) relative: [f64; 3],
    /// Its standard error \[1\].
    pub(crate) standard_error: [f64; 3],
    /// Time of an explicit path over that of one with a proxy \[1\].
    pub(crate) speedup: f64,
}

impl Beside {
    pub(crate) fn new(proxied: Box<dyn Integrator>, explicit: Box<dyn Integrator>, explicit_grains: u32) -> Self {
        Self { proxied, explicit, explicit_grains, sums: Mutex::default() }
    }

    pub(crate) fn difference(&self) -> Difference {
        let sums = *self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        let Sums { pairs, paths, faults, d, e, dd, de, ee, time } = sums;
        let relative: [f64; 3] = std::array::from_fn(|c| d[c] / e[c]);
        let square = |c: usize| dd[c] - 2.0 * relative[c] * de[c] + relative[c] * relative[c] * ee[c];
        let each = |time: Duration, paths: u64| time.as_secs_f64() / paths as f64;
        Difference {
            explicit_grains: self.explicit_grains,
            pairs,
            faults,
            relative,
            standard_error: std::array::from_fn(|c| square(c).max(0.0).sqrt() / e[c]),
            speedup: each(time[1], pairs) / each(time[0], paths),
        }
    }

    /// Follows some of the paths again, explicitly; `proxied` is what they found, in that time.
    fn compare(&self, scene: &Scene, samples: &[CameraSample], proxied: &[Lanes], time: Duration) {
        let chosen = |sample: &CameraSample| sample.sampler.rng.aside().next_u32().is_multiple_of(EVERY);
        let pairs = samples.iter().zip(proxied).filter(|(sample, _)| chosen(sample));
        let (again, proxied): (Vec<CameraSample>, Vec<Lanes>) = pairs.unzip();
        let start = ThreadTime::now();
        let explicit = self.explicit.li_many(scene, &again, &mut Tally::default());
        let mut sums = Sums { paths: samples.len() as u64, time: [time, start.elapsed()], ..Sums::default() };
        for ((sample, proxied), explicit) in again.iter().zip(proxied).zip(explicit) {
            sums.add(proxied, explicit, sample);
        }
        self.sums.lock().unwrap_or_else(PoisonError::into_inner).merge(&sums);
    }
}

impl Sums {
    fn add(&mut self, proxied: Lanes, explicit: Lanes, sample: &CameraSample) {
        self.pairs += 1;
        if !(proxied.is_finite() && explicit.is_finite()) {
            self.faults += 1;
            return;
        }
        let [proxied, explicit] = [proxied, explicit].map(|light| film_rgb(light, &sample.wavelengths).map(f64::from));
        for (c, (proxied, e)) in proxied.into_iter().zip(explicit).enumerate() {
            let d = proxied - e;
            self.d[c] += d;
            self.e[c] += e;
            self.dd[c] += d * d;
            self.de[c] += d * e;
            self.ee[c] += e * e;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.pairs += other.pairs;
        self.paths += other.paths;
        self.faults += other.faults;
        for c in 0..3 {
            self.d[c] += other.d[c];
            self.e[c] += other.e[c];
            self.dd[c] += other.dd[c];
            self.de[c] += other.de[c];
            self.ee[c] += other.ee[c];
        }
        for (sum, time) in self.time.iter_mut().zip(other.time) {
            *sum += time;
        }
    }
}

impl Integrator for Beside {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        self.proxied.li(scene, seen, tally)
    }

    fn li_many(&self, scene: &Scene, samples: &[CameraSample], tally: &mut Tally) -> Vec<Lanes> {
        let start = ThreadTime::now();
        let radiance = self.proxied.li_many(scene, samples, tally);
        self.compare(scene, samples, &radiance, start.elapsed());
        radiance
    }

    fn apart(&self) -> Option<&dyn TakesApart> {
        self.proxied.apart().map(|_| self as &dyn TakesApart)
    }
}

impl TakesApart for Beside {
    fn li_apart(&self, scene: &Scene, by: &Automaton, samples: &[CameraSample], tally: &mut Tally) -> Parts {
        let Some(proxied) = self.proxied.apart() else {
            return Parts::undivided(self.li_many(scene, samples, tally));
        };
        let start = ThreadTime::now();
        let parts = proxied.li_apart(scene, by, samples, tally);
        self.compare(scene, samples, &parts.radiance, start.elapsed());
        parts
    }
}

impl Difference {
    /// In a line of a report.
    pub(crate) fn sentence(&self) -> String {
        let Self { explicit_grains, pairs, faults, relative, standard_error, speedup } = self;
        let percent = |c: usize| format!("{:+.2} ± {:.2}", 100.0 * relative[c], 100.0 * standard_error[c]);
        let grains = match explicit_grains {
            1 => "1 explicit grain".to_owned(),
            n => format!("{n} explicit grains"),
        };
        let mut sentence = format!(
            "  after {grains} the proxy, which is not exact: red {}, green {}, blue {} % against {pairs} explicit paths; \
             {speedup:.1} times as fast",
            percent(0),
            percent(1),
            percent(2)
        );
        if *faults > 0 {
            // Writing to a string cannot fail.
            let _ = write!(sentence, "; {faults} of them found no radiance and do not count");
        }
        sentence
    }
}
