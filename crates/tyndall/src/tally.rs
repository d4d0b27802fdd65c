//! What the paths of a render did: counts that end up in the statistics, and everything that went wrong.

/// A sample that was not a number, infinite or negative: found, located, reported, never hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BadSample {
    /// Column and row.
    pub pixel: (u32, u32),
    /// Index of the sample within the pixel.
    pub index: u32,
    /// Its linear-sRGB value.
    pub value: [f32; 3],
}

/// Sums over paths. Tiles keep their own, merged in a fixed order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// Camera paths.
    pub paths: u64,
    /// Rays traced for paths.
    pub rays: u64,
    /// Rays traced to see whether light arrives.
    pub shadow_rays: u64,
    /// Collisions in media.
    pub collisions: u64,
    /// Surface vertices (boundaries without a material not counted).
    pub surface_vertices: u64,
    /// Paths cut by a depth limit that the user asked for.
    pub truncated_paths: u64,
    /// Σ of the throughput that those paths still carried: with unit radiance all around, the energy lost.
    pub truncated_throughput: f64,
    /// Paths that left a medium without meeting its boundary, by rounding; they end.
    pub leaks: u64,
    /// Crossings into more bodies than a path can keep count of: those count as not there.
    pub lost_bodies: u64,
    /// Number of samples that were not finite or negative.
    pub bad_samples: u64,
    /// The first few of them.
    pub bad_sample_list: Vec<BadSample>,
}

impl Tally {
    /// How many bad samples are kept with their place.
    pub const KEPT: usize = 32;

    /// Notes a sample that is not a radiance.
    pub fn bad_sample(&mut self, pixel: (u32, u32), index: u32, value: [f32; 3]) {
        self.bad_samples += 1;
        if self.bad_sample_list.len() < Self::KEPT {
            self.bad_sample_list.push(BadSample { pixel, index, value });
        }
    }

    /// The sum of two tallies.
    #[must_use]
    pub fn merged(mut self, other: &Self) -> Self {
        self.paths += other.paths;
        self.rays += other.rays;
        self.shadow_rays += other.shadow_rays;
        self.collisions += other.collisions;
        self.surface_vertices += other.surface_vertices;
        self.truncated_paths += other.truncated_paths;
        self.truncated_throughput += other.truncated_throughput;
        self.leaks += other.leaks;
        self.lost_bodies += other.lost_bodies;
        self.bad_samples += other.bad_samples;
        let room = Self::KEPT.saturating_sub(self.bad_sample_list.len());
        self.bad_sample_list.extend(other.bad_sample_list.iter().take(room));
        self
    }

    /// Scattering and surface events a path.
    pub fn mean_path_length(&self) -> f64 {
        (self.collisions + self.surface_vertices) as f64 / self.paths.max(1) as f64
    }
}
