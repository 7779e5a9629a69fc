//! Some rows of a frame: sprites are made there, as many rows of their texels as are needed, and drawn one after the other.

use std::ops::Range;

use glam::Vec4;

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
    texels: Vec<Vec4>,
    /// A row between two rows of texels; its ends are there twice.
    row: Vec<Vec4>,
    /// What each column of a sprite that is not turned reads.
    reads: Vec<Read>,
    /// How far columns are from the middle of a turned sprite.
    aside: Vec<f32>,
    /// What each column of a turned sprite reads in a row.
    corners: Vec<Corner>,
    /// The nearest surface of each block of columns, in meters.
    nearest: Vec<f64>,
}

/// Where in the row the texel left of a place is, and the share of the way to the next.
#[derive(Clone, Copy)]
struct Read {
    left: u32,
    share: f32,
}

/// Where among the texels the one left of a place and above is, and the shares of the ways to the next ones.
#[derive(Clone, Copy)]
struct Corner {
    first: u32,
    share: [f32; 2],
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
            let row = Row { at: self.places[1][y], side, made_from: made.start, clear };
            let cells = (y - self.first) * width;
            if straight {
                self.straight(splat, &row, cells + columns.start..cells + columns.end);
            } else {
                self.turned(drawn, &row, cells);
            }
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
                let at = (across + 0.5) * side as f64 + 0.5;
                self.scratch.reads.push(Read { left: at as u32, share: (at - 1.0 - (at.floor() - 1.0)) as f32 });
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

    /// Draws a row of a sprite that is not turned, if it is there: rows and columns of texels are weighed apart from one
    /// another.
    fn straight(&mut self, splat: &Splat, row: &Row, cells: Range<usize>) {
        let along = (row.at - splat.middle.y) / splat.size_px.y;
        if along.abs() >= 0.5 {
            return;
        }
        let ([above, below], share) = neighbors((along + 0.5) * row.side as f64, row.side);
        let Scratch { texels, row: between, reads, .. } = &mut *self.scratch;
        let of = |y: usize| &texels[(y - row.made_from) * row.side..][..row.side];
        between.resize(row.side + 2, Vec4::ZERO);
        let pairs = of(above).iter().zip(of(below));
        between[1..].iter_mut().zip(pairs).for_each(|(out, (a, b))| *out = mean(*a, *b, share));
        (between[0], between[row.side + 1]) = (between[1], between[row.side]);
        let between = &between[..];
        let colors = reads.iter().map(|read| {
            let pair = &between[read.left as usize..][..2];
            mean(pair[0], pair[1], read.share)
        });
        let (depth, out) = (&self.depth[cells.clone()], &mut self.out[cells]);
        Blend::new(self.synth, splat, row.clear).put(colors, depth, out);
    }

    /// Draws a row of a turned sprite; `cells` is the number of the row's first cell.
    fn turned(&mut self, drawn: &Drawn, row: &Row, cells: usize) {
        let splat = drawn.splat;
        let columns = span(drawn, &self.places[0], row.at);
        let map = Map::new(splat, row);
        let Scratch { texels, aside, corners, .. } = &mut *self.scratch;
        let aside = &aside[columns.start - drawn.columns.start..columns.end - drawn.columns.start];
        corners.clear();
        corners.extend(aside.iter().map(|dx| map.at(*dx)));
        let texels = &texels[..];
        let colors = corners.iter().map(|Corner { first, share: [u, v] }| {
            let above = &texels[*first as usize..][..row.side + 2];
            let below = &above[row.side..];
            mean(mean(above[0], above[1], *u), mean(below[0], below[1], *u), *v)
        });
        let cells = cells + columns.start..cells + columns.end;
        let (depth, out) = (&self.depth[cells.clone()], &mut self.out[cells]);
        Blend::new(self.synth, splat, row.clear).put(colors, depth, out);
    }
}

/// A row of the frame that a sprite is drawn in.
struct Row {
    /// Where it is, in pixels.
    at: f64,
    /// Texels of a side.
    side: usize,
    /// The first row of texels that is there.
    made_from: usize,
    /// Whether all surfaces are too far behind to matter.
    clear: bool,
}

/// How a sprite is blended with what is there.
struct Blend {
    mixing: Mixing,
    clear: bool,
    opacity: f32,
    tint: Vec4,
    depth: f64,
    soft: f64,
}

impl Blend {
    fn new(synth: &Synth, splat: &Splat, clear: bool) -> Blend {
        Blend {
            mixing: synth.blend,
            clear,
            opacity: splat.opacity as f32,
            tint: splat.tint,
            depth: splat.depth,
            soft: synth.values.soft,
        }
    }

    /// Blends colors as read from texels with cells.
    #[inline(always)]
    fn put(&self, colors: impl Iterator<Item = Vec4>, depth: &[f64], out: &mut [Rgba]) {
        let put = |out: &mut Rgba, color: Vec4| *out = color.to_array();
        let opacity = |behind: &f64| self.opacity * before(*behind, self.depth, self.soft) as f32;
        let cells = out.iter_mut().zip(colors.map(|color| shaded(color, self.tint)));
        match (self.mixing, self.clear) {
            (Mixing::Screen, true) => {
                cells.for_each(|(out, color)| put(out, screen((*out).into(), color, self.opacity)))
            }
            (Mixing::Over, true) => cells.for_each(|(out, color)| put(out, over((*out).into(), color, self.opacity))),
            (Mixing::Screen, false) => cells.zip(depth).for_each(|((out, color), behind)| {
                put(out, screen((*out).into(), color, opacity(behind)));
            }),
            (Mixing::Over, false) => cells.zip(depth).for_each(|((out, color), behind)| {
                put(out, over((*out).into(), color, opacity(behind)));
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
    side: f32,
    made_from: f32,
}

impl Map {
    fn new(splat: &Splat, row: &Row) -> Map {
        let Splat { middle, size_px, turn, .. } = splat;
        let axis = |at: f64, each: f64, size: f64| {
            let scale = row.side as f64 / size;
            [(at * scale + (row.side - 1) as f64 / 2.0) as f32, (each * scale) as f32]
        };
        let (dy, sense) = (row.at - middle.y, if splat.mirrored { -1.0 } else { 1.0 });
        let across = axis(sense * turn.y * dy, sense * turn.x, size_px.x);
        let along = axis(turn.x * dy, -turn.y, size_px.y);
        Map { axes: [across, along], side: row.side as f32, made_from: row.made_from as f32 }
    }

    /// What a column this far beside the middle reads; edges repeat. Small whole numbers are exact in single precision.
    #[inline(always)]
    fn at(&self, dx: f32) -> Corner {
        let place = |[middle, each]: [f32; 2]| {
            let at = (middle + dx * each).max(0.0).min(self.side - 1.0);
            let before = at.min(self.side - 2.0) as i32 as f32;
            (before, at - before)
        };
        let ((x, u), (y, v)) = (place(self.axes[0]), place(self.axes[1]));
        Corner { first: ((y - self.made_from) * self.side + x) as i32 as u32, share: [u, v] }
    }
}
