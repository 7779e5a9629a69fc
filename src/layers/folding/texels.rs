//! A zone's field packed into the textures that `frame.wgsl` reads. Crossings are distances from s = 0 in one long
//! list; every pixel's part ends with a number that no s reaches, so that the shader needs neither counts nor a second
//! loop.

use super::field::Field;
use super::ragged::Ragged;
use crate::base::pixels::Grid;
use crate::layers::parts::plan::{Format, Packed, Upload};

/// Columns of [`Texels::crossings`].
pub const COLUMNS: usize = 4096;

const MEMBER: u32 = 1 << 31;
const INSIDE: u32 = 1 << 30;
const NO_CROSSING: f32 = f32::MAX;

impl Upload for Field {
    /// Two textures: [`Texels::pixels`] and [`Texels::crossings`].
    fn pack(&self) -> Vec<Packed<'_>> {
        let Texels { pixels, crossings } = Texels::pack(self);
        vec![Packed::grid(pixels, Format::Rgba32Uint), Packed::grid(crossings, Format::R32Float)]
    }
}

/// A field as textures.
pub struct Texels {
    /// One texel per pixel of the box: the bits of J.x and J.y, the index of its first crossing ahead, that behind with
    /// flags.
    pub pixels: Grid<[u32; 4]>,
    /// All lists of crossings, in rows of [`COLUMNS`].
    pub crossings: Grid<f32>,
}

impl Texels {
    /// Packs a field.
    pub fn pack(field: &Field) -> Texels {
        let mut lists = Lists { values: vec![NO_CROSSING] };
        let pixel = |i: usize| {
            let [x, y] = field.jumps.cells()[i].map(f32::to_bits);
            let member = if field.inside.cells()[i] { MEMBER } else { 0 };
            let Some(folds) = field.folds.as_ref().filter(|_| member != 0) else { return [x, y, 0, member] };
            let inside = if folds.inside.cells()[i] { INSIDE } else { 0 };
            [x, y, lists.add(&folds.ahead, i), lists.add(&folds.behind, i) | member | inside]
        };
        let pixels = (0..field.jumps.cells().len()).map(pixel).collect();
        Texels {
            pixels: Grid::from_cells(field.jumps.width(), field.jumps.height(), pixels),
            crossings: lists.into_grid(),
        }
    }
}

/// All lists, one after another. Index 0 is the empty list.
struct Lists {
    values: Vec<f32>,
}

impl Lists {
    fn add(&mut self, ragged: &Ragged, i: usize) -> u32 {
        let list = ragged.of(i);
        if list.is_empty() {
            return 0;
        }
        let first = self.values.len();
        self.values.extend(list.iter().map(|&s| s.abs() as f32));
        self.values.push(NO_CROSSING);
        first as u32
    }

    fn into_grid(mut self) -> Grid<f32> {
        let rows = self.values.len().div_ceil(COLUMNS);
        self.values.resize(rows * COLUMNS, NO_CROSSING);
        Grid::from_cells(COLUMNS, rows, self.values)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::fold::Rule;
    use super::super::thresholds::Folds;
    use super::*;

    #[test]
    fn lists_end_and_the_empty_ones_share_one() {
        let field = Field {
            x0: 0,
            y0: 0,
            inside: Arc::new(Grid::from_cells(3, 1, vec![true, true, false])),
            jumps: Arc::new(Grid::filled(3, 1, [1.0, 0.0])),
            folds: Some(Folds {
                rule: Rule::Cover,
                inside: Grid::from_cells(3, 1, vec![false, true, true]),
                ahead: Ragged::new([&[0.25, 0.5][..], &[], &[9.0]]),
                behind: Ragged::new([&[][..], &[-0.75], &[]]),
            }),
        };
        let texels = Texels::pack(&field);
        assert_eq!(
            &texels.crossings.row(0)[..7],
            [NO_CROSSING, 0.25, 0.5, NO_CROSSING, 0.75, NO_CROSSING, NO_CROSSING]
        );
        let lists: Vec<_> = texels.pixels.cells().iter().map(|t| [t[2], t[3]]).collect();
        assert_eq!(lists, [[1, MEMBER], [0, 4 | MEMBER | INSIDE], [0, 0]]);
    }
}
