//! Plane layers under a beam: what is reflected, transmitted and absorbed, and where.
//!
//! ```text
//!        beam            z = 0 is the upper surface, z grows downwards; the beam falls on the origin
//!          │  index above
//!  ────────┼──────────── 0
//!          │  layer 0
//!  ────────┼──────────── thickness of layer 0
//!          ⋮
//!  ────────┼────────────
//!             index below (none, if the last layer goes on for ever)
//! ```
//!
//! Light that never collides is *specular* (reflected, after any number of reflections inside) or *unscattered*
//! (transmitted); the rest is *diffuse*. MCML (Wang, Jacques and Zheng 1995) counts as specular only what the first surface
//! reflects: [`Measured::first_surface`] tells it, so that `MCML's R_d = specular + diffuse − first_surface`.

mod detector;

use glam::DVec3;
use tyndall::math::{Ray, Vec3};
use tyndall::scene::Scene;

use crate::photon::shoot;
use crate::point::source_stream;
use crate::run::{Estimate, Sums, Verdict};
use crate::world::{SetupError, Substance, World, within};
use detector::{Layout, Recorder};

/// A layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// What it is made of.
    pub substance: Substance,
    /// How thick it is [length]; infinite for a half-space, which must be the last.
    pub thickness: f64,
}

/// How the light comes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Incidence {
    /// A beam at this cosine to the normal \[1\], in (0, 1].
    Beam(f64),
    /// The same radiance from all directions of the half-space above.
    Diffuse,
    /// Power `(k + 1) μᵏ` per cosine μ to the normal: k = 1 is diffuse light, k = 0 what a plane of isotropic sources sends.
    Power(f64),
}

/// An experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// From top to bottom.
    pub layers: Vec<Layer>,
    /// Index above \[1\].
    pub n_above: f64,
    /// Index below \[1\].
    pub n_below: f64,
    /// How the light comes in.
    pub incidence: Incidence,
    /// How finely it is told where light ends up.
    pub bins: Bins,
}

/// Where light that ends up is told apart. What has no bins is not told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bins {
    /// Bins of the exit angle, from 0 to 90°.
    pub angles: usize,
    /// Radii at which light leaves [length].
    pub radii: Edges,
    /// Depths [length].
    pub depths: Edges,
    /// Scattering orders that are kept apart, from 0 on.
    pub orders: usize,
    /// Lengths of the way from surface to surface [length].
    pub lengths: Edges,
}

/// The ends of bins, which lie side by side: `n + 1` numbers for `n` bins, increasing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edges(pub Vec<f64>);

impl Edges {
    /// Bins of one width from 0 on.
    pub fn uniform(count: usize, width: f64) -> Self {
        if count == 0 { Self::default() } else { Self((0..=count).map(|i| i as f64 * width).collect()) }
    }

    /// How many bins there are.
    pub fn count(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// The bin of a value.
    pub fn find(&self, value: f64) -> Option<usize> {
        let above = self.0.partition_point(|edge| *edge <= value);
        (1..self.0.len()).contains(&above).then(|| above - 1)
    }

    /// The ends of a bin.
    pub fn bin(&self, index: usize) -> [f64; 2] {
        [self.0[index], self.0[index + 1]]
    }

    pub(crate) fn check(&self) -> Result<(), SetupError> {
        within("a number of bins", self.count() as f64, "at most 100000", |count| count <= Bins::MOST as f64)?;
        let unordered = self.0.windows(2).find(|w| !(w[0] >= 0.0 && w[0] < w[1] && w[1].is_finite()));
        unordered.map_or(Ok(()), |w| {
            within("an edge of a bin", w[1], "at least 0, and greater than the one before", |_| false)
        })
    }
}

/// What was measured. Parts are of the light that was sent in \[1\].
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Photons.
    pub photons: u64,
    /// Collisions, all together.
    pub collisions: u64,
    /// Reflected without a collision.
    pub specular: Estimate,
    /// What the first surface alone reflects, by Fresnel's equations; for diffuse light by integration.
    pub first_surface: f64,
    /// Reflected after collisions.
    pub diffuse: Estimate,
    /// All that is reflected.
    pub reflectance: Estimate,
    /// Transmitted without a collision.
    pub unscattered: Estimate,
    /// Transmitted after collisions.
    pub diffuse_transmittance: Estimate,
    /// All that is transmitted.
    pub transmittance: Estimate,
    /// Absorbed, by layer.
    pub absorbed: Vec<Estimate>,
    /// Reflected per solid angle by exit angle \[1/sr\], after collisions.
    pub reflectance_by_angle: Vec<Estimate>,
    /// Transmitted per solid angle by exit angle \[1/sr\], unscattered light included.
    pub transmittance_by_angle: Vec<Estimate>,
    /// Reflected per area by radius [1/length²], after collisions.
    pub reflectance_by_radius: Vec<Estimate>,
    /// Transmitted per area by radius [1/length²], unscattered light included.
    pub transmittance_by_radius: Vec<Estimate>,
    /// Mean fluence by depth \[1\]: power per area that crosses from all sides, over the irradiance.
    pub fluence: Vec<Estimate>,
    /// Reflected by scattering order.
    pub reflectance_by_order: Vec<Estimate>,
    /// Transmitted by scattering order.
    pub transmittance_by_order: Vec<Estimate>,
    /// Reflected per length of the way [1/length].
    pub reflectance_by_length: Vec<Estimate>,
    /// Transmitted per length of the way [1/length].
    pub transmittance_by_length: Vec<Estimate>,
}

/// Does the experiment.
///
/// # Errors
/// A number is out of its range, or there is no layer.
pub fn measure(
    setup: &Setup,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Result<Measured, SetupError> {
    setup.check()?;
    Ok(measure_in(&setup.scene()?, setup, photons, seed, look))
}

/// The same in a scene that is made already.
pub(crate) fn measure_in(
    scene: &Scene,
    setup: &Setup,
    photons: u64,
    seed: u64,
    look: impl FnMut(&Sums) -> Verdict,
) -> Measured {
    let layout = Layout::new(setup);
    let recorder = || Recorder::new(setup, &layout);
    let sums = shoot(scene, photons, seed, |photon| setup.ray(photon, seed), recorder, look);
    layout.read(setup, &sums)
}

impl Setup {
    /// One layer in air, seen from above.
    pub fn one(substance: Substance, thickness: f64, incidence: Incidence) -> Self {
        let layers = vec![Layer { substance, thickness }];
        Self { layers, n_above: 1.0, n_below: 1.0, incidence, bins: Bins::default() }
    }

    /// Whether it can be.
    ///
    /// # Errors
    /// It cannot.
    pub fn check(&self) -> Result<(), SetupError> {
        if self.layers.is_empty() {
            return Err(SetupError::Missing("layer"));
        }
        let last = self.layers.len() - 1;
        for (i, layer) in self.layers.iter().enumerate() {
            layer.substance.check()?;
            if i < last {
                within("the thickness of a layer above others", layer.thickness, "positive and finite", |d| {
                    d > 0.0 && d.is_finite()
                })?;
            }
            within("the thickness of a layer", layer.thickness, "positive", |d| d > 0.0)?;
        }
        for n in [self.n_above, self.n_below] {
            Substance { n, ..Substance::VACUUM }.check()?;
        }
        if let Incidence::Beam(cosine) = self.incidence {
            within("the cosine of the incidence", cosine, "greater than 0, and at most 1", |c| c > 0.0 && c <= 1.0)?;
        }
        if let Incidence::Power(k) = self.incidence {
            within("the power of the cosine", k, "at least 0, and at most 100", |k| (0.0..=100.0).contains(&k))?;
        }
        self.bins.check()
    }

    /// The world of the layers.
    pub(crate) fn scene(&self) -> Result<Scene, SetupError> {
        let mut world = World::default();
        let radius = self.radius();
        let around = |n| Substance { n, ..Substance::VACUUM };
        let mut above = around(self.n_above);
        let mut depth = 0.0;
        for layer in &self.layers {
            world.plane(-depth, radius, &above, &layer.substance)?;
            (above, depth) = (layer.substance, depth + layer.thickness);
        }
        if depth.is_finite() {
            world.plane(-depth, radius, &above, &around(self.n_below))?;
        }
        world.build(&around(self.n_above), self.height() * DVec3::Z)
    }

    /// How wide the planes are [length]: light that gets farther is lost, and counted.
    fn radius(&self) -> f64 {
        let free_paths =
            self.layers.iter().map(|layer| layer.substance.sigma_t()).filter(|s| *s > 0.0).map(|s| 1.0 / s);
        let sizes = self.layers.iter().map(|layer| layer.thickness).filter(|d| d.is_finite()).chain(free_paths);
        1e6 * sizes.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The way of a photon before the first surface.
    pub(crate) fn ray(&self, photon: u64, seed: u64) -> Ray {
        let cosine = match self.incidence {
            Incidence::Beam(cosine) => cosine as f32,
            Incidence::Diffuse => source_stream(photon, seed).next_positive().sqrt(),
            Incidence::Power(k) => source_stream(photon, seed).next_positive().powf(1.0 / (k as f32 + 1.0)),
        };
        let dir = Vec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, -cosine);
        Ray::new(-dir * self.height() as f32, dir)
    }

    /// From how far photons are sent [length].
    fn height(&self) -> f64 {
        1e-6 * self.radius()
    }

    /// Down to where the layers reach [length].
    fn depth(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness).sum()
    }
}

impl Bins {
    /// The most bins of one kind: what is kept for each batch has to stay small.
    const MOST: usize = 100_000;

    fn check(&self) -> Result<(), SetupError> {
        for count in [self.angles, self.orders] {
            within("a number of bins", count as f64, "at most 100000", |_| count <= Self::MOST)?;
        }
        [&self.radii, &self.depths, &self.lengths].into_iter().try_for_each(Edges::check)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn enough(_: &Sums) -> Verdict {
        Verdict::GoOn
    }

    /// All that is sent in comes out or stays: of two layers with different indices and a half-space below.
    #[test]
    fn what_goes_in_comes_out_or_stays() {
        let layer =
            |sigma_a, n, thickness| Layer { substance: Substance { sigma_a, sigma_s: 5.0, g: 0.6, n }, thickness };
        let mut setup = Setup::one(Substance::VACUUM, 1.0, Incidence::Beam(0.7));
        setup.layers = vec![layer(0.2, 1.3, 0.5), layer(1.0, 1.6, 0.2), layer(0.1, 1.4, f64::INFINITY)];
        let m = measure(&setup, 40_000, 1, enough).unwrap();
        let kept: f64 = m.absorbed.iter().map(|a| a.mean).sum();
        let all = m.reflectance.mean + m.transmittance.mean + kept;
        // Roulette keeps energy in the mean only.
        let spread = m.absorbed.iter().map(|a| a.standard_error).sum::<f64>() + m.reflectance.standard_error;
        assert!((all - 1.0).abs() < 4.0 * spread, "{all} ± {spread}");
        assert!(m.absorbed.iter().all(|a| a.mean > 0.0));
        assert_eq!(m.transmittance.mean, 0.0);
    }

    /// Photons deep inside walk together where nobody asks for their depths, and one by one with a ray for each flight where
    /// somebody does: both find the same light, by order and by the length of its way too.
    #[test]
    fn walks_find_the_light_that_rays_find() {
        let tissue = Substance { sigma_a: 0.05, sigma_s: 10.0, g: 0.8, n: 1.4 };
        let bins = Bins { orders: 200, lengths: Edges::uniform(8, 2.0), ..Bins::default() };
        let walked = Setup { bins, ..Setup::one(tissue, 8.0, Incidence::Beam(1.0)) };
        let mut traced = walked.clone();
        traced.bins.depths = Edges::uniform(4, 2.0);
        let [walked, traced] =
            [(walked, 1), (traced, 2)].map(|(setup, seed)| measure(&setup, 60_000, seed, enough).unwrap());
        let late = |m: &Measured| m.reflectance_by_order[50..].iter().map(|e| e.mean).sum::<f64>();
        assert!(late(&walked) > 0.05, "most of this light has walked");
        let figures = |m: &Measured| {
            let by_length = [&m.reflectance_by_length[..], &m.transmittance_by_length[6..]].concat();
            [&[m.diffuse, m.transmittance, m.absorbed[0]][..], &by_length, &m.reflectance_by_order[60..64]].concat()
        };
        let z = |(a, b): (Estimate, Estimate)| (a.mean - b.mean) / a.standard_error.hypot(b.standard_error);
        let zs: Vec<f64> = figures(&walked).into_iter().zip(figures(&traced)).map(z).collect();
        // Of 17 figures one is beyond 3.6 once in 180 times.
        assert!(zs.iter().all(|z| z.abs() < 3.6), "{zs:?}");
    }

    /// A sheet of glass without absorption: both faces reflect r = ((n − 1)/(n + 1))², together 2r/(1 + r), and nothing is
    /// diffuse.
    #[test]
    fn a_pane_reflects_what_its_faces_do() {
        let glass = Substance { n: 1.5, ..Substance::VACUUM };
        let m = measure(&Setup::one(glass, 1.0, Incidence::Beam(1.0)), 100_000, 1, enough).unwrap();
        let z = (m.specular.mean - 0.08 / 1.04) / m.specular.standard_error;
        assert!(z.abs() < 4.0, "{:?}", m.specular);
        assert_eq!(m.diffuse.mean, 0.0);
        assert!((m.first_surface - 0.04).abs() < 1e-12);
    }

    #[test]
    fn an_experiment_that_cannot_be_is_refused() {
        let good = Setup::one(Substance::of_albedo(0.9, 0.0), 1.0, Incidence::Beam(1.0));
        let refused = |change: &dyn Fn(&mut Setup)| {
            let mut setup = good.clone();
            change(&mut setup);
            measure(&setup, 1000, 0, enough).unwrap_err().to_string()
        };
        assert!(refused(&|s| s.layers.clear()).contains("there is no layer"));
        assert!(refused(&|s| s.layers[0].thickness = 0.0).contains("thickness"));
        assert!(refused(&|s| s.layers[0].substance.sigma_a = f64::NAN).contains("absorption coefficient"));
        assert!(refused(&|s| s.layers[0].substance.g = 1.0).contains("mean cosine"));
        assert!(refused(&|s| s.incidence = Incidence::Beam(0.0)).contains("incidence"));
        assert!(refused(&|s| s.bins.radii = Edges(vec![0.0, 2.0, 1.0])).contains("edge of a bin"));
    }
}
