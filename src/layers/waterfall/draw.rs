//! Draws sprites into a frame. Every pixel meets them in the same order, whatever the number of threads: the frame is cut
//! into strips, and each strip draws all its sprites one after the other.

use rayon::prelude::*;

use super::cells::{Drawn, covered};
use super::model::Mixing;
use super::splat::Splat;
use super::strip::{Scratch, Strip};
use super::synth::Synth;
use crate::base::pixels::Rgba;

/// Rows of a strip: few enough that what is drawn on stays close to the processor, and that all threads have work.
const ROWS: usize = 64;

/// Where a frame is looked at, and what is there already.
pub struct Canvas<'a> {
    /// The places of columns, and of rows, in pixels of the frame: ascending.
    pub places: [Vec<f64>; 2],
    /// How far away the surface is at each place, row by row, in meters; infinite where there is none.
    pub depth: &'a [f64],
    /// What is there, linear light, premultiplied.
    pub out: &'a mut [Rgba],
}

/// The sprites that are seen, in the order in which they are drawn.
pub fn in_order(blend: Mixing, splats: &[Splat]) -> Vec<&Splat> {
    let mut order: Vec<&Splat> = splats.iter().filter(|splat| splat.opacity > 0.0).collect();
    if blend == Mixing::Over {
        order.sort_by_key(|splat| std::cmp::Reverse((1024.0 * splat.depth + 0.5).floor() as i64));
    }
    order
}

/// The sprites that cover cells, in the order in which they are drawn.
pub fn drawn<'a>(blend: Mixing, splats: &'a [Splat], places: &[Vec<f64>; 2]) -> Vec<Drawn<'a>> {
    let cells = |splat: &'a Splat| {
        let [columns, rows] = covered(splat, places)?;
        Some(Drawn { splat, columns, rows })
    };
    in_order(blend, splats).into_par_iter().filter_map(cells).collect()
}

/// For each strip of so many rows, the numbers of the sprites that it draws.
pub fn bins(drawn: &[Drawn], rows: usize) -> Vec<Vec<u32>> {
    let mut bins = vec![Vec::new(); rows.div_ceil(ROWS)];
    for (i, drawn) in drawn.iter().enumerate() {
        let strips = drawn.rows.start / ROWS..drawn.rows.end.div_ceil(ROWS);
        bins[strips].iter_mut().for_each(|bin| bin.push(i as u32));
    }
    bins
}

/// Draws sprites.
pub fn draw(synth: &Synth, splats: &[Splat], canvas: Canvas) {
    let Canvas { places, depth, out } = canvas;
    let width = places[0].len();
    if width == 0 || out.is_empty() {
        return;
    }
    let drawn = drawn(synth.blend, splats, &places);
    let bins = bins(&drawn, places[1].len());
    let cells = ROWS * width;
    let strips = out.par_chunks_mut(cells).zip(depth.par_chunks(cells)).zip(bins).enumerate().with_max_len(1);
    strips.for_each_init(Scratch::default, |scratch, (i, ((out, depth), bin))| {
        let mut strip = Strip::new(synth, &places, i * ROWS, (depth, out), scratch);
        bin.iter().for_each(|&i| strip.lay(&drawn[i as usize]));
    });
}
