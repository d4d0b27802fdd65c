//! A mixture as a renderer takes it: coefficients by wavelength, and one phase function for all of them.
//!
//! The phase function is that of the light which the mixture scatters at [`SEEN`], `Σ σ_s p/Σ σ_s`, with the mean cosine `ḡ`.
//! Where Mie's `g` differs from it, scattering is changed so that its reduced coefficient stays as computed:
//!
//! ```text
//! σ_s*(λ) (1 − ḡ) = σ_s(λ) (1 − g(λ))
//! ```
//!
//! So the colour of light that has been scattered often is that of the mixture. What is seen in single scattering is not:
//! `σ_s*/σ_s` goes from 0.92 at 400 nm to 1.08 at 700 nm in skimmed milk, and from 0.82 to 1.29 in whole milk, whose globules send
//! red light on more evenly than blue light. In fog it is within 3 % of 1 there.

use crate::{mixture::Mixture, substance::WAVELENGTHS};

/// Wavelengths whose phase functions are mixed [m].
pub const SEEN: [f64; 3] = [450e-9, 550e-9, 650e-9];

/// Coefficients by wavelength and a phase function.
#[derive(Debug, Clone, PartialEq)]
pub struct Medium {
    /// Wavelengths [nm], from 360 to 830.
    pub lambda: Vec<f64>,
    /// Absorption [1/mm].
    pub sigma_a: Vec<f64>,
    /// Scattering `σ_s*` [1/mm].
    pub sigma_s: Vec<f64>,
    /// The phase function at regular cosines from −1 to 1, up to a factor; empty where nothing scatters.
    pub phase: Vec<f64>,
    /// Its mean cosine `ḡ` \[1\].
    pub g: f64,
}

/// The wavelengths [m] of a medium: those of the tables, and on to both ends of what is seen.
pub fn wavelengths() -> impl Iterator<Item = f64> {
    [360e-9].into_iter().chain(WAVELENGTHS).chain([800e-9, 830e-9])
}

impl Medium {
    /// Of a mixture.
    pub fn of(mixture: &Mixture) -> Self {
        let (mut scattered, mut forward) = (0.0, 0.0);
        for bulk in SEEN.map(|wavelength| mixture.at(wavelength)) {
            scattered += bulk.sigma_s;
            forward += bulk.sigma_s * bulk.g;
        }
        let g = if scattered > 0.0 { forward / scattered } else { 0.0 };
        let mut medium =
            Self { lambda: Vec::new(), sigma_a: Vec::new(), sigma_s: Vec::new(), phase: mixture.phase(&SEEN), g };
        for wavelength in wavelengths() {
            let bulk = mixture.at(wavelength);
            medium.lambda.push((wavelength * 1e9).round());
            medium.sigma_a.push(bulk.sigma_a * 1e-3);
            medium.sigma_s.push(bulk.sigma_s * (1.0 - bulk.g) / (1.0 - g) * 1e-3);
        }
        medium
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::milk::milk;

    /// Blue light is scattered more evenly by milk than red light, and the renderer has one phase function.
    #[test]
    fn reduced_scattering_is_that_of_the_mixture_at_every_wavelength() {
        let mixture = milk(0.1, 3.4, 20.0);
        let medium = Medium::of(&mixture);
        for (i, lambda) in medium.lambda.iter().enumerate() {
            let bulk = mixture.at(lambda * 1e-9);
            let reduced = 1e-3 * bulk.sigma_s * (1.0 - bulk.g);
            assert!((medium.sigma_s[i] * (1.0 - medium.g) / reduced - 1.0).abs() < 1e-9, "{lambda}");
        }
    }

    /// What the manual says of single scattering: whole milk, skimmed milk and fog at 400 and 700 nm.
    #[test]
    fn single_scattering_changes_by_what_the_manual_says() {
        let fog = crate::recipe::named("fog").unwrap();
        let fog = fog.mix(&fog.defaults()).unwrap();
        for (mixture, expected) in
            [(milk(0.1, 3.4, 20.0), [0.92, 1.08]), (milk(3.5, 3.3, 20.0), [0.82, 1.29]), (fog, [0.985, 1.015])]
        {
            let bulks = SEEN.map(|l| mixture.at(l));
            let scattered: f64 = bulks.iter().map(|b| b.sigma_s).sum();
            let g = bulks.iter().map(|b| b.sigma_s * b.g).sum::<f64>() / scattered;
            for (nanometres, expected) in [400e-9, 700e-9].into_iter().zip(expected) {
                let change = (1.0 - mixture.at(nanometres).g) / (1.0 - g);
                assert!((change - expected).abs() < 0.016, "{nanometres:e}: {change} instead of {expected}");
            }
        }
    }
}
