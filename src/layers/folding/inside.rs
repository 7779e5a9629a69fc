//! Which pixels are inside polygons.

use std::ops::Range;

use kurbo::{Rect, Vec2};

use super::interpolation::area::Area;
use crate::base::geometry::Polygon;
use crate::base::pixels::Grid;

/// Which pixels of a picture of `size` have their `place` inside the polygon.
pub fn mask(polygon: &Polygon, (width, height): (usize, usize), place: Vec2) -> Grid<bool> {
    let mut marked = vec![false; width * height];
    spans(polygon, &Area { from: [0; 2], to: [width as u32, height as u32] }, place, &mut marked);
    Grid::from_cells(width, height, marked)
}

/// Marks the pixels of `area`, row by row, whose `place` is inside the polygon.
pub fn spans(polygon: &Polygon, area: &Area, place: Vec2, marked: &mut [bool]) {
    let mut crossings = Vec::new();
    let (first, end) = (f64::from(area.from[0]), f64::from(area.to[0]));
    // The first column at or after a crossing, by the very sum that decides it.
    let column = |crossing: f64| {
        let reached = |x: f64| crossing <= x + place.x;
        let mut x = (crossing - place.x).ceil().clamp(first, end);
        while x > first && reached(x - 1.0) {
            x -= 1.0;
        }
        while x < end && !reached(x) {
            x += 1.0;
        }
        (x - first) as usize
    };
    let rows = marked.chunks_exact_mut((area.to[0] - area.from[0]) as usize);
    for (row, y) in rows.zip(area.from[1]..) {
        polygon.row_crossings(f64::from(y) + place.y, &mut crossings);
        for pair in crossings.chunks_exact(2) {
            row[column(pair[0])..column(pair[1])].fill(true);
        }
    }
}

/// The pixels that `bounds` touches in a part of a picture: first column and row, width, height.
pub fn pixel_box(bounds: Rect, part: (Range<usize>, Range<usize>)) -> Option<(usize, usize, usize, usize)> {
    let clip = |low: f64, high: f64, part: Range<usize>| {
        let (from, to) = (part.start as f64, part.end as f64);
        let first = low.floor().clamp(from, to) as usize;
        let end = high.ceil().clamp(from, to) as usize;
        (end > first).then(|| (first, end - first))
    };
    let (x0, w) = clip(bounds.x0, bounds.x1, part.0)?;
    let (y0, h) = clip(bounds.y0, bounds.y1, part.1)?;
    Some((x0, y0, w, h))
}
