//! Which windows of a clip are chosen: in each frame, as many as the growth law says, of those where things move; each one
//! as different as can be from all before.

use rayon::prelude::*;

use super::luma::{difference, halved, moved};
use super::model::Sprites;
use crate::base::pixels::Grid;

/// In frames of half the size, what moves goes no farther than this from one frame to the other.
const REACH: i32 = 4;
/// How much more what moves counts than what only changes.
const MOTION: u32 = 8;
/// Thumbnails are so many blocks wide and high.
const BLOCKS: usize = 16;

/// A window of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The frame.
    pub frame: usize,
    /// Its left column and top row.
    pub at: (usize, usize),
}

/// The differences of a window's blocks from their mean, and the sum of their squares.
struct Thumbnail(Vec<i64>, i64);

impl Thumbnail {
    fn new(frame: &Grid<u8>, (left, top): (usize, usize), side: usize) -> Option<Thumbnail> {
        let each = side / BLOCKS;
        let block = |i: usize| {
            let (x, y) = (left + i % BLOCKS * each, top + i / BLOCKS * each);
            (0..each).flat_map(|j| &frame.row(y + j)[x..x + each]).map(|v| i64::from(*v)).sum::<i64>()
        };
        let sums: Vec<i64> = (0..BLOCKS * BLOCKS).map(block).collect();
        let total: i64 = sums.iter().sum();
        let differences: Vec<i64> = sums.iter().map(|sum| (BLOCKS * BLOCKS) as i64 * sum - total).collect();
        let square = differences.iter().map(|d| d * d).sum();
        (square > 0).then_some(Thumbnail(differences, square))
    }

    fn likeness(&self, other: &Thumbnail) -> f64 {
        let product: i64 = self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum();
        product as f64 / (self.1 as f64 * other.1 as f64).sqrt()
    }
}

/// The chosen windows, in order. `frames` are the clip's in brightness; at least as many as a track needs.
pub fn windows(sprites: &Sprites, fps: f64, frames: &[Grid<u8>]) -> Vec<Window> {
    let side = sprites.size as usize;
    let ahead = (sprites.track_frames() - 1).max(sprites.step as usize);
    let mut taken: Vec<(Window, Thumbnail)> = Vec::new();
    let mut owed = 0;
    for k in 0..frames.len().saturating_sub(ahead) {
        owed += sprites.growth.added(k, fps);
        if owed == 0 {
            continue;
        }
        let mut left = moving(frames, k, sprites.step as usize, side);
        while owed > 0 && !left.is_empty() {
            let most = |thumbnail: &Thumbnail| {
                taken.iter().map(|(_, other)| thumbnail.likeness(other)).fold(f64::NEG_INFINITY, f64::max)
            };
            let mut best = (0, f64::INFINITY);
            for (i, likeness) in left.iter().map(|(_, thumbnail)| most(thumbnail)).enumerate() {
                if likeness < best.1 {
                    best = (i, likeness);
                }
            }
            // Before any is taken, the first is as good as all others.
            let (at, thumbnail) = left.remove(best.0);
            taken.push((Window { frame: k, at }, thumbnail));
            owed -= 1;
        }
    }
    taken.into_iter().map(|(window, _)| window).collect()
}

/// The windows of frame `k` where most moves, best first.
fn moving(frames: &[Grid<u8>], k: usize, step: usize, side: usize) -> Vec<((usize, usize), Thumbnail)> {
    let (now, then) = (halved(&frames[k]), halved(&frames[k + step]));
    let size = (frames[k].width(), frames[k].height());
    let along = |size: usize| (0..).map(|i| i * side / 4).take_while(move |at| at + side <= size);
    let places: Vec<(usize, usize)> = along(size.1).flat_map(|y| along(size.0).map(move |x| (x, y))).collect();
    let scored = places.into_par_iter().map(|at| (score(&now, &then, (at.0 / 2, at.1 / 2), side / 2), at));
    let mut scored: Vec<(u32, (usize, usize))> = scored.collect();
    let best = scored.iter().map(|(score, _)| *score).max().unwrap_or(0);
    scored.retain(|(score, _)| best > 0 && 2 * score >= best);
    scored.sort_by_key(|&(score, (left, top))| (std::cmp::Reverse(score), top, left));
    let kept = scored.into_iter().filter_map(|(_, at)| Some((at, Thumbnail::new(&frames[k], at, side)?)));
    kept.collect()
}

/// How much moves in a square: where most of the change is gone if the square is moved along, it is motion.
fn score(now: &Grid<u8>, then: &Grid<u8>, at: (usize, usize), side: usize) -> u32 {
    let size = (then.width(), then.height());
    let by = (-REACH..=REACH).flat_map(|dy| (-REACH..=REACH).map(move |dx| (dx, dy)));
    let places = by.filter_map(|by| moved(at, by, side, size));
    let still = difference(now, at, then, at, (side, u32::MAX));
    let least = places.fold(still, |least, to| least.min(difference(now, at, then, to, (side, least))));
    MOTION * (still - least) + still
}

/// Where a square is in the frame after, if it moves along with what it shows.
pub fn followed(now: &Grid<u8>, then: &Grid<u8>, at: (usize, usize), side: usize, reach: i32) -> (usize, usize) {
    let size = (then.width(), then.height());
    let by = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
    let mut least = (u32::MAX, 0, 0, 0);
    let mut found = at;
    for (dx, dy) in by {
        let Some(to) = moved(at, (dx, dy), side, size) else { continue };
        let rank = (difference(now, at, then, to, (side, least.0)), dx * dx + dy * dy, dy, dx);
        if rank < least {
            (least, found) = (rank, to);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::sprites::model::Growth;

    /// Noise that falls by 2 pixels a frame right of column 32, and stands still left of it.
    fn frames(count: usize) -> Vec<Grid<u8>> {
        let code = |x: usize, y: usize| ((x * 7919 + y * 104_729) ^ (x * y * 31)) as u8;
        let frame = |k: usize| {
            let cell = |i: usize| match (i % 96, i / 96) {
                (x, y) if x < 32 => code(x, y),
                (x, y) => code(x, (y + 200 - 2 * k) / 3),
            };
            Grid::from_cells(96, 64, (0..96 * 64).map(cell).collect())
        };
        (0..count).map(frame).collect()
    }

    fn sprites(max: u32) -> Sprites {
        Sprites { size: 16, keys: 3, growth: Growth { max, ..Growth::default() }, ..Sprites::default() }
    }

    #[test]
    fn windows_are_where_things_fall_and_all_differ() {
        let frames = frames(12);
        let found = windows(&sprites(20), 2.0, &frames);
        assert_eq!(found.len(), 20, "{found:?}");
        assert!(found.iter().all(|window| window.at.0 >= 20), "{found:?}");
        let all = found.iter().enumerate();
        assert!(all.into_iter().all(|(i, window)| !found[..i].contains(window)));
        assert!(found.iter().all(|window| window.frame + 4 < 12));
        let known = |k: usize| found.iter().filter(|window| window.frame <= k).count();
        assert_eq!([known(0), known(1)], [4, Growth { max: 20, ..Growth::default() }.added(1, 2.0) + 4]);
    }

    #[test]
    fn a_window_follows_what_it_shows() {
        let frames = frames(2);
        assert_eq!(followed(&frames[0], &frames[1], (48, 16), 16, 8), (48, 18));
        assert_eq!(followed(&frames[0], &frames[1], (8, 16), 16, 8), (8, 16));
        // Of displacements that fit as well, the shortest counts, then the one upwards.
        let even = Grid::filled(40, 40, 7);
        assert_eq!(followed(&even, &even, (8, 8), 16, 8), (8, 8));
    }

    #[test]
    fn nothing_is_chosen_where_nothing_moves() {
        assert_eq!(windows(&sprites(20), 2.0, &vec![Grid::filled(64, 64, 9); 8]), []);
    }
}
