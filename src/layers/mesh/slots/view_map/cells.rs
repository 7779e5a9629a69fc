//! The cells of a surface: squares of its charts in layers, each with four times as many as the one before.

use glam::DVec2;

use super::atlas::Atlas;

/// No cell.
pub const NONE: u32 = u32::MAX;

/// How far the square of a cell is drawn in on each side where it is asked whether a triangle meets it, in cells.
const DRAWN_IN: f64 = 1e-6;

/// The cells of all layers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// The layers, the coarsest first.
    pub layers: Vec<Layer>,
}

/// The cells of one layer, numbered chart by chart, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    /// How many cells are side by side in a unit of the atlas.
    pub resolution: f64,
    /// Where each cell is.
    pub cells: Vec<Cell>,
    /// The squares of each chart that may be cells.
    pub charts: Vec<Chart>,
    /// The cell of each of those squares, or [`NONE`].
    pub numbers: Vec<u32>,
}

/// Where a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Its chart.
    pub chart: u32,
    /// Its column.
    pub x: i32,
    /// Its row.
    pub y: i32,
}

/// A rectangle of squares, row by row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chart {
    /// The number of its first square.
    pub first: usize,
    /// How many are side by side.
    pub width: i32,
    /// How many rows.
    pub height: i32,
}

impl Layer {
    /// The cell of a chart in column `x`, row `y`, if there is one.
    #[inline]
    pub fn find(&self, chart: u32, x: i32, y: i32) -> u32 {
        let chart = &self.charts[chart as usize];
        let within = x >= 0 && y >= 0 && x < chart.width && y < chart.height;
        if within { self.numbers[chart.first + y as usize * chart.width as usize + x as usize] } else { NONE }
    }

    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The four cells nearest to a place, in cells of this layer, and how much each counts; without those that are not
    /// there the weights do not sum to one.
    #[inline]
    pub fn four(&self, chart: u32, at: DVec2) -> [(u32, f64); 4] {
        let (gx, gy) = (at.x - 0.5, at.y - 0.5);
        let (x, y) = (floor(gx), floor(gy));
        let (wx, wy) = (gx - f64::from(x), gy - f64::from(y));
        [
            (self.find(chart, x, y), (1.0 - wx) * (1.0 - wy)),
            (self.find(chart, x + 1, y), wx * (1.0 - wy)),
            (self.find(chart, x, y + 1), (1.0 - wx) * wy),
            (self.find(chart, x + 1, y + 1), wx * wy),
        ]
    }

    /// The four cells of this layer that are nearest to the middle of a cell of the next.
    #[inline]
    pub fn above(&self, finer: &Cell) -> [(u32, f64); 4] {
        self.four(finer.chart, DVec2::new(f64::from(finer.x) + 0.5, f64::from(finer.y) + 0.5) / 2.0)
    }

    /// The cells of the next layer that a cell of this one is made of.
    #[inline]
    pub fn children(cell: &Cell, finer: &Layer) -> [u32; 4] {
        let find = |x: i32, y: i32| finer.find(cell.chart, 2 * cell.x + x, 2 * cell.y + y);
        [find(0, 0), find(1, 0), find(0, 1), find(1, 1)]
    }

    /// The cells round one, row by row.
    #[inline]
    pub fn around(&self, cell: &Cell) -> [u32; 8] {
        const WAYS: [(i32, i32); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        WAYS.map(|(x, y)| self.find(cell.chart, cell.x + x, cell.y + y))
    }
}

/// The most cells of the finest layer.
pub const MOST_CELLS: f64 = 16_777_216.0;

impl Cells {
    /// The cells of so many layers, of which the first has so many side by side in a unit of the atlas.
    pub fn new(atlas: &Atlas, first: u32, levels: usize) -> Cells {
        let Some(finest) = levels.checked_sub(1) else { return Cells::default() };
        let mut layers = vec![Layer::finest(atlas, f64::from(first) * f64::from(1 << finest))];
        for _ in 0..finest {
            let coarser = layers.last().map(Layer::coarser);
            layers.extend(coarser);
        }
        layers.reverse();
        Cells { layers }
    }

    /// How many cells there are on all layers.
    pub fn count(&self) -> usize {
        self.layers.iter().map(Layer::len).sum()
    }

    /// So many layers, or as many of them as have no more than [`MOST_CELLS`] on the finest.
    pub fn fitting(atlas: &Atlas, first: u32, levels: usize) -> usize {
        (1..=levels).rev().find(|levels| Cells::most(atlas, first, *levels) <= MOST_CELLS).unwrap_or(levels.min(1))
    }

    /// How many squares a finest layer may have at most, before it is made.
    pub fn most(atlas: &Atlas, first: u32, levels: usize) -> f64 {
        let resolution = f64::from(first) * f64::from(1_u32 << levels.saturating_sub(1));
        let squares = atlas.extents.iter().map(|most| {
            let [width, height] = (*most * resolution).to_array();
            (width.floor() + 1.0) * (height.floor() + 1.0)
        });
        squares.sum()
    }
}

impl Layer {
    fn finest(atlas: &Atlas, resolution: f64) -> Layer {
        let squares = atlas.extents.iter().map(|most| (*most * resolution).floor());
        let (charts, count) = rectangles(squares.map(|most| [most.x as i32 + 1, most.y as i32 + 1]));
        let mut there = vec![false; count];
        for (corners, chart) in atlas.corners.iter().zip(&atlas.chart) {
            let chart = &charts[*chart as usize];
            met(&corners.map(|corner| corner * resolution), |x, y| {
                if x >= 0 && y >= 0 && x < chart.width && y < chart.height {
                    there[chart.first + y as usize * chart.width as usize + x as usize] = true;
                }
            });
        }
        Layer::numbered(resolution, charts, &there)
    }

    fn coarser(&self) -> Layer {
        let halves = self.charts.iter().map(|chart| [(chart.width + 1) / 2, (chart.height + 1) / 2]);
        let (charts, count) = rectangles(halves);
        let mut there = vec![false; count];
        for cell in &self.cells {
            let chart = &charts[cell.chart as usize];
            there[chart.first + (cell.y / 2) as usize * chart.width as usize + (cell.x / 2) as usize] = true;
        }
        Layer::numbered(self.resolution / 2.0, charts, &there)
    }

    fn numbered(resolution: f64, charts: Vec<Chart>, there: &[bool]) -> Layer {
        let mut numbers = vec![NONE; there.len()];
        let mut cells = Vec::with_capacity(there.iter().filter(|there| **there).count());
        for (number, chart) in charts.iter().enumerate() {
            for y in 0..chart.height {
                for x in 0..chart.width {
                    let at = chart.first + y as usize * chart.width as usize + x as usize;
                    if there[at] {
                        numbers[at] = cells.len() as u32;
                        cells.push(Cell { chart: number as u32, x, y });
                    }
                }
            }
        }
        Layer { resolution, cells, charts, numbers }
    }

    /// For each cell, the triangles whose inside has its middle: how many, and the last.
    pub fn middles(&self, atlas: &Atlas) -> Vec<(u32, u32)> {
        let mut found = vec![(0, 0); self.cells.len()];
        for (triangle, (corners, chart)) in atlas.corners.iter().zip(&atlas.chart).enumerate() {
            let corners = corners.map(|corner| corner * self.resolution);
            let low = corners[0].min(corners[1]).min(corners[2]);
            let high = corners[0].max(corners[1]).max(corners[2]);
            let sense = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).signum();
            for y in floor(low.y)..=floor(high.y) {
                for x in floor(low.x)..=floor(high.x) {
                    let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let inside =
                        |k: usize| (corners[(k + 1) % 3] - corners[k]).perp_dot(middle - corners[k]) * sense > 0.0;
                    let cell = self.find(*chart, x, y);
                    if cell != NONE && inside(0) && inside(1) && inside(2) {
                        let (count, last) = &mut found[cell as usize];
                        (*count, *last) = (*count + 1, triangle as u32);
                    }
                }
            }
        }
        found
    }
}

/// The whole number below, of numbers that are small enough.
#[inline]
fn floor(x: f64) -> i32 {
    let cut = x as i32;
    cut - i32::from(f64::from(cut) > x)
}

fn rectangles(sizes: impl Iterator<Item = [i32; 2]>) -> (Vec<Chart>, usize) {
    let mut first = 0;
    let charts = sizes.map(|[width, height]| {
        let chart = Chart { first, width, height };
        first += width as usize * height as usize;
        chart
    });
    let charts: Vec<Chart> = charts.collect();
    (charts, first)
}

/// Calls `each` with column and row of every square that a triangle meets, its corners in squares.
fn met(corners: &[DVec2; 3], mut each: impl FnMut(i32, i32)) {
    let low = corners[0].min(corners[1]).min(corners[2]);
    let high = corners[0].max(corners[1]).max(corners[2]);
    let axes: [(DVec2, f64, f64); 3] = std::array::from_fn(|k| {
        let side = corners[(k + 1) % 3] - corners[k];
        let across = side.perp();
        let along = corners.map(|corner| across.dot(corner - corners[k]));
        (across, along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2]))
    });
    for y in low.y.floor() as i32..=high.y.floor() as i32 {
        for x in low.x.floor() as i32..=high.x.floor() as i32 {
            let from = DVec2::new(f64::from(x) + DRAWN_IN, f64::from(y) + DRAWN_IN);
            let to = DVec2::new(f64::from(x) + 1.0 - DRAWN_IN, f64::from(y) + 1.0 - DRAWN_IN);
            let apart = high.x < from.x || high.y < from.y || low.x > to.x || low.y > to.y;
            let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
            let beside = |(k, (across, least, most)): (usize, &(DVec2, f64, f64))| {
                let (at, reach) = (across.dot(middle - corners[k]), across.abs().dot(half));
                at + reach < *least || at - reach > *most
            };
            if !apart && !axes.iter().enumerate().any(beside) {
                each(x, y);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn automatic_layers_end_where_the_finest_would_have_too_many_cells() {
        let atlas = Atlas { extents: vec![DVec2::ONE], ..Atlas::default() };
        // 64 * 2^5 = 2048 side by side fit, 4096 and one more at the border do not.
        for (first, levels, fits) in
            [(64, 3, 3), (64, 6, 6), (64, 7, 6), (64, 20, 6), (4095, 2, 1), (5000, 2, 1), (64, 0, 0)]
        {
            assert_eq!(Cells::fitting(&atlas, first, levels), fits, "{levels} layers from {first}");
        }
        let two = Atlas { extents: vec![DVec2::ONE, DVec2::new(0.5, 1.0)], ..Atlas::default() };
        assert_eq!(Cells::most(&two, 2, 2), 25.0 + 15.0, "squares of all charts");
        assert_eq!(Cells::fitting(&two, 2048, 2), 1);
    }
}
