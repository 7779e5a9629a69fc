//! Frames on the CPU: the reference that the GPU agrees with. Rows are made on all cores; a pixel's value does not depend
//! on which.

use std::ops::Range;

use rayon::prelude::*;

use super::Synth;
use crate::base::pixels::{Frame, Grid, Linear, Rgba, encode, over};
use crate::layers::parts::moment::Columns;
use crate::layers::ready::Still;

/// The frame at `scene_time` in linear, premultiplied RGBA.
pub fn linear(synth: &Synth, scene_time: f64) -> Linear {
    rows(synth, scene_time, 0..synth.size.1)
}

/// These rows of it alone.
fn rows(synth: &Synth, scene_time: f64, rows: Range<usize>) -> Linear {
    lines(synth, scene_time, Columns::All, &rows.collect::<Vec<_>>())
}

/// These rows, and of them these columns.
fn lines(synth: &Synth, scene_time: f64, columns: Columns, rows: &[usize]) -> Linear {
    let width = match columns {
        Columns::All => synth.size.0,
        Columns::Some(columns) => columns.len(),
    };
    let moment = synth.moment(scene_time);
    let layers: Vec<Box<dyn Still + '_>> = synth.layers.iter().map(|layer| layer.at(&moment)).collect();
    let mut picture = Linear::filled(width, rows.len(), [0.0; 4]);
    let lines = picture.cells_mut().par_chunks_mut(width.max(1)).zip(rows.par_iter());
    lines.for_each(|(out, &y)| {
        let mut own = vec![[0.0; 4]; width];
        for layer in &layers {
            own.fill([0.0; 4]);
            layer.row(y, columns, &mut own);
            out.iter_mut().zip(&own).for_each(|(beneath, &color)| *beneath = over(color, *beneath));
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
    lines(synth, scene_time, Columns::Some(columns), rows)
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

/// Gives clear pixels of a finished frame the colors that their layers have there: straight alpha keeps them.
pub fn keep_clear_colors(synth: &Synth, frame: &mut Frame) {
    let width = frame.width().max(1);
    frame.cells_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, code) in row.iter_mut().enumerate().filter(|(_, code)| code[3] == 0) {
            synth.layers.iter().for_each(|layer| layer.keep_clear_color((x, y), code));
        }
    });
}
