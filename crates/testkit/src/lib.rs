//! Statistical tests for samplers and estimators.
//!
//! | question | tool |
//! |---|---|
//! | is the mean of an estimator right? | [`Mean`], [`z_test`] |
//! | do samples follow their density? | [`Grid::test`], [`sphere_test`], [`line_test`] (χ²), [`ks_test`] |
//! | is a density normalised? | [`quadrature`], [`close`] |
//! | many of these at once | [`Family`]: Šidák's correction, one table of what failed |
//!
//! A χ² test compares shapes and misses a density that is 1 % too large everywhere; a quadrature test finds that and
//! misses a sampler that does not follow its density. A sampler needs both.
//!
//! Every test returns an [`Outcome`]: a p-value, the probability of a deviation at least this large if nothing is wrong,
//! and the sentence that explains it. Samples come from a [`Stream`] with a fixed seed, so a test that passes once passes
//! always.
//!
//! ```
//! use testkit::{Family, Stream, close, ks_test, quadrature::gauss_legendre, z_test};
//!
//! // p(x) = 2x on [0, 1], sampled by x = √u; the mean is 2/3.
//! let mut stream = Stream::new(2);
//! let mut samples: Vec<f64> = (0..10_000).map(|_| stream.next_f64().sqrt()).collect();
//! let mut family = Family::new("linear density", 0.01);
//! family.check("normalised", close(gauss_legendre(4, 0.0, 1.0, |x| 2.0 * x), 1.0, 1e-12));
//! family.check("mean", z_test(samples.iter().copied(), 2.0 / 3.0));
//! family.check("distribution", ks_test(&mut samples, |x| x * x));
//! family.finish();
//! ```

pub mod chi_square;
pub mod family;
pub mod ks;
pub mod mean;
pub mod outcome;
pub mod quadrature;
pub mod stream;

pub use chi_square::{Grid, chi_square, line_test, sphere_test};
pub use family::{Family, sidak};
pub use ks::ks_test;
pub use mean::{Mean, assert_mean, z_test};
pub use outcome::{Outcome, close};
pub use stream::Stream;
