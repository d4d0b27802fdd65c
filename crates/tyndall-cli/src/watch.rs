//! What happens beside a render: progress, saving the image so far, showing it, and ending early.

use std::{
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    time::{Duration, Instant},
};

use tyndall::{
    film::Film,
    render::{self, Observer},
};

use crate::{interrupt, progress::Progress, tev::Tev};

/// Between two saves of the image so far, at least.
const SAVE_EVERY: Duration = Duration::from_secs(10);
/// Saving may take this part of the time, at most.
const SAVE_SHARE: u32 = 20;
/// Between two images for the viewer, at least.
const SHOW_EVERY: Duration = Duration::from_millis(250);

/// Saves a film.
type Save<'a> = Box<dyn Fn(&Film) -> anyhow::Result<()> + Send + 'a>;

/// Watches one render.
pub(crate) struct Watch<'a> {
    pub(crate) progress: Progress,
    deadline: Option<Instant>,
    /// Whether every pixel has a sample: before, no limit of time ends the render.
    covered: AtomicBool,
    image: Mutex<Image<'a>>,
}

/// What becomes of the image so far.
struct Image<'a> {
    save: Save<'a>,
    next_save: Instant,
    tev: Option<Tev>,
    next_show: Instant,
}

impl<'a> Watch<'a> {
    /// Ends the render after `limit`; saves the image with `save` and shows it in `tev` from time to time.
    pub(crate) fn new(
        progress: Progress,
        limit: Option<Duration>,
        save: impl Fn(&Film) -> anyhow::Result<()> + Send + 'a,
        tev: Option<Tev>,
    ) -> Self {
        let now = Instant::now();
        let image = Image { save: Box::new(save), next_save: now + SAVE_EVERY, tev, next_show: now };
        Self {
            progress,
            // A limit beyond what the clock can hold is none.
            deadline: limit.and_then(|limit| now.checked_add(limit)),
            covered: AtomicBool::new(false),
            image: Mutex::new(image),
        }
    }

    /// Whether the time is up.
    fn late(&self) -> bool {
        self.covered.load(Relaxed) && self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl Observer for Watch<'_> {
    fn cancelled(&self) -> bool {
        interrupt::requested() || self.late()
    }

    fn batch_done(&self, progress: render::Progress) {
        self.progress.tell(progress);
    }

    fn pass_done(&self, film: &Film, progress: render::Progress) {
        if progress.samples >= film.pixels.len() as u64 {
            self.covered.store(true, Relaxed);
        }
        // A poisoned lock means that another thread panicked: the render ends anyway.
        let Ok(mut image) = self.image.lock() else { return };
        let last = progress.samples >= progress.total || self.cancelled();
        image.show(film, last, &self.progress);
        if !last {
            image.save_if_due(film, &self.progress);
        }
    }
}

impl Image<'_> {
    fn show(&mut self, film: &Film, last: bool, progress: &Progress) {
        let Some(tev) = &mut self.tev else { return };
        if !last && Instant::now() < self.next_show {
            return;
        }
        if let Err(error) = tev.show(film) {
            progress.say(&format!("warning: {error:#}; the render goes on without it"));
            self.tev = None;
        }
        self.next_show = Instant::now() + SHOW_EVERY;
    }

    fn save_if_due(&mut self, film: &Film, progress: &Progress) {
        let start = Instant::now();
        if start < self.next_save {
            return;
        }
        if let Err(error) = (self.save)(film) {
            progress.say(&format!("warning: the image so far was not saved: {error:#}"));
        }
        self.next_save = Instant::now() + SAVE_EVERY.max(start.elapsed() * SAVE_SHARE);
    }
}
