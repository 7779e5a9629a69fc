//! Some rows of a frame: sprites are made there, as many rows of their texels as are needed, and drawn one after the other.

use std::ops::Range;

use glam::Vec4;

use super::between::{Mixed, Sums, at_least};
use super::blend::{Blend, PAIR, Sheet, pair};
use super::cells::Covering;
use super::color::{before, neighbors};
use super::splat::Splat;
use super::sprites::LARGEST;
use super::synth::Synth;
use super::turned::{Corners, Map, Spans};
use crate::base::pixels::Rgba;
use crate::base::simd::{LANES, Lanes};

/// Columns over which the nearest surface is known.
const BLOCK: usize = 64;

/// Rows of texels that are made at a time, so that the caches closest to the processor hold all that this takes.
const BAND: usize = 8;

/// Texels that a row is read from: as many as a side has at most, and the one after the last.
const REACH: usize = LARGEST as usize + 1;

/// Texels that a picture is read from, likewise.
const WINDOW: usize = (LARGEST * LARGEST) as usize + 1;

/// Memory that is used again and again.
#[derive(Default)]
pub struct Scratch {
    /// What is shown.
    canvas: Sheet,
    /// The nearest surface of each block of columns, in meters.
    nearest: Vec<f64>,
    /// What these are made of.
    sums: Sums,
    /// Rows of texels of a sprite, and after them whatever was there.
    texels: Vec<Rgba>,
    /// What each pair of columns of a sprite that is not turned reads.
    reads: Vec<Read>,
    /// How far columns are from the middle of a turned sprite.
    aside: Vec<f32>,
    /// What each column of a turned sprite reads in a row.
    corners: Vec<Corners>,
    /// What columns read in each row of texels of a sprite that is not turned.
    colors: Vec<Lanes>,
}

/// Where in a row of texels those left of two places are, and the weights of these and of the next ones.
#[derive(Clone, Copy, Default)]
struct Read {
    left: [u8; PAIR],
    weights: [Lanes; 2],
}

/// Some rows of a frame.
pub struct Strip<'a> {
    synth: &'a Synth,
    places: &'a [Vec<f64>; 2],
    /// The number of its first row.
    first: usize,
    depth: &'a [f64],
    scratch: &'a mut Scratch,
}

impl<'a> Strip<'a> {
    /// Rows from number `first` on: how far away surfaces are there, and what is shown.
    #[inline(always)]
    pub fn new(
        synth: &'a Synth,
        places: &'a [Vec<f64>; 2],
        first: usize,
        (depth, shown): (&'a [f64], &[Rgba]),
        scratch: &'a mut Scratch,
    ) -> Self {
        let width = places[0].len();
        scratch.nearest.clear();
        scratch.nearest.resize(width.div_ceil(BLOCK), f64::INFINITY);
        for row in depth.chunks_exact(width) {
            for (nearest, depths) in scratch.nearest.iter_mut().zip(row.chunks(BLOCK)) {
                for depth in depths {
                    if depth < nearest {
                        *nearest = *depth;
                    }
                }
            }
        }
        scratch.canvas.take(width, shown);
        Strip { synth, places, first, depth, scratch }
    }

    /// Writes what is shown.
    #[inline(always)]
    pub fn finish(self, out: &mut [Rgba]) {
        self.scratch.canvas.give(self.places[0].len(), out);
    }

    /// Draws a sprite.
    #[inline(always)]
    pub fn lay(&mut self, drawn: &Covering) {
        let rows =
            drawn.rows.start.max(self.first)..drawn.rows.end.min(self.first + self.depth.len() / self.places[0].len());
        if rows.is_empty() {
            return;
        }
        let splat = drawn.splat;
        let mixed = Mixed::new((&self.synth.pictures, &self.synth.residues), &splat.mix, splat.level);
        let made = needed(drawn, self.places, &rows, mixed.side);
        if splat.turn.y == 0.0 && splat.turn.x > 0.0 {
            self.straight(splat, &mixed, drawn.columns.clone(), rows, made);
        } else {
            self.turned(drawn, &mixed, rows, made);
        }
    }

    /// How a sprite is blended in these columns.
    #[inline(always)]
    fn blend(&self, splat: &Splat, columns: &Range<usize>) -> Blend {
        let blocks = columns.start / BLOCK..columns.end.div_ceil(BLOCK);
        let mut clear = true;
        for nearest in &self.scratch.nearest[blocks] {
            clear &= before(*nearest, splat.depth, self.synth.values.soft) >= 1.0;
        }
        Blend::new(self.synth, splat, clear)
    }

    /// Draws a sprite that is not turned: its texels are weighed across, a row of them at a time, and then down.
    #[inline(always)]
    fn straight(
        &mut self,
        splat: &Splat,
        mixed: &Mixed,
        columns: Range<usize>,
        rows: Range<usize>,
        made: Range<usize>,
    ) {
        let columns = self.find_reads(splat, columns, mixed.side);
        if columns.is_empty() {
            return;
        }
        let blend = self.blend(splat, &columns);
        let Scratch { canvas, sums, texels, reads, colors, .. } = &mut *self.scratch;
        let pairs = reads.len();
        let colors = at_least(colors, pairs * made.len());
        let texels = at_least(texels, BAND * mixed.side + REACH);
        for (band, colors) in colors.chunks_mut(pairs * BAND).enumerate() {
            let first = made.start + band * BAND;
            let band = first..made.end.min(first + BAND);
            mixed.rows(band.clone(), sums, &mut texels[..band.len() * mixed.side]);
            for (i, colors) in colors.chunks_exact_mut(pairs).enumerate() {
                // As many as can be asked for: no read needs to be checked.
                let Some(texels) = texels[i * mixed.side..].first_chunk::<REACH>() else { continue };
                for (Read { left, weights }, out) in reads.iter().zip(colors) {
                    let [first, second] = left.map(usize::from);
                    let [before, after] = [0, 1].map(
                        #[inline(always)]
                        |i| pair(texels[first + i].into(), texels[second + i].into()),
                    );
                    *out = after.times(weights[1], before * weights[0]);
                }
            }
        }
        let width = self.places[0].len();
        for y in rows {
            let along = (self.places[1][y] - splat.middle.y) / splat.size_px.y;
            if along.abs() >= 0.5 {
                continue;
            }
            let ([above, below], share) = neighbors((along + 0.5) * mixed.side as f64, mixed.side);
            let [above, below] = [above, below].map(|row| &colors[(row - made.start) * pairs..][..pairs]);
            let share = Lanes::all(share);
            let depth = &self.depth[(y - self.first) * width..][columns.clone()];
            let out = canvas.row(y - self.first, columns.start, pairs);
            blend.lay(
                #[inline(always)]
                |i| (below[i] - above[i]).times(share, above[i]),
                depth,
                out,
            );
        }
    }

    /// Finds the columns that a sprite which is not turned covers, and what each reads.
    #[inline(always)]
    fn find_reads(&mut self, splat: &Splat, columns: Range<usize>, side: usize) -> Range<usize> {
        let reads = &mut self.scratch.reads;
        reads.clear();
        let (mut from, mut count) = (columns.start, 0);
        for x in columns {
            let across = (self.places[0][x] - splat.middle.x) / splat.size_px.x;
            let across = if splat.mirrored { -across } else { across };
            if across.abs() < 0.5 {
                let at = ((across + 0.5) * side as f64 - 0.5).clamp(0.0, (side - 1) as f64);
                let share = (at - at.floor()) as f32;
                if count % PAIR == 0 {
                    reads.push(Read::default());
                }
                if let Some(read) = reads.last_mut() {
                    read.left[count % PAIR] = at as u8;
                    for (weights, weight) in read.weights.iter_mut().zip([1.0 - share, share]) {
                        weights.0[count % PAIR * 4..][..4].fill(weight);
                    }
                }
                count += 1;
            } else if count == 0 {
                from = x + 1;
            }
        }
        from..from + count
    }

    /// Draws a turned sprite.
    #[inline(always)]
    fn turned(&mut self, drawn: &Covering, mixed: &Mixed, rows: Range<usize>, made: Range<usize>) {
        let (splat, side) = (drawn.splat, mixed.side);
        let blend = self.blend(splat, &drawn.columns);
        let Scratch { canvas, sums, texels, aside, corners, .. } = &mut *self.scratch;
        let texels = at_least(texels, side + WINDOW);
        mixed.rows(made.clone(), sums, &mut texels[..made.len() * side]);
        // As many as can be asked for: no read needs to be checked.
        let (Some(above), Some(below)) = (texels.first_chunk::<WINDOW>(), texels[side..].first_chunk::<WINDOW>())
        else {
            return;
        };
        // How far columns are from the middle; more of them, since rows end with whole blocks.
        let count = drawn.columns.len();
        let aside = at_least(aside, count + LANES);
        for (aside, x) in aside.iter_mut().zip(&self.places[0][drawn.columns.clone()]) {
            *aside = (x - splat.middle.x) as f32;
        }
        let (spans, width) = (Spans::new(drawn, &self.places[0]), self.places[0].len());
        for y in rows {
            let columns = spans.at(self.places[1][y]);
            let map = Map::new(splat, self.places[1][y], side, made.start);
            let (blocks, pairs) = (columns.len().div_ceil(LANES), columns.len().div_ceil(PAIR));
            let aside = aside[columns.start - drawn.columns.start..][..blocks * LANES].as_chunks::<LANES>().0;
            let corners = at_least(corners, blocks);
            for (corners, aside) in corners.iter_mut().zip(aside) {
                *corners = map.at(Lanes(*aside));
            }
            let depth = &self.depth[(y - self.first) * width..][columns.clone()];
            let out = canvas.row(y - self.first, columns.start, pairs);
            blend.lay(
                #[inline(always)]
                |i| {
                    let Corners { first, weights: [w, x, y, z] } = &corners[i / (LANES / PAIR)];
                    let k = PAIR * (i % (LANES / PAIR));
                    let colors = [k, k + 1].map(
                        #[inline(always)]
                        |k| {
                            let (left, right) = (usize::from(first[k]), usize::from(first[k]) + 1);
                            let (w, x, y, z) = (w[k], x[k], y[k], z[k]);
                            let above = Vec4::from(above[left]) * w + Vec4::from(above[right]) * x;
                            above + Vec4::from(below[left]) * y + Vec4::from(below[right]) * z
                        },
                    );
                    pair(colors[0], colors[1])
                },
                depth,
                out,
            );
        }
    }
}

/// The rows of texels that a sprite reads in these rows of the frame.
#[inline(always)]
fn needed(drawn: &Covering, places: &[Vec<f64>; 2], rows: &Range<usize>, side: usize) -> Range<usize> {
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
