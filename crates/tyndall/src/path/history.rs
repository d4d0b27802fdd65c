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
    /// Free flights whose length was drawn since anything last scattered: more than one where boundaries or holes were
    /// passed straight through.
    pub flights: u32,
    /// Dirac lobes in a row: mirrors and glass since anything last scattered.
    pub specular_run: u32,
    /// Whether the path has gone on with its hero wavelength alone.
    pub parted: bool,
    /// Vertices that a limit on the depth does not count.
    pub passes: u16,
    /// The state of the automaton that takes light apart, if there is one: see [`crate::lpe`].
    pub state: u16,
}

/// Dirac lobes in a row after which light counts as trapped.
const TRAPPED: u32 = 128;
/// Events after which a path counts as endless.
const ENDLESS: u32 = 1 << 20;

impl History {
    /// The probability with which a path goes on that has lost no weight. It is 1, but for light that total reflection
    /// guides around a body without loss, and for light that nothing absorbs and that finds no way out: such paths
    /// would never end by themselves.
    #[inline]
    pub fn survival(&self) -> f32 {
        if self.specular_run >= TRAPPED {
            0.98
        } else if self.vertices >= ENDLESS {
            0.999
        } else {
            1.0
        }
    }

    /// Scattering events as a limit on them counts.
    #[inline]
    pub fn depth(&self) -> u32 {
        self.vertices - u32::from(self.passes)
    }

    /// Notes a free flight whose length was drawn.
    #[inline]
    pub fn flew(&mut self) {
        self.flights = self.flights.saturating_add(1);
    }

    /// Notes collisions that a walk has gone through.
    #[inline]
    pub fn walked(&mut self, collisions: u32) {
        self.vertices = self.vertices.saturating_add(collisions);
        self.order = self.order.saturating_add(collisions);
        if collisions > 0 {
            (self.flights, self.specular_run) = (0, 0);
        }
    }

    /// Notes a scattering by a Dirac lobe, or by another.
    #[inline]
    pub fn scattered(&mut self, specular: bool) {
        self.vertices = self.vertices.saturating_add(1);
        self.flights = 0;
        self.specular_run = if specular { self.specular_run.saturating_add(1) } else { 0 };
    }
}

impl Default for History {
    fn default() -> Self {
        Self { vertices: 0, order: 0, eta_scale: 1.0, flights: 0, specular_run: 0, parted: false, passes: 0, state: 0 }
    }
}
