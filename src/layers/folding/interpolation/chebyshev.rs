//! Interpolation between Chebyshev nodes: a function that is smooth on a square cell is known from its values at a few
//! places, handed down to the four quarters of the cell by two small matrices, and to its pixels by two more.

use crate::base::maths;
use crate::base::simd::{fused_doubles, vectorised};

/// Nodes along each side of a cell.
pub const NODES: usize = 8;

/// Values at the nodes of a cell, row by row.
pub type Nodes = [[f64; NODES]; NODES];

/// Shares of the nodes (first index) in the values at `N` places along a side.
pub type Shares<const N: usize> = [[f64; N]; NODES];

/// Where the nodes are, and how the quarters of a cell follow from them.
pub struct Chebyshev {
    /// The nodes along a side that reaches from -1 to 1.
    pub nodes: [f64; NODES],
    /// Shares of a side's nodes in those of its lower and upper half.
    halves: [Shares<NODES>; 2],
}

impl Chebyshev {
    /// The nodes, and all that follows from them.
    pub fn new() -> Self {
        let turn = maths::TAU / (4 * NODES) as f64;
        let nodes = std::array::from_fn(|k| -maths::cos((2 * k + 1) as f64 * turn));
        let half = |middle: f64| shares(&nodes, nodes.map(|node| (node + middle) / 2.0));
        Chebyshev { halves: [half(-1.0), half(1.0)], nodes }
    }

    /// Shares of the nodes in `N` places from `first` on, one unit apart, of a side from 0 to `size`.
    pub fn shares_of_pixels<const N: usize>(&self, first: f64, size: f64) -> Shares<N> {
        shares(&self.nodes, std::array::from_fn(|k| (k as f64 + first) / size * 2.0 - 1.0))
    }

    /// The values at the nodes of a quarter: `right` and `lower` say of which.
    #[inline(always)]
    pub fn quarter(&self, values: &Nodes, right: bool, lower: bool) -> Nodes {
        let (across, down) = (&self.halves[usize::from(right)], &self.halves[usize::from(lower)]);
        let mut quarter = [[0.0; NODES]; NODES];
        for (row, out) in quarter.iter_mut().enumerate() {
            *out = along(&row_of(values, down, row), across);
        }
        quarter
    }

    /// The largest error with which a cell gives `weight` of the squared distance, in half sides, to an anchor that is
    /// `gap` half sides away from it; errors are divided by `unit` of the value there.
    pub fn error(&self, gap: f64, weight: impl Fn(f64) -> f64, unit: impl Fn(f64) -> f64) -> f64 {
        const PLACES: usize = 9;
        let places: [f64; PLACES] = std::array::from_fn(|k| k as f64 / 4.0 - 1.0);
        let shares = shares(&self.nodes, places);
        let (straight, diagonal) = (1.0 + gap, 1.0 + gap * std::f64::consts::FRAC_1_SQRT_2);
        let mut worst = 0.0_f64;
        for [x, y] in [[straight, 0.0], [straight, 0.6], [straight, 1.0], [diagonal, diagonal]] {
            let exact = |at_x: f64, at_y: f64| weight((at_x - x) * (at_x - x) + (at_y - y) * (at_y - y));
            let values = self.nodes.map(|at_y| self.nodes.map(|at_x| exact(at_x, at_y)));
            for (row, at_y) in places.into_iter().enumerate() {
                let found = vectorised(
                    #[inline(always)]
                    || along(&row_of(&values, &shares, row), &shares),
                );
                for (found, at_x) in found.into_iter().zip(places) {
                    let exact = exact(at_x, at_y);
                    worst = worst.max(((found - exact) / unit(exact)).abs());
                }
            }
        }
        worst
    }
}

/// Row `row` of the places that `shares` are of, still at the nodes' columns.
#[inline(always)]
pub fn row_of<const N: usize>(values: &Nodes, shares: &Shares<N>, row: usize) -> [f64; NODES] {
    let mut sum = [0.0; NODES];
    for (values, shares) in values.iter().zip(shares) {
        let share = shares[row];
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum = fused_doubles(share, *value, *sum);
        }
    }
    sum
}

/// The values along a row from those at its nodes.
#[inline(always)]
pub fn along<const N: usize>(row: &[f64; NODES], shares: &Shares<N>) -> [f64; N] {
    let mut sums = [0.0; N];
    for (value, shares) in row.iter().zip(shares) {
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum = fused_doubles(*value, *share, *sum);
        }
    }
    sums
}

/// Lagrange's polynomials of the nodes at some places.
fn shares<const N: usize>(nodes: &[f64; NODES], places: [f64; N]) -> Shares<N> {
    let share = |k: usize, place: f64| {
        let others = nodes.iter().enumerate().filter(|(other, _)| *other != k);
        others.fold(1.0, |product, (_, other)| product * (place - other) / (nodes[k] - other))
    };
    std::array::from_fn(|k| places.map(|place| share(k, place)))
}
