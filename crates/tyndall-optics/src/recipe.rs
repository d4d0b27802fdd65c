//! Mixtures by name and a few numbers, as a cook has them: what `tyndall mix` and scenes can ask for.
//!
//! | recipe | what | source |
//! |---|---|---|
//! | `milk` | fat and casein in serum | Frisvad, Christensen and Jensen 2007: see [`milk`](crate::milk) |
//! | `cloud`, `fog` | droplets of water in air, gamma distributed | Deirmendjian 1969, cloud C.1 (effective radius 6 µm, variance 1/9); Hansen and Travis 1974 |
//! | `ink` | carbon black in water, log-normal | index: Bond and Bergstrom 2006 |
//! | `smoke` | soot in air, log-normal | index and density: Bond and Bergstrom 2006 |
//! | `sea` | sea water without anything in it | Quan and Fry 1995; Pope and Fry 1997; Morel 1974 |
//!
//! Where a default is no published number (how much of it there is, sizes of ink and smoke, all of `fog`) it is an example
//! that looks like the thing. Spheres of carbon absorb about 30 % less than real soot does, whose grains cling together
//! (Bond and Bergstrom 2006).

use crate::{
    milk::milk,
    mixture::{Mixture, Particles},
    sizes::Sizes,
    substance::Substance,
};

/// A number that a recipe asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it says, with its unit.
    pub about: &'static str,
    /// Its value if nothing is said.
    pub default: f64,
    /// The least and the greatest that makes sense.
    pub range: [f64; 2],
}

/// A recipe.
#[derive(Debug, Clone, Copy)]
pub struct Recipe {
    /// Its name.
    pub name: &'static str,
    /// What it makes.
    pub about: &'static str,
    /// Who published it.
    pub source: &'static str,
    /// What it asks for.
    pub parameters: &'static [Parameter],
    /// Index of refraction of a smooth surface around it \[1\].
    pub eta: f64,
    mixture: fn(&[f64]) -> Mixture,
}

impl Recipe {
    /// The mixture of these values, one for each parameter.
    ///
    /// # Errors
    /// Which value is missing or out of its range, in words.
    pub fn mix(&self, values: &[f64]) -> Result<Mixture, String> {
        if values.len() != self.parameters.len() {
            return Err(format!("{} takes {} numbers", self.name, self.parameters.len()));
        }
        let outside = self.parameters.iter().zip(values).find(|(p, v)| !(p.range[0]..=p.range[1]).contains(v));
        match outside {
            Some((p, v)) => Err(format!("\"{}\" is between {} and {}: got {v}", p.name, p.range[0], p.range[1])),
            None => Ok((self.mixture)(values)),
        }
    }

    /// The values where nothing is said.
    pub fn defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default).collect()
    }
}

/// The recipe of a name.
pub fn named(name: &str) -> Option<&'static Recipe> {
    RECIPES.iter().find(|recipe| recipe.name == name)
}

const fn parameter(name: &'static str, about: &'static str, default: f64, range: [f64; 2]) -> Parameter {
    Parameter { name, about, default, range }
}

const RADIUS: [f64; 2] = [0.01, 20.0];
const FINE: [f64; 2] = [0.001, 0.5];
const VARIANCE: Parameter = parameter("variance", "effective variance of the radii [1]", 1.0 / 9.0, [0.005, 0.25]);
const SPREAD: Parameter =
    parameter("spread", "geometric standard deviation of the radii, by number [1]", 1.5, [1.01, 2.0]);

/// All recipes.
pub static RECIPES: [Recipe; 6] = [
    Recipe {
        name: "milk",
        about: "Milk: fat globules and casein micelles in serum",
        source: "Frisvad, Christensen and Jensen 2007",
        parameters: &[
            parameter("fat", "fat [weight-%]", 3.5, [0.0, 10.0]),
            parameter("protein", "protein [weight-%]", 3.3, [0.0, 10.0]),
            parameter("pressure", "pressure of homogenisation [MPa], 0 for raw milk", 20.0, [0.0, 100.0]),
        ],
        eta: 1.33,
        mixture: |v| milk(v[0], v[1], v[2]),
    },
    Recipe {
        name: "cloud",
        about: "A cloud: droplets of water in air",
        source: "Deirmendjian 1969 (C.1); Hale and Querry 1973; Pope and Fry 1997",
        parameters: &[
            parameter("radius", "effective radius of the droplets [µm]", 6.0, RADIUS),
            VARIANCE,
            parameter("water", "liquid water [g/m³]", 0.3, [0.0, 10.0]),
        ],
        eta: 1.0,
        mixture: droplets,
    },
    Recipe {
        name: "fog",
        about: "Fog: a thin cloud of large droplets",
        source: "Hansen and Travis 1974; Hale and Querry 1973; Pope and Fry 1997",
        parameters: &[
            parameter("radius", "effective radius of the droplets [µm]", 10.0, RADIUS),
            VARIANCE,
            parameter("water", "liquid water [g/m³]", 0.05, [0.0, 10.0]),
        ],
        eta: 1.0,
        mixture: droplets,
    },
    Recipe {
        name: "ink",
        about: "Black ink in water: carbon black",
        source: "Bond and Bergstrom 2006; Hale and Querry 1973; Pope and Fry 1997",
        parameters: &[
            parameter("carbon", "carbon [g/l]", 0.1, [0.0, 100.0]),
            parameter("radius", "median radius of the grains, by number [µm]", 0.05, FINE),
            SPREAD,
        ],
        eta: 1.33,
        mixture: |v| carbon(Substance::Water, v[0] * 1e3, v[1], v[2]),
    },
    Recipe {
        name: "smoke",
        about: "Black smoke: soot in air",
        source: "Bond and Bergstrom 2006",
        parameters: &[
            parameter("soot", "soot [g/m³]", 0.1, [0.0, 100.0]),
            parameter("radius", "median radius of the grains, by number [µm]", 0.05, FINE),
            SPREAD,
        ],
        eta: 1.0,
        mixture: |v| carbon(Substance::Air, v[0], v[1], v[2]),
    },
    Recipe {
        name: "sea",
        about: "The clearest sea water: salt water without anything in it",
        source: "Quan and Fry 1995; Pope and Fry 1997; Morel 1974",
        parameters: &[
            parameter("salinity", "salt [g/kg]", 35.0, [0.0, 35.0]),
            parameter("temperature", "temperature [°C]", 20.0, [0.0, 30.0]),
        ],
        eta: 1.34,
        mixture: |v| Mixture { host: Substance::SeaWater { salinity: v[0], temperature: v[1] }, particles: Vec::new() },
    },
];

/// Grams of water in a cubic metre of it.
const WATER: f64 = 1e6;
/// The same of soot: 1.7 to 1.9 g/cm³ (Bond and Bergstrom 2006).
const SOOT: f64 = 1.8e6;

fn droplets(v: &[f64]) -> Mixture {
    let sizes = Sizes::gamma(v[0] * 1e-6, v[1]);
    let water = Particles { substance: Substance::Water, fraction: v[2] / WATER, sizes };
    Mixture { host: Substance::Air, particles: vec![water] }
}

/// Carbon [g/m³] of this median radius [µm] and spread.
fn carbon(host: Substance, mass: f64, radius: f64, spread: f64) -> Mixture {
    let sizes = Sizes::log_normal(radius * 1e-6, spread.ln());
    Mixture { host, particles: vec![Particles { substance: Substance::Carbon, fraction: mass / SOOT, sizes }] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_recipe_can_be_mixed_as_it_stands_and_refuses_what_makes_no_sense() {
        for recipe in &RECIPES {
            let mut values = recipe.defaults();
            let bulk = recipe.mix(&values).unwrap().at(550e-9);
            assert!(bulk.sigma_a >= 0.0 && bulk.sigma_s > 0.0 && bulk.g.abs() < 1.0, "{}: {bulk:?}", recipe.name);
            values[0] = f64::NAN;
            assert!(recipe.mix(&values).unwrap_err().contains(recipe.parameters[0].name));
            assert!(recipe.mix(&values[1..]).is_err());
        }
        assert!(named("beer").is_none());
    }

    /// Bond and Bergstrom 2006, section 8.1: fine spheres of 1.95 + 0.79i at 550 nm absorb about 30 % less than the measured
    /// 7.5 ± 1.2 m²/g; Rayleigh's `6π Im((m²−1)/(m²+2))/(λρ)` alone is 4.9 m²/g, and grains near 0.1 µm do more.
    #[test]
    fn soot_absorbs_per_gram_what_its_review_says() {
        let per_gram = named("smoke").unwrap().mix(&[1.0, 0.05, 1.5]).unwrap().at(550e-9).sigma_a;
        assert!((per_gram / (0.7 * 7.5) - 1.0).abs() < 0.3, "{per_gram} m²/g");
        let fine = named("smoke").unwrap().mix(&[1.0, 0.001, 1.01]).unwrap().at(550e-9).sigma_a;
        let m = num_complex::Complex64::new(1.95, 0.79);
        let rayleigh = 6.0 * std::f64::consts::PI * ((m * m - 1.0) / (m * m + 2.0)).im / (550e-9 * SOOT);
        assert!((fine / rayleigh - 1.0).abs() < 1e-3, "{fine} {rayleigh}");
    }

    /// Deirmendjian's C.1 has `n ∝ r⁶ exp(−1.5 r/µm)`: Hansen and Travis's distribution with a = 6 µm, b = 1/9. Its droplets are
    /// `⟨r³⟩ = 9!/(6! 1.5³) µm³` in the mean, so the water of a hundred in a cubic centimetre is 0.0626 g/m³, and their shadows
    /// `π ⟨r²⟩ = π 8!/(6! 1.5²) µm²`, twice of which they take but for the edge (`1 + x^(−2/3)`, x = 54 at 700 nm).
    #[test]
    fn a_cloud_is_that_of_deirmendjian() {
        let water = 100e6 * 4.0 / 3.0 * std::f64::consts::PI * 504.0 / 3.375 * 1e-18 * WATER;
        let shadows = 100e6 * std::f64::consts::PI * 56.0 / 2.25 * 1e-12;
        let bulk = named("cloud").unwrap().mix(&[6.0, 1.0 / 9.0, water]).unwrap().at(700e-9);
        let efficiency = (bulk.sigma_a + bulk.sigma_s) / shadows;
        assert!(
            (water - 0.0626).abs() < 1e-4 && (efficiency - 2.0 - 2.0 * 54f64.powf(-2.0 / 3.0)).abs() < 0.03,
            "{efficiency}"
        );
    }
}
