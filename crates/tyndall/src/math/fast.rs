//! Elementary functions that scalar and SIMD code share: small polynomials without fused operations, so that every
//! instruction set gives the same bits. Long ones are summed in pairs (Estrin 1960), which need not wait for each other. Tested
//! against `f64`.

/// Natural logarithm of `x` in `(0, 1]` or any positive normal number; relative error below 3·10⁻⁷ away from 1,
/// absolute error below 1·10⁻⁷ near 1.
///
/// Argument reduction to `[√½, √2)` and the polynomial of Cephes `logf` (Moshier 1989).
#[inline]
pub fn ln(x: f32) -> f32 {
    let bits = x.to_bits();
    // The exponent of x / √½: shifts the mantissa's range to [√½, √2).
    let shifted = bits.wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32) >> 23;
    let mantissa = f32::from_bits(bits.wrapping_sub((exponent as u32) << 23));
    let e = exponent as f32;
    let f = mantissa - 1.0;
    let f2 = f * f;
    let f4 = f2 * f2;
    let low = (3.333_333_1e-1 - 2.499_999_4e-1 * f) + (2.000_071_5e-1 - 1.666_805_7e-1 * f) * f2;
    let high = (1.424_932_3e-1 - 1.242_014_1e-1 * f) + (1.167_699_9e-1 - 1.151_461e-1 * f) * f2;
    let p = low + high * f4 + 7.037_683_6e-2 * (f4 * f4);
    let y = p * f * f2 - 2.121_944_4e-4 * e - 0.5 * f2;
    f + y + 0.693_359_4 * e
}

/// `eˣ`; relative error below 2·10⁻⁷; 0 where the result would be denormal, infinite above 88, and NaN for NaN.
///
/// Argument reduction to `[−½ ln 2, ½ ln 2]` and the polynomial of Cephes `expf` (Moshier 1989).
#[inline]
pub fn exp(x: f32) -> f32 {
    let held = if x < -87.0 { -87.0 } else { x };
    let (n, whole) = nearest(held * std::f32::consts::LOG2_E);
    let r = held - n * 0.693_359_4 + n * 2.121_944_4e-4;
    let r2 = r * r;
    let low = (5e-1 + 1.666_666_5e-1 * r) + (4.166_579_6e-2 + 8.333_452e-3 * r) * r2;
    let p = low + (1.398_2e-3 + 1.987_569_1e-4 * r) * (r2 * r2);
    let y = p * r2 + r + 1.0;
    let power = f32::from_bits(whole.wrapping_add(127) << 23);
    if x > 88.0 {
        f32::INFINITY
    } else if x < -87.0 {
        0.0
    } else {
        y * power
    }
}

/// The whole number nearest to `x`, for |x| < 2²², also as an integer: no rounding instruction and no checked cast, which
/// compilers do one lane at a time.
#[inline]
fn nearest(x: f32) -> (f32, u32) {
    const SHIFT: f32 = 12_582_912.0; // 1.5 · 2²³: above it, numbers are whole
    let shifted = x + SHIFT;
    (shifted - SHIFT, shifted.to_bits().wrapping_sub(SHIFT.to_bits()))
}

/// `(sin 2πu, cos 2πu)` for `u` in `[0, 1]`; absolute error below 2·10⁻⁷.
#[inline]
pub fn sin_cos_turn(u: f32) -> (f32, f32) {
    // Nearest quarter turn, and the rest in [−π/4, π/4].
    let (quarters, q) = nearest(4.0 * u);
    let x = (4.0 * u - quarters) * std::f32::consts::FRAC_PI_2;
    let x2 = x * x;
    let s = x + x * x2 * (-1.666_665_5e-1 + x2 * (8.332_160_9e-3 + x2 * -1.951_529_6e-4));
    let c = 1.0 - 0.5 * x2 + x2 * x2 * (4.166_664_6e-2 + x2 * (-1.388_731_6e-3 + x2 * 2.443_315_7e-5));
    let (s, c) = if q & 1 == 0 { (s, c) } else { (c, s) };
    let sin = if q & 2 == 0 { s } else { -s };
    let cos = if (q + 1) & 2 == 0 { c } else { -c };
    (sin, cos)
}

/// The angle of the vector `(x, y)`, finite, in `[−π, π]` [rad]; absolute error below 3·10⁻⁸; 0 for no vector.
///
/// The polynomial of Abramowitz and Stegun 1964, 4.4.49, on the octant.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    let (ax, ay) = (x.abs(), y.abs());
    let (least, greatest) = (ax.min(ay), ax.max(ay));
    let t = if greatest > 0.0 { least / greatest } else { 0.0 };
    let t2 = t * t;
    let t4 = t2 * t2;
    let low = (-3.333_314_528e-1 + 1.999_355_085e-1 * t2) + (-1.420_889_944e-1 + 1.065_626_393e-1 * t2) * t4;
    let high = (-7.528_964_00e-2 + 4.290_961_38e-2 * t2) + (-1.616_573_67e-2 + 2.866_225_7e-3 * t2) * t4;
    let p = low + high * (t4 * t4);
    let octant = t + t * t2 * p;
    let quadrant = if ay > ax { FRAC_PI_2 - octant } else { octant };
    (if x < 0.0 { PI - quadrant } else { quadrant }).copysign(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_of_a_vector_agrees_with_that_of_the_library() {
        for i in 0..=1_000_000u32 {
            let angle = (f64::from(i) / 500_000.0 - 1.0) * std::f64::consts::PI;
            let (y, x) = (1e-3 * angle.sin(), 1e-3 * angle.cos());
            assert!((atan2(y, x) - y.atan2(x)).abs() < 3e-8, "{angle}");
        }
        assert_eq!((atan2(0.0, 0.0), atan2(0.0, 2.0)), (0.0, 0.0));
        assert_eq!(atan2(0.0, -1.0), std::f64::consts::PI);
        assert_eq!(atan2(-1e-300, 0.0), -std::f64::consts::FRAC_PI_2);
    }

    #[test]
    fn the_logarithm_agrees_with_double_precision() {
        for i in 1..=2_000_000u32 {
            let x = i as f32 / 2_000_000.0;
            let exact = f64::from(x).ln();
            let error = (f64::from(ln(x)) - exact).abs();
            assert!(error <= 1e-7 + 1.5e-7 * exact.abs(), "ln({x}) is off by {error}");
        }
        for x in [f32::MIN_POSITIVE, 1e-30, 3.0, 1e30, f32::MAX] {
            assert!((f64::from(ln(x)) / f64::from(x).ln() - 1.0).abs() < 2e-7, "{x}");
        }
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn the_exponential_agrees_with_double_precision() {
        for i in -8_700_000..=8_800_000i32 {
            let x = i as f32 / 100_000.0;
            let exact = f64::from(x).exp();
            assert!((f64::from(exp(x)) / exact - 1.0).abs() < 2e-7, "exp({x})");
        }
        assert_eq!((exp(0.0), exp(-1e4), exp(f32::NEG_INFINITY)), (1.0, 0.0, 0.0));
        assert!(exp(f32::NAN).is_nan() && exp(100.0) == f32::INFINITY && exp(f32::INFINITY) == f32::INFINITY);
    }

    #[test]
    fn sine_and_cosine_agree_with_double_precision() {
        for i in 0..=1_000_000u32 {
            let u = i as f32 / 1_000_000.0;
            let (s, c) = sin_cos_turn(u);
            let (es, ec) = (f64::from(u) * std::f64::consts::TAU).sin_cos();
            assert!((f64::from(s) - es).abs() < 2e-7 && (f64::from(c) - ec).abs() < 2e-7, "{u}");
        }
        assert_eq!(sin_cos_turn(0.0), (0.0, 1.0));
    }
}
