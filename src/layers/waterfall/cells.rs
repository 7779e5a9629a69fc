//! Which cells of a frame, or of what is looked at of it, a sprite covers.

use std::ops::Range;

use super::splat::Splat;

/// A sprite to be drawn, with the cells that it may cover.
pub struct Covering<'a> {
    /// The sprite.
    pub splat: &'a Splat,
    /// The columns.
    pub columns: Range<usize>,
    /// The rows.
    pub rows: Range<usize>,
}

/// The cells of a canvas that a sprite may cover; `None` if there are none.
pub fn covered(splat: &Splat, places: &[Vec<f64>; 2]) -> Option<[Range<usize>; 2]> {
    let turn = splat.turn.abs();
    let half = [
        (turn.x * splat.size_px.x + turn.y * splat.size_px.y) / 2.0,
        (turn.y * splat.size_px.x + turn.x * splat.size_px.y) / 2.0,
    ];
    let range = |axis: usize, middle: f64| {
        let (low, high) = (middle - half[axis] - 1e-6, middle + half[axis] + 1e-6);
        let from = places[axis].partition_point(|at| *at < low);
        from..from + places[axis][from..].partition_point(|at| *at <= high)
    };
    let found = [range(0, splat.middle.x), range(1, splat.middle.y)];
    found.iter().all(|range| !range.is_empty()).then_some(found)
}

/// Where in a sprite a place of the frame is: from -1/2 to 1/2 if it is inside.
#[inline(always)]
pub fn inside(splat: &Splat, x: f64, y: f64) -> Option<[f64; 2]> {
    let (dx, dy) = (x - splat.middle.x, y - splat.middle.y);
    let across = (splat.turn.x * dx + splat.turn.y * dy) / splat.size_px.x;
    let along = (splat.turn.x * dy - splat.turn.y * dx) / splat.size_px.y;
    (across.abs() < 0.5 && along.abs() < 0.5).then_some([if splat.mirrored { -across } else { across }, along])
}
