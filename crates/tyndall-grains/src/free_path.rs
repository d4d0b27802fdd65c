//! How far light goes between grains: the length of lines outside grains over the number of grains they enter.
//!
//! ```text
//! l = 4 (1 − φ) / s       φ packing fraction, s surface of grains per volume of the container
//! l = 4 r (1 − φ) / (3φ)  for equal balls of radius r
//! ```
//!
//! Both sides are exact for a pack in a container when its lines are isotropic and uniform: the mean length of such lines in a
//! body is proportional to its volume, the mean number of entries to its surface (Cauchy, Crofton). No pack need be
//! homogeneous for that. Dilute scatterers would have `4r / (3φ)`.

use std::f64::consts::TAU;

use glam::DVec3;
use tyndall::sampling::Rng;

use crate::{pack::Pack, uniform};

/// A mean free path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreePath {
    /// By rays.
    pub mean: f64,
    /// Standard error of that.
    pub error: f64,
}

impl Pack {
    /// The mean free path by formula.
    pub fn free_path_by_formula(&self) -> f64 {
        4.0 * (1.0 - self.fraction()) / self.surface()
    }

    /// The mean free path along so many random lines. `None` if they meet no grain.
    pub fn free_path_by_rays(&self, lines: u32, seed: u64) -> Option<FreePath> {
        let reach = self.container.half().length();
        let measured: Vec<(f64, f64)> = (0..lines)
            .filter_map(|index| {
                let mut rng = Rng::for_sample((1, 0), index, seed);
                let (origin, direction) = line(reach, &mut rng);
                let spans = self.container.spans(origin, direction);
                let ends = (spans.first()?.0, spans.last()?.1);
                let (met, inside) = self.grid.along(&self.grains, origin, direction, ends);
                Some((spans.iter().map(|(near, far)| far - near).sum::<f64>() - inside, f64::from(met)))
            })
            .collect();
        let (outside, met) = measured.iter().fold((0.0, 0.0), |sum, line| (sum.0 + line.0, sum.1 + line.1));
        let mean = outside / met;
        // Of a ratio of means, to first order.
        let squares: f64 = measured.iter().map(|(outside, met)| (outside - mean * met).powi(2)).sum();
        (met > 0.0).then(|| FreePath { mean, error: squares.sqrt() / met })
    }
}

/// An isotropic, uniform line through a ball around the origin: through a random point of the disk across its direction.
pub(crate) fn line(reach: f64, rng: &mut Rng) -> (DVec3, DVec3) {
    let (z, turn) = (2.0 * uniform(rng) - 1.0, TAU * uniform(rng));
    let rim = (1.0 - z * z).sqrt();
    let direction = DVec3::new(rim * turn.cos(), rim * turn.sin(), z);
    let (a, b) = direction.any_orthonormal_pair();
    let (radius, turn) = (reach * uniform(rng).sqrt(), TAU * uniform(rng));
    (radius * (turn.cos() * a + turn.sin() * b), direction)
}
