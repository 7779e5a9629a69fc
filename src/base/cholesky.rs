//! Cholesky factorisation U'U of a symmetric positive definite matrix, block by block on all cores. It is not from a
//! library, because libraries choose their instructions, and with them the order of their sums, by the processor: here
//! each number's sum runs over the rows above it in order, by multiplications and subtractions alone, so that the bits
//! are the same on every machine and for any number of threads.

use rayon::prelude::*;

/// Rows per block; a block is eliminated from the rest in one pass.
const BLOCK: usize = 32;
/// Rows per task.
const TASK: usize = 32;
/// Rows and columns of a tile, whose sums stay in registers.
const TILE: usize = 4;

/// A matrix, row by row; its rows are [`stride`] numbers long.
pub struct Matrix {
    /// The numbers.
    pub cells: Vec<f64>,
    /// Numbers per row.
    pub stride: usize,
}

/// The length of a row for `columns` numbers: a whole number of tiles.
pub fn stride(columns: usize) -> usize {
    columns.next_multiple_of(TILE)
}

impl Matrix {
    /// A matrix of zeros.
    pub fn new(rows: usize, columns: usize) -> Self {
        Matrix { cells: vec![0.0; rows * stride(columns)], stride: stride(columns) }
    }

    /// One row.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.cells[i * self.stride..][..self.stride]
    }

    /// Overwrites the upper triangle of the first `n` rows and columns with U, and the columns B after them with U'^-1
    /// B; what is below the diagonal is left undefined. `None` if `stopped` becomes true.
    pub fn factor(&mut self, n: usize, stopped: &(impl Fn() -> bool + Sync)) -> Option<()> {
        let stride = self.stride;
        let largest = (0..n).map(|i| self.cells[i * stride + i].abs()).fold(0.0, f64::max);
        // Rounding can leave a pivot near or below 0 for two anchors at almost the same place: with at least this much,
        // they share the weight.
        let least = (largest * f64::EPSILON).max(f64::MIN_POSITIVE);
        for first in (0..n).step_by(BLOCK) {
            let (above, below) = self.cells[..n * stride].split_at_mut((first + BLOCK).min(n) * stride);
            let block = &mut above[first * stride..];
            factor_block(block, stride, first, least);
            let next = first + block.len() / stride;
            let task = |(task, rows): (usize, &mut [f64])| {
                (!stopped()).then(|| subtract(block, rows, stride, next + task * TASK))
            };
            below.par_chunks_mut(TASK * stride).enumerate().map(task).collect::<Option<()>>()?;
        }
        Some(())
    }

    /// U^-1 times column `column`, after [`Matrix::factor`].
    pub fn solve(&self, n: usize, column: usize) -> Vec<f64> {
        let mut solved = vec![0.0; n];
        for i in (0..n).rev() {
            let row = self.row(i);
            let rest = (i + 1..n).fold(row[column], |rest, j| rest - row[j] * solved[j]);
            solved[i] = rest / row[i];
        }
        solved
    }
}

/// Factors the rows of one block, whose first row has number `first`.
fn factor_block(block: &mut [f64], stride: usize, first: usize, least: f64) {
    for k in 0..block.len() / stride {
        let (done, rest) = block.split_at_mut((k + 1) * stride);
        let row = &mut done[k * stride + first + k..];
        let root = row[0].max(least).sqrt();
        row[0] = root;
        row[1..].iter_mut().for_each(|cell| *cell /= root);
        for (below, other) in rest.chunks_exact_mut(stride).enumerate() {
            let factor = row[below + 1];
            let from = first + k + 1 + below;
            for (cell, above) in other[from..].iter_mut().zip(&row[below + 1..]) {
                *cell -= factor * above;
            }
        }
    }
}

/// Eliminates the rows of `block` from `rows`, whose first row has number `first`.
fn subtract(block: &[f64], rows: &mut [f64], stride: usize, first: usize) {
    let depth = block.len() / stride;
    let mut right = [[0.0; TILE]; BLOCK];
    for column in (first / TILE * TILE..stride).step_by(TILE) {
        for (right, row) in right.iter_mut().zip(block.chunks_exact(stride)) {
            right.copy_from_slice(&row[column..][..TILE]);
        }
        for (four, rows) in rows.chunks_mut(TILE * stride).enumerate() {
            let row = first + four * TILE;
            match rows.len() / stride {
                TILE => tile::<TILE>(block, rows, stride, row, column, &right[..depth]),
                // The last rows, one by one.
                few => (0..few).for_each(|i| {
                    tile::<1>(block, &mut rows[i * stride..][..stride], stride, row + i, column, &right[..depth]);
                }),
            }
        }
    }
}

#[inline(always)]
fn tile<const ROWS: usize>(
    block: &[f64],
    rows: &mut [f64],
    stride: usize,
    row: usize,
    column: usize,
    right: &[[f64; TILE]],
) {
    let mut sums = [[0.0; TILE]; ROWS];
    for (sum, row) in sums.iter_mut().zip(rows.chunks_exact(stride)) {
        sum.copy_from_slice(&row[column..][..TILE]);
    }
    for (right, above) in right.iter().zip(block.chunks_exact(stride)) {
        let left = &above[row..][..ROWS];
        for (sum, left) in sums.iter_mut().zip(left) {
            for (sum, right) in sum.iter_mut().zip(right) {
                *sum -= left * right;
            }
        }
    }
    for (sum, row) in sums.iter().zip(rows.chunks_exact_mut(stride)) {
        row[column..][..TILE].copy_from_slice(sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix whose numbers need rounding, and a column beside it.
    fn example(n: usize) -> Matrix {
        let mut matrix = Matrix::new(n, n + 1);
        let number = |i: usize, j: usize| ((i * 7919 + j * 104_729) % 1009) as f64 / 1009.0 - 0.5;
        for i in 0..n {
            for j in 0..n {
                matrix.cells[i * matrix.stride + j] = number(i.min(j), i.max(j)) + if i == j { n as f64 } else { 0.0 };
            }
            matrix.cells[i * matrix.stride + n] = number(i, i + 1);
        }
        matrix
    }

    #[test]
    fn what_is_solved_fits() {
        for n in [0, 1, 2, 3, 4, 5, 31, 32, 33, 64, 67, 130] {
            let before = example(n);
            let mut matrix = example(n);
            matrix.factor(n, &|| false).unwrap();
            let solved = matrix.solve(n, n);
            for i in 0..n {
                let sum: f64 = (0..n).map(|j| before.row(i)[j] * solved[j]).sum();
                assert!((sum - before.row(i)[n]).abs() < 1e-12, "{n} {i}");
            }
        }
        assert!(example(100).factor(100, &|| true).is_none());
    }

    #[test]
    fn sums_run_in_one_order() {
        let n = 75;
        let (mut blocks, plain) = (example(n), example(n));
        blocks.factor(n, &|| false).unwrap();
        let mut rows: Vec<Vec<f64>> = (0..n).map(|i| plain.row(i).to_vec()).collect();
        for k in 0..n {
            let root = rows[k][k].sqrt();
            rows[k][k] = root;
            (k + 1..=n).for_each(|j| rows[k][j] /= root);
            for i in k + 1..n {
                for j in i..=n {
                    rows[i][j] -= rows[k][i] * rows[k][j];
                }
            }
        }
        for (i, row) in rows.iter().enumerate() {
            let bits = |row: &[f64]| row[i..=n].iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(blocks.row(i)), bits(row), "row {i}");
        }
    }
}
