//! Which impulses may reach each tile of a frame.

use rayon::prelude::*;

use super::impulse::Impulse;

/// The side of a tile, in pixels.
pub const TILE: usize = 64;

/// The impulses that may reach each tile, in order.
pub struct Bins {
    /// Where those of each tile begin, and where the last ends.
    begins: Vec<u32>,
    /// The impulses of one tile after the other.
    all: Vec<u32>,
}

impl Bins {
    /// Sorts the impulses of a frame of this size.
    pub fn new((width, height): (usize, usize), impulses: &[Impulse]) -> Bins {
        let (across, down) = (width.div_ceil(TILE).max(1), height.div_ceil(TILE).max(1));
        let tiles = |middle: f64, radius: f64, most: usize| {
            let tile = |at: f64| (at * (1.0 / TILE as f64)).clamp(0.0, most as f64) as u32;
            [tile(middle - radius), tile(middle + radius + TILE as f64).min(most as u32)]
        };
        let reached = impulses.par_iter().map(|impulse| {
            let Impulse { at, radius_px, .. } = *impulse;
            [tiles(at.x, radius_px, across), tiles(at.y, radius_px, down)]
        });
        let reached: Vec<[[u32; 2]; 2]> = reached.collect();
        let each = |[x, y]: &[[u32; 2]; 2]| {
            let [x, y] = [x[0]..x[1], y[0]..y[1]];
            y.flat_map(move |y| x.clone().map(move |x| y as usize * across + x as usize))
        };
        let mut begins = vec![0; across * down + 1];
        reached.iter().flat_map(each).for_each(|tile| begins[tile + 1] += 1);
        (0..across * down).for_each(|tile| begins[tile + 1] += begins[tile]);
        let (mut next, mut all) = (begins.clone(), vec![0; begins[across * down] as usize]);
        for (i, reached) in reached.iter().enumerate() {
            for tile in each(reached) {
                all[next[tile] as usize] = i as u32;
                next[tile] += 1;
            }
        }
        Bins { begins, all }
    }

    /// Those that may reach a tile, by its number: row after row.
    pub fn of(&self, tile: usize) -> &[u32] {
        &self.all[self.begins[tile] as usize..self.begins[tile + 1] as usize]
    }
}
