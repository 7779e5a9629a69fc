//! Which parts of lines in space are hidden by surfaces. Depths are looked up in a grid over the frame.

use kurbo::Point;
use rayon::prelude::*;

use crate::base::maths::lerp;
use crate::layers::parts::moment::Columns;

/// At most so many depths are looked up.
const MOST: f64 = 500_000.0;
/// A line is hidden only by what is nearer than it by more than this share of its depth.
const NEARER: f64 = 1e-3;

/// How far away the nearest surfaces are, the farthest of those in and beside each cell of a grid: at its edge a surface
/// does not hide what is drawn on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Depths {
    /// Side of a cell, in pixels.
    side: usize,
    width: usize,
    /// In meters; infinite where nothing is.
    cells: Vec<f64>,
}

impl Depths {
    /// In a frame of this width and height; `row` lowers the depths in these columns of a row to those of surfaces.
    pub fn new((width, height): (usize, usize), row: impl Fn(usize, Columns, &mut [f64]) + Sync) -> Depths {
        let side = ((width * height) as f64 / MOST).sqrt().ceil().max(1.0) as usize;
        let middles = |length: usize| (0..length).step_by(side).map(move |from| (from + side / 2).min(length - 1));
        let (columns, rows): (Vec<usize>, Vec<usize>) = (middles(width).collect(), middles(height).collect());
        let mut depths = vec![f64::INFINITY; columns.len() * rows.len()];
        let lines = depths.par_chunks_mut(columns.len().max(1)).zip(&rows);
        lines.for_each(|(depths, &y)| row(y, Columns::Some(&columns), depths));
        let width = columns.len();
        let farthest = |i: usize| {
            let (x, y) = (i % width, i / width);
            let beside = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
            let near = beside(y, rows.len()).flat_map(|y| beside(x, width).map(move |x| y * width + x));
            near.map(|i| depths[i]).fold(0.0, f64::max)
        };
        let cells = (0..depths.len()).into_par_iter().map(farthest).collect();
        Depths { side, width, cells }
    }

    fn shows(&self, at: Point, inverse: f64) -> bool {
        let [x, y] = [at.x, at.y].map(|at| (at / self.side as f64).floor());
        let within = x >= 0.0 && x < self.width as f64 && y >= 0.0;
        let depth = within.then(|| self.cells.get(y as usize * self.width + x as usize)).flatten();
        depth.is_none_or(|depth| 1.0 <= depth * inverse * (1.0 + NEARER))
    }

    /// The parts of a line that nothing hides; its ends come with 1 / their depths.
    pub fn shown(&self, [(a, inverse_a), (b, inverse_b)]: [(Point, f64); 2]) -> Vec<[Point; 2]> {
        let steps = ((b - a).hypot() / self.side as f64).ceil().max(1.0) as usize;
        let share = |step: usize| step as f64 / steps as f64;
        let shows = |step: &usize| {
            // In the middle of a step: ends are where other surfaces meet this one.
            let share = share(*step) + 0.5 / steps as f64;
            self.shows(a.lerp(b, share), lerp(inverse_a, inverse_b, share))
        };
        let mut parts = Vec::new();
        let mut step = 0;
        while let Some(from) = (step..steps).find(shows) {
            let to = (from..steps).find(|step| !shows(step)).unwrap_or(steps);
            parts.push([a.lerp(b, share(from)), a.lerp(b, share(to))]);
            step = to;
        }
        parts
    }
}
