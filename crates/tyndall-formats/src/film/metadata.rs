//! How an image was made, as names and texts that fit EXR attributes and PNG text chunks alike.

/// How an image was made. Rendering the same scene with the same settings gives the same bits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Metadata {
    /// Version of tyndall.
    pub version: String,
    /// The scene file, as the user named it.
    pub scene: String,
    /// Hash over every file that the scene read ([`super::hash`]).
    pub scene_hash: String,
    /// Name of the integrator.
    pub integrator: String,
    /// Colour mode: `rgb`, `mono` or `spectral`.
    pub color: String,
    /// Sampler: `sobol` or `independent`.
    pub sampler: String,
    /// Samples a pixel that were asked for; 0 if only a time was.
    pub spp: u32,
    /// Samples a pixel that were taken, in the mean.
    pub samples_per_pixel: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// `x0,y0,x1,y1` [pixels], the last column and row not included.
    pub crop: String,
    /// Time since the render began [s].
    pub wall_seconds: f64,
    /// The command line.
    pub command: String,
}

impl Metadata {
    /// Names and values, in the order of the fields.
    pub fn entries(&self) -> [(&'static str, String); 12] {
        [
            ("tyndall.version", self.version.clone()),
            ("tyndall.scene", self.scene.clone()),
            ("tyndall.scene_hash", self.scene_hash.clone()),
            ("tyndall.integrator", self.integrator.clone()),
            ("tyndall.color", self.color.clone()),
            ("tyndall.sampler", self.sampler.clone()),
            ("tyndall.spp", self.spp.to_string()),
            ("tyndall.samples_per_pixel", self.samples_per_pixel.to_string()),
            ("tyndall.seed", self.seed.to_string()),
            ("tyndall.crop", self.crop.clone()),
            ("tyndall.wall_seconds", self.wall_seconds.to_string()),
            ("tyndall.command", self.command.clone()),
        ]
    }

    /// Reads the entries back. `None` if there is no version: another program wrote the file. Other entries that are
    /// missing or damaged become empty or zero, for an image is worth more than its label.
    pub fn from_entries(text: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let words = |name: &str| text(name).unwrap_or_default();
        Some(Self {
            version: text("tyndall.version")?,
            scene: words("tyndall.scene"),
            scene_hash: words("tyndall.scene_hash"),
            integrator: words("tyndall.integrator"),
            color: words("tyndall.color"),
            sampler: words("tyndall.sampler"),
            spp: words("tyndall.spp").parse().unwrap_or_default(),
            samples_per_pixel: words("tyndall.samples_per_pixel").parse().unwrap_or_default(),
            seed: words("tyndall.seed").parse().unwrap_or_default(),
            crop: words("tyndall.crop"),
            wall_seconds: words("tyndall.wall_seconds").parse().unwrap_or_default(),
            command: words("tyndall.command"),
        })
    }
}
