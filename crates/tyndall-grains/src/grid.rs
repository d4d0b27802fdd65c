//! Which grains are near: cells of the width of the largest grain, each with the grains whose boxes reach into it. Only cells
//! with grains take memory.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

use crate::{form::Form, pack::Grain};

#[derive(Debug)]
pub(crate) struct Grid {
    form: Form,
    pub(crate) reach: f64,
    width: f64,
    cells: HashMap<I64Vec3, Vec<u32>>,
}

impl Grid {
    /// An empty one for grains of a form up to a radius.
    pub(crate) fn new(form: Form, largest: f64) -> Self {
        let reach = form.reach();
        Self { form, reach, width: 2.0 * reach * largest, cells: HashMap::new() }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.clear();
    }

    fn cell(&self, point: DVec3) -> I64Vec3 {
        (point / self.width).floor().as_i64vec3()
    }

    fn around(&self, grain: &Grain) -> impl Iterator<Item = I64Vec3> + use<> {
        // A little more than the grain, so that rounding puts no entry of a ray into a cell that does not know the grain.
        let reach = DVec3::splat(self.reach * grain.radius + 1e-6 * self.width);
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
        let near = self.around(new).filter_map(|cell| self.cells.get(&cell)).flatten();
        near.into_iter().all(|&id| !self.form.overlap(&grains[id as usize], new))
    }

    /// Whether a point lies in a grain.
    pub(crate) fn covers(&self, grains: &[Grain], point: DVec3) -> bool {
        let near = self.cells.get(&self.cell(point)).into_iter().flatten();
        near.into_iter().any(|&id| {
            let passages = self.form.passages(&grains[id as usize], point, DVec3::Z);
            passages.iter().filter(|&&t| t < 0.0).count() % 2 == 1
        })
    }

    /// How often a line enters grains between two distances, and what of it lies in them. A grain is counted in the cell
    /// where the line first enters it.
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
                let passages = self.form.passages(&grains[id as usize], origin, direction);
                if passages.first().is_some_and(|first| (from..to).contains(first)) {
                    met += passages.len() as u32 / 2;
                    inside += passages.chunks_exact(2).map(|pair| pair[1] - pair[0]).sum::<f64>();
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
