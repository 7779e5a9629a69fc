//! Where charts are in the textures of a map: on each layer the same place, in textures that are twice as large from one to
//! the next, so that one pair of texture coordinates leads to the cells of all layers.

use crate::base::packing::{Packed, pack};
use crate::layers::mesh::slots::view_map::cells::{Cell, Cells, Layer, NONE};

/// The border of a chart, in cells of layer 0; of it, one cell of each layer beside its cells is filled.
const BORDER: usize = 1;

/// Where charts are.
pub struct Layout {
    /// Where the cells of each chart begin on layer 0: column and row of a texel.
    pub places: Vec<(usize, usize)>,
    /// Columns and rows of layer 0.
    size: (usize, usize),
}

/// What each texel of a layer shows.
pub struct Texels {
    /// Its cell, or one beside it that it repeats, or none.
    pub cells: Vec<u32>,
    /// Whether the cell is its own.
    pub own: Vec<bool>,
}

impl Layout {
    /// The charts of a map packed.
    pub fn new(cells: &Cells) -> Layout {
        let sizes = cells.layers.iter().take(1).flat_map(|layer| &layer.charts);
        let sizes: Vec<(usize, usize)> = sizes
            .map(|chart| [chart.width, chart.height].map(|side| side.max(0) as usize + 2 * BORDER))
            .map(|[width, height]| (width, height))
            .collect();
        let Packed { places, width, height } = pack(&sizes);
        Layout { places: places.into_iter().map(|(x, y)| (x + BORDER, y + BORDER)).collect(), size: (width, height) }
    }

    /// Columns and rows of a layer.
    pub fn size(&self, layer: usize) -> (usize, usize) {
        (self.size.0 << layer, self.size.1 << layer)
    }

    /// Column and row of the texel of a cell.
    fn texel(&self, layer: usize, cell: &Cell) -> (usize, usize) {
        let (x, y) = self.places[cell.chart as usize];
        ((x << layer) + cell.x as usize, (y << layer) + cell.y as usize)
    }

    /// What each texel of a layer shows, row by row.
    pub fn shown(&self, number: usize, layer: &Layer) -> Texels {
        const BESIDE: [(isize, isize); 4] = [(-1, 0), (1, 0), (0, -1), (0, 1)];
        const ASLANT: [(isize, isize); 4] = [(-1, -1), (1, -1), (-1, 1), (1, 1)];
        let (width, height) = self.size(number);
        let mut shown = Texels { cells: vec![NONE; width * height], own: vec![false; width * height] };
        for (i, cell) in layer.cells.iter().enumerate() {
            let (x, y) = self.texel(number, cell);
            (shown.cells[y * width + x], shown.own[y * width + x]) = (i as u32, true);
        }
        for ways in [BESIDE, ASLANT] {
            for (i, cell) in layer.cells.iter().enumerate() {
                let (x, y) = self.texel(number, cell);
                for (right, down) in ways {
                    let at = y.wrapping_add_signed(down) * width + x.wrapping_add_signed(right);
                    if shown.cells[at] == NONE {
                        shown.cells[at] = i as u32;
                    }
                }
            }
        }
        shown
    }
}
