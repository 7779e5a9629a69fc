//! Sums over anchors at every pixel, in a time that hardly depends on how many anchors there are. A quadtree lies over
//! the picture. What an anchor adds is smooth on a cell that is far from it: there it is summed at the cell's Chebyshev
//! nodes only, and handed down to the pixels. Anchors near a cell of pixels are summed directly.
//!
//! Cells are always the same parts of the picture, and each sum is made in the same order, so that a pixel has the same
//! bits whichever part of a field is asked for.

use rayon::prelude::*;

use super::area::{Area, Stretch};
use super::chebyshev::{Chebyshev, NODES, Nodes, Shares, along, row_of};
use super::kernel::{Apart, Fate, GROUP, Kernel, Pair, Source};
use super::method::{AT_ANCHOR_PX, Cell, Method, Wanted};
use crate::base::simd::{fused, fused_doubles, vectorised};

/// Pixels along a side of the cells whose pixels are evaluated at once: the larger, and the smaller where many anchors
/// are near.
pub const LEAF: u32 = 32;
const SMALL_LEAF: u32 = LEAF / 2;

/// With more anchors near it than this a cell is split once more.
const MANY: usize = 10;

/// Cells of at least this size are shared by the rows of a field, and there are at most so many along a side of it.
const BASE: u32 = 64;
const BASES: u32 = 128;

/// With fewer anchors than this all are summed directly.
const FEW: usize = 16;

/// Shares of the nodes in the pixels of a leaf, across and down.
struct Leaf<const S: usize>([Shares<S>; 2]);

/// The anchors of a zone, how they are weighed, and the place in each pixel that is evaluated.
pub struct Cells<K, const C: usize> {
    kernel: K,
    sources: Vec<Source<C>>,
    /// Whether the kernel and the anchors allow for weights in single precision.
    is_single: bool,
    place: [f64; 2],
    /// Side of the one cell that contains the picture.
    whole: u32,
    chebyshev: Chebyshev,
    leaf: Leaf<{ LEAF as usize }>,
    small_leaf: Leaf<{ SMALL_LEAF as usize }>,
}

impl<K: Kernel<C>, const C: usize> Cells<K, C> {
    /// Prepares the anchors of a picture of `size`; `place` is the place in each pixel, from its top-left corner.
    pub fn new(kernel: K, sources: Vec<Source<C>>, size: [u32; 2], place: [f64; 2]) -> Self {
        let chebyshev = Chebyshev::new();
        let whole = size[0].max(size[1]).max(BASE).next_power_of_two();
        let leaf = Leaf(place.map(|first| chebyshev.shares_of_pixels(first, f64::from(LEAF))));
        let small_leaf = Leaf(place.map(|first| chebyshev.shares_of_pixels(first, f64::from(SMALL_LEAF))));
        // Few anchors are told apart to the last bits that double precision has.
        let is_single = kernel.is_single() && sources.len() >= FEW;
        Cells { kernel, sources, is_single, place, whole, chebyshev, leaf, small_leaf }
    }

    /// The quarters of a cell whose part of `area` is `wanted`.
    fn quarters(&self, cell: &Cell, area: &Area, wanted: &dyn Fn(&Area) -> bool) -> impl Iterator<Item = Cell> {
        let size = cell.size() / 2;
        [[false, false], [true, false], [false, true], [true, true]].into_iter().filter_map(move |quarter| {
            let from = [0, 1].map(|k| cell.area.from[k] + if quarter[k] { size } else { 0 });
            let part = Area { from, to: from.map(|from| from + size) };
            part.and(area).filter(wanted).map(|_| self.quarter(cell, quarter, part))
        })
    }

    fn quarter(&self, cell: &Cell, [right, lower]: [bool; 2], area: Area) -> Cell {
        let half = f64::from(cell.size()) / 4.0;
        let middle = area.from.map(|from| f64::from(from) + half);
        let mut quarter = Cell { area, nodes: Vec::new(), near: Vec::new(), doubt: cell.doubt };
        let mut far: Vec<Source<C>> = Vec::new();
        let apart = |&index: &u32| {
            let at = self.sources[index as usize].at;
            let [x, y] = [0, 1].map(|k| (at[k] - middle[k]).abs());
            let square = |x: f64, y: f64| x * x + y * y;
            let nearest2 = square((x - half).max(0.0), (y - half).max(0.0));
            Apart { nearest2, farthest2: square(x + half, y + half), half2: half * half, closest2: 0.0 }
        };
        let closest2 = match K::RELATIVE {
            true => cell.near.iter().map(|index| apart(index).farthest2).fold(f64::INFINITY, f64::min),
            false => 0.0,
        };
        for index in &cell.near {
            let apart = Apart { closest2, ..apart(index) };
            match self.kernel.fate(&apart) {
                Fate::Dropped => {}
                Fate::Far if self.sources.len() >= FEW => {
                    quarter.doubt += self.kernel.doubt(&apart);
                    far.push(self.sources[*index as usize]);
                }
                Fate::Far | Fate::Near => quarter.near.push(*index),
            }
        }
        let places = [0, 1].map(|k| self.chebyshev.nodes.map(|node| middle[k] + node * half));
        quarter.nodes = vectorised(
            #[inline(always)]
            || self.nodes(&cell.nodes, [right, lower], &far, &places),
        );
        quarter
    }

    /// The sums at the nodes of a quarter, from those of the cell and from the anchors that are far only now; `places` are
    /// the columns and the rows of the nodes.
    #[inline(always)]
    fn nodes(
        &self,
        above: &[Nodes],
        [right, lower]: [bool; 2],
        far: &[Source<C>],
        places: &[[f64; NODES]; 2],
    ) -> Vec<Nodes> {
        // Not by a closure, which would be compiled for shorter vectors.
        let mut nodes: Vec<Nodes> = Vec::with_capacity(C);
        for above in above {
            nodes.push(self.chebyshev.quarter(above, right, lower));
        }
        let squares = self.squares_across(far, &places[0]);
        for (row, y) in places[1].iter().enumerate() {
            let sums = self.sum_far(far, &squares, &places[0], *y);
            for (nodes, sums) in nodes.iter_mut().zip(sums) {
                nodes[row].iter_mut().zip(sums).for_each(|(node, sum)| *node += sum);
            }
        }
        nodes
    }

    /// Sums over far anchors at nodes in a row; `squares` are their [`Cells::squares_across`].
    #[inline(always)]
    fn sum_far(&self, far: &[Source<C>], squares: &[[f32; NODES]], xs: &[f64; NODES], y: f64) -> [[f64; NODES]; C] {
        let mut sums = [[0.0; NODES]; C];
        if self.is_single() {
            self.add_single(far, squares, y, &mut sums);
            return sums;
        }
        for source in far {
            let dy = y - source.at[1];
            let mut weights = [0.0; NODES];
            for (weight, x) in weights.iter_mut().zip(xs) {
                let dx = x - source.at[0];
                *weight = self.kernel.weight(dx * dx + dy * dy);
            }
            add(&mut sums, &source.terms, &weights);
        }
        sums
    }

    /// Whether weights are made in single precision.
    #[inline(always)]
    fn is_single(&self) -> bool {
        K::SINGLE && self.is_single
    }

    /// The squares of the ways across from each anchor to the columns `xs`; none unless weights are single.
    #[inline(always)]
    fn squares_across<const N: usize>(&self, sources: &[Source<C>], xs: &[f64; N]) -> Vec<[f32; N]> {
        let mut all = Vec::new();
        if self.is_single() {
            all.resize(sources.len(), [0.0; N]);
        }
        for (squares, source) in all.iter_mut().zip(sources) {
            for (square, x) in squares.iter_mut().zip(xs) {
                let dx = x - source.at[0];
                *square = (dx * dx) as f32;
            }
        }
        all
    }

    /// Adds anchors in a row of places by weights in single precision. Squares of the ways across and down are rounded only
    /// after they were made, so that a weight is as exact for an anchor that is near.
    #[inline(always)]
    fn add_single<const N: usize>(
        &self,
        sources: &[Source<C>],
        squares: &[[f32; N]],
        y: f64,
        sums: &mut [[f64; N]; C],
    ) {
        for (sources, squares) in sources.chunks(GROUP).zip(squares.chunks(GROUP)) {
            let mut group = [[0.0_f32; N]; C];
            for (source, squares) in sources.iter().zip(squares) {
                let dy = y - source.at[1];
                let down = (dy * dy) as f32;
                let mut weights = [0.0_f32; N];
                for (weight, across) in weights.iter_mut().zip(squares) {
                    *weight = self.kernel.weight_single(across + down);
                }
                for (sums, term) in group.iter_mut().zip(&source.terms) {
                    let term = *term as f32;
                    for (sum, weight) in sums.iter_mut().zip(&weights) {
                        *sum = fused(*weight, term, *sum);
                    }
                }
            }
            for (sums, group) in sums.iter_mut().zip(&group) {
                for (sum, of_group) in sums.iter_mut().zip(group) {
                    *sum += f64::from(*of_group);
                }
            }
        }
    }

    /// Tells the pixels of `part` of a cell of size `S`.
    fn tell<const S: usize>(&self, cell: &Cell, leaf: &Leaf<S>, part: &Area, tell: &mut dyn FnMut(Stretch)) {
        let near: Vec<Source<C>> = cell.near.iter().map(|&index| self.sources[index as usize]).collect();
        let [from, to] = [part.from, part.to].map(|end| (end[0] - cell.area.from[0]) as usize);
        let mut rows: Vec<[[f64; S]; 2]> = Vec::with_capacity(S);
        let at = |row: u32| [cell.area.from[0], row];
        vectorised(
            #[inline(always)]
            || {
                let xs = self.columns(cell.area.from[0]);
                let squares = self.squares_across(&near, &xs);
                for row in part.from[1]..part.to[1] {
                    rows.push(self.row(cell, (&near, &squares), leaf, at(row), &xs));
                }
            },
        );
        for ([x, y], row) in rows.iter_mut().zip(part.from[1]..) {
            if K::PASSES_ANCHORS {
                self.take_anchors_at(at(row), &near, x, y);
            }
            tell(Stretch { pixel: [part.from[0], row], x: &mut x[from..to], y: &mut y[from..to] });
        }
    }

    /// The evaluated places in the columns from `first` on.
    #[inline(always)]
    fn columns<const S: usize>(&self, first: u32) -> [f64; S] {
        let mut xs = [0.0; S];
        for (k, x) in xs.iter_mut().enumerate() {
            *x = f64::from(first) + k as f64 + self.place[0];
        }
        xs
    }

    /// The jump vectors in the row of a leaf that begins at `pixel`.
    #[inline(always)]
    fn row<const S: usize>(
        &self,
        cell: &Cell,
        (near, squares): (&[Source<C>], &[[f32; S]]),
        Leaf([across, down]): &Leaf<S>,
        pixel: [u32; 2],
        xs: &[f64; S],
    ) -> [[f64; S]; 2] {
        let row = (pixel[1] - cell.area.from[1]) as usize;
        let y = f64::from(pixel[1]) + self.place[1];
        let mut sums = [[0.0; S]; C];
        for (sums, nodes) in sums.iter_mut().zip(&cell.nodes) {
            *sums = along(&row_of(nodes, down, row), across);
        }
        match self.is_single() {
            true => self.add_single(near, squares, y, &mut sums),
            false => self.add_near(near, pixel, xs, y, &mut sums),
        }
        if cell.doubt > 0.0 && sums[0].iter().any(|sum| *sum < cell.doubt) {
            sums = [[0.0; S]; C];
            self.add_near(&self.sources, pixel, xs, y, &mut sums);
        }
        self.kernel.jumps(&sums, xs, y)
    }

    /// Adds near anchors in a row of pixels.
    #[inline(always)]
    fn add_near<const S: usize>(
        &self,
        near: &[Source<C>],
        pixel: [u32; 2],
        xs: &[f64; S],
        y: f64,
        sums: &mut [[f64; S]; C],
    ) {
        let mut nearest2 = [f64::INFINITY; S];
        if K::RELATIVE {
            for source in near {
                let dy = y - source.at[1];
                for (nearest2, x) in nearest2.iter_mut().zip(xs) {
                    let dx = x - source.at[0];
                    let d2 = dx * dx + dy * dy;
                    *nearest2 = if d2 < *nearest2 { d2 } else { *nearest2 };
                }
            }
        }
        for source in near {
            let dy = y - source.at[1];
            let mut weights = [0.0; S];
            for (k, weight) in weights.iter_mut().enumerate() {
                let dx = xs[k] - source.at[0];
                let pixel = [pixel[0] + k as u32, pixel[1]];
                let pair = Pair { d2: dx * dx + dy * dy, nearest2: nearest2[k], pixel, index: source.index };
                *weight = self.kernel.weight_near(pair);
            }
            add(sums, &source.terms, &weights);
        }
    }

    /// Gives pixels at an anchor its vector; the first anchor there counts.
    fn take_anchors_at<const S: usize>(&self, pixel: [u32; 2], near: &[Source<C>], x: &mut [f64; S], y: &mut [f64; S]) {
        let [first, row] = [0, 1].map(|k| f64::from(pixel[k]) + self.place[k]);
        for source in near.iter().rev() {
            let dy = row - source.at[1];
            if dy.abs() >= AT_ANCHOR_PX {
                continue;
            }
            let k = (source.at[0] - first).round();
            if k >= 0.0 && k < S as f64 {
                let dx = first + k - source.at[0];
                if dx * dx + dy * dy < AT_ANCHOR_PX * AT_ANCHOR_PX {
                    [x[k as usize], y[k as usize]] = source.jump;
                }
            }
        }
    }
}

impl<K: Kernel<C>, const C: usize> Method for Cells<K, C> {
    fn cells(&self, area: &Area, wanted: Wanted, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Vec<Cell>> {
        let base = (self.whole / BASES).max(BASE);
        let whole = Area { from: [0, 0], to: [self.whole, self.whole] };
        let near = (0..self.sources.len() as u32).collect();
        let mut cells = vec![Cell { area: whole, nodes: vec![[[0.0; NODES]; NODES]; C], near, doubt: 0.0 }];
        while cells.first().is_some_and(|cell| cell.size() > base) {
            let quarters = |cell: &Cell| (!stopped()).then(|| self.quarters(cell, area, wanted).collect::<Vec<_>>());
            cells = cells.par_iter().map(quarters).collect::<Option<Vec<_>>>()?.concat();
        }
        cells.sort_unstable_by_key(|cell| [cell.area.from[1], cell.area.from[0]]);
        Some(cells)
    }

    fn fill(&self, cell: &Cell, area: &Area, wanted: &dyn Fn(&Area) -> bool, tell: &mut dyn FnMut(Stretch)) {
        let Some(part) = cell.area.and(area).filter(|part| wanted(part)) else { return };
        match cell.size() {
            LEAF if cell.near.len() <= MANY => self.tell(cell, &self.leaf, &part, tell),
            SMALL_LEAF => self.tell(cell, &self.small_leaf, &part, tell),
            _ => self.quarters(cell, area, wanted).for_each(|quarter| self.fill(&quarter, area, wanted, tell)),
        }
    }
}

/// Adds the product of `terms` and `weights`.
#[inline(always)]
fn add<const N: usize, const C: usize>(sums: &mut [[f64; N]; C], terms: &[f64; C], weights: &[f64; N]) {
    for (sums, term) in sums.iter_mut().zip(terms) {
        for (sum, weight) in sums.iter_mut().zip(weights) {
            *sum = fused_doubles(*weight, *term, *sum);
        }
    }
}
