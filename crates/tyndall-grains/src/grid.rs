//! Which grains are near: cells of the width of the largest grain, each with the grains whose boxes reach into it. Only cells
//! with grains take memory.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

use crate::{container::quadratic, pack::Grain};

#[derive(Debug)]
pub(crate) struct Grid {
    width: f64,
    cells: HashMap<I64Vec3, Vec<u32>>,
}

impl Grid {
    /// An empty one for grains up to a radius.
    pub(crate) fn new(largest: f64) -> Self {
        Self { width: 2.0 * largest, cells: HashMap::new() }
    }

    fn cell(&self, point: DVec3) -> I64Vec3 {
        (point / self.width).floor().as_i64vec3()
    }

    fn around(&self, grain: &Grain) -> impl Iterator<Item = I64Vec3> + use<> {
        // A little more than the grain, so that rounding puts no entry of a ray into a cell that does not know the grain.
        let reach = DVec3::splat(grain.radius + 1e-6 * self.width);
        let (a, b) = (self.cell(grain.centre - reach), self.cell(grain.centre + reach));
        (a.x..=b.x).flat_map(move |x| (a.y..=b.y).flat_map(move |y| (a.z..=b.z).map(move |z| I64Vec3::new(x, y, z))))
    }

    pub(crate) fn insert(&mut self, id: u32, grain: &Grain) {
        for cell in self.around(grain) {
            self.cells.entry(cell).or_default().push(id);
        }
    }

    /// Whether there is room for a grain.
    pub(crate) fn free(&self, grains: &[Grain], new: &Grain) -> bool {
        self.around(new).filter_map(|cell| self.cells.get(&cell)).flatten().all(|&id| {
            let old = &grains[id as usize];
            old.centre.distance(new.centre) >= old.radius + new.radius
        })
    }

    /// How many grains a line meets between two distances, and what of it lies in them. A grain is counted in the cell where
    /// the line enters it.
    pub(crate) fn along(&self, grains: &[Grain], origin: DVec3, direction: DVec3, span: (f64, f64)) -> (u32, f64) {
        let (mut met, mut inside) = (0, 0.0);
        let mut cell = self.cell(origin + span.0 * direction);
        let step = direction.signum().as_i64vec3();
        let mut from = f64::NEG_INFINITY;
        loop {
            let ahead = cell + step.max(I64Vec3::ZERO);
            let walls = (ahead.as_dvec3() * self.width - origin) / direction;
            let to = walls.min_element();
            for &id in self.cells.get(&cell).into_iter().flatten() {
                let grain = &grains[id as usize];
                let o = origin - grain.centre;
                let Some((near, far)) =
                    quadratic(1.0, o.dot(direction), o.length_squared() - grain.radius * grain.radius)
                else {
                    continue;
                };
                if (from..to).contains(&near) {
                    met += 1;
                    inside += far - near;
                }
            }
            if to >= span.1 {
                return (met, inside);
            }
            let axis = if walls.x == to {
                0
            } else if walls.y == to {
                1
            } else {
                2
            };
            cell[axis] += step[axis];
            from = to;
        }
    }
}
