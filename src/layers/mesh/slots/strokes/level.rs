//! A plane that is close to what a tile shows: it tells which kernels reach all of it, and which none.

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use super::bins::TILE;
use super::curves::LANES;

/// How many rows a block has; it has `LANES` columns.
const HIGH: usize = 16;
/// How many blocks are beside one another in a tile.
const ACROSS: usize = TILE / LANES;
/// Every so many pixels of a tile are looked at for its plane.
const SPARSE: usize = 8;
/// Distances are known to this share.
const SURE: f64 = 1e-3;

/// A plane that is close to what a tile shows of the layer.
#[derive(Clone, Debug)]
pub struct Level {
    /// 1 / its depth, as the `plane` of an impulse.
    plane: DVec3,
    /// Where the tile is in the frame.
    corner: DVec2,
    /// How much more than that 1 / the layer's depth is in all of the tile.
    all: Away,
    /// The same in its blocks, row after row.
    blocks: Vec<Away>,
}

/// How far another plane is from it.
#[derive(Clone, Copy)]
pub struct Apart {
    /// How much more 1 / its depth is than on the other, in the corner, and how that grows to the right and down.
    corner: f64,
    slopes: DVec2,
    /// How far what all of the tile shows is from the other.
    all: Away,
}

/// The least and the most; the other way round where the layer is not seen.
#[derive(Clone, Copy, Debug)]
struct Away {
    least: f64,
    most: f64,
}

impl Away {
    const NONE: Away = Away { least: f64::INFINITY, most: f64::NEG_INFINITY };

    /// The least and the most distance from 0 once something is added that is known to within `spread`.
    #[inline(always)]
    fn distances(self, added: f64, spread: f64) -> Away {
        let (low, high) = (self.least + added - spread, self.most + added + spread);
        Away { least: low.max(-high), most: high.max(-low) }
    }

    #[inline(always)]
    fn with(self, other: Away) -> Away {
        Away { least: self.least.min(other.least), most: self.most.max(other.most) }
    }
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
        let corner = DVec2::new(columns.start as f64 + 0.5, rows.start as f64 + 0.5);
        // Relative to the corner: the sums stay exact enough.
        let (mut squares, mut sums) = (DMat3::ZERO, DVec3::ZERO);
        for y in rows.clone().step_by(SPARSE) {
            for x in columns.clone().step_by(SPARSE) {
                let i = y * width + x;
                if triangle[i] != u32::MAX {
                    let at = DVec3::new((x - columns.start) as f64, (y - rows.start) as f64, 1.0);
                    squares += DMat3::from_cols(at * at.x, at * at.y, at);
                    sums += at * inverse[i];
                }
            }
        }
        // Any plane serves; a close one tells more.
        let fit = if squares.determinant() > 1.0 { squares.inverse() * sums } else { DVec3::ZERO };
        let mut blocks = Vec::with_capacity(ACROSS * TILE / HIGH);
        for first in rows.clone().step_by(HIGH) {
            let (mut least, mut most) = ([[f32::INFINITY; LANES]; ACROSS], [[f32::NEG_INFINITY; LANES]; ACROSS]);
            for y in first..(first + HIGH).min(rows.end) {
                let own = y * width + columns.start..y * width + columns.end;
                let (mut inverses, mut triangles) = ([0.0; TILE], [u32::MAX; TILE]);
                inverses[..own.len()].copy_from_slice(&inverse[own.clone()]);
                triangles[..own.len()].copy_from_slice(&triangle[own]);
                let level = fit.y * (y - rows.start) as f64 + fit.z;
                for lump in 0..ACROSS {
                    let level = level + fit.x * (lump * LANES) as f64;
                    for k in 0..LANES {
                        let i = lump * LANES + k;
                        let away = (inverses[i] - (fit.x * k as f64 + level)) as f32;
                        let is_own = triangles[i] != u32::MAX;
                        let (low, high) = (&mut least[lump][k], &mut most[lump][k]);
                        *low = if is_own & (away < *low) { away } else { *low };
                        *high = if is_own & (away > *high) { away } else { *high };
                    }
                }
            }
            for (least, most) in least.iter().zip(&most) {
                let (least, most) = (least.iter().copied().reduce(f32::min), most.iter().copied().reduce(f32::max));
                blocks.extend(least.zip(most).map(|(least, most)| Away { least: least.into(), most: most.into() }));
            }
        }
        let plane = fit.with_z(fit.z - fit.x * corner.x - fit.y * corner.y);
        let all = blocks.iter().copied().reduce(Away::with)?;
        (all.least <= all.most).then_some(Level { plane, corner, all, blocks })
    }

    /// How far a plane is from this one.
    #[inline(always)]
    pub fn apart(&self, plane: DVec3) -> Apart {
        let apart = self.plane - plane;
        let corner = apart.x * self.corner.x + apart.y * self.corner.y + apart.z;
        let (slopes, half) = (apart.truncate(), (TILE - 1) as f64 / 2.0);
        let spread = half * (slopes.x.abs() + slopes.y.abs());
        Apart { corner, slopes, all: self.all.distances(corner + half * (slopes.x + slopes.y), spread) }
    }

    /// Whether a kernel covers all of the layer in these columns and rows of the tile, or nothing; `None` if that differs. It is
    /// one on a plane that is so far apart, and reaches so far from it, by 1 / depth times a scale.
    #[inline(always)]
    pub fn covered(
        &self,
        Apart { corner, slopes, all }: &Apart,
        (scale, reach): (f64, f64),
        columns: &Range<usize>,
        rows: &Range<usize>,
    ) -> Option<bool> {
        let added = |x: f64, y: f64| corner + slopes.x * x + slopes.y * y;
        let spread = |wide: f64, high: f64| slopes.x.abs() * wide + slopes.y.abs() * high;
        let told = |Away { least, most }: Away| match most * scale <= reach * (1.0 - SURE) {
            true => Some(true),
            false => (least * scale >= 2.0 * reach * (1.0 + SURE)).then_some(false),
        };
        let half = |range: &Range<usize>| (range.len() - 1) as f64 / 2.0;
        // By all of the tile, by where the kernel is, by the blocks there.
        let of_tile = told(*all);
        if of_tile.is_some() {
            return of_tile;
        }
        let (wide, high) = (half(columns), half(rows));
        let middle = added(columns.start as f64 + wide, rows.start as f64 + high);
        let of_kernel = told(self.all.distances(middle, spread(wide, high)));
        if of_kernel.is_some() {
            return of_kernel;
        }
        let (wide, high) = (half(&(0..LANES)), half(&(0..HIGH)));
        let (mut all, spread) = (Away::NONE, spread(wide, high));
        for y in rows.start / HIGH..rows.end.div_ceil(HIGH) {
            for x in columns.start / LANES..columns.end.div_ceil(LANES) {
                let middle = added((x * LANES) as f64 + wide, (y * HIGH) as f64 + high);
                all = all.with(self.blocks[y * ACROSS + x].distances(middle, spread));
            }
        }
        told(all)
    }
}
