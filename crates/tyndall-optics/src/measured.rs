//! Measured scattering coefficients of real materials, by name: `"Skimmilk"`, `"Marble"`, `"Merlot"`.
//!
//! All coefficients are per millimetre, as published; whoever reads a scene file converts them to its unit of length.
//! Each material has three values, for the red, green and blue of the camera that measured it.
//!
//! | materials | source | columns |
//! |---|---|---|
//! | 12 | Jensen, Marschner, Levoy and Hanrahan 2001 | σ_a, σ_s′ |
//! | 35 | Narasimhan, Gupta, Donner, Ramamoorthi, Nayar and Jensen 2006 | σ_a, σ_s′, σ_s, g |
//!
//! A **preset** of pbrt-v4 is isotropic (g = 0) with the *reduced* coefficient `σ_s′ = (1 − g) σ_s` in the place of σ_s:
//! use [`Measured::sigma_a`] and [`Measured::sigma_s_reduced`], which hold pbrt-v4's digits. Diffusion looks the same;
//! single scattering and thin layers do not, and for these [`Measured::full`] has what was measured.
//!
//! The tables, with how they were transcribed and checked, are in `data/`.
//!
//! ```
//! let skimmilk = tyndall_optics::measured::named("skimmilk").unwrap();
//! assert_eq!(skimmilk.sigma_s_reduced, [0.70, 1.22, 1.90]); // 1/mm
//! ```

use std::sync::LazyLock;

/// Where a material was published.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Jensen et al. 2001, "A Practical Model for Subsurface Light Transport".
    Jensen2001,
    /// Narasimhan et al. 2006, "Acquiring Scattering Properties of Participating Media by Dilution".
    Narasimhan2006,
}

/// The coefficients of a material, for red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Its name as pbrt-v4 writes it.
    pub name: &'static str,
    /// Where it was published.
    pub source: Source,
    /// Absorption coefficient σ_a [1/mm].
    pub sigma_a: [f32; 3],
    /// Reduced scattering coefficient σ_s′ = (1 − g) σ_s [1/mm].
    pub sigma_s_reduced: [f32; 3],
    /// Index of refraction \[1\].
    pub eta: f32,
    /// Scattering before reduction, where it was measured.
    pub full: Option<Anisotropic>,
}

/// Scattering with its mean cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropic {
    /// Scattering coefficient σ_s [1/mm].
    pub sigma_s: [f32; 3],
    /// Mean cosine g of the phase function, in [0, 1); 0 where nothing scatters.
    pub g: [f32; 3],
}

/// All materials: first those of 2001, then those of 2006.
pub fn all() -> &'static [Measured] {
    &MATERIALS
}

/// The names of all materials, in the same order.
pub fn names() -> impl Iterator<Item = &'static str> {
    MATERIALS.iter().map(|m| m.name)
}

/// The material of a name, in any case.
pub fn named(name: &str) -> Option<&'static Measured> {
    MATERIALS.iter().find(|m| m.name.eq_ignore_ascii_case(name))
}

static MATERIALS: LazyLock<Vec<Measured>> = LazyLock::new(|| {
    let jensen = materials(include_str!("../data/measured_jensen2001.csv")).map(|[r, g, b]| Measured {
        name: r.name(),
        source: Source::Jensen2001,
        sigma_a: [r, g, b].map(|row| row.number("sigma_a")),
        sigma_s_reduced: [r, g, b].map(|row| row.number("sigma_s_prime")),
        eta: r.number("eta"),
        full: None,
    });
    let narasimhan = materials(include_str!("../data/measured_narasimhan2006.csv")).map(|[r, g, b]| Measured {
        name: r.name(),
        source: Source::Narasimhan2006,
        sigma_a: [r, g, b].map(|row| row.number("sa_pbrt")),
        sigma_s_reduced: [r, g, b].map(|row| row.number("ssp_pbrt")),
        eta: r.number("eta"),
        full: Some(Anisotropic {
            sigma_s: [r, g, b].map(|row| row.number("sigma_s")),
            g: [r, g, b].map(|row| row.number("g")),
        }),
    });
    jensen.chain(narasimhan).collect()
});

/// A line of a table, with its header.
#[derive(Debug, Clone, Copy)]
struct Row {
    header: &'static str,
    line: &'static str,
}

impl Row {
    fn field(&self, column: &str) -> &'static str {
        let position = self.header.split(',').position(|name| name == column);
        position.and_then(|i| self.line.split(',').nth(i)).expect("the committed table has the column")
    }

    fn name(&self) -> &'static str {
        self.field("material")
    }

    fn number(&self, column: &str) -> f32 {
        self.field(column).parse().expect("the committed table holds numbers")
    }
}

/// The red, green and blue rows of each material.
fn materials(table: &'static str) -> impl Iterator<Item = [Row; 3]> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().expect("the committed table has a header");
    let mut rows = lines.map(move |line| Row { header, line });
    std::iter::from_fn(move || {
        let channels = [rows.next()?, rows.next()?, rows.next()?];
        for (row, channel) in channels.iter().zip(["R", "G", "B"]) {
            assert!(row.name() == channels[0].name() && row.field("channel") == channel, "{}: channels", row.line);
        }
        Some(channels)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 47 presets of pbrt-v4, in its order.
    const PBRT: [&str; 47] = [
        "Apple",
        "Chicken1",
        "Chicken2",
        "Cream",
        "Ketchup",
        "Marble",
        "Potato",
        "Skimmilk",
        "Skin1",
        "Skin2",
        "Spectralon",
        "Wholemilk",
        "Lowfat Milk",
        "Reduced Milk",
        "Regular Milk",
        "Espresso",
        "Mint Mocha Coffee",
        "Lowfat Soy Milk",
        "Regular Soy Milk",
        "Lowfat Chocolate Milk",
        "Regular Chocolate Milk",
        "Coke",
        "Pepsi",
        "Sprite",
        "Gatorade",
        "Chardonnay",
        "White Zinfandel",
        "Merlot",
        "Budweiser Beer",
        "Coors Light Beer",
        "Clorox",
        "Apple Juice",
        "Cranberry Juice",
        "Grape Juice",
        "Ruby Grapefruit Juice",
        "White Grapefruit Juice",
        "Shampoo",
        "Strawberry Shampoo",
        "Head & Shoulders Shampoo",
        "Lemon Tea Powder",
        "Orange Powder",
        "Pink Lemonade Powder",
        "Cappuccino Powder",
        "Salt Powder",
        "Sugar Powder",
        "Suisse Mocha Powder",
        "Pacific Ocean Surface Water",
    ];

    #[test]
    fn every_preset_of_pbrt_is_found_in_any_case() {
        assert!(names().eq(PBRT));
        for name in PBRT {
            assert_eq!(named(name).unwrap().name, name);
            assert_eq!(named(&name.to_uppercase()).unwrap().name, name);
        }
        assert_eq!(named("Chocolate"), None);
    }

    #[test]
    fn coefficients_are_those_of_the_papers() {
        let marble = named("Marble").unwrap();
        assert_eq!((marble.sigma_a, marble.eta), ([0.0021, 0.0041, 0.0071], 1.5));
        assert_eq!((marble.sigma_s_reduced, marble.full), ([2.19, 2.62, 3.00], None));
        let milk = named("Regular Milk").unwrap();
        assert_eq!((milk.sigma_a, milk.sigma_s_reduced), ([0.0015333, 0.0046, 0.019933], [4.5513, 5.8294, 7.136]));
        assert_eq!((milk.source, milk.eta), (Source::Narasimhan2006, 1.33));
        assert_eq!(milk.full.unwrap().sigma_s, [18.2052, 20.3826, 22.3698]);
        // Red wine scatters in red only.
        let merlot = named("merlot").unwrap().full.unwrap();
        assert_eq!((merlot.sigma_s[1], merlot.g), (0.0, [0.974, 0.0, 0.0]));
    }

    /// σ_s′ = (1 − g) σ_s to the rounding of g and σ_s, which have three and five decimals.
    #[test]
    fn reduced_coefficients_belong_to_the_full_ones() {
        for m in all() {
            assert!(m.sigma_a.iter().chain(&m.sigma_s_reduced).all(|&v| v >= 0.0 && v.is_finite()), "{}", m.name);
            let Some(full) = m.full else { continue };
            for i in 0..3 {
                let (sigma_s, g) = (full.sigma_s[i], full.g[i]);
                assert!((0.0..1.0).contains(&g), "{}: g = {g}", m.name);
                let rounding = 0.5e-3 * sigma_s + 0.5e-5 * (1.0 - g) + 1e-4 * m.sigma_s_reduced[i];
                let difference = (m.sigma_s_reduced[i] - (1.0 - g) * sigma_s).abs();
                assert!(difference <= rounding, "{} {i}: {difference} > {rounding}", m.name);
            }
        }
    }
}
