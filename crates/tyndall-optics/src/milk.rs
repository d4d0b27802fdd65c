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
    use super::*;

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
        let classes: Vec<_> = (0..)
            .map(|i| (0.005 + (f64::from(i) + 0.5) * step) * 1e-6)
            .take_while(|r| *r < 10e-6)
            .map(|r| [r, (-0.5 * ((r / median).ln() / sigma).powi(2)).exp() / r])
            .collect();
        let sum: f64 = classes.iter().map(|class| class[1]).sum();
        Sizes { classes: classes.into_iter().map(|[r, share]| [r, share / sum]).collect() }
    }

    fn worst(found: &[f64], expected: &[f64]) -> f64 {
        found.iter().zip(expected).map(|(f, e)| (f / e - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn print() {
        for row in rows() {
            let [fat, protein, pressure] = row.recipe;
            let mut mixture = milk(fat, protein, pressure);
            let conv = mixture.at(row.wavelength);
            mixture.particles[0].sizes = on_the_grid(fat, pressure, row.step);
            let bulk = mixture.at(row.wavelength);
            let v = row.values;
            let w = |b: &crate::mixture::Bulk| [b.sigma_a + b.sigma_s, b.sigma_s, b.sigma_a, b.g].iter().zip(&v[..4]).map(|(f,e)| format!("{:.1e}", f/e-1.0)).collect::<Vec<_>>().join(" ");
            println!("{:?} {} {}: grid {} conv {}", row.recipe, row.step, row.wavelength, w(&bulk), w(&conv));
        }
        let _ = worst(&[1.0],&[1.0]);
    }
}
