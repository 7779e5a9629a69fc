//! A plane that is close to what a tile shows: it tells which kernels reach all of it, and which none.

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use super::curves::LANES;

/// How many rows a block has.
const HIGH: usize = 16;
/// Every so many pixels of a tile are looked at for its plane.
const SPARSE: usize = 4;

/// A plane that is close to what a tile shows of the layer.
pub struct Level {
    /// 1 / its depth, as the `plane` of an impulse.
    pub plane: DVec3,
    /// The least and the greatest that 1 / the layer's depth is more than that in blocks of `LANES` columns and `HIGH` rows;
    /// infinite where the layer is not seen.
    blocks: Vec<[f64; 2]>,
    /// How many blocks are beside one another.
    across: usize,
}

impl Level {
    /// That of a tile of a frame of this width: of 1 / the depth and the triangle of each pixel. `None` if the layer is not
    /// seen in it.
    #[inline(always)]
    pub fn new(
        (width, inverse, triangle): (usize, &[f64], &[u32]),
        columns: &Range<usize>,
        rows: &Range<usize>,
    ) -> Option<Level> {
        let own = |x: usize, y: usize| {
            let i = y * width + x;
            (triangle[i] != u32::MAX).then(|| inverse[i])
        };
        // Relative to the corner: the sums stay exact enough.
        let corner = DVec2::new(columns.start as f64 + 0.5, rows.start as f64 + 0.5);
        let (mut squares, mut sums) = (DMat3::ZERO, DVec3::ZERO);
        for y in rows.clone().step_by(SPARSE) {
            for x in columns.clone().step_by(SPARSE) {
                if let Some(inverse) = own(x, y) {
                    let at = DVec3::new((x - columns.start) as f64, (y - rows.start) as f64, 1.0);
                    squares += DMat3::from_cols(at * at.x, at * at.y, at);
                    sums += at * inverse;
                }
            }
        }
        // Any plane serves; a close one tells more.
        let fit = if squares.determinant() > 1.0 { squares.inverse() * sums } else { DVec3::ZERO };
        let plane = fit.with_z(fit.z - fit.x * corner.x - fit.y * corner.y);
        let (across, down) = (columns.len().div_ceil(LANES), rows.len().div_ceil(HIGH));
        let mut least = vec![[f64::INFINITY; LANES]; across * down];
        let mut most = vec![[f64::NEG_INFINITY; LANES]; across * down];
        let mut away = vec![f64::NAN; across * LANES];
        for y in rows.clone() {
            let own = y * width + columns.start..y * width + columns.end;
            let first = plane.x * (columns.start as f64 + 0.5) + plane.y * (y as f64 + 0.5) + plane.z;
            let pixels = inverse[own.clone()].iter().zip(&triangle[own]);
            for (x, (away, (inverse, triangle))) in away.iter_mut().zip(pixels).enumerate() {
                let found = inverse - (plane.x * x as f64 + first);
                *away = if *triangle != u32::MAX { found } else { f64::NAN };
            }
            let block = (y - rows.start) / HIGH * across;
            let blocks = least[block..].iter_mut().zip(&mut most[block..]);
            for (lump, (least, most)) in away.as_chunks::<LANES>().0.iter().zip(blocks) {
                for (k, away) in lump.iter().enumerate() {
                    // What is not a number is neither.
                    least[k] = if *away < least[k] { *away } else { least[k] };
                    most[k] = if *away > most[k] { *away } else { most[k] };
                }
            }
        }
        let least = least.into_iter().map(|block| block.into_iter().fold(f64::INFINITY, f64::min));
        let most = most.into_iter().map(|block| block.into_iter().fold(f64::NEG_INFINITY, f64::max));
        let blocks: Vec<[f64; 2]> = least.zip(most).map(|(least, most)| [least, most]).collect();
        blocks.iter().any(|[least, most]| least <= most).then_some(Level { plane, blocks, across })
    }

    /// Whether all of the layer in these columns and rows of the tile is within `reach` of a plane, or all of it beyond twice
    /// that; `None` if that differs. The plane is given by what is added to what is away: at the first pixel of the tile, and
    /// for each column and row.
    #[inline(always)]
    pub fn within(
        &self,
        (first, slope): (f64, DVec2),
        columns: &Range<usize>,
        rows: &Range<usize>,
        reach: f64,
    ) -> Option<bool> {
        let half = DVec2::new(LANES as f64 - 1.0, HIGH as f64 - 1.0) / 2.0;
        let spread = slope.abs().dot(half);
        let (mut farthest, mut nearest) = (0.0_f64, f64::INFINITY);
        for y in rows.start / HIGH..rows.end.div_ceil(HIGH) {
            for x in columns.start / LANES..columns.end.div_ceil(LANES) {
                let middle = first + slope.dot(DVec2::new((x * LANES) as f64, (y * HIGH) as f64) + half);
                let [least, most] = self.blocks[y * self.across + x];
                let (low, high) = (least + middle - spread, most + middle + spread);
                farthest = farthest.max(high).max(-low);
                nearest = nearest.min(low.max(-high));
            }
        }
        if farthest <= reach {
            return Some(true);
        }
        (nearest >= 2.0 * reach).then_some(false)
    }
}
