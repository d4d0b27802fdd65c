//! Densities on the unit square that are given on a grid and at some values of parameters, linear between all of them.
//!
//! A [`Grid`] is looked up, sampled (`u → x`) and inverted (`x → u`), with the marginal density of the rows and then the
//! conditional one of the columns. Sums over slices of the parameters are linear too, so that the blend of two densities is
//! sampled exactly, with their blended sums. In a cell the density along a line is `a + (b − a)t`, its sum
//! `c = at + (b − a)t²/2`, and so `t = 2c / (a + √(a² + 2(b − a)c))`, which never cancels.

use crate::math::Vec2;

/// Numbers in a block: the last dimension varies fastest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Block {
    /// Its dimensions.
    pub shape: Vec<usize>,
    /// As many numbers as the product of them.
    pub values: Vec<f32>,
}

/// What is the matter with the numbers of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// The dimensions do not fit the numbers or the parameters.
    #[error("the dimensions of its blocks do not fit each other")]
    Shape,
    /// Parameters do not increase, or are not finite.
    #[error("its angles or wavelengths do not increase")]
    Parameters,
    /// A number is not finite, or a density is negative.
    #[error("it has a number that is not finite, or a negative density")]
    Value,
    /// A density is zero everywhere.
    #[error("it has a density that is zero everywhere")]
    Empty,
}

/// A function on the unit square, or a density, by parameters.
#[derive(Debug, Clone)]
pub struct Grid {
    width: usize,
    height: usize,
    /// The values of each parameter; slices are in their order, the last varies fastest.
    parameters: Vec<Vec<f32>>,
    values: Vec<f32>,
    /// Sums over rows up to each, of each slice; empty if the grid is not a density.
    rows: Vec<f32>,
    /// Sums along each row up to each column, of each slice.
    columns: Vec<f32>,
}

/// The slices around values of the parameters, with their weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blend {
    slices: [(usize, f32); 8],
    count: usize,
}

/// A cell and a place in it.
struct Cell {
    row: usize,
    column: usize,
    at: Vec2,
}

impl Grid {
    /// A function to look up.
    ///
    /// # Errors
    /// [`GridError`].
    pub fn function(block: Block, parameters: Vec<Vec<f32>>) -> Result<Self, GridError> {
        let Block { shape, values } = block;
        let n = parameters.len();
        let fits = parameters.iter().map(Vec::len).eq(shape.iter().take(n).copied());
        let [height, width] = *shape.get(n..).ok_or(GridError::Shape)? else { return Err(GridError::Shape) };
        let size = shape.iter().try_fold(1usize, |size, &n| size.checked_mul(n));
        if n > 3 || !fits || width < 2 || height < 2 || size != Some(values.len()) || values.is_empty() {
            return Err(GridError::Shape);
        }
        let increase = |p: &Vec<f32>| p.iter().all(|v| v.is_finite()) && p.windows(2).all(|w| w[0] < w[1]);
        if !parameters.iter().all(increase) {
            return Err(GridError::Parameters);
        }
        if values.iter().any(|v| !v.is_finite()) {
            return Err(GridError::Value);
        }
        Ok(Self { width, height, parameters, values, rows: Vec::new(), columns: Vec::new() })
    }

    /// A density, made to integrate to 1 at all values of its parameters.
    ///
    /// # Errors
    /// [`GridError`].
    pub fn density(block: Block, parameters: Vec<Vec<f32>>) -> Result<Self, GridError> {
        let mut grid = Self::function(block, parameters)?;
        if grid.values.iter().any(|v| *v < 0.0) {
            return Err(GridError::Value);
        }
        let (w, h) = (grid.width, grid.height);
        for slice in grid.values.chunks_exact_mut(w * h) {
            let columns: Vec<f64> =
                slice.chunks_exact(w).flat_map(|row| sums(row.iter().map(|v| f64::from(*v)))).collect();
            let rows: Vec<f64> = sums(columns.chunks_exact(w).map(|row| row[w - 1])).collect();
            let total = rows[h - 1];
            if !(total > 0.0 && total.is_finite()) {
                return Err(GridError::Empty);
            }
            for value in slice.iter_mut() {
                *value = (f64::from(*value) / total) as f32;
            }
            grid.rows.extend(rows.iter().map(|v| (v / total) as f32));
            grid.columns.extend(columns.iter().map(|v| (v / total) as f32));
        }
        Ok(grid)
    }

    /// The slices around values of the parameters, one each; beyond their ends those at the ends.
    pub(super) fn blend(&self, at: &[f32]) -> Blend {
        let mut blend = Blend { slices: [(0, 1.0); 8], count: 1 };
        for (values, &x) in self.parameters.iter().zip(at) {
            let last = values.len() - 1;
            let below = values.partition_point(|v| *v <= x).clamp(1, last.max(1)) - 1;
            let t = if last == 0 {
                0.0
            } else {
                ((x - values[below]) / (values[below + 1] - values[below])).clamp(0.0, 1.0)
            };
            let old = blend.count;
            for i in 0..old {
                let (slice, weight) = blend.slices[i];
                let slice = slice * values.len() + below;
                blend.slices[i] = (slice, weight * (1.0 - t));
                if t > 0.0 {
                    blend.slices[blend.count] = (slice + 1, weight * t);
                    blend.count += 1;
                }
            }
        }
        blend
    }

    /// The value at a place.
    pub(super) fn eval(&self, blend: &Blend, at: Vec2) -> f32 {
        let cell = self.cell(at);
        let [a, b] = self.line(blend, &cell);
        lerp(a, b, cell.at.x)
    }

    /// The place with the density of the grid for `u` in the unit square, and the density.
    pub(super) fn sample(&self, blend: &Blend, u: Vec2) -> (Vec2, f32) {
        let (w, h) = (self.width, self.height);
        let u = u.clamp(Vec2::splat(f32::EPSILON), Vec2::splat(1.0 - f32::EPSILON));
        let row = last_below(h - 1, |row| self.row_sum(blend, row) <= u.y);
        let [low, high] = self.row_totals(blend, row);
        let y = segment((u.y - self.row_sum(blend, row)) * (h - 1) as f32, low, high);
        let wanted = u.x * lerp(low, high, y);
        let sum = |column: usize| self.column_sum(blend, row, column, y);
        let column = last_below(w - 1, |column| sum(column) <= wanted);
        let [a, b] = self.line(blend, &Cell { row, column, at: Vec2::new(0.0, y) });
        let x = segment((wanted - sum(column)) * (w - 1) as f32, a, b);
        let place = Vec2::new(column as f32 + x, row as f32 + y) / Vec2::new((w - 1) as f32, (h - 1) as f32);
        (place, lerp(a, b, x))
    }

    /// The `u` for which [`Self::sample`] gives a place, and the density there.
    pub(super) fn invert(&self, blend: &Blend, at: Vec2) -> (Vec2, f32) {
        let cell = self.cell(at);
        let [a, b] = self.line(blend, &cell);
        let [low, high] = self.row_totals(blend, cell.row);
        let total = lerp(low, high, cell.at.y);
        let along = self.column_sum(blend, cell.row, cell.column, cell.at.y)
            + summed(cell.at.x, a, b) / (self.width - 1) as f32;
        let up = self.row_sum(blend, cell.row) + summed(cell.at.y, low, high) / (self.height - 1) as f32;
        let u = if total > 0.0 { along / total } else { 0.0 };
        (Vec2::new(u, up).clamp(Vec2::ZERO, Vec2::ONE), lerp(a, b, cell.at.x))
    }

    fn cell(&self, at: Vec2) -> Cell {
        let scaled = at.clamp(Vec2::ZERO, Vec2::ONE) * Vec2::new((self.width - 1) as f32, (self.height - 1) as f32);
        let (column, row) = ((scaled.x as usize).min(self.width - 2), (scaled.y as usize).min(self.height - 2));
        Cell { row, column, at: scaled - Vec2::new(column as f32, row as f32) }
    }

    /// The values at both ends of the line through a cell at the height of its place.
    fn line(&self, blend: &Blend, cell: &Cell) -> [f32; 2] {
        let corner =
            |row: usize, column: usize| blend.of(&self.values, self.width * self.height, row * self.width + column);
        [0, 1].map(|i| lerp(corner(cell.row, cell.column + i), corner(cell.row + 1, cell.column + i), cell.at.y))
    }

    fn row_sum(&self, blend: &Blend, row: usize) -> f32 {
        blend.of(&self.rows, self.height, row)
    }

    /// The sums along a row and the next.
    fn row_totals(&self, blend: &Blend, row: usize) -> [f32; 2] {
        [row, row + 1].map(|row| blend.of(&self.columns, self.width * self.height, (row + 1) * self.width - 1))
    }

    /// The sum along the line at `y` between a row and the next, up to a column.
    fn column_sum(&self, blend: &Blend, row: usize, column: usize, y: f32) -> f32 {
        let sum = |row: usize| blend.of(&self.columns, self.width * self.height, row * self.width + column);
        lerp(sum(row), sum(row + 1), y)
    }
}

impl Blend {
    /// Number `i` of each slice of a table, blended.
    fn of(&self, table: &[f32], size: usize, i: usize) -> f32 {
        self.slices[..self.count].iter().map(|(slice, weight)| weight * table[slice * size + i]).sum()
    }
}

/// The integral of what is linear between values at even distances over [0, 1], up to each of them.
fn sums(values: impl ExactSizeIterator<Item = f64>) -> impl Iterator<Item = f64> {
    let half = 0.5 / (values.len() - 1) as f64;
    let mut before = None;
    values.scan(0.0, move |sum, value| {
        *sum += before.map_or(0.0, |before: f64| (before + value) * half);
        before = Some(value);
        Some(*sum)
    })
}

/// The last of so many for which `below` holds, or the first; it holds up to some of them.
fn last_below(count: usize, below: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, count);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if below(middle) { low = middle } else { high = middle }
    }
    low
}

/// Where the sum of what runs from `a` to `b` is `c`.
fn segment(c: f32, a: f32, b: f32) -> f32 {
    let root = (a * a + 2.0 * (b - a) * c).max(0.0).sqrt();
    let sum = a + root;
    if sum > 0.0 { (2.0 * c / sum).clamp(0.0, 1.0) } else { 0.0 }
}

/// The sum of what runs from `a` to `b`, up to `t`.
fn summed(t: f32, a: f32, b: f32) -> f32 {
    t * (a + 0.5 * (b - a) * t)
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}
