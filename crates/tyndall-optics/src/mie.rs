//! A homogeneous sphere in a plane wave, by Lorenz and Mie: what it takes away, and where it sends it.
//!
//! Time runs as `exp(−iωt)`, so that an index `n + ik` with `k > 0` absorbs. With `x = 2π r n_host/λ` and
//! `y = 2π r n_sphere/λ`, both complex, and `m = n_sphere/n_host`,
//!
//! ```text
//! a_n = [(D_n/m + n/x) ψ_n(x) − ψ_{n−1}(x)] / [(D_n/m + n/x) ζ_n(x) − ζ_{n−1}(x)],     D_n = ψ'_n(y)/ψ_n(y)
//! b_n = [(m D_n + n/x) ψ_n(x) − ψ_{n−1}(x)] / [(m D_n + n/x) ζ_n(x) − ζ_{n−1}(x)]
//! C_t = λ²/(2π) Σ (2n+1) Re((a_n + b_n)/n_host²)
//! C_s = λ² exp(−α)/(2π γ |n_host|²) Σ (2n+1) (|a_n|² + |b_n|²),    α = 4π r Im(n_host)/λ,  γ = 2 (1 + (α − 1) e^α)/α²
//! g   = Σ [n(n+2)/(n+1) Re(a_n a*_{n+1} + b_n b*_{n+1}) + (2n+1)/(n(n+1)) Re(a_n b*_n)] / (½ Σ (2n+1)(|a_n|² + |b_n|²))
//! p   = (|S₁|² + |S₂|²) / (4π Σ (2n+1) (|a_n|² + |b_n|²))   [1/sr],  ∫ p dω = 1
//! ```
//!
//! These are the far-field cross sections for a host that absorbs: `C_t` is what the sphere adds to the extinction of its
//! host, and `γ` the share of light that reaches it.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `radius` | radius \[m\] | > 0 |
//! | `wavelength` | in vacuum \[m\] | > 0 |
//! | `sphere`, `host` | complex index of refraction \[1\] | Re > 0, Im ≥ 0 |
//!
//! What is stable: `D_n` and `ψ_n` are carried downwards from far above the last term, the second solution `χ_n` upwards,
//! and `ζ = ψ − iχ`, so that neither grows errors and the tiny real part of `a_n` of a Rayleigh particle is not lost. In a
//! host that swallows light within the sphere's radius `ψ − iχ` cancels, and `ζ` is carried upwards by itself.
//!
//! Sources: Bohren and Huffman 1983, "Absorption and Scattering of Light by Small Particles", ch. 4 and appendix A;
//! Wiscombe 1980, "Improved Mie scattering algorithms" (number of terms); Frisvad, Christensen and Jensen 2007, "Computing
//! the scattering properties of participating media using Lorenz–Mie theory", eq. 11 to 15.

use std::f64::consts::PI;

use num_complex::Complex64;

/// A sphere in its host, at one wavelength.
#[derive(Debug, Clone)]
pub struct Sphere {
    /// `a_n` and `b_n`, from n = 1.
    terms: Vec<[Complex64; 2]>,
    /// `Σ (2n+1) (|a_n|² + |b_n|²)`.
    scattered: f64,
    /// Extinction that the sphere adds to its host [m²].
    pub extinction: f64,
    /// Scattering [m²].
    pub scattering: f64,
    /// Mean cosine \[1\].
    pub g: f64,
}

impl Sphere {
    /// What a sphere of this `radius` [m] does to light of this `wavelength` in vacuum [m].
    pub fn new(radius: f64, wavelength: f64, sphere: Complex64, host: Complex64) -> Self {
        let k = 2.0 * PI / wavelength;
        let terms = terms(host * k * radius, sphere * k * radius);
        let two_n = |i: usize| 2.0 * i as f64 + 3.0;
        let scattered: f64 = terms.iter().enumerate().map(|(i, [a, b])| two_n(i) * (a.norm_sqr() + b.norm_sqr())).sum();
        let forward: Complex64 = terms.iter().enumerate().map(|(i, [a, b])| (a + b) * two_n(i)).sum();
        let area = 2.0 * PI / (k * k);
        let alpha = 2.0 * k * radius * host.im;
        Self {
            scattered,
            extinction: area * (forward / (host * host)).re,
            scattering: area * (-alpha).exp() / (reaching(alpha) * host.norm_sqr()) * scattered,
            g: mean_cosine(&terms) / (0.5 * scattered),
            terms,
        }
    }

    /// The phase function `p(cos θ)` [1/sr] of unpolarised light, normalised over the sphere.
    pub fn phase(&self, cos_theta: f64) -> f64 {
        let (mut s1, mut s2) = (Complex64::ZERO, Complex64::ZERO);
        let (mut before, mut pi) = (0.0, 1.0);
        for (i, [a, b]) in self.terms.iter().enumerate() {
            let n = i as f64 + 1.0;
            let tau = n * cos_theta * pi - (n + 1.0) * before;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            s1 += (a * pi + b * tau) * weight;
            s2 += (a * tau + b * pi) * weight;
            (before, pi) = (pi, ((2.0 * n + 1.0) * cos_theta * pi - (n + 1.0) * before) / n);
        }
        (s1.norm_sqr() + s2.norm_sqr()) / (4.0 * PI * self.scattered)
    }
}

/// `γ`: 1 in a clear host; a series where the closed form cancels.
fn reaching(alpha: f64) -> f64 {
    if alpha < 1e-3 {
        1.0 + alpha * (2.0 / 3.0 + alpha * 0.25)
    } else {
        2.0 * (1.0 + (alpha - 1.0) * alpha.exp()) / (alpha * alpha)
    }
}

fn mean_cosine(terms: &[[Complex64; 2]]) -> f64 {
    let mut sum = 0.0;
    for (i, [a, b]) in terms.iter().enumerate() {
        let n = i as f64 + 1.0;
        sum += (2.0 * n + 1.0) / (n * (n + 1.0)) * (a * b.conj()).re;
        if let Some([next_a, next_b]) = terms.get(i + 1) {
            sum += n * (n + 2.0) / (n + 1.0) * (a * next_a.conj() + b * next_b.conj()).re;
        }
    }
    sum
}

/// The last order that matters at a size parameter (Wiscombe 1980).
fn orders(x: Complex64) -> usize {
    let size = x.norm();
    (size + 4.05 * size.cbrt() + 2.0).ceil() as usize
}

/// Orders above the last one that matters, from where a downward recurrence has forgotten its start.
const ABOVE: usize = 16;
/// Attenuation over the radius from which on `ψ − iχ` loses digits.
const OPAQUE: f64 = 1.0;

fn terms(x: Complex64, y: Complex64) -> Vec<[Complex64; 2]> {
    let last = orders(x);
    let (log_derivative, psi) = (log_derivative(y, last), psi(x, last));
    let i = Complex64::I;
    let m = y / x;
    // ζ or χ, of the orders n − 1 and n.
    let is_opaque = x.im > OPAQUE;
    let (mut before, mut now) = if is_opaque { ((i * x).exp(), -i * (i * x).exp()) } else { (-x.sin(), x.cos()) };
    (before, now) = (now, now / x - before);
    (1..=last)
        .map(|n| {
            let order = n as f64;
            let zeta = |psi: Complex64, second: Complex64| if is_opaque { second } else { psi - i * second };
            let (zeta_before, zeta_now) = (zeta(psi[n - 1], before), zeta(psi[n], now));
            let term = |u: Complex64| {
                let factor = u + order / x;
                (factor * psi[n] - psi[n - 1]) / (factor * zeta_now - zeta_before)
            };
            let both = [term(log_derivative[n] / m), term(log_derivative[n] * m)];
            (before, now) = (now, now * (2.0 * order + 1.0) / x - before);
            both
        })
        .collect()
}

/// `ψ'_n(y)/ψ_n(y)` for n up to `last`.
fn log_derivative(y: Complex64, last: usize) -> Vec<Complex64> {
    let mut values = vec![Complex64::ZERO; last + 1];
    let mut d = Complex64::ZERO;
    let start = last.max(orders(y)) + ABOVE;
    for n in (1..=start).rev() {
        if n <= last {
            values[n] = d;
        }
        let ratio = n as f64 / y;
        d = ratio - (d + ratio).inv();
    }
    values[0] = d;
    values
}

/// `ψ_n(x) = x j_n(x)` for n from 0 to `last`, downwards (Miller 1952), in the measure of `ψ₀ = sin x` or `ψ₁`.
fn psi(x: Complex64, last: usize) -> Vec<Complex64> {
    let mut values = vec![Complex64::ZERO; last + 1];
    let (mut above, mut now) = (Complex64::ZERO, Complex64::from(1e-60));
    for n in (0..=last + ABOVE).rev() {
        if n <= last {
            values[n] = now;
        }
        if now.norm() > 1e60 {
            (above, now) = (above * 1e-120, now * 1e-120);
            for value in values.iter_mut().skip(n) {
                *value *= 1e-120;
            }
        }
        (above, now) = (now, now * (2.0 * n as f64 + 1.0) / x - above);
    }
    // ψ₁ = sin x/x − cos x cancels where x is small, and sin x vanishes where it is large.
    let first = x.sin() / x - x.cos();
    let scale = if x.norm() < 1.0 || x.sin().norm() > first.norm() { x.sin() / values[0] } else { first / values[1] };
    for value in &mut values {
        *value *= scale;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(m: Complex64, x: f64) -> Sphere {
        Sphere::new(x, 2.0 * PI, m, Complex64::ONE)
    }

    fn rows(table: &str) -> impl Iterator<Item = Vec<f64>> {
        let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
        lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect())
    }

    /// The table's columns of 40-digit arithmetic, printed with twelve digits.
    #[test]
    fn efficiencies_are_those_of_forty_digits() {
        let mut count = 0;
        for row in rows(include_str!("../data/mie_qext_qsca_g.csv")) {
            let [re, im, x] = [row[0], row[1], row[2]];
            let found = sphere(Complex64::new(re, -im), x);
            let area = PI * x * x;
            for (found, expected) in
                [(found.extinction / area, row[7]), (found.scattering / area, row[8]), (found.g, row[9])]
            {
                // The mean cosine of the smallest is 0 with an error of its own: the table's floor is 10⁻³.
                let difference =
                    (found - expected).abs() / expected.abs().max(if expected == row[9] { 1e-3 } else { 0.0 });
                assert!(difference < 1e-9, "m = {re} {im}, x = {x}: {found} instead of {expected}, {difference:e}");
            }
            count += 1;
        }
        assert!(count > 80, "{count} rows");
    }

    /// Nine digits are printed.
    #[test]
    fn phase_functions_are_those_of_the_table() {
        for row in rows(include_str!("../data/mie_phase.csv")) {
            let found = sphere(Complex64::new(row[0], -row[1].abs()).conj(), row[2]).phase(row[3]);
            assert!((found / row[4] - 1.0).abs() < 2e-8, "{row:?}: {found}");
        }
    }

    /// ∫ p dω = 1 and ∫ p cos θ dω = g: Simpson's rule over the angle, in which p is a trigonometric polynomial.
    #[test]
    fn the_phase_function_sends_all_light_on_and_has_its_mean_cosine() {
        for (m, host) in [((1.33, 0.0), 0.0), ((1.5, 0.1), 0.0), ((1.5, 1e-3), 0.05)] {
            let host = Complex64::new(1.33, host);
            let grain = Sphere::new(3.0, 2.0, Complex64::new(m.0, m.1) * host, host);
            let steps = 4000;
            let (mut mass, mut moment) = (0.0, 0.0);
            for i in 0..=steps {
                let theta = PI * f64::from(i) / f64::from(steps);
                let weight = f64::from(if i == 0 || i == steps { 1 } else { 2 + 2 * (i % 2) }) / 3.0;
                let p = grain.phase(theta.cos()) * theta.sin() * weight * 2.0 * PI * PI / f64::from(steps);
                mass += p;
                moment += p * theta.cos();
            }
            assert!((mass - 1.0).abs() < 1e-9 && (moment - grain.g).abs() < 1e-9, "{m:?}: {mass} {moment} {}", grain.g);
        }
    }

    /// Rayleigh: `Q_s = 8/3 x⁴ |(m² − 1)/(m² + 2)|²`, `Q_a = 4 x Im((m² − 1)/(m² + 2))`, next term of order x².
    #[test]
    fn far_below_the_wavelength_spheres_scatter_as_rayleigh_has_it() {
        for x in [1e-7, 1e-5, 1e-3] {
            for m in [Complex64::new(1.33, 0.0), Complex64::new(1.5, 0.1)] {
                let found = sphere(m, x);
                let l = (m * m - 1.0) / (m * m + 2.0);
                let [s, a] = [8.0 / 3.0 * x.powi(4) * l.norm_sqr(), 4.0 * x * l.im].map(|q| q * PI * x * x);
                assert!((found.scattering / s - 1.0).abs() < 1e-5, "{x}");
                assert!((found.extinction / (a + s) - 1.0).abs() < 1e-5, "{x}: {} {}", found.extinction, a + s);
            }
        }
    }

    /// What a sphere of its host's own substance does is nothing, and a host that hardly absorbs is a clear one. Opaque
    /// hosts are computed in another way from [`OPAQUE`] on: nothing jumps there.
    #[test]
    fn a_host_that_absorbs_is_the_limit_of_a_clear_one_and_has_no_seam() {
        let m = Complex64::new(1.5, 0.01);
        let at = |k: f64| Sphere::new(1.0, 0.5, m, Complex64::new(1.33, k));
        let (clear, nearly) = (at(0.0), at(1e-9));
        assert!((clear.scattering / nearly.scattering - 1.0).abs() < 1e-6);
        let seam = OPAQUE * 0.5 / (2.0 * PI);
        let (below, above) = (at(seam * (1.0 - 1e-9)), at(seam * (1.0 + 1e-9)));
        assert!((below.scattering / above.scattering - 1.0).abs() < 1e-6);
        assert!((below.extinction / above.extinction - 1.0).abs() < 1e-6 && (below.g - above.g).abs() < 1e-6);
        let host = Complex64::new(1.33, 0.1);
        assert!(Sphere::new(1.0, 0.5, host, host).scattering < 1e-20);
        assert!((reaching(1e-3 * (1.0 - 1e-9)) / reaching(1e-3) - 1.0).abs() < 1e-9);
    }

    /// Geometric optics: `Q_t → 2`, within `1.993 x^(−2/3)` (Nussenzveig and Wiscombe 1980).
    #[test]
    fn large_spheres_take_twice_their_shadow() {
        for x in [3000.0, 10_000.0] {
            let found = sphere(Complex64::new(1.33, 0.0), x);
            let q = found.extinction / (PI * x * x) - 2.0;
            assert!((q * x.powf(2.0 / 3.0) - 1.993).abs() < 0.3, "{x}: {q}");
            assert!((found.scattering / found.extinction - 1.0).abs() < 1e-9);
        }
    }
}
