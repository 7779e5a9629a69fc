//! Lines that run along the jump vectors of a zone, evenly apart: each begins where none is near, goes on to both sides, and ends
//! before it comes near another.

use kurbo::{Point, Vec2};

use super::field::Field;
use crate::layers::parts::readout::vector;

/// A vector shorter than this, in pixels, leads nowhere.
const LEAST_PX: f64 = 0.01;
/// Lines keep this share of the distance at which they begin.
const APART: f64 = 0.5;
/// Points of a line a cell that it goes through.
const POINTS: f64 = 4.0;

/// The lines, the first from the first of `seeds` on; where lines begin they are `spacing_px` apart.
pub fn streamlines(field: &Field, seeds: impl Iterator<Item = Point>, spacing_px: f64) -> Vec<Vec<Point>> {
    let side = (spacing_px * APART).max(1.0);
    let [columns, rows] = [field.inside.width(), field.inside.height()].map(|n| (n as f64 / side) as usize + 1);
    let mut tracer = Tracer { field, side, step: (side / POINTS).max(0.5), columns, taken: vec![0; columns * rows] };
    let mut lines = Vec::new();
    for seed in seeds {
        lines.extend(tracer.line(seed, lines.len() + 1));
    }
    lines
}

struct Tracer<'a> {
    field: &'a Field,
    /// The side of a cell, and the length of a step, in pixels.
    side: f64,
    step: f64,
    /// Which line goes through a cell, row by row, by its number from 1; 0 if none.
    taken: Vec<usize>,
    columns: usize,
}

impl Tracer<'_> {
    /// The line through a place; `None` if another is near or it would be a point.
    fn line(&mut self, seed: Point, number: usize) -> Option<Vec<Point>> {
        let cell = self.cell(seed);
        if self.taken[cell] != 0 {
            return None;
        }
        self.taken[cell] = number;
        let mut points = self.half(seed, -1.0, number);
        points.reverse();
        points.push(seed);
        points.extend(self.half(seed, 1.0, number));
        (points.len() > POINTS as usize).then_some(points)
    }

    /// What follows a place on one side: with the vectors or against them, by the midpoint rule.
    fn half(&mut self, mut at: Point, way: f64, number: usize) -> Vec<Point> {
        let mut points = Vec::new();
        let mut here = self.cell(at);
        while let Some(first) = self.direction(at)
            && let Some(middle) = self.direction(at + first * (way * self.step / 2.0))
        {
            at += middle * (way * self.step);
            if self.direction(at).is_none() {
                break;
            }
            let next = self.cell(at);
            // A line that comes round to itself ends too.
            if next != here && self.taken[next] != 0 {
                break;
            }
            self.taken[next] = number;
            here = next;
            points.push(at);
            // One that turns within a cell stands still.
            if points.len() > self.most() {
                break;
            }
        }
        points
    }

    /// The most points of a line: as if it went through all cells.
    fn most(&self) -> usize {
        (self.taken.len() + 1) * 2 * POINTS as usize
    }

    fn direction(&self, at: Point) -> Option<Vec2> {
        let (x, y) = (at.x - self.field.x0 as f64, at.y - self.field.y0 as f64);
        let within =
            x >= 0.0 && y >= 0.0 && x < self.field.inside.width() as f64 && y < self.field.inside.height() as f64;
        let (i, j) = within.then_some((x as usize, y as usize))?;
        let jump = vector(*self.field.jumps.get(i, j));
        let length = jump.hypot2().sqrt();
        (*self.field.inside.get(i, j) && length >= LEAST_PX).then(|| jump / length)
    }

    /// The cell of a place in the box.
    fn cell(&self, at: Point) -> usize {
        let of = |place: f64, corner: usize| ((place - corner as f64) / self.side).max(0.0) as usize;
        let (x, y) = (of(at.x, self.field.x0), of(at.y, self.field.y0));
        (y * self.columns + x).min(self.taken.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::pixels::Grid;

    fn lines(vectors: fn(f32, f32) -> [f32; 2], spacing: f64) -> Vec<Vec<Point>> {
        let (width, height) = (40, 30);
        let cells = (0..width * height).map(|i| vectors((i % width) as f32 - 19.5, (i / width) as f32 - 14.5));
        let jumps = Arc::new(Grid::from_cells(width, height, cells.collect()));
        let field = Field { x0: 5, y0: 3, inside: Arc::new(Grid::filled(width, height, true)), jumps, folds: None };
        let seeds =
            (0..6).flat_map(|y| (0..8).map(move |x| Point::new(f64::from(x) * 5.0 + 7.5, f64::from(y) * 5.0 + 5.5)));
        streamlines(&field, seeds, spacing)
    }

    #[test]
    fn lines_run_with_the_vectors_through_the_whole_zone() {
        let lines = lines(|_, _| [2.0, 0.0], 5.0);
        assert_eq!(lines.len(), 6, "one a row of seeds");
        for line in lines {
            let (first, last) = (line[0], line[line.len() - 1]);
            assert!(first.x < 7.0 && last.x > 43.0 && (first.y - last.y).abs() < 1e-9, "{first} {last}");
        }
    }

    #[test]
    fn a_line_that_comes_round_ends_and_nothing_is_drawn_where_nothing_moves() {
        let rings = lines(|x, y| [-y, x], 10.0);
        let around = |line: &Vec<Point>| line.windows(2).map(|pair| (pair[1] - pair[0]).hypot2().sqrt()).sum::<f64>();
        assert!(rings.len() > 1 && rings.iter().all(|ring| around(ring) < 2.5 * std::f64::consts::PI * 20.0));
        for ring in &rings {
            let radius = |at: &Point| (*at - Point::new(25.0, 18.0)).hypot2().sqrt();
            assert!(ring.iter().all(|at| (radius(at) - radius(&ring[0])).abs() < 1.0), "a ring stays one");
        }
        assert!(lines(|_, _| [0.0, 0.0], 5.0).is_empty());
    }

    #[test]
    fn lines_keep_apart() {
        let lines = lines(|x, y| [x, y * 0.3 + 1.0], 8.0);
        for (i, line) in lines.iter().enumerate() {
            let others = lines[i + 1..].iter().flatten();
            let near =
                others.flat_map(|b| line.iter().map(|a| (*a - *b).hypot2().sqrt())).fold(f64::INFINITY, f64::min);
            assert!(near > 0.0, "{near}");
        }
        assert!(lines.len() > 3);
    }
}
