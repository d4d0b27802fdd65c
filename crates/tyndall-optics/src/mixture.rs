//! Particles in a host: coefficients and phase function of the whole, by wavelength.
//!
//! Spheres of the volume fraction `v` with shares `w_i` of it at the radii `r_i` number `N_i = v w_i/(4/3 π r_i³)`. Particles
//! scatter independently of each other:
//!
//! ```text
//! σ_s = Σ N_i C_s,i     σ_t = σ_a,host + Σ N_i C_t,i     g = Σ N_i C_s,i g_i/σ_s     p = Σ N_i C_s,i p_i/σ_s
//! ```
//!
//! with the cross sections of [`mie`](crate::mie) (`C_t` is what a sphere adds to its host). Valid for dilute mixtures, up to a
//! volume fraction of about 0.1; above it neighbours shade and interfere.
//!
//! Sea water also scatters by its own fluctuations (Morel 1974): `σ_s = 0.00288 (λ/500 nm)^−4.32` per m and
//! `p ∝ 1 + 0.835 cos² θ`.
//!
//! Source: Frisvad, Christensen and Jensen 2007, eq. 8 to 10 and 17.

use std::f64::consts::PI;

use crate::{mie::Sphere, sizes::Sizes, substance::Substance};

/// Spheres of one substance.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// What they are made of.
    pub substance: Substance,
    /// Their part of the whole volume \[1\].
    pub fraction: f64,
    /// How large they are.
    pub sizes: Sizes,
}

/// Particles in a host.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture {
    /// What they swim in.
    pub host: Substance,
    /// Spheres in it, kind by kind.
    pub particles: Vec<Particles>,
}

/// A mixture at one wavelength.
#[derive(Debug, Clone)]
pub struct Bulk {
    /// Absorption [1/m].
    pub sigma_a: f64,
    /// Scattering [1/m].
    pub sigma_s: f64,
    /// Mean cosine, 0 where nothing scatters \[1\].
    pub g: f64,
    /// What scatters, and how much of it [1/m].
    scatterers: Vec<(f64, Scatterer)>,
}

#[derive(Debug, Clone)]
enum Scatterer {
    Sphere(Sphere),
    Molecules,
}

/// Of sea water, Morel 1974: what `cos² θ` adds to 1.
const MOLECULES: f64 = 0.835;

impl Scatterer {
    fn phase(&self, cos_theta: f64) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.phase(cos_theta),
            Self::Molecules => 3.0 / (4.0 * PI * (3.0 + MOLECULES)) * (1.0 + MOLECULES * cos_theta * cos_theta),
        }
    }
}

impl Mixture {
    /// The whole at a wavelength in vacuum [m].
    pub fn at(&self, wavelength: f64) -> Bulk {
        let host = self.host.index(wavelength);
        let mut bulk = Bulk { sigma_a: self.host.absorption(wavelength), sigma_s: 0.0, g: 0.0, scatterers: Vec::new() };
        let mut forward = 0.0;
        for particles in &self.particles {
            let index = particles.substance.index(wavelength);
            for [radius, share] in &particles.sizes.classes {
                let number = particles.fraction * share / (4.0 / 3.0 * PI * radius.powi(3));
                let sphere = Sphere::new(*radius, wavelength, index, host);
                let sigma_s = number * sphere.scattering;
                bulk.sigma_a += number * (sphere.extinction - sphere.scattering);
                bulk.sigma_s += sigma_s;
                forward += sigma_s * sphere.g;
                bulk.scatterers.push((sigma_s, Scatterer::Sphere(sphere)));
            }
        }
        if matches!(self.host, Substance::SeaWater { .. }) {
            let sigma_s = 0.00288 * (wavelength / 500e-9).powf(-4.32);
            bulk.sigma_s += sigma_s;
            bulk.scatterers.push((sigma_s, Scatterer::Molecules));
        }
        if bulk.sigma_s > 0.0 {
            bulk.g = forward / bulk.sigma_s;
        }
        // A clear sphere's extinction is its scattering but for rounding.
        bulk.sigma_a = bulk.sigma_a.max(0.0);
        bulk
    }

    /// `⟨r³⟩/⟨r²⟩` of the largest kind [m], 0 without particles.
    fn largest(&self) -> f64 {
        self.particles.iter().map(|p| p.sizes.effective_radius()).fold(0.0, f64::max)
    }

    /// The phase function that holds for light of several wavelengths [m], at regular cosines from −1 to 1: the one of all
    /// that they scatter, `Σ σ_s p/Σ σ_s`, up to a factor. Empty where nothing scatters.
    ///
    /// Mie's series is summed at the [`angles`] that a peak of the largest particles asks for; its logarithm is linear between.
    pub fn phase(&self, wavelengths: &[f64]) -> Vec<f64> {
        let shortest = wavelengths.iter().copied().fold(f64::INFINITY, f64::min);
        let size = 2.0 * PI * self.largest() / shortest;
        let bulks: Vec<_> = wavelengths.iter().map(|l| self.at(*l)).collect();
        if bulks.iter().all(|bulk| bulk.sigma_s == 0.0) {
            return Vec::new();
        }
        let angles = angles(size);
        let values: Vec<f64> = angles
            .iter()
            .map(|theta| bulks.iter().map(|bulk| bulk.sigma_s * bulk.phase(theta.cos())).sum::<f64>())
            .map(|value| value.max(f64::MIN_POSITIVE).ln())
            .collect();
        let segments = segments(size);
        (0..=segments)
            .map(|i| {
                let theta = (2.0 * i as f64 / segments as f64 - 1.0).clamp(-1.0, 1.0).acos();
                let above = angles.partition_point(|angle| *angle <= theta).clamp(1, angles.len() - 1);
                let share = (theta - angles[above - 1]) / (angles[above] - angles[above - 1]);
                (values[above - 1] + share * (values[above] - values[above - 1])).exp()
            })
            .collect()
    }
}

impl Bulk {
    /// `p(cos θ)` [1/sr], `∫ p dω = 1`; 0 where nothing scatters.
    pub fn phase(&self, cos_theta: f64) -> f64 {
        if self.sigma_s == 0.0 {
            return 0.0;
        }
        self.scatterers.iter().map(|(sigma_s, scatterer)| sigma_s * scatterer.phase(cos_theta)).sum::<f64>()
            / self.sigma_s
    }
}

/// Angles from 0 to π, dense where a sphere of this size parameter has its forward peak and its glory.
fn angles(size: f64) -> Vec<f64> {
    let coarse = (PI / 360.0).min(0.3 / size.max(1.0));
    let mut angles = vec![0.0];
    let mut theta = 0.0;
    while theta < PI {
        // Away from both peaks a distribution of sizes is smooth to half a degree.
        let from_peak = (theta / 20.0).min((PI - theta) / 20.0);
        theta += from_peak.clamp(coarse, PI / 360.0);
        angles.push(theta.min(PI));
    }
    angles
}

/// Regular steps of the cosine, a tenth of the forward peak's `θ²/2` with `θ ≈ 1/size`.
fn segments(size: f64) -> usize {
    ((20.0 * size * size) as usize).next_power_of_two().clamp(1 << 11, 1 << 18)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sizes::tests::gamma_of;

    fn cloud(sizes: Sizes) -> Mixture {
        let particles = Particles { substance: Substance::Water, fraction: 1e-7, sizes };
        Mixture { host: Substance::Air, particles: vec![particles] }
    }

    /// Resonances of droplets are narrower than the classes: four times as many tell what they leave out: 5·10⁻⁴ of
    /// σ_s and 2·10⁻⁴ of g. The manual promises 10⁻³.
    #[test]
    fn coefficients_have_converged_in_the_number_of_sizes() {
        let wavelength = 550e-9;
        let [few, many] =
            [Sizes::gamma(6e-6, 1.0 / 9.0), gamma_of(6e-6, 1.0 / 9.0, 5120)].map(|sizes| cloud(sizes).at(wavelength));
        assert!((few.sigma_s / many.sigma_s - 1.0).abs() < 1e-3, "{} {}", few.sigma_s, many.sigma_s);
        assert!((few.g - many.g).abs() < 1e-3, "{} {}", few.g, many.g);
    }

    /// Geometric optics: a cloud's extinction is `3/2 v/a` times `Q/2`, and `Q` is 2 within `2 x^(−2/3)`.
    #[test]
    fn a_cloud_takes_twice_the_shadow_of_its_droplets() {
        let found = cloud(Sizes::gamma(6e-6, 1.0 / 9.0)).at(550e-9);
        let shadow = 2.0 * 0.75 * 1e-7 / 6e-6;
        let excess = 2.0f64 * (2.0 * PI * 6.0 / 0.55f64).powf(-2.0 / 3.0) / 2.0;
        assert!((found.sigma_s / shadow - 1.0 - excess).abs() < 0.5 * excess, "{}", found.sigma_s / shadow);
        assert!((0.84..0.88).contains(&found.g), "{}", found.g);
    }

    /// The table, linear between its cosines, sends as much light on as the series has it.
    #[test]
    fn the_table_of_a_phase_function_has_the_mean_cosine_of_its_series() {
        for sizes in [Sizes::gamma(6e-6, 1.0 / 9.0), Sizes::log_normal(2e-7, 0.4), Sizes::mono(1e-8)] {
            let mixture = cloud(sizes);
            let values = mixture.phase(&[550e-9]);
            let segments = values.len() - 1;
            let (mut mass, mut moment) = (0.0, 0.0);
            for (i, value) in values.iter().enumerate() {
                let weight = value * if i == 0 || i == segments { 0.5 } else { 1.0 };
                mass += weight;
                moment += weight * (2.0 * i as f64 / segments as f64 - 1.0);
            }
            let g = mixture.at(550e-9).g;
            assert!((moment / mass - g).abs() < 1e-3 * (1.0 - g), "{segments}: {} instead of {g}", moment / mass);
        }
    }

    #[test]
    fn clear_water_scatters_nothing_and_salt_water_a_little() {
        let clear = Mixture { host: Substance::Water, particles: Vec::new() };
        assert_eq!((clear.at(500e-9).sigma_s, clear.at(500e-9).g), (0.0, 0.0));
        assert!(clear.phase(&[500e-9]).is_empty());
        let sea = Mixture { host: Substance::SeaWater { salinity: 35.0, temperature: 20.0 }, particles: Vec::new() };
        assert!((sea.at(500e-9).sigma_s - 0.00288).abs() < 1e-12 && sea.at(500e-9).g == 0.0);
        assert!((sea.at(500e-9).phase(1.0) / sea.at(500e-9).phase(0.0) - 1.835).abs() < 1e-12);
    }
}
