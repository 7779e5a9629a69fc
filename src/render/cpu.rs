//! Frames on the CPU: the reference for the GPU. Rows are rendered on all cores; a pixel's value does not depend on
//! which.

use std::ops::Range;

use rayon::prelude::*;

use super::Synth;
use super::made::{LastMade, Wholes};
use super::stage::{Group, Stage};
use super::whole::Surfaced;
use crate::base::pixels::{Frame, Grid, Linear, Rgba, encode, encode_all, over};
use crate::base::simd::vectorised;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::ready::Still;

/// The frame at `scene_time` in linear, premultiplied RGBA.
pub fn linear(synth: &Synth, scene_time: f64) -> Linear {
    mean(std::slice::from_ref(synth), scene_time)
}

/// Rows that are made one after the other.
const STRIP: usize = 16;
/// Colors that are encoded one after the other.
const RUN: usize = 1 << 14;

/// Only these columns of these rows of one sample of each pixel.
fn lines((synth, sample): (&Synth, usize), (scene_time, wholes): At, columns: Columns, rows: &[usize]) -> Linear {
    let width = match columns {
        Columns::All => synth.size.0,
        Columns::Some(columns) => columns.len(),
    };
    let moment = synth.moment(scene_time);
    let layers = layers(synth, &moment);
    let mut picture = Linear::filled(width, rows.len(), synth.stage.background);
    for (i, group) in synth.stage.groups.iter().enumerate() {
        let (shown, width) = (GroupAt { layers: &layers, group, columns }, width.max(1));
        let out = picture.cells_mut();
        let whole = wholes.of(i, sample, columns, rows);
        let has_sprites = has_sprites(synth, group);
        if whole.is_some() || has_sprites {
            // Sprites reach over many rows: all of these at once.
            let (mut own, depth) = whole.unwrap_or_else(|| shown.surfaces(rows, width));
            if has_sprites {
                own = shown.sprites(rows, &depth, own.into_owned()).into();
            }
            out.par_iter_mut().zip(own.par_iter()).for_each(|(beneath, color)| *beneath = over(*color, *beneath));
            continue;
        }
        let strips = out.par_chunks_mut(STRIP * width).zip(rows.par_chunks(STRIP));
        strips.for_each_init(Vec::new, |own, (out, rows)| shown.lay(rows, own, out));
    }
    picture
}

fn layers<'a>(synth: &'a Synth, moment: &'a Moment) -> Vec<Box<dyn Still + 'a>> {
    synth.layers.iter().map(|layer| layer.at(moment)).collect()
}

fn has_sprites(synth: &Synth, group: &Group) -> bool {
    group.layers().iter().any(|&layer| synth.layers[layer].has_sprites())
}

/// A group of layers at one time.
struct GroupAt<'a> {
    layers: &'a [Box<dyn Still + 'a>],
    group: &'a Group,
    columns: Columns<'a>,
}

impl GroupAt<'_> {
    /// Lays these rows of what is no sprite over `out`; `own` is memory.
    fn lay(&self, rows: &[usize], own: &mut Vec<Rgba>, out: &mut [Rgba]) {
        own.clear();
        own.resize(out.len(), [0.0; 4]);
        let width = out.len() / rows.len().max(1);
        match (self.group, self.columns, run(rows)) {
            (Group::Plane(layer), Columns::All, Some(rows)) => self.layers[*layer].rows(rows, width, own),
            _ => {
                let mut depth = vec![f64::INFINITY; width];
                rows.iter().zip(own.chunks_mut(width.max(1))).for_each(|(&y, own)| self.row(y, &mut depth, own));
            }
        }
        out.iter_mut().zip(own).for_each(|(beneath, color)| *beneath = over(*color, *beneath));
    }

    /// Writes row `y` of what is no sprite to `own`, transparent before, and how far away it is to `depth`.
    fn row(&self, y: usize, depth: &mut [f64], own: &mut [Rgba]) {
        match self.group {
            Group::Plane(layer) => self.layers[*layer].row(y, self.columns, own),
            Group::World(group) => {
                depth.fill(f64::INFINITY);
                group.iter().for_each(|layer| self.layers[*layer].surface(y, self.columns, depth, own));
            }
        }
    }

    /// The same for these rows.
    fn surfaces(&self, rows: &[usize], width: usize) -> Surfaced<'static> {
        let mut own = vec![[0.0; 4]; rows.len() * width];
        let mut depth = vec![f64::INFINITY; own.len()];
        let lines = own.par_chunks_mut(width).zip(depth.par_chunks_mut(width)).zip(rows.par_iter());
        lines.for_each(|((own, depth), &y)| self.row(y, depth, own));
        (own.into(), depth.into())
    }

    /// Draws sprites over surfaces, layer by layer.
    fn sprites(&self, rows: &[usize], depth: &[f64], mut own: Vec<Rgba>) -> Vec<Rgba> {
        let layers = self.group.layers().iter();
        layers.for_each(|&layer| self.layers[layer].sprites(rows, self.columns, depth, &mut own));
        own
    }
}

/// How many pixels are in memory as light at a time: light takes four times the memory of codes.
pub const BAND: usize = 1 << 22;

/// A scene time, with what is made whole then.
type At<'a> = (f64, &'a Wholes);

/// Hears how many rows more are done, each once for every sample of its pixels.
pub type Done<'a> = &'a (dyn Fn(usize) + Sync);

/// The finished frame from several samples per pixel: sRGB, straight alpha, 8 bits per channel.
pub fn frames(samples: &[Synth], scene_time: f64) -> Frame {
    let (width, height) = samples.first().map_or((0, 0), |synth| synth.size);
    let mut cells = vec![[0; 4]; width * height];
    let most = (BAND / width.max(1)).max(1);
    let wholes = Wholes::new(samples, scene_time);
    for (i, out) in cells.chunks_mut(most * width.max(1)).enumerate() {
        finish_rows(samples, (scene_time, &wholes), i * most..((i + 1) * most).min(height), out, &|_| ());
    }
    Grid::from_cells(width, height, cells)
}

/// Finishes these rows into `out`; `done` hears of rows that one more sample is made of.
pub fn finish_rows(samples: &[Synth], at: At, band: Range<usize>, out: &mut [[u8; 4]], done: Done) {
    let Some(width) = samples.first().map(|synth| synth.size.0.max(1)) else { return };
    let in_strips = |(sample, synth): (usize, &Synth)| {
        let mut groups = synth.stage.groups.iter().enumerate();
        groups.all(|(i, group)| !has_sprites(synth, group) && at.1.of(i, sample, Columns::All, &[]).is_none())
    };
    let rows: Vec<usize> = band.collect();
    if !samples.iter().enumerate().all(in_strips) {
        let linear = mean_lines(samples, at, Columns::All, &rows, done);
        return encode_in(linear.cells(), out);
    }
    let moments: Vec<Moment> = samples.iter().map(|synth| synth.moment(at.0)).collect();
    let layers: Vec<_> = samples.iter().zip(&moments).map(|(synth, moment)| layers(synth, moment)).collect();
    let samples: Vec<(&Stage, &[Box<dyn Still + '_>])> =
        samples.iter().zip(&layers).map(|(synth, layers)| (&*synth.stage, &layers[..])).collect();
    let strips = out.par_chunks_mut(STRIP * width).zip(rows.par_chunks(STRIP));
    strips.for_each_init(<[Vec<Rgba>; 3]>::default, |memory, (out, rows)| {
        finish_strip(&samples, rows, memory, out);
        done(samples.len() * rows.len());
    });
}

/// Finishes rows of which no layer needs more than these.
fn finish_strip(
    samples: &[(&Stage, &[Box<dyn Still + '_>])],
    rows: &[usize],
    [own, light, sum]: &mut [Vec<Rgba>; 3],
    out: &mut [[u8; 4]],
) {
    if let ([(stage, layers)], Some(rows)) = (samples, run(rows))
        && let [Group::Plane(layer)] = stage.groups[..]
        && layers[layer].codes(rows, stage.background, out)
    {
        return;
    }
    for (i, (stage, layers)) in samples.iter().enumerate() {
        light.clear();
        light.resize(out.len(), stage.background);
        for group in &stage.groups {
            GroupAt { layers, group, columns: Columns::All }.lay(rows, own, light);
        }
        if i == 0 {
            std::mem::swap(sum, light);
        } else {
            sum.iter_mut().zip(&*light).for_each(|(sum, more)| add(sum, more));
        }
    }
    let share = share_of(samples.len());
    if share < 1.0 {
        sum.iter_mut().for_each(|color| *color = color.map(|c| c * share));
    }
    encode_in(sum, out);
}

/// Rows as a range, if they follow one another.
fn run(rows: &[usize]) -> Option<Range<usize>> {
    let range = *rows.first()?..rows.last()? + 1;
    (range.len() == rows.len()).then_some(range)
}

/// Encodes light.
fn encode_in(light: &[Rgba], out: &mut [[u8; 4]]) {
    let runs = out.par_chunks_mut(RUN).zip(light.par_chunks(RUN));
    runs.for_each(|(out, light)| {
        vectorised(
            #[inline(always)]
            || encode_all(light, out),
        );
    });
}

/// The color that a frame has at one pixel: sRGB, straight alpha; `None` beside the frame.
pub fn color_at(synth: &Synth, t: f64, (x, y): (usize, usize)) -> Option<[u8; 4]> {
    let within = x < synth.size.0 && y < synth.size.1;
    within.then(|| encode(*lattice(synth, t, &[x], &[y]).get(0, 0)))
}

/// The pixels of the frame at `scene_time` in these columns and rows (ascending, within the frame). No others are
/// computed, but of layers that are made whole, so that a small view of a large picture is cheap.
pub fn lattice(synth: &Synth, scene_time: f64, columns: &[usize], rows: &[usize]) -> Linear {
    let at = (scene_time, &*LastMade::frame(synth, scene_time));
    mean_lines(std::slice::from_ref(synth), at, Columns::Some(columns), rows, &|_| ())
}

/// The same for several samples per pixel.
pub fn mean_lattice(samples: &[Synth], scene_time: f64, columns: &[usize], rows: &[usize]) -> Linear {
    mean_lines(samples, (scene_time, &Wholes::new(samples, scene_time)), Columns::Some(columns), rows, &|_| ())
}

/// The mean of the frames for several samples per pixel, in linear light.
pub fn mean(samples: &[Synth], scene_time: f64) -> Linear {
    let height = samples.first().map_or(0, |synth| synth.size.1);
    let at = (scene_time, &Wholes::new(samples, scene_time));
    mean_lines(samples, at, Columns::All, &(0..height).collect::<Vec<_>>(), &|_| ())
}

fn mean_lines(samples: &[Synth], at: At, columns: Columns, rows: &[usize], done: Done) -> Linear {
    mean_of(samples.iter().enumerate().map(|sample| {
        let made = lines((sample.1, sample.0), at, columns, rows);
        done(rows.len());
        made
    }))
}

fn add(sum: &mut Rgba, more: &Rgba) {
    *sum = std::array::from_fn(|i| sum[i] + more[i]);
}

/// What each of so many samples adds to a mean.
fn share_of(samples: usize) -> f32 {
    1.0 / samples as f32
}

/// The mean of linear frames of the same size.
pub fn mean_of(mut frames: impl ExactSizeIterator<Item = Linear>) -> Linear {
    let share = share_of(frames.len());
    let Some(mut sum) = frames.next() else { return Linear::filled(0, 0, [0.0; 4]) };
    for frame in frames {
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
    let mut cells = vec![[0; 4]; picture.cells().len()];
    encode_in(picture.cells(), &mut cells);
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
