//! Complex indices of refraction of what mixtures are made of, by wavelength.
//!
//! An index `n + ik` absorbs `4πk/λ` per length.
//!
//! | substance | source | wavelengths |
//! |---|---|---|
//! | air | 1, clear | any |
//! | water | n: Hale and Querry 1973; k: Pope and Fry 1997, from 725 nm on Hale and Querry | 375 to 775 nm |
//! | sea water | n: Quan and Fry 1995, of salinity and temperature; k: that of water | 400 to 700 nm |
//! | milk serum | water, with the riboflavin of milk: 0.17 mg in 100 g (Fox and McSweeney 1998; Du et al. 1998) | 375 to 775 nm |
//! | milk fat | Michalski, Briard and Michel 2001 | 375 to 775 nm |
//! | casein | 1.503, clear (Attaie and Richtert 2000) | any |
//! | carbon | 1.95 + 0.79i, the highest that Bond and Bergstrom 2006 recommend, for 550 nm | visible |
//!
//! Water, serum and fat are those that Frisvad, Christensen and Jensen 2007 put together, every 25 nm (`data/`), linear
//! between; beyond the first and last wavelength the value there holds.

use std::{f64::consts::PI, sync::LazyLock};

use num_complex::Complex64;

/// The wavelengths of the tables [m], every 25 nm.
pub const WAVELENGTHS: [f64; 17] = {
    let mut wavelengths = [0.0; 17];
    let mut i = 0;
    while i < 17 {
        wavelengths[i] = (375 + 25 * i) as f64 * 1e-9;
        i += 1;
    }
    wavelengths
};

/// A substance. Units and sources stand [above](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Substance {
    /// Air, or nothing.
    Air,
    /// Pure water.
    Water,
    /// Water of the sea.
    SeaWater {
        /// Salt [g/kg], 0 to 35.
        salinity: f64,
        /// Temperature \[°C\], 0 to 30.
        temperature: f64,
    },
    /// What fat and casein of milk swim in.
    MilkSerum,
    /// Fat of milk.
    MilkFat,
    /// Micelles of casein, the protein of milk.
    Casein,
    /// Soot and carbon black.
    Carbon,
}

impl Substance {
    /// The index of refraction at a wavelength in vacuum [m].
    pub fn index(self, wavelength: f64) -> Complex64 {
        let table = |columns: [usize; 2]| {
            let [n, k] = columns.map(|column| at(column, wavelength));
            Complex64::new(n, k)
        };
        match self {
            Self::Air => Complex64::ONE,
            Self::Water => table([1, 2]),
            Self::SeaWater { salinity, temperature } => {
                Complex64::new(quan_fry(wavelength * 1e9, salinity, temperature), at(2, wavelength))
            }
            Self::MilkSerum => {
                let absorption = riboflavin(at(3, wavelength));
                table([1, 2]) + Complex64::I * (absorption * wavelength / (4.0 * PI))
            }
            Self::MilkFat => table([4, 5]),
            Self::Casein => Complex64::new(1.503, 0.0),
            Self::Carbon => Complex64::new(1.95, 0.79),
        }
    }

    /// What it absorbs [1/m].
    pub fn absorption(self, wavelength: f64) -> f64 {
        4.0 * PI * self.index(wavelength).im / wavelength
    }
}

/// What the riboflavin of milk absorbs [1/m] where a solution of PhotochemCAD has this absorbance. The molar absorption at
/// 266.5 nm is 3.3·10⁶ per M and m (Koziol 1966), the absorbance there 0.25654; 1 kg of milk, 1.030 g/cm³, has 1.7 mg of
/// 376.3682 g/mol.
fn riboflavin(absorbance: f64) -> f64 {
    let molar = 3.3e6 / 0.25654 * absorbance;
    10f64.ln() * (0.17 / 376.3682) / (100.0 / 1.030) * molar
}

/// Quan and Fry 1995, eq. 3: wavelength in nm, salinity in g/kg, temperature in °C.
fn quan_fry(l: f64, s: f64, t: f64) -> f64 {
    1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t + (15.868 + 0.01155 * s - 0.00423 * t) / l
        - 4382.0 / (l * l)
        + 1.1455e6 / (l * l * l)
}

static TABLE: LazyLock<Vec<[f64; 6]>> = LazyLock::new(|| {
    let lines = include_str!("../data/substances.csv").lines().filter(|line| !line.starts_with('#')).skip(1);
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|field| field.parse().expect("the committed table holds numbers"));
        std::array::from_fn(|_| numbers.next().expect("the committed table has six columns"))
    };
    lines.map(row).collect()
});

fn at(column: usize, wavelength: f64) -> f64 {
    let nanometres = (wavelength * 1e9).clamp(TABLE[0][0], TABLE[TABLE.len() - 1][0]);
    let above = TABLE.partition_point(|row| row[0] <= nanometres).clamp(1, TABLE.len() - 1);
    let [low, high] = [TABLE[above - 1], TABLE[above]];
    let share = (nanometres - low[0]) / (high[0] - low[0]);
    low[column] + share * (high[column] - low[column])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pope and Fry 1997: pure water absorbs 0.00663 per m at 400 nm, 0.0565 at 550 nm and 0.624 at 700 nm, printed here with the
    /// four digits of k.
    #[test]
    fn water_absorbs_what_pope_and_fry_measured() {
        for (nanometres, expected) in [(400.0, 0.00663), (550.0, 0.0565), (700.0, 0.624)] {
            let found = Substance::Water.absorption(nanometres * 1e-9);
            assert!((found / expected - 1.0).abs() < 1e-3, "{nanometres}: {found}");
        }
    }

    /// Two measurements of one liquid, at 20 °C and room temperature: Hale and Querry's has three decimals.
    #[test]
    fn sea_water_without_salt_is_water() {
        for wavelength in WAVELENGTHS.into_iter().filter(|l| (400e-9..=700e-9).contains(l)) {
            let sea = Substance::SeaWater { salinity: 0.0, temperature: 20.0 }.index(wavelength).re;
            let fresh = Substance::Water.index(wavelength).re;
            assert!((sea - fresh).abs() < 5e-3, "{wavelength}: {sea} {fresh}");
        }
    }

    #[test]
    fn tables_hold_at_their_wavelengths_are_linear_between_and_end_flat() {
        assert!(TABLE.iter().map(|row| row[0] * 1e-9).zip(WAVELENGTHS).all(|(a, b)| (a - b).abs() < 1e-15));
        let fat = |nanometres: f64| Substance::MilkFat.index(nanometres * 1e-9);
        assert!((fat(400.0).re - 1.476).abs() < 1e-12 && (fat(412.5).re - 1.4745).abs() < 1e-12);
        assert_eq!((fat(100.0), fat(2000.0)), (fat(375.0), fat(775.0)));
    }
}
