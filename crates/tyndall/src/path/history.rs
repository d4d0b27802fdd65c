//! What a path has been through.

/// Counts of the events of a path so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    /// Scattering events: collisions and surfaces (boundaries without a material do not count).
    pub vertices: u32,
    /// Collisions in media: the scattering order.
    pub order: u32,
    /// Product of `1/η²` over the boundaries crossed, undone: radiance is compressed in glass, and roulette must not
    /// take that for a loss [1].
    pub eta_scale: f32,
    /// Whether the path has gone on with its hero wavelength alone.
    pub parted: bool,
}

impl Default for History {
    fn default() -> Self {
        Self { vertices: 0, order: 0, eta_scale: 1.0, parted: false }
    }
}
