//! Draws sprites into a frame. Every pixel meets them in the same order, whatever the number of threads: the frame is cut
//! into strips, and each strip draws all its sprites one after the other.

use std::ops::Range;

use rayon::prelude::*;

use super::between::texels;
use super::model::Mixing;
use super::splat::Splat;
use super::synth::Synth;
use crate::base::pixels::Rgba;

/// Sprites are made at once up to so many texels.
const TEXELS: usize = 1 << 20;
/// The fewest rows of a strip.
const ROWS: usize = 16;

/// Where a frame is looked at, and what is there already.
pub struct Canvas<'a> {
    /// The places of columns, and of rows, in pixels of the frame: ascending.
    pub places: [Vec<f64>; 2],
    /// How far away the surface is at each place, row by row, in meters; infinite where there is none.
    pub depth: &'a [f64],
    /// What is there, linear light, premultiplied.
    pub out: &'a mut [Rgba],
}

/// A sprite to be drawn, with the cells that it may cover.
struct Drawn<'a> {
    splat: &'a Splat,
    columns: Range<usize>,
    rows: Range<usize>,
    /// Its texels, row by row, and their side.
    texels: Vec<f32>,
    side: usize,
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
#[inline]
pub fn inside(splat: &Splat, x: f64, y: f64) -> Option<[f64; 2]> {
    let (dx, dy) = (x - splat.middle.x, y - splat.middle.y);
    let across = (splat.turn.x * dx + splat.turn.y * dy) / splat.size_px.x;
    let along = (splat.turn.x * dy - splat.turn.y * dx) / splat.size_px.y;
    (across.abs() < 0.5 && along.abs() < 0.5).then_some([if splat.mirrored { -across } else { across }, along])
}

/// The sprites that are seen, in the order in which they are drawn.
pub fn in_order(blend: Mixing, splats: &[Splat]) -> Vec<&Splat> {
    let mut order: Vec<&Splat> = splats.iter().filter(|splat| splat.opacity > 0.0).collect();
    if blend == Mixing::Over {
        order.sort_by_key(|splat| std::cmp::Reverse((1024.0 * splat.depth + 0.5).floor() as i64));
    }
    order
}

/// Draws sprites that are in order.
pub fn draw(synth: &Synth, splats: &[Splat], canvas: Canvas) {
    let Canvas { places, depth, out } = canvas;
    let width = places[0].len();
    if width == 0 || out.is_empty() {
        return;
    }
    let mut found = in_order(synth.blend, splats)
        .into_iter()
        .filter_map(|splat| Some((splat, covered(splat, &places)?)))
        .peekable();
    let strip = (out.len() / width).div_ceil(4 * rayon::current_num_threads()).max(ROWS);
    while found.peek().is_some() {
        let (mut chunk, mut count) = (Vec::new(), 0);
        while let Some((splat, cells)) = found.next_if(|_| count < TEXELS) {
            let side = synth.pictures.side >> splat.level;
            count += side * side;
            chunk.push((splat, cells, side));
        }
        let made = chunk.into_par_iter().map(|(splat, [columns, rows], side)| {
            let mut own = Vec::new();
            texels(&synth.pictures, &synth.residues.0, &splat.mix, splat.level, &mut own);
            Drawn { splat, columns, rows, texels: own, side }
        });
        let made: Vec<Drawn> = made.collect();
        let strips = out.par_chunks_mut(strip * width).zip(depth.par_chunks(strip * width)).enumerate();
        strips.for_each(|(i, (out, depth))| {
            let mut strip = Strip { synth, places: &places, first: i * strip, depth, out, row: Vec::new() };
            made.iter().for_each(|drawn| strip.lay(drawn));
        });
    }
}

/// Some rows of a canvas.
struct Strip<'a> {
    synth: &'a Synth,
    places: &'a [Vec<f64>; 2],
    /// The number of its first row.
    first: usize,
    depth: &'a [f64],
    out: &'a mut [Rgba],
    /// A row between two rows of texels.
    row: Vec<Rgba>,
}

impl Strip<'_> {
    fn lay(&mut self, drawn: &Drawn) {
        let width = self.places[0].len();
        let rows = drawn.rows.start.max(self.first)..drawn.rows.end.min(self.first + self.out.len() / width);
        if rows.is_empty() {
            return;
        }
        let straight = drawn.splat.turn.y == 0.0 && drawn.splat.turn.x > 0.0;
        let columns = if straight { straight_columns(drawn, &self.places[0]) } else { Vec::new() };
        for y in rows {
            let line = (y - self.first) * width..(y - self.first + 1) * width;
            let place = self.places[1][y];
            if straight {
                self.straight(drawn, &columns, place, line);
            } else {
                self.turned(drawn, place, line);
            }
        }
    }

    /// A row of a sprite that is not turned: rows and columns of texels are weighed apart from one another.
    fn straight(&mut self, drawn: &Drawn, columns: &[(usize, [usize; 2], f32)], y: f64, line: Range<usize>) {
        let along = (y - drawn.splat.middle.y) / drawn.splat.size_px.y;
        if along.abs() >= 0.5 {
            return;
        }
        let ([above, below], share) = neighbors((along + 0.5) * drawn.side as f64, drawn.side);
        let row = |j: usize| drawn.texels[4 * j * drawn.side..][..4 * drawn.side].as_chunks::<4>().0;
        self.row.clear();
        self.row.extend(row(above).iter().zip(row(below)).map(|(a, b)| mean(*a, *b, share)));
        for &(x, [left, right], share) in columns {
            let color = mean(self.row[left], self.row[right], share);
            self.put(drawn.splat, line.start + x, color);
        }
    }

    fn turned(&mut self, drawn: &Drawn, y: f64, line: Range<usize>) {
        for x in span(drawn, &self.places[0], y) {
            if let Some(place) = inside(drawn.splat, self.places[0][x], y) {
                self.put(drawn.splat, line.start + x, read(&drawn.texels, drawn.side, place));
            }
        }
    }

    /// Blends a color, as read from texels, with a cell.
    #[inline(always)]
    fn put(&mut self, splat: &Splat, cell: usize, color: Rgba) {
        let behind = self.depth[cell];
        let mut opacity = splat.opacity as f32;
        if behind < f64::INFINITY {
            opacity *= before(behind, splat.depth, self.synth.values.soft) as f32;
        }
        let own = shaded(color, splat.tint).map(|v| v * opacity);
        let there = &mut self.out[cell];
        let rest = match self.synth.blend {
            Mixing::Screen => own.map(|v| 1.0 - v),
            Mixing::Over => [1.0 - own[3]; 4],
        };
        *there = std::array::from_fn(|c| own[c] + there[c] * rest[c]);
    }
}

/// How much of a sprite is before the surface behind it.
pub fn before(surface: f64, depth: f64, soft: f64) -> f64 {
    if soft > 0.0 { ((surface - depth) / soft).clamp(0.0, 1.0) } else { f64::from(u8::from(depth < surface)) }
}

/// A color as read from texels, kept within bounds and tinted.
#[inline(always)]
pub fn shaded(color: Rgba, [r, g, b]: [f32; 3]) -> Rgba {
    let a = within(color[3], 1.0);
    let tinted: Rgba = std::array::from_fn(|c| within(color[c], a) * [r, g, b, 1.0][c]);
    tinted.map(|v| within(v, a))
}

/// A number kept between 0 and `most`; unlike `clamp` it is two instructions for four numbers at once.
#[inline(always)]
fn within(v: f32, most: f32) -> f32 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < most { v } else { most }
}

/// The bilinear read of texels, four numbers each, at a place from -1/2 to 1/2.
#[inline(always)]
pub fn read(texels: &[f32], side: usize, [across, along]: [f64; 2]) -> Rgba {
    let texels = texels.as_chunks::<4>().0;
    let ([left, right], u) = neighbors((across + 0.5) * side as f64, side);
    let ([above, below], v) = neighbors((along + 0.5) * side as f64, side);
    let before = mean(texels[above * side + left], texels[below * side + left], v);
    let after = mean(texels[above * side + right], texels[below * side + right], v);
    mean(before, after, u)
}

/// The texels before and after a place, and its share of the way; edges repeat.
#[inline(always)]
fn neighbors(place: f64, side: usize) -> ([usize; 2], f32) {
    let at = place - 0.5;
    let first = at.floor();
    let clamp = |i: f64| i.clamp(0.0, (side - 1) as f64) as usize;
    ([clamp(first), clamp(first + 1.0)], (at - first) as f32)
}

#[inline(always)]
fn mean(a: Rgba, b: Rgba, share: f32) -> Rgba {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
}

/// The columns that a sprite which is not turned covers, each with its texels.
fn straight_columns(drawn: &Drawn, places: &[f64]) -> Vec<(usize, [usize; 2], f32)> {
    let column = |x: usize| {
        let across = (places[x] - drawn.splat.middle.x) / drawn.splat.size_px.x;
        let across = if drawn.splat.mirrored { -across } else { across };
        let (texels, share) = neighbors((across + 0.5) * drawn.side as f64, drawn.side);
        (across.abs() < 0.5).then_some((x, texels, share))
    };
    drawn.columns.clone().filter_map(column).collect()
}

/// The columns that a turned sprite may cover in the row at `y`.
fn span(drawn: &Drawn, places: &[f64], y: f64) -> Range<usize> {
    let Splat { middle, size_px, turn, .. } = drawn.splat;
    let dy = y - middle.y;
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    // Both sides of the sprite along each of its axes: |a dx + b| < half.
    for (a, b, half) in [(turn.x, turn.y * dy, size_px.x / 2.0), (-turn.y, turn.x * dy, size_px.y / 2.0)] {
        if a.abs() > 1e-9 {
            let (one, other) = ((-half - b) / a, (half - b) / a);
            low = low.max(one.min(other));
            high = high.min(one.max(other));
        }
    }
    let places = &places[drawn.columns.clone()];
    let from = places.partition_point(|x| x - middle.x < low - 1e-3);
    let to = places.partition_point(|x| x - middle.x <= high + 1e-3);
    drawn.columns.start + from..drawn.columns.start + to.max(from)
}
