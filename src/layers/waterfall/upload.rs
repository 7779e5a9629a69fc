//! Pictures of sprites as one texture for the GPU: an atlas of blocks, each of all levels of one picture. Around every level
//! its edge is repeated, so that filtering never mixes two.

use std::ops::Range;

use super::sprites::Pictures;
use super::sprites::levels::Levels;
use super::sprites::residue::Residues;
use crate::base::half::half_of_value;
use crate::layers::parts::plan::{Format, Packed, Upload};

/// Texels in a row of the atlas.
const WIDTH: usize = 4096;

/// Where pictures of this side are in their atlas.
pub struct Atlas {
    /// The side of the largest level, in texels.
    pub side: usize,
}

impl Atlas {
    /// The first texel of a level in its block, and the level's side: the largest level to the left, the others beside it,
    /// one under the other.
    fn levels(&self) -> impl Iterator<Item = ([usize; 2], usize)> {
        let side = self.side;
        let mut top = 1;
        (0..=Levels::last(side)).map(move |level| match level {
            0 => ([1, 1], side),
            _ => {
                let own = side >> level;
                let first = [side + 3, top];
                top += own + 2;
                (first, own)
            }
        })
    }

    /// Width and height of a block.
    fn block(&self) -> [usize; 2] {
        let ends = self.levels().map(|([x, y], side)| [x + side + 1, y + side + 1]);
        ends.fold([0; 2], |most, end| [most[0].max(end[0]), most[1].max(end[1])])
    }

    fn across(&self) -> usize {
        WIDTH / self.block()[0]
    }

    /// The first texel of a level of picture number `i`.
    pub fn first_texel(&self, i: usize, level: usize) -> [usize; 2] {
        let [width, height] = self.block();
        let ([x, y], _) = self.levels().nth(level).unwrap_or(([0; 2], 0));
        [i % self.across() * width + x, i / self.across() * height + y]
    }

    /// The texture with these pictures; without pictures, a single texel.
    pub fn pack(self, pictures: Vec<&Levels>) -> Packed<'_> {
        let [_, block] = self.block();
        let size = (WIDTH, (pictures.len().div_ceil(self.across()) * block).max(1));
        let rows = move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
            let mut texels = vec![[0_u16; 4]; rows.len() * WIDTH];
            let lines = texels.chunks_exact_mut(WIDTH).zip(rows);
            lines.for_each(|(line, y)| self.line(&pictures, y, line));
            take(bytemuck::cast_slice(&texels));
        };
        Packed { size, format: Format::Rgba16Float, rows: Box::new(rows) }
    }

    /// Row `y` of the atlas.
    fn line(&self, pictures: &[&Levels], y: usize, out: &mut [[u16; 4]]) {
        let [width, height] = self.block();
        let first = y / height * self.across();
        for (picture, out) in pictures.iter().skip(first).zip(out.chunks_exact_mut(width)) {
            for (level, ([left, top], side)) in self.levels().enumerate() {
                let own = (y % height + 1).checked_sub(top).filter(|row| *row < side + 2);
                let Some(row) = own.map(|row| row.saturating_sub(1).min(side - 1)) else { continue };
                for (x, cell) in out[left - 1..left + side + 1].iter_mut().enumerate() {
                    *cell = picture.texel(level, x.saturating_sub(1).min(side - 1), row).map(half_of_value);
                }
            }
        }
    }
}

impl Upload for Pictures {
    fn pack(&self) -> Vec<Packed<'_>> {
        let keys = self.tracks.iter().flat_map(|track| &track.keys).map(|key| &*key.texels);
        vec![Atlas { side: self.side }.pack(keys.collect())]
    }
}

impl Upload for Residues {
    fn pack(&self) -> Vec<Packed<'_>> {
        let all: Vec<_> = self.0.iter().flatten().collect();
        let side = all.first().map_or(1, |first| first.level(0).side);
        vec![Atlas { side }.pack(all)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_of_every_picture_has_its_place_with_its_edge_repeated() {
        let side = 16;
        let count = 300;
        let picture = |i: usize| Levels::new(side, (0..side * side).map(|k| [(i + k) as f32; 4]).collect(), 16.0);
        let pictures: Vec<_> = (0..count).map(picture).collect();
        let packed = Atlas { side }.pack(pictures.iter().collect());
        let mut all: Vec<[u16; 4]> = Vec::new();
        (packed.rows)(0..packed.size.1, &mut |bytes| all.extend(bytemuck::cast_slice::<u8, [u16; 4]>(bytes)));
        let atlas = Atlas { side };
        for i in [0, 1, 140, 299] {
            for level in 0..=Levels::last(side) {
                let own = side >> level;
                let [left, top] = atlas.first_texel(i, level);
                for (x, y) in [(0, 0), (0, own + 1), (own + 1, 0), (own / 2, own / 3), (own + 1, own + 1)] {
                    let at = |v: usize| v.saturating_sub(1).min(own - 1);
                    let expected = pictures[i].texel(level, at(x), at(y)).map(half_of_value);
                    assert_eq!(all[(top + y - 1) * WIDTH + left + x - 1], expected, "{i} {level} {x} {y}");
                }
            }
        }
    }
}
