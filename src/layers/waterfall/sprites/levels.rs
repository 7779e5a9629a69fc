//! A picture at several sizes, in whole numbers of 16 bits: half the bytes of single precision, twice as many at a time,
//! and sums that have the same bits everywhere.

use std::num::Wrapping;
use std::ops::Range;

use crate::base::pixels::Rgba;

/// A number of a texel, or of a difference or sum of some.
pub type Number = Wrapping<i16>;

/// The smallest side that is halved.
const SMALLEST: usize = 8;

/// A square picture, and smaller ones, each half as large as the one before.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels {
    levels: Vec<Level>,
    one: f32,
}

/// A square picture with a border that repeats its edge, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Texels of a side.
    pub side: usize,
    numbers: Vec<[Number; 4]>,
}

impl Levels {
    /// The levels of a square picture, where 1 is the number `one`; what is beyond the numbers that there are is cut off.
    pub fn new(side: usize, mut texels: Vec<Rgba>, one: f32) -> Levels {
        let mut levels = vec![Level::new(side, &texels, one)];
        for side in sides(side).skip(1) {
            let mean = |i: usize| {
                let at = i / side * 4 * side + i % side * 2;
                let block = [at, at + 1, at + 2 * side, at + 2 * side + 1].map(|at| texels[at]);
                std::array::from_fn(|c| (block[0][c] + block[1][c] + block[2][c] + block[3][c]) * 0.25)
            };
            texels = (0..side * side).map(mean).collect();
            levels.push(Level::new(side, &texels, one));
        }
        Levels { levels, one }
    }

    /// The number of the smallest level of a picture of this side.
    pub fn last(side: usize) -> usize {
        sides(side).count() - 1
    }

    /// How many bytes the levels of a picture of this side take.
    pub fn bytes(side: usize) -> u64 {
        sides(side).map(|side| (across(side) * across(side) * size_of::<[Number; 4]>()) as u64).sum()
    }

    /// The level of this number.
    pub fn level(&self, level: usize) -> &Level {
        &self.levels[level]
    }

    /// A texel of a level.
    pub fn texel(&self, level: usize, x: usize, y: usize) -> Rgba {
        let Level { side, numbers } = &self.levels[level];
        numbers[(y + 1) * across(*side) + x + 1].map(|number| f32::from(number.0) * (1.0 / self.one))
    }

    /// All texels of a level, row by row.
    pub fn texels(&self, level: usize) -> impl Iterator<Item = Rgba> {
        let side = self.levels[level].side;
        (0..side * side).map(move |i| self.texel(level, i % side, i / side))
    }
}

impl Level {
    fn new(side: usize, texels: &[Rgba], one: f32) -> Level {
        let inside = |v: usize| v.saturating_sub(1).min(side - 1);
        let place = |i: usize| inside(i / across(side)) * side + inside(i % across(side));
        // Even: see where they are mixed.
        let number = |v: f32| Wrapping(2 * (v * one / 2.0).round().clamp(-16_383.0, 16_383.0) as i16);
        Level { side, numbers: (0..across(side) * across(side)).map(|i| texels[place(i)].map(number)).collect() }
    }

    /// The numbers of these rows with their borders, moved on by so many texels.
    #[inline(always)]
    pub fn rows(&self, rows: &Range<usize>, moved: isize) -> &[Number] {
        let row = across(self.side);
        self.numbers[((rows.start + 1) * row).wrapping_add_signed(moved)..][..rows.len() * row].as_flattened()
    }
}

/// How many texels make a row of a picture of this side, with its border.
pub fn across(side: usize) -> usize {
    side + 2
}

fn sides(side: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(side), |side| (side % 2 == 0 && *side >= SMALLEST).then_some(side / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_means_down_to_sides_that_are_odd_or_small() {
        for (side, sides) in [(64, vec![64, 32, 16, 8, 4]), (48, vec![48, 24, 12, 6]), (16, vec![16, 8, 4])] {
            let levels = Levels::new(side, (0..side * side).map(|i| [(i % side) as f32; 4]).collect(), 256.0);
            assert_eq!(levels.levels.iter().map(|level| level.side).collect::<Vec<_>>(), sides);
            assert_eq!(Levels::last(side), sides.len() - 1);
            assert_eq!(levels.texel(1, 1, 0), [2.5; 4]);
        }
    }

    #[test]
    fn texels_are_close_to_what_they_are_made_of_and_edges_repeat() {
        let texel = |i: usize| [0.0, 0.5, i as f32 / 256.0, 1.0];
        let levels = Levels::new(16, (0..256).map(texel).collect(), 32_766.0);
        for (i, found) in levels.texels(0).enumerate() {
            let far = (0..4).map(|c| (found[c] - texel(i)[c]).abs()).fold(0.0, f32::max);
            assert!(far < 3.1e-5 && found[0] == 0.0 && found[3] == 1.0, "{i}: {found:?}");
        }
        let (level, row) = (levels.level(2), across(4));
        let (first, above) = (level.rows(&(0..1), 0), level.rows(&(0..1), -(row as isize)));
        assert_eq!((first.len(), first), (4 * row, above));
        assert_eq!((&first[..4], &first[4 * row - 4..]), (&first[4..8], &first[4 * row - 8..4 * row - 4]));
    }

    #[test]
    fn numbers_that_are_too_large_are_cut_off() {
        let levels = Levels::new(16, vec![[-7.0, 7.0, f32::NAN, 1.0]; 256], 32_766.0);
        assert_eq!(levels.texel(0, 3, 3), [-1.0, 1.0, 0.0, 1.0]);
    }
}
