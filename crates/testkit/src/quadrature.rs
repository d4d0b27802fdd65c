//! Integrals without chance: is a density normalised, what is an albedo.
//!
//! - [`gauss_legendre`]: n nodes, exact for polynomials of degree 2n − 1; nodes by Newton's method on Pₙ.
//! - [`adaptive_simpson`]: Simpson's rule, halved until Richardson's estimate is below the tolerance (Lyness 1969).
//! - [`adaptive_rectangle`]: Gauss–Legendre on a rectangle, quartered likewise: for peaks and edges.
//! - [`sphere`], [`hemisphere`]: Gauss–Legendre in cos θ times the trapezoid rule in φ, which converges geometrically on
//!   a circle; and [`sphere_adaptive`] for peaked densities.

use std::f64::consts::{PI, TAU};

/// Nodes and weights of Gauss–Legendre quadrature on [−1, 1].
pub fn gauss_legendre_rule(n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            // Tricomi's first guess, then Newton.
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut previous) = (1.0, 0.0);
                for k in 1..=n {
                    let k = k as f64;
                    (p, previous) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * previous) / k, p);
                }
                slope = n as f64 * (x * p - previous) / (x * x - 1.0);
                x -= p / slope;
            }
            [x, 2.0 / ((1.0 - x * x) * slope * slope)]
        })
        .collect()
}

/// ∫ f over [a, b] with n nodes.
pub fn gauss_legendre(n: usize, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    gauss_legendre_rule(n).iter().map(|[x, w]| half * w * f(middle + half * x)).sum()
}

/// ∫ f over [a, b] to the absolute `tolerance`.
pub fn adaptive_simpson(a: f64, b: f64, tolerance: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// A piece with its values at ends and middle, and Simpson's estimate.
    struct Piece {
        ends: [f64; 2],
        values: [f64; 3],
        estimate: f64,
        tolerance: f64,
        depth: u32,
    }
    let simpson = |width: f64, v: [f64; 3]| width / 6.0 * (v[0] + 4.0 * v[1] + v[2]);
    let values = [f(a), f(0.5 * (a + b)), f(b)];
    let mut pieces = vec![Piece { ends: [a, b], values, estimate: simpson(b - a, values), tolerance, depth: 0 }];
    let mut sum = 0.0;
    while let Some(piece) = pieces.pop() {
        let [a, b] = piece.ends;
        let m = 0.5 * (a + b);
        let [va, vm, vb] = piece.values;
        let (left, right) = ([va, f(0.5 * (a + m)), vm], [vm, f(0.5 * (m + b)), vb]);
        let (sl, sr) = (simpson(m - a, left), simpson(b - m, right));
        let error = (sl + sr - piece.estimate) / 15.0;
        // The first halvings are made anyway: a narrow peak may hide between three points.
        if (piece.depth >= 4 && error.abs() <= piece.tolerance) || piece.depth >= 48 {
            sum += sl + sr + error;
            continue;
        }
        let (tolerance, depth) = (0.5 * piece.tolerance, piece.depth + 1);
        pieces.push(Piece { ends: [a, m], values: left, estimate: sl, tolerance, depth });
        pieces.push(Piece { ends: [m, b], values: right, estimate: sr, tolerance, depth });
    }
    sum
}

/// ∫∫ f over `x` × `y`: 5 × 5 nodes, quartered at most `depth` times where a quarter disagrees by more than `tolerance`.
pub fn adaptive_rectangle(x: [f64; 2], y: [f64; 2], tolerance: f64, depth: u32, f: &impl Fn([f64; 2]) -> f64) -> f64 {
    let rule = gauss_legendre_rule(5);
    refine(&rule, x, y, cell(&rule, x, y, f), tolerance, depth, f)
}

fn cell(rule: &[[f64; 2]], x: [f64; 2], y: [f64; 2], f: &impl Fn([f64; 2]) -> f64) -> f64 {
    let (mx, hx, my, hy) = (0.5 * (x[0] + x[1]), 0.5 * (x[1] - x[0]), 0.5 * (y[0] + y[1]), 0.5 * (y[1] - y[0]));
    let mut sum = 0.0;
    for [tx, wx] in rule {
        for [ty, wy] in rule {
            sum += wx * wy * f([mx + hx * tx, my + hy * ty]);
        }
    }
    sum * hx * hy
}

fn refine(
    rule: &[[f64; 2]],
    x: [f64; 2],
    y: [f64; 2],
    estimate: f64,
    tolerance: f64,
    depth: u32,
    f: &impl Fn([f64; 2]) -> f64,
) -> f64 {
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let quarters =
        [([x[0], mx], [y[0], my]), ([mx, x[1]], [y[0], my]), ([x[0], mx], [my, y[1]]), ([mx, x[1]], [my, y[1]])];
    let estimates = quarters.map(|(x, y)| cell(rule, x, y, f));
    let sum: f64 = estimates.iter().sum();
    if depth == 0 || (sum - estimate).abs() <= tolerance {
        return sum;
    }
    quarters.iter().zip(estimates).map(|(&(x, y), e)| refine(rule, x, y, e, 0.25 * tolerance, depth - 1, f)).sum()
}

/// The unit vector of a polar cosine and an azimuth.
pub fn direction([cos_theta, phi]: [f64; 2]) -> [f64; 3] {
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    [sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta]
}

/// ∫ f dω over the part of the sphere with cos θ in `cos`, with n × 2n nodes.
fn zone(n: usize, cos: [f64; 2], f: impl Fn([f64; 3]) -> f64) -> f64 {
    let m = 2 * n;
    let step = TAU / m as f64;
    let ring = |c: f64| (0..m).map(|j| f(direction([c, (j as f64 + 0.5) * step]))).sum::<f64>() * step;
    gauss_legendre(n, cos[0], cos[1], ring)
}

/// ∫ f dω over the sphere, n × 2n nodes; for densities that are smooth there.
pub fn sphere(n: usize, f: impl Fn([f64; 3]) -> f64) -> f64 {
    zone(n, [-1.0, 1.0], f)
}

/// ∫ f dω over the hemisphere z > 0, n × 2n nodes.
pub fn hemisphere(n: usize, f: impl Fn([f64; 3]) -> f64) -> f64 {
    zone(n, [0.0, 1.0], f)
}

/// ∫ f dω over the sphere, refined where f is peaked or breaks off; `tolerance` is absolute.
pub fn sphere_adaptive(tolerance: f64, f: impl Fn([f64; 3]) -> f64) -> f64 {
    let (rows, columns) = (8, 16);
    let mut sum = 0.0;
    for i in 0..rows {
        for j in 0..columns {
            let x = [i, i + 1].map(|i| -1.0 + 2.0 * f64::from(i) / f64::from(rows));
            let y = [j, j + 1].map(|j| TAU * f64::from(j) / f64::from(columns));
            sum += adaptive_rectangle(x, y, tolerance / f64::from(rows * columns), 10, &|p| f(direction(p)));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::close;

    /// ∫₋₁¹ x^(2k) dx = 2/(2k + 1), exact up to degree 2n − 1.
    #[test]
    fn gauss_legendre_is_exact_for_polynomials() {
        for n in [1, 2, 5, 20, 64] {
            for k in 0..n {
                let value = gauss_legendre(n as usize, -1.0, 1.0, |x| x.powi(2 * k));
                assert!((value - 2.0 / f64::from(2 * k + 1)).abs() < 1e-14, "n = {n}, k = {k}: {value}");
            }
        }
    }

    #[test]
    fn simpson_adapts_to_peaks_and_edges() {
        // ∫ 1/(x² + ε²) = 2/ε atan(1/ε).
        let e = 1e-3f64;
        let value = adaptive_simpson(-1.0, 1.0, 1e-8, |x| 1.0 / (x * x + e * e));
        assert!((value - 2.0 / e * (1.0 / e).atan()).abs() < 1e-6, "{value}");
        let edge = adaptive_simpson(0.0, 1.0, 1e-9, |x| if x < 0.3 { 1.0 } else { 0.0 });
        assert!((edge - 0.3).abs() < 1e-8, "{edge}");
    }

    /// ∫ dω = 4π, ∫ z² dω = 4π/3, ∫ cos⁺ dω = π; a Henyey–Greenstein lobe of g = 0.95 has integral 1.
    #[test]
    fn spheres_have_their_moments() {
        assert!((sphere(4, |_| 1.0) - 4.0 * PI).abs() < 1e-12);
        for axis in 0..3 {
            assert!((sphere(4, |d| d[axis] * d[axis]) - 4.0 * PI / 3.0).abs() < 1e-12);
        }
        assert!((hemisphere(4, |d| d[2]) - PI).abs() < 1e-12);
        let g = 0.95f64;
        let lobe = |d: [f64; 3]| (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * d[0]).powf(1.5));
        assert!((sphere_adaptive(1e-6, lobe) - 1.0).abs() < 1e-5);
    }

    /// What χ² misses.
    #[test]
    fn a_density_that_is_one_per_cent_too_large_fails() {
        let density = |scale: f64| sphere(8, |_| scale / (4.0 * PI));
        assert_eq!(close(density(1.0), 1.0, 1e-6).p, 1.0);
        assert_eq!(close(density(1.01), 1.0, 1e-6).p, 0.0);
        assert_eq!(close(f64::NAN, 1.0, 1e-6).p, 0.0);
    }
}
