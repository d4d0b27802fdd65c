//! Filters with negative lobes: Mitchell and Netravali's cubic, and the windowed sinc (Lanczos).
//!
//! Offsets are drawn with a density `q` that follows `|f|`, and a sample weighs `f/q`, with the filter's sign: the mean
//! of weighted samples is the filtered image at any number of samples, and their spread its standard error. The price of
//! the lobes is noise: samples of a white surface differ, with variance `(∫|f|)⁴ − 1` for a kernel of unit integral.
//!
//! | kernel | along each axis, `x` in pixels | parameters |
//! |---|---|---|
//! | Mitchell | the cubic `k(2x/r)` with coefficients `B` and `C`, zero from `|x| = r` on | `r` > 0 [pixels], `B`, `C` [1] |
//! | sinc | `sinc(x)·sinc(x/τ)`, cut off at `|x| = r`; `sinc(x) = sin(πx)/(πx)` | `r`, `τ` > 0 [pixels] |
//!
//! Sources: Mitchell and Netravali 1988, eq. 8; Duchon 1979 (Lanczos's window); Ernst et al. 2006 (sampling).

use crate::sampling::discrete::Discrete;

/// A kernel along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kernel {
    /// Mitchell and Netravali's cubic.
    Mitchell {
        /// Their B [1]: how much of a B-spline it is.
        b: f64,
        /// Their C [1]: how much of a cardinal cubic it is.
        c: f64,
    },
    /// A sinc, windowed by a wider one.
    Sinc {
        /// Where the window first vanishes [pixels].
        tau: f64,
    },
}

impl Kernel {
    /// Its value at `x` [pixels] for half width `radius` [pixels].
    fn eval(&self, x: f64, radius: f64) -> f64 {
        match *self {
            Self::Mitchell { b, c } => cubic(2.0 * x.abs() / radius, b, c),
            Self::Sinc { tau } => sinc(x) * sinc(x / tau),
        }
    }
}

/// Mitchell and Netravali's `k(x)`, `x ≥ 0`, without their factor 1/6.
fn cubic(x: f64, b: f64, c: f64) -> f64 {
    if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x + (-18.0 + 12.0 * b + 6.0 * c)) * x * x + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (((-b - 6.0 * c) * x + (6.0 * b + 30.0 * c)) * x + (-12.0 * b - 48.0 * c)) * x + (8.0 * b + 24.0 * c)
    } else {
        0.0
    }
}

/// `sin(πx)/(πx)`.
fn sinc(x: f64) -> f64 {
    let x = std::f64::consts::PI * x;
    if x.abs() < 1e-6 { 1.0 } else { libm::sin(x) / x }
}

/// Cells along an axis in which the density is constant.
const CELLS: usize = 512;
/// Where a cell is looked at, in parts of it: Gauss's four points, and their weights.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// One axis, ready to be sampled.
#[derive(Debug, Clone, PartialEq)]
struct Axis {
    kernel: Kernel,
    /// Half width [pixels].
    radius: f64,
    /// `1/∫f` [1/pixel].
    scale: f64,
    cells: Discrete,
}

impl Axis {
    /// `None` for a kernel whose lobes all but cancel, or that is not finite.
    fn new(kernel: Kernel, radius: f64) -> Option<Self> {
        let width = 2.0 * radius / CELLS as f64;
        let (mut integral, mut absolute) = (0.0, 0.0);
        let mut cells = Vec::with_capacity(CELLS);
        for cell in 0..CELLS {
            let mut weight = 0.0;
            for (place, share) in GAUSS {
                let f = share * width * kernel.eval((cell as f64 + place) * width - radius, radius);
                integral += f;
                weight += f.abs();
            }
            absolute += weight;
            cells.push(weight);
        }
        // Weights of a thousand would drown any image in noise.
        (integral > 1e-3 * absolute).then_some(())?;
        Some(Self { kernel, radius, scale: 1.0 / integral, cells: Discrete::from_f64(cells)? })
    }

    /// An offset [pixels] and its weight `f/q` [1].
    #[inline]
    fn sample(&self, u: f32) -> (f32, f32) {
        let (cell, probability, rest) = self.cells.sample(u);
        let width = 2.0 * self.radius / CELLS as f64;
        let x = (cell as f64 + f64::from(rest)) * width - self.radius;
        let weight = self.kernel.eval(x, self.radius) * self.scale * width / f64::from(probability);
        (x as f32, weight as f32)
    }
}

/// A product of two kernels, of unit integral.
#[derive(Debug, Clone, PartialEq)]
pub struct Lobed(Box<[Axis; 2]>);

impl Lobed {
    /// The filter of a kernel and half widths [pixels]. `None` where its lobes cancel, or a number is not finite.
    pub fn new(kernel: Kernel, radius: [f32; 2]) -> Option<Self> {
        let [x, y] = radius.map(|r| Axis::new(kernel, f64::from(r)));
        Some(Self(Box::new([x?, y?])))
    }

    /// An offset from the pixel's centre [pixels], and its weight [1].
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let [(x, weight_x), (y, weight_y)] = [self.0[0].sample(u[0]), self.0[1].sample(u[1])];
        ([x, y], weight_x * weight_y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments `∫ x^k f dx` of a filter of unit integral. Integrating the pieces of the cubic gives `∫x²k(x)dx =
    /// (2 + 3B − 4C)/15` in its own units, of which one is half the radius.
    #[test]
    fn weighted_offsets_have_the_moments_of_the_cubic() {
        for (b, c, radius) in [(1.0 / 3.0, 1.0 / 3.0, 2.0), (0.0, 0.5, 2.0), (1.0, 0.0, 3.0), (0.2, 0.9, 1.0)] {
            let filter = Lobed::new(Kernel::Mitchell { b, c }, [radius as f32; 2]).unwrap();
            let n = 200_000;
            let mut moments = [0.0; 3];
            for i in 0..n {
                let ([x, _], weight) = filter.sample([(i as f32 + 0.5) / n as f32, 0.43]);
                let ([_, _], other) = filter.sample([0.57, 0.43]);
                let ([_, _], middle) = filter.sample([0.57, 0.57]);
                // The weight along y is the same for all: √(w(0.57)·w(0.57)) there, by symmetry of 0.43 and 0.57.
                let along_y = f64::from(middle).sqrt() * f64::from(other / middle);
                for (k, m) in moments.iter_mut().enumerate() {
                    *m += f64::from(weight) / along_y * f64::from(x).powi(k as i32) / f64::from(n);
                }
            }
            let second = (2.0 + 3.0 * b - 4.0 * c) / 15.0 * (radius / 2.0) * (radius / 2.0);
            assert!((moments[0] - 1.0).abs() < 1e-4, "B = {b}, C = {c}: {moments:?}");
            assert!(moments[1].abs() < 1e-4, "B = {b}, C = {c}: {moments:?}");
            assert!((moments[2] - second).abs() < 1e-3, "B = {b}, C = {c}: {moments:?}, expected {second}");
        }
    }

    /// The cubic with B = 0 and every Lanczos window is 1 at 0 and 0 at whole pixels.
    #[test]
    fn interpolating_kernels_vanish_at_the_other_pixels() {
        for (kernel, radius, one) in
            [(Kernel::Mitchell { b: 0.0, c: 0.5 }, 2.0, 6.0), (Kernel::Sinc { tau: 3.0 }, 3.0, 1.0)]
        {
            assert!((kernel.eval(0.0, radius) - one).abs() < 1e-12);
            for x in [1.0, 2.0, -1.0, -2.0] {
                assert!(kernel.eval(x, radius).abs() < 1e-12, "{kernel:?} at {x}");
            }
        }
    }

    #[test]
    fn kernels_that_are_no_filter_are_refused() {
        for (kernel, radius) in [
            (Kernel::Mitchell { b: 1e30, c: 0.0 }, 2.0),
            (Kernel::Mitchell { b: 0.0, c: f64::NAN }, 2.0),
            (Kernel::Sinc { tau: 3.0 }, f32::INFINITY),
            (Kernel::Sinc { tau: 1e-300 }, 4.0),
        ] {
            assert!(Lobed::new(kernel, [radius; 2]).is_none(), "{kernel:?}");
        }
    }
}
