//! Refractive indices of optical glasses as functions of wavelength.
//!
//! Sellmeier's equation with λ in µm, three resonances each:
//!
//! ```text
//! n²(λ) = 1 + Σᵢ Bᵢ λ² / (λ² − Cᵢ),   i = 1, 2, 3
//! ```
//!
//! Coefficients: SCHOTT optical glass data sheets (N-BK7, N-BAF10, N-FK51A, N-LASF9, N-SF5, N-SF10, N-SF11), as also listed
//! by refractiveindex.info. These are the glasses that pbrt-v4 names; its words "glass-F5", "glass-F10" and "glass-F11"
//! stand for the SF glasses.

/// A glass of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glass {
    /// The catalogue's name, without "N-".
    pub name: &'static str,
    /// B₁, B₂, B₃ \[1\].
    pub b: [f64; 3],
    /// C₁, C₂, C₃ [µm²].
    pub c: [f64; 3],
}

/// All glasses.
pub const GLASSES: [Glass; 7] = [
    Glass { name: "BK7", b: [1.03961212, 0.231792344, 1.01046945], c: [0.00600069867, 0.0200179144, 103.560653] },
    Glass { name: "BAF10", b: [1.5851495, 0.143559385, 1.08521269], c: [0.00926681282, 0.0424489805, 105.613573] },
    Glass { name: "FK51A", b: [0.971247817, 0.216901417, 0.904651666], c: [0.00472301995, 0.0153575612, 168.68133] },
    Glass { name: "LASF9", b: [2.00029547, 0.298926886, 1.80691843], c: [0.0121426017, 0.0538736236, 156.530829] },
    Glass { name: "SF5", b: [1.52481889, 0.187085527, 1.42729015], c: [0.011254756, 0.0588995392, 129.141675] },
    Glass { name: "SF10", b: [1.62153902, 0.256287842, 1.64447552], c: [0.0122241457, 0.0595736775, 147.468793] },
    Glass { name: "SF11", b: [1.73759695, 0.313747346, 1.89878101], c: [0.013188707, 0.0623068142, 155.23629] },
];

impl Glass {
    /// The glass of a name such as "BK7", "glass-BK7" or "N-BK7", in any case.
    pub fn named(name: &str) -> Option<&'static Self> {
        let name = name.to_ascii_uppercase();
        let name = name.strip_prefix("GLASS-").unwrap_or(&name);
        let name = match name.strip_prefix("N-").unwrap_or(name) {
            "F5" => "SF5",
            "F10" => "SF10",
            "F11" => "SF11",
            other => other,
        };
        GLASSES.iter().find(|glass| glass.name == name)
    }

    /// The index of refraction at `lambda` [nm].
    pub fn eta(&self, lambda: f32) -> f32 {
        let l2 = (f64::from(lambda) * 1e-3).powi(2);
        let n2 = self.b.iter().zip(self.c).fold(1.0, |n2, (b, c)| n2 + b * l2 / (l2 - c));
        n2.sqrt() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n at the helium d line and the Abbe number (n_d − 1)/(n_F − n_C), from the same data sheets.
    #[test]
    fn indices_and_abbe_numbers_are_those_of_the_catalogue() {
        let published = [
            ("BK7", 1.5168, 64.17),
            ("BAF10", 1.67003, 47.11),
            ("FK51A", 1.48656, 84.47),
            ("LASF9", 1.85025, 32.17),
            ("SF5", 1.67271, 32.25),
            ("SF10", 1.72828, 28.53),
            ("SF11", 1.78472, 25.68),
        ];
        for (name, n_d, abbe) in published {
            let glass = Glass::named(name).unwrap();
            let [d, f, c] = [587.5618, 486.1327, 656.2725].map(|l| f64::from(glass.eta(l)));
            assert!((d - n_d).abs() < 6e-6, "{name}: {d}");
            assert!(((d - 1.0) / (f - c) - abbe).abs() < 0.02, "{name}: {}", (d - 1.0) / (f - c));
        }
    }

    #[test]
    fn glasses_are_found_by_all_their_names() {
        assert_eq!(Glass::named("glass-f11").unwrap().name, "SF11");
        assert_eq!(Glass::named("N-SF5").unwrap().name, "SF5");
        assert!(Glass::named("glass-wine").is_none());
    }
}
