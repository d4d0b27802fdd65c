//! The CIE 1931 2° standard observer and the standard illuminant D65, and integrals against them.
//!
//! The table holds 360 to 830 nm at 1 nm; between entries it is linear, beyond it is zero. Its source stands on top of
//! `cie_1931_d65.csv`.

use std::sync::LazyLock;

/// The shortest wavelength that is seen [nm].
pub const LAMBDA_MIN: f32 = 360.0;
/// The longest wavelength that is seen [nm].
pub const LAMBDA_MAX: f32 = 830.0;
/// Entries of the table, 1 nm apart.
const ENTRIES: usize = 471;

/// `(x̄, ȳ, z̄)/∫ȳ` [1/nm] and D65 of luminance 1.
struct Table {
    observer: [[f32; 3]; ENTRIES],
    d65: [f32; ENTRIES],
}

static TABLE: LazyLock<Table> = LazyLock::new(|| {
    let rows: Vec<[f64; 5]> = include_str!("cie_1931_d65.csv")
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| {
            let mut fields = line.split(',').map(|f| f.parse().expect("the committed table holds numbers"));
            std::array::from_fn(|_| fields.next().expect("the committed table has five columns"))
        })
        .collect();
    // Linear entries at unit spacing: the trapezoid rule is exact for ∫ȳ; for ∫ȳ·D65, a product, nearly so.
    let y_integral: f64 = rows.iter().map(|row| row[2]).sum();
    let d65_luminance: f64 = rows.iter().map(|row| row[2] * row[4]).sum::<f64>() / y_integral;
    Table {
        observer: std::array::from_fn(|i| [1, 2, 3].map(|c| (rows[i][c] / y_integral) as f32)),
        d65: std::array::from_fn(|i| (rows[i][4] / d65_luminance) as f32),
    }
});

/// Index and fraction of `lambda` [nm] in the table.
fn locate(lambda: f32) -> Option<(usize, f32)> {
    if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
        return None;
    }
    let x = lambda - LAMBDA_MIN;
    let i = (x as usize).min(ENTRIES - 2);
    Some((i, x - i as f32))
}

/// The observer's `(x̄, ȳ, z̄)` at `lambda` [nm] over ∫ȳ [1/nm].
#[inline]
pub fn observer(lambda: f32) -> [f32; 3] {
    let Some((i, f)) = locate(lambda) else { return [0.0; 3] };
    let (a, b) = (TABLE.observer[i], TABLE.observer[i + 1]);
    std::array::from_fn(|c| a[c] + f * (b[c] - a[c]))
}

/// Illuminant D65 at `lambda` [nm], scaled to luminance 1.
#[inline]
pub fn d65(lambda: f32) -> f32 {
    let Some((i, f)) = locate(lambda) else { return 0.0 };
    TABLE.d65[i] + f * (TABLE.d65[i + 1] - TABLE.d65[i])
}

/// Tristimulus values `∫ f(λ) (x̄, ȳ, z̄) dλ / ∫ȳ dλ` of an emission.
///
/// `breaks` are further wavelengths [nm], increasing, between which `f` is smooth. Simpson's rule on each piece between
/// these and the table's entries is exact for piecewise linear `f`, also times D65.
pub fn xyz(breaks: &[f32], f: impl Fn(f32) -> f64) -> [f64; 3] {
    let mut nodes: Vec<f32> = (0..ENTRIES).map(|i| LAMBDA_MIN + i as f32).collect();
    nodes.extend(breaks.iter().filter(|l| (LAMBDA_MIN..LAMBDA_MAX).contains(*l)));
    nodes.sort_by(f32::total_cmp);
    let integrand = |lambda: f32| observer(lambda).map(|response| f64::from(response) * f(lambda));
    let mut sum = [0.0; 3];
    for piece in nodes.windows(2).filter(|piece| piece[1] > piece[0]) {
        let width = f64::from(piece[1] - piece[0]);
        let ends = [integrand(piece[0]), integrand(0.5 * (piece[0] + piece[1])), integrand(piece[1])];
        for (c, s) in sum.iter_mut().enumerate() {
            *s += width / 6.0 * (ends[0][c] + 4.0 * ends[1][c] + ends[2][c]);
        }
    }
    sum
}

/// Tristimulus values of a reflectance `f` under D65: white is that of D65.
pub fn xyz_under_d65(breaks: &[f32], f: impl Fn(f32) -> f64) -> [f64; 3] {
    xyz(breaks, |lambda| f64::from(d65(lambda)) * f(lambda))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE 015: D65 has chromaticity (0.31272, 0.32903), the sums of the observer at 1 nm are 106.8655,
    /// 106.8569 and 106.8923, so that equal energy is (1/3, 1/3) to 5e-5 only.
    #[test]
    fn whites_have_their_published_chromaticities() {
        let chromaticity = |[x, y, z]: [f64; 3]| [x / (x + y + z), y / (x + y + z)];
        let [x, y] = chromaticity(xyz_under_d65(&[], |_| 1.0));
        assert!((x - 0.31272).abs() < 2e-5 && (y - 0.32903).abs() < 2e-5, "{x} {y}");
        let [x, y] = chromaticity(xyz(&[], |_| 1.0));
        assert!((x - 106.8655 / 320.6147).abs() < 2e-6 && (y - 106.8569 / 320.6147).abs() < 2e-6, "{x} {y}");
    }

    /// CIE 015: ∫ȳ at 1 nm is 106.8569, ȳ is 1 at 555 nm.
    #[test]
    fn luminances_of_the_flat_spectrum_and_of_d65_are_one() {
        assert!((observer(555.0)[1] - 1.0 / 106.8569).abs() < 1e-8);
        assert!((xyz(&[], |_| 1.0)[1] - 1.0).abs() < 1e-6);
        assert!((xyz_under_d65(&[], |_| 1.0)[1] - 1.0).abs() < 2e-5);
        assert_eq!((observer(359.0), observer(831.0), d65(f32::NAN)), ([0.0; 3], [0.0; 3], 0.0));
    }
}
