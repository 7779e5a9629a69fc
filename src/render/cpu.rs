//! Frames on the CPU: the reference for the GPU. Rows are rendered on all cores; a pixel's value does not depend on
//! which.

use std::ops::Range;

use rayon::prelude::*;

use super::Synth;
use super::stage::Group;
use crate::base::pixels::{Frame, Grid, Linear, Rgba, encode, over};
use crate::layers::parts::moment::Columns;
use crate::layers::ready::Still;

/// The frame at `scene_time` in linear, premultiplied RGBA.
pub fn linear(synth: &Synth, scene_time: f64) -> Linear {
    rows(synth, scene_time, 0..synth.size.1)
}

/// Only these rows of it.
fn rows(synth: &Synth, scene_time: f64, rows: Range<usize>) -> Linear {
    lines(synth, scene_time, Columns::All, &rows.collect::<Vec<_>>())
}

/// Only these columns of these rows.
fn lines(synth: &Synth, scene_time: f64, columns: Columns, rows: &[usize]) -> Linear {
    let width = match columns {
        Columns::All => synth.size.0,
        Columns::Some(columns) => columns.len(),
    };
    let moment = synth.moment(scene_time);
    let layers: Vec<Box<dyn Still + '_>> = synth.layers.iter().map(|layer| layer.at(&moment)).collect();
    let mut picture = Linear::filled(width, rows.len(), synth.stage.background);
    let lines = picture.cells_mut().par_chunks_mut(width.max(1)).zip(rows.par_iter());
    lines.for_each(|(out, &y)| {
        let mut own = vec![[0.0; 4]; width];
        let mut depth = Vec::new();
        for group in &synth.stage.groups {
            own.fill([0.0; 4]);
            match group {
                Group::Plane(layer) => layers[*layer].row(y, columns, &mut own),
                Group::World(group) => {
                    depth.clear();
                    depth.resize(width, f64::INFINITY);
                    group.iter().for_each(|layer| layers[*layer].surface(y, columns, &mut depth, &mut own));
                }
            }
            out.iter_mut().zip(&own).for_each(|(beneath, &color)| *beneath = over(color, *beneath));
        }
    });
    picture
}

/// How many pixels are in memory as light at a time: light takes four times the memory of codes.
pub const BAND: usize = 1 << 22;

/// The finished frame from several samples per pixel: sRGB, straight alpha, 8 bits per channel.
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

/// The pixels of the frame at `scene_time` in these columns and rows (ascending, within the frame). No others are
/// computed, so that a small view of a large picture is cheap.
pub fn lattice(synth: &Synth, scene_time: f64, columns: &[usize], rows: &[usize]) -> Linear {
    lines(synth, scene_time, Columns::Some(columns), rows)
}

/// The mean of the frames for several samples per pixel, in linear light.
pub fn mean(samples: &[Synth], scene_time: f64) -> Linear {
    mean_of(samples.iter().map(|synth| linear(synth, scene_time)))
}

/// The mean of linear frames of the same size.
pub fn mean_of(mut frames: impl ExactSizeIterator<Item = Linear>) -> Linear {
    let share = 1.0 / frames.len() as f32;
    let Some(mut sum) = frames.next() else { return Linear::filled(0, 0, [0.0; 4]) };
    for frame in frames {
        let add = |sum: &mut Rgba, more: &Rgba| *sum = std::array::from_fn(|i| sum[i] + more[i]);
        sum.cells_mut().par_iter_mut().zip(frame.cells().par_iter()).for_each(|(sum, more)| add(sum, more));
    }
    if share < 1.0 {
        sum.cells_mut().par_iter_mut().for_each(|color| *color = color.map(|c| c * share));
    }
    sum
}

/// The finished frame at `scene_time`: sRGB, straight alpha, 8 bits per channel.
pub fn frame(synth: &Synth, scene_time: f64) -> Frame {
    frames(std::slice::from_ref(synth), scene_time)
}

/// Encodes a linear frame.
pub fn finish(picture: &Linear) -> Frame {
    let cells = picture.cells().par_iter().map(|&color| encode(color)).collect();
    Grid::from_cells(picture.width(), picture.height(), cells)
}

/// Gives fully transparent pixels of a finished frame the colors that their layers have there, since straight alpha can
/// keep them.
pub fn keep_clear_colors(synth: &Synth, frame: &mut Frame) {
    let width = frame.width().max(1);
    frame.cells_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, code) in row.iter_mut().enumerate().filter(|(_, code)| code[3] == 0) {
            synth.layers.iter().for_each(|layer| layer.keep_clear_color((x, y), code));
        }
    });
}
