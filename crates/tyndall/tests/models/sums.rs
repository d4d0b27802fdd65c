//! Sums for the sampler tests: uniform numbers, adaptive quadrature, chi-square and mean tests, Šidák-corrected.

use tyndall::math::{Vec2, Vec3};

/// Uniform numbers in [0, 1): a counter through the finaliser of SplitMix64 (Steele et al. 2014).
pub(crate) struct Uniforms(u64);

impl Uniforms {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed << 32)
    }

    pub(crate) fn next_1d(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }

    pub(crate) fn next_2d(&mut self) -> Vec2 {
        Vec2::new(self.next_1d(), self.next_1d())
    }

    /// Uniform over the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        let (z, phi) = (2.0 * self.next_1d() - 1.0, std::f32::consts::TAU * self.next_1d());
        let sin = ((1.0 - z) * (1.0 + z)).sqrt();
        Vec3::new(sin * phi.cos(), sin * phi.sin(), z)
    }
}

/// `∫∫ f dx dy` over a rectangle: nine Gauss points, halved in both directions until halving changes less than
/// `tolerance`.
pub(crate) fn integrate(f: &impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2], tolerance: f64) -> f64 {
    refine(f, x, y, gauss(f, x, y), tolerance, 12)
}

fn refine(f: &impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2], whole: f64, tolerance: f64, depth: u32) -> f64 {
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let parts =
        [([x[0], mx], [y[0], my]), ([mx, x[1]], [y[0], my]), ([x[0], mx], [my, y[1]]), ([mx, x[1]], [my, y[1]])]
            .map(|(x, y)| (x, y, gauss(f, x, y)));
    let sum = parts.iter().map(|p| p.2).sum::<f64>();
    if depth == 0 || (sum - whole).abs() < tolerance {
        sum
    } else {
        parts.iter().map(|&(x, y, part)| refine(f, x, y, part, 0.5 * tolerance, depth - 1)).sum()
    }
}

fn gauss(f: &impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2]) -> f64 {
    let nodes = [(-(0.6f64.sqrt()), 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.6f64.sqrt(), 5.0 / 18.0)];
    let at = |range: [f64; 2], node: f64| 0.5 * (range[0] + range[1]) + 0.5 * (range[1] - range[0]) * node;
    let mut sum = 0.0;
    for (a, wa) in nodes {
        for (b, wb) in nodes {
            sum += wa * wb * f(at(x, a), at(y, b));
        }
    }
    sum * (x[1] - x[0]) * (y[1] - y[0])
}

/// `∫ f dx`: three Gauss points, halved until halving changes less than `tolerance`.
pub(crate) fn integrate_line(f: &impl Fn(f64) -> f64, x: [f64; 2], tolerance: f64) -> f64 {
    let node = 0.6f64.sqrt();
    let gauss = |a: f64, b: f64| {
        let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
        (5.0 * f(mid - node * half) + 8.0 * f(mid) + 5.0 * f(mid + node * half)) * half / 9.0
    };
    let (mut sum, mut pending) = (0.0, vec![(x[0], x[1], gauss(x[0], x[1]), tolerance, 25)]);
    while let Some((a, b, whole, tolerance, depth)) = pending.pop() {
        let mid = 0.5 * (a + b);
        let (left, right) = (gauss(a, mid), gauss(mid, b));
        if depth == 0 || (left + right - whole).abs() < tolerance {
            sum += left + right;
        } else {
            pending.push((a, mid, left, 0.5 * tolerance, depth - 1));
            pending.push((mid, b, right, 0.5 * tolerance, depth - 1));
        }
    }
    sum
}

/// How many standard deviations a family of `family` tests may stray at a significance of 1 % for the whole.
fn limit(family: usize) -> f64 {
    let tail = 1.0 - 0.99f64.powf(1.0 / family as f64);
    // Abramowitz and Stegun 26.2.23, good to 5e-4.
    let t = (-2.0 * tail.ln()).sqrt();
    let numerator = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    t - numerator / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)))
}

/// Pearson's test, with neighbouring bins pooled until each expects at least ten.
pub(crate) fn assert_chi_square(what: &str, observed: &[u32], expected: &[f64], family: usize) {
    let n = observed.iter().map(|&o| f64::from(o)).sum::<f64>();
    let mut pooled = vec![(0.0, 0.0)];
    for (&o, &p) in observed.iter().zip(expected) {
        if pooled.last().is_some_and(|last: &(f64, f64)| last.1 >= 10.0) {
            pooled.push((0.0, 0.0));
        }
        let last = pooled.last_mut().expect("never empty");
        last.0 += f64::from(o);
        last.1 += n * p;
    }
    if pooled.len() > 1 && pooled.last().is_some_and(|last| last.1 < 10.0) {
        let (o, e) = pooled.pop().expect("more than one");
        let last = pooled.last_mut().expect("more than none");
        *last = (last.0 + o, last.1 + e);
    }
    if pooled.len() == 1 {
        let (o, e) = pooled[0];
        assert!((o - e).abs() <= 1e-3 * n, "{what}: {o} seen, {e} expected");
        return;
    }
    let chi = pooled.iter().map(|(o, e)| (o - e) * (o - e) / e).sum::<f64>();
    let k = (pooled.len() - 1) as f64;
    // Wilson and Hilferty 1931: (χ²/k)^⅓ is nearly normal.
    let z = ((chi / k).cbrt() - (1.0 - 2.0 / (9.0 * k))) / (2.0 / (9.0 * k)).sqrt();
    if z >= limit(family) {
        let score = |&&(o, e): &&(f64, f64)| (o - e) * (o - e) / e;
        let worst = pooled.iter().max_by(|a, b| score(a).total_cmp(&score(b)));
        panic!(
            "{what}: chi-square {chi:.1} with {k} degrees of freedom (z = {z:.1}); worst (seen, expected) {worst:?}"
        );
    }
}

/// The mean of `values` is `exact` within its standard error.
pub(crate) fn assert_mean(what: &str, values: impl Iterator<Item = f64>, exact: f64, family: usize) {
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for v in values {
        n += 1.0;
        sum += v;
        squares += v * v;
    }
    let mean: f64 = sum / n;
    let error = ((squares / n - mean * mean).max(0.0) / n).sqrt();
    // Two-sided; the constant is the rounding and quadrature error of a mean without variance.
    let allowed = limit(2 * family) * error + 1e-5 * (1.0 + exact.abs());
    assert!((mean - exact).abs() <= allowed, "{what}: mean {mean} ± {error}, expected {exact}");
}
