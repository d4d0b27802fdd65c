//! Milk from fat, protein and the pressure of its homogenisation (Frisvad, Christensen and Jensen 2007, section 6.2).
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `fat` | fat [weight-%] | 0 to 10 |
//! | `protein` | protein [weight-%] | 0 to 10 |
//! | `pressure` | homogenisation \[MPa\]; 0 is milk as it comes from the cow | 0 to 100 |
//!
//! Volume fractions: `v_fat = w/0.915 · 1.030/100`, `v_casein = 0.76 w/1.11 · 1.030/100` (densities in g/cm³; 76 % of the
//! protein is casein). Fat globules are log-normal by volume, `r₄₃` from fits to Goulden and Phipps 1964 and Olson, White
//! and Richter 2004:
//!
//! ```text
//! r₄₃(50 MPa) = 7.481·10⁻⁴ w² + 3.204·10⁻² w + 0.1162  µm
//! r₄₃(0)      = −0.2528 w² + 1.4186 w  µm  (w < 2),   1.4562 w^0.36  µm  (w ≥ 2)
//! log r₄₃(P)  = log r₄₃(0) − [log r₄₃(0) − log r₄₃(50)] log P/log 50
//! r₃₂ = r₄₃/(1 + 0.6²),   standard deviation 0.6 r₃₂
//! ```
//!
//! Below 1 MPa, where `r₄₃(P)` meets `r₄₃(0)`, the latter holds. Casein micelles have a log-normal `r/(150 nm − r)`, with
//! `r₃₂ = 43 nm` and standard deviation 0.23 of that variable (Schmidt, Walstra and Buchheim 1973; Gebhardt et al. 2006).

use crate::{
    mixture::{Mixture, Particles},
    sizes::Sizes,
    substance::Substance,
};

/// Densities [g/cm³].
const FAT: f64 = 0.915;
const CASEIN: f64 = 1.11;
const MILK: f64 = 1.030;
/// The share of casein in protein.
const CASEIN_SHARE: f64 = 0.76;
/// Coefficient of variation of fat globules.
const VARIATION: f64 = 0.6;
/// No micelle is larger [m].
const LARGEST_MICELLE: f64 = 150e-9;

/// Milk of `fat` and `protein` [weight-%], homogenised at `pressure` [MPa].
pub fn milk(fat: f64, protein: f64, pressure: f64) -> Mixture {
    let volume = |weight: f64, density: f64| weight / density * MILK / 100.0;
    let mut particles = Vec::new();
    if fat > 0.0 {
        let (median, sigma) = fat_globules(fat, pressure);
        particles.push(Particles {
            substance: Substance::MilkFat,
            fraction: volume(fat, FAT),
            sizes: Sizes::log_normal_volume(median, sigma),
        });
    }
    if protein > 0.0 {
        particles.push(Particles {
            substance: Substance::Casein,
            fraction: volume(CASEIN_SHARE * protein, CASEIN),
            sizes: micelles(),
        });
    }
    Mixture { host: Substance::MilkSerum, particles }
}

/// The parameters of a log-normal distribution with this mean and standard deviation: median and width.
fn log_normal_of(mean: f64, deviation: f64) -> (f64, f64) {
    let variance = (deviation / mean).powi(2).ln_1p();
    (mean * (-0.5 * variance).exp(), variance.sqrt())
}

/// Median radius by volume [m] and width of its logarithm.
fn fat_globules(w: f64, pressure: f64) -> (f64, f64) {
    let raw = if w < 2.0 { -0.2528033794 * w * w + 1.418606759 * w } else { 1.456189142 * w.powf(0.36) };
    let at_50 = 7.481403922e-4 * w * w + 3.203991829e-2 * w + 0.1162155667;
    let share = pressure.max(1.0).ln() / 50f64.ln();
    let r_43 = raw * (at_50 / raw).powf(share) * 1e-6;
    let r_32 = r_43 / (1.0 + VARIATION * VARIATION);
    log_normal_of(r_32, VARIATION * r_32)
}

fn micelles() -> Sizes {
    let stretched = |r: f64| r / (LARGEST_MICELLE - r);
    let (median, sigma) = log_normal_of(stretched(43e-9), 0.23);
    Sizes::by_radius(LARGEST_MICELLE, 150, |r| {
        let t = stretched(r);
        (-0.5 * ((t / median).ln() / sigma).powi(2)).exp() / t
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::mie::Sphere;

    struct Row {
        recipe: [f64; 3],
        step: f64,
        wavelength: f64,
        /// σ_t, σ_s, σ_a, g, σ_s and g of fat, σ_s and g of casein, σ_a of the host.
        values: [f64; 9],
    }

    fn rows() -> impl Iterator<Item = Row> {
        let table = include_str!("../data/milk_frisvad_miepython.csv");
        table.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| {
            let v: Vec<f64> = line.split(',').skip(1).map(|field| field.parse().unwrap()).collect();
            Row {
                recipe: [v[0], v[1], v[2]],
                step: v[3],
                wavelength: v[4] * 1e-9,
                values: std::array::from_fn(|i| v[5 + i]),
            }
        })
    }

    /// The fat of the table: regular steps [µm] from 5 nm to 10 µm.
    fn on_the_grid(fat: f64, pressure: f64, step: f64) -> Sizes {
        let (median, sigma) = fat_globules(fat, pressure);
        let classes: Vec<_> = (0..2000)
            .map(|i| (0.005 + (f64::from(i) + 0.5) * step) * 1e-6)
            .take_while(|r| *r < 10e-6)
            .map(|r| [r, (-0.5 * ((r / median).ln() / sigma).powi(2)).exp() / r])
            .collect();
        let sum: f64 = classes.iter().map(|class| class[1]).sum();
        Sizes { classes: classes.into_iter().map(|[r, share]| [r, share / sum]).collect() }
    }

    /// The table's own assumption: spheres in a host that is clear, which absorbs beside them.
    fn in_a_clear_host(mixture: &Mixture, wavelength: f64) -> [f64; 9] {
        let host = mixture.host.index(wavelength);
        let kinds: [[f64; 3]; 2] = std::array::from_fn(|kind| {
            let particles = &mixture.particles[kind];
            let mut sums = [0.0; 3];
            for [radius, share] in &particles.sizes.classes {
                let number = particles.fraction * share / (4.0 / 3.0 * PI * radius.powi(3));
                let sphere = Sphere::new(*radius, wavelength, particles.substance.index(wavelength), host.re.into());
                sums[0] += number * sphere.extinction;
                sums[1] += number * sphere.scattering;
                sums[2] += number * sphere.scattering * sphere.g;
            }
            sums
        });
        let [fat, casein] = kinds;
        let water = mixture.host.absorption(wavelength);
        let (sigma_t, sigma_s) = (fat[0] + casein[0] + water, fat[1] + casein[1]);
        let g = (fat[2] + casein[2]) / sigma_s;
        let of_fat = [fat[1], fat[2] / fat[1]];
        let of_casein = [casein[1], casein[2] / casein[1]];
        [sigma_t, sigma_s, sigma_t - sigma_s, g, of_fat[0], of_fat[1], of_casein[0], of_casein[1], water]
    }

    /// Every column to the six digits that are printed, on the grid of the table.
    #[test]
    fn milk_is_that_of_the_table() {
        let mut count = 0;
        for row in rows() {
            let [fat, protein, pressure] = row.recipe;
            let mut mixture = milk(fat, protein, pressure);
            mixture.particles[0].sizes = on_the_grid(fat, pressure, row.step);
            let found = in_a_clear_host(&mixture, row.wavelength);
            for (found, expected) in found.into_iter().zip(row.values) {
                assert!(
                    (found / expected - 1.0).abs() < 6e-6,
                    "{:?} {:e}: {found} {expected}",
                    row.recipe,
                    row.wavelength
                );
            }
            count += 1;
        }
        assert!(count > 50, "{count} rows");
    }

    /// The sum over sizes without steps: what the finest grid of the table leaves out is 2·10⁻⁶ of homogenised milk, and of raw
    /// milk the globules above 10 µm, 2·10⁻⁴. Fat takes the place of serum and the light within its radius: absorption changes
    /// by no more than 2.5 times the volume of the particles (`γ`), scattering by `5/3 4πkr/λ`.
    #[test]
    fn milk_has_converged_and_particles_take_the_place_of_serum() {
        for row in rows().filter(|row| row.step < 0.01) {
            let [fat, protein, pressure] = row.recipe;
            let mixture = milk(fat, protein, pressure);
            let bulk = mixture.at(row.wavelength);
            let above = mixture.particles[0].sizes.classes.iter().filter(|[radius, _]| *radius > 10e-6);
            let cut = above.map(|class| class[1]).sum::<f64>() + 1e-5;
            assert!((bulk.sigma_s / row.values[1] - 1.0).abs() < cut, "{:?} {}", row.recipe, bulk.sigma_s);
            assert!((bulk.g - row.values[3]).abs() < cut, "{:?} {}", row.recipe, bulk.g);
            let volume: f64 = mixture.particles.iter().map(|p| p.fraction).sum();
            let change = (bulk.sigma_a - row.values[2]).abs();
            assert!(change < 2.5 * volume * row.values[8] + cut * row.values[2], "{:?} {change}", row.recipe);
        }
    }

    /// Skimmed, without protein, and water.
    #[test]
    fn what_is_not_in_the_milk_does_not_scatter() {
        assert_eq!(milk(0.0, 3.4, 20.0).particles.len(), 1);
        assert_eq!(milk(0.0, 0.0, 20.0).at(500e-9).sigma_s, 0.0);
        assert_eq!(fat_globules(3.3, 0.0), fat_globules(3.3, 1.0));
    }
}
