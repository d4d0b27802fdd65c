//! Random sequential addition: grain after grain is put at a random place, again and again until it overlaps no other. A
//! radius is kept until it has its place, so that large grains are not drawn more rarely than asked for. Equal balls jam at
//! a packing fraction of 0.384 (Zhang and Torquato 2013); the last percent before it takes very long, so that filling ends
//! after a number of failures in a row ([`PATIENCE`]).

use std::f64::consts::PI;

use glam::DVec3;
use tyndall::sampling::Rng;

use crate::{GrainError, container::Container, grid::Grid, radii::Radii, uniform};

/// The most grains.
pub const MOST: u64 = 10_000_000;

/// How many times as large as the largest grain half a container may be.
const FINEST: f64 = 1e4;

/// After how many failures in a row a container is full.
pub const PATIENCE: u32 = 100_000;

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// A container with grains, none of which overlap.
#[derive(Debug)]
pub struct Pack {
    /// What is filled.
    pub container: Container,
    /// What it is filled with.
    pub grains: Vec<Grain>,
    pub(crate) grid: Grid,
}

impl Pack {
    /// Fills a container with so many grains, or as many as find a place. `go_on` hears how many there are, and says
    /// whether to continue.
    ///
    /// # Errors
    /// No grain, too many, or one that does not fit.
    pub fn fill(
        container: Container,
        radii: Radii,
        count: u64,
        seed: u64,
        mut go_on: impl FnMut(u64) -> bool,
    ) -> Result<Self, GrainError> {
        if !(1..=MOST).contains(&count) {
            return Err(GrainError::Count(count));
        }
        let (largest, half) = (radii.largest(), container.half());
        if largest > half.min_element() {
            return Err(GrainError::TooLarge { radius: largest, room: half.min_element() });
        }
        let least = half.max_element() / FINEST;
        if largest < least {
            return Err(GrainError::TooSmall { radius: largest, least });
        }
        let mut rng = Rng::for_sample((0, 0), 0, seed);
        let mut pack = Self { container, grains: Vec::new(), grid: Grid::new(largest) };
        let mut radius = radii.draw(&mut rng);
        let mut failures = 0;
        while (pack.grains.len() as u64) < count && failures < PATIENCE {
            let place = DVec3::new(uniform(&mut rng), uniform(&mut rng), uniform(&mut rng));
            let grain = Grain { centre: (2.0 * place - 1.0) * (half - radius), radius };
            if container.holds(grain.centre, radius) && pack.grid.free(&pack.grains, &grain) {
                pack.grid.insert(pack.grains.len() as u32, &grain);
                pack.grains.push(grain);
                radius = radii.draw(&mut rng);
                failures = 0;
            } else {
                failures += 1;
            }
            if (failures + pack.grains.len() as u32).is_multiple_of(1024) && !go_on(pack.grains.len() as u64) {
                break;
            }
        }
        Ok(pack)
    }

    /// What part of the container is grain.
    pub fn fraction(&self) -> f64 {
        4.0 / 3.0 * PI * self.grains.iter().map(|grain| grain.radius.powi(3)).sum::<f64>() / self.container.volume()
    }

    /// Surface of the grains in a volume of the container.
    pub fn surface(&self) -> f64 {
        4.0 * PI * self.grains.iter().map(|grain| grain.radius.powi(2)).sum::<f64>() / self.container.volume()
    }
}
