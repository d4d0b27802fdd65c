//! How far the render is: a bar on a terminal, a line every few seconds elsewhere.

use std::{
    fmt::Write,
    io::IsTerminal,
    sync::{
        Mutex,
        atomic::{AtomicU64, Ordering::Relaxed},
    },
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressStyle};
use tyndall::render;

/// Between two lines where there is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// Steps of the bar.
const STEPS: u64 = 10_000;

/// Tells a person how far a render is. Samples may be told from any thread.
#[derive(Debug)]
pub(crate) struct Progress {
    start: Instant,
    pixels: u64,
    limit: Option<Duration>,
    /// Whether the number of samples is bounded, so that it tells how much is left.
    counted: bool,
    samples: AtomicU64,
    show: Show,
}

#[derive(Debug)]
enum Show {
    Nothing,
    Bar(ProgressBar),
    Lines { last: Mutex<Instant> },
}

impl Progress {
    /// Of a render of so many pixels, that ends after a time, a number of samples, or both.
    pub(crate) fn new(pixels: u64, limit: Option<Duration>, counted: bool, quiet: bool) -> Self {
        let show = if quiet {
            Show::Nothing
        } else if std::io::stderr().is_terminal() {
            Show::Bar(bar())
        } else {
            Show::Lines { last: Mutex::new(Instant::now()) }
        };
        Self { start: Instant::now(), pixels: pixels.max(1), limit, counted, samples: AtomicU64::new(0), show }
    }

    /// Notes samples, and shows them if it is time.
    pub(crate) fn tell(&self, progress: render::Progress) {
        self.samples.fetch_max(progress.samples, Relaxed);
        match &self.show {
            Show::Nothing => {}
            Show::Bar(bar) => {
                bar.set_position((self.fraction(progress.total) * STEPS as f64) as u64);
                // Redrawing is limited in frequency by the bar; the words are cheap beside a tile.
                bar.set_message(self.words(progress.total));
            }
            Show::Lines { last } => {
                // Another thread that holds the lock is just printing: then there is nothing left to say.
                let Ok(mut last) = last.try_lock() else { return };
                if last.elapsed() >= LINE_EVERY {
                    *last = Instant::now();
                    let percent = 100.0 * self.fraction(progress.total);
                    eprintln!("{percent:3.0} %  {}", self.words(progress.total));
                }
            }
        }
    }

    /// Takes the bar off the screen.
    pub(crate) fn finish(&self) {
        if let Show::Bar(bar) = &self.show {
            bar.finish_and_clear();
        }
    }

    /// Says something without tearing the bar.
    pub(crate) fn say(&self, line: &str) {
        match &self.show {
            Show::Nothing => {}
            Show::Bar(bar) => bar.suspend(|| eprintln!("{line}")),
            Show::Lines { .. } => eprintln!("{line}"),
        }
    }

    /// The part that is done, by whichever limit is nearer.
    fn fraction(&self, total: u64) -> f64 {
        let by_samples = if self.counted { self.samples.load(Relaxed) as f64 / total.max(1) as f64 } else { 0.0 };
        let by_time = self.limit.map_or(0.0, |limit| self.start.elapsed().as_secs_f64() / limit.as_secs_f64());
        by_samples.max(by_time).min(1.0)
    }

    /// `12.3 of 64 spp   1.25 Msamples/s   about 40 s left`.
    fn words(&self, total: u64) -> String {
        let elapsed = self.start.elapsed().as_secs_f64();
        let samples = self.samples.load(Relaxed) as f64;
        let mut words = format!("{:.1} ", samples / self.pixels as f64);
        if self.counted {
            // Writing to a string cannot fail.
            let _ = write!(words, "of {} ", total / self.pixels);
        }
        let _ = write!(words, "spp   {}", rate(samples / elapsed.max(1e-9)));
        let done = self.fraction(total);
        if done > 0.0 {
            let _ = write!(words, "   {} left", time(elapsed * (1.0 - done) / done));
        }
        words
    }
}

fn bar() -> ProgressBar {
    let style =
        ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(STEPS).with_style(style)
}

/// Samples a second, in units that keep the number short.
fn rate(samples_per_second: f64) -> String {
    match samples_per_second {
        r if r >= 1e6 => format!("{:.2} Msamples/s", r / 1e6),
        r if r >= 1e3 => format!("{:.1} ksamples/s", r / 1e3),
        r => format!("{r:.0} samples/s"),
    }
}

/// A time for people: `0.4 s`, `12 s`, `3 min 5 s`, `2 h 10 min`.
pub(crate) fn time(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match seconds {
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 59.5 => format!("{whole} s"),
        s if s < 3570.0 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", (whole + 30) / 3600, (whole + 30) / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_as_people_tell_them() {
        assert_eq!(time(0.44), "0.4 s");
        assert_eq!(time(12.3), "12 s");
        assert_eq!(time(59.7), "1 min 0 s");
        assert_eq!(time(185.0), "3 min 5 s");
        assert_eq!(time(7800.0), "2 h 10 min");
    }

    #[test]
    fn the_nearer_limit_tells_how_much_is_done() {
        let hour = Some(Duration::from_hours(1));
        let both = Progress::new(100, hour, true, true);
        both.tell(render::Progress { samples: 300, total: 400 });
        assert!((both.fraction(400) - 0.75).abs() < 1e-9);
        assert!(both.words(400).starts_with("3.0 of 4 spp"));
        let timed = Progress::new(100, hour, false, true);
        timed.tell(render::Progress { samples: 300, total: 400 });
        assert!(timed.fraction(400) < 1e-3);
    }
}
