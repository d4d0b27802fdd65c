//! Numbers that read back to the same bits, as short as can be.

/// The shortest decimal of a number; with an exponent where that is shorter to read.
pub(super) fn double(v: f64) -> String {
    // A negative zero is a zero: no picture depends on it.
    let v = if v == 0.0 { 0.0 } else { v };
    let plain = v == 0.0 || (1e-4..1e9).contains(&v.abs());
    if plain { format!("{v}") } else { format!("{v:e}") }
}

/// The shortest decimal that a reader in double precision makes this single of.
pub(super) fn single(v: f32) -> String {
    let plain = v == 0.0 || (1e-4..1e9).contains(&v.abs());
    let short = if v == 0.0 {
        "0".into()
    } else if plain {
        format!("{v}")
    } else {
        format!("{v:e}")
    };
    // Rounded twice, the shortest decimal of a single could be its neighbour.
    let same = short.parse::<f64>().is_ok_and(|read| read as f32 == v);
    if same { short } else { double(f64::from(v)) }
}

/// Numbers with blanks between.
pub(super) fn doubles(values: &[f64]) -> String {
    values.iter().map(|v| double(*v)).collect::<Vec<_>>().join(" ")
}

/// The number with the fewest digits near `v` that `is_right`; `v` itself if there is no shorter one.
pub(super) fn shortest(v: f64, is_right: impl Fn(f64) -> bool) -> f64 {
    let digits = (1..17).map(|digits| format!("{v:.*e}", digits - 1));
    digits.filter_map(|text| text.parse().ok()).find(|short| is_right(*short)).unwrap_or(v)
}

/// The shortest number that is `v` in single precision: the same for all that are.
pub(super) fn as_single(v: f64) -> f64 {
    shortest(f64::from(v as f32), |short| short as f32 == v as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(doubles(&[0.1, -0.0, 1.0, 1e-7, 1e300, 0.1 + 0.2]), "0.1 0 1 1e-7 1e300 0.30000000000000004");
        assert_eq!((single(0.1), single(1e-7), single(16_777_216.0)), ("0.1".into(), "1e-7".into(), "16777216".into()));
        assert_eq!(shortest(0.1 + 0.2, |v| v as f32 == 0.3f32), 0.3);
    }

    proptest! {
        #[test]
        fn every_number_reads_back_to_its_bits(bits: u64) {
            let (d, s) = (f64::from_bits(bits), f32::from_bits(bits as u32));
            if d.is_finite() {
                prop_assert_eq!(double(d).parse::<f64>().unwrap(), d);
            }
            if s.is_finite() {
                prop_assert_eq!(single(s).parse::<f64>().unwrap() as f32, s);
            }
        }
    }
}
