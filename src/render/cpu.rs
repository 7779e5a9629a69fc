//! Frames on the CPU: the reference that the GPU agrees with. Rows are made on all cores; a pixel's value does not depend
//! on which.

use std::ops::Range;

use rayon::prelude::*;

use super::{LayerSynth, Synth};
use crate::base::pixels::{Frame, Grid, Linear, Rgba, encode, over};
use crate::layers::folding;

/// The frame at `scene_time` in linear, premultiplied RGBA.
pub fn linear(synth: &Synth, scene_time: f64) -> Linear {
    rows(synth, scene_time, 0..synth.size.1)
}

/// These rows of it alone.
fn rows(synth: &Synth, scene_time: f64, rows: Range<usize>) -> Linear {
    let width = synth.size.0;
    let mut picture = Linear::filled(width, rows.len(), [0.0; 4]);
    picture.cells_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(i, row)| {
        for layer in &synth.layers {
            lay(layer, scene_time, rows.start + i, row);
        }
    });
    picture
}

/// Pixels whose light stands beside their codes at a time: a frame in 32-bit light is four times its codes.
const BAND: usize = 1 << 22;

/// The finished frame of several samples of each pixel: sRGB, straight alpha, 8 bits a channel.
pub fn frames(samples: &[Synth], scene_time: f64) -> Frame {
    let (width, height) = samples.first().map_or((0, 0), |synth| synth.size);
    let mut cells = vec![[0; 4]; width * height];
    let most = (BAND / width.max(1)).max(1);
    for (i, out) in cells.chunks_mut(most * width.max(1)).enumerate() {
        finish_rows(samples, scene_time, i * most..((i + 1) * most).min(height), out);
    }
    Grid::from_cells(width, height, cells)
}

/// Finishes these rows into `out`.
pub fn finish_rows(samples: &[Synth], scene_time: f64, band: Range<usize>, out: &mut [[u8; 4]]) {
    let linear = mean_of(samples.iter().map(|synth| rows(synth, scene_time, band.clone())));
    out.par_iter_mut().zip(linear.cells().par_iter()).for_each(|(code, &light)| *code = encode(light));
}

/// The pixels of the frame at `scene_time` in these columns and rows (ascending, within the frame), and no others: what a
/// small view of a large picture costs.
pub fn lattice(synth: &Synth, scene_time: f64, columns: &[usize], rows: &[usize]) -> Linear {
    let mut picture = Linear::filled(columns.len(), rows.len(), [0.0; 4]);
    let lines = picture.cells_mut().par_chunks_mut(columns.len().max(1)).zip(rows.par_iter());
    lines.for_each(|(out, &y)| {
        for LayerSynth::Picture(layer) in &synth.layers {
            if y < layer.picture.height() {
                let within = &columns[..columns.partition_point(|&x| x < layer.picture.width())];
                let mut own = vec![[0.0; 4]; within.len()];
                folding::frame::columns(layer, scene_time, y, within, &mut own);
                out.iter_mut().zip(own).for_each(|(beneath, colour)| *beneath = over(colour, *beneath));
            }
        }
    });
    picture
}

/// The mean of the frames of several samples of each pixel, in linear light.
pub fn mean(samples: &[Synth], scene_time: f64) -> Linear {
    mean_of(samples.iter().map(|synth| linear(synth, scene_time)))
}

/// The mean of linear frames of one size.
pub fn mean_of(mut frames: impl ExactSizeIterator<Item = Linear>) -> Linear {
    let share = 1.0 / frames.len() as f32;
    let Some(mut sum) = frames.next() else { return Linear::filled(0, 0, [0.0; 4]) };
    for frame in frames {
        let add = |sum: &mut Rgba, more: &Rgba| *sum = std::array::from_fn(|i| sum[i] + more[i]);
        sum.cells_mut().par_iter_mut().zip(frame.cells().par_iter()).for_each(|(sum, more)| add(sum, more));
    }
    if share < 1.0 {
        sum.cells_mut().par_iter_mut().for_each(|colour| *colour = colour.map(|c| c * share));
    }
    sum
}

/// The finished frame at `scene_time`: sRGB, straight alpha, 8 bits a channel.
pub fn frame(synth: &Synth, scene_time: f64) -> Frame {
    frames(std::slice::from_ref(synth), scene_time)
}

/// Encodes a linear frame.
pub fn finish(picture: &Linear) -> Frame {
    let cells = picture.cells().par_iter().map(|&colour| encode(colour)).collect();
    Grid::from_cells(picture.width(), picture.height(), cells)
}

/// Gives clear pixels of a finished frame the colors that their pictures have there: straight alpha keeps them.
pub fn keep_clear_colors(synth: &Synth, frame: &mut Frame) {
    let width = frame.width().max(1);
    frame.cells_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, code) in row.iter_mut().enumerate().filter(|(_, code)| code[3] == 0) {
            for LayerSynth::Picture(layer) in &synth.layers {
                let within = x < layer.picture.width() && y < layer.picture.height();
                layer.picture.keep_clear_color(within.then_some((x, y)), code);
            }
        }
    });
}

/// Lays row `y` of a layer over what is there.
fn lay(layer: &LayerSynth, scene_time: f64, y: usize, row: &mut [Rgba]) {
    let LayerSynth::Picture(synth) = layer;
    if y >= synth.picture.height() {
        return;
    }
    let mut own = vec![[0.0; 4]; synth.picture.width()];
    folding::frame::row(synth, scene_time, y, &mut own);
    row.iter_mut().zip(own).for_each(|(beneath, colour)| *beneath = over(colour, *beneath));
}
