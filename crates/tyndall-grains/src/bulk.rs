//! What part of space is grain in the middle of a pack: away from walls, beside which grains stand in layers, and from the top.
//!
//! Points are strewn in the container. Those count that are at least four of the largest radii from its walls and as far below
//! the top, which is where nine tenths of the grains have their centres beneath. The mean free path there is that of
//! [`free_path`](crate::free_path), with the surface per volume that goes with the part: `s = A φ ⟨r²⟩ / (V ⟨r³⟩)`, `A` and `V` those
//! of a grain of radius 1.

use std::f64::consts::PI;

use glam::DVec3;
use tyndall::sampling::Rng;

use crate::{pack::Pack, uniform};

/// How far from walls and top [largest radii].
const AWAY: f64 = 4.0;
/// Points that are strewn.
const POINTS: u32 = 400_000;
/// The fewest that tell anything.
const FEWEST: u32 = 1000;

/// The middle of a pack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bulk {
    /// What part of it is grain.
    pub fraction: f64,
    /// Standard error of that.
    pub error: f64,
    /// The mean free path that goes with it [length].
    pub free_path: f64,
}

impl Pack {
    /// `None` where the container is too small to have a middle, or nearly empty.
    pub fn bulk(&self, seed: u64) -> Option<Bulk> {
        let mut heights: Vec<f64> = self.grains.iter().map(|grain| grain.centre.z).collect();
        heights.sort_by(f64::total_cmp);
        let away = AWAY * self.largest;
        let top = heights.get(heights.len() * 9 / 10)? - away;
        let mut rng = Rng::for_sample((2, 0), 0, seed);
        let (mut all, mut grain) = (0u32, 0u32);
        for _ in 0..POINTS {
            let place = DVec3::new(uniform(&mut rng), uniform(&mut rng), uniform(&mut rng));
            let point = (2.0 * place - 1.0) * self.container.half();
            if point.z < top && self.container.holds(point, away) {
                all += 1;
                grain += u32::from(self.grid.covers(&self.grains, point));
            }
        }
        let fraction = f64::from(grain) / f64::from(all);
        let surface = self.form.surface() * fraction * self.moment(2) / (4.0 / 3.0 * PI * self.moment(3));
        (all >= FEWEST && grain > 0).then(|| Bulk {
            fraction,
            error: (fraction * (1.0 - fraction) / f64::from(all)).sqrt(),
            free_path: 4.0 * (1.0 - fraction) / surface,
        })
    }
}
