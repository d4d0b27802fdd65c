//! Spectra by name: complex indices of metals (`"metal-Cu-eta"`, `"metal-Cu-k"`) and standard illuminants (`"stdillum-A"`).
//!
//! | names | what | values |
//! |---|---|---|
//! | `metal-*-eta`, `metal-*-k` | real and imaginary part of an index of refraction \[1\] | 42 substances, at their published wavelengths |
//! | `stdillum-A`, `stdillum-D50`, `stdillum-F1` to `stdillum-F12` | illuminants of CIE 015 \[relative\] | 5 nm apart |
//! | `illum-acesD60` | the white of ACES \[relative\] | 5 nm apart |
//!
//! The names are those of pbrt-v4; the metals that only Mitsuba 3 knows are named in the same way after its `material`
//! words (`metal-W-eta`). Glasses and D65 have formulas and a table of their own in `tyndall::spectrum`.
//! A table holds what was published between 360 and 830 nm; where it ends earlier, the last value goes on (as in pbrt-v4).
//! Where the numbers come from is said on top of `data/spectra.txt`.
//!
//! ```
//! let gold = tyndall_optics::spectra::named("metal-Au-k").unwrap();
//! assert!(gold.lambda.len() == gold.values.len() && gold.values[0] > 1.0);
//! ```

use std::sync::LazyLock;

/// A table of values at wavelengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    /// Its name.
    pub name: &'static str,
    /// Wavelengths [nm], increasing, from at most 360 to at least 830.
    pub lambda: Vec<f32>,
    /// Values, as many.
    pub values: Vec<f32>,
}

/// All tables.
pub fn all() -> &'static [Tabulated] {
    &TABLES
}

/// The names of all tables.
pub fn names() -> impl Iterator<Item = &'static str> {
    TABLES.iter().map(|t| t.name)
}

/// The table of a name. `metal-W_palik-eta` is that of `metal-W-eta` where there is no other.
pub fn named(name: &str) -> Option<&'static Tabulated> {
    let exactly = |name: &str| TABLES.iter().find(|t| t.name == name);
    exactly(name).or_else(|| exactly(&name.replace("_palik", "")))
}

/// The substances whose complex index is known: `"Ag"`, `"Al"`.
pub fn metals() -> impl Iterator<Item = &'static str> {
    names().filter_map(|name| name.strip_prefix("metal-")?.strip_suffix("-eta"))
}

static TABLES: LazyLock<Vec<Tabulated>> = LazyLock::new(|| {
    let lines = include_str!("../data/spectra.txt").lines().filter(|line| !line.starts_with('#'));
    lines.map(table).collect()
});

fn table(line: &'static str) -> Tabulated {
    let number = |text: &str| text.parse::<f32>().expect("the committed table holds numbers");
    let mut words = line.split(' ');
    let name = words.next().expect("a line has a name");
    let pairs = words.map(|pair| pair.split_once(':').expect("the committed table holds pairs"));
    let (mut lambda, mut values): (Vec<_>, Vec<_>) = pairs.map(|(l, v)| (number(l), number(v))).unzip();
    let (first, last) = (values[0], values[values.len() - 1]);
    if lambda[0] > 360.0 {
        lambda.insert(0, 359.0);
        values.insert(0, first);
    }
    if lambda[lambda.len() - 1] < 830.0 {
        lambda.push(831.0);
        values.push(last);
    }
    Tabulated { name, lambda, values }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(name: &str, lambda: f32) -> f32 {
        let t = named(name).unwrap();
        let i = t.lambda.partition_point(|&l| l <= lambda).clamp(1, t.lambda.len() - 1);
        let f = (lambda - t.lambda[i - 1]) / (t.lambda[i] - t.lambda[i - 1]);
        t.values[i - 1] + f * (t.values[i] - t.values[i - 1])
    }

    #[test]
    fn tables_increase_and_cover_all_that_is_seen() {
        assert!(all().len() > 90);
        for t in all() {
            assert!(t.lambda.windows(2).all(|w| w[0] < w[1]), "{}", t.name);
            assert!(t.lambda[0] <= 360.0 && t.lambda[t.lambda.len() - 1] >= 830.0, "{}", t.name);
            assert!(t.lambda.len() == t.values.len() && t.values.iter().all(|v| v.is_finite() && *v >= 0.0));
            assert!(!t.name.ends_with("-eta") || t.values.iter().all(|v| *v > 0.0), "{}", t.name);
        }
        assert!(metals().all(|m| named(&format!("metal-{m}-k")).is_some()));
    }

    /// Johnson and Christy 1972, another measurement: Ag at 563.6 nm 0.06 + 3.75i, Au at 563.6 nm 0.31 + 2.88i, Cu at
    /// 616.8 nm 0.30 + 3.21i. Films differ by several hundredths in n and a tenth in k.
    #[test]
    fn noble_metals_agree_with_another_measurement() {
        for (metal, lambda, eta, k) in [("Ag", 563.6, 0.06, 3.75), ("Au", 563.6, 0.31, 2.88), ("Cu", 616.8, 0.30, 3.21)]
        {
            let found = [at(&format!("metal-{metal}-eta"), lambda), at(&format!("metal-{metal}-k"), lambda)];
            assert!((found[0] - eta).abs() < 0.12 && (found[1] - k).abs() < 0.35, "{metal}: {found:?}");
        }
    }

    /// CIE 015 defines illuminant A by Planck's law at 2848 K with c₂ = 1.435·10⁷ nm·K, 100 at 560 nm.
    #[test]
    fn illuminant_a_is_the_formula_of_the_cie() {
        let hot = |l: f64| (1.435e7 / (2848.0 * l)).exp_m1();
        let planck = |l: f64| (560.0 / l).powi(5) * hot(560.0) / hot(l);
        for lambda in [400.0f32, 500.0, 600.0, 700.0, 800.0] {
            let expected = 100.0 * planck(f64::from(lambda));
            assert!((f64::from(at("stdillum-A", lambda)) / expected - 1.0).abs() < 1e-4, "{lambda}");
        }
    }

    #[test]
    fn names_after_palik_fall_back_to_the_one_measurement() {
        assert_eq!(named("metal-Hg_palik-k").unwrap().name, "metal-Hg-k");
        assert_eq!(named("metal-Cu_palik-k").unwrap().name, "metal-Cu_palik-k");
        assert!(named("metal-Unobtainium-k").is_none());
    }
}
