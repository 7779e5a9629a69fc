//! Some rows of a frame: sprites are made there, as many rows of their texels as are needed, and drawn one after the other.

use std::ops::Range;

use super::between::texels;
use super::cells::{Drawn, inside};
use super::color::{before, mean, neighbors, over, screen, shaded};
use super::model::Mixing;
use super::splat::Splat;
use super::synth::Synth;
use crate::base::pixels::Rgba;

/// Columns over which the nearest surface is known.
const BLOCK: usize = 64;

/// Memory that is used again and again.
#[derive(Default)]
pub struct Scratch {
    /// Rows of texels of a sprite.
    texels: Vec<Rgba>,
    /// A row between two rows of texels.
    row: Vec<Rgba>,
    /// What each column of a sprite that is not turned reads.
    reads: Vec<Read>,
    /// How far columns are from the middle of a turned sprite.
    aside: Vec<f32>,
    /// The colors of a sprite in a row of the frame.
    colors: Vec<Rgba>,
    /// The nearest surface of each block of columns, in meters.
    nearest: Vec<f64>,
}

/// The texels left and right of a place, and its share of the way.
struct Read {
    texels: [usize; 2],
    share: f32,
}

/// Some rows of a frame.
pub struct Strip<'a> {
    synth: &'a Synth,
    places: &'a [Vec<f64>; 2],
    /// The number of its first row.
    first: usize,
    depth: &'a [f64],
    out: &'a mut [Rgba],
    scratch: &'a mut Scratch,
}

impl<'a> Strip<'a> {
    /// Rows from number `first` on: how far away surfaces are there, and what is shown.
    pub fn new(
        synth: &'a Synth,
        places: &'a [Vec<f64>; 2],
        first: usize,
        (depth, out): (&'a [f64], &'a mut [Rgba]),
        scratch: &'a mut Scratch,
    ) -> Self {
        let width = places[0].len();
        scratch.nearest.clear();
        scratch.nearest.resize(width.div_ceil(BLOCK), f64::INFINITY);
        for row in depth.chunks_exact(width) {
            for (nearest, depths) in scratch.nearest.iter_mut().zip(row.chunks(BLOCK)) {
                *nearest = depths.iter().fold(*nearest, |a, b| if *b < a { *b } else { a });
            }
        }
        Strip { synth, places, first, depth, out, scratch }
    }

    /// Draws a sprite.
    pub fn lay(&mut self, drawn: &Drawn) {
        let width = self.places[0].len();
        let rows = drawn.rows.start.max(self.first)..drawn.rows.end.min(self.first + self.out.len() / width);
        if rows.is_empty() {
            return;
        }
        let (splat, side) = (drawn.splat, self.synth.pictures.side >> drawn.splat.level);
        let made = needed(drawn, self.places, &rows, side);
        let from = (&*self.synth.pictures, &*self.synth.residues);
        texels(from, &splat.mix, splat.level, made.clone(), &mut self.scratch.texels);
        let straight = splat.turn.y == 0.0 && splat.turn.x > 0.0;
        let columns = if straight { self.find_reads(drawn, side) } else { self.find_places(drawn) };
        let clear = self.is_clear(splat, &columns);
        for y in rows {
            let at = self.places[1][y];
            let covered = if straight {
                if self.straight(splat, at, (side, made.start)) { columns.clone() } else { 0..0 }
            } else {
                self.turned(drawn, at, (side, made.start))
            };
            let from = (y - self.first) * width;
            self.blend(splat, clear, from + covered.start..from + covered.end);
        }
    }

    /// Whether all surfaces in these columns are too far behind a sprite to matter.
    fn is_clear(&self, splat: &Splat, columns: &Range<usize>) -> bool {
        let blocks = columns.start / BLOCK..columns.end.div_ceil(BLOCK);
        let clear = |nearest: &f64| before(*nearest, splat.depth, self.synth.values.soft) >= 1.0;
        self.scratch.nearest[blocks].iter().all(clear)
    }

    /// Finds the columns that a sprite which is not turned covers, and what each reads.
    fn find_reads(&mut self, drawn: &Drawn, side: usize) -> Range<usize> {
        let Drawn { splat, columns, .. } = drawn;
        self.scratch.reads.clear();
        let mut from = columns.start;
        for x in columns.clone() {
            let across = (self.places[0][x] - splat.middle.x) / splat.size_px.x;
            let across = if splat.mirrored { -across } else { across };
            if across.abs() < 0.5 {
                let (texels, share) = neighbors((across + 0.5) * side as f64, side);
                self.scratch.reads.push(Read { texels, share });
            } else if self.scratch.reads.is_empty() {
                from = x + 1;
            }
        }
        from..from + self.scratch.reads.len()
    }

    /// Finds how far the columns of a turned sprite are from its middle.
    fn find_places(&mut self, drawn: &Drawn) -> Range<usize> {
        self.scratch.aside.clear();
        let aside = self.places[0][drawn.columns.clone()].iter().map(|x| (x - drawn.splat.middle.x) as f32);
        self.scratch.aside.extend(aside);
        drawn.columns.clone()
    }

    /// The colors of a sprite that is not turned, in the row at `y`, if it is there: rows and columns of texels are weighed
    /// apart from one another.
    fn straight(&mut self, splat: &Splat, y: f64, (side, made_from): (usize, usize)) -> bool {
        let along = (y - splat.middle.y) / splat.size_px.y;
        if along.abs() >= 0.5 {
            return false;
        }
        let ([above, below], share) = neighbors((along + 0.5) * side as f64, side);
        let Scratch { texels, row, reads, colors, .. } = &mut *self.scratch;
        let of = |y: usize| &texels[(y - made_from) * side..][..side];
        row.clear();
        row.extend(of(above).iter().zip(of(below)).map(|(a, b)| mean(*a, *b, share)));
        colors.clear();
        colors.extend(reads.iter().map(|read| {
            let [left, right] = read.texels;
            shaded(mean(row[left], row[right], read.share), splat.tint)
        }));
        true
    }

    /// The colors of a turned sprite in the row at `y`, and the columns that it covers.
    fn turned(&mut self, drawn: &Drawn, y: f64, (side, made_from): (usize, usize)) -> Range<usize> {
        let splat = drawn.splat;
        let columns = span(drawn, &self.places[0], y);
        let map = Map::new(splat, y - splat.middle.y, side);
        let Scratch { texels, aside, colors, .. } = &mut *self.scratch;
        let aside = &aside[columns.start - drawn.columns.start..columns.end - drawn.columns.start];
        colors.clear();
        colors.extend(aside.iter().map(|dx| {
            let [(x, u), (y, v)] = map.at(*dx);
            let pair = |y: usize| {
                let first = (y - made_from) * side + x;
                let pair = &texels[first..first + 2];
                mean(pair[0], pair[1], u)
            };
            shaded(mean(pair(y), pair(y + 1), v), splat.tint)
        }));
        columns
    }

    /// Blends colors with cells.
    fn blend(&mut self, splat: &Splat, clear: bool, cells: Range<usize>) {
        let (opacity, soft) = (splat.opacity as f32, self.synth.values.soft);
        let (out, colors) = (&mut self.out[cells.clone()], &self.scratch.colors);
        let pairs = out.iter_mut().zip(colors);
        match (self.synth.blend, clear) {
            (Mixing::Screen, true) => pairs.for_each(|(out, color)| screen(out, color, opacity)),
            (Mixing::Over, true) => pairs.for_each(|(out, color)| over(out, color, opacity)),
            (blend, false) => pairs.zip(&self.depth[cells]).for_each(|((out, color), behind)| {
                let opacity = opacity * before(*behind, splat.depth, soft) as f32;
                match blend {
                    Mixing::Screen => screen(out, color, opacity),
                    Mixing::Over => over(out, color, opacity),
                }
            }),
        }
    }
}

/// The rows of texels that a sprite reads in these rows of the frame.
fn needed(drawn: &Drawn, places: &[Vec<f64>; 2], rows: &Range<usize>, side: usize) -> Range<usize> {
    let Splat { middle, size_px, turn, .. } = drawn.splat;
    let ends = |axis: usize, cells: &Range<usize>| [cells.start, cells.end - 1].map(|cell| places[axis][cell]);
    let (across, down) = (ends(0, &drawn.columns), ends(1, rows));
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (x, y) in [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| (across[i] - middle.x, down[j] - middle.y)) {
        let texel = ((turn.x * y - turn.y * x) / size_px.y + 0.5) * side as f64 - 0.5;
        (low, high) = (low.min(texel), high.max(texel));
    }
    // A little more, since turned sprites read with single precision; two rows at least.
    let row = |at: f64, least: usize| at.floor().clamp(least as f64, (side - 2 + least) as f64) as usize;
    row(low - 0.01, 0)..row(high + 1.01, 1) + 1
}

/// The columns that a turned sprite covers in the row at `y`.
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
    let own = &places[drawn.columns.clone()];
    let from = own.partition_point(|x| x - middle.x < low - 1e-3);
    let to = own.partition_point(|x| x - middle.x <= high + 1e-3).max(from);
    // The ends are a little too far out.
    let misses = |i: &usize| inside(drawn.splat, own[*i], y).is_none();
    let from = from + (from..to).take_while(misses).count();
    let to = to - (from..to).rev().take_while(misses).count();
    drawn.columns.start + from..drawn.columns.start + to
}

/// Which texels a row of the frame reads of a turned sprite: single precision, so that they are found fast.
struct Map {
    /// Across and along the sprite: at its middle, and for each pixel beside it, in texels.
    axes: [[f32; 2]; 2],
    /// The last texel.
    last: f32,
}

impl Map {
    /// The row that is `dy` below the middle.
    fn new(splat: &Splat, dy: f64, side: usize) -> Map {
        let Splat { size_px, turn, .. } = splat;
        let axis = |at: f64, each: f64, size: f64| {
            let scale = side as f64 / size;
            [(at * scale + (side - 1) as f64 / 2.0) as f32, (each * scale) as f32]
        };
        let sense = if splat.mirrored { -1.0 } else { 1.0 };
        let across = axis(sense * turn.y * dy, sense * turn.x, size_px.x);
        Map { axes: [across, axis(turn.x * dy, -turn.y, size_px.y)], last: (side - 1) as f32 }
    }

    /// The texel before a place across and along, and the share of the way to the next; edges repeat.
    #[inline(always)]
    fn at(&self, dx: f32) -> [(usize, f32); 2] {
        self.axes.map(|[middle, each]| {
            let at = (middle + dx * each).clamp(0.0, self.last);
            let before = (at as usize).min(self.last as usize - 1);
            (before, at - before as f32)
        })
    }
}
