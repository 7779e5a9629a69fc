//! A filled map as textures for the GPU, layer after layer, in rows as those of a mesh: as `sample.wgsl` reads it.

use std::iter;

use super::arrays::Arrays;
use super::atlas::Atlas;
use super::cells::Cells;
use super::coat::Coat;
use super::entries::Entry;
use super::lists::Lists;
use super::looked::Filled;
use crate::base::half::half_of_value;
use crate::layers::parts::plan::{Format, Packed, Upload};
use crate::layers::space::upload::{WIDTH, lines, packed};

/// The most texels of a texture: 8192 rows, which each GPU can hold.
const MOST_TEXELS: usize = 8192 * WIDTH;

/// The numbers of the textures of cells: the charts of each layer, and the cells of their squares.
pub const CHARTS: usize = 0;
/// See [`CHARTS`].
pub const SQUARES: usize = 1;
/// The numbers of the textures of lists: where that of each cell begins, and what they tell.
pub const STARTS: usize = 0;
/// See [`STARTS`].
pub const ENTRIES: usize = 1;
/// The numbers of the textures of arrays: how cells are turned, and the elements.
pub const TURNS: usize = 0;
/// See [`TURNS`].
pub const ELEMENTS: usize = 1;

/// Whether each texture of a map has at most as many texels as it may.
pub fn fits((map, arrays): Filled) -> bool {
    let squares = map.cells.layers.iter().map(|layer| layer.numbers.len()).sum::<usize>() / 4;
    let entries = map.lists.iter().map(|lists| lists.entries.len()).sum();
    let elements = arrays.map_or(0, |arrays| arrays.elements.iter().map(Vec::len).sum());
    [2 * map.atlas.corners.len(), squares, 2 * map.cells.count(), entries, elements].iter().all(|of| *of <= MOST_TEXELS)
}

/// Several lists, one after the other.
struct Joined {
    /// Where each begins; one more at the end.
    firsts: Vec<usize>,
}

impl Joined {
    fn new(lengths: impl Iterator<Item = usize>) -> Joined {
        let ends = lengths.scan(0, |end, length| {
            *end += length;
            Some(*end)
        });
        Joined { firsts: iter::once(0).chain(ends).collect() }
    }

    fn count(&self) -> usize {
        self.firsts.last().copied().unwrap_or(0)
    }

    /// The list that an item is in, and its place there.
    fn at(&self, item: usize) -> (usize, usize) {
        let list = self.firsts.partition_point(|first| *first <= item).saturating_sub(1);
        (list, item - self.firsts[list])
    }
}

/// Four whole numbers a texel.
fn numbers<'a>(count: usize, of: impl Fn(usize) -> u32 + 'a) -> Packed<'a> {
    let texels = count.div_ceil(4);
    let four = move |i: usize| [[0, 1, 2, 3].map(|k| if 4 * i + k < count { of(4 * i + k) } else { 0 })];
    packed(lines(texels, four), texels, Format::Rgba32Uint)
}

impl Upload for Atlas {
    /// Of each triangle two texels: its corners, its area and its chart.
    fn pack(&self) -> Vec<Packed<'_>> {
        let corners = lines(self.corners.len(), |i| {
            let [a, b, c] = self.corners[i].map(|corner| corner.as_vec2());
            [[a.x, a.y, b.x, b.y], [c.x, c.y, self.areas[i] as f32, self.chart[i] as f32]]
        });
        vec![packed(corners, 2 * self.corners.len(), Format::Rgba32Float)]
    }
}

impl Upload for Cells {
    fn pack(&self) -> Vec<Packed<'_>> {
        let of_charts = Joined::new(self.layers.iter().map(|layer| layer.charts.len()));
        let of_squares = Joined::new(self.layers.iter().map(|layer| layer.numbers.len()));
        let (charts, squares) = (of_charts.count(), of_squares.count());
        let chart = move |i: usize| {
            let (layer, at) = of_charts.at(i);
            let chart = &self.layers[layer].charts[at];
            [[chart.first as u32, chart.width as u32, chart.height as u32, 0]]
        };
        let square = move |i: usize| {
            let (layer, at) = of_squares.at(i);
            self.layers[layer].numbers[at]
        };
        vec![packed(lines(charts, chart), charts, Format::Rgba32Uint), numbers(squares, square)]
    }
}

impl Upload for Vec<Coat> {
    fn pack(&self) -> Vec<Packed<'_>> {
        let joined = Joined::new(self.iter().map(|coat| coat.colors.len()));
        let count = joined.count();
        let color = move |i: usize| {
            let (layer, at) = joined.at(i);
            let [r, g, b] = self[layer].colors[at].map(half_of_value);
            [[r, g, b, half_of_value(1.0)]]
        };
        vec![packed(lines(count, color), count, Format::Rgba16Float)]
    }
}

impl Upload for Vec<Lists> {
    fn pack(&self) -> Vec<Packed<'_>> {
        let of_starts = Joined::new(self.iter().map(|lists| lists.starts.len()));
        let of_entries = Joined::new(self.iter().map(|lists| lists.entries.len()));
        let firsts = of_entries.firsts.clone();
        let (starts, entries) = (of_starts.count(), of_entries.count());
        let start = move |i: usize| {
            let (layer, at) = of_starts.at(i);
            firsts[layer] as u32 + self[layer].starts[at]
        };
        let entry = move |i: usize| {
            let (layer, at) = of_entries.at(i);
            [told(self[layer].views[at], &self[layer].entries[at])]
        };
        vec![numbers(starts, start), packed(lines(entries, entry), entries, Format::Rgba32Uint)]
    }
}

/// What a view tells a cell, in 16 bytes: the color in half floats, how much it counts in 16 bits, its depth as it is, the mask in
/// 24 bits and the view.
fn told(view: u8, entry: &Entry) -> [u32; 4] {
    let [r, g, b] = entry.color.map(|light| u32::from(half_of_value(light)));
    let whole = |share: f32, most: f64| (f64::from(share).clamp(0.0, 1.0) * most).round() as u32;
    let (facing, mask) = (whole(entry.facing, 65535.0), whole(entry.mask, 16_777_215.0));
    [r | g << 16, b | facing << 16, entry.depth.to_bits(), u32::from(view) | mask << 8]
}

impl Upload for Arrays {
    /// Of each cell two texels: the normal, and where the atlas goes right; then the elements.
    fn pack(&self) -> Vec<Packed<'_>> {
        let of_cells = Joined::new(self.frames.iter().map(Vec::len));
        let of_elements = Joined::new(self.elements.iter().map(Vec::len));
        let (cells, elements) = (of_cells.count(), of_elements.count());
        let turn = move |i: usize| {
            let (layer, at) = of_cells.at(i);
            let frame = &self.frames[layer][at];
            [frame.normal, frame.along].map(|way| way.as_vec3().extend(0.0).to_array())
        };
        let element = move |i: usize| {
            let (layer, at) = of_elements.at(i);
            [self.elements[layer][at]]
        };
        vec![
            packed(lines(cells, turn), 2 * cells, Format::Rgba32Float),
            packed(lines(elements, element), elements, Format::Rgba16Float),
        ]
    }
}
