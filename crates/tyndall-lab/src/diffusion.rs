//! What diffusion theory says of a narrow beam that falls straight on a half-space: the light `R(r)` [1/length²] that leaves
//! per area at a distance `r`, of a beam of power 1 *inside* of the surface (what falls on it times `1 − F(1)`).
//!
//! With `σ_s′ = (1 − g) σ_s`, `σ_t′ = σ_a + σ_s′`, `α′ = σ_s′/σ_t′`, a source at depth `z`, its image at `−z − 2 z_b` outside,
//! and `d` the distance to either:
//!
//! | model | diffusion coefficient D | boundary | source | exitance |
//! |---|---|---|---|---|
//! | [`Model::Classical`] (Jensen, Marschner, Levoy and Hanrahan 2001, eq. 4) | `1/(3 σ_t′)` | `z_b = 2AD`, `A` from a fit of the Fresnel reflectance | at `1/σ_t′`, power `α′` | flux |
//! | [`Model::Better`] (d'Eon 2012, "A better dipole") | Grosjean's `(2σ_a + σ_s′)/(3 σ_t′²)` | `A = (1 + 3C₂)/(1 − 2C₁)`, exact moments | at `1/σ_t′`, power `α′²` | `C_φ φ + C_E E` |
//! | [`Model::Beam`] (Habel, Christensen and Jarosz 2013, "Photon beam diffusion") | Grosjean's | the same | all along the beam, `α′² σ_t′ exp(−σ_t′ z)`, faded near it by `1 − exp(−2σ_t′(d + z))` | the same, and single scattering exactly |
//!
//! `σ_tr = √(σ_a/D)`, `C_φ = (1 − 2C₁)/4`, `C_E = (1 − 3C₂)/2`, and `C_n = ∫ F(μ) μⁿ dμ` the moments of the reflectance of the
//! surface seen from inside.
//!
//! They are approximations, drawn beside what is measured so that one can see where they fail: near the beam, and where
//! absorption is strong.

use std::f64::consts::{FRAC_PI_2, PI};

use tyndall::bsdf::fresnel;
use tyndall::phase::Phase;

use crate::world::{SetupError, Substance};

/// Points of each integral.
const POINTS: u32 = 200;
/// Points across a ring.
const ACROSS: u32 = 24;

/// A model of diffusion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Model {
    /// The classical dipole.
    Classical,
    /// The better dipole.
    Better,
    /// Photon beam diffusion, with single scattering.
    Beam,
}

impl Model {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Classical, Self::Better, Self::Beam];

    /// Its name in a legend.
    pub fn name(self) -> &'static str {
        match self {
            Self::Classical => "classical dipole",
            Self::Better => "better dipole",
            Self::Beam => "photon beam diffusion",
        }
    }
}

/// A half-space as diffusion sees it.
#[derive(Debug, Clone)]
pub struct HalfSpace {
    substance: Substance,
    phase: Phase,
    /// `σ_s′`, `σ_t′` [1/length].
    reduced: [f64; 2],
    /// The moments `C₁` and `C₂`.
    moments: [f64; 2],
}

impl HalfSpace {
    /// Of a substance that scatters, in air.
    ///
    /// # Errors
    /// The substance cannot be.
    pub fn new(substance: &Substance) -> Result<Self, SetupError> {
        substance.check()?;
        let sigma_s = (1.0 - substance.g) * substance.sigma_s;
        Ok(Self {
            substance: *substance,
            phase: Phase::henyey_greenstein(substance.g as f32)?,
            reduced: [sigma_s, substance.sigma_a + sigma_s],
            moments: [1, 2].map(|n| moment(substance.n, n)),
        })
    }

    /// The mean of `R` over the ring between two radii [1/length²].
    pub fn ring(&self, model: Model, [inner, outer]: [f64; 2]) -> f64 {
        let at = |i: u32| inner + (outer - inner) * (f64::from(i) + 0.5) / f64::from(ACROSS);
        let (sum, area) =
            (0..ACROSS).map(at).fold((0.0, 0.0), |(sum, area), r| (sum + r * self.at(model, r), area + r));
        sum / area
    }

    /// `R` at a distance [1/length²].
    pub fn at(&self, model: Model, r: f64) -> f64 {
        match model {
            Model::Classical => self.classical(r),
            Model::Better => self.better(r),
            Model::Beam => self.multiple_along_beam(r) + self.single(r),
        }
    }

    fn albedo(&self) -> f64 {
        let [sigma_s, sigma_t] = self.reduced;
        if sigma_t > 0.0 { sigma_s / sigma_t } else { 0.0 }
    }

    fn classical(&self, r: f64) -> f64 {
        let [_, sigma_t] = self.reduced;
        let eta = self.substance.n;
        let reflected = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
        let a = (1.0 + reflected) / (1.0 - reflected);
        let sigma_tr = (3.0 * self.substance.sigma_a * sigma_t).sqrt();
        let pole = |z: f64| flux(z, r, sigma_tr);
        self.albedo() * (pole(1.0 / sigma_t) + pole((1.0 + 4.0 / 3.0 * a) / sigma_t))
    }

    fn better(&self, r: f64) -> f64 {
        self.albedo().powi(2) * self.dipole(1.0 / self.reduced[1], r)
    }

    /// What leaves of a point source of power 1 at depth `z`, by Grosjean's diffusion.
    fn dipole(&self, z: f64, r: f64) -> f64 {
        let ([sigma_s, sigma_t], [c1, c2]) = (self.reduced, self.moments);
        let d = (2.0 * self.substance.sigma_a + sigma_s) / (3.0 * sigma_t * sigma_t);
        let sigma_tr = (self.substance.sigma_a / d).sqrt();
        let image = z + 4.0 * d * (1.0 + 3.0 * c2) / (1.0 - 2.0 * c1);
        let fluence = (point(z, r, sigma_tr) - point(image, r, sigma_tr)) / d;
        let flux = flux(z, r, sigma_tr) + flux(image, r, sigma_tr);
        0.25 * (1.0 - 2.0 * c1) * fluence + 0.5 * (1.0 - 3.0 * c2) * flux
    }

    fn multiple_along_beam(&self, r: f64) -> f64 {
        let [_, sigma_t] = self.reduced;
        let part = |z: f64| {
            let faded = -(-2.0 * sigma_t * (r.hypot(z) + z)).exp_m1();
            faded * self.dipole(z, r)
        };
        // Midpoints of equal parts of the probability to be scattered.
        self.albedo().powi(2) * mean(|u| part(-(-u).ln_1p() / sigma_t))
    }

    /// Scattered once: straight down to a depth `z = r tan ψ`, and straight to the surface.
    fn single(&self, r: f64) -> f64 {
        let Substance { sigma_s, n, .. } = self.substance;
        let sigma_t = self.substance.sigma_t();
        // From less deep than this all light is reflected back.
        let first = (n * n - 1.0).max(0.0).sqrt().atan();
        let part = |u: f64| {
            let (sin, cos) = (first + (FRAC_PI_2 - first) * u).sin_cos();
            let phase = f64::from(self.phase.eval(-sin as f32));
            phase * (1.0 - internal(n, sin)) * sin * (-sigma_t * r * (1.0 + sin) / cos).exp()
        };
        sigma_s / r * (FRAC_PI_2 - first) * mean(part)
    }
}

/// `∫ f(u) du` over [0, 1] at midpoints.
fn mean(f: impl Fn(f64) -> f64) -> f64 {
    (0..POINTS).map(|i| f((f64::from(i) + 0.5) / f64::from(POINTS))).sum::<f64>() / f64::from(POINTS)
}

/// `exp(−σ_tr d)/(4πd)`.
fn point(z: f64, r: f64, sigma_tr: f64) -> f64 {
    let d = r.hypot(z);
    (-sigma_tr * d).exp() / (4.0 * PI * d)
}

/// The flux through the surface from a source at depth `z`, of a medium without end.
fn flux(z: f64, r: f64, sigma_tr: f64) -> f64 {
    let d = r.hypot(z);
    z * (1.0 + sigma_tr * d) / (d * d) * point(z, r, sigma_tr)
}

/// The reflectance \[1\] of the surface of a body of index `n`, seen from inside at a cosine.
fn internal(n: f64, cosine: f64) -> f64 {
    if n == 1.0 { 0.0 } else { f64::from(fresnel::dielectric(cosine as f32, (1.0 / n) as f32).reflectance) }
}

/// `∫ F μⁿ dμ` over [0, 1]: by parts on either side of the critical angle, behind which all is reflected.
fn moment(n: f64, order: i32) -> f64 {
    let critical = if n > 1.0 { (1.0 - 1.0 / (n * n)).sqrt() } else { 0.0 };
    let whole = critical.powi(order + 1) / f64::from(order + 1);
    // The reflectance starts from the critical angle like a root: squares of the variable make it smooth.
    whole
        + (1.0 - critical)
            * mean(|u| {
                let mu = critical + (1.0 - critical) * u * u;
                2.0 * u * internal(n, mu) * mu.powi(order)
            })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::table::rows;

    const RINGS: &str = include_str!("../data/mcml_R_of_r.csv");
    const MEDIA: &str = include_str!("../data/mcml_totals_vs_adding.csv");

    /// Every ring of the reference table has the models' values, which another program computed.
    #[test]
    fn the_models_are_those_of_the_papers() {
        let media = rows(MEDIA);
        let mut compared = 0;
        for ring in rows(RINGS) {
            let Some(medium) = media.iter().find(|row| row.word("case") == ring.word("case")) else { continue };
            if medium.number("thickness") < 1e7 {
                continue;
            }
            let [n, sigma_a, sigma_s, g] = ["n", "mu_a", "mu_s", "g"].map(|column| medium.number(column));
            let half_space = HalfSpace::new(&Substance { sigma_a, sigma_s, g, n }).unwrap();
            let edges = ["r_lo", "r_hi"].map(|column| ring.number(column));
            for (column, model) in [("dip_classic", Model::Classical), ("dip_better", Model::Better)] {
                let (found, expected) = (half_space.ring(model, edges), ring.number(column));
                let error = (found / expected - 1.0).abs();
                assert!(error < 2e-3, "{column} of {} at {edges:?}: {found} for {expected}", ring.word("case"));
                compared += 1;
            }
            // The table's sum over the beam is one of 100 terms, and worth no more than this.
            let expected = ring.number("pbd_ms") + ring.number("ss_exact");
            let found = half_space.ring(Model::Beam, edges);
            let place = format!("{} at {edges:?}: {found} for {expected}", ring.word("case"));
            assert!((found / expected - 1.0).abs() < 1e-2, "{place}");
        }
        assert!(compared > 400, "{compared}");
    }
}
