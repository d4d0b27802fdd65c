//! Small dense matrices in double precision.

use std::ops::{Index, IndexMut};

/// A square matrix.
#[derive(Debug, Clone)]
pub(crate) struct Matrix<const N: usize>(Box<[[f64; N]; N]>);

impl<const N: usize> Matrix<N> {
    pub(crate) fn from_fn(entry: impl Fn(usize, usize) -> f64) -> Self {
        Self(Box::new(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))))
    }

    pub(crate) fn row(&self, i: usize) -> &[f64; N] {
        &self.0[i]
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut product = Self::from_fn(|_, _| 0.0);
        for i in 0..N {
            for k in 0..N {
                let factor = self[(i, k)];
                for j in 0..N {
                    product[(i, j)] += factor * other[(k, j)];
                }
            }
        }
        product
    }

    /// `X` with `self · X = right`, by elimination with the largest pivot of each column. `self` is not singular.
    pub(crate) fn solve(mut self, right: &Self) -> Self {
        let mut x = right.clone();
        for column in 0..N {
            let size = |&row: &usize| self[(row, column)].abs();
            let pivot = (column..N).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
            self.0.swap(column, pivot);
            x.0.swap(column, pivot);
            for row in column + 1..N {
                let factor = self[(row, column)] / self[(column, column)];
                for j in column..N {
                    let above = self[(column, j)];
                    self[(row, j)] -= factor * above;
                }
                for j in 0..N {
                    let above = x[(column, j)];
                    x[(row, j)] -= factor * above;
                }
            }
        }
        for row in (0..N).rev() {
            for j in 0..N {
                let known: f64 = (row + 1..N).map(|k| self[(row, k)] * x[(k, j)]).sum();
                x[(row, j)] = (x[(row, j)] - known) / self[(row, row)];
            }
        }
        x
    }
}

impl<const N: usize> Index<(usize, usize)> for Matrix<N> {
    type Output = f64;
    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.0[i][j]
    }
}

impl<const N: usize> IndexMut<(usize, usize)> for Matrix<N> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.0[i][j]
    }
}
