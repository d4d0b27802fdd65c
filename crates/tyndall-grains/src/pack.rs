//! Random sequential addition: grain after grain is put at a random place, again and again until it overlaps no other. A
//! radius is kept until it has its place, so that large grains are not drawn more rarely than asked for. Equal balls jam at
//! a packing fraction of 0.384 (Zhang and Torquato 2013); the last percent before it takes very long, so that filling ends
//! after a number of failures in a row ([`PATIENCE`]).

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use tyndall::sampling::Rng;

use crate::{GrainError, container::Container, form::Form, grid::Grid, radii::Radii, uniform};

/// The most grains.
pub const MOST: u64 = 10_000_000;

/// How many times as large as the largest grain half a container may be.
const FINEST: f64 = 1e4;

/// After how many failures in a row a container is full.
pub const PATIENCE: u32 = 100_000;

/// What is wanted.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// What is filled.
    pub container: Container,
    /// The shape of the grains.
    pub form: Form,
    /// Their sizes.
    pub radii: Radii,
    /// How many, if so many find a place.
    pub count: u64,
    /// Of the random numbers.
    pub seed: u64,
}

/// A grain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Its centre.
    pub centre: DVec3,
    /// Radius of the ball that has its volume.
    pub radius: f64,
    /// How it is turned.
    pub turn: DQuat,
}

/// A container with grains, none of which overlap.
#[derive(Debug)]
pub struct Pack {
    /// What is filled.
    pub container: Container,
    /// The shape of what it is filled with.
    pub form: Form,
    /// What it is filled with.
    pub grains: Vec<Grain>,
    pub(crate) largest: f64,
    pub(crate) grid: Grid,
}

impl Recipe {
    fn check(&self) -> Result<(), GrainError> {
        if !(1..=MOST).contains(&self.count) {
            return Err(GrainError::Count(self.count));
        }
        let (largest, half) = (self.radii.largest(), self.container.half());
        if largest > half.min_element() {
            return Err(GrainError::TooLarge { radius: largest, room: half.min_element() });
        }
        let least = half.max_element() / FINEST;
        if largest < least {
            return Err(GrainError::TooSmall { radius: largest, least });
        }
        Ok(())
    }
}

impl Pack {
    /// Nothing yet.
    ///
    /// # Errors
    /// No grain, too many, or one that does not fit.
    pub(crate) fn empty(recipe: &Recipe) -> Result<Self, GrainError> {
        recipe.check()?;
        let Recipe { container, form, radii, .. } = recipe.clone();
        let largest = radii.largest();
        Ok(Self { container, grid: Grid::new(form.clone(), largest), form, grains: Vec::new(), largest })
    }

    /// Fills a container by random sequential addition. `go_on` hears how many grains there are, and says whether to continue.
    ///
    /// # Errors
    /// No grain, too many, or one that does not fit.
    pub fn fill(recipe: &Recipe, mut go_on: impl FnMut(u64) -> bool) -> Result<Self, GrainError> {
        let mut pack = Self::empty(recipe)?;
        pack.add(recipe, &mut Rng::for_sample((0, 0), 0, recipe.seed), PATIENCE, &mut go_on);
        if pack.grains.is_empty() { Err(GrainError::NoRoom) } else { Ok(pack) }
    }

    /// Adds grains until all are there, or one has found no place so many times.
    pub(crate) fn add(&mut self, recipe: &Recipe, rng: &mut Rng, patience: u32, go_on: &mut impl FnMut(u64) -> bool) {
        let (half, reach) = (self.container.half(), self.grid.reach);
        let mut radius = recipe.radii.draw(rng);
        let (mut failures, mut tries) = (0, 0u64);
        while (self.grains.len() as u64) < recipe.count && failures < patience {
            let place = DVec3::new(uniform(rng), uniform(rng), uniform(rng));
            // A ball keeps its distance from the walls; of others only those that reach so far are tested.
            let room = half - if reach > 1.0 { 0.0 } else { radius };
            let grain = Grain { centre: (2.0 * place - 1.0) * room, radius, turn: self.form.turn(rng) };
            if self.holds(&grain) && self.grid.free(&self.grains, &grain) {
                self.push(grain);
                radius = recipe.radii.draw(rng);
                failures = 0;
            } else {
                failures += 1;
            }
            tries += 1;
            if tries.is_multiple_of(1024) && !go_on(self.grains.len() as u64) {
                break;
            }
        }
    }

    /// Whether a grain lies wholly inside.
    pub(crate) fn holds(&self, grain: &Grain) -> bool {
        let reach = self.grid.reach;
        let ball = reach * grain.radius;
        self.container.holds(grain.centre, ball)
            || (reach > 1.0
                && self.container.holds(grain.centre, 0.0)
                && self.form.points(grain).into_iter().all(|point| self.container.holds(point, 0.0)))
    }

    pub(crate) fn push(&mut self, grain: Grain) {
        self.grid.insert(self.grains.len() as u32, &grain);
        self.grains.push(grain);
    }

    /// Puts grains in the place of those that are there.
    pub(crate) fn replace(&mut self, grains: impl Iterator<Item = Grain>) {
        self.grid.clear();
        self.grains.clear();
        grains.for_each(|grain| self.push(grain));
    }

    /// Takes out what overlaps a grain before it or a wall.
    pub(crate) fn sift(&mut self) {
        self.grid.clear();
        for grain in std::mem::take(&mut self.grains) {
            if self.holds(&grain) && self.grid.free(&self.grains, &grain) {
                self.push(grain);
            }
        }
    }

    /// What part of the container is grain.
    pub fn fraction(&self) -> f64 {
        4.0 / 3.0 * PI * self.moment(3) / self.container.volume()
    }

    /// Surface of the grains in a volume of the container.
    pub fn surface(&self) -> f64 {
        self.form.surface() * self.moment(2) / self.container.volume()
    }

    /// Sum of a power of the radii.
    pub(crate) fn moment(&self, power: i32) -> f64 {
        self.grains.iter().map(|grain| grain.radius.powi(power)).sum()
    }
}
