//! The brightness of frames in whole numbers, so that every program chooses and follows the same windows.

use crate::base::clip::Clip;
use crate::base::picture::Picture;
use crate::base::pixels::Grid;

/// Half of what 8 bits leave out.
const HALF: u16 = 128;

/// The brightness of a color in codes of 8 bits: 0 to 65280.
pub fn of([r, g, b]: [u8; 3]) -> u16 {
    54 * u16::from(r) + 183 * u16::from(g) + 19 * u16::from(b)
}

/// The brightness of a frame, in 8 bits.
pub fn frame(picture: &Picture) -> Grid<u8> {
    let (width, height) = (picture.width(), picture.height());
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let cells = places.map(|(x, y)| ((of(picture.codes(x, y)) + HALF) >> 8) as u8);
    Grid::from_cells(width, height, cells.collect())
}

/// The brightness of each frame of a clip.
pub fn frames(clip: &Clip) -> Vec<Grid<u8>> {
    use rayon::prelude::*;
    clip.frames.par_iter().map(|picture| frame(picture)).collect()
}

/// Half as large: the mean of each whole block of 2 x 2.
pub fn halved(full: &Grid<u8>) -> Grid<u8> {
    let (width, height) = (full.width() / 2, full.height() / 2);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (2 * x, 2 * y)));
    let sum = |(x, y): (usize, usize)| {
        let block = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        block.iter().map(|&(x, y)| u16::from(*full.get(x, y))).sum::<u16>()
    };
    Grid::from_cells(width, height, places.map(|at| ((sum(at) + 2) >> 2) as u8).collect())
}

/// The sum of absolute differences between a square at `at` in one frame and one at `to` in another; more than `most` as
/// soon as that is certain.
pub fn difference(
    from: &Grid<u8>,
    (x, y): (usize, usize),
    into: &Grid<u8>,
    (to_x, to_y): (usize, usize),
    (side, most): (usize, u32),
) -> u32 {
    let mut sum = 0;
    for j in 0..side {
        let (a, b) = (&from.row(y + j)[x..x + side], &into.row(to_y + j)[to_x..to_x + side]);
        sum += a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(*b))).sum::<u32>();
        if sum > most {
            break;
        }
    }
    sum
}

/// The place `from` moved by a displacement, if a square there is inside a frame.
pub fn moved(
    from: (usize, usize),
    by: (i32, i32),
    side: usize,
    (width, height): (usize, usize),
) -> Option<(usize, usize)> {
    let along = |at: usize, by: i32, size: usize| {
        let to = at as i64 + i64::from(by);
        (to >= 0 && to as usize + side <= size).then_some(to as usize)
    };
    Some((along(from.0, by.0, width)?, along(from.1, by.1, height)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_is_in_whole_numbers() {
        assert_eq!([of([255; 3]), of([0; 3]), of([1, 2, 3])], [65_280, 0, 54 + 366 + 57]);
        let cells = [[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 1.0]].repeat(4);
        let grey = frame(&Picture::from_cells(4, 2, cells));
        assert_eq!(grey.cells(), [0, 255, 0, 255, 0, 255, 0, 255]);
        assert_eq!(halved(&grey).cells(), [128, 128]);
        assert_eq!(halved(&Grid::from_cells(3, 3, (0..9).collect())).cells(), [2]);
    }

    #[test]
    fn squares_stay_inside() {
        assert_eq!(moved((1, 1), (-1, 1), 2, (4, 4)), Some((0, 2)));
        assert_eq!(moved((1, 1), (-2, 0), 2, (4, 4)), None);
        assert_eq!(moved((1, 1), (0, 2), 2, (4, 4)), None);
    }
}
