//! What is told about a finished render: numbers for programs (`--json`), sentences for people.

use serde::Serialize;
use tyndall::{film::Film, tally::Tally};
use tyndall_formats::film::{Image, Metadata};

use crate::{
    beside::Difference,
    progress::time,
    statistics::{MeanColor, mean_color},
};

/// Statistics of a render, as `--json` writes them.
#[derive(Debug, Serialize)]
pub(crate) struct Statistics {
    pub(crate) version: String,
    pub(crate) scene: String,
    pub(crate) scene_hash: String,
    pub(crate) integrator: String,
    pub(crate) color: String,
    pub(crate) sampler: String,
    pub(crate) seed: u64,
    pub(crate) threads: usize,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// `x0,y0,x1,y1` [pixels].
    pub(crate) crop: String,
    /// The files of the image.
    pub(crate) outputs: Vec<String>,
    pub(crate) ended: End,
    /// Samples a pixel that were taken, in the mean.
    pub(crate) spp: f64,
    /// Before the first ray.
    pub(crate) startup_seconds: Startup,
    /// The render alone, without reading the scene.
    pub(crate) wall_seconds: f64,
    /// Of all threads, the render alone.
    pub(crate) cpu_seconds: f64,
    pub(crate) image: MeanColor,
    /// Mean standard error of a pixel / mean of the image; infinite (null) below two samples a pixel.
    pub(crate) relative_error: f64,
    pub(crate) paths: u64,
    pub(crate) paths_per_second: f64,
    pub(crate) rays: u64,
    pub(crate) shadow_rays: u64,
    pub(crate) collisions: u64,
    pub(crate) surface_vertices: u64,
    /// Collisions and surface vertices of a path.
    pub(crate) mean_path_length: f64,
    /// CPU time of the whole render / collisions [ns]; none without collisions.
    pub(crate) ns_per_collision: Option<f64>,
    /// Paths that a limit on their length cut short.
    pub(crate) truncated_paths: u64,
    /// Throughput that they still carried, a path: the energy lost where everything around shines with radiance 1.
    pub(crate) energy_lost_to_limit: f64,
    /// Paths that left a medium without meeting its boundary, by rounding, and ended there.
    pub(crate) leaks: u64,
    /// Crossings into more bodies than a path can keep count of.
    pub(crate) lost_bodies: u64,
    /// Where grains have a proxy: what that does to the picture, and what it saves.
    pub(crate) proxy: Option<Difference>,
    /// Samples that were not a radiance (NaN, infinite or negative) and count as zero.
    pub(crate) non_finite_samples: u64,
    /// The first of them.
    pub(crate) non_finite_list: Vec<BadSample>,
}

/// How a render ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum End {
    /// All samples were taken.
    Complete,
    /// The time was up.
    Time,
    /// Ctrl-C.
    Interrupted,
}

/// Time before the first ray [s].
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Startup {
    /// Reading the scene's own files.
    pub(crate) load: f64,
    /// Meshes, images, tables, the BVH.
    pub(crate) build: f64,
}

/// A sample that was not a radiance.
#[derive(Debug, Serialize)]
pub(crate) struct BadSample {
    pub(crate) pixel: (u32, u32),
    pub(crate) index: u32,
    /// Words, for JSON knows neither NaN nor infinity.
    pub(crate) value: [String; 3],
}

/// How the render went, apart from what the image and its metadata tell.
#[derive(Debug)]
pub(crate) struct Course {
    pub(crate) threads: usize,
    pub(crate) outputs: Vec<String>,
    pub(crate) ended: End,
    pub(crate) startup: Startup,
    pub(crate) cpu_seconds: f64,
    pub(crate) proxy: Option<Difference>,
}

impl Statistics {
    pub(crate) fn new(image: &Image, metadata: Metadata, tally: &Tally, course: Course) -> Self {
        let mean = mean_color(image);
        let wall_seconds = metadata.wall_seconds;
        Self {
            version: metadata.version,
            scene: metadata.scene,
            scene_hash: metadata.scene_hash,
            integrator: metadata.integrator,
            color: metadata.color,
            sampler: metadata.sampler,
            seed: metadata.seed,
            threads: course.threads,
            width: image.width,
            height: image.height,
            crop: metadata.crop,
            outputs: course.outputs,
            ended: course.ended,
            spp: metadata.samples_per_pixel,
            startup_seconds: course.startup,
            wall_seconds,
            cpu_seconds: course.cpu_seconds,
            relative_error: relative_error(image, &mean),
            image: mean,
            paths: tally.paths,
            paths_per_second: tally.paths as f64 / wall_seconds,
            rays: tally.rays,
            shadow_rays: tally.shadow_rays,
            collisions: tally.collisions,
            surface_vertices: tally.surface_vertices,
            mean_path_length: tally.mean_path_length(),
            ns_per_collision: (tally.collisions > 0).then(|| 1e9 * course.cpu_seconds / tally.collisions as f64),
            truncated_paths: tally.truncated_paths,
            energy_lost_to_limit: tally.truncated_throughput / tally.paths.max(1) as f64,
            leaks: tally.leaks,
            lost_bodies: tally.lost_bodies,
            proxy: course.proxy,
            non_finite_samples: tally.bad_samples,
            non_finite_list: tally.bad_sample_list.iter().map(BadSample::from).collect(),
        }
    }

    /// The render in a few lines.
    pub(crate) fn sentences(&self) -> String {
        let mut lines = vec![
            format!("{} in {}", self.outputs.join(" and "), time(self.wall_seconds)),
            format!(
                "  {} spp, {}; {}; {} thread{}, {:.2} CPU seconds",
                Short(self.spp),
                self.how_it_ended(),
                self.error_in_words(),
                self.threads,
                if self.threads == 1 { "" } else { "s" },
                self.cpu_seconds,
            ),
            format!(
                "  {} rays, {} shadow rays, {} collisions; a path has {:.1} events",
                count(self.rays),
                count(self.shadow_rays),
                count(self.collisions),
                self.mean_path_length,
            ),
        ];
        lines.extend(self.proxy.as_ref().map(Difference::sentence));
        if self.truncated_paths > 0 {
            lines.push(format!(
                "  the depth limit cut {} paths; under light of radiance 1 all around that loses {:.3e} a path",
                count(self.truncated_paths),
                self.energy_lost_to_limit,
            ));
        }
        if self.leaks > 0 {
            lines.push(format!("  warning: {} paths left a medium without meeting its boundary", count(self.leaks)));
        }
        if self.lost_bodies > 0 {
            let lost = count(self.lost_bodies);
            lines.push(format!(
                "  warning: {lost} times a path entered a body while in eight others: it counted as not there"
            ));
        }
        if let Some(first) = self.non_finite_list.first() {
            lines.push(format!(
                "  warning: {} samples were not a radiance and count as zero; the first: pixel {},{} sample {} = [{}]",
                self.non_finite_samples,
                first.pixel.0,
                first.pixel.1,
                first.index,
                first.value.join(", "),
            ));
        }
        lines.join("\n")
    }

    fn error_in_words(&self) -> String {
        if self.relative_error.is_finite() {
            format!("pixel error {:.2} % of the mean", 100.0 * self.relative_error)
        } else {
            "the pixel error shows from two samples on".into()
        }
    }

    fn how_it_ended(&self) -> &'static str {
        match self.ended {
            End::Complete => "complete",
            End::Time => "as many as the time gave",
            End::Interrupted => "stopped",
        }
    }
}

impl From<&tyndall::tally::BadSample> for BadSample {
    fn from(sample: &tyndall::tally::BadSample) -> Self {
        Self { pixel: sample.pixel, index: sample.index, value: sample.value.map(|v| v.to_string()) }
    }
}

/// Mean number of samples a pixel.
pub(crate) fn samples_per_pixel(film: &Film) -> f64 {
    film.pixels.iter().map(|p| p.count as f64).sum::<f64>() / film.pixels.len().max(1) as f64
}

/// Mean standard error of a pixel over the mean of the image, all channels together.
fn relative_error(image: &Image, mean: &MeanColor) -> f64 {
    let Some(errors) = &image.standard_error else { return f64::NAN };
    let error = errors.iter().flatten().map(|&e| f64::from(e)).sum::<f64>() / (3 * errors.len()).max(1) as f64;
    error / (mean.rgb.iter().sum::<f64>() / 3.0)
}

/// A number with few digits: `16`, `16.37`.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.fract() == 0.0 { write!(f, "{}", self.0) } else { write!(f, "{:.2}", self.0) }
    }
}

/// `12`, `3.4 k`, `5.67 M`, `8.90 G`.
fn count(n: u64) -> String {
    match n as f64 {
        x if x >= 1e9 => format!("{:.2} G", x / 1e9),
        x if x >= 1e6 => format!("{:.2} M", x / 1e6),
        x if x >= 1e4 => format!("{:.1} k", x / 1e3),
        _ => n.to_string(),
    }
}
